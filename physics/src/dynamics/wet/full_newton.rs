//! Newton's step for the forces of a step with the whole tangent of the fluid.
//!
//! Where a film lies over several waves of a soft plate, what it does against the uniform closing speed is not nearly all
//! of it, and the iteration with that alone settles for very short steps only. Here all generalised forces of the fluid
//! are unknowns: with n coordinates that it acts on, (2 + n) times the points of a step. The factored equations serve as
//! long as the iteration gains enough by them, from step to step of one length.

use super::solve::{Defect, Factors, Trial, Wet};
use super::table::WetTable;
use crate::dynamics::system::INNER;
use crate::numerics::stages::STAGES;
use faer::Mat;
use faer::linalg::solvers::Solve;

/// Place of the force of contact `i` among the unknowns.
fn contact(i: usize, stage: usize) -> usize {
    i * STAGES + stage
}

/// Place of the generalised force of the fluid on its coordinate `k`.
fn load(k: usize, stage: usize) -> usize {
    (2 + k) * STAGES + stage
}

impl Wet<'_> {
    /// The equations for steps of the length of `table`, with the tangents in the motion of `trial`.
    pub(super) fn factors(&self, table: &WetTable, defect: &Defect, trial: &Trial) -> Factors {
        let fluid = trial.fluid.len();
        let size = (2 + fluid) * STAGES;
        let mut matrix = Mat::<f64>::identity(size, size);
        for j in 0..STAGES {
            let tangent = self.fluid.tangent(&trial.motion.v[j], &trial.loads[j]);
            for l in 0..self.system.size() {
                let approach = [0, 1].map(|i| self.system.approach[i][l]);
                let [place, rate] = table.per_force(j, l);
                for s in 0..STAGES {
                    // what coordinate l answers at j to a force on it at s moves contacts and fluid at j
                    let moved = |row: usize, answer: f64, matrix: &mut Mat<f64>| {
                        for i in 0..2 {
                            matrix[(row, contact(i, s))] += answer * approach[i];
                        }
                        if l >= INNER && l - INNER < fluid {
                            matrix[(row, load(l - INNER, s))] -= answer;
                        }
                    };
                    for i in 0..2 {
                        let [d0, d1] = defect.tangent[j][i];
                        moved(contact(i, j), (d0 * approach[0] + d1 * approach[1]) * place[s], &mut matrix);
                    }
                    if l >= INNER && l - INNER < fluid {
                        for k in 0..fluid {
                            let at = k * fluid + l - INNER;
                            let answer = tangent.per_rate[at] * rate[s] + tangent.per_place[at] * place[s];
                            moved(load(k, j), answer, &mut matrix);
                        }
                    }
                }
            }
        }
        Factors { h: table.h, lu: matrix.partial_piv_lu() }
    }

    /// Improves the forces by the `factors`; `false` if their equations are singular.
    pub(super) fn full_newton(&self, factors: &Factors, defect: &Defect, trial: &mut Trial) -> bool {
        let fluid = trial.fluid.len();
        let mut change = Mat::<f64>::zeros((2 + fluid) * STAGES, 1);
        for j in 0..STAGES {
            for i in 0..2 {
                change[(contact(i, j), 0)] = defect.contact[i][j];
            }
            for k in 0..fluid {
                change[(load(k, j), 0)] = defect.fluid[k][j];
            }
        }
        factors.lu.solve_in_place(&mut change);
        if !(0..change.nrows()).all(|row| change[(row, 0)].is_finite()) {
            return false;
        }
        for j in 0..STAGES {
            for i in 0..2 {
                // factors from when the contact was closed know no open one
                let open = defect.tangent[j][i] == [0.0; 2];
                trial.forces[i][j] = if open { 0.0 } else { trial.forces[i][j] + change[(contact(i, j), 0)] };
            }
            for k in 0..fluid {
                trial.fluid[k][j] += change[(load(k, j), 0)];
            }
        }
        true
    }
}
