//! Answers of all oscillators at all points of a step of one length.

use crate::impact::collocation::{Collocation, Response, STAGES, Stages};
use crate::impact::system::System;

/// Gauss points of a step and its end.
pub const POINTS: usize = STAGES + 1;

/// Everything about a step of one length that does not depend on the state.
#[derive(Debug, Clone)]
pub struct Table {
    /// Length of the step in s.
    pub h: f64,
    /// Answers at the Gauss points and at the end. Shape (POINTS, n).
    answers: Vec<Vec<Response>>,
}

/// Coordinates and their rates at the points of a step. Shape (POINTS, n) each.
#[derive(Debug, Clone, Default)]
pub struct Motion {
    /// Coordinates.
    pub q: Vec<Vec<f64>>,
    /// Rates.
    pub v: Vec<Vec<f64>>,
}

impl Table {
    /// Table of `system` for steps of length `h` s.
    pub fn new(system: &System, collocation: &Collocation, h: f64) -> Self {
        let time = |point: usize| collocation.nodes.get(point).map_or(h, |node| node * h);
        let answers = (0..POINTS)
            .map(|point| system.oscillators.iter().map(|o| collocation.response(o, time(point), h)).collect())
            .collect();
        Self { h, answers }
    }

    /// Motion from the state (`q`, `v`) at the start of the step under the generalised forces `force` at the Gauss
    /// points, shape (n).
    pub fn motion(&self, q: &[f64], v: &[f64], force: &[Stages], motion: &mut Motion) {
        motion.q.resize(POINTS, Vec::new());
        motion.v.resize(POINTS, Vec::new());
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

    /// Change of displacement and rate of coordinate `k` at Gauss point `j` per generalised force at the Gauss points.
    pub fn per_force(&self, j: usize, k: usize) -> [&Stages; 2] {
        let answer = &self.answers[j][k];
        [&answer.displacement_per_force, &answer.velocity_per_force]
    }
}
