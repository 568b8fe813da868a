//! `impactcheck doctor`: what is installed, and the command that installs what is missing.

use super::{Context, JsonArgument};
use crate::error::{ExitStatus, Result};

/// Runs the checks; missing programs are told, not failed on: stored solutions need none of them.
pub fn run(context: &Context, arguments: JsonArgument) -> Result<ExitStatus> {
    let checks = crate::reference::doctor(&context.store());
    if arguments.json {
        super::print_json(&checks)?;
    } else {
        for check in &checks {
            let line = match &check.found {
                Some(found) => format!("found    {:<14} {found}", check.name),
                None => {
                    format!(
                        "missing  {:<14} needed for {}; install with: {}",
                        check.name, check.needed_for, check.install
                    )
                }
            };
            super::print(&line)?;
        }
    }
    Ok(ExitStatus::Pass)
}
