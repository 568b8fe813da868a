//! The result of a run in a few numbers, the same type for reduced models and the reference.

use super::{
    ContactPressure, Drive, FlightSummary, Impact, Limit, Losses, Quantity, Table, VibrationSummary,
};
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
    /// Another program, run or imported.
    External,
}

/// What is said about a bender besides the quantities; its eq. (1) efficiency relates to its kinetic energy.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BenderSummary {
    /// Kinetic energy of the inner body over the strain energy of the bender before its release; `None` if the run was cut
    /// during a contact.
    pub strain_energy_efficiency: Option<f64>,
    /// How the bender was driven.
    #[serde(flatten)]
    pub drive: Drive,
}

/// What is said about a stack besides the quantities: it has no kinetic energy that eq. (1) could relate to, and goes on giving.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StackSummary {
    /// Electrical energy taken from buffer or source from the switching on to the end of the run, J.
    pub electrical_energy: f64,
    /// Mechanical energy given to plate and inner body, J.
    pub mechanical_energy: f64,
    /// Kinetic energy of the inner body at the end over the electrical energy; `None` if the run was cut during a contact.
    pub share: Option<f64>,
}

/// How bodies move along the plate and turn after an off-centre impact or at an angle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sideways {
    /// Velocity of the outer body along x in m/s.
    pub outer_tangential_velocity_final: f64,
    /// Velocity of the inner body along x in m/s; `None` without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inner_tangential_velocity_final: Option<f64>,
    /// Spin of the outer body about y in rad/s; positive as of a ball that rolls towards +x on a plate below it.
    pub outer_spin_final: f64,
    /// Spin of the inner body about y in rad/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inner_spin_final: Option<f64>,
}

impl Sideways {
    /// Name, value and unit of each.
    pub fn rows(&self) -> impl Iterator<Item = (&'static str, f64, &'static str)> + use<> {
        let all = [
            ("outer_tangential_velocity_final", Some(self.outer_tangential_velocity_final), "m/s"),
            ("inner_tangential_velocity_final", self.inner_tangential_velocity_final, "m/s"),
            ("outer_spin_final", Some(self.outer_spin_final), "rad/s"),
            ("inner_spin_final", self.inner_spin_final, "rad/s"),
        ];
        all.into_iter().filter_map(|(name, value, unit)| Some((name, value?, unit)))
    }
}

/// Largest speed of the outer body in m/s at which a contact stays elastic, all else being as it is; `None` where no yield strength
/// is known, or the contact never comes to it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ElasticLimit {
    /// Between outer body and plate.
    pub outer: Option<f64>,
    /// Between plate and inner body.
    pub inner: Option<f64>,
}

impl ElasticLimit {
    /// Name and speed in m/s of each contact.
    pub fn rows(&self) -> impl Iterator<Item = (&'static str, f64)> + use<> {
        let named = [("outer_elastic_speed", self.outer), ("inner_elastic_speed", self.inner)];
        named.into_iter().filter_map(|(name, speed)| Some((name, speed?)))
    }
}

/// Summary of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Name of the scene.
    pub scene: String,
    /// Hash of the scene's physical content.
    pub scene_hash: String,
    /// Reduced model or reference.
    pub source: Source,
    /// Name of the reduced model or of the other program; `None` for the reference.
    pub model: Option<String>,
    /// Number of elastic modes of the reduced model; `None` for the reference.
    pub modes: Option<usize>,
    /// The physical results; of a stored summary read by [`Summary::read`] alone.
    #[serde(flatten, skip_deserializing)]
    pub quantities: Table,
    /// |energy at the end + losses - energy at the start| over the energy at the start; `None` if another program states none.
    pub energy_residual: Option<f64>,
    /// Momentum that no impulse accounts for, over the momentum at the start; `None` if another program states none.
    pub momentum_residual: Option<f64>,
    /// Time steps taken; `None` if another program states none.
    pub steps: Option<u64>,
    /// Wall time of the time integration, s; of another program that is run, from its start to its end.
    pub solve_seconds: f64,
    /// Why there is no result, in one sentence, if another program failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
    /// Reduced models: estimated error for want of modes, the largest of efficiency, outer velocity and force peaks; the
    /// efficiency's relative to at least 0.05, the velocity's to the impact speed. `None` if there is no estimate.
    #[serde(default)]
    pub truncation_error: Option<f64>,
    /// Reduced models of a body from a mesh: estimated error of efficiency and force peaks by the mesh, relative: half of the change from a mesh
    /// with elements twice as large. `None` of other bodies, or if it is not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh_error: Option<f64>,
    /// Reduced models of a body from a mesh whose scene lists them: the lowest eigenfrequencies in Hz, ascending.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub frequencies: Vec<f64>,
    /// Estimated error of the final velocities, over the impact speed: from the time integration of impacts with many contacts, which amplify
    /// it, and from friction whose effect on the normal motion has not converged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub integration_error: Option<f64>,
    /// Off-centre impacts (references), those at an angle or with spin, unless the run was cut during a contact.
    #[serde(flatten, default, skip_serializing_if = "Option::is_none")]
    pub sideways: Option<Sideways>,
    /// Rough seal seats: spin of the sphere about y after its last contact in rad/s, positive from z to x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sphere_spin: Option<f64>,
    /// Reduced models whose bodies rub: energy that friction dissipates, J.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_work: Option<f64>,
    /// Of a bender only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bender: Option<BenderSummary>,
    /// Of a stack only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stack: Option<StackSummary>,
    /// Plate impacts: Hertz's contact patches at the force peaks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_pressure: Option<ContactPressure>,
    /// The impacts of a series; the quantities above are those of the last one. Of a stored summary read by [`Summary::read`] alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty", skip_deserializing)]
    pub impacts: Vec<Impact>,
    /// Reduced models of a series whose bodies yield: the efficiency if they did not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elastic_efficiency: Option<f64>,
    /// Reduced models of plate impacts with a yield strength.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elastic_limit: Option<ElasticLimit>,
    /// Energy lost to damping, fluid and materials, if there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub losses: Option<Losses>,
    /// Reduced models of scenes with `[flight]`, and references beside them in a comparison; `None` also if the run was cut during a
    /// contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flight: Option<FlightSummary>,
    /// Reduced models of scenes with `[vibration]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vibration: Option<VibrationSummary>,
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
    #[serde(default)]
    pub warnings: Vec<String>,
    /// How near it comes to the bounds of the theories behind it; beyond them there is a warning.
    #[serde(default)]
    pub limits: Vec<Limit>,
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

