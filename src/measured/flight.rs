//! The free flight of a signal before and after the impact: offset, drift, velocities with their standard errors.

use super::noise::{Estimate, groups, looks_white, means};
use crate::numerics::least_squares::fit;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Fewest samples of a stretch of free flight.
pub(super) const FEWEST: usize = 8;
/// Groups of samples per period of the bandwidth, but so many over all of the free flight at least and at most: closer samples tell
/// nothing more of offset, drift and velocity.
const PER_PERIOD: f64 = 2.0;
const GROUPS: (f64, f64) = (12.0, 80.0);

/// Samples of one signal in free flight. Times in s from the first touch, values in SI.
#[derive(Debug, Clone)]
pub(super) struct FreeFlight {
    /// Whether the signal is a velocity, or else a displacement.
    pub is_velocity: bool,
    pub before: Vec<(f64, f64)>,
    /// Empty where the record shows too little of it.
    pub after: Vec<(f64, f64)>,
}

/// What the free flight shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flight {
    /// Value at the first touch without an impact, and slope: offset and drift of a velocity at rest.
    pub level: f64,
    pub slope: f64,
    /// Standard deviation of the samples about the fit.
    pub noise: f64,
    /// Change of the velocity by the impact, with its standard error (1.96 of it are 95 %).
    pub step: Option<(f64, f64)>,
}

/// Means over groups of samples.
pub(super) struct Grouped {
    pub time: Vec<f64>,
    pub values: DVector<f64>,
    /// Before and after.
    pub segments: [Range<usize>; 2],
    /// Length of a group in s.
    pub width: f64,
}

impl FreeFlight {
    /// Offset, drift and step; `None` if they can't be told apart. `bandwidth` in Hz.
    pub fn fitted(&self, bandwidth: f64) -> Option<Flight> {
        if self.is_velocity && self.after.is_empty() {
            // without free flight on the other side drift and contact can't be told apart
            let rows: Vec<([f64; 1], f64)> = self.before.iter().map(|(_, y)| ([1.0], *y)).collect();
            let found = fit(&rows)?;
            return Some(Flight {
                level: found.coefficients[0],
                slope: 0.0,
                noise: found.scatter,
                step: None,
            });
        }
        if self.is_velocity {
            let row = |jump: f64| move |(t, y): &(f64, f64)| ([1.0, *t, jump], *y);
            let rows: Vec<([f64; 3], f64)> =
                self.before.iter().map(row(0.0)).chain(self.after.iter().map(row(1.0))).collect();
            let found = fit(&rows)?;
            let [level, slope, step] = found.coefficients;
            let course = |late: bool, t: f64| level + slope * t + if late { step } else { 0.0 };
            let error = self.error(course, found.errors[2], bandwidth);
            return Some(Flight { level, slope, noise: found.scatter, step: Some((step, error)) });
        }
        let line = |side: &[(f64, f64)]| {
            let rows: Vec<([f64; 2], f64)> = side.iter().map(|(t, y)| ([1.0, *t], *y)).collect();
            fit(&rows)
        };
        let before = line(&self.before)?;
        let [level, slope] = before.coefficients;
        let step = line(&self.after).map(|after| {
            let known = after.errors[1].hypot(before.errors[1]);
            let [late_level, late_slope] = after.coefficients;
            let course =
                |late: bool, t: f64| if late { late_level + late_slope * t } else { level + slope * t };
            (late_slope - slope, self.error(course, known, bandwidth))
        });
        Some(Flight { level, slope, noise: before.scatter, step })
    }

    /// Standard error of the step; `independent` if neither samples nor groups of them are correlated about the fitted `course`,
    /// before or after the impact at a time.
    fn error(&self, course: impl Fn(bool, f64) -> f64, independent: f64, bandwidth: f64) -> f64 {
        let side =
            |samples: &[(f64, f64)], late| samples.iter().map(|(t, y)| (*t, y - course(late, *t))).collect();
        let left = FreeFlight {
            is_velocity: self.is_velocity,
            before: side(&self.before, false),
            after: side(&self.after, true),
        };
        let samples: Vec<f64> = left.before.iter().chain(&left.after).map(|(_, y)| *y).collect();
        if looks_white(&samples) && looks_white(left.grouped(bandwidth).values.as_slice()) {
            return independent;
        }
        self.standard_error(if self.is_velocity { 2 } else { 3 }, bandwidth).unwrap_or(independent)
    }

    /// Standard error of the drift; `None` if there are too few groups.
    pub fn drift_error(&self, bandwidth: f64) -> Option<f64> {
        self.standard_error(1, bandwidth)
    }

    /// Standard error of the coefficient of a column of [`Self::basis`], the samples not being independent.
    fn standard_error(&self, column: usize, bandwidth: f64) -> Option<f64> {
        let Grouped { time, values, segments, .. } = self.grouped(bandwidth);
        let basis = self.basis(&time, segments[0].end);
        let found = Estimate::of((&time, &values), &basis, &segments, bandwidth)?;
        Some(found.covariance[(column, column)].max(0.0).sqrt())
    }

