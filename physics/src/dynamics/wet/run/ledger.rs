//! What is booked of the steps: impulses, work and losses, and what the run comes to.

use super::{Run, joined};
use crate::dynamics::collocation::Stages;
use crate::dynamics::contact_ledger::work;
use crate::dynamics::integrator::Integration;
use crate::dynamics::recorder::Recorder;
use crate::dynamics::system::{INNER, PLATE, dot};
use crate::dynamics::wet::FluidLoad;
use crate::dynamics::wet::solve::END;
use crate::result::Losses;

/// Rounding errors of coordinates that a step's work may be off by.
const ROUNDINGS: f64 = 64.0;

/// What the fluid did so far.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Booked {
    /// Impulse of film and drag on the inner body in N s.
    pub(super) film_impulse: f64,
    pub(super) drag_impulse: f64,
    /// Energy dissipated in film and by drag, J.
    pub(super) dissipated: [f64; 2],
    /// Work of the fluid's force polynomials on the bodies, J.
    pub(super) work: f64,
}

impl Booked {
    pub(super) fn add(&mut self, step: &Self) {
        self.film_impulse += step.film_impulse;
        self.drag_impulse += step.drag_impulse;
        self.dissipated[0] += step.dissipated[0];
        self.dissipated[1] += step.dissipated[1];
        self.work += step.work;
    }
}

/// What is booked of a step.
pub(super) struct StepAccount {
    pub(super) fluid: Booked,
    /// Work of both contacts' force polynomials, J.
    pub(super) contact_work: [f64; 2],
    /// Energy made from nothing, J.
    pub(super) energy_error: f64,
    /// What of it the rounding of coordinates may be, J: a film can be millions of newtons strong.
    pub(super) rounding: f64,
}

impl Run<'_> {
    /// What the fluid does in the step of `h` s just solved.
    fn fluid_in_step(&self, h: f64) -> Booked {
        let trial = &self.trial;
        let sum = |value: fn(&FluidLoad) -> f64| -> f64 {
            let weights = &self.collocation.weights;
            h * weights.iter().zip(&trial.loads).map(|(w, load)| w * value(load)).sum::<f64>()
        };
        let work = trial.fluid.iter().enumerate().map(|(k, stages)| {
            let course = std::array::from_fn(|p| match p {
                0 => self.q[INNER + k],
                _ => trial.motion.q[p - 1][INNER + k],
            });
            work(self.collocation, stages, &course)
        });
        Booked {
            film_impulse: -sum(|load| load.film_force),
            drag_impulse: sum(|load| load.drag_force),
            dissipated: [sum(|load| load.dissipation[0]), sum(|load| load.dissipation[1])],
            work: work.sum(),
        }
    }

    /// The account of the step of `h` s just solved.
    pub(super) fn account(&self, h: f64) -> StepAccount {
        let (system, trial) = (self.wet.system, &self.trial);
        let fluid = self.fluid_in_step(h);
        let contact_work = [0, 1].map(|i| {
            let approach = joined(self.approach[i], &trial.approach[i]);
            work(self.collocation, &trial.forces[i], &approach)
        });
        let stored = system.stored_energy(trial.end_force, trial.local.map(|p| p[END]))
            - system.stored_energy(self.force, self.local);
        let dissipated = fluid.dissipated[0] + fluid.dissipated[1];
        let energy_error = stored - (contact_work[0] + contact_work[1]) + dissipated + fluid.work;
        let forces = self.wet.generalised(trial);
        let largest = |stages: &Stages| stages.iter().fold(0.0, |a: f64, f| a.max(f.abs()));
        let work: f64 = forces.iter().zip(&trial.motion.q[END]).map(|(f, q)| largest(f) * q.abs()).sum();
        StepAccount { fluid, contact_work, energy_error, rounding: ROUNDINGS * f64::EPSILON * work }
    }

    /// The results of the run.
    pub(super) fn finish(self) -> Integration {
        let system = self.wet.system;
        let (contacts, booked) = (self.contacts, self.booked);
        let velocity = [dot(&system.outer, &self.v), self.v[INNER] / system.masses[1].sqrt()];
        let [start_q, start_v] = &system.start;
        let initial = system.energy(start_q, start_v);
        let stored = system.stored_energy(self.force, self.local);
        let end = system.energy(&self.q, &self.v);
        let dissipated = booked.dissipated[0] + booked.dissipated[1];
        let contact_work = contacts[0].work + contacts[1].work;
        let damped = system.is_damped();
        let unaccounted = if damped {
            stored - contact_work + dissipated + booked.work
        } else {
            end + stored - initial + dissipated
        };
        let fluid_impulse = booked.film_impulse + booked.drag_impulse;
        let impulses = [contacts[0].impulse, contacts[1].impulse];
        let mut unexplained = vec![system.masses[1] * velocity[1] + impulses[1] - fluid_impulse];
        if !system.outer_returns() {
            unexplained.push(system.masses[0] * (velocity[0] + system.speed) - impulses[0]);
        }
        if system.oscillators.get(PLATE).is_some_and(|o| o.omega == 0.0) {
            let plate = self.v[PLATE] / system.centre[PLATE];
            unexplained.push(plate + impulses[0] - impulses[1] + booked.film_impulse);
        }
        Integration {
            velocity,
            contacts,
            energy_residual: unaccounted.abs() / initial,
            energy_gained: unaccounted / initial,
            momentum_residual: unexplained.into_iter().fold(0.0, |worst: f64, p| worst.max(p.abs()))
                / (system.masses[0] * system.speed),
            losses: Losses {
                plate_damping: if damped { initial - end - contact_work + booked.work } else { 0.0 },
                squeeze_film: booked.dissipated[0],
                drag: booked.dissipated[1],
            },
            steps: self.steps,
            error_estimate: None,
            history: self.recorder.map(Recorder::finish),
        }
    }
}
