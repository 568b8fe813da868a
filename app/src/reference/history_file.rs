//! `history.csv` of a stored solution, read strictly.

use super::CurveBands;
use crate::result::{Curve, History};
use std::path::Path;

/// What the name of a band's column adds to that of its curve.
const BAND: &str = "_band";

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum HistoryColumn {
    Time,
    /// The curve of this number.
    Curve(usize),
    /// The half width of its band.
    Band(usize),
}

/// The columns a header names: the time, then every curve once, and the bands of all curves or of none.
fn columns(header: &csv::StringRecord, curves: &[Curve]) -> Option<Vec<HistoryColumn>> {
    let curve = |name: &str| curves.iter().position(|curve| curve.name == name);
    let column = |name: &str| match (name, name.strip_suffix(BAND)) {
        ("time", _) => Some(HistoryColumn::Time),
        (_, Some(name)) => curve(name).map(HistoryColumn::Band),
        (name, None) => curve(name).map(HistoryColumn::Curve),
    };
    let columns: Vec<HistoryColumn> = header.iter().map(column).collect::<Option<_>>()?;
    let all = |of: fn(usize) -> HistoryColumn| (0..curves.len()).all(|k| columns.contains(&of(k)));
    // no column twice: there are as many as there are names
    let complete = columns.first() == Some(&HistoryColumn::Time)
        && all(HistoryColumn::Curve)
        && match columns.len().checked_sub(1 + curves.len()) {
            Some(0) => true,
            Some(bands) => bands == curves.len() && all(HistoryColumn::Band),
            None => false,
        };
    complete.then_some(columns)
}

/// Reads a history: the time and these curves, finite numbers, strictly increasing time, one row at least; and the bands of
/// the curves, if the file has them. Another program's file may lack curves.
///
/// # Errors
/// One sentence with line, column and value.
pub(super) fn read(
    curves: &[Curve],
    path: &Path,
    may_omit_curves: bool,
) -> Result<(History, Option<CurveBands>), String> {
    let mut reader = csv::Reader::from_path(path).map_err(|e| format!("can't be read: {e}"))?;
    let header = reader.headers().map_err(|e| format!("line 1: {e}"))?.clone();
    if header.is_empty() {
        return Err("has no sample".to_owned());
    }
    let given = |curve: &&Curve| !may_omit_curves || header.iter().any(|name| name == curve.name);
    let curves: &[Curve] = &curves.iter().filter(given).cloned().collect::<Vec<_>>();
    let columns = columns(&header, curves).ok_or_else(|| {
        let found: Vec<&str> = header.iter().take(12).collect();
        let expected: Vec<&str> = curves.iter().map(|curve| curve.name).collect();
        format!(
            "line 1: the columns are {}; expected time, then {}, and optionally the uncertainties of all curves",
            found.join(","),
            expected.join(",")
        )
    })?;
    let mut history = History::new(curves);
    let mut bands: Vec<Vec<f64>> = vec![Vec::new(); curves.len()];
    for (index, record) in reader.records().enumerate() {
        let line = index + 2;
        // The reader itself refuses a row with another number of columns than the first.
        let record = record.map_err(|e| format!("line {line}: {e}"))?;
        for ((column, name), text) in columns.iter().zip(&header).zip(&record) {
            let number = text.parse().ok().filter(|n: &f64| n.is_finite());
            let number =
                number.ok_or_else(|| format!("line {line}: {name} is `{text}`, not a finite number"))?;
            match *column {
                HistoryColumn::Time => {
                    if let Some(last) = history.time.last().filter(|last| number <= **last) {
                        return Err(format!(
                            "line {line}: time is {number} s, not after {last} s of the line before"
                        ));
                    }
                    history.time.push(number);
                }
                HistoryColumn::Curve(k) => history.curves[k].values.push(number),
                HistoryColumn::Band(_) if number < 0.0 => {
                    return Err(format!("line {line}: {name} is `{text}`, not a width of 0 or more"));
                }
                HistoryColumn::Band(k) => bands[k].push(number),
            }
        }
    }
    if history.is_empty() {
        return Err("has no sample".to_owned());
    }
    let names = curves.iter().map(|curve| curve.name);
    let bands = (columns.len() > 1 + curves.len())
        .then(|| CurveBands::new(history.time.clone(), names.zip(bands).collect()));
    Ok((history, bands))
}
