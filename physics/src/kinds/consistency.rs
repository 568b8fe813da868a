//! What the results of any kind of scene must obey by themselves: a contact's force is found again in its summary, impulse
//! changes momentum, velocity changes displacement. An error in one curve that leaves the others alone breaks one of them.

use crate::result::{Source, Statement, Summary};

/// Share of the peak by which the peak force of a reference may differ from that of its history,
/// beyond the sampling: contact forces of finite elements are noisy, and the history's are averages.
const REFERENCE_PEAK_SLACK: f64 = 0.01;
/// The same for a reduced model, whose force is smooth.
const REDUCED_PEAK_SLACK: f64 = 0.002;
/// Share of the initial speed by which velocities may differ that should be the same.
pub(crate) const VELOCITY_SLACK: f64 = 1e-3;
/// Relative difference between the efficiency and the one that the final velocity gives.
pub(crate) const EFFICIENCY_SLACK: f64 = 2e-3;
/// Share of the initial energy by which the final one of a result from outside may exceed it: what the velocities' own errors make of it.
pub(crate) const ENERGY_SLACK: f64 = 5e-3;
/// Share of the peak below which a force counts as none.
pub(crate) const FORCE_FLOOR: f64 = 1e-9;
/// Share of the total impulse, and of the peak displacement, that a balance may miss beyond
/// what sampling explains.
pub(crate) const SLACK: f64 = 2e-3;
/// Endings of the names of results that are never negative.
const NOT_NEGATIVE: [&str; 5] = ["efficiency", "_peak", "_end", "_speed", "first_frequency"];

/// Largest magnitude in `values`.
pub(crate) fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |p, v| p.max(v.abs()))
}

/// Results of a summary that can't be negative are not.
pub(crate) fn not_negative(summary: &Summary) -> Vec<Statement> {
    let is_one = |name: &str| NOT_NEGATIVE.iter().any(|ending| name.ends_with(ending));
    let known = summary.quantities.iter().filter(|quantity| is_one(quantity.name));
    known
        .filter_map(|q| Some(Statement::at_least(format!("{}_sign", q.name), q.unit, q.value?, 0.0, 0.0)))
        .collect()
}

/// What a summary states of a contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stated {
    /// Largest force in N, if it is determined.
    pub(crate) peak: Option<f64>,
    /// Last release in s, if it is determined.
    end: Option<f64>,
    /// Its 95 % band in s, 0 if none is stated: between a last faint force and none a release is known no better.
    end_band: f64,
}

impl Stated {
    /// Of the contact of `body`.
    pub(crate) fn of(summary: &Summary, body: &str) -> Self {
        let value = |what: &str| summary.value(&format!("{body}_{what}"));
        let end_band = summary.band(&format!("{body}_contact_end")).unwrap_or(0.0);
        Stated { peak: value("force_peak"), end: value("contact_end"), end_band }
    }
}

/// Sign, peak and end of a contact force over `time`, against what a summary states of it.
pub(crate) fn contact(
    name: &str,
    source: Source,
    (time, force): (&[f64], &[f64]),
    stated: Stated,
    unseen: f64,
) -> Vec<Statement> {
    let tension = force.iter().fold(0.0_f64, |least, &f| least.min(f));
    let floor = FORCE_FLOOR * peak(force);

    let (at, found) = force.iter().enumerate().fold((0, 0.0), |m, (k, &f)| if f > m.1 { (k, f) } else { m });
    let neighbours = [at.checked_sub(1), Some(at + 1).filter(|&k| k < force.len())];
    let drop = neighbours.into_iter().flatten().map(|k| found - force[k]).fold(0.0, f64::max);
    let slack = match source {
        Source::Reference | Source::External => REFERENCE_PEAK_SLACK,
        Source::Reduced => REDUCED_PEAK_SLACK,
    };
    // A parabola rises above the higher of its samples by at most an eighth of the drop to the
    // lower neighbour; twice that is allowed.
    let peak_bound = slack * found + 0.25 * drop + unseen;

    let last = force.iter().rposition(|&f| f > floor);
    let (end, end_bound) = last.map_or((0.0, time[1]), |k| {
        let before = k.checked_sub(1).map_or(0.0, |j| time[k] - time[j]);
        let after = time.get(k + 1).map_or(0.0, |t| t - time[k]);
        // Room for the rounding of times written as text.
        (time[k], before.max(after) * 1.001)
    });
    let compared = |what: &str, unit, found, stated: Option<f64>, bound| {
        stated.map(|stated| Statement::new(format!("{name}_{what}"), unit, found, stated, bound))
    };
    let tension = Statement::new(format!("{name}_tension"), "N", tension, 0.0, 1e-6 * peak(force));
    let peak = compared("force_peak", "N", found, stated.peak, peak_bound);
    let end = compared("contact_end", "s", end, stated.end, end_bound + stated.end_band);
    [Some(tension), peak, end].into_iter().flatten().collect()
}

/// The velocity of a mass in kg changes by `sign` times the impulse of `force` in N.
pub(crate) fn momentum_balance(
    name: &str,
    mass: f64,
    time: &[f64],
    velocity: &[f64],
    force: &[f64],
    sign: f64,
    interval: f64,
) -> Statement {
    let impulse = RunningIntegral::of(time, force);
    let gained = |k: usize| mass * (velocity[k] - velocity[0]);
    let missed = largest((0..time.len()).map(|k| gained(k) - sign * impulse.values[k]));
    let bound = impulse.sampling_error + peak(force) * interval + SLACK * peak(&impulse.values);
    Statement::new(format!("{name}_momentum_balance"), "N*s", missed, 0.0, bound)
}

/// A displacement is the integral of its velocity, up to `slack` of its peak and what the sampling hides.
pub(crate) fn displacement_balance(
    name: &str,
    time: &[f64],
    (displacement, velocity): (&[f64], &[f64]),
    interval: f64,
    slack: f64,
) -> Statement {
    let path = RunningIntegral::of(time, velocity);
    let moved = |k: usize| displacement[k] - displacement[0];
    let missed = largest((0..time.len()).map(|k| moved(k) - path.values[k]));
    let bound = path.sampling_error + peak(velocity) * interval + slack * peak(displacement);
    Statement::new(format!("{name}_displacement_balance"), "m", missed, 0.0, bound)
}

/// Largest magnitude.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}

/// Integral from the first instant to each, by the trapezoidal rule.
pub(crate) struct RunningIntegral {
    pub(crate) values: Vec<f64>,
    /// Largest difference to the integral over every other sample: above the error of the
    /// full one, which is about a third of it for a smooth curve.
    sampling_error: f64,
}

impl RunningIntegral {
    pub(crate) fn of(time: &[f64], curve: &[f64]) -> Self {
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
