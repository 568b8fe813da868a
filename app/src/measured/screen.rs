//! Faults that a record shows by itself: padding, clipped signals, missing samples.

use super::finding::{Finding, FindingKind};
use super::record::{Channel, Record};
use crate::format::{quantity, short};
use std::ops::Range;

/// Fewest equal samples at an end of a signal with noise that count as padding, and of zeros of all signals.
const PADDING: usize = 5;
const ZEROS: usize = 3;
/// Fewest equal samples at a limit of a signal.
const CLIPPED: usize = 8;
/// How much more often the limit is met than the value next to it.
const OFTENER: usize = 4;
/// Part of neighbouring samples that may be equal in a signal whose resolution shows its noise.
const EQUAL: f64 = 0.02;
/// Part of the samples at which the curvature changes its sign: more than a smooth course has.
const COARSE_SCALE: f64 = 0.08;
/// Fewest neighbouring samples from which that is judged.
const PAIRS: u32 = 20;
/// Jump of a signal into zeros that no body makes, over the signal's span.
const JUMP: f64 = 0.2;

/// The record without its padding, and what was found. `bandwidth` in Hz.
pub(super) fn screened(record: &Record, bandwidth: f64) -> (Record, Vec<Finding>) {
    let count = record.time.len();
    let [first, last] = padding(record);
    let mut findings = Vec::new();
    for (range, end) in [(0..first, "begins"), (count - last..count, "ends")] {
        if !range.is_empty() {
            findings.push(Finding::new(
                FindingKind::Padding,
                [record.time[range.start], record.time[range.end - 1]],
                format!(
                    "the record {end} with {} equal samples that nothing measured; they are not used",
                    range.len()
                ),
            ));
        }
    }
    let keep = first..count - last;
    let channels = record
        .channels
        .iter()
        .map(|channel| Channel { quantity: channel.quantity, values: channel.values[keep.clone()].to_vec() });
    let record = Record {
        time: record.time[keep.clone()].to_vec(),
        channels: channels.collect(),
        ..record.without_samples()
    };
    findings.extend(record.gaps.iter().map(|(name, [from, to])| {
        let effect = format!(
            "{name}: values are missing for {}; a straight line stands for them",
            quantity(to - from, "s", 3)
        );
        Finding::new(FindingKind::Gap, [*from, *to], effect)
    }));
    findings.extend(record.channels.iter().filter_map(|channel| clipped(&record.time, channel)));
    let longest = gap(&record.time, bandwidth);
    findings.extend(record.time.windows(2).filter(|pair| pair[1] - pair[0] > longest).map(|pair| {
        let effect = format!(
            "no samples for {}: what happened there is not seen, a change of the velocities within it is taken for the impact",
            quantity(pair[1] - pair[0], "s", 3)
        );
        Finding::new(FindingKind::Gap, [pair[0], pair[1]], effect)
    }));
    (record, findings)
}

/// Numbers of padded samples at the beginning and at the end.
fn padding(record: &Record) -> [usize; 2] {
    let count = record.time.len();
    let mut found = [0; 2];
    for (end, found) in found.iter_mut().enumerate() {
        let place = |k: usize| if end == 0 { k } else { count - 1 - k };
        let run = |values: &[f64]| (0..count).take_while(|k| values[place(*k)] == values[place(0)]).count();
        for channel in &record.channels {
            let length = run(&channel.values);
            let range = if end == 0 { 0..length } else { count - length..count };
            // at a limit of the signal it is rather clipped
            let (low, high) = extremes(&channel.values);
            let is_inside = (low..high).contains(&channel.values[place(0)]) && channel.values[place(0)] > low;
            if is_inside
                && (PADDING..count).contains(&length)
                && shows_noise(&channel.values, |k| range.contains(&k))
            {
                *found = length.max(*found);
            }
        }
        // without noise only a jump of the signals tells
        let zeros = record
            .channels
            .iter()
            .map(|channel| (0..count).take_while(|k| channel.values[place(*k)] == 0.0).count());
        let zeros = zeros.min().unwrap_or(0);
        let jumps = |channel: &Channel| channel.values[place(zeros)].abs() > JUMP * span(&channel.values);
        if (ZEROS..count).contains(&zeros) && record.channels.iter().any(jumps) {
            *found = zeros.max(*found);
        }
    }
    if found[0] + found[1] < count { found } else { [0; 2] }
}

