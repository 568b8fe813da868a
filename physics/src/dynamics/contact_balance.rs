//! What is booked about one contact: impulse, peak force, touches and releases.

use super::collocation::{Collocation, crossing, derivative, horner};
use super::system::dot;
use crate::numerics::stages::{STAGES, Stages};

/// Course of one contact over one step, known at `P` points of it: start, Gauss (Radau) points and end.
pub struct StepCourse<const P: usize> {
    /// Start of the step and its length, s.
    pub time: f64,
    /// Length of the step in s.
    pub h: f64,
    /// Local approach, positive where the bodies touch, m.
    pub local_approach: [f64; P],
    /// Force in N.
    pub force: [f64; P],
    /// Work of the force polynomial along the approach, J (see [`work`]).
    pub work: f64,
}

/// One of many short steps, between whose ends nothing is known.
pub struct EvenStep {
    /// Length in s.
    pub h: f64,
    /// Mean force in N.
    pub mean: f64,
    /// Largest force in N.
    pub peak: f64,
    /// Local approach at both ends, m.
    pub local_approach: [f64; 2],
    /// Work of the force along the approach, J.
    pub work: f64,
}

/// Account of one contact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactBalance {
    /// Impulse so far in N s.
    pub impulse: f64,
    /// Work of the step's force polynomials along the approach so far in J: what the bodies lost to the contact. The
    /// contact's strain energy differs from it by the error of the integration alone, damped bodies or not.
    pub work: f64,
    /// Largest force so far in N.
    pub force_peak: f64,
    /// Largest distance in N between the force at the end of a step and the step's polynomial, where the force is smooth.
    pub force_defect: f64,
    /// Sum of these distances over all steps, N.
    pub force_defect_sum: f64,
    /// Time of the latest release in s.
    pub end: f64,
    /// Number of separate contacts so far.
    pub contacts: u32,
    /// Whether the bodies touch now.
    pub closed: bool,
    /// Impulse in N s below which a contact does not count as one.
    negligible: f64,
    /// Impulse when the present contact began, N s.
    impulse_at_contact: f64,
    /// Least distance from zero at which the local approach turned so far, over its largest value until then: a smaller error loses no
    /// contact and makes none.
    pub least_turn: f64,
    /// Largest local approach so far, m.
    approach_peak: f64,
    /// Relative change of [`ContactBalance::end`] for a change of the local approach, over its largest value: large where bodies part slowly.
    pub end_sensitivity: f64,
    /// Latest change of the local approach in m, 0 where it is not known, and how long it took in s.
    change: (f64, f64),
}

impl ContactBalance {
    /// An account that does not count contacts of less than `negligible` N s: a static residual flexibility lets
    /// the far face answer before a wave can reach it, with a graze of no consequence.
    pub fn new(negligible: f64) -> Self {
        Self { negligible, least_turn: f64::INFINITY, ..Self::default() }
    }

    /// Books a step in which the force is known at its ends alone; `released` gives the time of a release in s and the rate of separation
    /// then in m/s.
    #[inline(always)]
    pub fn add_even(&mut self, step: &EvenStep, released: impl FnOnce() -> (f64, f64)) {
        let before = self.impulse;
        self.impulse += step.h * step.mean;
        self.work += step.work;
        self.force_peak = self.force_peak.max(step.peak);
        let [start, end] = step.local_approach;
        self.turn(start, (end - start, step.h));
        self.pass(end > 0.0, before, released);
    }

    /// Books a step.
    pub fn book<const P: usize>(&mut self, collocation: &Collocation<P>, course: &StepCourse<P>) {
        let stages: &Stages = course.force[1..=STAGES].try_into().expect("STAGES values");
        let before = self.impulse;
        self.impulse += course.h * stages.iter().zip(&collocation.weights).map(|(f, w)| f * w).sum::<f64>();
        self.work += course.work;
        for point in 1..P {
            let place = course.local_approach[point - 1];
            let took = course.h * (collocation.points[point] - collocation.points[point - 1]);
            self.turn(place, (course.local_approach[point] - place, took));
            let released = || release(collocation, course, point);
            self.pass(course.local_approach[point] > 0.0, before, released);
        }
    }

    /// Books a flight that left the contact open by about `depth` m.
    pub fn add_flight(&mut self, depth: f64) {
        self.least_turn = self.least_turn.min(depth / self.approach_peak);
        self.change = (0.0, 0.0);
    }

    /// Notes where the local approach turns, by the parabola through three points; from the second, `place` m, it changes by so many m in
    /// so many s.
    #[inline(always)]
    fn turn(&mut self, place: f64, change: (f64, f64)) {
        // grazes of no consequence before do not count
        if change.0 * self.change.0 < 0.0 && self.impulse > self.negligible {
            let [(first, took), (second, takes)] = [self.change, change];
            let [before, after] = [first / took, second / takes];
            let slope = (before * takes + after * took) / (took + takes);
            let top = place - 0.25 * slope * slope * (took + takes) / (after - before);
            let distance = if top * place > 0.0 { top.abs() } else { 0.0 };
            self.least_turn = self.least_turn.min(distance / self.approach_peak);
        }
        self.approach_peak = self.approach_peak.max(place + change.0);
        self.change = change;
    }

    /// Books the `defect` in N of a step's force.
    #[inline]
    pub fn add_defect(&mut self, defect: f64) {
        self.force_defect = self.force_defect.max(defect);
        self.force_defect_sum += defect;
    }

    /// Counts touches and releases; `before` is the impulse when the step began in N s, `released` gives the time of a release in s, and the
    /// rate of separation then in m/s.
    #[inline(always)]
    fn pass(&mut self, closed: bool, before: f64, released: impl FnOnce() -> (f64, f64)) {
        if closed && !self.closed {
            self.contacts += 1;
            self.impulse_at_contact = before;
        } else if !closed && self.closed {
            if self.impulse - self.impulse_at_contact <= self.negligible {
                self.contacts -= 1;
            } else {
                let (time, rate) = released();
                self.end = time;
                self.end_sensitivity = self.approach_peak / (rate * time).abs();
            }
        }
        self.closed = closed;
    }
}

/// Integral of the force polynomial over the approach in J, by parts: F delta at the ends less the integral of delta dF.
pub fn work<const P: usize>(collocation: &Collocation<P>, force: &Stages, approach: &[f64; P]) -> f64 {
    let [start, end] = collocation.ends.map(|weights| dot(&weights, force));
    let inside: f64 = (0..STAGES)
        .map(|j| collocation.weights[j] * approach[j + 1] * dot(&collocation.slopes[j], force))
        .sum();
    end * approach[P - 1] - start * approach[0] - inside
}

/// When before `point` the local approach passes zero, s, and how quickly, m/s.
fn release<const P: usize>(collocation: &Collocation<P>, course: &StepCourse<P>, point: usize) -> (f64, f64) {
    let polynomial = collocation.through(&course.local_approach);
    let around = |values: &[f64; P]| [values[point - 1], values[point]];
    let place = crossing(&polynomial, around(&collocation.points), around(&course.local_approach));
    (course.time + course.h * place, horner(&derivative(&polynomial), place) / course.h)
}
