//! The bodies' modes with the internal variables of their materials: exact steps under forces that change evenly.
//!
//! Of a viscoelastic body with one kernel for bulk and shear every mode obeys
//! q'' + 2 alpha q' + omega^2 (q - sum g_i xi_i) = f, xi_i' = (q - xi_i)/tau_i: a linear system of its own, whose flow over a step is a
//! matrix exponential.

use super::step_force::StepForce;
use crate::dynamics::system::System;
use crate::material::Relaxation;
use crate::numerics::duhamel::Oscillator;
use nalgebra::DMatrix;
use std::ops::Range;

/// One mode: its flow over a step.
#[derive(Debug)]
pub(crate) struct ModeFlow {
    oscillator: Oscillator,
    /// Displacement, velocity and internal variables at the end per each at the start, row by row. Shape (n, n).
    flow: Vec<f64>,
    /// The same per force at the start and at the end of the step. Shapes (n).
    forced: [Vec<f64>; 2],
    /// Where its state begins.
    first: usize,
}

/// All modes of a system, and the relaxation of those of the plate.
pub(super) struct ModeSet<'a> {
    system: &'a System,
    terms: &'a [Relaxation],
    modes: Vec<ModeFlow>,
    /// Flows of the modes without a force over 2, 4, 8, ... steps, those that have been asked for.
    longer: Vec<Vec<Vec<f64>>>,
    /// Approaches lost at the end of a step per force that acts in it, m/N.
    pub(super) coupling: [[f64; 2]; 2],
}

impl<'a> ModeSet<'a> {
    /// The modes of `system`, whose plate relaxes by `terms`, for steps of `h` s under forces of the kind `step_force`.
    pub(super) fn new(system: &'a System, terms: &'a [Relaxation], h: f64, step_force: StepForce) -> Self {
        let (mut modes, mut first) = (Vec::new(), 0);
        let plate = system.elastic();
        for (k, &oscillator) in system.oscillators.iter().enumerate() {
            let mode = ModeFlow::new(oscillator, if plate.contains(&k) { terms } else { &[] }, h, first);
            first += mode.size();
            modes.push(mode);
        }
        let mut coupling = [[0.0; 2]; 2];
        for (k, mode) in modes.iter().enumerate() {
            let [start, end] = [0, 1].map(|at| mode.forced[at][0]);
            let moved = match step_force {
                StepForce::Conserving | StepForce::Mean => start + end,
                StepForce::Linear => end,
            };
            for i in 0..2 {
                for j in 0..2 {
                    coupling[i][j] += system.approach[i][k] * system.approach[j][k] * moved;
                }
            }
        }
        Self { system, terms, modes, longer: Vec::new(), coupling }
    }

    /// The state in which the impact begins.
    pub(super) fn start(&self) -> Vec<f64> {
        let [q, v] = &self.system.start;
        let mut state = Vec::new();
        for (k, mode) in self.modes.iter().enumerate() {
            state.extend([q[k], v[k]]);
            state.resize(mode.first + mode.size(), q[k]);
        }
        state
    }

    /// The state `state` after a step under contact forces that go from `forces[0]` to `forces[1]`, in N.
    pub(super) fn advance(&self, state: &[f64], forces: [[f64; 2]; 2], next: &mut [f64]) {
        for (k, mode) in self.modes.iter().enumerate() {
            let force =
                forces.map(|f| -(self.system.approach[0][k] * f[0] + self.system.approach[1][k] * f[1]));
            let n = mode.size();
            let now = &state[mode.first..mode.first + n];
            for row in 0..n {
                let free: f64 = mode.flow[row * n..(row + 1) * n].iter().zip(now).map(|(a, x)| a * x).sum();
                next[mode.first + row] =
                    free + mode.forced[0][row] * force[0] + mode.forced[1][row] * force[1];
            }
        }
    }

