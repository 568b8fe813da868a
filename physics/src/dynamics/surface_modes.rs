//! The struck body's surfaces, which its modes move along themselves: by the contact forces across them, as where a plate's normal turns, and
//! by those along them.

use crate::numerics::duhamel::Oscillator;
use wide::f64x4;

/// Modes in a block.
const LANES: usize = 4;
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

/// Forces of outer and inner contact in N.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceForces {
    /// Pressing ones.
    pub across: [f64; 2],
    /// Along x on the struck body.
    pub along: [f64; 2],
}

/// What is struck, from rest on.
#[derive(Debug, Clone)]
pub struct MovingSurfaces<'a> {
    modes: &'a [SurfaceMode],
    blocks: Vec<ModeBlock>,
    /// Duration in s of the free motion that the blocks are prepared for.
    duration: f64,
}

/// Modes side by side.
#[derive(Debug, Clone, Copy)]
struct ModeBlock {
    /// See [`SurfaceMode`], by contact.
    approach: [f64x4; 2],
    along: [f64x4; 2],
    /// What free motion makes of coordinate and rate: coordinate by both, rate by both.
    free: [[f64x4; 2]; 2],
    /// Coordinates and rates.
    state: [f64x4; 2],
}

impl<'a> MovingSurfaces<'a> {
    /// At rest.
    pub fn new(modes: &'a [SurfaceMode]) -> Self {
        let blocks = modes.chunks(LANES).map(|chunk| ModeBlock {
            approach: [0, 1].map(|i| each(chunk, |mode| mode.approach[i])),
            along: [0, 1].map(|i| each(chunk, |mode| mode.along[i])),
            free: [[f64x4::ZERO; 2]; 2],
            state: [f64x4::ZERO; 2],
        });
        Self { modes, blocks: blocks.collect(), duration: f64::NAN }
    }

    /// The forces act for `h` s.
    pub fn kick(&mut self, forces: SurfaceForces, h: f64) {
        let by = |forces: [f64; 2]| forces.map(|force| f64x4::splat(h * force));
        let (across, along) = (by(forces.across), by(forces.along));
        for block in &mut self.blocks {
            for i in 0..2 {
                block.state[1] += block.along[i] * along[i] - block.approach[i] * across[i];
            }
        }
    }

    /// Free motion for `h` s; how far it moves both surfaces along x, m.
    pub fn drift(&mut self, h: f64) -> [f64; 2] {
        // false at first, when it is not a number
        let is_prepared = (self.duration - h).abs() <= SAME * h;
        if !is_prepared {
            self.prepare(h);
        }
        let mut moved = [f64x4::ZERO; 2];
        for block in &mut self.blocks {
            let [q, v] = block.state;
            block.state = block.free.map(|[by_q, by_v]| by_q * q + by_v * v);
            (0..2).for_each(|i| moved[i] += block.along[i] * (block.state[0] - q));
        }
        moved.map(f64x4::reduce_add)
    }

    fn prepare(&mut self, h: f64) {
        for (block, chunk) in self.blocks.iter_mut().zip(self.modes.chunks(LANES)) {
            let of = |i: usize, unit: [f64; 2]| each(chunk, |mode| mode.oscillator.after(h, unit)[i]);
            block.free = [0, 1].map(|i| [of(i, [1.0, 0.0]), of(i, [0.0, 1.0])]);
        }
        self.duration = h;
    }

    /// Speed at which a contact moves across its surface, the larger of both, m/s.
    pub fn speed_across(&self) -> f64 {
        let of = |i: usize| {
            let sum =
                self.blocks.iter().fold(f64x4::ZERO, |sum, block| sum + block.approach[i] * block.state[1]);
            sum.reduce_add().abs()
        };
        of(0).max(of(1))
    }
}

/// The values of `chunk`, at most four modes, filled up with zeros.
fn each(chunk: &[SurfaceMode], value: impl Fn(&SurfaceMode) -> f64) -> f64x4 {
    f64x4::from(std::array::from_fn::<f64, LANES, _>(|k| chunk.get(k).map_or(0.0, &value)))
}
