//! Formats of tables in files.

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
}

impl std::str::FromStr for TableFormat {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let found = [TableFormat::Csv, TableFormat::Parquet].into_iter().find(|f| f.extension() == text);
        found.ok_or_else(|| format!("`{text}` is not a format; there are csv and parquet"))
    }
}
