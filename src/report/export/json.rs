//! The comparison document as JSON.

use crate::error::Result;
use crate::report::{Report, standing};

/// Pretty JSON of [`crate::comparison::Comparison`], of every scene also what tables of several scenes show (`overview`),
/// ending with a line break.
///
/// # Errors
/// [`crate::Error::Internal`] if it can't be serialised.
pub fn json(report: &Report) -> Result<String> {
    standing::document(report, &standing::of_run(report))
}
