//! What is booked of a wet step: impulses, work and losses.

use super::{WetStepper, with_start};
use crate::dynamics::contact_balance::work;
use crate::dynamics::integration::FluidAccount;
use crate::dynamics::system::INNER;
use crate::dynamics::wet::FluidLoad;
use crate::dynamics::wet::solve::END;
use crate::numerics::stages::Stages;

/// Rounding errors of coordinates that a step's work may be off by.
const ROUNDINGS: f64 = 64.0;

/// What is booked of a step.
pub(super) struct StepAccount {
    pub(super) fluid: FluidAccount,
    /// Work of both contacts' force polynomials, J.
    pub(super) contact_work: [f64; 2],
    /// Energy made from nothing, J.
    pub(super) energy_error: f64,
    /// What of it the rounding of coordinates may be, J: a film can be millions of newtons strong.
    pub(super) rounding: f64,
}

impl WetStepper<'_> {
    /// What the fluid does in the step of `h` s just solved.
    fn fluid_in_step(&self, h: f64) -> FluidAccount {
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
        FluidAccount {
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
            let approach = with_start(self.approach[i], &trial.approach[i]);
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
}
