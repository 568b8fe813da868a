//! Differences of a model from records, without the offset and drift that the instruments have.

use crate::measured::screen::extremes;
use crate::measured::{AlignedRecord, Channel, Filtered, Speed};
use crate::numerics::stationary_noise::{Noise, groups, means, orthonormal};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Groups of samples per period of the bandwidth: samples are compared by their means.
const PER_PERIOD: f64 = 2.0;
/// Groups of free flight on either side of the impact that are compared at most.
const FREE_FLIGHT: f64 = 100.0;

/// One signal of a record.
struct Signal {
    record: usize,
    quantity: &'static str,
    /// Samples: time in s from the first touch, value.
    time: Vec<f64>,
    values: Vec<f64>,
    groups: Vec<Range<usize>>,
    /// Mean time of every group.
    means: Vec<f64>,
    /// What its difference is measured by.
    span: f64,
    /// Orthonormal courses that offset and drift give to the groups.
    nuisance: DMatrix<f64>,
}

/// The signals of all records.
pub(super) struct Signals {
    signals: Vec<Signal>,
    bandwidth: f64,
}

impl Signals {
    /// Of `records` taken with a `bandwidth` in Hz, around an impact that lasts until `end` in s from the first touch.
    pub fn of(records: &[AlignedRecord], end: f64, (bandwidth, speed): (f64, Speed)) -> Self {
        let width = 1.0 / (PER_PERIOD * bandwidth);
        let margin = FREE_FLIGHT * width;
        let of = |(k, record, channel, last): (usize, &AlignedRecord, &Channel, f64)| {
            let inside = -margin..(end + margin).min(last);
            let (time, values): (Vec<f64>, Vec<f64>) =
                record.time.iter().zip(&channel.values).filter(|(t, _)| inside.contains(t)).unzip();
            let groups = groups(&time, width);
            let means = means(&time, &groups);
            let (low, high) = extremes(&values);
            // a trusted velocity has no offset: of a displacement then only the offset is unknown, of a velocity the drift
            let trusted = channel.quantity.starts_with("outer") && speed == Speed::Measured;
            let powers: &[i32] = match (trusted, channel.quantity.ends_with("velocity")) {
                (false, _) => &[0, 1],
                (true, true) => &[1],
                (true, false) => &[0],
            };
            let unknown = |i: usize, j: usize| (means[i] * bandwidth).powi(powers[j]);
            let scaled = DMatrix::from_fn(means.len(), powers.len(), unknown);
            let nuisance = orthonormal(&scaled);
            let span = (high - low).max(f64::MIN_POSITIVE);
            Signal { record: k, quantity: channel.quantity, time, values, groups, means, span, nuisance }
        };
        let each = records.iter().enumerate().flat_map(|(k, record)| {
            record.signals.iter().zip(&record.ends).map(move |(channel, last)| (k, record, channel, *last))
        });
        Signals { signals: each.map(of).filter(|signal| signal.means.len() > 2).collect(), bandwidth }
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.signals.iter().map(|signal| signal.time.len()).sum()
    }

    /// Differences of the groups, over the signals' spans and without what offset and drift may explain; every record is later by its
    /// one of `shifts` in s.
    pub fn differences(&self, model: &Filtered, shifts: &[f64]) -> Option<Vec<f64>> {
        let mut all = Vec::new();
        for signal in &self.signals {
            let curve = model.curve(signal.quantity)?;
            let shift = shifts[signal.record];
            let samples: Vec<f64> = signal
                .time
                .iter()
                .zip(&signal.values)
                .map(|(t, value)| (curve(t - shift) - value) / signal.span)
                .collect();
            let differences = DVector::from_vec(means(&samples, &signal.groups));
            let left = &differences - &signal.nuisance * signal.nuisance.tr_mul(&differences);
            all.extend(left.iter());
        }
        Some(all)
    }

    /// Covariance of the differences, signal by signal, from what a fit with these `slopes` has `left` of them. `None` if they are too few.
    pub fn covariance(&self, left: &DVector<f64>, slopes: &DMatrix<f64>) -> Option<Vec<DMatrix<f64>>> {
        let mut start = 0;
        let mut blocks = Vec::new();
        for Signal { means, nuisance, .. } in &self.signals {
            let count = means.len();
            let of_fit = slopes.rows(start, count);
            let basis = DMatrix::from_fn(count, nuisance.ncols() + of_fit.ncols(), |i, j| {
                if j < nuisance.ncols() { nuisance[(i, j)] } else { of_fit[(i, j - nuisance.ncols())] }
            });
            let values = left.rows(start, count).into_owned();
            blocks.push(Noise::of((means, &values), &basis, self.bandwidth)?.covariance(count));
            start += count;
        }
        Some(blocks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds::plate_impact::CURVES;
    use crate::measured::BANDWIDTH;
    use crate::result::History;

    /// Largest difference of an impact, from a signal of it to which `added` (of time in s) is added, over the span.
    fn largest(quantity: &'static str, speed: Speed, added: impl Fn(f64) -> f64) -> f64 {
        let time: Vec<f64> = (0..400).map(|k| -100e-6 + 1e-6 * f64::from(k)).collect();
        let mut history = History::new(&CURVES);
        for t in &time {
            // the bodies exchange their velocities within 100 us
            let after = (t / 100e-6).clamp(0.0, 1.0);
            let [outer, inner] = [-0.55 * (1.0 - after), -0.55 * after];
            history.push(*t, [outer * t, 0.0, inner * t, outer, 0.0, inner, 0.0, 0.0]);
        }
        let model = Filtered::new(&history, BANDWIDTH).unwrap();
        let curve = model.curve(quantity).unwrap();
        let values = time.iter().map(|t| curve(*t) + added(*t)).collect();
        let record = AlignedRecord {
            file: "synthetic.csv".into(),
            samples: time.len(),
            shift: 0.0,
            channels: Vec::new(),
            outer_velocity_initial: -0.55,
            inner_velocity_final: None,
            efficiency: None,
            efficiency_uncertainty: None,
            restitution: None,
            restitution_uncertainty: None,
            findings: Vec::new(),
            is_copy: false,
            noise: vec![0.0],
            ends: vec![f64::INFINITY],
            signals: vec![Channel { quantity, values }],
            raw: Vec::new(),
            residuals: Vec::new(),
            time,
        };
        let signals = Signals::of(&[record], 100e-6, (BANDWIDTH, speed));
        let differences = signals.differences(&model, &[0.0]).unwrap();
        differences.iter().fold(0.0, |most, d| most.max(d.abs()))
    }

    /// Offset and drift of an instrument are no differences, and of a trusted signal what its velocity may still contain.
    #[test]
    fn instrument_offsets_are_eliminated() {
        for (quantity, speed, offset_counts, drift_counts) in [
            ("outer_velocity", Speed::Scene, false, false),
            ("outer_displacement", Speed::Scene, false, false),
            ("inner_velocity", Speed::Measured, false, false),
            ("outer_velocity", Speed::Measured, true, false),
            ("outer_displacement", Speed::Measured, false, true),
        ] {
            // a thousandth of the span and more
            let size = if quantity.ends_with("velocity") { 1e-2 } else { 1e-6 };
            let offset = largest(quantity, speed, |_| size);
            let drift = largest(quantity, speed, |t| size * t / 50e-6);
            for (what, largest, counts) in [("offset", offset, offset_counts), ("drift", drift, drift_counts)]
            {
                assert!(
                    if counts { largest > 1e-3 } else { largest < 1e-9 },
                    "{what} of {quantity}, {speed:?}: {largest}"
                );
            }
        }
    }
}
