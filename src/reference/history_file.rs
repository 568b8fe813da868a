//! `history.csv` of a stored solution, read strictly.

use crate::impact::{History, Motion};
use std::path::Path;

/// The columns, in this order.
const COLUMNS: [&str; 9] = [
    "time",
    "outer_displacement",
    "outer_velocity",
    "outer_force",
    "plate_displacement",
    "plate_velocity",
    "inner_displacement",
    "inner_velocity",
    "inner_force",
];

/// Reads a history: the columns above, finite numbers, strictly increasing time, one row at least.
///
/// # Errors
/// One sentence with line, column and value.
pub(super) fn read(path: &Path) -> Result<History, String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_path(path)
        .map_err(|e| format!("can't be read: {e}"))?;
    let mut columns: [Vec<f64>; 9] = Default::default();
    for (index, record) in reader.records().enumerate() {
        let line = index + 1;
        // The reader itself refuses a row with another number of columns than the first.
        let record = record.map_err(|e| format!("line {line}: {e}"))?;
        if index == 0 {
            if record.iter().ne(COLUMNS) {
                let found: Vec<&str> = record.iter().take(12).collect();
                return Err(format!(
                    "line 1: the columns are {}; expected {}",
                    found.join(","),
                    COLUMNS.join(",")
                ));
            }
            continue;
        }
        for ((column, name), text) in columns.iter_mut().zip(COLUMNS).zip(record.iter()) {
            let number: Option<f64> = text.parse().ok().filter(|n: &f64| n.is_finite());
            let number =
                number.ok_or_else(|| format!("line {line}: {name} is `{text}`, not a finite number"))?;
            if let (true, Some(last)) = (name == "time", column.last())
                && number <= *last
            {
                return Err(format!(
                    "line {line}: time is {number} s, not after {last} s of the line before"
                ));
            }
            column.push(number);
        }
    }
    if columns[0].is_empty() {
        return Err("has no sample".to_owned());
    }
    let [
        time,
        outer_displacement,
        outer_velocity,
        outer_force,
        plate_displacement,
        plate_velocity,
        inner_displacement,
        inner_velocity,
        inner_force,
    ] = columns;
    Ok(History {
        time,
        outer: Motion { displacement: outer_displacement, velocity: outer_velocity },
        plate: Motion { displacement: plate_displacement, velocity: plate_velocity },
        inner: Motion { displacement: inner_displacement, velocity: inner_velocity },
        outer_force,
        inner_force,
    })
}
