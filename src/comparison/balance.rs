//! What a history must obey by itself: impulse changes momentum, velocity changes displacement.
//! An error in one curve that leaves the others alone breaks one of the two.

use super::alignment::peak;
use super::integrity::Check;
use crate::kinds::plate_impact::{Motion, PlateCurves};
use crate::result::Summary;
use crate::scene::PlateImpact;

/// Share of the total impulse, and of the peak displacement, that a balance may miss beyond
/// what sampling explains.
const SLACK: f64 = 2e-3;
/// The same for the plate's centre, whose velocity may hold oscillations faster than the sampling.
const PLATE_SLACK: f64 = 0.05;

/// Checks of a history that can be sampled.
pub(super) fn check(setup: &PlateImpact, summary: &Summary, history: &PlateCurves) -> Vec<Check> {
    let mut checks = Vec::new();
    // Forces of a reference are averages over the sampling interval, which shifts them by up to one.
    let interval = summary.sample_interval.unwrap_or(0.0);
    let mut momentum = |name: &str, mass: f64, motion: Motion, force: &[f64], sign: f64| {
        checks.push(momentum_balance(name, mass, history.time, motion.velocity, force, sign, interval));
    };
    let (outer, inner) = (&setup.outer, &setup.inner);
    let outer_mass = outer.shape.mass(&outer.material);
    momentum("outer", outer_mass, history.outer, history.outer_force, 1.0);
    // In a fluid more than the contact force acts on the inner body.
    if setup.fluid.is_none() {
        let inner_mass = inner.shape.mass(&inner.material);
        momentum("inner", inner_mass, history.inner, history.inner_force, -1.0);
    }
    let motions = [
        ("outer", history.outer, SLACK),
        ("plate", history.plate, PLATE_SLACK),
        ("inner", history.inner, SLACK),
    ];
    for (name, motion, slack) in motions {
        let motion = (motion.displacement, motion.velocity);
        checks.push(path_balance(name, history.time, motion, interval, slack));
    }
    checks
}

/// The velocity of a mass in kg changes by `sign` times the impulse of `force` in N.
pub(super) fn momentum_balance(
    name: &str,
    mass: f64,
    time: &[f64],
    velocity: &[f64],
    force: &[f64],
    sign: f64,
    interval: f64,
) -> Check {
    let impulse = RunningIntegral::of(time, force);
    let gained = |k: usize| mass * (velocity[k] - velocity[0]);
    let missed = largest((0..time.len()).map(|k| gained(k) - sign * impulse.values[k]));
    let bound = impulse.sampling_error + peak(force) * interval + SLACK * peak(&impulse.values);
    Check::new(format!("{name}_momentum_balance"), "N*s", missed, 0.0, bound)
}

/// The displacement of a rigid body is the integral of its velocity.
pub(super) fn displacement_balance(
    name: &str,
    time: &[f64],
    displacement: &[f64],
    velocity: &[f64],
    interval: f64,
) -> Check {
    path_balance(name, time, (displacement, velocity), interval, SLACK)
}

fn path_balance(
    name: &str,
    time: &[f64],
    (displacement, velocity): (&[f64], &[f64]),
    interval: f64,
    slack: f64,
) -> Check {
    let path = RunningIntegral::of(time, velocity);
    let moved = |k: usize| displacement[k] - displacement[0];
    let missed = largest((0..time.len()).map(|k| moved(k) - path.values[k]));
    let bound = path.sampling_error + peak(velocity) * interval + slack * peak(displacement);
    Check::new(format!("{name}_displacement_balance"), "m", missed, 0.0, bound)
}

/// Largest magnitude.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}

/// Integral from the first instant to each, by the trapezoidal rule.
struct RunningIntegral {
    values: Vec<f64>,
    /// Largest difference to the integral over every other sample: above the error of the
    /// full one, which is about a third of it for a smooth curve.
    sampling_error: f64,
}

impl RunningIntegral {
    fn of(time: &[f64], curve: &[f64]) -> Self {
        let accumulated = |stride: usize| {
            let mut sum = 0.0;
            let mut values = vec![0.0];
            for k in (stride..time.len()).step_by(stride) {
                sum += 0.5 * (time[k] - time[k - stride]) * (curve[k] + curve[k - stride]);
                values.push(sum);
            }
            values
        };
        let (values, coarse) = (accumulated(1), accumulated(2));
        let sampling_error = largest(coarse.iter().enumerate().map(|(k, c)| c - values[2 * k]));
        RunningIntegral { values, sampling_error }
    }
}

#[cfg(test)]
mod tests {
    use super::RunningIntegral;

    #[test]
    fn sampling_error_bounds_the_error_of_the_integral() {
        let time: Vec<f64> = (0..=20).map(|k| f64::from(k) / 20.0).collect();
        let curve: Vec<f64> = time.iter().map(|t| (std::f64::consts::PI * t).sin()).collect();
        let integral = RunningIntegral::of(&time, &curve);
        let error = (integral.values[20] - 2.0 / std::f64::consts::PI).abs();
        assert!(error > 0.0 && error < integral.sampling_error);
        assert!(integral.sampling_error < 5.0 * error);
    }
}
