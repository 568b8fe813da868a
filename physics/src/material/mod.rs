//! What bodies are made of: elastic, viscoelastic or plastic.

mod creep;
mod relaxation;

pub use creep::{Creep, Deformation};
pub use relaxation::{Relaxation, fit_loss_factor, modulus_ratio, vibration_frequency};

use serde::Serialize;

/// Isotropic material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Material {
    /// Name under `[materials]` in the scene file.
    pub name: String,
    /// Young's modulus E in Pa; of a viscoelastic material the instantaneous one.
    pub youngs_modulus: f64,
    /// Poisson's ratio nu, -1 < nu < 0.5.
    pub poisson_ratio: f64,
    /// Density rho in kg/m^3.
    pub density: f64,
    /// Yield strength in uniaxial tension in Pa, if it is known. Without hardening it changes no result, only what is warned of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yield_strength: Option<f64>,
    /// Slope of the yield stress over the plastic strain in Pa; with it the material yields.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hardening: Option<f64>,
    /// How the yield stress grows with the rate of plastic strain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate: Option<RateHardening>,
    /// Relaxation of bulk and shear modulus alike; empty for an elastic material.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub relaxation: Vec<Relaxation>,
}

/// Cowper and Symonds' law: the yield stress grows by the factor 1 + (rate of plastic strain / D)^(1/q).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RateHardening {
    /// D in 1/s, at which the yield stress is twice the static one.
    #[serde(rename = "D")]
    pub reference_rate: f64,
    /// Exponent q.
    #[serde(rename = "q")]
    pub exponent: f64,
}

/// A material that yields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plasticity {
    /// Yield strength Y in Pa.
    pub yield_strength: f64,
    /// Slope H of the yield stress over the plastic strain in Pa.
    pub hardening: f64,
    /// Its growth with the rate.
    pub rate: Option<RateHardening>,
}

impl Material {
    /// A linearly elastic material; modulus in Pa, density in kg/m^3.
    pub fn elastic(name: &str, youngs_modulus: f64, poisson_ratio: f64, density: f64) -> Self {
        Self {
            name: name.to_owned(),
            youngs_modulus,
            poisson_ratio,
            density,
            yield_strength: None,
            hardening: None,
            rate: None,
            relaxation: Vec::new(),
        }
    }

    /// That of a rigid wall: so stiff that what it yields is lost in rounding.
    pub fn rigid() -> Self {
        Self::elastic("rigid", 1e30, 0.0, 1.0)
    }

    /// Plane-strain modulus E / (1 - nu^2) in Pa.
    pub fn plane_strain_modulus(&self) -> f64 {
        self.youngs_modulus / (1.0 - self.poisson_ratio.powi(2))
    }

    /// Shear modulus E / (2 (1 + nu)) in Pa.
    pub fn shear_modulus(&self) -> f64 {
        0.5 * self.youngs_modulus / (1.0 + self.poisson_ratio)
    }

    /// Speed of longitudinal waves in a thin bar, sqrt(E / rho), in m/s.
    pub fn bar_wave_speed(&self) -> f64 {
        (self.youngs_modulus / self.density).sqrt()
    }

    /// Whether it neither yields nor relaxes.
    pub fn is_elastic(&self) -> bool {
        self.plasticity().is_none() && self.relaxation.is_empty()
    }

    /// How it yields, if it does.
    pub fn plasticity(&self) -> Option<Plasticity> {
        let (yield_strength, hardening) = (self.yield_strength?, self.hardening?);
        Some(Plasticity { yield_strength, hardening, rate: self.rate })
    }
}
