//! Answers of all oscillators at all points of a step of one length.

use crate::dynamics::collocation::{Collocation, RADAU_POINTS, Response};
use crate::dynamics::system::System;
use crate::numerics::stages::{STAGES, Stages};

/// Everything about a step of one length that does not depend on the state.
#[derive(Debug, Clone)]
pub struct WetTable {
    /// Length of the step in s.
    pub h: f64,
    /// Answers at Radau's points. Shape (STAGES, n).
    answers: Vec<Vec<Response>>,
}

/// Coordinates and their rates at Radau's points of a step, the last of which is its end. Shape (STAGES, n) each.
#[derive(Debug, Clone, Default)]
pub struct StageMotion {
    /// Coordinates.
    pub q: Vec<Vec<f64>>,
    /// Rates.
    pub v: Vec<Vec<f64>>,
}

impl WetTable {
    /// Table of `system` for steps of length `h` s.
    pub fn new(system: &System, collocation: &Collocation<RADAU_POINTS>, h: f64) -> Self {
        let answers = collocation
            .nodes
            .iter()
            .map(|node| system.oscillators.iter().map(|o| collocation.response(o, node * h, h)).collect())
            .collect();
        Self { h, answers }
    }

    /// Motion from the state (`q`, `v`) at the start of the step under the generalised forces `force` at Radau's
    /// points, shape (n).
    pub fn motion(&self, q: &[f64], v: &[f64], force: &[Stages], motion: &mut StageMotion) {
        motion.q.resize(STAGES, Vec::new());
        motion.v.resize(STAGES, Vec::new());
        for (point, answers) in self.answers.iter().enumerate() {
            motion.q[point].clear();
            motion.v[point].clear();
            for (k, answer) in answers.iter().enumerate() {
                let mut at = [
                    answer.displacement_per_displacement * q[k] + answer.displacement_per_velocity * v[k],
                    answer.velocity_per_displacement * q[k] + answer.velocity_per_velocity * v[k],
                ];
                for l in 0..STAGES {
                    at[0] += answer.displacement_per_force[l] * force[k][l];
                    at[1] += answer.velocity_per_force[l] * force[k][l];
                }
                motion.q[point].push(at[0]);
                motion.v[point].push(at[1]);
            }
        }
    }

    /// Change of displacement and rate of coordinate `k` at Radau's point `j` per generalised force at them.
    pub fn per_force(&self, j: usize, k: usize) -> [&Stages; 2] {
        let answer = &self.answers[j][k];
        [&answer.displacement_per_force, &answer.velocity_per_force]
    }
}
