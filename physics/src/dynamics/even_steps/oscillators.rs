//! The oscillators of a system from step to step, all steps of one length.
//!
//! With the force F a parabola through its values at three neighbouring steps, an oscillator's coordinates there obey
//!
//!   q(n+1) - a q(n) + b q(n-1) = -(w- F(n-1) + w0 F(n) + w+ F(n+1)),
//!
//! exactly: a and b are trace and determinant of its free motion over a step, the weights w follow from Duhamel's integral. With
//! p(n) = q(n) + w+ F(n) there is no force on the right that is not known,
//!
//!   p(n+1) = a p(n) - b p(n-1) - (w0 + a w+) F(n) - (w- - b w+) F(n-1),
//!
//! and the last term vanishes without damping. What is missing to the approaches, w+ F(n+1), acts as a flexibility on the contacts.
//! Oscillators that turn too far in a step follow as under static forces: they are flexibility alone.

use crate::dynamics::batch::LANES;
use crate::dynamics::system::System;
use crate::numerics::duhamel::Oscillator;
use wide::f64x4;

/// Turn per step, rad, up to which an oscillator moves by itself; at pi the coordinates would say nothing of the rates.
const FARTHEST_TURN: f64 = 2.2;

/// What one step does to an oscillator.
struct EvenOscillator {
    /// Its place among those of the system.
    place: usize,
    /// Trace and determinant of the free motion over a step.
    trace: f64,
    determinant: f64,
    /// Coordinate after a step per coordinate and per rate.
    free: [f64; 2],
    /// Weights of the forces of this step and of the one before, s^2.
    force: [f64; 2],
}

/// [`LANES`] oscillators side by side.
struct EvenBlock {
    trace: f64x4,
    determinant: f64x4,
    /// Coordinate per force of this step, and of the one before, of each contact, negative.
    force: [[f64x4; 2]; 2],
    /// Approach of each contact per coordinate.
    approach: [f64x4; 2],
}

/// The oscillators at two neighbouring steps.
pub(super) struct EvenOscillators {
    each: Vec<EvenOscillator>,
    blocks: Vec<EvenBlock>,
    /// p of the latest step and of the one before.
    latest: Vec<f64x4>,
    before: Vec<f64x4>,
    damped: bool,
    /// Approach lost at once per force, m/N: contacts (0,0), (0,1) = (1,0), (1,1).
    pub(super) flexibility: [f64; 3],
}

/// Whether the `oscillator` moves by itself in steps of `h` s.
pub(super) fn moves(oscillator: &Oscillator, h: f64) -> bool {
    oscillator.omega * h <= FARTHEST_TURN
}

impl EvenOscillator {
    /// Of the `oscillator` with steps of `h` s, and the weight w+.
    fn new(place: usize, oscillator: &Oscillator, h: f64) -> (Self, f64) {
        let Oscillator { omega, alpha } = *oscillator;
        let m = oscillator.moments(h);
        let free = [m[0] + 2.0 * alpha * m[1], m[1]];
        let [rate_per_coordinate, rate_per_rate] = [-omega * omega * m[1], m[0]];
        let determinant = free[0] * rate_per_rate - free[1] * rate_per_coordinate;
        // coordinate and rate after a step under forces (t/h)^p
        let powers = [1.0, 1.0 / h, 2.0 / (h * h)];
        let answers = |first: usize| [0, 1, 2].map(|p| powers[p] * m[first + p]);
        let (coordinate, rate) = (answers(2), answers(1));
        let under = |c: [f64; 3], answers: [f64; 3]| (0..3).map(|p| c[p] * answers[p]).sum::<f64>();
        // the step before, from -h to 0, comes in with what it leaves
        let weight = |now: [f64; 3]| {
            let [a, b, c] = now;
            let earlier = [a - b + c, b - 2.0 * c, c];
            under(now, coordinate) - rate_per_rate * under(earlier, coordinate)
                + free[1] * under(earlier, rate)
        };
        let [before, now, after] = [[0.0, -0.5, 0.5], [1.0, 0.0, -1.0], [0.0, 0.5, 0.5]].map(weight);
        let trace = free[0] + rate_per_rate;
        let force = [now + trace * after, before - determinant * after];
        (Self { place, trace, determinant, free, force }, after)
    }
}

impl EvenOscillators {
    /// Those of `system` at rest, with steps of `h` s.
    pub(super) fn new(system: &System, h: f64) -> Self {
        let mut flexibility = [0.0; 3];
        let mut each = Vec::with_capacity(system.size());
        for (place, oscillator) in system.oscillators.iter().enumerate() {
            let at_once = if moves(oscillator, h) {
                let (moving, after) = EvenOscillator::new(place, oscillator, h);
                each.push(moving);
                after
            } else {
                oscillator.omega.powi(-2)
            };
            let [outer, inner] = [0, 1].map(|i| system.approach[i][place]);
            for (sum, product) in flexibility.iter_mut().zip([outer * outer, outer * inner, inner * inner]) {
                *sum += product * at_once;
            }
        }
        let blocks: Vec<_> = each.chunks(LANES).map(|chunk| EvenBlock::new(chunk, system)).collect();
        let rest = vec![f64x4::ZERO; blocks.len()];
        Self { each, latest: rest.clone(), before: rest, blocks, damped: system.is_damped(), flexibility }
    }

