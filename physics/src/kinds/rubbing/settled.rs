//! Friction that bends or turns what is struck, and contacts that move over it: the motion across the surfaces and that along them, in turn
//! until both settle.

use super::{Rubbing, StruckSurface};
use crate::dynamics::error_control::differences;
use crate::dynamics::integration::{Integration, Options, Settled};
use crate::dynamics::sliding::Slid;
use crate::dynamics::surface_modes::SurfaceMode;
use crate::dynamics::system::System;
use crate::dynamics::tangential_load::TangentialLoad;
use crate::error::Result;
use std::borrow::Cow;

/// Velocity across the surfaces by friction, over the speed, up to which its effect is negligible; and relative change of what the first mode
/// does at a contact that has moved.
const NEGLIGIBLE: f64 = 1e-4;
/// Error of velocities, over the speed, and force peaks, relative, that is in order.
pub(in crate::kinds) const SETTLED: f64 = 1e-4;
/// Rounds at most; two are enough where they converge at all.
const MOST_ROUNDS: usize = 6;

impl Rubbing {
    /// The impact of `system` that `run` finds, with the effect of the motion along the surfaces on that across them if there is one, and the
    /// contact forces as its history, or the one that the `options` request. Where friction excites vibrations of what is struck more and
    /// more, rounds diverge after they have come near: then the nearest counts.
    ///
    /// # Errors
    /// As `run` and [`Rubbing::solve`].
    pub(in crate::kinds) fn settled(
        &self,
        system: &System,
        options: &Options,
        run: impl Fn(&System, &Options) -> Result<Integration>,
    ) -> Result<Integration> {
        let StruckSurface::Moving(modes) = &self.struck else { return run(system, options) };
        let rubs = self.has_friction() && modes.iter().any(couples);
        if !(rubs || self.moves_on(system)) {
            return run(system, options);
        }
        let with_forces = self.keeping_forces(system, &Options { sample_interval: None, ..*options });
        let smooth = run(system, &with_forces)?;
        let slid = self.slide(&smooth)?;
        // what happens along the surfaces changes little: steps that are right without it are right with it
        let converged = smooth.converged.or(options.converged);
        let (once, error_estimate) = (Options { converged, ..with_forces }, smooth.error_estimate);
        let along = participations(system, modes);
        let mut settled = Settled { error: 0.0, slid };
        let (mut found, mut last) = (smooth, Cow::Borrowed(system));
        let is_notable = rubs && settled.slid.across > NEGLIGIBLE * system.speed
            || self.moves_on(system) && settled.slid.change(system) > NEGLIGIBLE;
        let mut change_before = f64::INFINITY;
        for _ in 0..if is_notable { MOST_ROUNDS } else { 0 } {
            let load =
                TangentialLoad { course: std::mem::take(&mut settled.slid.course), along: along.clone() };
            let changed = System { tangential_load: Some(load), ..system.clone() };
            let next = run(&changed, &once)?;
            let change = change(system, [&found, &next]);
            if change >= change_before {
                settled.error = change;
                break;
            }
            // each round leaves the same share of the change before
            let share = change / change_before;
            settled.error = if share > 0.0 { change * share / (1.0 - share) } else { change };
            settled.slid =
                Slid { error: settled.slid.error, ..self.slide_in_steps(&next, settled.slid.finer)? };
            (found, last, change_before) = (next, Cow::Owned(changed), change);
            if settled.error <= SETTLED {
                break;
            }
        }
        if *options != with_forces {
            found = run(&last, &Options { converged, ..*options })?;
        }
        Ok(Integration { friction: Some(settled), converged, error_estimate, ..found })
    }

    /// Whether the outer body moves over a plate where its modes change along x.
    fn moves_on(&self, system: &System) -> bool {
        self.tilt.is_some() && self.outer.angle != 0.0 && system.along.iter().any(|along| along[0] != 0.0)
    }
}

impl Slid {
    /// Largest relative change of what the first mode of `system` does at the outer contact, as that moves.
    fn change(&self, system: &System) -> f64 {
        let farthest = self.course.iter().map(|(_, at)| at.ways[0].abs()).fold(0.0, f64::max);
        let first = system.elastic().zip(&system.along).next();
        first.map_or(0.0, |(k, along)| farthest * (along[0] / system.approach[0][k]).abs())
    }
}

/// Change of velocities, over the speed of `system`, and force peaks, relative, between two results of it.
fn change(system: &System, results: [&Integration; 2]) -> f64 {
    let peaks = results.map(|result| result.contacts.map(|contact| contact.force_peak));
    let [velocity, force] = differences(system, results.map(|result| result.velocity), peaks);
    velocity.max(force)
}

/// Whether `mode` moves the surfaces along themselves and across.
fn couples(mode: &SurfaceMode) -> bool {
    [mode.along, mode.approach].iter().all(|moved| *moved != [0.0; 2])
}

