//! Records that are not impacts of their own.

use super::align::AlignedRecord;
use super::finding::{Finding, FindingKind};
use super::screen::{extremes, independent, resolution, roughness};
use crate::curves::MonotoneCubic;

/// Roughness of the difference of two records over that of one in free flight: of two impacts it is 1 at least, of a copy about 0.
const SAME: f64 = 0.7;
/// Noise over the span of a signal below which a record is a computed one, whose likeness shows nothing.
const LEAST_NOISE: f64 = 1e-5;
/// Noise in steps of the resolution below which its course is not seen.
const LEAST_STEPS: f64 = 0.5;

/// Adds a finding to each of `records` that repeats an earlier one, and to each that shows no inner body while another shows no outer
/// one: both belong to one impact.
pub(super) fn mark(records: &mut [AlignedRecord], bandwidth: f64) {
    let found: Vec<(bool, Option<Finding>)> = (0..records.len()).map(|k| of(records, k, bandwidth)).collect();
    for (record, (is_copy, finding)) in records.iter_mut().zip(found) {
        record.is_copy = is_copy;
        record.findings.extend(finding);
    }
}

/// Whether record number `k` is a copy, and what is wrong with it.
fn of(records: &[AlignedRecord], k: usize, bandwidth: f64) -> (bool, Option<Finding>) {
    let record = &records[k];
    let finding = |effect: String| {
        let clock = [0, record.time.len() - 1].map(|i| record.time[i] + record.shift);
        Finding::new(FindingKind::Duplicate, clock, effect)
    };
    if let Some(first) = records[..k].iter().find(|first| are_same(first, record, bandwidth)) {
        let effect =
            format!("the record is the same as {}, noise included; it is not used", first.file.display());
        return (true, Some(finding(effect)));
    }
    let gaps = |record: &AlignedRecord, body: &str| {
        record.signals.iter().all(|signal| !signal.quantity.starts_with(body))
    };
    let other = records.iter().find(|other| gaps(record, "inner") && gaps(other, "outer"));
    let effect = |other: &AlignedRecord| {
        finding(format!(
            "the record shows only the outer body and {} only the inner one: if that is one impact, put all signals into one file",
            other.file.display()
        ))
    };
    (false, other.map(effect))
}

fn are_same(a: &AlignedRecord, b: &AlignedRecord, bandwidth: f64) -> bool {
    // a copy may have some of the samples alone
    (a.time == b.time && a.signals == b.signals) || repeats(a, b, bandwidth) || repeats(b, a, bandwidth)
}

/// Whether the samples of `a` in free flight are those of `b` at the same times, noise included. What else both have in common, as the
/// decay of the same AC-coupled sensor, does not count.
fn repeats(a: &AlignedRecord, b: &AlignedRecord, bandwidth: f64) -> bool {
    let spacing = independent(&a.time, bandwidth);
    a.signals.len() == b.signals.len()
        && a.signals.iter().enumerate().all(|(k, signal)| {
            let (noise, residuals) = (&a.noise[k], &a.residuals[k]);
            let Some(other) = b.signals.iter().find(|other| other.quantity == signal.quantity) else {
                return false;
            };
            let (low, high) = extremes(&signal.values);
            let course = MonotoneCubic::new(&b.time, &other.values);
            let within = b.time[0]..b.time[b.time.len() - 1];
            let own = MonotoneCubic::new(&a.time, &signal.values);
            let (noises, differences): (Vec<f64>, Vec<f64>) = residuals
                .iter()
                .filter(|(t, _)| within.contains(t))
                .map(|(t, residual)| (*residual, own.at(*t) - course.at(*t)))
                .unzip();
            // noise below the step between two values is mostly that of their rounding, which any two records may share
            *noise > (LEAST_NOISE * (high - low)).max(LEAST_STEPS * resolution(&a.raw[k]))
                && roughness(&differences, spacing) < SAME * roughness(&noises, spacing)
        })
}
