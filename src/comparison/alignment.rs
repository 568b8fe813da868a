//! Two histories with different time axes, brought onto a common one.

use super::interpolation::MonotoneCubic;
use crate::result::Curves;
use crate::result::Outcome;
use crate::result::Quantities;
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
    pub fn of_reference<Q: Quantities>(reference: &Outcome<Q>) -> Option<Self> {
        if !can_be_sampled(&reference.history) {
            return None;
        }
        let last = *reference.history.time().last()?;
        let contact = reference.summary.quantities.last_contact() * WINDOW_FACTOR;
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
    /// Name in [`Curves::NAMES`].
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
pub(super) fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |p, v| p.max(v.abs()))
}

/// Whether every curve has a finite value at every instant and time increases strictly.
pub(super) fn can_be_sampled<H: Curves>(history: &H) -> bool {
    let n = history.time().len();
    let whole = |values: &[f64]| values.len() == n && values.iter().all(|v| v.is_finite());
    n >= 2
        && whole(history.time())
        && history.time().windows(2).all(|w| w[0] < w[1])
        && H::NAMES.iter().all(|(name, _)| history.values(name).is_some_and(whole))
}

/// Every curve of both histories on the reference's window `axis`; empty if one can't be sampled.
///
/// Between samples the curves are interpolated by monotone cubics. If the reduced history ends
/// inside the window with both contacts open, the spheres fly on freely: constant velocity, no
/// force. The plate's curves are then compared up to the end of the reduced history; so are
/// all curves if it ends during a contact.
pub fn align<H: Curves>(axis: CommonAxis, reference: &H, reduced: &H) -> Vec<AlignedCurve> {
    if !can_be_sampled(reference) || !can_be_sampled(reduced) {
        return Vec::new();
    }
    let aligned = |&(quantity, unit): &(&'static str, &'static str)| {
        let axis = axis.cut(covered_until(quantity, reduced));
        let of = |history: &H| sampled(quantity, history, &axis);
        (axis.end > axis.start).then(|| AlignedCurve {
            quantity,
            unit,
            axis,
            reference: of(reference),
            reduced: of(reduced),
        })
    };
    H::NAMES.iter().filter_map(aligned).collect()
}

/// One curve of a history on a common axis.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledCurve {
    /// Name in [`Curves::NAMES`].
    pub quantity: &'static str,
    /// Values; NaN where the history doesn't cover the axis, free flight of the spheres included.
    /// Shape (axis.samples).
    pub values: Vec<f64>,
}

/// Every curve of a history at the instants of `axis`; empty if it can't be sampled.
pub fn sample<H: Curves>(axis: CommonAxis, history: &H) -> Vec<SampledCurve> {
    if !can_be_sampled(history) {
        return Vec::new();
    }
    let curve = |&(quantity, _): &(&'static str, &'static str)| {
        let end = covered_until(quantity, history);
        let mut values = sampled(quantity, history, &axis);
        let beyond = (0..axis.samples).filter(|&k| axis.time(k) > end);
        beyond.for_each(|k| values[k] = f64::NAN);
        SampledCurve { quantity, values }
    };
    H::NAMES.iter().map(curve).collect()
}

/// Time in s up to which a curve is known, free flight included.
fn covered_until<H: Curves>(quantity: &str, history: &H) -> f64 {
    let end = history.time().last().copied().unwrap_or(f64::NAN);
    history.rate_after_end(quantity).map_or(end, |_| f64::INFINITY)
}

/// A curve of a history that can be sampled, at the instants of `axis`.
fn sampled<H: Curves>(quantity: &str, history: &H, axis: &CommonAxis) -> Vec<f64> {
    let (Some(values), Some(&end)) = (history.values(quantity), history.time().last()) else {
        return Vec::new();
    };
    let curve = MonotoneCubic::new(history.time(), values);
    let rate = history.rate_after_end(quantity).unwrap_or(0.0);
    (0..axis.samples).map(|k| axis.time(k)).map(|t| curve.at(t) + rate * (t - end).max(0.0)).collect()
}
