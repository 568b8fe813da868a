//! `impactcheck schema`: the JSON schema of scene files.

use crate::error::{ExitStatus, Result};

/// Prints the schema.
pub fn run() -> Result<ExitStatus> {
    super::print_json(&crate::scene::schema())?;
    Ok(ExitStatus::Pass)
}
