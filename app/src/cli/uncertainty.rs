//! `impactcheck uncertainty`: how the results scatter with the inputs.

use super::progress::Counter;
use super::requested_model;
use super::{Context, JsonArgument};
use crate::error::{Error, ExitStatus, Result};
use crate::file::write_file;
use crate::format::{percent, prefixed, with_unit};
use crate::kinds::{KINDS, Use};
use crate::report::{self, FigureFile, figure_format};
use crate::scene::{self, Model, Template, suggestion};
use crate::table_format::TableFormat;
use crate::uncertainty::{
    PropagatedUncertainty, QuantityUncertainty, Request, Samples, Share, study, uncertainty_of,
};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file with a table [uncertainty], or name of a shipped scene
    scene: String,
    /// Reduced model [default: C]
    #[arg(long, default_value = "C", hide_default_value = true)]
    model: Model,
    /// Number of modes [default: as in `reduced`]
    #[arg(long, value_name = "N")]
    modes: Option<usize>,
    /// Number of samples, or auto: doubled until --accuracy is reached. A sample takes two impacts and one per input
    #[arg(long, default_value = "auto", value_name = "N|auto", value_parser = samples)]
    samples: RowCount,
    /// Accuracy of auto: half width of the 95 % intervals of mean and standard deviation, over the standard deviation
    #[arg(long, default_value = "2%", value_name = "SHARE", value_parser = requested_model::tolerance)]
    accuracy: f64,
    /// Quantities of auto and of the tables
    #[arg(long = "quantity", value_delimiter = ',', default_value = "efficiency,outer_force_peak,inner_force_peak", value_name = "NAME,…", value_parser = quantity)]
    quantities: Vec<String>,
    /// Seed of the samples
    #[arg(long, default_value_t = 1)]
    seed: u32,
    /// Folder of samples, results (JSON) and figure (SVG, PNG); an interrupted study continues there
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Format of the samples: csv or parquet
    #[arg(long, default_value = "parquet")]
    format: TableFormat,
    /// Write the figure to this file (.svg, .pdf or .png)
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgument,
}

/// What `--samples` says.
#[derive(Debug, Clone, Copy)]
enum RowCount {
    Auto,
    Rows(usize),
}

fn samples(text: &str) -> std::result::Result<RowCount, String> {
    match text {
        "auto" => Ok(RowCount::Auto),
        _ => text.parse().map(RowCount::Rows).map_err(|_| format!("`{text}` is neither a number nor auto")),
    }
}

/// A result that scatters.
fn quantity(name: &str) -> std::result::Result<String, String> {
    let names = || {
        let sampled = KINDS.iter().filter(|kind| kind.serves(Use::Samples));
        sampled
            .flat_map(|kind| kind.quantities())
            .filter(|quantity| !quantity.is_count)
            .map(|quantity| quantity.name)
    };
    if names().any(|known| known == name) {
        return Ok(name.to_owned());
    }
    let hint = suggestion(name, names()).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
    Err(format!("there is no quantity `{name}`{hint} (there: {})", names().collect::<Vec<_>>().join(", ")))
}

