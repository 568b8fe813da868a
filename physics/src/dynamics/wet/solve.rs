//! The forces of one step: contacts and fluid at Radau's points, by Newton's iteration.
//!
//! The film's answer to the rates is a matrix over inner body and modes. Nearly all of it is what it does
//! against a uniform closing speed: D = g g^T/R with the generalised forces g per unit speed and their resultant R.
//! With that in place of the full matrix a step has twelve unknowns (two contacts and the film's part along g,
//! at four points) however many modes there are; what D leaves out is found by the iteration, or, where that is slow, by
//! Newton's step with the whole matrix.

use super::table::{StageMotion, WetTable};
use crate::dynamics::system::{INNER, System};
use crate::dynamics::wet::{FluidForces, FluidLoad};
use crate::numerics::stages::{STAGES, Stages};
use faer::linalg::solvers::PartialPivLu;

/// Iterations for the forces of a step; more means that the step is too long.
const MAX_ITERATIONS: usize = 30;
/// Error of an iteration over that of the last above which it gains no more, be it for round-off.
const STAGNANT: f64 = 0.5;
/// Error of an iteration over that of the last from which on the fluid's whole tangent is worth its price.
const SLOW: f64 = 0.3;
/// Iterations in a row without a gain after which rounding errors are what is left: a film against which fast bodies hardly
/// move answers to those of their rates.
const STALLS: u32 = 2;
/// Admissible force errors with which such a step is in order.
const ROUNDED: f64 = 100.0;
/// Errors of a rate in its last digit that may come together in a force of the film.
const ROUNDINGS: f64 = 16.0;
/// Unknowns of Newton's step: both contact forces and the film's part along g at every point of a step.
const UNKNOWNS: usize = 3 * STAGES;

/// Last of Radau's points: the end of the step.
pub const END: usize = STAGES - 1;

/// A solved step, not yet accepted. Everything is at Radau's points, the last of which is the end.
#[derive(Debug, Clone, Default)]
pub struct Trial {
    /// Motion.
    pub motion: StageMotion,
    /// Modal approach of both contacts in m.
    pub approach: [Stages; 2],
    /// Patches of both contacts, see [`System::contact`].
    pub local: [Stages; 2],
    /// Forces of both contacts in N.
    pub forces: [Stages; 2],
    /// What the contacts answer to the motion at the end in N: `forces` there, but for the error of the iteration.
    pub end_force: [f64; 2],
    /// Generalised forces of the fluid, from the inner body's on. Shape (size).
    pub fluid: Vec<Stages>,
    /// What the fluid does, whose forces act: in the motion before the last correction. Shape (STAGES).
    pub loads: Vec<FluidLoad>,
    /// The equations of Newton's step with the fluid's whole tangent, once it has been worth its price.
    pub(super) factors: Option<Factors>,
}

/// The bodies and the fluid between them.
#[derive(Clone, Copy)]
pub struct Wet<'a> {
    pub system: &'a System,
    pub fluid: &'a FluidForces,
}

