//! An independent solution of a random impact: a Runge-Kutta method of order 8 that knows neither modes nor contacts.

use super::between::{ContactWatch, ObservedContact};
use super::kinds::StressImpact;
use super::{DIFFERENCE_BOUND, END_BOUND, TOLERANCE};
use crate::dynamics::equations::Equations;
use crate::dynamics::error_control;
use crate::dynamics::integration::Integration;
use crate::dynamics::system::{INNER, System};
use crate::dynamics::wet::{FluidForces, FluidLoad};
use crate::numerics::explicit_runge_kutta::{self as runge_kutta, DORMAND_PRINCE_8, Tolerances};

/// Evaluations times state entries that the solution of a case may cost; dearer cases (high modes, long runs) go without
/// one and are counted. In a fluid an evaluation costs as much as [`FILM_ENTRIES`] entries more.
const WORK: f64 = 4e6;
const FILM_ENTRIES: usize = 300;
/// Relative tolerance of the solution, and that of a second one where the first contradicts.
const TOLERANCES: [f64; 2] = [1e-11, 1e-13];

/// Time over the last release until which nothing more happens where the end of a run was left to the program.
const LONGER: f64 = 1.5;

/// What came of a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum IndependentCheck {
    /// There is no independent solution at a bearable cost.
    TooExpensive,
    /// The independent solution is itself uncertain: at two tolerances it differs by more than a third of the bound. Or the result
    /// says itself that it is no more exact.
    Undecided,
    /// Differences from the independent solution.
    Differences(Differences),
}

/// Largest differences of two solutions, relative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Differences {
    /// Of a velocity, over the impact speed, and of a force peak (see [`error_control::differences`]).
    pub(super) velocity: f64,
    pub(super) force: f64,
    /// Of the efficiency, over the larger of it and 1.
    pub(super) efficiency: f64,
    /// Of the time of the last release.
    pub(super) end: f64,
    /// The other solution's numbers of contacts that ended where they differ.
    pub(super) contacts: Option<[u32; 2]>,
}

impl Differences {
    fn within(&self, bound: f64) -> bool {
        let end = self.end * DIFFERENCE_BOUND / END_BOUND;
        // max() would drop a value that is not a number
        [self.velocity, self.force, self.efficiency, end].iter().all(|difference| *difference <= bound)
            && self.contacts.is_none()
    }
}

/// Velocities in m/s at the end, and what happened at the contacts, of outer and inner body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Answer {
    velocity: [f64; 2],
    contacts: [ObservedContact; 2],
}

impl From<&Integration> for Answer {
    fn from(result: &Integration) -> Self {
        Self { velocity: result.velocity, contacts: [0, 1].map(|i| ObservedContact::of(&result.contacts[i])) }
    }
}

impl Answer {
    /// How far this answer is from `other`.
    pub(super) fn differences(self, other: Self, system: &System) -> Differences {
        let both = [self, other];
        let peaks = both.map(|answer| answer.contacts.map(|contact| contact.force_peak));
        let [velocity, force] = error_control::differences(system, both.map(|answer| answer.velocity), peaks);
        let efficiency = both.map(|answer| {
            let energy = 0.5 * system.masses[1] * answer.velocity[1].powi(2);
            energy / system.initial_energy()
        });
        let end = |i: usize| {
            let [one, two] = both.map(|answer| answer.contacts[i].end);
            if one == two { 0.0 } else { (one - two).abs() / two }
        };
        let [ours, theirs] = both.map(|answer| answer.contacts.map(|contact| contact.ended()));
        Differences {
            velocity,
            force,
            efficiency: (efficiency[0] - efficiency[1]).abs() / efficiency[1].max(1.0),
            end: end(0).max(end(1)),
            contacts: (ours != theirs).then_some(theirs),
        }
    }
}

/// Compares the `result` of the program for `impact` with the independent solution.
pub(super) fn compare(impact: &StressImpact, result: &Integration) -> IndependentCheck {
    let bound = DIFFERENCE_BOUND;
    let system = &impact.system;
    let end_time = impact.end_time.unwrap_or_else(|| {
        let last = result.contacts.iter().fold(system.hertz_impact().duration(), |last, c| last.max(c.end));
        LONGER * last
    });
    let solve = |tolerance, work| solve(system, impact.forces.as_ref(), end_time, tolerance, work);
    let ours = Answer::from(result);
    // the program warns of contacts that it cannot count
    let countable =
        result.contacts.iter().all(|contact| contact.least_turn > error_control::ENOUGH * TOLERANCE);
    let apart = |one: Answer, two: Answer| {
        let found = one.differences(two, system);
        Differences { contacts: found.contacts.filter(|_| countable), ..found }
    };
    let [quick, careful] = TOLERANCES;
    let Some(quick) = solve(quick, WORK) else { return IndependentCheck::TooExpensive };
    let difference = apart(ours, quick);
    // much of a larger one is the quick solution's own
    if difference.within(0.1 * bound) {
        return IndependentCheck::Differences(difference);
    }
    let more = if impact.forces.is_some() { 4.0 } else { 20.0 };
    match solve(careful, more * WORK) {
        None if difference.within(bound) => IndependentCheck::Differences(difference),
        None => IndependentCheck::Undecided,
        Some(careful) => {
            let difference = apart(ours, careful);
            let unsure = !apart(quick, careful).within(bound / 3.0)
                || difference.within(result.error_estimate.unwrap_or(0.0));
            if !difference.within(bound) && unsure {
                IndependentCheck::Undecided
            } else {
                IndependentCheck::Differences(difference)
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
            let approach = system.modal_approach(&y[..n]);
            let local = system.contact(approach, approach).map_or(approach, |(local, _)| local);
            fluid.evaluate(&y[..n], &y[n..], system.indentation(local), &mut load);
            for (acceleration, force) in dy[n + INNER..].iter_mut().zip(&load.force) {
                *acceleration += force;
            }
        }
    };
    let mut watch = ContactWatch::new(system);
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
    let answer = Answer { velocity: equations.velocity(&state), contacts: watch.contacts };
    Some(answer).filter(|answer| answer.velocity.iter().all(|v| v.is_finite()))
}
