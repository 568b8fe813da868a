//! The result of a run in a few numbers, the same type for reduced models and the reference.

use super::ContactPressure;
use super::Drive;
use super::Losses;
use super::history::{Curves, History};
use crate::scene::{Model, Scene};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of every JSON document the program writes.
pub const SCHEMA_VERSION: u32 = 1;

/// Which side of the comparison a result comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// Reduced model.
    Reduced,
    /// Finite-element reference.
    Reference,
}

/// The physical results of one kind of scene, by name.
///
/// What a summary, a store or a comparison does alike for every kind goes by this.
pub trait Quantities: Clone + std::fmt::Debug + PartialEq + Serialize + serde::de::DeserializeOwned {
    /// The course over time that goes with it.
    type History: Curves;
    /// The quantities that are compared, with their units.
    const NAMES: &'static [(&'static str, &'static str)];

    /// The value of the quantity called `name` in [`Quantities::NAMES`].
    fn value(&self, name: &str) -> Option<f64>;

    /// Time of the last release of any body, s.
    fn last_contact(&self) -> f64;
}

/// Results of an impact through a plate (scene kind `plate-impact`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlateQuantities {
    /// Eq. (1): kinetic energy of the inner body after the last contact over that of the outer before the first.
    pub efficiency: f64,
    /// Velocity of the outer body after the last contact, m/s, signed along z.
    pub outer_velocity_final: f64,
    /// Velocity of the inner body after the last contact, m/s, signed along z.
    pub inner_velocity_final: f64,
    /// Largest force between outer body and plate, N.
    pub outer_force_peak: f64,
    /// Largest force between plate and inner body, N.
    pub inner_force_peak: f64,
    /// Time of the last release of the outer body, s.
    pub outer_contact_end: f64,
    /// Time of the last release of the inner body, s.
    pub inner_contact_end: f64,
    /// Number of separate contacts of the outer body.
    pub outer_contacts: u32,
    /// Number of separate contacts of the inner body.
    pub inner_contacts: u32,
    /// First eigenfrequency of the plate that is not a rigid motion, Hz.
    pub first_frequency: f64,
}

/// The quantities of [`PlateQuantities`] that are compared, with their units.
pub const PLATE_QUANTITIES: [(&str, &str); 10] = [
    ("efficiency", "1"),
    ("outer_velocity_final", "m/s"),
    ("inner_velocity_final", "m/s"),
    ("outer_force_peak", "N"),
    ("inner_force_peak", "N"),
    ("outer_contact_end", "s"),
    ("inner_contact_end", "s"),
    ("outer_contacts", "1"),
    ("inner_contacts", "1"),
    ("first_frequency", "Hz"),
];

impl PlateQuantities {
    /// The value of the quantity called `name` in [`PLATE_QUANTITIES`].
    pub fn get(&self, name: &str) -> Option<f64> {
        Some(match name {
            "efficiency" => self.efficiency,
            "outer_velocity_final" => self.outer_velocity_final,
            "inner_velocity_final" => self.inner_velocity_final,
            "outer_force_peak" => self.outer_force_peak,
            "inner_force_peak" => self.inner_force_peak,
            "outer_contact_end" => self.outer_contact_end,
            "inner_contact_end" => self.inner_contact_end,
            "outer_contacts" => f64::from(self.outer_contacts),
            "inner_contacts" => f64::from(self.inner_contacts),
            "first_frequency" => self.first_frequency,
            _ => return None,
        })
    }
}

impl Quantities for PlateQuantities {
    type History = History;
    const NAMES: &'static [(&'static str, &'static str)] = &PLATE_QUANTITIES;

    fn last_contact(&self) -> f64 {
        self.outer_contact_end.max(self.inner_contact_end)
    }

    fn value(&self, name: &str) -> Option<f64> {
        self.get(name)
    }
}

/// What is said about a bender besides the quantities; its eq. (1) efficiency relates to its kinetic energy.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BenderSummary {
    /// Kinetic energy of the inner body over the strain energy of the bender before its release.
    pub strain_energy_efficiency: f64,
    /// How the bender was driven.
    #[serde(flatten)]
    pub drive: Drive,
}

/// Summary of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Summary<Q: Quantities = PlateQuantities> {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Name of the scene.
    pub scene: String,
    /// Hash of the scene's physical content.
    pub scene_hash: String,
    /// Reduced model or reference.
    pub source: Source,
    /// Name of the reduced model; `None` for the reference.
    pub model: Option<String>,
    /// Number of elastic modes of the reduced model; `None` for the reference.
    pub modes: Option<usize>,
    /// The physical results.
    #[serde(flatten)]
    pub quantities: Q,
    /// |energy at the end + losses - energy at the start| over the energy at the start.
    pub energy_residual: f64,
    /// Momentum that no impulse accounts for, over the momentum at the start.
    pub momentum_residual: f64,
    /// Time steps taken.
    pub steps: u64,
    /// Wall time of the time integration, s.
    pub solve_seconds: f64,
    /// Estimated error of the final velocities from the time integration, over the impact speed; of impacts with many
    /// contacts only, which amplify it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub integration_error: Option<f64>,
    /// Reduced models: estimated error for want of modes, the largest of efficiency, outer velocity and force peaks; the
    /// efficiency's relative to at least 0.05, the velocity's to the impact speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truncation_error: Option<f64>,
    /// Of a bender only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bender: Option<BenderSummary>,
    /// Reduced models of plate impacts: contact patches at the force peaks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_pressure: Option<ContactPressure>,
    /// Energy lost to damping and fluid, if there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub losses: Option<Losses>,
    /// Reference only: half width of the 95 % band of each quantity, absolute, in its unit.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub uncertainty: BTreeMap<String, f64>,
    /// Reference only: values on all meshes, observed orders, extrapolated values and bands, kept as written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub convergence: Option<serde_json::Value>,
    /// Reference only: the mesh (nodes, dofs, elements per contact radius, ...), kept as written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<serde_json::Value>,
    /// Reference only: solver settings and versions, kept as written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solver: Option<serde_json::Value>,
    /// What a user has to know before relying on the result, a sentence each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// Why it is this model and this number of modes, if that was left to the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub choice: Option<crate::result::Choice>,
    /// Number of samples in the history, if one was kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<usize>,
    /// Distance of the samples in s, if it is the same between all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample_interval: Option<f64>,
}

impl<Q: Quantities> Summary<Q> {
    /// What a reduced model of `scene` says; balances, steps and time are still to be told.
    pub(crate) fn of_reduced(scene: &Scene, model: Model, modes: usize, quantities: Q) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            scene: scene.name.clone(),
            scene_hash: scene.hash(),
            source: Source::Reduced,
            model: Some(model.to_string()),
            modes: Some(modes),
            quantities,
            energy_residual: f64::NAN,
            momentum_residual: f64::NAN,
            steps: 0,
            solve_seconds: 0.0,
            bender: None,
            contact_pressure: None,
            losses: None,
            integration_error: None,
            truncation_error: None,
            choice: None,
            uncertainty: BTreeMap::new(),
            convergence: None,
            mesh: None,
            solver: None,
            warnings: Vec::new(),
            samples: None,
            sample_interval: None,
        }
    }
}
