//! The numbers of a table of text.

use super::column::Column;
use super::layout::{self, TextLayout};
use super::series::{self, Columns, MOST, ReadSignal};

/// What programs write for a value that is missing.
const MISSING: [&str; 7] = ["", "nan", "-nan", "n/a", "#n/a", "--", "null"];

/// Where the times come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Clock<'c> {
    Column(&'c Column),
    /// Start and interval in s.
    Even([f64; 2]),
}

/// Whether a cell has no value.
pub(super) fn is_missing(cell: &str) -> bool {
    MISSING.iter().any(|other| cell.eq_ignore_ascii_case(other))
}

/// Reads the `columns` of all rows of `text`.
///
/// # Errors
/// One sentence with line, column and value.
pub(super) fn read(
    text: &str,
    layout: &TextLayout,
    clock: Clock,
    columns: &[&Column],
    fewest: usize,
) -> Result<Columns, String> {
    let mut table = RowsSoFar::new(layout, clock, columns);
    let body = &text[layout.rows.clone()];
    if layout.delimiter == ' ' {
        let mut row = csv::StringRecord::new();
        for (k, line) in body.lines().enumerate() {
            row.clear();
            line.split_whitespace().for_each(|cell| row.push_field(cell.trim_matches('"')));
            table.add(&row, layout.lines_before + k + 1)?;
        }
    } else {
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .delimiter(layout.delimiter as u8)
            .from_reader(body.as_bytes());
        let mut row = csv::StringRecord::new();
        while reader.read_record(&mut row).map_err(|e| e.to_string())? {
            let line = row.position().map_or(0, csv::Position::line) as usize;
            table.add(&row, layout.lines_before + line)?;
        }
    }
    table.finished(fewest)
}

/// The rows so far.
struct RowsSoFar<'t> {
    decimal: char,
    clock: Clock<'t>,
    columns: &'t [&'t Column],
    time: Vec<f64>,
    /// Raw numbers of each column, not a number where they are missing; and of its own times.
    values: Vec<Vec<f64>>,
    own_times: Vec<Vec<f64>>,
}

impl<'t> RowsSoFar<'t> {
    fn new(layout: &TextLayout, clock: Clock<'t>, columns: &'t [&'t Column]) -> Self {
        let empty = vec![Vec::new(); columns.len()];
        Self {
            decimal: layout.decimal,
            clock,
            columns,
            time: Vec::new(),
            values: empty.clone(),
            own_times: empty,
        }
    }

    /// The number in a cell, not a number where it is missing.
    fn number(&self, row: &csv::StringRecord, index: usize, name: &str, line: usize) -> Result<f64, String> {
        let cell = row.get(index).unwrap_or_default();
        // nearly all cells are plain numbers: a record may have millions
        if self.decimal == '.'
            && let Ok(number) = cell.parse::<f64>()
            && number.is_finite()
        {
            return Ok(number);
        }
        let cell = cell.trim();
        match layout::value(cell, self.decimal) {
            Some(number) if number.is_finite() => Ok(number),
            _ if is_missing(cell) => Ok(f64::NAN),
            _ => Err(format!("line {line}: {name} is `{cell}`, not a finite number")),
        }
    }

    fn add(&mut self, row: &csv::StringRecord, line: usize) -> Result<(), String> {
        if row.iter().all(|cell| cell.bytes().all(|byte| byte == b' ')) {
            return Ok(());
        }
        let time = match self.clock {
            Clock::Even([start, interval]) => start + interval * self.time.len() as f64,
            Clock::Column(column) => {
                let number = self.number(row, column.index, column.name, line)?;
                if number.is_nan() {
                    return Err(format!("line {line}: time is missing"));
                }
                number * column.factor + column.offset
            }
        };
        // programs write the state before and after an event at the same time
        let again = self.time.last().is_some_and(|before| time == *before);
        if let Some(before) = self.time.last().filter(|before| time < **before) {
            return Err(format!("line {line}: time is {time} s, not after {before} s of the line before"));
        }
        if !again {
            self.time.push(time);
        }
        if self.time.len() > MOST {
            return Err(format!("has more than {MOST} samples"));
        }
        for (k, column) in self.columns.iter().enumerate() {
            let value = self.number(row, column.index, column.name, line)? * column.factor + column.offset;
            let own = match column.clock {
                Some(index) => Some(self.number(row, index, "its time", line)?),
                None => None,
            };
            if again {
                self.values[k].pop();
                self.own_times[k].pop();
            }
            self.values[k].push(value);
            self.own_times[k].extend(own);
        }
        Ok(())
    }

    fn finished(self, fewest: usize) -> Result<Columns, String> {
        let scale = if let Clock::Column(column) = self.clock { column.factor } else { 1.0 };
        let signals =
            self.columns.iter().zip(self.values).zip(self.own_times).map(|((column, values), times)| {
                let clock = column.clock.map(|_| times.iter().map(|t| t * scale).collect());
                ReadSignal { column, values, clock }
            });
        series::columns(self.time, signals.collect(), fewest)
    }
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

/// The values that C's `%12.5E` or Fortran's `1PE12.4` wrote one after another. Some systems write three digits of an exponent, and then a negative value
/// is wider than its column; but every value has one digit before its point.
pub(super) fn packed(text: &str) -> Option<Vec<f64>> {
    let text = text.is_ascii().then(|| text.trim_end())?;
    let is_minus = |at: usize| text.as_bytes()[at] == b'-';
    let begins = |point: usize| {
        let digit = point.checked_sub(1)?;
        let minus = digit.checked_sub(1).filter(|at| is_minus(*at));
        Some(minus.unwrap_or(digit))
    };
    let mut begins: Vec<usize> =
        text.match_indices('.').map(|(point, _)| begins(point)).collect::<Option<_>>()?;
    begins.push(text.len());
    let values = begins.windows(2).map(|pair| number(text[pair[0]..pair[1]].trim_end()));
    text[..begins[0]].trim().is_empty().then(|| values.collect())?
}

#[cfg(test)]
mod tests {
    use super::{number, packed};

    #[test]
    fn values_without_a_space_between_them_are_apart() {
        let values = packed("  0.0000E+00-1.0000E-04 2.5000-101-1.5000-101").expect("numbers");
        assert_eq!(values, [0.0, -1e-4, 2.5e-101, -1.5e-101]);
        for text in ["1 2 3", "1.0E+00 x 2.0E+00", "1.0E+00µ"] {
            assert_eq!(packed(text), None, "{text}");
        }
    }

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
