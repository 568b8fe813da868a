//! What a scene is made of: plates, bodies that strike or are struck, fluids.

use super::Material;
pub use crate::actuator::{Bender, Stack, Supply};
use serde::{Deserialize, Serialize};

/// Support of the plate's rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
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
    /// Support of the edge.
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
    /// Piezo stack, an elastic body that pushes on while it strikes; outer body only.
    Stack(Stack),
}

impl Shape {
    /// Mass in kg of the body made of `material` (of a bender: beam and tip).
    pub fn mass(&self, material: &Material) -> f64 {
        match *self {
            Shape::Sphere { radius } => 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * material.density,
            Shape::Compact { mass, .. } => mass,
            Shape::Bender(bender) => bender.mass(),
            Shape::Stack(stack) => stack.mass(),
        }
    }

    /// Radius of curvature at the contact in m.
    pub fn tip_radius(&self) -> f64 {
        match *self {
            Shape::Sphere { radius } => radius,
            Shape::Compact { tip_radius, .. } => tip_radius,
            Shape::Bender(bender) => bender.tip_radius,
            Shape::Stack(stack) => stack.tip_radius,
        }
    }

    /// Whether it is held at one end, so that its momentum is not its own.
    pub fn is_mounted(&self) -> bool {
        matches!(self, Shape::Bender(_) | Shape::Stack(_))
    }
}

/// How a body turns, and rubs on what it touches.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Turning {
    /// Coulomb's coefficient of its contact.
    #[serde(skip)]
    pub friction: f64,
    /// The same if the body states its own; `None`: it is that of the scene.
    #[serde(rename = "friction", skip_serializing_if = "Option::is_none")]
    pub own_friction: Option<f64>,
    /// Spin about y at t = 0 in rad/s; positive as of a ball that rolls towards +x on a floor.
    #[serde(skip_serializing_if = "is_zero")]
    pub spin: f64,
    /// Moment of inertia about its centre in kg m^2, of a compact body; `None`: not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment_of_inertia: Option<f64>,
}

impl Turning {
    /// Whether the moment of inertia of a body of this `shape` is known.
    pub fn has_inertia(&self, shape: &Shape) -> bool {
        matches!(shape, Shape::Sphere { .. }) || self.moment_of_inertia.is_some()
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
    /// Speed in m/s, positive; of a bender that of its tip when it strikes, of a stack that after a step of its voltage.
    pub speed: f64,
    /// Distance of the point of impact from the axis in m, along x, not negative.
    #[serde(skip_serializing_if = "is_zero")]
    pub offset: f64,
    /// Angle of the velocity against the plate's normal in rad, in the x-z plane; positive = towards +x.
    #[serde(skip_serializing_if = "is_zero")]
    pub angle: f64,
    /// Spin and friction.
    #[serde(flatten)]
    pub turning: Turning,
}

impl Outer {
    /// A body that strikes the centre of the plate along its axis with `speed` in m/s.
    pub fn centred(shape: Shape, material: Material, speed: f64) -> Self {
        Self { shape, material, speed, offset: 0.0, angle: 0.0, turning: Turning::default() }
    }

    /// Speed towards the plate in m/s.
    pub fn normal_speed(&self) -> f64 {
        self.speed * self.angle.cos()
    }

    /// Whether it strikes the centre of the plate along its axis.
    pub fn is_centred(&self) -> bool {
        self.offset == 0.0 && self.angle == 0.0
    }
}

/// The inner body: rests below the plate, or has a speed of its own.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inner {
    /// Shape.
    #[serde(flatten)]
    pub shape: Shape,
    /// Material.
    pub material: Material,
    /// Initial distance to the plate in m, not negative.
    pub gap: f64,
    /// Speed towards the plate in m/s at t = 0, when the outer body touches; negative = away from it.
    #[serde(skip_serializing_if = "is_zero")]
    pub speed: f64,
    /// Spin and friction.
    #[serde(flatten)]
    pub turning: Turning,
}

/// What is zero is written as before it could be anything else, so that the hash of the scene stays.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it with a reference")]
pub(crate) fn is_zero(value: &f64) -> bool {
    *value == 0.0
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

/// The same impact several times, each with the dents of those before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Series {
    /// Number of impacts at most; they end earlier once nothing yields any more.
    pub impacts: u64,
    /// Where outer and inner body are hit.
    pub sphere_spot: Spot,
}

/// Where a body is hit in a series of impacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Spot {
    /// On the same spot each time.
    Same,
    /// On a spot that has not yielded yet.
    Fresh,
}
