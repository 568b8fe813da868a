//! All oscillators of a system side by side, so that one instruction serves several of them.
//!
//! [`Oscillator`] holds the mathematics of one oscillator; here are the same moments for a block of [`LANES`] at a
//! time. Nothing depends on the order of the oscillators; the last block is filled up with rigid coordinates no
//! contact acts on, which stay at rest.

use super::system::{System, dot};
use crate::numerics::duhamel::{Feed, MOMENTS, Oscillator};
use crate::numerics::stages::{STAGES, Stages, powers};
use bytemuck::cast;
use wide::{f64x4, u64x4};

/// Oscillators in a block.
pub const LANES: usize = 4;
/// Quarter turns up to which [`sin_cos`] reduces its argument exactly.
const MAX_ANGLE: f64 = 1e8;
/// omega t below which the power series is used (as in [`Oscillator::moments`]).
const SERIES: f64 = 2.0;
/// 1/n! for n = 0 ...
const INVERSE_FACTORIAL: [f64; 27] = {
    let mut table = [1.0; 27];
    let mut n = 1;
    while n < table.len() {
        table[n] = table[n - 1] / n as f64;
        n += 1;
    }
    table
};

/// Some oscillators of a [`System`] and what the contacts see of them.
#[derive(Debug, Clone)]
pub struct Block {
    pub omega: f64x4,
    /// omega^2.
    pub stiffness: f64x4,
    /// 1/omega^2; 0 for a rigid motion, whose moments never divide by it.
    pub flexibility: f64x4,
    /// 2 alpha.
    pub damping: f64x4,
    /// Approach of each contact per unit of each coordinate.
    pub approach: [f64x4; 2],
    /// Products of the approaches of a pair of contacts: (0,0), (0,1) = (1,0), (1,1).
    pub products: [f64x4; 3],
    /// Whether there is any damping.
    damped: bool,
    oscillators: [Oscillator; LANES],
}

/// An oscillator of a circuit.
#[derive(Debug, Clone)]
pub struct Fed {
    /// Its place among the oscillators.
    pub place: usize,
    pub oscillator: Oscillator,
    /// Approach of the first contact per unit.
    pub approach: f64,
    pub feed: Feed,
}

impl Fed {
    /// Coordinate and rate, positive against the force, at time `t` under forces tau^p / p!.
    pub fn answers(&self, t: f64) -> [Stages; 2] {
        self.oscillator.fed(&self.feed, &self.oscillator.moments(t))
    }
}

/// All blocks of a [`System`].
#[derive(Debug, Clone)]
pub struct OscillatorBatch {
    /// In the order of the oscillators.
    pub blocks: Vec<Block>,
    /// Oscillators of a circuit, which the force of the first contact moves in one more way; none of any other body.
    pub fed: Vec<Fed>,
    /// Displacement along x of the surfaces at both contacts per unit of each coordinate, where forces along them are known; else nothing.
    pub along: Vec<[f64x4; 2]>,
}

impl OscillatorBatch {
    /// The oscillators of `system`.
    pub fn new(system: &System) -> Self {
        let blocks = system.oscillators.chunks(LANES).zip((0..).step_by(LANES)).map(|(chunk, start)| {
            Block::new(chunk, [0, 1].map(|i| filled_up(&system.approach[i][start..][..chunk.len()])))
        });
        let fed = system.feeds.iter().map(|&(place, feed)| Fed {
            place,
            oscillator: system.oscillators[place],
            approach: system.approach[0][place],
            feed,
        });
        let along = system.tangential_load.iter().flat_map(|load| load.along.chunks(LANES));
        let along = along
            .map(|chunk| [0, 1].map(|i| filled_up(&chunk.iter().map(|along| along[i]).collect::<Vec<_>>())));
        Self { blocks: blocks.collect(), fed: fed.collect(), along: along.collect() }
    }

