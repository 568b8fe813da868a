//! The scene: everything that defines one impact, in SI units, read and checked once.
//!
//! A [`Scene`] is immutable after [`Scene::read`]; whatever follows (bodies, impact,
//! reference, comparison) takes it by reference. Its JSON form (SI numbers only) is what
//! the finite-element side receives, and its physical part is what [`Scene::hash`] identifies.

mod advice;
mod alternatives;
mod check;
mod collision;
pub mod hash;
mod plausibility;
mod problem;
mod quantity;
mod read;
mod read_seat;
mod schema;
mod seal_seat;
mod seat_specification;
mod specification;
mod template;
mod tolerances;

pub use plausibility::doubts;
pub use problem::suggestion;
pub use problem::{Problem, Problems, problems};
pub use quantity::in_unit as quantity_in;
pub use read::MAX_FILE_BYTES;
pub use schema::schema;
pub use seal_seat::{Actuator, ContactRing, Notch, SealSeat, Seat, SeatedSphere, SphereBody};
pub use specification::{MAX_MODES, unit_of};
pub use template::{Field, Rejected, Template};

use crate::Error;
use serde::Serialize;
use std::collections::BTreeMap;

/// Elastic, isotropic material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Material {
    /// Name under `[materials]` in the scene file.
    pub name: String,
    /// Young's modulus E in Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio nu, -1 < nu < 0.5.
    pub poisson_ratio: f64,
    /// Density rho in kg/m^3.
    pub density: f64,
    /// Yield strength in uniaxial tension in Pa, if it is known. It changes no elastic result, only what is warned of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yield_strength: Option<f64>,
}

impl Material {
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
}

/// Support of the plate's rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Edge {
    /// Deflection and slope are zero.
    Clamped,
    /// Deflection is zero, the rim may rotate.
    SimplySupported,
    /// The rim is free; the plate keeps its rigid motion.
    Free,
}

/// Circular plate of constant thickness.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plate {
    /// Radius R in m.
    pub radius: f64,
    /// Thickness t in m.
    pub thickness: f64,
    /// Support of the rim.
    pub edge: Edge,
    /// Material of the plate.
    pub material: Material,
    /// Modal damping ratio (Lehr), the same for every mode; 0 = undamped.
    pub damping_ratio: f64,
}

impl Plate {
    /// Mass in kg.
    pub fn mass(&self) -> f64 {
        std::f64::consts::PI * self.radius.powi(2) * self.thickness * self.material.density
    }
}

/// Piezo bender (section 4.3): a beam clamped at one end, with a point mass and a spherical tip at the other.
///
/// It is bent away from the plate by a bending moment that is uniform along the beam, as a piezo layer gives it,
/// and released from rest: the moment is gone at once or, as a piezo is discharged through a resistor (section 2.2.2),
/// decays. It strikes where its tip passes the straight position.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bender {
    /// Length L of the beam in m.
    pub length: f64,
    /// Bending stiffness E I in N m^2.
    pub bending_stiffness: f64,
    /// Mass per length rho A in kg/m.
    pub line_mass: f64,
    /// Point mass at the tip in kg.
    pub tip_mass: f64,
    /// Radius of curvature at the contact in m.
    pub tip_radius: f64,
    /// Time constant in s with which the moment decays after the release; 0 = it is gone at once.
    pub discharge_time: f64,
}

impl Bender {
    /// Mass of beam and tip in kg.
    pub fn mass(&self) -> f64 {
        self.line_mass * self.length + self.tip_mass
    }
}

/// Shape of a striking or struck body.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Shape {
    /// Homogeneous sphere.
    Sphere {
        /// Radius in m.
        radius: f64,
    },
    /// Compact body whose mass and tip radius are independent (section 4.2.3).
    Compact {
        /// Mass in kg.
        mass: f64,
        /// Radius of the spherical tip in m.
        tip_radius: f64,
    },
    /// Beam with a tip mass, an elastic body; outer body only.
    Bender(Bender),
}

impl Shape {
    /// Mass in kg of the body made of `material` (of a bender: beam and tip).
    pub fn mass(&self, material: &Material) -> f64 {
        match *self {
            Shape::Sphere { radius } => 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * material.density,
            Shape::Compact { mass, .. } => mass,
            Shape::Bender(bender) => bender.mass(),
        }
    }

