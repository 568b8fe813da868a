//! Flow resistance of the inner body (section 3.5.1 of the paper).
//!
//! Eq. (2) as printed, F = c_W rho U^2 R, is a force per length. What is used is the law it stands for, with the
//! resistance coefficient of the textbooks, which refers to the area pi R^2: F = c_W rho/2 U^2 pi R^2.

use crate::scene::{Fluid, Inner};
use std::f64::consts::PI;

/// Resistance F = k U |U| against the velocity U.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drag {
    /// k in N s^2/m^2.
    pub coefficient: f64,
}

impl Drag {
    /// Resistance of the inner body in the fluid; `None` without a drag coefficient.
    pub fn new(fluid: &Fluid, inner: &Inner) -> Option<Self> {
        let area = PI * inner.shape.tip_radius().powi(2);
        let coefficient = 0.5 * fluid.drag_coefficient * fluid.density * area;
        (coefficient > 0.0).then_some(Self { coefficient })
    }

    /// Change of the resistance per velocity in N s/m at `velocity` m/s.
    pub fn damping(&self, velocity: f64) -> f64 {
        2.0 * self.coefficient * velocity.abs()
    }

    /// Force in N along z on the body that moves with `velocity` m/s.
    pub fn force(&self, velocity: f64) -> f64 {
        -self.coefficient * velocity * velocity.abs()
    }
}
