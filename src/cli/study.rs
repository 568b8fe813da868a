//! `impactcheck study`: the paper's tables and parameter studies.

use super::{Context, JsonArgument};
use crate::error::{ExitStatus, Result};
use crate::{report, study};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Name of the study: table2, insensitivity
    name: String,
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
    if let Some(folder) = &arguments.out {
        // refused before anything is computed
        report::check_writable(folder)?;
    }
    let study = (entry.run)(&mut |text| context.note(text))?;
    if let Some(folder) = &arguments.out {
        for path in study::write(&study, folder)? {
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
