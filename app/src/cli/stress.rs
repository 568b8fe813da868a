//! `impactcheck stress`: numerical stability over random scenes.

use super::{Context, JsonArgument};
use crate::error::{ExitStatus, Result};
use crate::evidence::stress::{self, StressReport};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Number of random scenes
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u64).range(1..))]
    cases: u64,
    /// Seed of the first scene
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Print all results, to compare two versions bit for bit
    #[arg(long, requires = "json")]
    results: bool,
    #[command(flatten)]
    json: JsonArgument,
}

/// Runs the scenes; the exit status is that of a failed solver if an invariant does not hold.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let bar = if context.quiet { ProgressBar::hidden() } else { ProgressBar::new(arguments.cases) };
    if let Ok(style) = ProgressStyle::with_template("{pos}/{len} scenes, {elapsed}, {eta} left {bar:40}") {
        bar.set_style(style);
    }
    let progress = || bar.inc(1);
    if arguments.results {
        let results = stress::results(arguments.cases, arguments.seed, &progress)?;
        bar.finish_and_clear();
        arguments.json.print(&results, |_| String::new())?;
        return Ok(ExitStatus::Pass);
    }
    let report = stress::run(arguments.cases, arguments.seed, &progress)?;
    bar.finish_and_clear();
    arguments.json.print(&report, table)?;
    Ok(if report.failures.is_empty() && report.sweep.holds() { ExitStatus::Pass } else { ExitStatus::Solver })
}

fn table(report: &StressReport) -> String {
    let mut lines = vec![format!(
        "{} scenes from seed {}: {} failed; {} compared with an independent solution, {} with more than one contact",
        report.cases,
        report.seed,
        report.failures.len(),
        report.compared,
        report.recontacts
    )];
    if !report.undecided.is_empty() {
        lines.push(format!(
            "  too uncertain to compare, be it the independent solution or the result by its own warning, seeds {}",
            report.undecided.iter().map(u64::to_string).collect::<Vec<_>>().join(", ")
        ));
    }
    if !report.beyond_model.is_empty() {
        lines.push(format!(
            "  refused, since the plate bends around the inner body in the fluid, or by contact chatter without end: {}",
            report.beyond_model.len()
        ));
    }
    let sweep = &report.sweep;
    lines.push(format!(
        "  as points of a sweep: {} of {} have not converged (stated); {} are wrong without a statement (bound 1 in 1000)",
        sweep.unconverged,
        sweep.points,
        sweep.wrong.len()
    ));
    for (name, worst) in &report.worst {
        let bound = worst.bound.map_or_else(String::new, |b| format!(" (bound {b:.0e})"));
        lines.push(format!("  worst {name:<28} {:>9.2e}{bound}, seed {}", worst.value, worst.seed));
    }
    for failure in &report.failures {
        lines.push(format!("  {}\n    {}", failure.reason, failure.case));
        lines.push(format!("    impactcheck stress --cases 1 --seed {}", failure.seed));
    }
    lines.join("\n")
}