impl Wet<'_> {
    /// Solves for the forces of a step from the state (`q`, `v`), from those in `trial` on; `false` if the iteration
    /// does not settle within `force_error` N or the contact has no equilibrium.
    pub fn solve(&self, table: &WetTable, q: &[f64], v: &[f64], force_error: f64, trial: &mut Trial) -> bool {
        let (mut last, mut best, mut stalls) = (f64::INFINITY, f64::INFINITY, 0);
        for iteration in 0..MAX_ITERATIONS {
            table.motion(q, v, &self.generalised(trial), &mut trial.motion);
            let Some(defect) = self.defect(trial) else { return false };
            let size = self.size(&defect);
            stalls = if size > STAGNANT * last { stalls + 1 } else { 0 };
            best = size.min(best);
            // in a very short step any guess gives the right impulse, but not the right energy
            let converged = size <= force_error && iteration > 0;
            let rounded = stalls >= STALLS
                && size <= 2.0 * best
                && size <= (ROUNDED * force_error).max(self.rounding(trial));
            if converged || rounded {
                return self.balance(table, q, v, trial);
            }
            let slow = size > SLOW * last;
            let solved = size.is_finite()
                && if slow || trial.factors.is_some() {
                    let fit = |factors: &Factors| !slow && factors.h == table.h;
                    let factors = trial
                        .factors
                        .take()
                        .filter(fit)
                        .unwrap_or_else(|| self.factors(table, &defect, trial));
                    let solved = self.full_newton(&factors, &defect, trial);
                    trial.factors = Some(factors);
                    solved
                } else {
                    self.newton(table, &defect, trial)
                };
            if !solved {
                return false;
            }
            last = size;
        }
        false
    }

    /// Makes the fluid's last answer the force that acts: to the last digit the same on both sides of the film, so that what
    /// the iteration leaves can't unbalance the momenta, step after step. The motion follows; the fluid is not asked again,
    /// since a stiff film would magnify the difference, which the next step stops. `false` if the contact has no
    /// equilibrium.
    fn balance(&self, table: &WetTable, q: &[f64], v: &[f64], trial: &mut Trial) -> bool {
        for (k, fluid) in trial.fluid.iter_mut().enumerate() {
            *fluid = std::array::from_fn(|j| trial.loads[j].force[k]);
        }
        table.motion(q, v, &self.generalised(trial), &mut trial.motion);
        for j in 0..STAGES {
            let approach = self.system.modal_approach(&trial.motion.q[j]);
            let Some((local, force)) = self.system.contact(approach, approach) else { return false };
            for i in 0..2 {
                (trial.approach[i][j], trial.local[i][j]) = (approach[i], local[i]);
            }
            trial.end_force = force;
        }
        true
    }

    /// Generalised forces of contacts and fluid at Radau's points. Shape (n).
    pub fn generalised(&self, trial: &Trial) -> Vec<Stages> {
        let [b0, b1] = &self.system.approach;
        let [f0, f1] = &trial.forces;
        let mut force: Vec<Stages> =
            b0.iter().zip(b1).map(|(b0, b1)| std::array::from_fn(|l| -b0 * f0[l] - b1 * f1[l])).collect();
        for (force, fluid) in force[INNER..].iter_mut().zip(&trial.fluid) {
            for l in 0..STAGES {
                force[l] += fluid[l];
            }
        }
        force
    }

    /// What contacts and fluid answer to the motion, less what was assumed.
    fn defect(&self, trial: &mut Trial) -> Option<Defect> {
        let mut defect = Defect {
            contact: [[0.0; STAGES]; 2],
            tangent: [[[0.0; 2]; 2]; STAGES],
            fluid: vec![[0.0; STAGES]; trial.fluid.len()],
        };
        for j in 0..STAGES {
            let (q, v) = (&trial.motion.q[j], &trial.motion.v[j]);
            let approach = self.system.modal_approach(q);
            let (local, force) = self.system.contact(approach, approach)?;
            defect.tangent[j] = self.system.tangent(local);
            trial.end_force = force;
            for i in 0..2 {
                trial.approach[i][j] = approach[i];
                trial.local[i][j] = local[i];
                defect.contact[i][j] = force[i] - trial.forces[i][j];
            }
            self.fluid.evaluate(q, v, self.system.indentation(local), &mut trial.loads[j]);
            for (k, force) in trial.loads[j].force.iter().enumerate() {
                defect.fluid[k][j] = force - trial.fluid[k][j];
            }
        }
        Some(defect)
    }

    /// Largest force in N that is missing; generalised forces as if they acted on the inner body.
    fn size(&self, defect: &Defect) -> f64 {
        let largest = |values: &[Stages]| {
            // a value that is no number has to come out
            values
                .iter()
                .flatten()
                .fold(0.0, |largest: f64, x| if x.abs() <= largest { largest } else { x.abs() })
        };
        let (contact, fluid) =
            (largest(&defect.contact), largest(&defect.fluid) * self.system.masses[1].sqrt());
        if contact >= fluid || contact.is_nan() { contact } else { fluid }
    }

    /// What rounding of the rates makes of the film's forces, as [`Self::size`] counts them, N: their parts from each coordinate, of
    /// which next to nothing may be left where fast bodies move together.
    fn rounding(&self, trial: &Trial) -> f64 {
        let at = |(load, v): (&FluidLoad, &Vec<f64>)| {
            let parts: f64 =
                load.unit_force.iter().zip(&v[INNER..]).map(|(force, v)| (force * v).abs()).sum();
            let largest = load.unit_force.iter().fold(0.0, |largest: f64, force| largest.max(force.abs()));
            if load.resistance > 0.0 { parts * largest / load.resistance } else { 0.0 }
        };
        let parts = trial.loads.iter().zip(&trial.motion.v).map(at).fold(0.0, f64::max);
        ROUNDINGS * f64::EPSILON * parts * self.system.masses[1].sqrt()
    }

    /// Improves the forces; `false` if the equations are singular.
    fn newton(&self, table: &WetTable, defect: &Defect, trial: &mut Trial) -> bool {
        let n = self.system.size();
        // directions in which the forces at point l can change: contact 0, contact 1, film
        let film: Vec<Vec<f64>> = (0..STAGES)
            .map(|l| {
                let mut full = vec![0.0; n];
                for (k, force) in trial.loads[l].unit_force.iter().enumerate() {
                    full[INNER + k] = -force;
                }
                full
            })
            .collect();
        let [b0, b1] = &self.system.approach;
        let mut matrix = [[0.0; UNKNOWNS + 1]; UNKNOWNS];
        for j in 0..STAGES {
            let resistance = trial.loads[j].resistance;
            for l in 0..STAGES {
                // approaches of both contacts and closing force of the film, per direction and for the defect
                let mut answer = [[0.0; 4]; 3];
                for k in 0..n {
                    let [per_q, per_v] = table.per_force(j, k).map(|stages| stages[l]);
                    let fluid =
                        if k < INNER { 0.0 } else { defect.fluid.get(k - INNER).map_or(0.0, |d| d[l]) };
                    let forces = [-b0[k], -b1[k], film[l][k], fluid];
                    let seen = [b0[k] * per_q, b1[k] * per_q, -film[j][k] * per_v];
                    for row in 0..3 {
                        for column in 0..4 {
                            answer[row][column] += seen[row] * forces[column];
                        }
                    }
                }
                let tangent = defect.tangent[j];
                for column in 0..4 {
                    let at = if column == 3 { UNKNOWNS } else { column * STAGES + l };
                    let sign = if column == 3 { 1.0 } else { -1.0 };
                    for i in 0..2 {
                        let force = tangent[i][0] * answer[0][column] + tangent[i][1] * answer[1][column];
                        matrix[i * STAGES + j][at] += sign * force;
                    }
                    if resistance > 0.0 {
                        matrix[2 * STAGES + j][at] += sign * answer[2][column] / resistance;
                    }
                }
            }
        }
        for row in 0..UNKNOWNS {
            matrix[row][row] += 1.0;
        }
        for i in 0..2 {
            for j in 0..STAGES {
                matrix[i * STAGES + j][UNKNOWNS] += defect.contact[i][j];
            }
        }
        let Some(change) = eliminate(matrix) else { return false };
        for i in 0..2 {
            for j in 0..STAGES {
                trial.forces[i][j] += change[i * STAGES + j];
            }
        }
        for (k, fluid) in trial.fluid.iter_mut().enumerate() {
            for j in 0..STAGES {
                fluid[j] += defect.fluid[k][j] + film[j][INNER + k] * change[2 * STAGES + j];
            }
        }
        true
    }
}

