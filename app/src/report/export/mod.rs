//! Results as files, a format a file: the user chooses by the ending of a name, or it is part of every report.

mod csv;
mod figure;
mod json;
mod parquet;

pub(crate) use csv::Csv;
pub use csv::curves_csv;
pub use figure::{FigureFile, figure_format};
pub(crate) use json::Json;
pub use json::json;

use crate::error::{Error, Result};
use crate::result::History;
use std::path::Path;

/// A format of files that hold an `S`.
pub trait Export<S: ?Sized>: Sync {
    /// What the files' names end in, without the dot.
    fn ending(&self) -> &'static str;

    /// The file of `shown`.
    ///
    /// # Errors
    /// [`Error::Internal`] if it can't be written.
    fn bytes(&self, shown: &S) -> Result<Vec<u8>>;
}

/// The format of a history that the ending of `file`, of the option `--history`, names: CSV or Parquet, with the columns of a
/// reference's history.
///
/// # Errors
/// [`Error::Usage`] if it names none.
pub fn history_format(file: &Path) -> Result<&'static dyn Export<History>> {
    by_ending("--history", file, &[&csv::Csv, &parquet::Parquet])
}

/// The one of `formats` that the ending of `file` names, which `option` of the command line asks for.
///
/// # Errors
/// [`Error::Usage`] with the endings that there are, if it names none.
fn by_ending<'f, S: ?Sized>(
    option: &str,
    file: &Path,
    formats: &[&'f dyn Export<S>],
) -> Result<&'f dyn Export<S>> {
    let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    formats.iter().copied().find(|format| format.ending() == ending).ok_or_else(|| {
        let endings: Vec<String> = formats.iter().map(|format| format!(".{}", format.ending())).collect();
        let endings = endings.join(", ");
        // "a, b or c"
        let endings =
            endings.rsplit_once(", ").map_or(endings.clone(), |(some, last)| format!("{some} or {last}"));
        Error::Usage(format!("{option} {}: the name has to end in {endings}", file.display()))
    })
}
