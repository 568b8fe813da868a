//! Signals over one time axis: what is missing is filled, what has a clock of its own is moved, what a curve follows from becomes the curve.

use super::column::{Column, Measures};
use crate::curves::MonotoneCubic;

/// Most samples: a second at 20 MHz.
pub(super) const MOST: usize = 20_000_000;

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

/// What a file says of a signal.
pub(super) struct ReadSignal<'c> {
    pub column: &'c Column,
    /// In its SI unit, not a number where they are missing.
    pub values: Vec<f64>,
    /// Times of its own, s; none: those of all.
    pub clock: Option<Vec<f64>>,
}

/// The curves of `signals` at the times `time`, `fewest` at least.
///
/// # Errors
/// One sentence with the signal.
pub(super) fn columns(time: Vec<f64>, signals: Vec<ReadSignal>, fewest: usize) -> Result<Columns, String> {
    let samples = time.len();
    if samples < fewest {
        return Err(format!("has {samples} samples; at least {fewest} are needed"));
    }
    let (mut values, mut gaps, mut integrals) = (Vec::new(), Vec::new(), Vec::new());
    for ReadSignal { column, values: mut own, clock } in signals {
        let missing = filled(column.name, clock.as_deref().unwrap_or(&time), &mut own)?;
        gaps.extend(missing.into_iter().map(|span| (column.name, span)));
        if clock.is_some() || column.delay != 0.0 {
            own = moved(column, clock.unwrap_or_else(|| time.clone()), &own, &time)?;
        }
        if column.measures == Measures::Acceleration {
            integrals.push(column.name);
        }
        values.push((column.name, derived(column.measures, &time, own)));
    }
    Ok(Columns { time, values, gaps, integrals })
}

/// Fills what is missing of `values` by straight lines; where that was.
fn filled(name: &str, time: &[f64], values: &mut [f64]) -> Result<Vec<[f64; 2]>, String> {
    if values.iter().all(|value| value.is_finite()) {
        return Ok(Vec::new());
    }
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
