//! Hertz's law for a spherical tip on a flat face.

use super::Press;
use super::radial_slip::{dundurs_beta, stiffening};
use crate::scene::Material;

/// F = k delta^(3/2) while the approach delta is positive, else 0.
///
/// ```
/// use impactcheck_physics::contact::Hertz;
///
/// let contact = Hertz { stiffness: 1.5e10, tip_radius: 0.01 };
/// let force = contact.force(8e-6);
/// assert!((contact.approach(force) - 8e-6).abs() < 1e-18);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    /// k = 4/3 E* sqrt(r) in N/m^(3/2).
    pub stiffness: f64,
    /// Radius r of the tip in m.
    pub tip_radius: f64,
}

impl Hertz {
    /// Contact of a tip of `tip_radius` m on a flat face; 1/E* is the sum of (1 - nu^2)/E.
    pub fn new(tip_radius: f64, tip: &Material, face: &Material) -> Self {
        let compliance = 1.0 / tip.plane_strain_modulus() + 1.0 / face.plane_strain_modulus();
        Self { stiffness: 4.0 / 3.0 * tip_radius.sqrt() / compliance, tip_radius }
    }

    /// The same with the coefficient of `friction`, by which a contact of the unlike materials `tip` and `face` is stiffer.
    #[must_use]
    pub fn with_friction(self, tip: &Material, face: &Material, friction: f64) -> Self {
        let stiffening = stiffening(dundurs_beta(tip, face), friction);
        Self { stiffness: self.stiffness * stiffening, ..self }
    }

    /// Force in N at the approach `delta` in m.
    #[inline(always)]
    pub fn force(&self, delta: f64) -> f64 {
        let d = delta.max(0.0);
        self.stiffness * d * d.sqrt()
    }

    /// Approach in m under `force` N, not negative: (F/k)^(2/3).
    #[inline]
    pub fn approach(&self, force: f64) -> f64 {
        (force / self.stiffness).powi(2).cbrt()
    }

    /// Tangent stiffness dF/d(delta) in N/m.
    #[inline(always)]
    pub fn tangent(&self, delta: f64) -> f64 {
        1.5 * self.stiffness * delta.max(0.0).sqrt()
    }

    /// Strain energy in J: 2/5 k delta^(5/2).
    pub fn energy(&self, delta: f64) -> f64 {
        0.4 * self.force(delta) * delta.max(0.0)
    }

    /// Radius of the contact patch in m under `force` N: sqrt(r delta).
    pub fn contact_radius(&self, force: f64) -> f64 {
        (self.tip_radius * self.approach(force.max(0.0))).sqrt()
    }

    /// The contact under `force` N.
    pub fn press(&self, force: f64) -> Press {
        Press { force, radius: self.contact_radius(force), evenness: 0.0, curvature: self.tip_radius.recip() }
    }

    /// Pressure at the patch's centre in Pa under `force` N: 3 F / (2 pi a^2); 0 without force.
    pub fn maximum_pressure(&self, force: f64) -> f64 {
        let area = std::f64::consts::PI * self.contact_radius(force).powi(2);
        if area > 0.0 { 1.5 * force / area } else { 0.0 }
    }
}
