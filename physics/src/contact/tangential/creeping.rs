//! The tangential springs of bodies that relax: each is two in series, one of each body.

use super::{LANES, at_most};
use crate::material::{Creep, Deformation, Material};
use wide::f64x4;

/// What one body adds to every spring.
#[derive(Debug, Clone)]
struct CreepingHalf {
    /// Share of the spring's compliance at once.
    share: f64,
    creep: Creep,
}

/// All springs of a contact; forces are over the stiffness of a spring at once, in m.
#[derive(Debug, Clone)]
pub(super) struct CreepingSprings {
    halves: [CreepingHalf; 2],
    /// Shape (springs; along the motion, across it; bodies).
    states: Vec<[[Deformation; 2]; 2]>,
    /// Length of a step in s; power that the springs lose along the motion in m^2/s, and what they have lost in m^2.
    step: f64,
    power: f64,
    lost: f64,
}

impl CreepingSprings {
    /// Springs of bodies of these `materials` with these `shares` of the compliance; `None` if both are elastic.
    pub(super) fn new(materials: [&Material; 2], shares: [f64; 2], count: usize) -> Option<Self> {
        let half = |i: usize| CreepingHalf { share: shares[i], creep: Creep::new(&materials[i].relaxation) };
        materials.iter().any(|material| !material.relaxation.is_empty()).then(|| Self {
            halves: [half(0), half(1)],
            states: vec![Default::default(); count],
            step: 0.0,
            power: 0.0,
            lost: 0.0,
        })
    }

    /// Prepares a step of `h` s.
    pub(super) fn prepare(&mut self, h: f64) {
        if h != self.step {
            self.step = h;
            self.halves.iter_mut().for_each(|half| half.creep.prepare(h));
        }
    }

    /// Moves springs side by side to the deflections `wanted` in m, or as far as a force of `most` holds them; gives the forces along the motion.
    pub(super) fn moved(
        &mut self,
        springs: usize,
        wanted: [f64x4; 2],
        most: f64x4,
        deflections: &mut [f64x4; 2],
    ) -> f64x4 {
        let states = &mut self.states[springs * LANES..][..LANES];
        let free = |axis: usize| {
            let of = |half: usize, lane: usize| {
                self.halves[half].creep.deformation(&states[lane][axis][half], 0.0)
            };
            f64x4::from([0, 1, 2, 3].map(|lane| of(0, lane) + of(1, lane)))
        };
        let free = [free(0), free(1)];
        let growth: f64 = self.halves.iter().map(|half| half.share * half.creep.growth()).sum();
        let forces = at_most([0, 1].map(|axis| (wanted[axis] - free[axis]) / growth), most);
        for axis in 0..2 {
            for (state, force) in states.iter_mut().zip(forces[axis].to_array()) {
                for (half, state) in self.halves.iter().zip(&mut state[axis]) {
                    half.creep.advance(state, half.share * force);
                }
            }
            deflections[axis] = free[axis] + forces[axis] * growth;
        }
        forces[0]
    }

    /// Books what the springs have lost in a step.
    pub(super) fn book(&mut self) {
        let power = self.sum(Creep::power);
        self.lost += 0.5 * self.step * (self.power + power);
        self.power = power;
    }

    /// Energy that the springs store along the motion, and have lost by creeping so far, over the stiffness of a spring, m^2.
    pub(super) fn stored(&self) -> f64 {
        self.sum(Creep::stored)
    }

    pub(super) fn lost(&self) -> f64 {
        self.lost
    }

    /// Sum over all springs of what `of` gives per stiffness.
    fn sum(&self, of: impl Fn(&Creep, &Deformation) -> f64) -> f64 {
        let along = self.states.iter().map(|[along, _]| along);
        along
            .flat_map(|states| self.halves.iter().zip(states))
            .map(|(half, state)| of(&half.creep, state) / half.share)
            .sum()
    }
}