    /// Approaches in m, without the gaps, with their first and second derivatives by time, `t` s after the state
    /// (`q`, `v`) under forces of which `forces` are the derivatives by time in that state.
    pub fn approach_after(
        &self,
        (q, v): (&[f64x4], &[f64x4]),
        forces: &[Stages; 2],
        t: f64,
    ) -> [[f64; 2]; 3] {
        let powers = powers(t);
        let now = forces.map(|force| force.iter().zip(&powers).map(|(f, power)| f * power).sum::<f64>());
        let mut sums = [[f64x4::ZERO; 2]; 3];
        for ((block, &q), &v) in self.blocks.iter().zip(q).zip(v) {
            let Block { stiffness, damping, approach: [b0, b1], .. } = *block;
            let [displacement, rate] = block.after(&block.moments(t, &powers), [q, v], forces);
            let acceleration = -(stiffness * displacement) - damping * rate - (b0 * now[0] + b1 * now[1]);
            for (sums, value) in sums.iter_mut().zip([displacement, rate, acceleration]) {
                sums[0] += b0 * value;
                sums[1] += b1 * value;
            }
        }
        let mut sums = sums.map(|sums| sums.map(f64x4::reduce_add));
        for fed in &self.fed {
            let [displacement, rate] = fed.answers(t).map(|answers| dot(&answers, &forces[0]));
            let Oscillator { omega, alpha } = fed.oscillator;
            let acceleration = omega.powi(2) * displacement + 2.0 * alpha * rate - fed.feed.push * now[0];
            sums[0][0] -= fed.approach * displacement;
            sums[1][0] -= fed.approach * rate;
            sums[2][0] += fed.approach * acceleration;
        }
        sums
    }

    /// [`Self::approach_after`] without second derivatives, at the ends of so many equal `intervals` of a step of `h` s: the state goes on
    /// from one to the next.
    pub fn approaches_within(
        &self,
        (q, v): (&[f64x4], &[f64x4]),
        forces: &[Stages; 2],
        h: f64,
        intervals: usize,
    ) -> Vec<[[f64; 2]; 2]> {
        let dt = h / intervals as f64;
        let powers = powers(dt);
        let moments: Vec<_> = self.blocks.iter().map(|block| block.moments(dt, &powers)).collect();
        let fed: Vec<_> = self.fed.iter().map(|fed| fed.answers(dt)).collect();
        let (mut state, mut forces): (Vec<[f64x4; 2]>, _) =
            (q.iter().zip(v).map(|(q, v)| [*q, *v]).collect(), *forces);
        let mut samples = Vec::with_capacity(intervals + 1);
        loop {
            let mut sums = [[f64x4::ZERO; 2]; 2];
            for (block, state) in self.blocks.iter().zip(&state) {
                for (sums, value) in sums.iter_mut().zip(state) {
                    sums[0] += block.approach[0] * *value;
                    sums[1] += block.approach[1] * *value;
                }
            }
            samples.push(sums.map(|sums| sums.map(f64x4::reduce_add)));
            if samples.len() > intervals {
                return samples;
            }
            for ((block, moments), state) in self.blocks.iter().zip(&moments).zip(&mut state) {
                *state = block.after(moments, *state, &forces);
            }
            for (fed, answers) in self.fed.iter().zip(&fed) {
                let answers = answers.map(|answers| dot(&answers, &forces[0]));
                let (block, lane) = (fed.place / LANES, fed.place % LANES);
                for (value, answer) in state[block].iter_mut().zip(answers) {
                    value.as_mut_array()[lane] -= answer;
                }
            }
            // the derivatives at the end of the interval
            let later = |force: Stages| {
                std::array::from_fn(|p| (p..STAGES).map(|m| force[m] * powers[m - p]).sum::<f64>())
            };
            forces = forces.map(later);
        }
    }

    /// What forces along the surfaces add to [`Self::approach_after`], of which `forces` are the derivatives by time.
    pub fn pushed_after(&self, forces: &[Stages; 2], t: f64) -> [[f64; 2]; 3] {
        let powers = powers(t);
        let now = forces.map(|force| dot(&force, &powers));
        let mut sums = [[f64x4::ZERO; 2]; 3];
        for (block, along) in self.blocks.iter().zip(&self.along) {
            let moments = block.moments(t, &powers);
            let [displacement, rate] = pushed(&moments, along, forces);
            let now = along[0] * now[0] + along[1] * now[1];
            let acceleration = now - block.stiffness * displacement - block.damping * rate;
            for (sums, value) in sums.iter_mut().zip([displacement, rate, acceleration]) {
                sums[0] += block.approach[0] * value;
                sums[1] += block.approach[1] * value;
            }
        }
        sums.map(|sums| sums.map(f64x4::reduce_add))
    }

