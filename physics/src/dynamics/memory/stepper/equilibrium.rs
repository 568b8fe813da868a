//! The end of a step: what contacts, modes and residual flexibilities agree on.

use super::MemoryStepper;
use crate::dynamics::memory::step_force::StepForce;

/// Newton steps after which a contact counts as unsolvable, and the least part of one.
const MAX_ITERATIONS: usize = 60;
const LEAST_FRACTION: f64 = 1e-4;
/// What may be missing of the approaches, over the largest: to stop, and where rounding leaves no more.
const CONVERGED: f64 = 1e-13;
const ROUNDING: f64 = 1e-10;

/// Approaches tried for the end of a step.
pub(super) struct ApproachTrial {
    pub(super) x: [f64; 2],
    pub(super) force: [f64; 2],
    /// The forces that act in the step, N.
    pub(super) acting: [f64; 2],
    /// Of the forces at the end by the approaches, N/m.
    slope: [f64; 2],
    /// Work that each contact has taken, and with it what is stored beyond half-spaces, J.
    pub(super) taken: [f64; 2],
    pub(super) energy: f64,
    pub(super) patch: [f64; 2],
    /// Beyond half-spaces, m/N.
    flexibility: [[f64; 2]; 2],
    /// What is missing, m.
    error: [f64; 2],
}

impl ApproachTrial {
    /// Not a number if an error is none.
    fn size(&self) -> f64 {
        let [a, b] = self.error.map(f64::abs);
        if a >= b || a.is_nan() { a } else { b }
    }
}

impl MemoryStepper<'_> {
    /// The end of the step in which the modes alone would approach by `free` m, by Newton's method with halved steps; `None` if there is
    /// no equilibrium. Where the law of a contact has a kink within the step the forces may have to be their means.
    pub(super) fn solve(&self, free: [f64; 2]) -> Option<ApproachTrial> {
        self.solve_by(self.step_force, free).or_else(|| match self.step_force {
            StepForce::Conserving => self.solve_by(StepForce::Mean, free),
            _ => None,
        })
    }

    fn solve_by(&self, step_force: StepForce, free: [f64; 2]) -> Option<ApproachTrial> {
        let free = [free[0] + self.offset[0], free[1] + self.offset[1]];
        let scale = free[0].abs().max(free[1].abs()).max(f64::MIN_POSITIVE);
        let trial = |x: [f64; 2], patch: [f64; 2]| self.trial(step_force, free, x, patch);
        let mut best = trial(self.x, self.patch);
        let mut step = self.newton(&best);
        let mut fraction = 1.0;
        for _ in 0..MAX_ITERATIONS {
            if best.size() <= CONVERGED * scale {
                break;
            }
            let x = [best.x[0] - fraction * step[0], best.x[1] - fraction * step[1]];
            let next = trial(x, best.patch);
            if next.size() < best.size() {
                (step, fraction) = (self.newton(&next), 1.0);
                best = next;
            } else if fraction > LEAST_FRACTION {
                fraction *= 0.5;
            } else if best.size() > ROUNDING * scale {
                // where a contact turns from loading to unloading the slope is that of the other side: beyond it is the right one
                best = trial([best.x[0] - step[0], best.x[1] - step[1]], best.patch);
                (step, fraction) = (self.newton(&best), 1.0);
            } else {
                break;
            }
        }
        (best.size() <= ROUNDING * scale).then_some(best)
    }

    /// What the contacts answer at the approaches `x`, from the patches of a nearby state on.
    fn trial(&self, step_force: StepForce, free: [f64; 2], x: [f64; 2], patch: [f64; 2]) -> ApproachTrial {
        let answer = [0, 1].map(|i| self.bodies.contacts[i].answer(x[i]));
        let [force, slope, taken] = [0, 1, 2].map(|of| answer.map(|answer| answer[of]));
        let (elastic, patch, flexibility) = self.bodies.elastic(self.system, force, patch);
        let elastic_below = |i: usize, part: usize| {
            self.bodies.creep(i, part).deformation(&self.deformed[i][part], elastic[i][part])
        };
        let bodies = [0, 1].map(|i| x[i] + elastic_below(i, 0) + elastic_below(i, 1));
        let energy = taken[0] + taken[1] + self.bodies.energy_beyond(self.system, force, patch);
        let moved = [0, 1].map(|i| bodies[i] - self.offset[i] - self.y[i]);
        let acting = step_force.acting([self.force, force], moved, [self.energy, energy]);
        let coupling = self.modes[self.level].coupling;
        let error = [0, 1].map(|i| {
            let lost = coupling[i][0] * acting[0] + coupling[i][1] * acting[1];
            bodies[i] + lost - free[i]
        });
        ApproachTrial { x, force, acting, slope, taken, energy, patch, flexibility, error }
    }

    /// Newton's step in the approaches, m, to be taken off: as if the flexibility did not change with the patches.
    fn newton(&self, trial: &ApproachTrial) -> [f64; 2] {
        let ApproachTrial { slope, flexibility, error, .. } = trial;
        let growth = |i: usize| self.bodies.creep(i, 0).growth().max(self.bodies.creep(i, 1).growth());
        let share = self.step_force.share_of_end();
        let per_force = |i: usize, j: usize| {
            growth(i) * flexibility[i][j] + share * self.modes[self.level].coupling[i][j]
        };
        let [a, b] = [1.0 + per_force(0, 0) * slope[0], per_force(0, 1) * slope[1]];
        let [c, e] = [per_force(1, 0) * slope[0], 1.0 + per_force(1, 1) * slope[1]];
        let determinant = a * e - b * c;
        [(e * error[0] - b * error[1]) / determinant, (a * error[1] - c * error[0]) / determinant]
    }
}
