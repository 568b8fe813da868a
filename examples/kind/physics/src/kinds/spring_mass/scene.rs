//! The bodies of a spring-mass scene, their keys and how they are read. Both move along one axis and touch at t = 0.

use super::NAME;
use crate::contact::Hertz;
use crate::error::Result;
use crate::material::Material;
use crate::scene::grammar::{BODY_MATERIAL, Field, Kind, positive, required};
use crate::scene::material::material;
use crate::scene::quantity::Dimension;
use crate::scene::values::Node;
use crate::scene::{Bodies, Geometry, Language, ReferenceSettings, Setup};
use serde::Serialize;

/// The sphere, rigid but for its contact.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StrikingSphere {
    /// Mass in kg.
    pub mass: f64,
    /// Radius in m.
    pub radius: f64,
    /// Speed towards the mass in m/s.
    pub speed: f64,
    /// Material.
    pub material: Material,
}

/// The mass, at rest; its face is flat.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StruckMass {
    /// Mass in kg.
    pub mass: f64,
    /// Stiffness of its spring in N/m.
    pub stiffness: f64,
    /// Material of its face.
    pub material: Material,
}

/// A sphere strikes a mass on a spring.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpringMass {
    /// The sphere.
    pub sphere: StrikingSphere,
    /// The mass.
    pub mass: StruckMass,
}

impl SpringMass {
    /// Contact of both.
    pub(super) fn law(&self) -> Hertz {
        Hertz::new(self.sphere.radius, &self.sphere.material, &self.mass.material)
    }
}

impl Bodies for SpringMass {
    fn kind(&self) -> &'static str {
        NAME
    }
}

static SPHERE: [Field; 4] = [
    required("mass", positive(Dimension::MASS), "Mass of the sphere"),
    required("radius", positive(Dimension::LENGTH), "Radius of the sphere"),
    required("speed", positive(Dimension::SPEED), "Speed towards the mass"),
    BODY_MATERIAL,
];

static MASS: [Field; 3] = [
    required("mass", positive(Dimension::MASS), "The mass"),
    required("stiffness", positive(Dimension::STIFFNESS), "Stiffness of its spring"),
    BODY_MATERIAL,
];

impl Language for super::Kind {
    fn keys(&self) -> Vec<Field> {
        vec![
            required("sphere", Kind::Table(&SPHERE), "Strikes the mass"),
            required("mass", Kind::Table(&MASS), "A mass on a spring, at rest"),
        ]
    }

    fn read(&self, root: &Node, materials: &Node) -> Result<(Setup, ReferenceSettings)> {
        let (sphere, mass) = (root.table("sphere")?, root.table("mass")?);
        let bodies = SpringMass {
            sphere: StrikingSphere {
                mass: sphere.number("mass")?,
                radius: sphere.number("radius")?,
                speed: sphere.number("speed")?,
                material: material(materials, sphere.text("material")?)?,
            },
            mass: StruckMass {
                mass: mass.number("mass")?,
                stiffness: mass.number("stiffness")?,
                material: material(materials, mass.text("material")?)?,
            },
        };
        Ok((Setup::new(bodies), ReferenceSettings::of(Geometry::Axisymmetric)))
    }
}
