//! Curves from a table: a CSV file whose columns are named by their heading or by a map, each with its unit.

use crate::result::Curve;
use crate::scene::{quantity_in, suggestion};

/// Most rows: a second at 20 MHz.
const MOST: usize = 20_000_000;

/// What some programs put before a text in UTF-8.
pub const BYTE_ORDER_MARK: char = '\u{feff}';

/// A column that is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of the curve, or `time`.
    pub name: &'static str,
    /// Its place in a row.
    pub index: usize,
    /// Size of its unit in SI, negative if it counts the other way.
    pub factor: f64,
    /// What is added afterwards, SI.
    pub offset: f64,
}

/// Values by name in SI, strictly increasing over the time.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// Time in s. Shape (rows).
    pub time: Vec<f64>,
    /// The others, in the order asked for. Shapes (rows).
    pub values: Vec<(&'static str, Vec<f64>)>,
}

/// The columns of a `header` such as `time [us],outer_velocity [mm/s]`, of the time and the `known` curves; without unit a
/// column is in SI.
///
/// # Errors
/// One sentence with the heading.
pub fn by_heading<'h>(
    header: impl IntoIterator<Item = &'h str>,
    known: &[Curve],
) -> Result<Vec<Column>, String> {
    let named = |(index, heading): (usize, &str)| {
        let (name, unit) = match heading.split_once('[') {
            Some((name, unit)) => {
                let unit = unit.strip_suffix(']');
                let unit = unit.ok_or_else(|| format!("column `{heading}`: `]` is missing"))?;
                (name.trim(), Some(unit.trim()))
            }
            None => (heading, None),
        };
        let (name, si) = known_column(name, known)?;
        let factor = unit.map_or(Ok(1.0), |unit| in_si(unit, si));
        let factor = factor.map_err(|reason| format!("column `{heading}`: {reason}"))?;
        Ok(Column { name, index, factor, offset: 0.0 })
    };
    let headings: Vec<&str> = header.into_iter().collect();
    if let [only] = headings[..]
        && only.contains(';')
    {
        return Err(
            "the columns are separated by `;`; a comma between columns and a decimal point are needed".into(),
        );
    }
    let columns: Vec<Column> = headings.into_iter().enumerate().map(named).collect::<Result<_, String>>()?;
    let twice = |(k, column): (usize, &Column)| columns[..k].iter().any(|other| other.name == column.name);
    match columns.iter().enumerate().find(|column| twice(*column)) {
        Some((_, column)) => Err(format!("two columns are called `{}`", column.name)),
        None => Ok(columns),
    }
}

/// The column called `name` among the time and the `known` curves, and its SI unit.
///
/// # Errors
/// One sentence with those there are.
pub fn known_column(name: &str, known: &[Curve]) -> Result<(&'static str, &'static str), String> {
    let all = std::iter::once(("time", "s")).chain(known.iter().map(|curve| (curve.name, curve.unit)));
    all.clone().find(|(other, _)| *other == name).ok_or_else(|| {
        // several kinds of scenes have curves of the same name
        let mut names: Vec<&str> = Vec::new();
        for (name, _) in all {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let hint = suggestion(name, names.iter().copied()).map(|near| format!("; did you mean `{near}`?"));
        format!(
            "`{name}` is not a known column{} (there are: {})",
            hint.unwrap_or_default(),
            names.join(", ")
        )
    })
}

/// Size of `unit` in the SI unit `si`.
///
/// # Errors
/// One sentence.
pub fn in_si(unit: &str, si: &str) -> Result<f64, String> {
    quantity_in(&format!("1 {unit}"), si)
}

/// Reads the `columns` of all rows.
///
/// # Errors
/// One sentence with line, column and value.
pub fn read(rows: &mut csv::Reader<&[u8]>, columns: &[Column], fewest: usize) -> Result<Columns, String> {
    let Some(clock) = columns.iter().position(|column| column.name == "time") else {
        return Err("there is no column `time`".into());
    };
    if columns.len() < 2 {
        return Err("there is no signal except the time".into());
    }
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
    for row in rows.records() {
        let row = row.map_err(|e| e.to_string())?;
        let line = row.position().map_or(0, csv::Position::line);
        for (values, Column { name, index, factor, offset }) in values.iter_mut().zip(columns) {
            let text = row.get(*index).ok_or_else(|| format!("line {line}: {name} is missing"))?;
            let number = self::number(text).filter(|n| n.is_finite());
            let number =
                number.ok_or_else(|| format!("line {line}: {name} is `{text}`, not a finite number"))?;
            values.push(number * factor + offset);
        }
        if let [.., before, now] = values[clock][..]
            && now <= before
        {
            return Err(format!("line {line}: time is {now} s, not after {before} s of the line before"));
        }
        if values[clock].len() > MOST {
            return Err(format!("has more than {MOST} samples"));
        }
    }
    let samples = values[clock].len();
    if samples < fewest {
        return Err(format!("has {samples} samples; at least {fewest} are needed"));
    }
    let time = std::mem::take(&mut values[clock]);
    let others = columns.iter().map(|column| column.name).zip(values).filter(|(name, _)| *name != "time");
    Ok(Columns { time, values: others.collect() })
}

/// A number as C or Fortran writes it: Fortran has D as the exponent's letter, too, and leaves it out before three digits
/// (`1.5-110`).
pub fn number(text: &str) -> Option<f64> {
    text.parse().ok().or_else(|| {
        let by_letter = text.split_once(['d', 'D']).filter(|(mantissa, _)| !mantissa.contains(['e', 'E']));
        let by_sign = || {
            let (mantissa, exponent) = text.split_at_checked(text.len().checked_sub(4)?)?;
            let is_exponent =
                exponent.starts_with(['+', '-']) && exponent[1..].bytes().all(|b| b.is_ascii_digit());
            (is_exponent && mantissa.contains('.')).then_some((mantissa, exponent))
        };
        let (mantissa, exponent) = by_letter.or_else(by_sign)?;
        format!("{mantissa}e{exponent}").parse().ok()
    })
}

/// A reader of CSV with a header; lines that begin with `#` are skipped.
pub fn csv_reader(bytes: &[u8], delimiter: u8) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new()
        .has_headers(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .delimiter(delimiter)
        .from_reader(bytes)
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_of_fortran_are_numbers() {
        for (text, value) in [
            ("-7.66720-110", -7.6672e-110),
            ("1.5+100", 1.5e100),
            ("1.0D-03", 1e-3),
            ("-2.5d+02", -250.0),
            ("3.25E-004", 3.25e-4),
        ] {
            assert_eq!(number(text), Some(value), "{text}");
        }
        // two numbers without a space, a date, a range
        for text in ["1.5E+00-110", "1.5-1", "2026-110", "0.125-1.5", "D", "1D", "1.5-11O", "--1.5-110"] {
            assert_eq!(number(text), None, "{text}");
        }
    }
}
