//! `history.csv` of a stored solution, read strictly.

use super::CurveBands;
use crate::result::Curves;
use std::path::Path;

/// What the name of a band's column adds to that of its curve. Bands follow the curves, one per curve.
const BAND: &str = "_band";

/// The number, if it can be the half width of a band.
fn width(text: &str) -> Option<f64> {
    text.parse().ok().filter(|width: &f64| width.is_finite() && *width >= 0.0)
}

/// Whether these are the columns of a history, with or without bands.
fn are_columns(found: &csv::StringRecord, columns: &[&str]) -> bool {
    let bands = columns[1..].iter().map(|name| format!("{name}{BAND}"));
    let all: Vec<String> = columns.iter().map(|name| (*name).to_owned()).chain(bands).collect();
    found.iter().eq(columns.iter().copied()) || found.iter().eq(all.iter().map(String::as_str))
}

/// Reads a history: its columns, finite numbers, strictly increasing time, one row at least; and the bands of its
/// curves, if the file has them.
///
/// # Errors
/// One sentence with line, column and value.
pub(super) fn read<H: Curves>(path: &Path) -> Result<(H, Option<CurveBands>), String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_path(path)
        .map_err(|e| format!("can't be read: {e}"))?;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); H::COLUMNS.len()];
    let mut bands: Vec<Vec<f64>> = vec![Vec::new(); H::COLUMNS.len() - 1];
    for (index, record) in reader.records().enumerate() {
        let line = index + 1;
        // The reader itself refuses a row with another number of columns than the first.
        let record = record.map_err(|e| format!("line {line}: {e}"))?;
        if index == 0 {
            if !are_columns(&record, H::COLUMNS) {
                let found: Vec<&str> = record.iter().take(12).collect();
                return Err(format!(
                    "line 1: the columns are {}; expected {} and perhaps the bands of the curves",
                    found.join(","),
                    H::COLUMNS.join(",")
                ));
            }
            continue;
        }
        for ((column, name), text) in columns.iter_mut().zip(H::COLUMNS).zip(record.iter()) {
            let number: Option<f64> = text.parse().ok().filter(|n: &f64| n.is_finite());
            let number =
                number.ok_or_else(|| format!("line {line}: {name} is `{text}`, not a finite number"))?;
            if let (true, Some(last)) = (*name == "time", column.last())
                && number <= *last
            {
                return Err(format!(
                    "line {line}: time is {number} s, not after {last} s of the line before"
                ));
            }
            column.push(number);
        }
        for (band, text) in bands.iter_mut().zip(record.iter().skip(H::COLUMNS.len())) {
            let width = width(text);
            band.push(width.ok_or_else(|| {
                format!("line {line}: a band is `{text}`, not a finite number of 0 or more")
            })?);
        }
    }
    if columns[0].is_empty() {
        return Err("has no sample".to_owned());
    }
    let has_bands = !bands[0].is_empty();
    let bands = has_bands
        .then(|| CurveBands::new(columns[0].clone(), H::COLUMNS[1..].iter().copied().zip(bands).collect()));
    let mut history = H::default();
    for (values, name) in columns.into_iter().zip(H::COLUMNS) {
        let column =
            history.column(name).ok_or_else(|| format!("has a column `{name}` that belongs nowhere"))?;
        *column = values;
    }
    Ok((history, bands))
}