/// Displacement along x of the surfaces at both contacts per unit of each coordinate of `system`, of which the struck body moves in `modes`. Of
/// rigid motions the system has those that the contacts see: what a force along x does across the surfaces is the same as by all of them.
fn participations(system: &System, modes: &[SurfaceMode]) -> Vec<[f64; 2]> {
    let mut along = vec![[0.0; 2]; system.oscillators.len()];
    system.elastic().zip(&system.along).for_each(|(k, of_mode)| along[k] = *of_mode);
    // the contacts see as few rigid motions as there are across the surfaces: combinations of all
    let rigid = || modes.iter().filter(|mode| mode.oscillator.omega == 0.0);
    let seen: Vec<usize> = system.rigid().collect();
    let approach = |k: usize, i: usize| system.approach[i][k];
    for i in 0..2 {
        // motion across the surface at both contacts by a force along it at contact i
        let moved = [0, 1].map(|j| rigid().map(|mode| mode.approach[j] * mode.along[i]).sum::<f64>());
        match seen[..] {
            [k] => along[k][i] = moved[0] / approach(k, 0),
            [k, l] => {
                let [[a, b], [c, d]] = [0, 1].map(|j| [approach(k, j), approach(l, j)]);
                let determinant = a * d - b * c;
                along[k][i] = (moved[0] * d - b * moved[1]) / determinant;
                along[l][i] = (a * moved[1] - moved[0] * c) / determinant;
            }
            _ => {}
        }
    }
    along
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::ModalBody;
    use crate::dynamics::MovingBody;
    use crate::dynamics::error_control::controlled;
    use crate::material::Material;
    use crate::scene::{Outer, Shape, Turning};
    use approx::assert_relative_eq;

    /// A ball slides over the face of a free rigid body, on the whole way, away from the centre: the friction turns the body towards the ball
    /// or away from it. Along the normal that is an elastic impact of another mobility, A - mu C (Stronge, Impact Mechanics, 2000, 3.3).
    #[test]
    fn a_sliding_ball_turns_a_rigid_body() {
        let steel = Material::elastic("steel", 210e9, 0.3, 7780.0);
        let (mass, inertia, height) = (20e-3_f64, 4e-7_f64, 8e-3);
        for (arm, friction) in [(5e-3, 0.3), (-5e-3, 0.3), (3e-3, 0.25), (-3e-3, 0.25)] {
            // along z, along x, about y
            let motion = |approach: f64, along: f64| SurfaceMode::rigid([approach, 0.0], [along, 0.0]);
            let (push, turn) = (mass.sqrt().recip(), inertia.sqrt().recip());
            let modes = vec![motion(push, 0.0), motion(0.0, push), motion(arm * turn, height * turn)];
            let product = |of: fn(&SurfaceMode) -> f64, by: fn(&SurfaceMode) -> f64| -> f64 {
                modes.iter().map(|mode| of(mode) * by(mode)).sum()
            };
            let of_body = product(|mode| mode.approach[0], |mode| mode.approach[0]);
            let coupling = product(|mode| mode.approach[0], |mode| mode.along[0]);
            let body = ModalBody {
                omega: vec![0.0],
                damping_ratio: vec![0.0],
                participation: vec![[of_body.sqrt(), 0.0]],
                residual: None,
            };
            let turning = Turning { friction, ..Turning::default() };
            let angle = 80_f64.to_radians();
            let ball = Outer::centred(Shape::Sphere { radius: 3e-3 }, steel.clone(), 0.2);
            let normal = MovingBody::outer(&ball).unwrap();
            let system = System::on_body(normal, &body, &steel, 0.0);
            let outer = Outer { angle, speed: ball.speed / angle.cos(), turning, ..ball };
            let contact = (system.laws[0], [steel.clone(), steel.clone()]);
            let rubbing = Rubbing {
                outer,
                inner: None,
                struck: StruckSurface::Moving(modes),
                tilt: None,
                aside: Vec::new(),
                contacts: [contact.clone(), contact],
            };
            let run = |system: &System, options: &Options| controlled(options, system, None);
            let found = rubbing.settled(&system, &Options::default(), run).unwrap();
            let mobility = system.masses[0].recip() + of_body;
            let impulse = 2.0 * system.speed / (mobility - friction * coupling);
            assert_relative_eq!(found.contacts[0].impulse, impulse, max_relative = 2e-3);
            // the coupling is no detail
            let smooth = 2.0 * system.speed / mobility;
            assert!((impulse / smooth - 1.0).abs() > 0.01, "{impulse} {smooth}");
            let residuals = [found.momentum_residual, found.energy_residual];
            assert!(residuals[0] < 1e-12 && residuals[1] < 1e-7, "{residuals:?}");
            assert!(found.friction.is_some_and(|friction| friction.error < SETTLED));
        }
    }

    /// What a force along the surface does across it at both contacts, by the rigid motions that the contacts see and by all of them.
    #[test]
    fn rigid_motions_that_the_contacts_see_are_pushed_as_all_are() {
        let motion = |approach: [f64; 2], along: [f64; 2]| SurfaceMode::rigid(approach, along);
        let modes = [
            motion([2.0, -1.0], [0.3, 0.1]),
            motion([0.5, 1.5], [-0.7, 0.2]),
            motion([1.0, 0.4], [0.6, 0.9]),
        ];
        let product = |i: usize, j: usize| modes.iter().map(|m| m.approach[i] * m.approach[j]).sum::<f64>();
        let first = product(0, 0).sqrt();
        let shared = product(0, 1) / first;
        let body = ModalBody {
            omega: vec![0.0; 2],
            damping_ratio: vec![0.0; 2],
            participation: vec![[first, -shared], [0.0, -(product(1, 1) - shared * shared).sqrt()]],
            residual: None,
        };
        let steel = Material::elastic("steel", 210e9, 0.3, 7780.0);
        let ball = Outer::centred(Shape::Sphere { radius: 3e-3 }, steel.clone(), 0.2);
        let bodies = [(); 2].map(|()| MovingBody::outer(&ball).unwrap());
        let system = System::of(&bodies, &body, &steel, [0.0; 2]);
        let along = participations(&system, &modes);
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let seen: f64 = system.rigid().map(|k| system.approach[i][k] * along[k][j]).sum();
            let all: f64 = modes.iter().map(|mode| mode.approach[i] * mode.along[j]).sum();
            assert_relative_eq!(seen, all, max_relative = 1e-12);
        }
    }
}
