//! What happens along the surfaces and changes the motion across them: forces along them, which turn or bend what is struck, and contacts that
//! move over it. Both are known from a run before.
//!
//! The forces along the surfaces depend on those across them, and these on the motion that both cause. Each is solved in turn over the whole
//! impact, with the course of the other from the run before, until nothing changes (waveform relaxation: Lelarasmee, Ruehli and
//! Sangiovanni-Vincentelli, IEEE Trans. CAD 1 (1982) 131). What a run takes over is the share of the force across that acts along the surface:
//! of a contact that slides it is the coefficient of friction, whatever the force comes to, so that two rounds are enough. If they took over
//! forces, they would diverge where friction excites modes more than the contact force does.
//!
//! A contact that has moved by `s` along x over a plate touches it where a mode moves by its slope times `s` more. The slope is the motion of
//! the face along x over half of the thickness (Kirchhoff), so that the contact force acts on the modes as if a share of it acted along the
//! face, and the contact closes by that share of the face's motion less.

use super::batch::OscillatorBatch;
use super::collocation::{Collocation, Points};
use super::contact_forces::points;
use super::step_table::StepTable;
use super::system::dot;
use crate::numerics::stages::{STAGES, Stages};
use wide::f64x4;

/// What happens along the surfaces at a time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tangential {
    /// Forces on what is struck along x over those across it, at outer and inner contact.
    pub ratios: [f64; 2],
    /// How far the contacts have moved along x over a plate, over half of its thickness.
    pub ways: [f64; 2],
}

impl Tangential {
    fn between(&self, other: &Self, share: f64) -> Self {
        let mix = |from: [f64; 2], to: [f64; 2]| [0, 1].map(|i| from[i] + share * (to[i] - from[i]));
        Self { ratios: mix(self.ratios, other.ratios), ways: mix(self.ways, other.ways) }
    }
}

/// What happens along the surfaces in the course of an impact, and the oscillators that move them.
#[derive(Debug, Clone)]
pub struct TangentialLoad {
    /// Times in s, ascending, and what happens then.
    pub course: Vec<(f64, Tangential)>,
    /// Displacement along x of the surfaces at both contacts per unit of each oscillator's coordinate. Shape (n).
    pub along: Vec<[f64; 2]>,
}

/// The same at the points of a step. Shapes (contacts, STAGES) and (contacts).
#[derive(Debug, Clone, Copy)]
pub struct StepLoad {
    /// Forces along the surfaces on the modes over those across them.
    shares: [Stages; 2],
    /// See [`Tangential`], at the nodes, the start and the end.
    ways: [Stages; 2],
    ends: [[f64; 2]; 2],
}

impl TangentialLoad {
    /// What happens at `time` s.
    pub(super) fn at(&self, time: f64) -> Tangential {
        let after = self.course.partition_point(|(at, _)| *at <= time);
        match (after.checked_sub(1).map(|before| &self.course[before]), self.course.get(after)) {
            (Some((from, start)), Some((to, end))) => start.between(end, (time - from) / (to - from)),
            (Some((_, last)), None) => *last,
            (None, _) => Tangential::default(),
        }
    }

    /// What happens in the step of `h` s from `time` s on.
    pub(super) fn step(&self, collocation: &Collocation, time: f64, h: f64) -> StepLoad {
        let at_nodes = collocation.nodes.map(|node| self.at(time + node * h));
        StepLoad {
            shares: [0, 1].map(|i| at_nodes.map(|at| at.ratios[i] + at.ways[i])),
            ways: [0, 1].map(|i| at_nodes.map(|at| at.ways[i])),
            ends: [time, time + h].map(|time| self.at(time).ways),
        }
    }
}

impl StepLoad {
    /// Forces along the surfaces at the nodes under those `across` them, N.
    pub(super) fn forces(&self, across: &[Stages; 2]) -> [Stages; 2] {
        [0, 1].map(|i| std::array::from_fn(|j| self.shares[i][j] * across[i][j]))
    }

    /// What approaches at the nodes become, of surfaces that move by `along` m there, as the contacts have moved.
    pub(super) fn moved(&self, approach: [f64x4; 2], along: [f64x4; 2]) -> [f64x4; 2] {
        [0, 1].map(|i| approach[i] - f64x4::from(self.ways[i]) * along[i])
    }

    /// What the contacts' ways add to the approaches at start, nodes and end of a step, at which the surfaces have moved by `along` m.
    pub(super) fn shift(&self, along: &[Points; 2]) -> [Points; 2] {
        [0, 1].map(|i| {
            let ways = points(self.ends[0][i], self.ways[i], self.ends[1][i]);
            std::array::from_fn(|p| -ways[p] * along[i][p])
        })
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

    /// The `coupling` of a step table under `load`: approaches lost per force, contacts (0,0), (0,1), (1,0), (1,1).
    pub(super) fn coupling(
        &self,
        [own0, mutual, own1]: &[[f64x4; STAGES]; 3],
        load: &StepLoad,
    ) -> [[f64x4; STAGES]; 4] {
        let ways = load.ways.map(f64x4::from);
        let less = |of: &[f64x4; STAGES], i: usize, j: usize| {
            std::array::from_fn(|l| {
                let share = load.shares[j][l];
                let along = self.along[i][j][l] * share - self.across[j][i][l];
                of[l] - self.across[i][j][l] * share + ways[i] * along
            })
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
