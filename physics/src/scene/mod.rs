//! The scene: everything that defines one impact, in SI units, read and checked once.
//!
//! A [`Scene`] is immutable after [`Scene::read`]; whatever follows (bodies, impact,
//! reference, comparison) takes it by reference. Its JSON form (SI numbers only) is what
//! the finite-element side receives, and its physical part is what [`Scene::hash`] identifies.

mod advice;
mod alternatives;
mod check;
mod check_numbers;
pub(crate) mod collision;
mod external;
mod fault;
mod field;
pub(crate) mod flight;
pub(crate) mod grammar;
pub mod hash;
mod language;
pub(crate) mod material;
pub(crate) mod parts;
mod place;
pub(crate) mod plausibility;
pub(crate) mod quantity;
pub(crate) mod read;
mod schema;
mod setup;
mod template;
pub(crate) mod tolerances;
mod uncertainty;
pub(crate) mod values;

pub use external::{External, ExternalProgram, StartValue, UnitInterface};
pub use fault::{Fault, Faults, faults};
pub use fault::{suggestion, unknown_name};
pub use field::{Field, Rejected};
pub use flight::{Flight, FlightSpring, Flyer, Vibration};
pub(crate) use language::{Alias, Dialect, FileFault, Grammar, Language};
pub use parts::{
    Bender, Edge, Fluid, Inner, Outer, Plate, Series, Shape, ShearThinning, Spot, Stack, Supply, Turning,
};
pub use plausibility::doubts;
pub use quantity::{Dimension, dimension_of, in_unit as quantity_in};
pub use read::MAX_FILE_BYTES;
pub(crate) use setup::Bodies;
pub use setup::Setup;
pub use template::Template;
pub use tolerances::LANDING_SHARE;
pub use uncertainty::{Correlation, Distribution, Spread, UncertainInput, Uncertainty};

pub use crate::material::{Material, RateHardening, Relaxation};

use crate::Error;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Modes of a reduced model when neither the scene nor the caller names a number (the paper's 16).
pub const DEFAULT_MODES: usize = 16;

/// Length of the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunSettings {
    /// End time in s after the first touch; `None` = until no further contact is possible.
    pub end_time: Option<f64>,
}

/// A reduced model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub enum Model {
    /// One Kirchhoff mode.
    A,
    /// Kirchhoff modes, 16 by default.
    B,
    /// Continuum modes with residual flexibility of the contact points.
    C,
}

impl std::fmt::Display for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{self:?}")
    }
}

impl std::str::FromStr for Model {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "A" | "a" => Ok(Model::A),
            "B" | "b" => Ok(Model::B),
            "C" | "c" => Ok(Model::C),
            _ => Err(format!("`{text}` is not a reduced model; there are A, B and C")),
        }
    }
}

/// Settings of the reduced model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReducedSettings {
    /// The model to run when the command line names none; `None` = the program's choice.
    pub model: Option<Model>,
    /// Number of modes; `None` = the program's choice (model A has one).
    pub modes: Option<usize>,
    /// How many eigenfrequencies of a body from a mesh are listed; `None` = none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequencies: Option<usize>,
}

/// Geometry of the reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Geometry {
    /// Axisymmetric solid elements.
    Axisymmetric,
    /// Three-dimensional solid elements.
    Solid,
}

/// Settings of the finite-element reference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReferenceSettings {
    /// Geometry of the elements.
    pub geometry: Geometry,
    /// Elements across the contact radius at `paper` resolution; `None` for a seal seat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elements_per_contact_radius: Option<f64>,
    /// Elements through a plate's thickness at `paper` resolution, solid geometry only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elements_per_thickness: Option<f64>,
    /// Elements across the radius of the contact ring at `paper` resolution, seal seat only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elements_per_ring_radius: Option<f64>,
    /// Order of the elements, solid geometry only; `None` = quadratic.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub element_order: Option<u64>,
    /// Spheres that are rigid, solid geometry only; `None` = none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rigid: Option<Rigid>,
}

impl ReferenceSettings {
    /// Of elements of this geometry, with nothing else said.
    pub(crate) fn of(geometry: Geometry) -> Self {
        Self {
            geometry,
            elements_per_contact_radius: None,
            elements_per_thickness: None,
            elements_per_ring_radius: None,
            element_order: None,
            rigid: None,
        }
    }
}

/// Spheres that the solid reference takes as rigid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rigid {
    /// The outer one.
    Outer,
    /// The inner one.
    Inner,
    /// Both.
    Both,
}

/// Bound on how far a reduced model's quantity may lie from the reference's.
///
/// The checked value is `difference - bias`; it passes when its magnitude is within any of
/// the bounds that are given. `bias` is the known, measured discrepancy of the model, in the same
/// terms as the bound: with it the gate watches for drift around a model error that is understood.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Tolerance {
    /// Bound relative to the reference's value.
    pub relative: Option<f64>,
    /// Bound in the quantity's SI unit.
    pub absolute: Option<f64>,
    /// Bound relative to the peak of the quantity's curve in the reference.
    pub relative_to_peak: Option<f64>,
    /// Known discrepancy, in the terms of the bound it stands with (relative if `relative` is given, ...).
    pub bias: Option<f64>,
}

/// Tolerances of one model, by quantity.
pub type Tolerances = BTreeMap<String, Tolerance>;

/// One impact, checked, in SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scene {
    /// Name; identifies the scene in the store and in reports.
    pub name: String,
    /// One line for people.
    pub description: String,
    /// Bodies and their motion.
    #[serde(flatten)]
    pub setup: Setup,
    /// Length of the run.
    pub run: RunSettings,
    /// Settings of the reduced model.
    pub reduced: ReducedSettings,
    /// Settings of the reference.
    pub reference: ReferenceSettings,
    /// Tolerances of the gate, by reduced model or program of the user's.
    pub tolerances: BTreeMap<String, Tolerances>,
    /// How uncertain its numbers are; no solver is told of it.
    #[serde(skip)]
    pub uncertainty: Option<Uncertainty>,
    /// Where the sphere flies after the impact; no solver of the impact is told of it.
    #[serde(skip)]
    pub flight: Option<Flight>,
    /// How the valve is shaken; no solver of the impact is told of it.
    #[serde(skip)]
    pub vibration: Option<Vibration>,
    /// Programs of the user's that solve the scene too.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub external: Vec<External>,
}

impl Scene {
    /// The bodies as those of the kind `needed`, for what knows nothing else.
    ///
    /// # Errors
    /// [`Error::Scene`] if the scene is of another kind.
    pub(crate) fn of_kind<T: Bodies>(&self, needed: &str) -> crate::Result<&T> {
        self.setup.get().ok_or_else(|| {
            let help = format!("name a scene of kind = \"{needed}\"");
            Error::Scene(miette::miette!(
                help = help,
                "scene `{}` is of kind `{}`, but this runs scenes of kind `{needed}` only",
                self.name,
                self.setup.kind()
            ))
        })
    }
}
