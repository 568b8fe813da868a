//! The flight of the sphere after the impact: from the launch to the seat it comes to rest in (sections 2.1, 2.3.2, 5.1 and 5.2
//! of the paper).
//!
//! A rigid sphere with spin moves in the plane of symmetry of its [`Chamber`] under gravity, a spring and a fluid's drag
//! ([`Field`]). Touches are located to rounding; each changes the velocities at once (Newton's restitution, Coulomb's impulse),
//! and bounces too low to matter become rolling and sliding. All of it only loses energy: as soon as that is less than the saddle
//! of the [`Landscape`] around the sphere, the seat is certain.

mod chamber;
mod contact;
mod field;
mod free;
mod friction;
mod impact;
mod judged;
mod landscape;
mod run;
mod spring;
mod step;
#[cfg(test)]
mod tests;
mod track;
mod vibration;

pub use chamber::{Chamber, TooNarrow};
pub use field::{Excitation, Field, SphereDrag, Wave};
pub use judged::{Judged, Landing, LaunchDeviation, judge, map_of_landings};
pub use landscape::{Landscape, Saddle};
pub use run::{Ending, Flight, FlightContact, fly};
pub use spring::Spring;
pub use vibration::{Thresholds, thresholds, thresholds_within};

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

/// A vector (x, z) of the plane of symmetry.
pub type Vector = Vector2<f64>;

/// Sphere, chamber and forces: all but the launch.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Mass of the sphere in kg.
    pub mass: f64,
    /// Its radius in m.
    pub radius: f64,
    /// Where it can be.
    pub chamber: Chamber,
    /// What acts on it in flight.
    pub field: Field,
    /// Newton's coefficient of restitution of all walls, 0 to 1.
    pub restitution: f64,
    /// Coulomb's coefficient of friction of all walls.
    pub friction: f64,
    /// Time in s after which a flight without verdict is given up.
    pub end_time: f64,
}

impl Setup {
    /// Moment of inertia of the sphere in kg m^2: that of a full one of its mass.
    pub fn inertia(&self) -> f64 {
        0.4 * self.mass * self.radius.powi(2)
    }

    /// Kinetic and potential energy in J; the potential is that of [`Field::potential`].
    pub fn energy(&self, state: &State) -> f64 {
        let kinetic = self.mass * state.velocity.norm_squared() + self.inertia() * state.spin.powi(2);
        0.5 * kinetic + self.field.potential(self.mass, state.place)
    }
}

/// How the sphere leaves its seat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Launch {
    /// Speed in m/s.
    pub speed: f64,
    /// Direction against z in rad, positive towards +x.
    pub angle: f64,
    /// Spin in rad/s, positive counterclockwise as seen with x to the right and z up.
    pub spin: f64,
}

/// Where the sphere is and how it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Time in s since the launch.
    pub time: f64,
    /// Its centre in m.
    pub place: Vector,
    /// Velocity in m/s.
    pub velocity: Vector,
    /// Spin in rad/s, as in [`Launch`].
    pub spin: f64,
}

/// Where the sphere comes to rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Seat {
    /// In the other seat: the valve has shifted.
    Other,
    /// In the seat it came from.
    Same,
    /// In neither.
    None,
}

impl Seat {
    /// As documents call it.
    pub fn name(self) -> &'static str {
        match self {
            Seat::Other => "other",
            Seat::Same => "same",
            Seat::None => "none",
        }
    }
}

impl std::fmt::Display for Seat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
