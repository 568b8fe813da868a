//! An independent solution of a random impact: a Runge-Kutta method of order 8 that knows neither modes nor contacts.

use crate::analytical::hertz::HertzImpact;
use crate::dynamics::explicit_runge_kutta::{self as runge_kutta, DORMAND_PRINCE_8, Equations, Tolerances};
use crate::dynamics::system::{INNER, System};
use crate::dynamics::wet::{FluidForces, FluidLoad};

/// Evaluations times state entries that the solution of a case may cost; dearer cases (high modes, long runs) go without
/// one and are counted. In a fluid an evaluation costs as much as [`FILM_ENTRIES`] entries more.
const WORK: f64 = 3e6;
const FILM_ENTRIES: usize = 300;
/// Relative tolerance of the solution, and that of a second one where the first contradicts.
const TOLERANCES: [f64; 2] = [1e-11, 1e-13];

/// What came of a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Comparison {
    /// There is no independent solution at a bearable cost.
    TooDear,
    /// The independent solution is itself uncertain: at two tolerances it differs by more than a third of the bound.
    Undecided,
    /// Largest difference of a velocity, over the impact speed.
    Difference(f64),
}

/// Compares the final velocities `velocity` in m/s with the independent solution, which is to tell whether they differ by
/// more than `bound`.
pub(super) fn compare(
    system: &System,
    fluid: Option<&FluidForces>,
    end_time: f64,
    velocity: [f64; 2],
    bound: f64,
) -> Comparison {
    let apart = |a: [f64; 2], b: [f64; 2]| {
        // max() would drop a value that is not a number
        let [first, second] = [0, 1].map(|i| (a[i] - b[i]).abs() / system.speed);
        if first >= second || first.is_nan() { first } else { second }
    };
    let [quick, careful] = TOLERANCES;
    let Some(quick) = solve(system, fluid, end_time, quick, WORK) else { return Comparison::TooDear };
    let difference = apart(quick, velocity);
    // much of a larger one is the quick solution's own
    if difference <= 0.1 * bound {
        return Comparison::Difference(difference);
    }
    let more = if fluid.is_some() { 4.0 } else { 20.0 };
    let careful = solve(system, fluid, end_time, careful, more * WORK);
    match careful {
        None if difference <= bound => Comparison::Difference(difference),
        None => Comparison::Undecided,
        Some(careful) => {
            let difference = apart(careful, velocity);
            let unsure = apart(careful, quick) > bound / 3.0;
            if difference > bound && unsure {
                Comparison::Undecided
            } else {
                Comparison::Difference(difference)
            }
        }
    }
}

/// Velocities of outer and inner body in m/s at the end; `None` if that would take more than `work` (see [`WORK`]).
fn solve(
    system: &System,
    fluid: Option<&FluidForces>,
    end_time: f64,
    tolerance: f64,
    work: f64,
) -> Option<[f64; 2]> {
    let equations = Equations::new(system);
    let hit =
        HertzImpact { mass: system.masses[0], speed: system.speed, stiffness: system.laws[0].stiffness };
    let n = system.size();
    let fastest = system.oscillators.iter().map(|o| o.omega + 2.0 * o.alpha).fold(0.0, f64::max);
    let entries = n + 20 + if fluid.is_some() { FILM_ENTRIES } else { 0 };
    let max_evaluations = (work / entries as f64) as u64;
    // a step of about 3/omega at most, 12 evaluations each
    if fastest * end_time / 3.0 * 12.0 > max_evaluations as f64 {
        return None;
    }
    let (mut state, scale) = equations.start(hit.duration());
    let tolerances = Tolerances { relative: tolerance, absolute: tolerance, max_evaluations };
    let mut load = FluidLoad::default();
    let rate = |y: &[f64], dy: &mut [f64]| {
        equations.rate(y, dy);
        if let Some(fluid) = fluid {
            fluid.evaluate(&y[..n], &y[n..], &mut load);
            for (acceleration, force) in dy[n + INNER..].iter_mut().zip(&load.force) {
                *acceleration += force;
            }
        }
    };
    runge_kutta::integrate(&DORMAND_PRINCE_8, rate, &mut state, &scale, end_time, &tolerances)?;
    // a film so stiff that an explicit method leaves the numbers has no solution here
    Some(equations.velocity(&state)).filter(|velocity| velocity.iter().all(|v| v.is_finite()))
}
