//! `impactcheck bench`: run time against error.

use super::{Context, JsonArgument};
use crate::error::{ExitStatus, Result};
use crate::evidence::bench::{self, Bench, Settings};
use crate::file::write_file;
use crate::report;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Numbers of modes at which integrators are compared (default: a minute or two; 1,16,64,256: about an hour)
    #[arg(long, value_delimiter = ',', default_value = "1,16", value_name = "N,…")]
    modes: Vec<usize>,
    /// Other programs to run, which solve the same equations as benches/diffsol does (JSON document in, one line per
    /// run out)
    #[arg(long = "peer", value_name = "PROGRAM")]
    peers: Vec<PathBuf>,
    /// Random impacts in each batch (models B and C, fixed and varied shapes), each compared with an exact solution
    #[arg(long, default_value_t = 1000, value_name = "N")]
    series: usize,
    /// Measure the batches only
    #[arg(long)]
    series_alone: bool,
    /// Folder for the results and diagrams (JSON, SVG, PNG)
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgument,
}

/// Runs the benchmark and prints its ratios.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    if let Some(folder) = &arguments.out {
        // refused before anything is computed
        report::check_writable(folder)?;
    }
    let (modes, peers, series) = (arguments.modes.clone(), arguments.peers.clone(), arguments.series);
    let settings = Settings { modes, peers, series, ..Settings::default() };
    let settings = if arguments.series_alone {
        Settings { modes: Vec::new(), models: false, ..settings }
    } else {
        settings
    };
    let bench = bench::run(&settings, &context.store(), &|text| context.note(text))?;
    if let Some(folder) = &arguments.out {
        let svg = bench::figure(&bench);
        let text = serde_json::to_string_pretty(&bench)
            .map_err(|e| crate::error::Error::Internal(format!("writing JSON: {e}")))?;
        let png = crate::plot::png(&svg, 2.0)?;
        for (name, bytes) in
            [("bench.json", text.as_bytes()), ("bench.svg", svg.as_bytes()), ("bench.png", &png[..])]
        {
            write_file(&folder.join(name), bytes)?;
            context.note(format_args!("wrote {}", folder.join(name).display()));
        }
    }
    arguments.json.print(&bench, table)?;
    Ok(ExitStatus::Pass)
}

fn table(bench: &Bench) -> String {
    let mut lines = vec![format!("{}, {}", bench.machine, bench.compiler)];
    lines.push(format!("{:<64} {:>5} {:>8} {:>12} {:>10}", "peer", "modes", "error", "ours, s", "ratio"));
    for ratio in &bench.ratios {
        lines.push(format!(
            "{:<64} {:>5} {:>8.0e} {:>12.3e} {:>10.1}",
            ratio.peer,
            ratio.modes.map_or_else(String::new, |n| n.to_string()),
            ratio.relative_error,
            ratio.seconds,
            ratio.ratio
        ));
    }
    if !bench.series.is_empty() {
        lines.push(format!(
            "{:<64} {:>8} {:>8} {:>21} {:>21}",
            "series of impacts on one core: impacts per second",
            "cold",
            "warm",
            "all errors 99 %, max",
            "efficiency 99 %, max"
        ));
    }
    for series in &bench.series {
        let errors = |[most, largest]: [f64; 2]| format!("{most:.1e}, {largest:.1e}");
        lines.push(format!(
            "{:<64} {:>8.0} {:>8.0} {:>21} {:>21}",
            format!(
                "model {}, {} fields vary, {} impacts",
                series.model,
                series.varied.len(),
                series.impacts
            ),
            series.per_second_cold,
            series.per_second_warm,
            errors(series.error),
            errors(series.efficiency_error)
        ));
        for (what, found) in [("shared bodies", series.shared), ("their meshes", series.meshed)] {
            lines.extend(found.map(|found| {
                format!(
                    "  {what}, integrated to 1e-7: force peaks {}; efficiency {} (99 %, max)",
                    errors(found.force_peaks),
                    errors(found.efficiency)
                )
            }));
        }
    }
    lines.extend(bench.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}
