//! A rough run: contact forces as kicks between exact free motions.
//!
//! The oscillators move freely for a fixed time, then the contacts' forces change their rates at once (Strang's splitting: Hairer,
//! Lubich and Wanner, Geometric Numerical Integration, 2006, II.5). It is of second order and hardly looks at what it does: for
//! impacts that only have to be known to a few percent. A contact much weaker than the other one, behind a thick plate, can be off by half.

use super::batch::{OscillatorBatch, in_blocks};
use super::free_flight;
use super::system::System;
use wide::f64x4;

/// Free motion in radians of the stiffer contact with the bodies alone, for accuracy, and with all oscillators, of which 2 would be
/// unstable.
const STEP: [f64; 2] = [0.25, 1.0];
/// Steps from one look at whether it is over to the next.
const LOOKS: usize = 16;
/// Steps after which the run is given up.
const MAX_STEPS: usize = 4000;

/// What a contact did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SplittingPeak {
    /// Largest force, N.
    pub force_peak: f64,
    /// Impulse, N s.
    pub impulse: f64,
}

/// Both contacts of the impact of `system` until no further one is possible, without residual flexibility; `None` if that takes too long,
/// and of a stack, which presses on when all else is over.
pub fn run(system: &System) -> Option<[SplittingPeak; 2]> {
    if system.stack.is_some() {
        return None;
    }
    let h = step(system);
    let batch = OscillatorBatch::new(system);
    let free: Vec<[f64; 2]> = system.oscillators.iter().map(|oscillator| oscillator.free(h)).collect();
    let [slope, impulse] = [0, 1].map(|i| in_blocks(&free.iter().map(|free| free[i]).collect::<Vec<_>>()));
    let (q, v) = system.initial_state();
    let (mut q, mut v) = (in_blocks(&q), in_blocks(&v));
    let mut contacts = [SplittingPeak::default(); 2];
    for n in 0..MAX_STEPS {
        let mut sums = [f64x4::ZERO; 2];
        for (k, block) in batch.blocks.iter().enumerate() {
            let (start, rate) = (q[k], v[k]);
            q[k] = slope[k] * start + impulse[k] * (rate + block.damping * start);
            v[k] = slope[k] * rate - block.stiffness * impulse[k] * start;
            sums[0] += block.approach[0] * q[k];
            sums[1] += block.approach[1] * q[k];
        }
        let force = [0, 1].map(|i| system.laws[i].force(sums[i].reduce_add() - system.gap[i]));
        for (k, block) in batch.blocks.iter().enumerate() {
            v[k] -= h * (block.approach[0] * force[0] + block.approach[1] * force[1]);
        }
        for (contact, force) in contacts.iter_mut().zip(force) {
            contact.force_peak = contact.force_peak.max(force);
            contact.impulse += h * force;
        }
        if n % LOOKS == 0 && force == [0.0; 2] {
            let [q, v]: [&[f64]; 2] = [&q, &v].map(|blocks| bytemuck::cast_slice(blocks));
            if free_flight::is_over(system, &q[..system.size()], &v[..system.size()]) {
                return Some(contacts);
            }
        }
    }
    None
}

/// Length of a step in s.
fn step(system: &System) -> f64 {
    let approach = system.hertz_impact().approach_peak();
    let of = |i: usize| {
        let frequency = |mobility: f64| (system.laws[i].tangent(approach) * mobility).sqrt();
        let all: f64 = system.approach[i].iter().map(|b| b * b).sum();
        (STEP[0] / frequency(1.0 / system.masses[i])).min(STEP[1] / frequency(all))
    };
    of(0).min(of(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::kirchhoff::modes;
    use crate::dynamics::integration::Options;
    use crate::dynamics::integrator::integrate;
    use crate::scene::Scene;
    use approx::assert_relative_eq;

    /// As the collocation finds them; peaks 9 % apart are patches 3 % apart.
    #[test]
    fn peaks_and_impulses_are_known_to_a_few_percent() {
        for (thickness, inner) in
            [(1e-3, 10e-3), (2e-3, 10e-3), (2e-3, 4e-3), (3e-3, 8e-3), (4e-3, 10e-3), (6e-3, 10e-3)]
        {
            let text = include_str!("../../../scenes/scaled-plate-r10.toml");
            let mut setup = Scene::parse("r10.toml", text).unwrap().plate_impact().unwrap().clone();
            setup.plate.thickness = thickness;
            setup.inner.shape = crate::scene::Shape::Sphere { radius: inner };
            let with = |count| setup.rigid_system(&modes(&setup.plate, count).unwrap(), [0.0; 2]);
            let exact = integrate(&with(16), &Options::default()).unwrap().contacts;
            for (ours, exact) in run(&with(8)).expect("an end").iter().zip(&exact) {
                assert_relative_eq!(ours.force_peak, exact.force_peak, max_relative = 9e-2);
                assert_relative_eq!(ours.impulse, exact.impulse, max_relative = 5e-2);
            }
        }
    }
}
