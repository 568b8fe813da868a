//! Friction's effect on the motion across the surfaces: forces along them that are known from a run before, and turn or bend what is struck.
//!
//! The forces along the surfaces depend on those across them, and these on the motion that both cause. Each is solved in turn over the whole
//! impact, with the course of the other from the run before, until nothing changes (waveform relaxation: Lelarasmee, Ruehli and
//! Sangiovanni-Vincentelli, IEEE Trans. CAD 1 (1982) 131). What a run takes over is the share of the force across that acts along the surface:
//! of a contact that slides it is the coefficient of friction, whatever the force comes to, so that two rounds are enough. If they took over
//! forces, they would diverge where friction excites modes more than the contact force does.

use super::batch::OscillatorBatch;
use super::collocation::Collocation;
use super::step_table::StepTable;
use super::system::dot;
use crate::numerics::stages::{STAGES, Stages};
use wide::f64x4;

/// Forces along the surfaces over those across them in the course of an impact, and the oscillators that they move.
#[derive(Debug, Clone)]
pub struct FrictionLoad {
    /// Times in s, ascending, and the ratio of the forces on what is struck then, along x over across, at outer and inner contact.
    pub course: Vec<(f64, [f64; 2])>,
    /// Displacement along x of the surfaces at both contacts per unit of each oscillator's coordinate. Shape (n).
    pub along: Vec<[f64; 2]>,
}

impl FrictionLoad {
    /// The ratios at `time` s.
    fn at(&self, time: f64) -> [f64; 2] {
        let after = self.course.partition_point(|(at, _)| *at <= time);
        match (after.checked_sub(1).map(|before| self.course[before]), self.course.get(after)) {
            (Some((from, start)), Some((to, end))) => {
                let share = (time - from) / (to - from);
                [0, 1].map(|i| start[i] + share * (end[i] - start[i]))
            }
            (Some((_, last)), None) => last,
            (None, _) => [0.0; 2],
        }
    }

    /// The ratios at the nodes of the step of `h` s from `time` s on. Shape (contacts, STAGES).
    pub(super) fn step(&self, collocation: &Collocation, time: f64, h: f64) -> [Stages; 2] {
        let at_nodes = collocation.nodes.map(|node| self.at(time + node * h));
        [0, 1].map(|i| at_nodes.map(|ratios| ratios[i]))
    }
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
    /// Books a step of `h` s with the `forces` along x at the nodes in N and their work in J.
    pub(super) fn book(&mut self, collocation: &Collocation, h: f64, forces: &[Stages; 2], work: f64) {
        (0..2).for_each(|i| self.impulse[i] += h * dot(&collocation.weights, &forces[i]));
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

    /// The `coupling` of a step table if forces along the surfaces are `ratios` of those across them: approaches lost per force, contacts (0,0),
    /// (0,1), (1,0), (1,1).
    pub(super) fn coupling(
        &self,
        [own0, mutual, own1]: &[[f64x4; STAGES]; 3],
        ratios: &[Stages; 2],
    ) -> [[f64x4; STAGES]; 4] {
        let less = |of: &[f64x4; STAGES], i: usize, j: usize| {
            std::array::from_fn(|l| of[l] - self.across[i][j][l] * ratios[j][l])
        };
        [less(own0, 0, 0), less(mutual, 0, 1), less(mutual, 1, 0), less(own1, 1, 1)]
    }

    /// What `forces` along the surfaces and `contacts` across them, at the nodes in N, add to the displacements along x there, m.
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