    pub fn grouped(&self, bandwidth: f64) -> Grouped {
        let length =
            |side: &[(f64, f64)]| side.last().map_or(0.0, |last| last.0) - side.first().map_or(0.0, |f| f.0);
        let length = length(&self.before) + length(&self.after);
        let width = (1.0 / (PER_PERIOD * bandwidth)).clamp(length / GROUPS.1, length / GROUPS.0);
        let (mut time, mut values) = (Vec::new(), Vec::new());
        let mut ends = [0; 2];
        for (side, end) in [&self.before, &self.after].into_iter().zip(&mut ends) {
            let (t, y): (Vec<f64>, Vec<f64>) = side.iter().copied().unzip();
            let groups = groups(&t, width);
            time.extend(means(&t, &groups));
            values.extend(means(&y, &groups));
            *end = time.len();
        }
        let [early, late] = ends;
        Grouped { time, values: DVector::from_vec(values), segments: [0..early, early..late], width }
    }

    /// Columns of a free flight at `time`, of which the first `before` are before the impact; the step of the velocity is the last.
    pub fn basis(&self, time: &[f64], before: usize) -> DMatrix<f64> {
        let late = |k: usize| if k < before { 0.0 } else { 1.0 };
        if self.is_velocity {
            return DMatrix::from_fn(time.len(), 3, |k, j| [1.0, time[k], late(k)][j]);
        }
        DMatrix::from_fn(time.len(), 4, |k, j| [1.0, time[k], late(k), late(k) * time[k]][j])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biquad::{Biquad, Coefficients, DirectForm2Transposed, Q_BUTTERWORTH_F64, ToHertz, Type};

    const BANDWIDTH: f64 = 100e3;
    const SAMPLING: f64 = 2e6;
    const STEP: f64 = -0.46;

    /// Normally distributed (Box and Muller) noise with a standard deviation of 2 mm/s, behind a filter of second order if it has a
    /// `corner` in Hz.
    fn noise(random: &mut fastrand::Rng, corner: Option<f64>, count: usize) -> Vec<f64> {
        let white: Vec<f64> = (0..count + 2000)
            .map(|_| {
                (-2.0 * (1.0 - random.f64()).ln()).sqrt() * (2.0 * std::f64::consts::PI * random.f64()).cos()
            })
            .collect();
        let Some(corner) = corner else { return white[2000..].iter().map(|w| 2e-3 * w).collect() };
        let design = Coefficients::from_params(Type::LowPass, SAMPLING.hz(), corner.hz(), Q_BUTTERWORTH_F64);
        let mut filter = DirectForm2Transposed::<f64>::new(design.expect("a filter"));
        let filtered: Vec<f64> = white.into_iter().map(|w| filter.run(w)).collect();
        // its power is pi/2/sqrt(2) of the corner
        let deviation = (std::f64::consts::PI / 2.0_f64.sqrt() * corner / SAMPLING).sqrt();
        filtered[2000..].iter().map(|w| 2e-3 * w / deviation).collect()
    }

    /// Free flight of the inner body of Table 1, `length` before the first touch and after the outer contact has ended.
    fn free_flight(length: f64, corner: Option<f64>, seed: u64) -> FreeFlight {
        let mut random = fastrand::Rng::with_seed(seed);
        let count = ((200e-6 + 2.0 * length) * SAMPLING) as usize;
        let noise = noise(&mut random, corner, count);
        let sample = |k: usize| (k as f64 / SAMPLING - length, noise[k]);
        FreeFlight {
            is_velocity: true,
            before: (0..count).map(sample).filter(|(t, _)| *t < -10e-6).collect(),
            after: (0..count).map(sample).filter(|(t, _)| *t > 103e-6).map(|(t, y)| (t, y + STEP)).collect(),
        }
    }

    /// Short and long flights, noise that is white and that is limited to 100 and 20 kHz. A fit that takes all samples for
    /// independent states intervals that hold the step in 37 and 7 % there.
    #[test]
    fn intervals_of_95_percent_hold_the_step_in_95_percent_of_the_records() {
        for length in [40e-6, 300e-6] {
            for corner in [None, Some(100e3), Some(20e3)] {
                let within = (0..400).filter(|seed| {
                    let found = free_flight(length, corner, *seed).fitted(BANDWIDTH).expect("a fit");
                    let (step, error) = found.step.expect("a step");
                    (step - STEP).abs() <= 1.96 * error
                });
                let share = within.count() as f64 / 400.0;
                assert!((0.92..=0.985).contains(&share), "{length:e} s, {corner:?} Hz: {share}");
            }
        }
    }

    #[test]
    fn undisturbed_flights_show_no_disturbance() {
        for (length, corner) in
            [(40e-6, None), (40e-6, Some(20e3)), (300e-6, Some(100e3)), (300e-6, Some(20e3))]
        {
            let alarms =
                (0..50).filter(|seed| free_flight(length, corner, *seed).disturbance(BANDWIDTH).is_some());
            assert_eq!(alarms.count(), 0, "{length:e} s, {corner:?} Hz");
        }
    }
}
