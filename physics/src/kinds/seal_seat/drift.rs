//! Exact motion of the seat's modes between two kicks.

use super::system::{State, System};
use crate::dynamics::memory::ModeFlow;
use crate::material::Relaxation;
use crate::numerics::duhamel::Oscillator;

/// The flow of all modes over one step.
pub(super) enum Drift<'a> {
    Elastic(Rotation),
    Relaxing(Flow<'a>),
}

/// Of an elastic seat.
pub(super) struct Rotation {
    cos: Vec<f64>,
    /// sin(omega h) / omega
    sinc: Vec<f64>,
    /// -omega sin(omega h)
    back: Vec<f64>,
}

/// Of a seat that relaxes: every mode with the internal variables of its material.
pub(super) struct Flow<'a> {
    terms: &'a [Relaxation],
    modes: Vec<ModeFlow>,
}

impl<'a> Drift<'a> {
    /// Of the modes of `system`, over `step` s.
    pub(super) fn over(system: &'a System, step: f64) -> Self {
        let terms = &system.relaxation[..];
        if terms.is_empty() {
            return Self::Elastic(Rotation::over(&system.omega, step));
        }
        let mode = |&omega: &f64| ModeFlow::new(Oscillator { omega, alpha: 0.0 }, terms, step, 0);
        Self::Relaxing(Flow { terms, modes: system.omega.iter().map(mode).collect() })
    }

    /// Moves the modes of `state`; the energy in J that they lose.
    pub(super) fn apply(&self, state: &mut State) -> f64 {
        match self {
            Self::Elastic(rotation) => {
                rotation.apply(state);
                0.0
            }
            Self::Relaxing(flow) => flow.apply(state),
        }
    }

    /// Largest displacement that every mode can still reach by itself, m kg^(1/2). Shape (N).
    pub(super) fn reach(&self, system: &System, state: &State) -> Vec<f64> {
        match self {
            Self::Elastic(_) => {
                let modes = system.omega.iter().zip(&state.modal).zip(&state.modal_velocity);
                modes.map(|((omega, q), v)| q.hypot(v / omega)).collect()
            }
            Self::Relaxing(flow) => {
                let of = |(k, mode): (usize, &ModeFlow)| mode.reach(&flow.of_mode(state, k), flow.terms);
                flow.modes.iter().enumerate().map(of).collect()
            }
        }
    }
}

impl Rotation {
    fn over(omega: &[f64], step: f64) -> Self {
        Self {
            cos: omega.iter().map(|w| (w * step).cos()).collect(),
            sinc: omega.iter().map(|w| (w * step).sin() / w).collect(),
            back: omega.iter().map(|w| -(w * step).sin() * w).collect(),
        }
    }

    fn apply(&self, state: &mut State) {
        for (k, (q, v)) in state.modal.iter_mut().zip(&mut state.modal_velocity).enumerate() {
            (*q, *v) = (*q * self.cos[k] + *v * self.sinc[k], *q * self.back[k] + *v * self.cos[k]);
        }
    }
}

impl Flow<'_> {
    /// Displacement, velocity and internal variables of mode `k`.
    fn of_mode(&self, state: &State, k: usize) -> Vec<f64> {
        let terms = self.terms.len();
        let relaxed = &state.relaxed[k * terms..(k + 1) * terms];
        [&[state.modal[k], state.modal_velocity[k]], relaxed].concat()
    }

    fn apply(&self, state: &mut State) -> f64 {
        let terms = self.terms.len();
        let mut lost = 0.0;
        for (k, mode) in self.modes.iter().enumerate() {
            let now = self.of_mode(state, k);
            let mut next = vec![0.0; now.len()];
            mode.fly(&now, &mut next);
            (state.modal[k], state.modal_velocity[k]) = (next[0], next[1]);
            state.relaxed[k * terms..(k + 1) * terms].copy_from_slice(&next[2..]);
            // the motion is exact, and so is what it loses
            lost += mode.energy(&now, self.terms)[0] - mode.energy(&next, self.terms)[0];
        }
        lost
    }
}