fn span(values: &[f64]) -> f64 {
    let (low, high) = extremes(values);
    high - low
}

/// Least and largest value.
pub(crate) fn extremes(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)))
}

/// Step between two values that the instrument gives: the smallest distance of different ones; 0 if there is one value alone.
pub(super) fn resolution(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let steps = sorted.windows(2).map(|pair| pair[1] - pair[0]);
    steps.filter(|step| *step > 0.0).reduce(f64::min).unwrap_or(0.0)
}

/// Samples of a record, at times `time` in s, after which noise limited to `bandwidth` in Hz is another one: a quarter of its period.
pub(super) fn independent(time: &[f64], bandwidth: f64) -> usize {
    let interval = (time[time.len() - 1] - time[0]) / time.len() as f64;
    (1.0 / (4.0 * bandwidth * interval)).round().max(1.0) as usize
}

/// Median size of the second differences of values that are `spacing` samples apart: of noise, as courses and disturbances are smooth, and
/// jumps are few.
pub(super) fn roughness(values: &[f64], spacing: usize) -> f64 {
    let bend = |k: usize| (values[k] - 2.0 * values[k - spacing] + values[k - 2 * spacing]).abs();
    let mut bends: Vec<f64> = (2 * spacing..values.len()).map(bend).collect();
    bends.sort_by(f64::total_cmp);
    bends.get(bends.len() / 2).copied().unwrap_or(0.0)
}

/// Whether the signal has noise that its resolution shows, apart from the samples `omitted`: equal ones are then no chance.
fn shows_noise(values: &[f64], omitted: impl Fn(usize) -> bool) -> bool {
    let (mut pairs, mut equal, mut bends, mut last) = (0, 0, 0, 0.0);
    for k in 2..values.len() {
        if omitted(k) || omitted(k - 1) || omitted(k - 2) {
            continue;
        }
        pairs += 1;
        equal += usize::from(values[k] == values[k - 1]);
        let bend = values[k] - 2.0 * values[k - 1] + values[k - 2];
        bends += usize::from(bend * last < 0.0);
        last = bend;
    }
    let part = |count: usize| count as f64 / f64::from(pairs);
    pairs >= PAIRS && part(equal) < EQUAL && part(bends) > COARSE_SCALE
}

fn clipped(time: &[f64], channel: &Channel) -> Option<Finding> {
    let values = &channel.values;
    let (low, high) = extremes(values);
    // a body at rest in a computed record is at 0, which is no limit of an instrument
    [low, high].into_iter().filter(|limit| *limit != 0.0).find_map(|limit| {
        let at_limit: Vec<usize> = (0..values.len()).filter(|k| values[*k] == limit).collect();
        let others = values.iter().copied().filter(|v| *v != limit);
        let next = others.min_by(|a, b| (a - limit).abs().total_cmp(&(b - limit).abs()))?;
        let neighbours = values.iter().filter(|v| **v == next).count();
        if at_limit.len() < CLIPPED.max(OFTENER * neighbours) || !shows_noise(values, |k| values[k] == low || values[k] == high) {
            return None;
        }
        let Range { start, end } = at_limit[0]..at_limit[at_limit.len() - 1];
        let effect = format!(
            "{}: {} samples have its extreme value of {}: the range of the instrument was exceeded, and offset, velocities and time of the first contact from this signal are wrong",
            channel.quantity,
            at_limit.len(),
            short(limit)
        );
        Some(Finding::new(FindingKind::Clipped, [time[start], time[end]], effect))
    })
}

/// Distance of samples from which on something is missing, s.
fn gap(time: &[f64], bandwidth: f64) -> f64 {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() {
        return f64::INFINITY;
    }
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    // several usual steps, and long enough to hide something the instrument would show
    (5.0 * usual).max(1.0 / bandwidth)
}
