//! The free flight of a signal before and after the impact: offset, drift, velocities with their standard errors.

use crate::numerics::least_squares::fit;
use crate::numerics::stationary_noise::{SignalFit, groups, means};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Fewest samples of a stretch of free flight.
pub(super) const FEWEST: usize = 8;
/// Groups of samples per period of the bandwidth, but so many over all of the free flight at least and at most: closer samples tell
/// nothing more of offset, drift and velocity.
const PER_PERIOD: f64 = 2.0;
const GROUPS: (f64, f64) = (12.0, 60.0);
/// Noise over the step between two values of a signal from which on it evens out their rounding.
const EVEN: f64 = 0.5;

/// Samples of one signal in free flight. Times in s from the first touch, values in SI.
#[derive(Debug, Clone)]
pub(super) struct FreeFlight {
    /// Whether the signal is constant in free flight, as a velocity or a force, or else a displacement.
    pub is_level: bool,
    pub before: Vec<(f64, f64)>,
    /// Empty where the record shows too little of it.
    pub after: Vec<(f64, f64)>,
}

/// What the free flight shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct FreeFlightFit {
    /// Value at the first touch without an impact, and slope: offset and drift of a velocity at rest.
    pub level: f64,
    pub slope: f64,
    /// Standard deviation of the samples about the fit.
    pub noise: f64,
    /// Change of the velocity by the impact.
    pub step: Option<f64>,
}

/// Standard errors, of which 1.96 are 95 %; the samples are not independent.
#[derive(Debug, Clone, Copy)]
pub(super) struct FlightErrors {
    /// Of the velocity before the impact, if the signal is trusted to have no offset.
    pub before: f64,
    /// Of the drift of a velocity; infinite, as `step`, without free flight after the impact.
    pub slope: f64,
    /// Of the change of the velocity by the impact.
    pub step: f64,
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
    /// Offset, drift and step; `None` if they can't be told apart.
    pub fn fitted(&self) -> Option<FreeFlightFit> {
        if self.is_level && self.after.is_empty() {
            // without free flight on the other side drift and contact can't be told apart
            let rows: Vec<([f64; 1], f64)> = self.before.iter().map(|(_, y)| ([1.0], *y)).collect();
            let found = fit(&rows)?;
            return Some(FreeFlightFit {
                level: found.coefficients[0],
                slope: 0.0,
                noise: found.deviation,
                step: None,
            });
        }
        if self.is_level {
            let row = |jump: f64| move |(t, y): &(f64, f64)| ([1.0, *t, jump], *y);
            let rows: Vec<([f64; 3], f64)> =
                self.before.iter().map(row(0.0)).chain(self.after.iter().map(row(1.0))).collect();
            let found = fit(&rows)?;
            let [level, slope, step] = found.coefficients;
            return Some(FreeFlightFit { level, slope, noise: found.deviation, step: Some(step) });
        }
        let line = |side: &[(f64, f64)]| {
            let rows: Vec<([f64; 2], f64)> = side.iter().map(|(t, y)| ([1.0, *t], *y)).collect();
            fit(&rows)
        };
        let before = line(&self.before)?;
        let [level, slope] = before.coefficients;
        let step = line(&self.after).map(|after| after.coefficients[1] - slope);
        Some(FreeFlightFit { level, slope, noise: before.deviation, step })
    }

    /// What the fit leaves of every sample: times in s from the first touch, values in SI.
    pub fn residuals(&self) -> Vec<(f64, f64)> {
        let sides = [&self.before, &self.after];
        if self.is_level {
            let Some(FreeFlightFit { level, slope, step, .. }) = self.fitted() else { return Vec::new() };
            let expected =
                |t: f64, late: bool| level + slope * t + if late { step.unwrap_or(0.0) } else { 0.0 };
            let of = |(side, late): (&Vec<(f64, f64)>, bool)| -> Vec<(f64, f64)> {
                side.iter().map(|(t, y)| (*t, y - expected(*t, late))).collect()
            };
            return sides.into_iter().zip([false, true]).flat_map(of).collect();
        }
        let of = |side: &Vec<(f64, f64)>| -> Vec<(f64, f64)> {
            let rows: Vec<([f64; 2], f64)> = side.iter().map(|(t, y)| ([1.0, *t], *y)).collect();
            let Some(found) = fit(&rows) else { return Vec::new() };
            let [level, slope] = found.coefficients;
            side.iter().map(|(t, y)| (*t, y - level - slope * t)).collect()
        };
        sides.into_iter().flat_map(of).collect()
    }