    /// Displacements along x of the surfaces in m with the coordinates `q`.
    pub fn moved_along(&self, q: &[f64x4]) -> [f64; 2] {
        let mut sums = [f64x4::ZERO; 2];
        for (along, &q) in self.along.iter().zip(q) {
            (0..2).for_each(|i| sums[i] += along[i] * q);
        }
        sums.map(f64x4::reduce_add)
    }

    /// Rates of the approaches in m/s with the rates `v` of the oscillators.
    pub fn approach_rate(&self, v: &[f64x4]) -> [f64; 2] {
        let mut sums = [f64x4::ZERO; 2];
        for (block, &v) in self.blocks.iter().zip(v) {
            sums[0] += block.approach[0] * v;
            sums[1] += block.approach[1] * v;
        }
        sums.map(f64x4::reduce_add)
    }
}

impl Block {
    /// At most [`LANES`] oscillators, with the approaches of both contacts.
    pub fn new(chunk: &[Oscillator], approach: [f64x4; 2]) -> Self {
        let rest = Oscillator { omega: 0.0, alpha: 0.0 };
        let oscillators: [Oscillator; LANES] = std::array::from_fn(|i| chunk.get(i).copied().unwrap_or(rest));
        let each = |value: fn(&Oscillator) -> f64| f64x4::from(oscillators.map(|o| value(&o)));
        Self {
            omega: each(|o| o.omega),
            stiffness: each(|o| o.omega * o.omega),
            flexibility: each(|o| if o.omega > 0.0 { 1.0 / (o.omega * o.omega) } else { 0.0 }),
            damping: each(|o| 2.0 * o.alpha),
            approach,
            products: [approach[0] * approach[0], approach[0] * approach[1], approach[1] * approach[1]],
            damped: oscillators.iter().any(|o| o.alpha > 0.0),
            oscillators,
        }
    }

    /// Coordinates and rates after the time of these `moments` from the `state` under forces with these derivatives by time in it.
    #[inline(always)]
    fn after(&self, moments: &[f64x4; MOMENTS], [q, v]: [f64x4; 2], forces: &[Stages; 2]) -> [f64x4; 2] {
        let Block { stiffness, damping, approach: [b0, b1], .. } = *self;
        let mut displacement = moments[0] * q + moments[1] * (v + damping * q);
        let mut rate = moments[0] * v - stiffness * moments[1] * q;
        for p in 0..STAGES {
            let force = b0 * forces[0][p] + b1 * forces[1][p];
            displacement -= moments[p + 2] * force;
            rate -= moments[p + 1] * force;
        }
        [displacement, rate]
    }

    /// The moments at time `t` > 0, as [`Oscillator::moments`]; `powers` are t^p / p! for p < STAGES.
    #[inline(always)]
    pub fn moments(&self, t: f64, powers: &[f64; STAGES]) -> [f64x4; MOMENTS] {
        let angle = self.omega * t;
        if self.damped || angle.simd_lt(f64x4::splat(MAX_ANGLE)).to_bitmask() != 0b1111 {
            return self.one_by_one(t);
        }
        match angle.simd_lt(f64x4::splat(SERIES)).to_bitmask() {
            0b1111 => self.series(t, powers, angle * angle),
            0 => self.closed_form(powers, angle),
            _ => {
                let small = angle.simd_lt(f64x4::splat(SERIES));
                let (near, far) = (self.series(t, powers, angle * angle), self.closed_form(powers, angle));
                std::array::from_fn(|p| small.select(near[p], far[p]))
            }
        }
    }

    /// Small omega t: S_(p-2) = t^p c_p with Stumpff's functions c_p = sum of (-(omega t)^2)^m / (p + 2m)! for the two
    /// highest, recurrence downwards.
    #[inline(always)]
    fn series(&self, t: f64, powers: &[f64; STAGES], square: f64x4) -> [f64x4; MOMENTS] {
        // terms that are enough up to (omega t)^2 = 4, or 0.25
        let near = square.simd_lt(f64x4::splat(0.25)).to_bitmask() == 0b1111;
        let stumpff = |p: usize| if near { stumpff::<7>(p, square) } else { stumpff::<11>(p, square) };
        let mut moments = [f64x4::ZERO; MOMENTS];
        let high = powers[STAGES - 1] / INVERSE_FACTORIAL[STAGES - 1] * t;
        moments[MOMENTS - 2] = stumpff(MOMENTS - 2) * high;
        moments[MOMENTS - 1] = stumpff(MOMENTS - 1) * (high * t);
        for p in (0..STAGES).rev() {
            moments[p] = f64x4::splat(powers[p]) - self.stiffness * moments[p + 2];
        }
        moments
    }

