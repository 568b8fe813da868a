//! `impactcheck schema`: the JSON schema of scene files.

use crate::error::{ExitStatus, Result};

/// Its file beside scenes, which editors find by a scene's line `#:schema`; written by this program alone.
pub(super) const FILE: &str = "impactcheck.schema.json";

/// Prints the schema.
pub fn run() -> Result<ExitStatus> {
    super::print_json(&crate::kinds::schema())?;
    Ok(ExitStatus::Pass)
}