    /// Radius of curvature at the contact in m.
    pub fn tip_radius(&self) -> f64 {
        match *self {
            Shape::Sphere { radius } => radius,
            Shape::Compact { tip_radius, .. } => tip_radius,
            Shape::Bender(bender) => bender.tip_radius,
        }
    }
}

/// The outer body: strikes the plate from above.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outer {
    /// Shape.
    #[serde(flatten)]
    pub shape: Shape,
    /// Material.
    pub material: Material,
    /// Speed towards the plate in m/s, positive; of a bender that of its tip when it strikes.
    pub speed: f64,
}

/// The inner body: rests below the plate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inner {
    /// Shape.
    #[serde(flatten)]
    pub shape: Shape,
    /// Material.
    pub material: Material,
    /// Initial distance to the plate in m, not negative.
    pub gap: f64,
}

/// Fluid on the inner side (section 3.5); absent = dry.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fluid {
    /// Dynamic viscosity in Pa s (at rest, if the fluid is shear-thinning).
    pub viscosity: f64,
    /// Density in kg/m^3.
    pub density: f64,
    /// Minimal gap of eq. (4) in m.
    pub minimum_gap: f64,
    /// Whether the squeeze film of eq. (3) acts.
    pub squeeze_film: bool,
    /// First wet over first dry eigenfrequency (section 3.5.3); 1 = no added mass.
    pub added_mass_frequency_ratio: f64,
    /// Modal damping ratio of the wet plate, replacing the dry one.
    pub plate_damping_ratio: f64,
    /// c_W of eq. (2); 0 = no drag.
    pub drag_coefficient: f64,
    /// Shear thinning of the viscosity; `None` = Newtonian.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shear_thinning: Option<ShearThinning>,
}

/// Carreau's law: mu = mu_inf + (mu_0 - mu_inf) (1 + (lambda rate)^2)^((n - 1)/2).
///
/// Between its two bounds it is the power law mu ~ rate^(n - 1).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ShearThinning {
    /// mu_inf in Pa s; mu_0 is the fluid's `viscosity`.
    pub infinite_shear_viscosity: f64,
    /// lambda in s.
    pub relaxation_time: f64,
    /// n, 0 < n <= 1.
    pub power_index: f64,
}

/// What strikes what.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Setup {
    /// Outer body, circular plate, inner body on one axis.
    PlateImpact(Box<PlateImpact>),
    /// Sphere in a flexibly mounted seal seat, struck from below.
    SealSeat(Box<SealSeat>),
}

/// Outer body, circular plate, inner body on one axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlateImpact {
    /// The plate.
    pub plate: Plate,
    /// The striking body.
    pub outer: Outer,
    /// The struck body.
    pub inner: Inner,
    /// The fluid, if any.
    pub fluid: Option<Fluid>,
}

/// Length of the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Run {
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
}

/// Geometry of the reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
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

/// Spheres that the solid reference takes as rigid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
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

/// Tolerances of one reduced model, by quantity.
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
    pub run: Run,
    /// Settings of the reduced model.
    pub reduced: ReducedSettings,
    /// Settings of the reference.
    pub reference: ReferenceSettings,
    /// Tolerances of the gate, by reduced model.
    pub tolerances: BTreeMap<Model, Tolerances>,
}

impl Scene {
    /// The plate impact, for what knows nothing else.
    ///
    /// # Errors
    /// [`Error::Scene`] if the scene is of another kind.
    pub fn plate_impact(&self) -> crate::Result<&PlateImpact> {
        match &self.setup {
            Setup::PlateImpact(setup) => Ok(setup),
            Setup::SealSeat(_) => Err(self.other_kind("seal-seat", "plate-impact")),
        }
    }

    /// The seal seat, for what knows nothing else.
    ///
    /// # Errors
    /// [`Error::Scene`] if the scene is of another kind.
    pub fn seal_seat(&self) -> crate::Result<&SealSeat> {
        match &self.setup {
            Setup::SealSeat(setup) => Ok(setup),
            Setup::PlateImpact(_) => Err(self.other_kind("plate-impact", "seal-seat")),
        }
    }

    fn other_kind(&self, found: &str, needed: &str) -> Error {
        let help = format!("name a scene of kind = \"{needed}\"");
        Error::Scene(miette::miette!(
            help = help,
            "scene `{}` is of kind `{found}`, but this runs scenes of kind `{needed}` only",
            self.name
        ))
    }
}