    /// Large omega t: impulse response in closed form, recurrence upwards.
    #[inline(always)]
    fn closed_form(&self, powers: &[f64; STAGES], angle: f64x4) -> [f64x4; MOMENTS] {
        let (sine, cosine) = sin_cos(angle);
        let flexibility = self.flexibility;
        let mut moments = [f64x4::ZERO; MOMENTS];
        moments[0] = cosine;
        moments[1] = sine * self.omega * flexibility;
        for p in 0..STAGES {
            moments[p + 2] = (f64x4::splat(powers[p]) - moments[p]) * flexibility;
        }
        moments
    }

    #[cold]
    #[inline(never)]
    fn one_by_one(&self, t: f64) -> [f64x4; MOMENTS] {
        let moments = self.oscillators.map(|oscillator| oscillator.moments(t));
        std::array::from_fn(|p| f64x4::from(moments.map(|m| m[p])))
    }
}

/// Coordinates and rates after the time of these `moments` from rest under forces along the surfaces with these derivatives by time.
#[inline(always)]
pub fn pushed(moments: &[f64x4; MOMENTS], along: &[f64x4; 2], forces: &[Stages; 2]) -> [f64x4; 2] {
    let mut motion = [f64x4::ZERO; 2];
    for p in 0..STAGES {
        let force = along[0] * forces[0][p] + along[1] * forces[1][p];
        motion[0] += moments[p + 2] * force;
        motion[1] += moments[p + 1] * force;
    }
    motion
}

/// The first `N` terms of Stumpff's function c_p at `square` = (omega t)^2.
#[inline(always)]
fn stumpff<const N: usize>(p: usize, square: f64x4) -> f64x4 {
    let mut sum = f64x4::ZERO;
    for m in (0..N).rev() {
        sum = f64x4::splat(INVERSE_FACTORIAL[p + 2 * m]) - square * sum;
    }
    sum
}

/// At most [`LANES`] `values`, filled up with zeros.
pub fn filled_up(values: &[f64]) -> f64x4 {
    f64x4::from(std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0)))
}

/// `values` in blocks, filled up with zeros.
pub fn in_blocks(values: &[f64]) -> Vec<f64x4> {
    values.chunks(LANES).map(filled_up).collect()
}

