//! The comparison document as JSON.

use super::Report;
use crate::error::{Error, Result};

/// Pretty JSON of [`crate::comparison::Comparison`], ending with a line break.
///
/// # Errors
/// [`Error::Internal`] if it can't be serialised.
pub fn json(report: &Report) -> Result<String> {
    serde_json::to_string_pretty(&report.comparison())
        .map(|text| text + "\n")
        .map_err(|e| Error::Internal(format!("writing the comparison as JSON: {e}")))
}
