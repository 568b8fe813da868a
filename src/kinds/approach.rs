//! What records of an impact are compared with, besides curves.

/// An outer and an inner body before their impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Speed of the outer body towards the inner one, m/s.
    pub outer_speed: f64,
    /// Velocity of the inner body along z, m/s.
    pub inner_velocity: f64,
    /// Masses of the outer and the inner body, kg.
    pub masses: [f64; 2],
    /// Whether the outer body has no energy but that of its motion, and is not driven.
    pub outer_is_rigid: bool,
    /// Whether the contact alone acts on the inner body: no fluid does.
    pub inner_is_free: bool,
}