    /// The state `state` after 2^`doublings` steps without a force.
    pub(super) fn fly(&mut self, state: &[f64], doublings: usize, next: &mut [f64]) {
        while self.longer.len() < doublings {
            let twice = |flow: &Vec<f64>| {
                let n = flow.len().isqrt();
                let entry = |at: usize| (0..n).map(|k| flow[at / n * n + k] * flow[k * n + at % n]).sum();
                (0..n * n).map(entry).collect()
            };
            let flows = match self.longer.last() {
                Some(flows) => flows.iter().map(twice).collect(),
                None => self.modes.iter().map(|mode| twice(&mode.flow)).collect(),
            };
            self.longer.push(flows);
        }
        for (k, mode) in self.modes.iter().enumerate() {
            let flow = doublings.checked_sub(1).map_or(&mode.flow, |at| &self.longer[at][k]);
            move_by(flow, &state[mode.own()], &mut next[mode.own()]);
        }
    }

    /// Displacements and velocities of the modes in `state`. Shapes (modes).
    pub(super) fn motion(&self, state: &[f64]) -> [Vec<f64>; 2] {
        [0, 1].map(|entry| self.modes.iter().map(|mode| state[mode.first + entry]).collect())
    }

    /// Energy of all modes in J, and the power in W that they lose.
    pub(super) fn energy(&self, state: &[f64]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for mode in &self.modes {
            let [energy, power] = mode.energy(&state[mode.own()], self.terms);
            (sum[0], sum[1]) = (sum[0] + energy, sum[1] + power);
        }
        sum
    }

    /// Largest rate that every mode can have by itself with the energy of its `state`, m/s kg^(1/2); none of a rigid motion.
    pub(super) fn most_speeds(&self, state: &[f64]) -> Vec<f64> {
        let speed = |mode: &ModeFlow| match mode.oscillator.omega > 0.0 {
            true => (2.0 * mode.energy(&state[mode.own()], self.terms)[0]).sqrt(),
            false => 0.0,
        };
        self.modes.iter().map(speed).collect()
    }

    /// Largest displacement that every mode can still reach by itself, m kg^(1/2); none of a rigid motion.
    pub(super) fn reach(&self, state: &[f64]) -> Vec<f64> {
        self.modes.iter().map(|mode| mode.reach(&state[mode.own()], self.terms)).collect()
    }
}

/// `next` as the flow `flow` has it from `now`.
fn move_by(flow: &[f64], now: &[f64], next: &mut [f64]) {
    for (row, next) in flow.chunks(now.len()).zip(next) {
        *next = row.iter().zip(now).map(|(a, x)| a * x).sum();
    }
}

impl ModeFlow {
    /// Relaxing by `terms`, for steps of `h` s; its state (displacement, velocity, internal variables) begins at `first` of all states.
    pub(crate) fn new(oscillator: Oscillator, terms: &[Relaxation], h: f64, first: usize) -> Self {
        let Oscillator { omega, alpha } = oscillator;
        let n = 2 + terms.len();
        // velocities in units that keep the matrix balanced; the force and its change over the step stand behind the state
        let unit = omega.max(1.0 / h);
        let mut rates = DMatrix::zeros(n + 2, n + 2);
        rates[(0, 1)] = unit * h;
        rates[(1, 0)] = -omega * omega * h / unit;
        rates[(1, 1)] = -2.0 * alpha * h;
        for (i, term) in terms.iter().enumerate() {
            rates[(1, 2 + i)] = term.ratio * omega * omega * h / unit;
            (rates[(2 + i, 0)], rates[(2 + i, 2 + i)]) = (h / term.time, -h / term.time);
        }
        (rates[(1, n)], rates[(n, n + 1)]) = (h / unit, 1.0);
        let exponential = rates.exp();
        let scale = |row: usize| if row == 1 { unit } else { 1.0 };
        let mut flow = vec![0.0; n * n];
        for row in 0..n {
            for column in 0..n {
                flow[row * n + column] = scale(row) / scale(column) * exponential[(row, column)];
            }
        }
        let at_end = |row: usize| scale(row) * exponential[(row, n + 1)];
        let at_start = |row: usize| scale(row) * exponential[(row, n)] - at_end(row);
        let forced = [(0..n).map(at_start).collect(), (0..n).map(at_end).collect()];
        Self { oscillator, flow, forced, first }
    }

    fn size(&self) -> usize {
        self.forced[0].len()
    }

    /// Where its state stands.
    fn own(&self) -> Range<usize> {
        self.first..self.first + self.size()
    }

    /// The state `now` of this mode after a step without a force.
    pub(crate) fn fly(&self, now: &[f64], next: &mut [f64]) {
        move_by(&self.flow, now, next);
    }

