//! First guess of the forces of a step: those of the step before, carried on.

use super::solve::Trial;
use crate::dynamics::collocation::{Collocation, RADAU_POINTS};
use crate::dynamics::system::dot;
use crate::numerics::stages::{STAGES, Stages};

/// Length of a step over that of the step before up to which its forces are extrapolated.
const FARTHEST: f64 = 2.5;

/// Forces of the latest step at Radau's points.
#[derive(Default)]
pub(super) struct StepForces {
    /// Length of the step in s; 0 before the first.
    h: f64,
    /// Of both contacts, N.
    contacts: [Stages; 2],
    /// Generalised ones of the fluid. Shape (size).
    fluid: Vec<Stages>,
}

impl StepForces {
    /// Takes over the forces of `trial`, an accepted step of `h` s.
    pub(super) fn keep(&mut self, h: f64, trial: &Trial) {
        self.h = h;
        self.contacts = trial.forces;
        self.fluid.clone_from(&trial.fluid);
    }

    /// Writes a guess for the next step, of `h` s, into `trial`: extrapolated, or, if this step was too short for that, the
    /// forces at its start, of the contacts in N and the generalised ones of the fluid.
    pub(super) fn guess(
        &self,
        collocation: &Collocation<RADAU_POINTS>,
        h: f64,
        (contacts, fluid): ([f64; 2], &[f64]),
        trial: &mut Trial,
    ) {
        if h > FARTHEST * self.h {
            trial.forces = contacts.map(|force| [force; STAGES]);
            for (stages, force) in trial.fluid.iter_mut().zip(fluid) {
                *stages = [*force; STAGES];
            }
            return;
        }
        let weights = collocation.nodes.map(|u| collocation.interpolation(1.0 + u * h / self.h));
        let extrapolated = |stages: &Stages| weights.map(|weights| dot(&weights, stages));
        trial.forces = self.contacts.map(|stages| extrapolated(&stages).map(|force| force.max(0.0)));
        for (guess, stages) in trial.fluid.iter_mut().zip(&self.fluid) {
            *guess = extrapolated(stages);
        }
    }
}
