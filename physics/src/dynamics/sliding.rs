//! Motion along the surfaces and spin of bodies that touch with friction.
//!
//! The normal motion is solved before: what forces along the surface do to it is left out, which on a flat, symmetric surface is nothing.
//! Bodies, modes of what is struck and the contacts' tangential flexibility take part.

use crate::contact::TangentialContact;
use crate::error::{Error, Result};
use crate::numerics::duhamel::Oscillator;
use crate::result::History;

/// Longest step over the inverse angular frequency of the sticking contact.
const LONGEST: f64 = 0.05;

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

/// A mode of what is struck, whose surfaces it moves: by the forces across them, as where a plate's normal turns, and along them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceMode {
    /// How its coordinate vibrates.
    pub oscillator: Oscillator,
    /// Approach of outer and inner contact per unit of its coordinate, kg^(-1/2).
    pub approach: [f64; 2],
    /// Displacement along x of the surface at outer and inner contact per unit of its coordinate, kg^(-1/2).
    pub along: [f64; 2],
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
    /// Moves the bodies while they are pressed together by the forces `history`.
    ///
    /// # Errors
    /// [`Error::Internal`] of a history without forces.
    pub fn slide(mut self, history: &History) -> Result<Slid> {
        let forces = ["outer_force", "inner_force"].map(|name| history.curve(name));
        let [Some(outer), Some(inner)] = forces else {
            return Err(Error::Internal("the history has no contact forces".into()));
        };
        let mut slid = Slid::default();
        let mut velocity = self.velocity;
        let mut states = vec![[0.0; 2]; self.modes.len()];
        let mut by_friction = states.clone();
        for k in 1..history.len() {
            let (from, to) = ([outer[k - 1], inner[k - 1]], [outer[k], inner[k]]);
            let length = history.time[k] - history.time[k - 1];
            // contacts that are open forget where they were
            let count = (length * self.frequency(from, to) / LONGEST).ceil().max(1.0);
            let h = length / count;
            for step in 1..=count as usize {
                let share = step as f64 / count;
                let pressed = |share: f64| [0, 1].map(|i| (from[i] + share * (to[i] - from[i])).max(0.0));
                let (earlier, normal) = (pressed(share - 1.0 / count), pressed(share));
                let before = self.forces();
                self.kick(&mut velocity, before, 0.5 * h);
                let moved = self.drift(&mut states, (earlier, before), h);
                for (i, contact) in self.contacts.iter_mut().enumerate() {
                    let step = velocity[i] * h - moved[i];
                    contact.iter_mut().for_each(|contact| contact.advance(normal[i], step));
                }
                let after = self.forces();
                self.kick(&mut velocity, after, 0.5 * h);
                self.kick_modes(&mut states, (normal, after), 0.5 * h);
                self.drift(&mut by_friction, ([0.0; 2], before), h);
                self.kick_modes(&mut by_friction, ([0.0; 2], after), 0.5 * h);
                slid.across = self.across(&by_friction).into_iter().fold(slid.across, f64::max);
                (0..2).for_each(|i| slid.impulse[i] += 0.5 * h * (before[i] + after[i]));
            }
        }
        for (i, contact) in self.contacts.iter().enumerate() {
            slid.dissipated[i] = contact.as_ref().map_or(0.0, TangentialContact::dissipated);
        }
        Ok(slid)
    }

    fn forces(&self) -> [f64; 2] {
        [0, 1].map(|i| self.contacts[i].as_ref().map_or(0.0, |contact| contact.force))
    }

    /// Angular frequency in rad/s of the bodies on contacts that stick.
    fn frequency(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let of = |i: usize| {
            let stiffness = self.contacts[i].as_ref()?.sticking_stiffness(from[i].max(to[i]));
            let modes: f64 = self.modes.iter().map(|mode| mode.along[i] * mode.along[i]).sum();
            Some((stiffness * (self.mobility[i][i] + modes)).sqrt())
        };
        (0..2).filter_map(of).fold(0.0, f64::max)
    }

    /// Moves the modes by `h` s, kicked by the contact forces across and along the surfaces; how far the surfaces move along x, m.
    fn drift(&self, states: &mut [[f64; 2]], forces: ([f64; 2], [f64; 2]), h: f64) -> [f64; 2] {
        self.kick_modes(states, forces, 0.5 * h);
        let mut moved = [0.0; 2];
        for (mode, state) in self.modes.iter().zip(states) {
            let after = mode.oscillator.after(h, *state);
            (0..2).for_each(|i| moved[i] += mode.along[i] * (after[0] - state[0]));
            *state = after;
        }
        moved
    }

    /// Speed at which the modes move each contact across the surfaces, m/s.
    fn across(&self, states: &[[f64; 2]]) -> [f64; 2] {
        let of =
            |i: usize| self.modes.iter().zip(states).map(|(mode, [_, v])| mode.approach[i] * v).sum::<f64>();
        [0, 1].map(|i| of(i).abs())
    }

    fn kick_modes(&self, states: &mut [[f64; 2]], (across, along): ([f64; 2], [f64; 2]), h: f64) {
        for (mode, [_, v]) in self.modes.iter().zip(states) {
            for i in 0..2 {
                *v += h * (mode.along[i] * along[i] - mode.approach[i] * across[i]);
            }
        }
    }

    fn kick(&self, velocity: &mut [f64; 2], forces: [f64; 2], h: f64) {
        for (rate, row) in velocity.iter_mut().zip(&self.mobility) {
            *rate -= h * (row[0] * forces[0] + row[1] * forces[1]);
        }
    }
}
