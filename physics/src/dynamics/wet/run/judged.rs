//! What a solved wet step is wrong by.

use super::{WetStepper, with_start};
use crate::dynamics::step_bounds::{force_scale, peak_share};
use crate::dynamics::system::dot;
use crate::dynamics::wet::contact_between;
use crate::numerics::stages::{STAGES, Stages};
use std::cell::LazyCell;

/// Share of a step's admissible defect at which its iteration may end, if rounding errors permit.
const CONVERGED: f64 = 1e-3;

/// Errors at which the iteration for a step may end.
pub(super) struct WetConvergence {
    /// Of the forces, N.
    force: f64,
    /// Of their impulses, N s.
    impulse: f64,
}

impl WetConvergence {
    /// The error of the forces in N in a step of `h` s.
    pub(super) fn in_step(&self, h: f64) -> f64 {
        self.force.min(self.impulse / h)
    }
}

impl WetStepper<'_> {
    /// Errors at which the iteration may end, with the momenta `scale` (see [`super::momentum_scale`]).
    pub(super) fn converged(&self, scale: [f64; 2]) -> WetConvergence {
        let least = (0..2).map(|i| self.force_scale(i, &[], scale)).fold(f64::INFINITY, f64::min);
        WetConvergence {
            force: CONVERGED * self.bounds.force_defect * least,
            impulse: CONVERGED * self.defect_bound * scale[1],
        }
    }

    /// Distance between the forces and the polynomials of the step, at its start and, of the film around a contact, late in it, as an impulse
    /// in relation to the momenta.
    pub(super) fn defect(&mut self, h: f64, scale: [f64; 2]) -> f64 {
        let late = self.late_film_defect(h) * h / scale[1];
        let extrapolation = self.collocation.ends[0];
        let film = std::array::from_fn(|j| self.trial.loads[j].film_force);
        let [outer, inner] = self.trial.forces;
        let starts = [self.force[0], self.force[1], self.load.film_force];
        [outer, inner, film]
            .iter()
            .zip(starts)
            .zip([scale[0], scale[1], scale[1]])
            .map(|((stages, start), scale)| (start - dot(&extrapolation, stages)).abs() * h / scale)
            .fold(late, f64::max)
    }

    /// Distance in N between the film's force and its polynomial halfway between the last two points of the step of `h` s just solved: where
    /// a contact ends, the force changes with the square root of the time. 0 without a contact in the step.
    fn late_film_defect(&mut self, h: f64) -> f64 {
        let (system, trial) = (self.wet.system, &self.trial);
        if trial.local[1].iter().all(|patch| *patch <= 0.0) || self.wet.fluid.minimum_gap().is_infinite() {
            return 0.0;
        }
        let [.., before, end] = self.collocation.nodes;
        let place = 0.5 * (before + end);
        let (q, v) = self.motion_at(&self.wet.generalised(trial), place * h, h);
        let approach = system.modal_approach(&q);
        let Some((local, _)) = system.contact(approach, approach) else { return f64::INFINITY };
        self.wet.fluid.evaluate(&q, &v, system.indentation(local), &mut self.late);
        let film: Stages = std::array::from_fn(|j| trial.loads[j].film_force);
        (self.late.film_force - dot(&self.collocation.interpolation(place), &film)).abs()
    }

    /// Distance in N between the contact forces at the start of the step and the polynomials of the step, where they are
    /// smooth.
    pub(super) fn force_defect(&self) -> [f64; 2] {
        let extrapolation = self.collocation.ends[0];
        std::array::from_fn(|i| {
            let (start, stages) = (self.force[i], &self.trial.forces[i]);
            let smooth = start > 0.0 && stages.iter().all(|force| *force > 0.0);
            if smooth { (start - dot(&extrapolation, stages)).abs() } else { 0.0 }
        })
    }

    /// [`Self::force_defect`] over what may be.
    pub(super) fn force_excess(&self, defect: [f64; 2], scale: [f64; 2]) -> f64 {
        let excess = |i: usize| {
            let forces = with_start(self.force[i], &self.trial.forces[i]);
            let share = peak_share(&forces, self.contacts[i].force_peak);
            defect[i] / (share * self.bounds.force_defect * self.force_scale(i, &forces, scale))
        };
        excess(0).max(excess(1))
    }

    /// See [`force_scale`].
    fn force_scale(&self, contact: usize, forces: &[f64], scale: [f64; 2]) -> f64 {
        force_scale(forces, self.contacts[contact].force_peak, scale[contact], self.energy.contact_time)
    }

    /// Impulse, over what may be wrong, of a touch between the points of the step of `h` s just solved.
    pub(super) fn missed_contact(&self, h: f64, scale: [f64; 2]) -> f64 {
        let (system, trial) = (self.wet.system, &self.trial);
        let points = [0, 1].map(|i| {
            let open = self.force[i] == 0.0 && trial.forces[i] == [0.0; STAGES];
            open.then(|| with_start(self.local[i], &trial.local[i]))
        });
        let forces = LazyCell::new(|| self.wet.generalised(trial));
        let motion = |place: f64| system.modal_approach(&self.motion_at(&forces, place * h, h).0);
        let largest = contact_between::forces(system, h, [&self.q, &self.v], points, motion);
        let missed = |i: usize| largest[i] * h / (scale[i] * self.bounds.kinked);
        missed(0).max(missed(1))
    }
}

/// Defect that a step may have for a relative error `tolerance` of the efficiency. The error of a step is of about
/// twice the order of its defect, so that the bound may fall more slowly than the tolerance; factor and exponent
/// are measured over scenes and numbers of modes.
pub(super) fn defect_bound(tolerance: f64) -> f64 {
    0.1 * tolerance.powf(0.87)
}
