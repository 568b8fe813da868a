//! The shift in time that lays a record over a model, and how well it does.

use super::align::Alignment;
use super::filter::Filtered;
use super::flight::FreeFlightFit;
use crate::error::{Error, Result};
use crate::numerics::least_squares::fit;
use argmin::core::{CostFunction, Executor, State};
use argmin::solver::brent::BrentOpt;
use std::ops::Range;

/// Most samples of a signal in the coarse search.
const COARSE_SAMPLES: usize = 300;
/// Part of a contact that the record has to show.
const RISE: f64 = 0.4;
/// Noise of a signal, relative to its span, that is assumed at least: models are not better than that.
const LEAST_NOISE: f64 = 0.01;

/// A shift on the grid of the coarse search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coarse {
    /// Time of the first touch on the record's clock, s.
    pub shift: f64,
    /// Distance from the model, root mean square over the spans of the signals.
    pub misfit: f64,
    /// Squares of the distances, and what is missing of the contacts.
    objective: f64,
}

impl Coarse {
    /// Whether this is a match and `other` is none.
    pub fn is_clearly_better(&self, other: &Coarse, worst: f64) -> bool {
        self.misfit < worst && self.objective < 0.25 * other.objective
    }
}

impl Alignment<'_> {
    /// Span of the model's curve over its contact: what distances are measured by.
    pub fn span(&self, quantity: &str) -> f64 {
        let Some(curve) = self.model.curve(quantity) else { return 1.0 };
        let contact = self.contact(quantity);
        let (start, end) = (contact.start, contact.end);
        let values = (0..=200).map(|k| curve(start + (end - start) * f64::from(k) / 200.0));
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        (high - low).max(f64::MIN_POSITIVE)
    }

    /// The shift on a grid that fits best when each of `signals`, by number, times `sign` may have any offset. A drift could make
    /// up for an impact that is not there.
    pub fn coarse(&self, signals: &[usize], sign: f64) -> Coarse {
        let time = &self.record.time;
        let (first, last) = (time[0], time[time.len() - 1]);
        let step = 1.0 / (8.0 * self.bandwidth);
        let count = ((last - first) / step).ceil() as usize;
        let channels = || signals.iter().map(|k| &self.record.channels[*k]);
        let spans: Vec<f64> = channels().map(|c| self.span(c.quantity)).collect();
        let mut best = Coarse { shift: first, misfit: 1.0, objective: f64::INFINITY };
        for k in 1..count {
            let shift = first + step * k as f64;
            let (mut squares, mut missing) = (0.0, 0.0);
            for (channel, span) in channels().zip(&spans) {
                let Some(curve) = self.model.curve(channel.quantity) else { continue };
                let end = self.contact(channel.quantity).end;
                let window = self.around(shift, end);
                let stride = window.len().div_ceil(COARSE_SAMPLES).max(1);
                let rows: Vec<([f64; 1], f64)> = window
                    .step_by(stride)
                    .map(|i| ([1.0], sign * channel.values[i] - curve(time[i] - shift)))
                    .collect();
                squares += fit(&rows).map_or(1.0, |found| (found.deviation / span).powi(2));
                // without its rise an impact looks like free flight, of which there is plenty
                missing += 1.0 - ((last - shift) / (RISE * end)).min(1.0);
            }
            if squares + missing < best.objective {
                let misfit = (squares / signals.len() as f64).sqrt();
                best = Coarse { shift, misfit, objective: squares + missing };
            }
        }
        best
    }

    /// The samples around an impact at `shift` with a contact of the length `end`: some before and some after.
    fn around(&self, shift: f64, end: f64) -> Range<usize> {
        let time = &self.record.time;
        time.partition_point(|t| *t < shift - end)..time.partition_point(|t| *t < shift + 2.0 * end)
    }

    /// The shift within `reach` of `shift` that fits best when each of `signals`, by number, may have any offset, drift and
    /// amplitude, and the squares of the distances over the noise before and after.
    pub fn refined(
        &self,
        signals: &[usize],
        shift: f64,
        reach: f64,
        flights: &[FreeFlightFit],
    ) -> Result<(f64, [f64; 2])> {
        let mut around = Vec::new();
        for k in signals {
            let channel = &self.record.channels[*k];
            let window = self.around(shift, self.contact(channel.quantity).end);
            let points = window.map(|i| (self.record.time[i] - shift, channel.values[i])).collect();
            let scale = flights[*k].noise.hypot(LEAST_NOISE * self.span(channel.quantity));
            around.push(ShiftedSignal { quantity: channel.quantity, scale, points });
        }
        let misfit = Misfit { model: self.model, signals: &around };
        let failed = |e: argmin::core::Error| Error::Internal(format!("Brent's method: {e}"));
        let before = misfit.cost(&0.0).map_err(failed)?;
        let solver = BrentOpt::new(-reach, reach).set_tolerance(1e-9, 1e-12);
        let result =
            Executor::new(misfit, solver).configure(|state| state.max_iters(60)).run().map_err(failed)?;
        let further = result.state().get_best_param().copied().unwrap_or(0.0);
        Ok((shift + further, [before, result.state().get_best_cost()]))
    }
}

/// One signal around the impact.
struct ShiftedSignal {
    quantity: &'static str,
    /// What its distances are measured by.
    scale: f64,
    /// Time from the shift that is tried around, and value.
    points: Vec<(f64, f64)>,
}

/// Squared distance of all signals from the model as a function of a further shift.
struct Misfit<'a> {
    model: &'a Filtered,
    signals: &'a [ShiftedSignal],
}

impl CostFunction for Misfit<'_> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, further: &f64) -> std::result::Result<f64, argmin::core::Error> {
        let mut total = 0.0;
        for ShiftedSignal { quantity, scale, points } in self.signals {
            let Some(curve) = self.model.curve(quantity) else { continue };
            let row = |(t, y): &(f64, f64)| ([1.0, *t, curve(t - further)], *y);
            let rows: Vec<([f64; 3], f64)> = points.iter().map(row).collect();
            total += fit(&rows).map_or(rows.len() as f64, |found| {
                (rows.len() - 3) as f64 * (found.deviation / scale).powi(2)
            });
        }
        Ok(total)
    }
}
