//! The numbers of a table of text.

use super::column::{Column, Measures};
use super::layout::{self, TextLayout};
use crate::curves::MonotoneCubic;

/// Most rows: a second at 20 MHz.
const MOST: usize = 20_000_000;
/// What programs write for a value that is missing.
const MISSING: [&str; 7] = ["", "nan", "-nan", "n/a", "#n/a", "--", "null"];

/// Values by name in SI, over the time.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// Time in s, strictly increasing. Shape (rows).
    pub time: Vec<f64>,
    /// The others, in the order asked for. Shapes (rows).
    pub values: Vec<(&'static str, Vec<f64>)>,
    /// Where values were missing, which are interpolated: name of the curve, first and last time in s.
    pub gaps: Vec<(&'static str, [f64; 2])>,
    /// Curves that are integrals, from 0 on.
    pub integrals: Vec<&'static str>,
}

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
        let cell = row.get(index).unwrap_or_default().trim();
        if is_missing(cell) {
            return Ok(f64::NAN);
        }
        let number = layout::value(cell, self.decimal).filter(|number| number.is_finite());
        number.ok_or_else(|| format!("line {line}: {name} is `{cell}`, not a finite number"))
    }

    fn add(&mut self, row: &csv::StringRecord, line: usize) -> Result<(), String> {
        if row.iter().all(|cell| cell.trim().is_empty()) {
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
        let samples = self.time.len();
        if samples < fewest {
            return Err(format!("has {samples} samples; at least {fewest} are needed"));
        }
        let (mut values, mut gaps) = (Vec::new(), Vec::new());
        let scale = if let Clock::Column(column) = self.clock { column.factor } else { 1.0 };
        for ((column, mut own), times) in self.columns.iter().zip(self.values).zip(self.own_times) {
            let missing = filled(column.name, &self.time, &mut own)?;
            gaps.extend(missing.into_iter().map(|span| (column.name, span)));
            if column.clock.is_some() || column.delay != 0.0 {
                let clock = match column.clock {
                    Some(_) => times.iter().map(|t| t * scale).collect(),
                    None => self.time.clone(),
                };
                own = moved(column, clock, &own, &self.time)?;
            }
            values.push((column.name, derived(column.measures, &self.time, own)));
        }
        let integrals = self.columns.iter().filter(|column| column.measures == Measures::Acceleration);
        let integrals = integrals.map(|column| column.name).collect();
        Ok(Columns { time: self.time, values, gaps, integrals })
    }
}

/// Fills what is missing of `values` by straight lines; where that was.
fn filled(name: &str, time: &[f64], values: &mut [f64]) -> Result<Vec<[f64; 2]>, String> {
    let known: Vec<usize> = (0..values.len()).filter(|k| values[*k].is_finite()).collect();
    let [Some(&first), Some(&last)] = [known.first(), known.last()] else {
        return Err(format!("{name} has no value"));
    };
    let mut gaps = Vec::new();
    for (edge, ends) in [(first, 0..first), (last, last + 1..values.len())] {
        if let (Some(from), Some(to)) = (ends.clone().next(), ends.clone().last()) {
            gaps.push([time[from], time[to]]);
            let value = values[edge];
            values[ends].fill(value);
        }
    }
    for pair in known.windows(2).filter(|pair| pair[1] > pair[0] + 1) {
        let [from, to] = [pair[0], pair[1]];
        gaps.push([time[from + 1], time[to - 1]]);
        let slope = (values[to] - values[from]) / (time[to] - time[from]);
        for k in from + 1..to {
            values[k] = values[from] + slope * (time[k] - time[from]);
        }
    }
    gaps.sort_by(|a, b| a[0].total_cmp(&b[0]));
    Ok(gaps)
}

/// The `values` at the times `clock` of a channel's own, which is late by its delay, at the times of all.
fn moved(column: &Column, clock: Vec<f64>, values: &[f64], time: &[f64]) -> Result<Vec<f64>, String> {
    if clock.windows(2).any(|pair| pair[1] <= pair[0]) {
        return Err(format!("the times of {} do not increase", column.name));
    }
    let clock: Vec<f64> = clock.iter().map(|t| t - column.delay).collect();
    let curve = MonotoneCubic::new(&clock, values);
    Ok(time.iter().map(|t| curve.at(*t)).collect())
}

/// The curve that follows from what a column measures: a velocity is the integral of an acceleration by the trapezoidal rule, from 0; a force
/// the rate of an impulse, by differences over two intervals.
fn derived(measures: Measures, time: &[f64], values: Vec<f64>) -> Vec<f64> {
    match measures {
        Measures::Acceleration => {
            let mut sum = 0.0;
            let step = |k: usize| 0.5 * (time[k] - time[k - 1]) * (values[k] + values[k - 1]);
            (0..values.len())
                .map(|k| {
                    sum += if k == 0 { 0.0 } else { step(k) };
                    sum
                })
                .collect()
        }
        Measures::Impulse => {
            let last = values.len() - 1;
            let rate = |k: usize| {
                let [from, to] = [k.saturating_sub(1), (k + 1).min(last)];
                (values[to] - values[from]) / (time[to] - time[from])
            };
            (0..=last).map(rate).collect()
        }
        _ => values,
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
