//! Files with one JSON document per line.

use crate::error::{Error, Result};
use crate::file::write_file;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::ErrorKind;
use std::path::Path;

/// The documents of `file`, none if it does not exist.
///
/// # Errors
/// [`Error::Io`] if it can't be read, [`Error::Usage`] naming the line that is not what is expected.
pub(crate) fn read<T: DeserializeOwned>(file: &Path) -> Result<Vec<T>> {
    let text = match std::fs::read_to_string(file) {
        Ok(text) => text,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        Err(e) => return Err(Error::io("reading", file, e)),
    };
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let parsed = lines.map(|(k, line)| {
        serde_json::from_str(line).map_err(|e| {
            Error::Usage(format!(
                "{}, line {}: {e}; remove the line or take the file from an earlier commit",
                file.display(),
                k + 1
            ))
        })
    });
    parsed.collect()
}

/// Replaces `file` by `documents`, complete or not at all.
///
/// # Errors
/// [`Error::Io`] if it can't be written.
pub(crate) fn write<T: Serialize>(file: &Path, documents: &[T]) -> Result<()> {
    let line = |document: &T| serde_json::to_string(document).map(|line| line + "\n");
    let text: std::result::Result<String, _> = documents.iter().map(line).collect();
    let text = text.map_err(|e| Error::Internal(format!("writing {}: {e}", file.display())))?;
    write_file(file, text.as_bytes())
}
