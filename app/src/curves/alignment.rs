//! Two histories with different time axes, brought onto a common one.

use super::MonotoneCubic;
use crate::result::{Curve, History, Outcome};
use serde::Serialize;

/// Samples of the common axis: about as many as a crash signal at 10 kHz has, for which
/// ISO/TS 18571 was made.
const SAMPLES: usize = 1501;

/// How far the window extends beyond the reference's last contact.
const WINDOW_FACTOR: f64 = 1.1;

/// Uniform time axis: `samples` instants from `start` to `end`, both included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CommonAxis {
    /// First instant in s.
    pub start: f64,
    /// Last instant in s.
    pub end: f64,
    /// Number of instants.
    pub samples: usize,
}

impl CommonAxis {
    /// The window of a comparison, fixed by the reference: from 0 to 1.1 times the end of its
    /// last contact, or to the end of its history if that comes first. `None` if the
    /// reference's history can't be sampled.
    pub fn of_reference(reference: &Outcome) -> Option<Self> {
        if !reference.history.can_be_sampled() {
            return None;
        }
        let last = *reference.history.time.last()?;
        let contact = reference.summary.last_contact().unwrap_or(0.0) * WINDOW_FACTOR;
        let end = if contact > 0.0 { contact.min(last) } else { last };
        (end > 0.0).then_some(CommonAxis { start: 0.0, end, samples: SAMPLES })
    }

    /// Instant number `k` in s.
    pub fn time(&self, k: usize) -> f64 {
        self.start + (self.end - self.start) * k as f64 / (self.samples - 1) as f64
    }

    /// The same axis, ending at `end` if it ended later.
    fn cut(self, end: f64) -> Self {
        CommonAxis { end: self.end.min(end), ..self }
    }
}

/// One curve of two histories on their common axis.
#[derive(Debug, Clone, PartialEq)]
pub struct AlignedCurve {
    /// Name of the curve.
    pub quantity: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// The axis: the reference's window, cut to what the reduced model covers.
    pub axis: CommonAxis,
    /// The reference. Shape (axis.samples).
    pub reference: Vec<f64>,
    /// The reduced model. Shape (axis.samples).
    pub reduced: Vec<f64>,
}

impl AlignedCurve {
    /// Largest magnitude of the reference.
    pub fn peak(&self) -> f64 {
        peak(&self.reference)
    }

    /// Root mean square of the difference.
    pub fn rms(&self) -> f64 {
        let sum: f64 = self.differences().map(|d| d * d).sum();
        (sum / self.axis.samples as f64).sqrt()
    }

    /// Largest magnitude of the difference; NaN if any is.
    pub fn largest_difference(&self) -> f64 {
        self.differences().map(f64::abs).fold(0.0, |a, b| if b <= a { a } else { b })
    }

    fn differences(&self) -> impl Iterator<Item = f64> {
        self.reduced.iter().zip(&self.reference).map(|(c, m)| c - m)
    }
}

/// Largest magnitude in `values`.
pub(crate) fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |p, v| p.max(v.abs()))
}

/// Every curve that both histories have on the reference's window `axis`; none if one can't be sampled.
///
/// Between samples the curves are interpolated by monotone cubics. If the reduced history ends
/// inside the window with both contacts open, the spheres fly on freely: constant velocity, no
/// force. The plate's curves are then compared up to the end of the reduced history; so are
/// all curves if it ends during a contact.
pub fn align(axis: CommonAxis, reference: &History, reduced: &History) -> Vec<AlignedCurve> {
    if !reference.can_be_sampled() || !reduced.can_be_sampled() {
        return Vec::new();
    }
    let given = |curve: &&Curve| reduced.curve(curve.name).is_some();
    let aligned = |&Curve { name: quantity, unit, .. }: &Curve| {
        let axis = axis.cut(covered_until(quantity, reduced));
        let of = |history: &History| sampled(quantity, history, &axis);
        (axis.end > axis.start).then(|| AlignedCurve {
            quantity,
            unit,
            axis,
            reference: of(reference),
            reduced: of(reduced),
        })
    };
    reference.curves.iter().filter(given).filter_map(aligned).collect()
}

/// One curve of a history on a common axis.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledCurve {
    /// Name of the curve.
    pub quantity: &'static str,
    /// Values; NaN where the history doesn't cover the axis, free flight of the spheres included.
    /// Shape (axis.samples).
    pub values: Vec<f64>,
}

/// Every curve of a history at the instants of `axis`; empty if it can't be sampled.
pub fn sample(axis: CommonAxis, history: &History) -> Vec<SampledCurve> {
    if !history.can_be_sampled() {
        return Vec::new();
    }
    let curve = |&Curve { name: quantity, .. }: &Curve| {
        let end = covered_until(quantity, history);
        let mut values = sampled(quantity, history, &axis);
        let beyond = (0..axis.samples).filter(|&k| axis.time(k) > end);
        beyond.for_each(|k| values[k] = f64::NAN);
        SampledCurve { quantity, values }
    };
    history.curves.iter().map(curve).collect()
}

/// Time in s up to which a curve is known, free flight included.
fn covered_until(quantity: &str, history: &History) -> f64 {
    let end = history.time.last().copied().unwrap_or(f64::NAN);
    history.rate_after_end(quantity).map_or(end, |_| f64::INFINITY)
}

/// A curve of a history that can be sampled, at the instants of `axis`; after its end in free flight.
fn sampled(quantity: &str, history: &History, axis: &CommonAxis) -> Vec<f64> {
    let (Some(values), Some(&end)) = (history.curve(quantity), history.time.last()) else {
        return Vec::new();
    };
    let curve = MonotoneCubic::new(&history.time, values);
    let rate = history.rate_after_end(quantity).unwrap_or(0.0);
    let times = (0..axis.samples).map(|k| axis.time(k));
    times.map(|t| curve.at(t) + rate * (t - end).max(0.0)).collect()
}
