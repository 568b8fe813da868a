//! `impactcheck doctor`: what is installed, and the command that installs what is missing.

use super::{Context, JsonArgument};
use crate::error::{ExitStatus, Result};
use crate::reference::{Check, INDEPENDENT_SOLVER};

/// Runs the checks. If anything is missing, the exit status says so too; what is stored can be compared all the same.
pub fn run(context: &Context, arguments: JsonArgument) -> Result<ExitStatus> {
    let checks = crate::reference::doctor(&context.store());
    if arguments.json {
        super::print_json(&checks)?;
    } else {
        super::print(&ready(&checks))?;
        for check in &checks {
            let line = match &check.found {
                Some(found) => format!("found    {:<14} {found}", check.name),
                None => {
                    let missing = if check.optional { "optional" } else { "missing " };
                    format!(
                        "{missing} {:<14} needed for {}; install with: {}",
                        check.name, check.needed_for, check.install
                    )
                }
            };
            super::print(&line)?;
        }
    }
    let is_complete = checks.iter().all(|check| check.found.is_some() || check.optional);
    Ok(if is_complete { ExitStatus::Pass } else { ExitStatus::Solver })
}

/// What can be done on this machine, in a line.
fn ready(checks: &[Check]) -> String {
    let missing = checks.iter().find(|check| check.found.is_none() && !check.optional);
    let finite_elements = missing.map_or("yes".to_owned(), |check| format!("no ({} is missing)", check.name));
    let has = |name: &str| checks.iter().any(|check| check.name == name && check.found.is_some());
    let solver = if has(INDEPENDENT_SOLVER) { "yes" } else { "no (optional)" };
    format!(
        "ready for: reduced models and reports: yes; finite elements: {finite_elements}; independent solver: {solver}"
    )
}
