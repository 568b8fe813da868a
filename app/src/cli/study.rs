//! `impactcheck study`: the paper's tables and parameter studies, and sweeps of one's own.

use super::{Context, JsonArgument, sweep};
use crate::error::{Error, ExitStatus, Result};
use crate::scene::Model;
use crate::{evidence::study, report};
use clap::{Args, Subcommand};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Arguments {
    #[command(subcommand)]
    own: Option<Own>,
    #[command(flatten)]
    named: Named,
}

#[derive(Debug, Subcommand)]
enum Own {
    /// Run a parameter sweep from a sweep file
    #[command(after_help = sweep::EXAMPLE)]
    Sweep(sweep::SweepArguments),
    /// Join the shards of a sweep into one table
    Merge(sweep::Arguments),
}

#[derive(Debug, Args)]
struct Named {
    /// Name of the study, from the list below
    #[arg(required = true)]
    name: Option<String>,
    /// Reduced model, for the studies of figures [default: B, as in the paper]
    #[arg(long)]
    model: Option<Model>,
    /// Folder for the results (JSON, CSV, Markdown; figures as SVG and PNG)
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgument,
}

/// What the help says after the options: each study in a line, and examples.
pub(super) fn after_help() -> String {
    let line = |entry: &study::Entry| {
        let name = format!("  {:21}", entry.name);
        let below = " ".repeat(name.len());
        textwrap::fill(
            entry.about,
            textwrap::Options::new(WIDTH).initial_indent(&name).subsequent_indent(&below),
        )
    };
    let studies: Vec<String> = study::STUDIES.iter().map(line).collect();
    format!("Studies:\n{}\n\n{EXAMPLES}", studies.join("\n"))
}

/// Columns of the list of studies.
const WIDTH: usize = 80;
const EXAMPLES: &str = "Examples: impactcheck study fig16 --out figures
          impactcheck study sweep my-sweep.toml --format parquet";

/// Runs a study or a sweep.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    match &arguments.own {
        Some(Own::Sweep(arguments)) => sweep::run(context, arguments),
        Some(Own::Merge(arguments)) => sweep::merge(context, arguments),
        None => named(context, &arguments.named),
    }
}

/// Runs the study and prints it. Claims are judged in the document; the exit status tells only whether the job was
/// done.
fn named(context: &Context, arguments: &Named) -> Result<ExitStatus> {
    let entry = study::find(arguments.name.as_deref().unwrap_or_default())?;
    if let (Some(model), false) = (arguments.model, entry.takes_model) {
        return Err(Error::Usage(format!(
            "--model {model}: the study {} runs no reduced model of choice",
            entry.name
        )));
    }
    let settings = study::Settings { model: arguments.model, store: context.store.clone() };
    if let Some(folder) = &arguments.out {
        // refused before anything is computed
        report::check_writable(folder)?;
    }
    let study = (entry.run)(&settings, &mut |text| context.note(text))?;
    if let Some(folder) = &arguments.out {
        for path in study::write(&study, entry.figure(&study)?, folder)? {
            context.note(format_args!("wrote {}", path.display()));
        }
    }
    if arguments.json.json {
        super::print_json(&study)?;
    } else {
        super::print(study::in_words(&study).trim_end())?;
        if arguments.out.is_none() && study.rows.len() > study::MOST_ROWS {
            context.note(format_args!(
                "{} of {} rows are shown; --out DIR writes them all, with figures",
                study::MOST_ROWS,
                study.rows.len()
            ));
        }
    }
    Ok(ExitStatus::Pass)
}