/// Forces that are missing at Radau's points.
pub(super) struct Defect {
    pub contact: [Stages; 2],
    /// Change of both contact forces per modal approach of both. Shape (STAGES, 2, 2).
    pub tangent: [[[f64; 2]; 2]; STAGES],
    pub fluid: Vec<Stages>,
}

/// Factored equations of steps of one length.
#[derive(Debug, Clone)]
pub(super) struct Factors {
    /// Length of the step in s.
    pub(super) h: f64,
    pub(super) lu: PartialPivLu<f64>,
}

/// Solution of the linear equations with the right-hand side in the last column, by Gauss with row pivots.
fn eliminate(mut a: [[f64; UNKNOWNS + 1]; UNKNOWNS]) -> Option<[f64; UNKNOWNS]> {
    for column in 0..UNKNOWNS {
        let pivot = (column..UNKNOWNS).max_by(|i, j| a[*i][column].abs().total_cmp(&a[*j][column].abs()))?;
        if !(a[pivot][column].is_finite() && a[pivot][column] != 0.0) {
            return None;
        }
        a.swap(column, pivot);
        let upper = a[column];
        for row in a.iter_mut().skip(column + 1) {
            let factor = row[column] / upper[column];
            for (entry, above) in row.iter_mut().zip(&upper).skip(column) {
                *entry -= factor * above;
            }
        }
    }
    let mut solution = [0.0; UNKNOWNS];
    for row in (0..UNKNOWNS).rev() {
        let known: f64 = (row + 1..UNKNOWNS).map(|k| a[row][k] * solution[k]).sum();
        solution[row] = (a[row][UNKNOWNS] - known) / a[row][row];
    }
    Some(solution)
}
