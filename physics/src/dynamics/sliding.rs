//! Motion along the surfaces and spin of bodies that touch with friction.
//!
//! The normal motion is solved before: what forces along the surface do to it is left out, which on a flat, symmetric surface is nothing.
//! Bodies, modes of what is struck and the contacts' tangential flexibility take part.

use super::surface_modes::{MovingSurfaces, SurfaceForces, SurfaceMode};
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
    /// Relative acceleration of the bodies' surfaces per force, 1/kg. Shape (contacts, contacts).
    pub mobility: [[f64; 2]; 2],
    /// Of what they strike, at rest at t = 0.
    pub modes: &'a [SurfaceMode],
    /// Relative velocity of the surfaces at t = 0 in m/s: of the outer and the inner body over what they touch.
    pub velocity: [f64; 2],
}

/// What friction did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Slid {
    /// Impulses on the struck body in N s along the surface, by outer and inner body.
    pub impulse: [f64; 2],
    /// Energy dissipated in the contacts, J.
    pub dissipated: [f64; 2],
    /// Largest velocity in m/s at which the forces along the surfaces move a contact across them: what is left out.
    pub across: f64,
}

impl Sliding<'_> {
    /// Moves the bodies while they are pressed together as `presses` has it at every `time` in s. Shapes (samples), (contacts, samples).
    pub fn slide(mut self, time: &[f64], presses: &[Vec<Press>; 2]) -> Slid {
        let mut slid = Slid::default();
        let mut velocity = self.velocity;
        let mut surfaces = MovingSurfaces::new(self.modes);
        let mut by_friction = surfaces.clone();
        for k in 1..time.len() {
            let [from, to] = [k - 1, k].map(|k| [presses[0][k], presses[1][k]]);
            let length = time[k] - time[k - 1];
            let count = self.steps([0, 1].map(|i| from[i].radius.max(to[i].radius)), length);
            let h = length / count;
            let mut press = from;
            for step in 1..=count as usize {
                let across = press.map(|press| press.force);
                let before = SurfaceForces { across, along: self.forces() };
                press = [0, 1].map(|i| from[i].between(&to[i], step as f64 / count));
                self.kick(&mut velocity, before.along, 0.5 * h);
                surfaces.kick(before, 0.5 * h);
                let moved = surfaces.drift(h);
                for (i, contact) in self.contacts.iter_mut().enumerate() {
                    let step = velocity[i] * h - moved[i];
                    contact.iter_mut().for_each(|contact| contact.advance(press[i], step, h));
                }
                let after = SurfaceForces { across: press.map(|press| press.force), along: self.forces() };
                self.kick(&mut velocity, after.along, 0.5 * h);
                surfaces.kick(after, 0.5 * h);
                by_friction.kick(SurfaceForces { across: [0.0; 2], ..after }, h);
                by_friction.drift(h);
                slid.across = slid.across.max(by_friction.speed_across());
                (0..2).for_each(|i| slid.impulse[i] += 0.5 * h * (before.along[i] + after.along[i]));
            }
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
            let accurate = (stiffness * self.mobility[i][i]).sqrt() / LONGEST;
            let stable = (stiffness * (self.mobility[i][i] + modes)).sqrt() / STABLE;
            Some(length * accurate.max(stable))
        };
        // contacts that are open forget where they were
        (0..2).filter_map(of).fold(0.0, f64::max).ceil().max(1.0)
    }

    fn kick(&self, velocity: &mut [f64; 2], forces: [f64; 2], h: f64) {
        for (rate, row) in velocity.iter_mut().zip(&self.mobility) {
            *rate -= h * (row[0] * forces[0] + row[1] * forces[1]);
        }
    }
}
