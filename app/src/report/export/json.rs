//! The comparison document as JSON.

use super::Export;
use crate::error::Result;
use crate::report::existing::Folder;
use crate::report::{Report, existing};

/// Pretty JSON of [`crate::comparison::Comparison`], of every scene also what tables of several scenes show (`overview`),
/// ending with a line break.
///
/// # Errors
/// [`crate::Error::Internal`] if it can't be serialised.
pub fn json(report: &Report) -> Result<String> {
    existing::document(report, &existing::of_run(report))
}

/// The document of all scenes of a folder.
pub struct Json;

impl Export<Folder<'_>> for Json {
    fn ending(&self) -> &'static str {
        "json"
    }

    fn bytes(&self, folder: &Folder) -> Result<Vec<u8>> {
        existing::document(folder.report, folder.scenes).map(String::into_bytes)
    }
}
