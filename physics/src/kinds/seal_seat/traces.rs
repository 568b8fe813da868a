//! What a seat that relaxes remembers of the forces on its contact nodes.
//!
//! One kernel for bulk and shear: the residual flexibility R yields to effective forces, u = R p, that creep under the true ones,
//! p - sum g_i xi_i = f, xi_i' = (p - xi_i)/tau_i. Over a step in which p changes evenly p = growth (f + trace) at its end, with a
//! trace of the past: the contact problem of every instant is that of a body softer by `growth` under some more forces.

use crate::material::{Creep, Deformation, Relaxation};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// A force in N on a candidate.
pub(super) type Push = (usize, Vector3<f64>);

/// The forces so far on candidates.
#[derive(Debug, Clone)]
pub struct Traces {
    creep: Creep,
    /// Effective forces x, y, z in N, which creep as deformations do.
    effective: BTreeMap<usize, [Deformation; 3]>,
    /// What they amount to in the present step, N, and the true forces before it.
    forces: Vec<Push>,
    before: Vec<Push>,
    /// Work in J on what relaxes: what it stores, and what it has lost.
    pub(super) work: f64,
}

impl Traces {
    /// None yet, of a material that relaxes by `terms`, for steps of `h` s.
    pub fn new(terms: &[Relaxation], h: f64) -> Self {
        let mut creep = Creep::new(terms);
        creep.prepare(h);
        Self { creep, effective: BTreeMap::new(), forces: Vec::new(), before: Vec::new(), work: 0.0 }
    }

    /// How much more than at once the body yields by the end of a step.
    pub fn growth(&self) -> f64 {
        self.creep.growth()
    }

    /// The forces that the past amounts to.
    pub(super) fn forces(&self) -> &[Push] {
        &self.forces
    }

    /// Begins a step after one that ended with the forces `push`, in ascending order of their candidates.
    pub(super) fn pass(&mut self, push: &[Push]) {
        for (candidate, _) in push {
            self.effective.entry(*candidate).or_default();
        }
        self.forces.clear();
        for (&candidate, effective) in &mut self.effective {
            let at = push.binary_search_by_key(&candidate, |(candidate, _)| *candidate);
            let force = at.map_or(Vector3::zeros(), |at| push[at].1);
            for (state, force) in effective.iter_mut().zip(force.iter()) {
                self.creep.advance(state, *force);
            }
            let trace = |c: usize, _| self.creep.deformation(&effective[c], 0.0) / self.creep.growth();
            self.forces.push((candidate, Vector3::from_fn(trace)));
        }
        self.before.clear();
        self.before.extend_from_slice(push);
    }

    /// Books the step that ends with the forces `push` and in which candidates yielded further as `deformation` has it, in m.
    pub(super) fn book(&mut self, push: &[Push], deformation: impl Fn(usize) -> Vector3<f64>) {
        let forces = self.before.iter().chain(push);
        self.work += 0.5 * forces.map(|(candidate, force)| force.dot(&deformation(*candidate))).sum::<f64>();
    }
}
