//! What the free flight of a signal contains besides offset, drift and the step of the impact: a further strike or stop, the decay
//! of an AC-coupled sensor, hum of the mains, a drift that is not constant.

use super::flight::{FreeFlight, Grouped};
use crate::numerics::stationary_noise::{SignalFit, orthonormal};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Frequencies of the mains and their first harmonics in Hz.
const MAINS: [f64; 8] = [50.0, 60.0, 100.0, 120.0, 150.0, 180.0, 250.0, 300.0];
/// Part of a period that a flight has to last to show a hum.
const LEAST_PERIOD: f64 = 0.5;
/// Groups on either side of a further impact.
const MARGIN: usize = 3;
/// Standard errors from which on a disturbance counts as found, and its size over the step of the impact: the efficiency changes by twice that.
const SIGNIFICANT: f64 = 7.0;
const LEAST_SIZE: f64 = 0.002;
/// Part of the squares left by a simpler explanation that a hum, which adapts to much, must not exceed.
const BETTER: f64 = 0.7;

/// What disturbs a free flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Disturbance {
    /// The velocity changes again: by `change` m/s, about `time` and not before `earliest`, s from the first touch.
    Event { time: f64, earliest: f64, change: f64 },
    /// The signal decays with this time constant in s.
    AcCoupled { time_constant: f64 },
    /// A vibration.
    Hum(Hum),
    /// The slope changes by this much over the record, in the signal's unit per second.
    Curved { change: f64 },
}

/// A vibration, times in s from the first touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hum {
    /// Hz.
    pub frequency: f64,
    /// Amplitudes of sine and cosine, in the signal's unit.
    pub parts: [f64; 2],
}

impl Hum {
    pub fn at(&self, time: f64) -> f64 {
        let (sine, cosine) = (2.0 * PI * self.frequency * time).sin_cos();
        self.parts[0] * sine + self.parts[1] * cosine
    }
}

/// A possible disturbance with the columns that describe it.
struct DisturbanceCandidate {
    kind: Disturbance,
    columns: DMatrix<f64>,
}

impl FreeFlight {
    /// The disturbance that explains most of what the fit leaves, if it is significant. `bandwidth` in Hz.
    pub fn disturbance(&self, bandwidth: f64) -> Option<Disturbance> {
        let grouped = self.grouped(bandwidth);
        let basis = self.basis(&grouped.time, grouped.segments[0].end);
        if self.after.is_empty() || grouped.time.len() < basis.ncols() + 2 * MARGIN {
            return None;
        }
        let space = orthonormal(&basis);
        let left = &grouped.values - &space * space.tr_mul(&grouped.values);
        let remains = |candidate: &DisturbanceCandidate| {
            let columns = &candidate.columns - &space * space.tr_mul(&candidate.columns);
            let directions = orthonormal(&columns);
            let rest = left.norm_squared() - directions.tr_mul(&left).norm_squared();
            if matches!(candidate.kind, Disturbance::Hum(_)) { rest / BETTER } else { rest }
        };
        let best = self
            .candidates(&grouped)
            .into_iter()
            .map(|candidate| (remains(&candidate), candidate))
            .min_by(|a, b| a.0.total_cmp(&b.0))?
            .1;
        let first = basis.ncols();
        let mut columns: Vec<DVector<f64>> = basis.column_iter().map(Into::into).collect();
        columns.extend(best.columns.column_iter().map(Into::<DVector<f64>>::into));
        let found =
            SignalFit::of((&grouped.time, &grouped.values), &DMatrix::from_columns(&columns), bandwidth)?;
        let new: Vec<usize> = (first..columns.len()).collect();
        let significance =
            (new.iter().map(|k| found.significance(*k).powi(2)).sum::<f64>() / new.len() as f64).sqrt();
        // what the disturbance adds to the values, over the change that the impact makes in them
        let added = new.iter().map(|k| &columns[*k] * found.coefficients[*k]).sum::<DVector<f64>>();
        let size = added.max() - added.min();
        let impact = &columns[first - 1] * found.coefficients[first - 1];
        if !(significance > SIGNIFICANT && size > LEAST_SIZE * (impact.max() - impact.min())) {
            return None;
        }
        let of = |k: usize| found.coefficients[first + k];
        Some(match best.kind {
            Disturbance::Event { time, earliest, .. } => Disturbance::Event { time, earliest, change: of(0) },
            // a signal that grows by itself is no sensor's
            Disturbance::AcCoupled { .. } if of(0) > 0.0 => return None,
            Disturbance::AcCoupled { .. } => Disturbance::AcCoupled { time_constant: -1.0 / of(0) },
            Disturbance::Hum(Hum { frequency, .. }) => {
                Disturbance::Hum(Hum { frequency, parts: [of(0), of(1)] })
            }
            Disturbance::Curved { .. } => {
                let length = grouped.time[grouped.time.len() - 1] - grouped.time[0];
                Disturbance::Curved { change: 2.0 * of(0) * length }
            }
        })
    }

    /// Takes a vibration out of the samples.
    pub fn subtract(&mut self, hum: &Hum) {
        for (time, value) in self.before.iter_mut().chain(&mut self.after) {
            *value -= hum.at(*time);
        }
    }

    fn candidates(&self, grouped: &Grouped) -> Vec<DisturbanceCandidate> {
        let Grouped { time, values, segments: [early, late], width } = grouped;
        let count = time.len();
        let column = |kind, of: &dyn Fn(usize) -> f64| DisturbanceCandidate {
            kind,
            columns: DMatrix::from_fn(count, 1, |k, _| of(k)),
        };
        let mut found = vec![column(Disturbance::Curved { change: 0.0 }, &|k| time[k].powi(2))];
        for first in late.start + MARGIN..late.end.saturating_sub(MARGIN) {
            let start = time[first] - 0.5 * width;
            let of = |k: usize| match (k >= first, self.is_level) {
                (false, _) => 0.0,
                (true, true) => 1.0,
                (true, false) => time[k] - start,
            };
            let earliest = start - width;
            found.push(column(Disturbance::Event { time: start, earliest, change: 0.0 }, &of));
        }
        if self.is_level {
            // a high-pass of first order: true = signal + integral of the signal over the time constant
            let mut integral = vec![0.0; count];
            for k in 1..count {
                integral[k] = integral[k - 1] + 0.5 * (values[k] + values[k - 1]) * (time[k] - time[k - 1]);
            }
            found.push(column(Disturbance::AcCoupled { time_constant: 0.0 }, &|k| integral[k]));
        }
        let length = (time[early.end - 1] - time[0]).max(time[count - 1] - time[late.start]);
        for frequency in MAINS.into_iter().filter(|f| f * length > LEAST_PERIOD) {
            let columns = DMatrix::from_fn(count, 2, |k, j| {
                let parts = [[1.0, 0.0], [0.0, 1.0]][j];
                Hum { frequency, parts }.at(time[k])
            });
            found.push(DisturbanceCandidate {
                kind: Disturbance::Hum(Hum { frequency, parts: [0.0; 2] }),
                columns,
            });
        }
        found
    }
}
