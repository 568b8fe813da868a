//! Friction's effect on the motion across the surfaces: forces along them that are known from a run before, and turn or bend what is struck.
//!
//! The forces depend on the motion across the surfaces, and that on them. Each is solved in turn over the whole impact, with the course of the
//! other from the run before, until nothing changes (waveform relaxation: Lelarasmee, Ruehli and Sangiovanni-Vincentelli, IEEE Trans. CAD 1
//! (1982) 131).

use super::batch::in_blocks;
use super::system::System;
use wide::f64x4;

/// Impulses along the surfaces over time, and the oscillators that they move.
#[derive(Debug, Clone)]
pub struct FrictionLoad {
    /// Times in s, ascending, and the impulses in N s until then on what is struck, along x at outer and inner contact.
    pub course: Vec<(f64, [f64; 2])>,
    /// Displacement along x of the surfaces at both contacts per unit of each oscillator's coordinate. Shape (n).
    pub along: Vec<[f64; 2]>,
    /// Least level of the steps, between which it acts as kicks.
    pub level: i32,
}

impl FrictionLoad {
    /// Impulses in N s until `time` s.
    fn impulse_until(&self, time: f64) -> [f64; 2] {
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
}

/// What a load has done in a run.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct GivenLoad {
    /// Impulses in N s along x at outer and inner contact.
    pub(super) impulse: [f64; 2],
    /// Work, J.
    pub(super) work: f64,
}

/// The load in a run, as kicks between its steps: half of what acts in the step before, and half of what acts in the next one.
#[derive(Debug)]
pub(super) struct Kicks<'a> {
    load: &'a FrictionLoad,
    /// Participations along the surfaces, and angular frequencies. Shape (blocks).
    along: [Vec<f64x4>; 2],
    omega: Vec<f64x4>,
    pub(super) given: GivenLoad,
}

impl<'a> Kicks<'a> {
    /// Of the load of `system`, if it has one.
    pub(super) fn new(system: &'a System) -> Option<Self> {
        let load = system.friction_load.as_ref()?;
        let along = [0, 1].map(|i| in_blocks(&load.along.iter().map(|along| along[i]).collect::<Vec<_>>()));
        let omega = in_blocks(&system.oscillators.iter().map(|o| o.omega).collect::<Vec<_>>());
        Some(Self { load, along, omega, given: GivenLoad::default() })
    }

    /// Least level of the steps.
    pub(super) fn level(&self) -> i32 {
        self.load.level
    }

    /// Changes the rates `v` after a step of `h` s that ends at `time` s; gives the work in J.
    ///
    /// Quick oscillators feel the mean of a step, as [`super::surface_modes::MovingSurfaces::kick`] has it.
    pub(super) fn kick(&mut self, time: f64, h: f64, v: &mut [f64x4]) -> f64 {
        let until = self.load.impulse_until(time + 0.5 * h);
        let impulse = [0, 1].map(|i| f64x4::splat(until[i] - self.given.impulse[i]));
        self.given.impulse = until;
        let mut work = f64x4::ZERO;
        for (k, v) in v.iter_mut().enumerate() {
            let turn = self.omega[k] * f64x4::splat(0.5 * h);
            let still = turn.simd_lt(f64x4::splat(f64::MIN_POSITIVE));
            let mean = still.select(f64x4::ONE, turn.sin() / turn);
            let change = mean * (self.along[0][k] * impulse[0] + self.along[1][k] * impulse[1]);
            work += change * (*v + f64x4::splat(0.5) * change);
            *v += change;
        }
        let work = work.reduce_add();
        self.given.work += work;
        work
    }
}
