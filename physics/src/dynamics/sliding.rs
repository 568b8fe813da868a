//! Motion along the surfaces and spin of bodies that touch with friction.
//!
//! The normal motion is solved before. What forces along the surface do to it is nothing on a flat, symmetric surface; elsewhere see
//! [`super::tangential_load`].
//! Bodies, modes of what is struck and the contacts' tangential flexibility take part.

use super::surface_modes::{MovingSurfaces, SurfaceMode};
use super::tangential_load::Tangential;
use crate::contact::{Press, TangentialContact};

/// Longest step over the inverse angular frequency of the sticking contact.
const LONGEST: f64 = 0.05;
/// The same with the modes of what is struck, which would be unstable from 2 on.
const STABLE: f64 = 0.5;

/// A body that moves along the surface and turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurningBody {
    /// Mass in kg.
    pub mass: f64,
    /// Moment of inertia about its centre, kg m^2.
    pub inertia: f64,
    /// Distance of the centre from the contact, m.
    pub arm: f64,
}

impl TurningBody {
    /// Acceleration of its surface at the contact per force along it, 1/kg.
    pub fn mobility(&self) -> f64 {
        1.0 / self.mass + self.arm * self.arm / self.inertia
    }
}

/// Contacts whose surfaces move along each other.
#[derive(Debug)]
pub struct Sliding<'a> {
    /// Outer and inner contact; `None`: it does not exist.
    pub contacts: [Option<TangentialContact>; 2],
    /// Relative acceleration of the bodies' surfaces at each contact per force there, 1/kg.
    pub mobility: [f64; 2],
    /// Of what they strike, at rest at t = 0.
    pub modes: &'a [SurfaceMode],
    /// Relative velocity of the surfaces at t = 0 in m/s: of the outer and the inner body over what they touch.
    pub velocity: [f64; 2],
    /// Velocity along x of the bodies' centres at t = 0, m/s.
    pub centres: [f64; 2],
    /// Where the surfaces of what they strike turn as they move along themselves.
    pub tilt: Option<Tilt>,
}

/// How the forces across a plate's faces push bodies along x: its normal turns by the displacement of its faces along x over half of its
/// thickness (Kirchhoff).
#[derive(Debug, Clone, Copy)]
pub struct Tilt {
    /// Half of the thickness, m.
    pub arm: f64,
    /// Masses of outer and inner body in kg.
    pub masses: [f64; 2],
}

/// What friction did.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Slid {
    /// Impulses on the struck body in N s along the surface, by outer and inner body.
    pub impulse: [f64; 2],
    /// Energy dissipated in the contacts, J.
    pub dissipated: [f64; 2],
    /// Impulses in N s along x on the bodies by forces across surfaces that turn.
    pub tilted: [f64; 2],
    /// Times in s, and what happens along the surfaces then; the ways of the contacts are known where the surfaces turn.
    pub course: Vec<(f64, Tangential)>,
    /// Largest velocity in m/s at which the forces along the surfaces move a contact across them.
    pub across: f64,
    /// Estimated error of the velocities along the surfaces, over the speed; 0 if it was not looked for.
    pub error: f64,
    /// Steps over those that seem enough.
    pub finer: f64,
}

