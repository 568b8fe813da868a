//! The struck body's surfaces, which its modes move along themselves: by the contact forces across them, as where a plate's normal turns, and
//! by those along them.

use super::batch::{Block, LANES, filled_up};
use crate::numerics::duhamel::Oscillator;
use crate::numerics::stages::{STAGES, powers};
use wide::f64x4;

/// Relative difference of durations below which they are the same but for rounding.
const SAME: f64 = 1e-9;

/// A mode of what is struck.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceMode {
    /// How its coordinate vibrates.
    pub oscillator: Oscillator,
    /// Approach of outer and inner contact per unit of its coordinate, kg^(-1/2).
    pub approach: [f64; 2],
    /// Displacement along x of the surface at outer and inner contact per unit of its coordinate, kg^(-1/2).
    pub along: [f64; 2],
}

/// What is struck, from rest on: its motion by the forces across the surfaces and that by those along them.
#[derive(Debug, Clone)]
pub struct MovingSurfaces {
    blocks: Vec<ModeBlock>,
    /// Duration of the steps that the blocks are prepared for, s.
    duration: f64,
    /// Static flexibility along the surfaces in m/N that the modes lack for kicks once a step. Shape (contacts, contacts).
    lacking: [[f64; 2]; 2],
}

/// Modes side by side.
#[derive(Debug, Clone)]
struct ModeBlock {
    oscillators: Block,
    /// See [`SurfaceMode`], by contact.
    along: [f64x4; 2],
    /// What a step of free motion makes of coordinate and rate: coordinate by both, rate by both.
    free: [[f64x4; 2]; 2],
    /// Coordinate and rate after a step, each by a force at its start and one at its end, between which it changes evenly.
    forced: [[f64x4; 2]; 2],
    /// Share of the participation along the surface that kicks once a step feel and move, see [`MovingSurfaces::kick`].
    felt: f64x4,
    /// Coordinates and rates by the forces across the surfaces, and by those along them.
    pressed: [f64x4; 2],
    kicked: [f64x4; 2],
}

impl SurfaceMode {
    /// A rigid motion with these participations.
    pub fn rigid(approach: [f64; 2], along: [f64; 2]) -> Self {
        Self { oscillator: Oscillator { omega: 0.0, alpha: 0.0 }, approach, along }
    }
}

impl ModeBlock {
    fn new(chunk: &[SurfaceMode]) -> Self {
        let oscillators: Vec<Oscillator> = chunk.iter().map(|mode| mode.oscillator).collect();
        let each = |value: &dyn Fn(&SurfaceMode) -> f64| {
            let values: Vec<f64> = chunk.iter().map(value).collect();
            filled_up(&values)
        };
        Self {
            oscillators: Block::new(&oscillators, [0, 1].map(|i| each(&|mode| mode.approach[i]))),
            along: [0, 1].map(|i| each(&|mode| mode.along[i])),
            free: [[f64x4::ZERO; 2]; 2],
            forced: [[f64x4::ZERO; 2]; 2],
            felt: f64x4::ONE,
            pressed: [f64x4::ZERO; 2],
            kicked: [f64x4::ZERO; 2],
        }
    }

    /// Prepares steps of `h` s, of which `powers` are the powers; gives the static flexibility that each mode lacks for kicks once a step.
    fn prepare(&mut self, h: f64, powers: &[f64; STAGES]) -> f64x4 {
        let Block { omega, stiffness, damping, flexibility, .. } = self.oscillators;
        // of Duhamel's integral: rate and coordinate by an even force, and the coordinate by one that grows
        let [slope, rate, even, growing, ..] = self.oscillators.moments(h, powers);
        self.free = [[slope + damping * rate, rate], [-(stiffness * rate), slope]];
        let (growing, rate_growing) = (growing / h, even / h);
        self.forced = [[even - growing, growing], [rate - rate_growing, rate_growing]];
        let turn = omega * (0.5 * h);
        let (sine, cosine) = turn.sin_cos();
        let still = turn.simd_lt(f64x4::splat(f64::MIN_POSITIVE));
        self.felt = still.select(f64x4::ONE, sine / turn);
        // sin(2 x)/(2 x) = sin x/x cos x
        flexibility * (f64x4::ONE - self.felt * cosine)
    }
}

impl MovingSurfaces {
    /// At rest.
    pub fn new(modes: &[SurfaceMode]) -> Self {
        let blocks = modes.chunks(LANES).map(ModeBlock::new).collect();
        Self { blocks, duration: f64::NAN, lacking: [[0.0; 2]; 2] }
    }

    /// Prepares steps of `h` s.
    pub fn prepare(&mut self, h: f64) {
        // false at first, when it is not a number
        if (self.duration - h).abs() <= SAME * h {
            return;
        }
        let powers = powers(h);
        let mut lacking = [f64x4::ZERO; 3];
        for block in &mut self.blocks {
            let flexibility = block.prepare(h, &powers);
            let [outer, inner] = block.along;
            for (sum, product) in lacking.iter_mut().zip([outer * outer, outer * inner, inner * inner]) {
                *sum += product * flexibility;
            }
        }
        let [outer, both, inner] = lacking.map(f64x4::reduce_add);
        self.lacking = [[outer, both], [both, inner]];
        self.duration = h;
    }