    /// Standard errors; `None` if there is too little free flight. `bandwidth` in Hz; `resolution` is the step between two values.
    pub fn errors(&self, bandwidth: f64, resolution: f64) -> Option<FlightErrors> {
        let Grouped { time, values, segments, .. } = self.grouped(bandwidth);
        let basis = self.basis(&time, segments[0].end);
        let before = if self.is_level { 0 } else { 1 };
        let found = if self.after.is_empty() { before + 1 } else { basis.ncols() };
        let SignalFit { errors, .. } =
            SignalFit::of((&time, &values), &basis.columns(0, found).into_owned(), bandwidth)?;
        let of = |k: usize| errors.get(k).copied().unwrap_or(f64::INFINITY);
        let noise = self.fitted()?.noise;
        let rounded = [&self.before, &self.after].map(|side| match noise < EVEN * resolution {
            true => self.rounding(side, resolution),
            false => 0.0,
        });
        Some(FlightErrors {
            before: of(before).hypot(rounded[0]),
            slope: of(1),
            step: of(basis.ncols() - 1).hypot(rounded[0].hypot(rounded[1])),
        })
    }

    /// Standard error of the velocity on one `side` whose values are rounded to steps of `resolution`, all in the same direction: of the level,
    /// or of both ends of a displacement.
    fn rounding(&self, side: &[(f64, f64)], resolution: f64) -> f64 {
        let error = resolution / 12.0_f64.sqrt();
        match (side.first(), side.last()) {
            (Some(first), Some(last)) if !self.is_level && last.0 > first.0 => {
                2.0_f64.sqrt() * error / (last.0 - first.0)
            }
            _ => error,
        }
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
        if self.is_level {
            return DMatrix::from_fn(time.len(), 3, |k, j| [1.0, time[k], late(k)][j]);
        }
        DMatrix::from_fn(time.len(), 4, |k, j| [1.0, time[k], late(k), late(k) * time[k]][j])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biquad::{Biquad, Coefficients, DirectForm2Transposed, Q_BUTTERWORTH_F64, ToHertz, Type};
    use std::f64::consts::PI;

    const BANDWIDTH: f64 = 100e3;
    const SAMPLING: f64 = 2e6;
    const STEP: f64 = -0.46;

    /// Order and -3 dB frequency in Hz of the low-pass filter that limits the noise; white without.
    type Filter = Option<(u8, f64)>;

    /// Normally distributed (Box and Muller) noise with a standard deviation of 2 mm/s behind a `filter` of Butterworth.
    fn noise(random: &mut fastrand::Rng, filter: Filter, count: usize) -> Vec<f64> {
        let mut values: Vec<f64> = (0..count + 2000)
            .map(|_| 2e-3 * (-2.0 * (1.0 - random.f64()).ln()).sqrt() * (2.0 * PI * random.f64()).cos())
            .collect();
        let Some((order, corner)) = filter else { return values.split_off(2000) };
        let sections = (0..order / 2).map(|k| {
            let quality = 0.5 / (PI * f64::from(2 * k + 1) / f64::from(2 * order)).sin();
            (Type::LowPass, quality)
        });
        let single = (order % 2 == 1).then_some((Type::SinglePoleLowPass, Q_BUTTERWORTH_F64));
        for (kind, quality) in sections.chain(single) {
            let design = Coefficients::from_params(kind, SAMPLING.hz(), corner.hz(), quality);
            let mut section = DirectForm2Transposed::<f64>::new(design.expect("a filter"));
            values.iter_mut().for_each(|value| *value = section.run(*value));
        }
        // the power that passes: pi/2n / sin(pi/2n) times the corner
        let part = PI / f64::from(2 * order);
        let deviation = (part / part.sin() * 2.0 * corner / SAMPLING).sqrt();
        values[2000..].iter().map(|value| value / deviation).collect()
    }

    /// Free flight of the inner body of Table 1, `length` before the first touch and after the outer contact has ended.
    fn free_flight(length: f64, filter: Filter, seed: u64) -> FreeFlight {
        let mut random = fastrand::Rng::with_seed(seed);
        let count = ((200e-6 + 2.0 * length) * SAMPLING) as usize;
        let noise = noise(&mut random, filter, count);
        let sample = |k: usize| (k as f64 / SAMPLING - length, noise[k]);
        FreeFlight {
            is_level: true,
            before: (0..count).map(sample).filter(|(t, _)| *t < -10e-6).collect(),
            after: (0..count).map(sample).filter(|(t, _)| *t > 103e-6).map(|(t, y)| (t, y + STEP)).collect(),
        }
    }

    /// Fails where the stated intervals do not hold the step in 92 to 98.5 % of many records of flights of a `length` in s, with noise
    /// that a filter (poles, Hz) limits. The share scatters by 0.6 to 1.1 % (short flights) and 1.1 to 1.5 %.
    fn assert_95_percent(length: f64, filter: Filter, records: u32) {
        let within = (0..u64::from(records)).filter(|seed| {
            let free = free_flight(length, filter, *seed);
            let step = free.fitted().and_then(|flight| flight.step).expect("a step");
            (step - STEP).abs() <= 1.96 * free.errors(BANDWIDTH, 0.0).expect("enough of it").step
        });
        let share = within.count() as f64 / f64::from(records);
        assert!((0.92..=0.985).contains(&share), "{length:e} s, {filter:?}: {share}");
    }

    /// Short and long flights; noise that is white, and that filters from a single pole to steep ones limit. A fit that takes all samples for
    /// independent states intervals that hold the step in 37 % at 100 kHz.
    #[test]
    fn intervals_of_95_percent_hold_the_step_in_95_percent_of_the_records() {
        assert_95_percent(40e-6, None, 400);
        assert_95_percent(40e-6, Some((8, 100e3)), 400);
        assert_95_percent(300e-6, Some((2, 100e3)), 200);
    }

    /// That fit would hold it in 7 %.
    #[test]
    fn intervals_of_95_percent_hold_the_step_under_slow_noise() {
        assert_95_percent(40e-6, Some((1, 20e3)), 1200);
        assert_95_percent(40e-6, Some((8, 20e3)), 400);
        assert_95_percent(300e-6, Some((1, 20e3)), 400);
    }

    /// Noise far below the step between two values shows one value alone, or few: the interval holds the step all the same.
    #[test]
    fn intervals_hold_the_step_of_rounded_records() {
        let resolution = 10e-3;
        let within = (0..200).filter(|seed| {
            let mut free = free_flight(300e-6, None, *seed);
            // the level lies anywhere between two values
            let level = fastrand::Rng::with_seed(*seed).f64() * resolution;
            for (_, value) in free.before.iter_mut().chain(&mut free.after) {
                *value = ((*value + level) / resolution).round() * resolution;
            }
            let step = free.fitted().and_then(|flight| flight.step).expect("a step");
            (step - STEP).abs() <= 1.96 * free.errors(BANDWIDTH, resolution).expect("enough of it").step
        });
        assert!(within.count() >= 190);
    }

    #[test]
    fn undisturbed_flights_show_no_disturbance() {
        for (length, filter) in [
            (40e-6, None),
            (40e-6, Some((1, 20e3))),
            (40e-6, Some((8, 20e3))),
            (300e-6, Some((2, 100e3))),
            (300e-6, Some((1, 20e3))),
            (300e-6, Some((8, 20e3))),
        ] {
            let alarms =
                (0..50).filter(|seed| free_flight(length, filter, *seed).disturbance(BANDWIDTH).is_some());
            assert_eq!(alarms.count(), 0, "{length:e} s, {filter:?}");
        }
    }
}
