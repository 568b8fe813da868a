//! Deformation of what relaxes, step by step.

use super::Relaxation;

/// The flow of the internal variables xi' = (w - xi)/tau over one step in which the deformation w changes evenly.
///
/// What yields by e at once under a force is deformed by w = e + sum g_i xi_i.
#[derive(Debug, Clone, Default)]
pub struct Creep {
    terms: Vec<Relaxation>,
    /// Per term: weights of the internal variable before, of the deformation at the step's start and at its end.
    weights: Vec<[f64; 3]>,
    /// Share of the deformation at the end that the terms follow at once.
    at_once: f64,
}

/// State of what relaxes.
#[derive(Debug, Clone, Default)]
pub struct Deformation {
    /// Deformation in m.
    depth: f64,
    /// Internal variables in m. Shape (terms), empty before the first step.
    relaxed: Vec<f64>,
}

impl Deformation {
    /// Deformation in m at the end of the latest step.
    pub fn depth(&self) -> f64 {
        self.depth
    }
}

impl Creep {
    /// Of a material that relaxes by `terms`.
    pub fn new(terms: &[Relaxation]) -> Self {
        Self { terms: terms.to_vec(), weights: vec![[0.0; 3]; terms.len()], at_once: 0.0 }
    }

    /// Prepares steps of `h` s.
    pub fn prepare(&mut self, h: f64) {
        for (weights, term) in self.weights.iter_mut().zip(&self.terms) {
            let x = h / term.time;
            // (1 - e^-x)/x without cancellation
            let mean = -(-x).exp_m1() / x;
            *weights = [(-x).exp(), mean - (-x).exp(), 1.0 - mean];
        }
        self.at_once =
            self.terms.iter().zip(&self.weights).map(|(term, weights)| term.ratio * weights[2]).sum();
    }

    /// Deformation in m at the step's end of what yields by `elastic` m at once.
    pub fn deformation(&self, state: &Deformation, elastic: f64) -> f64 {
        let memory: f64 = self
            .terms
            .iter()
            .zip(&self.weights)
            .enumerate()
            .map(|(k, (term, [old, start, _]))| {
                term.ratio * (old * state.relaxed.get(k).unwrap_or(&0.0) + start * state.depth)
            })
            .sum();
        (elastic + memory) * self.growth()
    }

    /// Deformation at the step's end per elastic one.
    pub fn growth(&self) -> f64 {
        1.0 / (1.0 - self.at_once)
    }

    /// Energy stored in `state` per instantaneous stiffness, m^2: the modulus after a long time, and a Maxwell element per term.
    pub fn stored(&self, state: &Deformation) -> f64 {
        let w = state.depth;
        0.5 * self.extensions(state).fold(w * w, |sum, (term, d)| sum + term.ratio * (d * d - w * w))
    }

    /// Power lost in `state` per instantaneous stiffness, m^2/s.
    pub fn power(&self, state: &Deformation) -> f64 {
        self.extensions(state).map(|(term, d)| term.ratio * d * d / term.time).sum()
    }

    /// Terms and the extension of the spring of each, w - xi in m.
    fn extensions<'a>(&'a self, state: &'a Deformation) -> impl Iterator<Item = (&'a Relaxation, f64)> {
        let of = |k| state.depth - state.relaxed.get(k).unwrap_or(&0.0);
        self.terms.iter().enumerate().map(move |(k, term)| (term, of(k)))
    }

    /// Ends the step with `elastic` m.
    pub fn advance(&self, state: &mut Deformation, elastic: f64) {
        let depth = self.deformation(state, elastic);
        state.relaxed.resize(self.terms.len(), 0.0);
        for (relaxed, [old, start, end]) in state.relaxed.iter_mut().zip(&self.weights) {
            *relaxed = old * *relaxed + start * state.depth + end * depth;
        }
        state.depth = depth;
    }
}