/// Samples, and prints how the results scatter.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let start = Instant::now();
    let file = scene::resolve(&arguments.scene)?;
    let template = Template::read(&file)?;
    uncertainty_of(template.scene())?;
    let figure =
        arguments.figure.as_ref().map(|file| Ok::<_, Error>((file, figure_format(file)?))).transpose()?;
    if let Some(folder) = &arguments.out {
        report::check_writable(folder)?;
    }
    let request = Request {
        model: arguments.model,
        modes: arguments.modes,
        samples: match arguments.samples {
            RowCount::Auto => Samples::Until(arguments.accuracy),
            RowCount::Rows(rows) => Samples::Rows(rows),
        },
        quantities: arguments.quantities.clone(),
        seed: arguments.seed,
    };
    let counter = Counter::new(context, &template.scene().name);
    let folder = arguments.out.as_deref().map(|dir| (dir, arguments.format));
    let propagated = study((&file, &template), &request, folder, &|progress| counter.show(progress))?;
    let (_, fresh) = counter.finish();
    let seconds = start.elapsed().as_secs_f64();
    context.note(format_args!(
        "{} samples, {} impacts, {fresh} of them run now, in {seconds:.2} s",
        propagated.samples, propagated.impacts
    ));
    for note in &propagated.notes {
        context.note(format_args!("note: {note}"));
    }
    let drawn = (figure.is_some() || arguments.out.is_some())
        .then(|| report::propagation_figure(&propagated, &request.quantities));
    if let (Some((file, format)), Some(svg)) = (figure, &drawn) {
        let figure = FigureFile { title: propagated.scene.clone(), svg: svg.clone() };
        write_file(file, &format.bytes(&figure)?)?;
    }
    if let (Some(folder), Some(svg)) = (&arguments.out, drawn) {
        let json = serde_json::to_string_pretty(&propagated)
            .map_err(|e| Error::Internal(format!("writing the results as JSON: {e}")))?;
        write_file(&folder.join("uncertainty.json"), (json + "\n").as_bytes())?;
        write_file(&folder.join("uncertainty.png"), &crate::plot::png(&svg, 2.0)?)?;
        write_file(&folder.join("uncertainty.svg"), svg.as_bytes())?;
        context.note(format_args!("wrote {}", folder.join("uncertainty.svg").display()));
    }
    arguments.json.print(&propagated, |_| table(&propagated, &request.quantities))?;
    Ok(ExitStatus::Pass)
}

fn table(propagated: &PropagatedUncertainty, quantities: &[String]) -> String {
    let mut lines = vec![format!(
        "{} (model {}): {} samples of {} inputs",
        propagated.scene,
        propagated.model,
        propagated.samples,
        propagated.inputs.len()
    )];
    for (name, input) in &propagated.inputs {
        let to = prefixed(input.unit, input.nominal);
        let [nominal, deviation] =
            [(input.nominal, 6), (input.standard_deviation, 3)].map(|(v, n)| with_unit(v, to, n));
        lines.push(format!("  {name:<36} {nominal:>14} ± {deviation}"));
    }
    for name in quantities {
        if let Some(of) = propagated.quantities.get(&**name) {
            lines.extend(of_quantity(name, of));
        }
    }
    lines.join("\n")
}

fn of_quantity(name: &str, of: &QuantityUncertainty) -> Vec<String> {
    let to = prefixed(of.unit, of.mean);
    let shown = |value: f64, digits| with_unit(value, to, digits);
    let [low, high] = of.interval();
    let half = |[low, high]: [f64; 2]| 0.5 * (high - low);
    let mut lines = vec![
        name.to_owned(),
        format!(
            "  mean {} ± {}, standard deviation {} ± {} ({} of the mean)",
            shown(of.mean, 6),
            shown(half(of.mean_interval), 2),
            shown(of.standard_deviation, 4),
            shown(half(of.standard_deviation_interval), 2),
            percent(Some(of.standard_deviation / of.mean.abs())).trim_start_matches('+')
        ),
        format!(
            "  nominal {}, median {}, 95 % between {} and {}",
            of.nominal.map_or("not determined".into(), |value| shown(value, 6)),
            shown(of.quantiles.get("0.5").copied().unwrap_or(f64::NAN), 6),
            shown(low, 6),
            shown(high, 6)
        ),
        format!(
            "  {:<36}{:>20}{:>20}{:>26}",
            "share of the variance", "alone", "with interactions", "± one deviation"
        ),
    ];
    // the interval may be cut at 0 or 1
    let share =
        |value: f64, [low, high]: [f64; 2]| format!("{value:.3} ± {:.3}", (high - value).max(value - low));
    for (inputs, Share { first, first_interval, total, total_interval }) in of.ranking() {
        let moved = of.local.get(inputs).map_or(String::new(), |local| {
            let [low, high] =
                local.results.map(|result| of.nominal.map_or(f64::NAN, |nominal| result / nominal - 1.0));
            format!("{} / {}", percent(Some(low)), percent(Some(high)))
        });
        lines.push(format!(
            "  {inputs:<36}{:>20}{:>20}{moved:>26}",
            share(*first, *first_interval),
            share(*total, *total_interval)
        ));
    }
    lines
}
