//! Hertz's pressure under the force peaks: what a user wants to know before a material is chosen.

use crate::contact::Hertz;
use serde::{Deserialize, Serialize};

/// Contact patch under the largest force of a contact, of elastic half-spaces (Johnson, Contact Mechanics, 1985, eqs. 3.34
/// and 3.39): the face's own bending and yielding are not in it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactPatch {
    /// Radius, m.
    pub contact_radius: f64,
    /// Pressure at the centre, Pa.
    pub maximum_pressure: f64,
}

/// The patches of both contacts at the peak of their force.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactPressure {
    /// Between outer body and plate.
    pub outer: ContactPatch,
    /// Between plate and inner body.
    pub inner: ContactPatch,
}

impl ContactPressure {
    /// Under the force peaks (outer, inner) in N.
    pub fn new(laws: &[Hertz; 2], peaks: [f64; 2]) -> Self {
        let patch = |i: usize| ContactPatch {
            contact_radius: laws[i].contact_radius(peaks[i]),
            maximum_pressure: laws[i].maximum_pressure(peaks[i]),
        };
        ContactPressure { outer: patch(0), inner: patch(1) }
    }

    /// Name, value and unit of each number.
    pub fn rows(&self) -> [(&'static str, f64, &'static str); 4] {
        [
            ("outer_contact_radius", self.outer.contact_radius, "m"),
            ("outer_contact_pressure", self.outer.maximum_pressure, "Pa"),
            ("inner_contact_radius", self.inner.contact_radius, "m"),
            ("inner_contact_pressure", self.inner.maximum_pressure, "Pa"),
        ]
    }
}