impl Summary {
    /// Reads the JSON of a summary of the kind of scene that has `quantities`.
    ///
    /// What a run determines that ended in contact is not believed, whatever an older solution says.
    ///
    /// # Errors
    /// One sentence that says what is wrong.
    pub fn read(quantities: &[Quantity], json: &str) -> Result<Self, String> {
        let document: serde_json::Value = serde_json::from_str(json).map_err(|e| e.to_string())?;
        let mut table = Table::read(quantities, &document)?;
        if document["in_contact_at_end"] == true {
            table = table.cut();
        }
        let impacts = Impact::read_all(quantities, &document["impacts"])?;
        let rest: Self = serde_json::from_value(document).map_err(|e| e.to_string())?;
        Ok(Self { quantities: table, impacts, ..rest })
    }

    /// The value of the quantity called `name`; `None` if there is none, or it is not determined.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.quantities.value(name)
    }

    /// Name, value and unit of what says how bodies move along the surfaces they touch, and turn.
    pub fn motion(&self) -> impl Iterator<Item = (&'static str, f64, &'static str)> + use<'_> {
        let spin = self.sphere_spin.map(|spin| ("sphere_spin", spin, "rad/s"));
        self.sideways.iter().flat_map(Sideways::rows).chain(spin)
    }

    /// Half width of the 95 % band of the quantity called `name`, if it is known.
    pub fn band(&self, name: &str) -> Option<f64> {
        self.uncertainty.get(name).copied()
    }

    /// Time in s of the last release of any body, if it is determined.
    pub fn last_contact(&self) -> Option<f64> {
        let ends = self.quantities.iter().filter(|quantity| quantity.name.ends_with("_contact_end"));
        ends.map(|end| end.value).try_fold(0.0_f64, |last, end| Some(last.max(end?)))
    }

    /// Time in s from the launch to the first contact: a bender swings until it strikes.
    pub fn strike_delay(&self) -> f64 {
        self.bender.map_or(0.0, |bender| bender.drive.strike_delay)
    }

    /// Keeps the limits, and warns of those exceeded.
    pub(crate) fn set_limits(&mut self, limits: Vec<Limit>) {
        self.warnings.extend(limits.iter().filter_map(Limit::warning));
        self.limits = limits;
    }

    /// The names of the quantities that the run has not determined.
    pub fn undetermined(&self) -> impl Iterator<Item = &'static str> {
        self.quantities.iter().filter(|quantity| quantity.value.is_none()).map(|quantity| quantity.name)
    }

    /// What a reduced model of `scene` says, without balances, steps and time.
    pub fn of_reduced(scene: &Scene, model: Model, modes: usize, quantities: Table) -> Self {
        Self {
            modes: Some(modes),
            ..Self::new(scene, (Source::Reduced, Some(model.to_string())), quantities)
        }
    }

    /// What `model` of `source` says of `scene`; everything else is still to be told.
    pub fn new(scene: &Scene, (source, model): (Source, Option<String>), quantities: Table) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            scene: scene.name.clone(),
            scene_hash: scene.hash(),
            source,
            model,
            modes: None,
            quantities,
            energy_residual: None,
            momentum_residual: None,
            steps: None,
            solve_seconds: 0.0,
            failure: None,
            sideways: None,
            sphere_spin: None,
            friction_work: None,
            bender: None,
            stack: None,
            contact_pressure: None,
            impacts: Vec::new(),
            elastic_efficiency: None,
            elastic_limit: None,
            losses: None,
            flight: None,
            vibration: None,
            truncation_error: None,
            mesh_error: None,
            frequencies: Vec::new(),
            integration_error: None,
            choice: None,
            uncertainty: BTreeMap::new(),
            convergence: None,
            mesh: None,
            solver: None,
            warnings: Vec::new(),
            limits: Vec::new(),
            samples: None,
            sample_interval: None,
        }
    }
}