    /// Goes to the state `q`, `v` of the system, in which no force acts nor did before.
    pub(super) fn start_from(&mut self, q: &[f64], v: &[f64]) {
        let latest: &mut [f64] = bytemuck::cast_slice_mut(&mut self.latest);
        let before: &mut [f64] = bytemuck::cast_slice_mut(&mut self.before);
        for (lane, one) in self.each.iter().enumerate() {
            let (q, v) = (q[one.place], v[one.place]);
            let next = one.free[0] * q + one.free[1] * v;
            latest[lane] = q;
            before[lane] = (one.trace * q - next) / one.determinant;
        }
    }

    /// Takes a step under the `forces` in N at the latest step and the one before; gives the approaches in m without the gaps and
    /// without what the step's own forces do at once.
    #[inline(always)]
    pub(super) fn advance(&mut self, [[outer, inner], earlier]: [[f64; 2]; 2]) -> [f64; 2] {
        let mut sums = [f64x4::ZERO; 2];
        for ((block, latest), before) in self.blocks.iter().zip(&mut self.latest).zip(&mut self.before) {
            let [now, then] = &block.force;
            let mut next =
                block.trace * *latest - block.determinant * *before + (now[0] * outer + now[1] * inner);
            if self.damped {
                next += then[0] * earlier[0] + then[1] * earlier[1];
            }
            (*before, *latest) = (*latest, next);
            sums[0] += block.approach[0] * next;
            sums[1] += block.approach[1] * next;
        }
        sums.map(f64x4::reduce_add)
    }

    /// Writes coordinates and rates of the latest step where no force acts any more; those that follow as under static forces are at rest.
    pub(super) fn state(&self, q: &mut [f64], v: &mut [f64]) {
        q.fill(0.0);
        v.fill(0.0);
        let latest: &[f64] = bytemuck::cast_slice(&self.latest);
        let before: &[f64] = bytemuck::cast_slice(&self.before);
        for ((one, latest), before) in self.each.iter().zip(latest).zip(before) {
            let next = one.trace * latest - one.determinant * before;
            q[one.place] = *latest;
            v[one.place] = (next - one.free[0] * latest) / one.free[1];
        }
    }
}

impl EvenBlock {
    fn new(chunk: &[EvenOscillator], system: &System) -> Self {
        let each = |value: &dyn Fn(&EvenOscillator) -> f64| {
            f64x4::from(std::array::from_fn(|lane| chunk.get(lane).map_or(0.0, value)))
        };
        let approach = [0, 1].map(|i| each(&|one| system.approach[i][one.place]));
        let force = [0, 1].map(|back| approach.map(|approach| -approach * each(&|one| one.force[back])));
        Self { trace: each(&|one| one.trace), determinant: each(&|one| one.determinant), force, approach }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A particular solution of q'' + 2 alpha q' + omega^2 q = -(a + b t + c t^2); the rest is free motion, which the recurrence cancels.
    fn under_parabola(oscillator: &Oscillator, [a, b, c]: [f64; 3], t: f64) -> f64 {
        let Oscillator { omega, alpha } = *oscillator;
        if omega == 0.0 {
            return -t * t * (a / 2.0 + t * (b / 6.0 + t * c / 12.0));
        }
        let stiffness = omega * omega;
        let square = -c / stiffness;
        let linear = -(b + 4.0 * alpha * square) / stiffness;
        let constant = -(a + 2.0 * alpha * linear + 2.0 * square) / stiffness;
        constant + t * (linear + t * square)
    }

    #[test]
    fn an_oscillator_answers_exactly_to_a_parabola() {
        let (h, parabola) = (0.7, [0.3, -1.1, 0.8]);
        for (omega, ratio) in [(0.0, 0.0), (0.4, 0.0), (3.1, 0.0), (1.0, 0.05), (3.0, 0.09), (0.5, 1.5)] {
            let oscillator = Oscillator { omega, alpha: ratio * omega };
            let (one, after) = EvenOscillator::new(0, &oscillator, h);
            let q = [-h, 0.0, h].map(|t| under_parabola(&oscillator, parabola, t));
            let f = [-h, 0.0, h].map(|t| parabola[0] + t * (parabola[1] + t * parabola[2]));
            // p(n) = q(n) + w+ F(n)
            let p = [0, 1, 2].map(|n| q[n] + after * f[n]);
            let next = one.trace * p[1] - one.determinant * p[0] - one.force[0] * f[1] - one.force[1] * f[0];
            assert_relative_eq!(next, p[2], max_relative = 1e-10, epsilon = 1e-12);
            if ratio == 0.0 {
                assert!(one.force[1].abs() < 1e-12, "no force of the step before: {}", one.force[1]);
            }
        }
    }
}
