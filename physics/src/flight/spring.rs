//! The spring that presses the sphere into its seats.

use super::Vector;

/// A compressed spring: it pushes the sphere, and lies loose once it has no force left.
///
/// Without anchor it pushes along a fixed direction. With one it pushes away from it: then the sphere between two walls has two
/// stable positions, as over the rocker (Fig. 4).
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// Force in N on a sphere that rests in a seat.
    pub force: f64,
    /// By how much less it pushes per length that the sphere gives way, N/m.
    pub stiffness: f64,
    /// Direction of the push, of length 1; not used with an anchor.
    pub direction: Vector,
    /// The end that is held, if it is not far away.
    pub anchor: Option<Vector>,
    /// Coulomb's coefficient between spring and sphere: its last turn, which lies around the sphere, resists every turn with the
    /// moment friction x force x radius of the sphere; 0 = it pushes through a point (Fig. 23).
    pub friction: f64,
    /// Centre of a sphere in a seat, where the force is [`Self::force`].
    pub seat: Vector,
}

impl Spring {
    /// How far in m the spring is longer than at the seat, and the direction in which it pushes, with the sphere at `place`.
    fn lengthening(&self, place: Vector) -> (f64, Vector) {
        match self.anchor {
            None => ((place - self.seat).dot(&self.direction), self.direction),
            Some(anchor) => {
                let (arm, length) = (place - anchor, (place - anchor).norm());
                (length - (self.seat - anchor).norm(), arm / length)
            }
        }
    }

    /// Force in N on the sphere at `place`.
    pub fn push(&self, place: Vector) -> Vector {
        let (longer, direction) = self.lengthening(place);
        (self.force - self.stiffness * longer).max(0.0) * direction
    }

    /// Potential in J, 0 at the seat.
    pub fn potential(&self, place: Vector) -> f64 {
        let longer = self.lengthening(place).0;
        let loose = if self.stiffness > 0.0 { self.force / self.stiffness } else { f64::INFINITY };
        let longer = longer.min(loose);
        -longer * (self.force - 0.5 * self.stiffness * longer)
    }

    /// Angular frequency in rad/s below which all motion of a sphere of `mass` kg on it stays, for the length of steps.
    pub(super) fn frequency(&self, mass: f64) -> f64 {
        let turning = self.anchor.map_or(0.0, |anchor| self.force / (self.seat - anchor).norm());
        ((self.stiffness + turning) / mass).sqrt()
    }
}
