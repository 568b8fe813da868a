//! What records of an impact are compared with, besides curves.

/// An outer and an inner body before their impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Speed of the outer body towards what it strikes, along z, m/s.
    pub outer_speed: f64,
    /// Velocity of the inner body along z, m/s; 0 without one.
    pub inner_velocity: f64,
    /// Mass of the outer body, kg.
    pub outer_mass: f64,
    /// Mass of the inner body, kg; `None` without one.
    pub inner_mass: Option<f64>,
    /// Whether the inner body has a contact of its own: something lies between it and the outer one.
    pub has_inner_contact: bool,
    /// Whether what the outer body strikes is held: without an inner body its rebound shows the restitution.
    pub is_held: bool,
    /// Whether the outer body has no energy but that of its motion, and is not driven.
    pub outer_is_rigid: bool,
    /// Whether the contact alone acts on the inner body: no fluid does.
    pub inner_is_free: bool,
}

impl Approach {
    /// The quantity that records show as one number: the efficiency, or without an inner body the restitution.
    pub fn key(&self) -> &'static str {
        if self.inner_mass.is_some() { "efficiency" } else { "outer_restitution" }
    }
}
