//! Friction's effect on the motion across the surfaces: forces along them that are known from a run before, and turn or bend what is struck.
//!
//! The forces depend on the motion across the surfaces, and that on them. Each is solved in turn over the whole impact, with the course of the
//! other from the run before, until nothing changes (waveform relaxation: Lelarasmee, Ruehli and Sangiovanni-Vincentelli, IEEE Trans. CAD 1
//! (1982) 131). In a step they are polynomials through the nodes, as the contact forces are, and the oscillators answer exactly.

use super::batch::OscillatorBatch;
use super::collocation::Collocation;
use super::step_table::StepTable;
use super::system::dot;
use crate::numerics::stages::{STAGES, Stages};
use wide::f64x4;

/// Forces along the surfaces over time, and the oscillators that they move.
#[derive(Debug, Clone)]
pub struct FrictionLoad {
    /// By time.
    pub course: Vec<LoadPoint>,
    /// Displacement along x of the surfaces at both contacts per unit of each oscillator's coordinate. Shape (n).
    pub along: Vec<[f64; 2]>,
}

/// What forces along x do to what is struck, at outer and inner contact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LoadPoint {
    /// In s.
    pub time: f64,
    /// Impulses until then, N s.
    pub impulse: [f64; 2],
    /// Forces then, N.
    pub force: [f64; 2],
}

impl FrictionLoad {
    /// Impulses in N s until `time` s, and the forces in N then: a cubic polynomial between the points of the course.
    fn at(&self, time: f64) -> [[f64; 2]; 2] {
        let after = self.course.partition_point(|point| point.time <= time);
        let (Some(from), Some(to)) = (after.checked_sub(1).map(|k| self.course[k]), self.course.get(after))
        else {
            return [self.course.last().map_or([0.0; 2], |last| last.impulse), [0.0; 2]];
        };
        let length = to.time - from.time;
        let u = (time - from.time) / length;
        let polynomial = |i: usize| {
            let [start, end] = [from.force[i], to.force[i]];
            let mean = (to.impulse[i] - from.impulse[i]) / length;
            // of the force: its ends, and the mean in between
            let bent = 3.0 * (2.0 * mean - start - end);
            let force = start + u * (end - start + bent * (1.0 - u));
            let impulse = start + u * (0.5 * (end - start + bent) - u * bent / 3.0);
            [from.impulse[i] + length * u * impulse, force]
        };
        let [outer, inner] = [polynomial(0), polynomial(1)];
        [[outer[0], inner[0]], [outer[1], inner[1]]]
    }

    /// What acts in the step of `h` s from `time` s on: values at the nodes, of which the polynomials have the impulse of the course.
    pub(super) fn step(&self, collocation: &Collocation, time: f64, h: f64) -> StepLoad {
        let [from, to] = [time, time + h].map(|time| self.at(time)[0]);
        let at_nodes = collocation.nodes.map(|node| self.at(time + node * h)[1]);
        let forces = [0, 1].map(|i| {
            let forces = at_nodes.map(|forces| forces[i]);
            let missing = (to[i] - from[i]) / h - dot(&collocation.weights, &forces);
            forces.map(|force| force + missing)
        });
        StepLoad { forces, impulse: [0, 1].map(|i| to[i] - from[i]) }
    }
}

/// Forces along the surfaces in a step.
#[derive(Debug, Clone, Copy)]
pub struct StepLoad {
    /// At the nodes, N. Shape (contacts, STAGES).
    pub forces: [Stages; 2],
    /// Of the step, N s.
    pub impulse: [f64; 2],
}

/// What a load has done in a run.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct GivenLoad {
    /// Impulses in N s along x at outer and inner contact.
    pub(super) impulse: [f64; 2],
    /// Work, J.
    pub(super) work: f64,
}

impl GivenLoad {
    /// Books a step of the `load` with its work in J.
    pub(super) fn book(&mut self, load: &StepLoad, work: f64) {
        (0..2).for_each(|i| self.impulse[i] += load.impulse[i]);
        self.work += work;
    }
}

/// What the oscillators answer to forces along the surfaces in a step of one length.
#[derive(Debug, Clone, Copy)]
pub struct LoadTable {
    /// `across[i][j][l]`: approaches of contact i at all nodes per force along the surface at contact j and node l, m/N.
    across: [[[f64x4; STAGES]; 2]; 2],
    /// The same of the displacements of the surfaces along x.
    along: [[[f64x4; STAGES]; 2]; 2],
}

impl LoadTable {
    /// Of the `table` of `batch`, of which oscillators move the surfaces along x.
    pub(super) fn new(table: &StepTable, batch: &OscillatorBatch, collocation: &Collocation) -> Self {
        let couplings = table.couplings(batch, collocation, |k| {
            let ([a, b], [x, y]) = (batch.blocks[k].approach, batch.along[k]);
            [a * x, a * y, b * x, b * y, x * x, x * y, y * y]
        });
        let [ax, ay, bx, by, xx, xy, yy] = couplings;
        Self { across: [[ax, ay], [bx, by]], along: [[xx, xy], [xy, yy]] }
    }

    /// What a load with the `forces` at the nodes in N adds to the approaches there, m.
    pub(super) fn approach(&self, forces: &[Stages; 2]) -> [f64x4; 2] {
        self.across.each_ref().map(|[outer, inner]| under(outer, &forces[0]) + under(inner, &forces[1]))
    }

    /// The same of the displacements along x of the surfaces, under `contacts` N across them also.
    pub(super) fn along(&self, forces: &[Stages; 2], contacts: &[Stages; 2]) -> [f64x4; 2] {
        std::array::from_fn(|j| {
            let [outer, inner] = &self.along[j];
            let pressed = under(&self.across[0][j], &contacts[0]) + under(&self.across[1][j], &contacts[1]);
            under(outer, &forces[0]) + under(inner, &forces[1]) - pressed
        })
    }
}

/// Answers at the nodes to `forces` there.
fn under(coupling: &[f64x4; STAGES], forces: &Stages) -> f64x4 {
    coupling.iter().zip(forces).fold(f64x4::ZERO, |sum, (answers, force)| sum + *answers * *force)
}