/// Sine and cosine of 0 <= x < [`MAX_ANGLE`]: reduction by quarter turns in three parts (Cody and Waite), polynomials of
/// Cephes. The library's own also treats signs, infinities and NaN, at twice the cost.
#[inline(always)]
fn sin_cos(x: f64x4) -> (f64x4, f64x4) {
    const SINE: [f64; 6] = [
        -0.1666666666666663,
        0.008333333333322118,
        -0.0001984126982958954,
        2.7557313621385722e-06,
        -2.5050747762857807e-08,
        1.5896230157654656e-10,
    ];
    const COSINE: [f64; 6] = [
        0.041666666666666595,
        -0.0013888888888873056,
        2.4801587288851704e-05,
        -2.755731417929674e-07,
        2.087570084197473e-09,
        -1.1358536521387682e-11,
    ];
    const QUARTER: [f64; 3] = [1.5707963109016418, 1.5893254712295857e-8, 6.123233995736766e-17];
    // adding it rounds to an integer, which then stands in the lowest bits
    const ROUND: f64 = 6_755_399_441_055_744.0;
    let shifted = x * f64x4::splat(std::f64::consts::FRAC_2_PI) + f64x4::splat(ROUND);
    let quarters: u64x4 = cast(shifted);
    let n = shifted - f64x4::splat(ROUND);
    let r = ((x - n * QUARTER[0]) - n * QUARTER[1]) - n * QUARTER[2];
    let square = r * r;
    let polynomial = |coefficients: &[f64; 6]| {
        coefficients.iter().rev().fold(f64x4::ZERO, |sum, c| sum * square + f64x4::splat(*c))
    };
    let sine = r + r * square * polynomial(&SINE);
    let cosine = (f64x4::ONE - square * 0.5) + square * square * polynomial(&COSINE);
    let one = u64x4::splat(1);
    let swap: f64x4 = cast(u64x4::splat(0) - (quarters & one));
    let sign = |turns: u64x4| -> f64x4 { cast((turns & u64x4::splat(2)) << 62) };
    (swap.select(cosine, sine) ^ sign(quarters), swap.select(sine, cosine) ^ sign(quarters + one))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::kirchhoff;
    use crate::dynamics::MovingBody;
    use crate::dynamics::tangential_load::TangentialLoad;
    use crate::scene::Scene;
    use approx::assert_relative_eq;

    /// Going on from one interval to the next gives what the whole time gives, damped or fed by a circuit.
    #[test]
    fn a_march_passes_where_the_whole_step_passes() {
        for text in [
            include_str!("../../../scenes/scaled-plate-r10.toml"),
            include_str!("../../../scenes/validation/damped-plate.toml"),
            include_str!("../../../scenes/validation/stack.toml"),
        ] {
            let scene = Scene::parse("scene.toml", text).expect("valid");
            let setup = scene.plate_impact().expect("a plate");
            let bodies = MovingBody::both(&setup.outer, &setup.inner).expect("bodies");
            let plate = kirchhoff::modes(&setup.plate, 16).expect("modes");
            let (system, h) = (System::of(&bodies, &plate, &setup.plate.material, [0.0; 2]), 3e-6);
            let batch = OscillatorBatch::new(&system);
            let (q, v) = system.initial_state();
            let (q, v) = (in_blocks(&q), in_blocks(&v));
            let forces = [[300.0, 2e8, -1e14, 4e19], [-100.0, 5e7, 3e13, -2e19]];
            let intervals = 40;
            let samples = batch.approaches_within((&q, &v), &forces, h, intervals);
            assert_eq!(samples.len(), intervals + 1);
            for (k, sample) in samples.iter().enumerate().skip(1) {
                let at = batch.approach_after((&q, &v), &forces, h * k as f64 / intervals as f64);
                for (found, expected) in sample.iter().flatten().zip(at.iter().flatten()) {
                    assert_relative_eq!(*found, *expected, max_relative = 1e-9, epsilon = 1e-18);
                }
            }
        }
    }

    /// Forces along surfaces that move as the contacts approach are contact forces of the opposite sign.
    #[test]
    fn forces_along_the_surfaces_move_oscillators_as_contact_forces_do() {
        let scene = include_str!("../../../scenes/validation/damped-plate.toml");
        let scene = Scene::parse("scene.toml", scene).expect("valid");
        let setup = scene.plate_impact().expect("a plate");
        let bodies = MovingBody::both(&setup.outer, &setup.inner).expect("bodies");
        let plate = kirchhoff::modes(&setup.plate, 16).expect("modes");
        let mut system = System::of(&bodies, &plate, &setup.plate.material, [0.0; 2]);
        let along = (0..system.oscillators.len()).map(|k| [system.approach[1][k], system.approach[0][k]]);
        system.tangential_load = Some(TangentialLoad { course: Vec::new(), along: along.collect() });
        let batch = OscillatorBatch::new(&system);
        let rest = vec![f64x4::ZERO; batch.blocks.len()];
        let forces = [[300.0, 2e8, -1e14, 4e19], [-100.0, 5e7, 3e13, -2e19]];
        let swapped = [forces[1], forces[0]];
        let pressed = batch.approach_after((&rest, &rest), &forces, 3e-6);
        let pushed = batch.pushed_after(&swapped, 3e-6);
        for (pressed, pushed) in pressed.iter().flatten().zip(pushed.iter().flatten()) {
            assert_relative_eq!(*pressed, -pushed, max_relative = 1e-12);
        }
    }

    #[test]
    fn sine_and_cosine_to_the_last_places() {
        for i in 0..4000 {
            let x = 1.003_f64.powi(i) * 1e-3;
            let (sine, cosine) = sin_cos(f64x4::splat(x));
            if x < 1e8 {
                assert_relative_eq!(sine.to_array()[0], x.sin(), epsilon = 4e-16);
                assert_relative_eq!(cosine.to_array()[3], x.cos(), epsilon = 4e-16);
            }
        }
    }
}