    /// Moves on by a step under forces across the surfaces that change evenly `from` those at its start `to` those at its end, in N; gives
    /// how far that moves both surfaces along x, m.
    pub fn press(&mut self, from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
        let forces = [from, to].map(|forces| forces.map(f64x4::splat));
        let mut moved = [f64x4::ZERO; 2];
        for block in &mut self.blocks {
            let [q, v] = block.pressed;
            let [outer, inner] = block.oscillators.approach;
            let [start, end] = forces.map(|[a, b]| outer * a + inner * b);
            block.pressed = [0, 1].map(|i| {
                let ([by_q, by_v], [by_start, by_end]) = (block.free[i], block.forced[i]);
                by_q * q + by_v * v - by_start * start - by_end * end
            });
            (0..2).for_each(|i| moved[i] += block.along[i] * (block.pressed[0] - q));
        }
        moved.map(f64x4::reduce_add)
    }

    /// Forces along x of `along` N act for `h` s, within steps that [`Self::drift`] takes.
    ///
    /// A mode that turns by half a circle or more within a step would be in phase with all kicks. So it feels the mean of a step, and is seen
    /// by it (the mollified impulse method of Garcia-Archilla, Sanz-Serna and Skeel, SIAM J. Sci. Comput. 20 (1998) 930): no energy comes of
    /// it, and slow modes are right to the second order. What quick ones lack statically is [`Self::yields`].
    pub fn kick(&mut self, along: [f64; 2], h: f64) {
        let by = along.map(|force| f64x4::splat(h * force));
        for block in &mut self.blocks {
            block.kicked[1] += block.felt * (block.along[0] * by[0] + block.along[1] * by[1]);
        }
    }

    /// Motion for a step after the kicks; how far it moves both surfaces along x, m.
    pub fn drift(&mut self) -> [f64; 2] {
        let mut moved = [f64x4::ZERO; 2];
        for block in &mut self.blocks {
            let [q, v] = block.kicked;
            block.kicked = block.free.map(|[by_q, by_v]| by_q * q + by_v * v);
            (0..2).for_each(|i| moved[i] += block.felt * block.along[i] * (block.kicked[0] - q));
        }
        moved.map(f64x4::reduce_add)
    }

    /// How far both surfaces move along x, m, by what quick modes lack, when forces along x grow by `growth` N.
    pub fn yields(&self, growth: [f64; 2]) -> [f64; 2] {
        self.lacking.map(|[outer, inner]| outer * growth[0] + inner * growth[1])
    }

    /// Speed at which a contact moves across its surface in a step, the larger of both, m/s; quick modes as [`Self::kick`] has them.
    pub fn speed_across(&self) -> f64 {
        let of = |i: usize| {
            let speed = |block: &ModeBlock| block.felt * block.oscillators.approach[i] * block.kicked[1];
            self.blocks.iter().map(speed).fold(f64x4::ZERO, |sum, speed| sum + speed).reduce_add().abs()
        };
        of(0).max(of(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn mode(omega: f64) -> SurfaceMode {
        SurfaceMode {
            oscillator: Oscillator { omega, alpha: 0.01 * omega },
            approach: [1.0, 0.0],
            along: [2.0, 0.0],
        }
    }

    /// Under a force that rises and stays a mode ends at its static displacement, however few steps a turn takes.
    #[test]
    fn a_pressed_mode_comes_to_its_static_displacement() {
        for omega in [1e3, 1e5, std::f64::consts::TAU * 1e6, 1e9] {
            let modes = [mode(omega)];
            let mut surfaces = MovingSurfaces::new(&modes);
            surfaces.prepare(1e-6);
            let steps = 2_000_000.0_f64.min(2e9 / omega).max(2000.0) as usize;
            let force = |k: usize| 3.0 * (k as f64 / steps as f64 * 2.0).min(1.0);
            let moved: f64 =
                (0..steps).map(|k| surfaces.press([force(k), 0.0], [force(k + 1), 0.0])[0]).sum();
            assert_relative_eq!(moved, -2.0 * 3.0 / (omega * omega), max_relative = 1e-2);
        }
    }

    /// Forces along the surface move slow modes as they do statically; no mode takes up more than that, also where it is in phase with all kicks.
    #[test]
    fn kicks_are_no_resonance() {
        let h = 1e-6;
        for turn in [0.1, 2.0, 3.1, std::f64::consts::TAU, 2.0 * std::f64::consts::TAU, 30.0] {
            let modes = [mode(turn / h)];
            let mut surfaces = MovingSurfaces::new(&modes);
            surfaces.prepare(h);
            let mut moved = 0.0;
            let mut largest = 0.0_f64;
            for _ in 0..20_000 {
                surfaces.kick([3.0, 0.0], 0.5 * h);
                moved += surfaces.drift()[0];
                surfaces.kick([3.0, 0.0], 0.5 * h);
                largest = largest.max(f64::abs(moved));
            }
            let still = 2.0 * 2.0 * 3.0 / (turn / h).powi(2);
            assert!(largest < 2.1 * still, "{turn}: {largest} {still}");
            let [all, _] = surfaces.yields([3.0, 0.0]);
            assert_relative_eq!(moved + all, still, max_relative = 0.01);
        }
    }
}
