//! Motion along the surfaces and spin of bodies that touch with friction.
//!
//! The normal motion is solved before: on a flat, symmetric surface forces along it do not move it across. Rigid motions and the contacts'
//! tangential flexibility take part.

use crate::contact::TangentialContact;
use crate::error::{Error, Result};
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

/// Contacts whose surfaces move along each other.
#[derive(Debug)]
pub struct Sliding {
    /// Outer and inner contact; `None`: it does not exist.
    pub contacts: [Option<TangentialContact>; 2],
    /// Relative acceleration of the surfaces per force, 1/kg. Shape (contacts, contacts).
    pub mobility: [[f64; 2]; 2],
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
}

impl Sliding {
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
        for k in 1..history.len() {
            let (from, to) = ([outer[k - 1], inner[k - 1]], [outer[k], inner[k]]);
            let length = history.time[k] - history.time[k - 1];
            // contacts that are open forget where they were
            let count = (length * self.frequency(from, to) / LONGEST).ceil().max(1.0);
            let h = length / count;
            for step in 1..=count as usize {
                let share = step as f64 / count;
                let before = self.forces();
                self.kick(&mut velocity, before, 0.5 * h);
                for (i, contact) in self.contacts.iter_mut().enumerate() {
                    let normal = (from[i] + share * (to[i] - from[i])).max(0.0);
                    contact.iter_mut().for_each(|contact| contact.advance(normal, velocity[i] * h));
                }
                let after = self.forces();
                self.kick(&mut velocity, after, 0.5 * h);
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
            Some((stiffness * self.mobility[i][i]).sqrt())
        };
        (0..2).filter_map(of).fold(0.0, f64::max)
    }

    fn kick(&self, velocity: &mut [f64; 2], forces: [f64; 2], h: f64) {
        for (rate, row) in velocity.iter_mut().zip(&self.mobility) {
            *rate -= h * (row[0] * forces[0] + row[1] * forces[1]);
        }
    }
}
