//! The scene: a body strikes a wall, or another body.

use super::NAME;
use super::soundness::key_collisions;
use crate::error::Result;
use crate::kinds::body_keys::{INNER, OUTER, SERIES};
use crate::kinds::body_reading;
use crate::kinds::plate_impact::PLATE;
use crate::material::Material;
use crate::scene::collision::Collision;
use crate::scene::grammar::{Field, Kind, choice, optional, required};
use crate::scene::material::material;
use crate::scene::values::Node;
use crate::scene::{Alias, Geometry, Inner, Language, Outer, ReferenceSettings, Scene, Series, Setup, Shape};
use serde::Serialize;
use std::borrow::Cow;

/// A flat wall that does not move.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Wall {
    /// Material of the half-space; `None` = rigid.
    pub material: Option<Material>,
}

/// What the outer body strikes.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Struck {
    /// A wall; there is no inner body.
    Wall(Wall),
    /// The inner body, with nothing between.
    Inner(Inner),
}

/// An outer body, and what it strikes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GeneralImpact {
    /// The striking body.
    pub outer: Outer,
    /// What it strikes.
    #[serde(flatten)]
    pub struck: Struck,
    /// How often the impact is repeated, if it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub series: Option<Series>,
}

impl GeneralImpact {
    /// The same impact with the outer body's velocity along the common normal alone.
    pub fn along_normal(&self) -> Cow<'_, Self> {
        if self.outer.angle == 0.0 {
            return Cow::Borrowed(self);
        }
        let outer = Outer { speed: self.outer.normal_speed(), angle: 0.0, ..self.outer.clone() };
        Cow::Owned(Self { outer, ..self.clone() })
    }

    /// The inner body, if there is one.
    pub fn inner(&self) -> Option<&Inner> {
        match &self.struck {
            Struck::Wall(_) => None,
            Struck::Inner(inner) => Some(inner),
        }
    }

    /// Material of what is struck.
    pub fn face(&self) -> Cow<'_, Material> {
        match &self.struck {
            Struck::Wall(Wall { material: Some(material) }) | Struck::Inner(Inner { material, .. }) => {
                Cow::Borrowed(material)
            }
            Struck::Wall(Wall { material: None }) => Cow::Owned(Material::rigid()),
        }
    }

    /// Materials of both bodies; a rigid wall has none.
    pub fn materials(&self) -> Vec<&Material> {
        let face = match &self.struck {
            Struck::Wall(wall) => wall.material.as_ref(),
            Struck::Inner(inner) => Some(&inner.material),
        };
        [Some(&self.outer.material), face].into_iter().flatten().collect()
    }

    /// Mass of the inner body in kg; `None` before a wall.
    pub fn inner_mass(&self) -> Option<f64> {
        self.inner().map(|inner| inner.shape.mass(&inner.material))
    }

    /// Whether results have the quantity or curve called `name`: a wall does not move, a clamped body has an energy of its own, and the tip of a
    /// stack vibrates on.
    pub fn has(&self, name: &str) -> bool {
        let outer = &self.outer.shape;
        match name {
            "efficiency" => self.inner().is_some() && !matches!(outer, Shape::Stack(_)),
            "outer_velocity_final" => !matches!(outer, Shape::Stack(_)),
            "outer_restitution" => !outer.is_mounted(),
            _ => self.inner().is_some() || !name.starts_with("inner"),
        }
    }

    /// Velocity of what is struck at t = 0 in m/s along z.
    pub fn struck_velocity(&self) -> f64 {
        self.inner().map_or(0.0, |inner| inner.speed)
    }

    /// Speed in m/s at which the bodies approach each other at t = 0; of a stack that of its tip after a step of the voltage.
    pub fn closing_speed(&self) -> f64 {
        self.outer.normal_speed() + self.struck_velocity()
    }
}

impl Scene {
    /// The impact on a wall or another body, for what knows nothing else.
    ///
    /// # Errors
    /// [`crate::Error::Scene`] if the scene is of another kind.
    pub fn general_impact(&self) -> Result<&GeneralImpact> {
        self.of_kind(NAME)
    }
}

static WALL: [Field; 2] = [
    optional("material", Kind::Material, "Material of the half-space, a name under [materials]"),
    optional("rigid", Kind::Flag, "`true` instead of a material: the wall does not deform"),
];

static REDUCED: [Field; 1] =
    [optional("model", Kind::Choice(&[choice("C")]), "Model to run: without a plate there is model C only")];

impl Language for super::Kind {
    fn keys(&self) -> Vec<Field> {
        vec![
            optional(
                "plate",
                Kind::Table(&PLATE),
                "Circular plate between the bodies; the scene is then one of kind `plate-impact`, with all its keys",
            ),
            optional(
                "wall",
                Kind::Table(&WALL),
                "Flat wall that the outer body strikes; there is no inner body",
            ),
            required("outer", Kind::Table(&OUTER), "The body that strikes"),
            optional(
                "inner",
                Kind::Table(&INNER),
                "The body that is struck, required without plate and wall",
            ),
            optional(
                "series",
                Kind::Table(&SERIES),
                "Repeated impacts, each with the plastic indentations of those before",
            ),
            optional("reduced", Kind::Table(&REDUCED), "Settings of the reduced model"),
            optional(
                "uncertainty",
                Kind::Uncertainty,
                "How uncertain the scene's numbers are, by the names of their fields; changes no result",
            ),
        ]
    }

    fn alias(&self) -> Option<Alias> {
        Some(Alias { with: "plate", without: "wall", kind: crate::kinds::plate_impact::NAME })
    }

    fn collisions(&self, root: &Node) -> Vec<Collision> {
        key_collisions(root)
    }

    fn read(&self, root: &Node, materials: &Node) -> Result<(Setup, ReferenceSettings)> {
        let of = |wall: &Node| match wall.0.contains_key("material") {
            true => material(materials, wall.text("material")?).map(Some),
            false => Ok(None),
        };
        let struck = match root.optional_table("wall")? {
            Some(wall) => Struck::Wall(Wall { material: of(&wall)? }),
            None => Struck::Inner(body_reading::inner(&root.table("inner")?, materials)?),
        };
        let outer = body_reading::outer(&root.table("outer")?, materials)?;
        let series = body_reading::series(root)?;
        let setup = GeneralImpact { outer, struck, series };
        Ok((Setup::new(setup), ReferenceSettings::of(Geometry::Axisymmetric)))
    }
}

/// Radius in m of a sphere.
pub(super) fn sphere_radius(shape: &Shape) -> Option<f64> {
    if let Shape::Sphere { radius } = shape { Some(*radius) } else { None }
}