    /// Energy in J in its state, and the power in W that it loses.
    pub(crate) fn energy(&self, state: &[f64], terms: &[Relaxation]) -> [f64; 2] {
        let [q, v] = [state[0], state[1]];
        let stiffness = self.oscillator.omega.powi(2);
        let mut sum = [0.5 * (v * v + stiffness * q * q), 2.0 * self.oscillator.alpha * v * v];
        for (xi, term) in state[2..].iter().zip(terms) {
            // the modulus after a long time, and a Maxwell element per term
            sum[0] += 0.5 * stiffness * term.ratio * ((q - xi).powi(2) - q * q);
            sum[1] += stiffness * term.ratio * (q - xi).powi(2) / term.time;
        }
        sum
    }

    /// Largest displacement that it can still reach from its state by itself, m kg^(1/2); none of a rigid motion.
    pub(crate) fn reach(&self, state: &[f64], terms: &[Relaxation]) -> f64 {
        let omega = self.oscillator.omega;
        if omega == 0.0 {
            return 0.0;
        }
        let [q, v] = [state[0], state[1]];
        if state.len() == 2 {
            return q.hypot(v / omega);
        }
        let relaxed = 1.0 - terms.iter().map(|term| term.ratio).sum::<f64>();
        let maxwell = state[2..].iter().zip(terms).map(|(xi, term)| term.ratio * (q - xi).powi(2));
        let energy = (v / omega).powi(2) + relaxed * q * q + maxwell.sum::<f64>();
        (energy / relaxed).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::Complex;

    /// Free vibration decays with the root of s^2 + omega^2 (1 - sum g/(1 + s tau)) = 0 near i omega, whatever the step.
    #[test]
    fn a_mode_decays_with_the_root_of_its_characteristic_polynomial() {
        let omega = 2e5;
        let terms = [Relaxation { ratio: 0.2, time: 3e-6 }, Relaxation { ratio: 0.1, time: 4e-5 }];
        let value = |s: Complex<f64>| {
            let shares = terms.iter().map(|term| Complex::from(term.ratio) / (s * term.time + 1.0));
            s * s + (Complex::from(1.0) - shares.sum::<Complex<f64>>()) * omega * omega
        };
        let mut root = Complex::new(0.0, omega);
        for _ in 0..60 {
            let step = Complex::new(1e-4 * omega, 0.0);
            root -= value(root) * step * 2.0 / (value(root + step) - value(root - step));
        }
        // a state that is the root's vector keeps its form
        let state = |at: Complex<f64>| {
            let xi = terms.map(|term| at / (root * term.time + 1.0));
            [at.re, (root * at).re, xi[0].re, xi[1].re]
        };
        for (h, steps) in [(1e-7, 500), (2e-5, 3)] {
            let mode = ModeFlow::new(Oscillator { omega, alpha: 0.0 }, &terms, h, 0);
            let mut now = state(Complex::from(1.0));
            for _ in 0..steps {
                now = std::array::from_fn(|row| {
                    (0..4).map(|column| mode.flow[4 * row + column] * now[column]).sum()
                });
            }
            let exact = state((root * h * f64::from(steps)).exp());
            for (found, exact) in now.iter().zip(exact) {
                assert_relative_eq!(
                    *found,
                    exact,
                    epsilon = 1e-9 * omega * f64::from(exact.abs() > 1.0) + 1e-9
                );
            }
        }
    }

    /// Under a force that grows evenly an oscillator at rest moves by F/omega^2 (t/h - sin(omega t)/(omega h)).
    #[test]
    fn a_force_that_grows_evenly_is_answered_exactly() {
        let (omega, h) = (3e5, 1e-5);
        let mode = ModeFlow::new(Oscillator { omega, alpha: 0.0 }, &[], h, 0);
        let x = omega * h;
        assert_relative_eq!(mode.forced[1][0], (1.0 - x.sin() / x) / (omega * omega), max_relative = 1e-12);
        assert_relative_eq!(mode.forced[1][1], (1.0 - x.cos()) / (omega * x), max_relative = 1e-12);
        assert_relative_eq!(
            mode.forced[0][0] + mode.forced[1][0],
            (1.0 - x.cos()) / (omega * omega),
            max_relative = 1e-12
        );
    }
}
