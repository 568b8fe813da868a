//! What a solved step is wrong by, and where it should have ended.

use super::DryStepper;
use crate::dynamics::clearance::contact_between;
use crate::dynamics::collocation::{Collocation, POINTS, Points, crossing};
use crate::dynamics::contact_forces::Course;
use crate::dynamics::step_bounds::{StepBounds, force_scale, peak_share};
use crate::dynamics::system::dot;

/// Places of a step (0..1) at which it is cut for an event; nearer to its ends shorter steps find it.
const EVENTS: std::ops::Range<f64> = 0.002..0.99;

/// What is wrong with a step.
pub(super) struct StepVerdict {
    /// Its largest error over what may be.
    pub(super) excess: f64,
    /// Where in it (0..1) the first touch or release is that it should end at.
    pub(super) event: Option<f64>,
    /// Distance in N between both forces at the end and the polynomials of the step, where they are smooth.
    pub(super) force_defect: [f64; 2],
}

impl StepVerdict {
    fn event_at(&mut self, place: f64) {
        self.event = Some(self.event.map_or(place, |event| event.min(place)));
    }
}

impl DryStepper<'_> {
    /// What `trial` is wrong by, with the momenta `scale` (see [`momentum_scale`]) and the excess of its energy.
    pub(super) fn judge(&self, trial: &Course, scale: [f64; 2], energy_excess: f64) -> StepVerdict {
        let (collocation, h) = (self.solver.collocation, trial.h);
        let share = StepBounds::share(self.steps);
        let mut judged = StepVerdict { excess: energy_excess, event: None, force_defect: [0.0; 2] };
        for i in 0..2 {
            let defect = self.defect(trial, i) / scale[i];
            let kinked = is_kinked(trial, i);
            let change = if kinked { change_inside(collocation, trial, i) } else { None };
            let bound = match change {
                Some(_) => self.bounds.kinked,
                None if kinked => self.bounds.edge,
                None => share * self.bounds.smooth,
            };
            judged.excess = judged.excess.max(defect / bound);
            if let Some(u) = change
                && (defect > bound || energy_excess > 1.0)
            {
                judged.event_at(u);
            }
            if !kinked {
                let force = defect * scale[i] / h;
                let peak = self.contacts[i].force_peak;
                let of = force_scale(&trial.force[i], peak, scale[i], self.energy.contact_time);
                let bound = share * peak_share(&trial.force[i], peak) * self.bounds.force_defect;
                judged.excess = judged.excess.max(force / (bound * of));
                judged.force_defect[i] = force;
            }
            if is_open(trial, i)
                && let Some(contact) = contact_between(collocation, &trial.local_approach[i])
            {
                let impulse = self.solver.system.laws[i].force(contact.depth) * h;
                let missed = impulse / (scale[i] * self.bounds.kinked);
                judged.excess = judged.excess.max(missed);
                if missed > 1.0 && EVENTS.contains(&contact.place) {
                    judged.event_at(contact.place);
                }
            }
        }
        judged
    }

    /// Distance between the force at the end of the step and the polynomial of the step, as an impulse in N s.
    fn defect(&self, trial: &Course, contact: usize) -> f64 {
        let extrapolated = dot(&self.solver.collocation.ends[1], &trial.stages()[contact]);
        (trial.force[contact][POINTS - 1] - extrapolated).abs() * trial.h
    }
}

/// Whether `contact` touches or opens at the start, in or at the end of the step.
fn is_kinked(trial: &Course, contact: usize) -> bool {
    let forces = &trial.force[contact];
    forces.contains(&0.0) && forces.iter().any(|f| *f > 0.0)
}

/// Whether `contact` is open at all points of the step, but perhaps for a rounding error at its start.
fn is_open(trial: &Course, contact: usize) -> bool {
    trial.force[contact][1..] == [0.0; POINTS - 1]
}

/// Where inside the step (0..1) `contact` first touches or opens, if it does so well away from the ends.
fn change_inside(collocation: &Collocation, trial: &Course, contact: usize) -> Option<f64> {
    let local = &trial.local_approach[contact];
    let closed = |value: f64| value > 0.0;
    let point =
        (1..POINTS).find(|p| closed(local[*p]) != closed(local[p - 1]) && (*p > 1 || local[0] != 0.0))?;
    let polynomial = collocation.through(local);
    let around = |values: &Points| [values[point - 1], values[point]];
    let u = crossing(&polynomial, around(&collocation.points), around(local));
    EVENTS.contains(&u).then_some(u)
}
