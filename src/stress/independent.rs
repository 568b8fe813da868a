//! An independent solution of a random impact: a Runge-Kutta method of order 8 that knows neither modes nor contacts.

use super::between::Watch;
use crate::dynamics::assured::differences;
use crate::dynamics::explicit_runge_kutta::{self as runge_kutta, DORMAND_PRINCE_8, Equations, Tolerances};
use crate::dynamics::integration::Integration;
use crate::dynamics::system::{INNER, System};
use crate::dynamics::wet::{FluidForces, FluidLoad};

/// Evaluations times state entries that the solution of a case may cost; dearer cases (high modes, long runs) go without
/// one and are counted. In a fluid an evaluation costs as much as [`FILM_ENTRIES`] entries more.
const WORK: f64 = 4e6;
const FILM_ENTRIES: usize = 300;
/// Relative tolerance of the solution, and that of a second one where the first contradicts.
const TOLERANCES: [f64; 2] = [1e-11, 1e-13];

/// What came of a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Comparison {
    /// There is no independent solution at a bearable cost.
    TooDear,
    /// The independent solution is itself uncertain: at two tolerances it differs by more than a third of the bound. Or the result
    /// says itself that it is no more exact.
    Undecided,
    /// Largest difference of a velocity, over the impact speed, and of a force peak, relative (see [`differences`]).
    Differences([f64; 2]),
}

/// Velocities in m/s at the end and force peaks in N of outer and inner body.
#[derive(Clone, Copy)]
struct Answer {
    velocity: [f64; 2],
    force_peak: [f64; 2],
}

/// Compares the `result` of the program with the independent solution, which is to tell whether they differ by more than
/// `bound`.
pub(super) fn compare(
    system: &System,
    fluid: Option<&FluidForces>,
    end_time: f64,
    result: &Integration,
    bound: f64,
) -> Comparison {
    let apart =
        |a: Answer, b: Answer| differences(system, [a.velocity, b.velocity], [a.force_peak, b.force_peak]);
    // max() would drop a value that is not a number
    let within = |[velocity, force]: [f64; 2], bound: f64| velocity <= bound && force <= bound;
    let ours = Answer { velocity: result.velocity, force_peak: result.contacts.map(|c| c.force_peak) };
    let [quick, careful] = TOLERANCES;
    let Some(quick) = solve(system, fluid, end_time, quick, WORK) else { return Comparison::TooDear };
    let difference = apart(ours, quick);
    // much of a larger one is the quick solution's own
    if within(difference, 0.1 * bound) {
        return Comparison::Differences(difference);
    }
    let more = if fluid.is_some() { 4.0 } else { 20.0 };
    match solve(system, fluid, end_time, careful, more * WORK) {
        None if within(difference, bound) => Comparison::Differences(difference),
        None => Comparison::Undecided,
        Some(careful) => {
            let difference = apart(ours, careful);
            let unsure = !within(apart(quick, careful), bound / 3.0)
                || within(difference, result.error_estimate.unwrap_or(0.0));
            if !within(difference, bound) && unsure {
                Comparison::Undecided
            } else {
                Comparison::Differences(difference)
            }
        }
    }
}

/// The solution at the end; `None` if it would take more than `work` (see [`WORK`]).
fn solve(
    system: &System,
    fluid: Option<&FluidForces>,
    end_time: f64,
    tolerance: f64,
    work: f64,
) -> Option<Answer> {
    let equations = Equations::new(system);
    let n = system.size();
    let fastest = system.oscillators.iter().map(|o| o.omega + 2.0 * o.alpha).fold(0.0, f64::max);
    let entries = n + 20 + if fluid.is_some() { FILM_ENTRIES } else { 0 };
    let max_evaluations = (work / entries as f64) as u64;
    // a step of about 3/omega at most, 12 evaluations each
    if fastest * end_time / 3.0 * 12.0 > max_evaluations as f64 {
        return None;
    }
    let (mut state, mut scale) = equations.start(system.hertz_impact().duration());
    // a light body's contact feels motions that the outer one would not
    for k in 0..n {
        let moves = system.approach[0][k].abs().max(system.approach[1][k].abs());
        let share = (system.speed / (moves * scale[n + k])).min(1.0);
        scale[k] *= share;
        scale[n + k] *= share;
    }
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
    let mut watch = Watch::new(system);
    runge_kutta::integrate_watched(
        &DORMAND_PRINCE_8,
        rate,
        |step| watch.accepts(step),
        &mut state,
        &scale,
        end_time,
        &tolerances,
    )?;
    // a film so stiff that an explicit method leaves the numbers has no solution here
    let answer = Answer { velocity: equations.velocity(&state), force_peak: watch.force_peak };
    Some(answer).filter(|answer| answer.velocity.iter().all(|v| v.is_finite()))
}
