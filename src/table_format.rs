//! Formats of tables in files.

use crate::error::{Error, Result};
use std::path::Path;

/// Format of a table, as its file's ending says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableFormat {
    /// Comma-separated text.
    Csv,
    /// Apache Parquet, units in the metadata.
    Parquet,
}

impl TableFormat {
    /// The ending of a file of this format.
    pub fn extension(self) -> &'static str {
        match self {
            TableFormat::Csv => "csv",
            TableFormat::Parquet => "parquet",
        }
    }

    /// The format that the ending of `file` names.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none of that name.
    pub fn of(file: &Path) -> Result<Self> {
        let ending = file.extension().unwrap_or_default().to_string_lossy();
        ending.parse().map_err(|reason| Error::Usage(format!("{}: {reason}", file.display())))
    }
}

impl std::str::FromStr for TableFormat {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let found = [TableFormat::Csv, TableFormat::Parquet].into_iter().find(|f| f.extension() == text);
        found.ok_or_else(|| format!("`{text}` is not a format; there are csv and parquet"))
    }
}