impl Sliding<'_> {
    /// Moves the bodies while they are pressed together as `presses` has it at every `time` in s, in `finer` times as many steps as seem enough.
    /// With fewer not every sample counts. Shapes (samples), (contacts, samples).
    pub fn slide(mut self, time: &[f64], presses: &[Vec<Press>; 2], finer: f64) -> Slid {
        let mut slid = Slid { course: vec![(0.0, Tangential::default())], finer, ..Slid::default() };
        let mut velocity = self.velocity;
        let mut surfaces = MovingSurfaces::new(self.modes);
        let mut earlier = self.forces();
        // of the surfaces along x so far, m
        let mut moved = [0.0; 2];
        let mut now = Tangential::default();
        let last = time.len().saturating_sub(1);
        let apart = finer.recip().max(1.0) as usize;
        for start in (0..last).step_by(apart) {
            let end = (start + apart).min(last);
            let [from, to] = [start, end].map(|k| [presses[0][k], presses[1][k]]);
            let length = time[end] - time[start];
            let enough = self.steps([0, 1].map(|i| from[i].radius.max(to[i].radius)), length);
            let count = (finer * enough).ceil();
            let h = length / count;
            surfaces.prepare(h);
            let mut press = from;
            for step in 1..=count as usize {
                let (before, across) = (self.forces(), press.map(|press| press.force));
                press = [0, 1].map(|i| match step as f64 / count {
                    1.0 => to[i],
                    share => from[i].between(&to[i], share),
                });
                self.kick(&mut velocity, before, 0.5 * h);
                surfaces.kick(before, 0.5 * h);
                let by_pressing = surfaces.press(across, press.map(|press| press.force));
                let by_friction = surfaces.drift();
                // a step late, which takes a little energy
                let yields = surfaces.yields([0, 1].map(|i| before[i] - earlier[i]));
                earlier = before;
                for (i, contact) in self.contacts.iter_mut().enumerate() {
                    let surface = by_pressing[i] + by_friction[i] + yields[i];
                    if let Some(Tilt { arm, masses }) = self.tilt {
                        let force = 0.5 * (across[i] + press[i].force);
                        let impulse = h * force * (moved[i] + 0.5 * surface) / arm;
                        let centre = self.centres[i] + (slid.tilted[i] - slid.impulse[i]) / masses[i];
                        now.ways[i] += (centre * h - surface) / arm;
                        slid.tilted[i] += impulse;
                        velocity[i] += impulse / masses[i];
                    }
                    moved[i] += surface;
                    let step = velocity[i] * h - surface;
                    contact.iter_mut().for_each(|contact| contact.advance(press[i], step, h));
                }
                let after = self.forces();
                self.kick(&mut velocity, after, 0.5 * h);
                surfaces.kick(after, 0.5 * h);
                slid.across = slid.across.max(surfaces.speed_across());
                (0..2).for_each(|i| slid.impulse[i] += 0.5 * h * (before[i] + after[i]));
            }
            let forces = self.forces();
            // between two contacts the ratio stays as it was
            (0..2).filter(|i| to[*i].force > 0.0).for_each(|i| now.ratios[i] = forces[i] / to[i].force);
            slid.course.push((time[end], now));
        }
        for (i, contact) in self.contacts.iter().enumerate() {
            slid.dissipated[i] = contact.as_ref().map_or(0.0, TangentialContact::dissipated);
        }
        slid
    }

    fn forces(&self) -> [f64; 2] {
        [0, 1].map(|i| self.contacts[i].as_ref().map_or(0.0, |contact| contact.force))
    }

    /// Steps that an interval of that `length` in s takes, for the frequency of the bodies on contacts of these `radii` in m that stick; modes
    /// move freely by themselves, and count only as far as the steps have to be stable.
    fn steps(&self, radii: [f64; 2], length: f64) -> f64 {
        let of = |i: usize| {
            let stiffness = self.contacts[i].as_ref()?.sticking_stiffness(radii[i]);
            let modes: f64 = self.modes.iter().map(|mode| mode.along[i] * mode.along[i]).sum();
            let accurate = (stiffness * self.mobility[i]).sqrt() / LONGEST;
            let stable = (stiffness * (self.mobility[i] + modes)).sqrt() / STABLE;
            Some(length * accurate.max(stable))
        };
        // contacts that are open forget where they were
        (0..2).filter_map(of).fold(0.0, f64::max).max(1.0)
    }

    fn kick(&self, velocity: &mut [f64; 2], forces: [f64; 2], h: f64) {
        (0..2).for_each(|i| velocity[i] -= h * self.mobility[i] * forces[i]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::duhamel::Oscillator;
    use approx::assert_relative_eq;

    /// A plate that gives way at once, so that its normal stays turned while the forces act: F theta T/m, without friction.
    #[test]
    fn a_tilted_plate_pushes_bodies_along_x() {
        let omega = 1e9;
        let oscillator = Oscillator { omega, alpha: omega };
        let modes = [SurfaceMode { oscillator, approach: [2.0, 1.0], along: [3.0, -4.0] }];
        let (arm, masses) = (1e-3, [2e-3, 5e-3]);
        let time: Vec<f64> = (0..=2000).map(|k| f64::from(k) * 1e-7).collect();
        let forces = [40.0, 10.0];
        let presses = forces.map(|force| {
            let at = |k: usize| Press { force: if k == 0 { 0.0 } else { force }, ..Press::default() };
            (0..time.len()).map(at).collect()
        });
        let sliding = Sliding {
            contacts: [None, None],
            mobility: [1.0; 2],
            modes: &modes,
            velocity: [0.0; 2],
            centres: [3.0, 0.0],
            tilt: Some(Tilt { arm, masses }),
        };
        let slid = sliding.slide(&time, &presses, 1.0);
        let coordinate = -(2.0 * forces[0] + forces[1]) / (omega * omega);
        for (i, along) in [3.0, -4.0].into_iter().enumerate() {
            let expected = forces[i] * along * coordinate / arm * 2e-4;
            assert_relative_eq!(slid.tilted[i], expected, max_relative = 2e-3);
        }
        assert_eq!(slid.impulse, [0.0; 2]);
    }
}
