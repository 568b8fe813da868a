//! `impactcheck study`: the paper's tables and parameter studies.

use super::{Context, JsonArgument};
use crate::error::{Error, ExitStatus, Result};
use crate::scene::Model;
use crate::{report, study};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Name of the study: table2
    name: String,
    /// Reduced model, for the studies of figures [default: B, with which the paper made them]
    #[arg(long)]
    model: Option<Model>,
    /// Write the study as JSON, CSV and Markdown into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgument,
}

/// Runs the study and prints it. Claims are judged in the document; the exit status tells only whether the job was
/// done.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let entry = study::find(&arguments.name)?;
    if let (Some(model), false) = (arguments.model, entry.takes_model) {
        return Err(Error::Usage(format!(
            "--model {model}: the study {} runs no reduced model of choice",
            entry.name
        )));
    }
    let settings = study::Settings { model: arguments.model };
    if let Some(folder) = &arguments.out {
        // refused before anything is computed
        report::check_writable(folder)?;
    }
    let study = (entry.run)(&settings, &mut |text| context.note(text))?;
    if let Some(folder) = &arguments.out {
        for path in study::write(&study, entry.panels, folder)? {
            context.note(format_args!("wrote {}", path.display()));
        }
    }
    if arguments.json.json {
        super::print_json(&study)?;
    } else {
        super::print(study::markdown(&study).trim_end())?;
    }
    Ok(ExitStatus::Pass)
}
