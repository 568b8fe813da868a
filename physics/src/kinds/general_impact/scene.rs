//! The scene: a body strikes a wall, or another body.

use super::NAME;
use super::body::{Body, find_file, place};
use super::soundness::key_collisions;
use crate::error::Result;
use crate::kinds::body_keys::{CONTACT_ELEMENTS, INNER, OUTER, SERIES};
use crate::kinds::body_reading;
use crate::kinds::plate_impact::{PLATE, read_plate};
use crate::kinds::rubbing::moves_along;
use crate::material::Material;
use crate::scene::collision::Collision;
use crate::scene::grammar::{
    BODY_MATERIAL, Bound, Field, Kind, choice, one_way, optional, positive, pure, required,
};
use crate::scene::material::material;
use crate::scene::quantity::Dimension;
use crate::scene::read::refused;
use crate::scene::values::{Node, Values};
use crate::scene::{
    Alias, Edge, FileFault, Geometry, Inner, Language, Outer, Plate, ReferenceSettings, Scene, Series, Setup,
    Shape,
};
use serde::Serialize;
use std::borrow::Cow;

/// A flat wall that does not move.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Wall {
    /// Material of the half-space; `None` = rigid.
    pub material: Option<Material>,
}

/// What the outer body strikes, if not the inner one.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Struck {
    /// A wall; there is no inner body.
    Wall(Wall),
    /// A circular plate, struck at its centre, with no inner body.
    Plate(Plate),
    /// An elastic body; the inner one lies behind it, if there is one.
    Body(Body),
}

/// An outer body, and what it strikes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GeneralImpact {
    /// The striking body.
    pub outer: Outer,
    /// What it strikes; `None` = the inner body.
    #[serde(flatten)]
    pub struck: Option<Struck>,
    /// The inner body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inner: Option<Inner>,
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

    /// The same with every body's friction stated as its own, which identifies the scene. Two bodies that meet have one.
    fn stating_friction(mut self) -> Result<Self> {
        let outer = &mut self.outer.turning;
        if let (None, Some(inner)) = (&self.struck, &mut self.inner) {
            let inner = &mut inner.turning;
            if let (Some(first), Some(second)) = (outer.own_friction, inner.own_friction)
                && first != second
            {
                return Err(refused(
                    &format!(
                        "`outer.friction` is {first}, but `inner.friction` is {second}: the bodies have one contact with one friction"
                    ),
                    "remove one of them",
                ));
            }
            let friction = outer.own_friction.or(inner.own_friction).unwrap_or(outer.friction);
            (outer.friction, inner.friction) = (friction, friction);
        }
        let inner = self.inner.as_mut().map(|inner| &mut inner.turning);
        for turning in [Some(&mut self.outer.turning), inner].into_iter().flatten() {
            turning.own_friction = Some(turning.friction).filter(|friction| *friction > 0.0);
        }
        Ok(self)
    }

    /// Whether a body turns before the impact.
    pub fn spins(&self) -> bool {
        let inner = self.inner.as_ref().map_or(0.0, |inner| inner.turning.spin);
        self.outer.turning.spin != 0.0 || inner != 0.0
    }

    /// Whether the moments of inertia of all bodies are known.
    pub fn has_inertia(&self) -> bool {
        let inner = self.inner.as_ref().map(|inner| inner.turning.has_inertia(&inner.shape));
        self.outer.turning.has_inertia(&self.outer.shape) && inner.unwrap_or(true)
    }

    /// Whether bodies move along the surfaces they meet, or turn: an elastic body's surface does not move along its normal alone.
    pub fn moves_along(&self) -> bool {
        moves_along(&self.outer, self.inner.as_ref())
            || self.body().is_some() && self.rubs() && self.has_inertia()
    }

    /// Whether they rub while they do.
    pub fn rubs_along(&self) -> bool {
        self.moves_along() && self.rubs()
    }

    /// Whether a body rubs on what it touches.
    pub fn rubs(&self) -> bool {
        let inner = self.inner.as_ref().map(|inner| inner.turning.friction);
        self.outer.turning.friction > 0.0 || inner.is_some_and(|friction| friction > 0.0)
    }

    /// The elastic body that is struck, if there is one.
    pub fn body(&self) -> Option<&Body> {
        if let Some(Struck::Body(body)) = &self.struck { Some(body) } else { None }
    }

    /// The circular plate that is struck, if there is one.
    pub fn plate(&self) -> Option<&Plate> {
        if let Some(Struck::Plate(plate)) = &self.struck { Some(plate) } else { None }
    }

    /// Whether plate or body is held; `None` if there is neither.
    pub fn is_held(&self) -> Option<bool> {
        match self.struck.as_ref()? {
            Struck::Wall(_) => None,
            Struck::Plate(plate) => Some(plate.edge != Edge::Free),
            Struck::Body(body) => Some(!body.fixed.is_empty()),
        }
    }

    /// The inner body if nothing lies between it and the outer one.
    pub fn struck_inner(&self) -> Option<&Inner> {
        self.inner.as_ref().filter(|_| self.struck.is_none())
    }

    /// Material of what is struck, of a body of several the first; of a rigid wall one that does not deform.
    pub fn face(&self) -> Cow<'_, Material> {
        let material = match &self.struck {
            Some(Struck::Wall(wall)) => wall.material.as_ref(),
            Some(Struck::Body(body)) => Some(body.materials.named(None)),
            Some(Struck::Plate(plate)) => Some(&plate.material),
            None => self.inner.as_ref().map(|inner| &inner.material),
        };
        material.map_or_else(|| Cow::Owned(Material::rigid()), Cow::Borrowed)
    }

    /// Materials of all bodies; a rigid wall has none.
    pub fn materials(&self) -> Vec<&Material> {
        let between = match &self.struck {
            Some(Struck::Wall(wall)) => wall.material.iter().collect(),
            Some(Struck::Body(body)) => body.materials.all(),
            Some(Struck::Plate(plate)) => vec![&plate.material],
            None => Vec::new(),
        };
        let inner = self.inner.iter().map(|inner| &inner.material);
        [&self.outer.material].into_iter().chain(between).chain(inner).collect()
    }

    /// Mass of the inner body in kg; `None` without one.
    pub fn inner_mass(&self) -> Option<f64> {
        self.inner.as_ref().map(|inner| inner.shape.mass(&inner.material))
    }

    /// Whether results have the quantity or curve called `name`: a wall does not move, a clamped body has an energy of its own, the tip of a
    /// stack vibrates on, and a contact of the inner body's own needs a body between.
    pub fn has(&self, name: &str) -> bool {
        let outer = &self.outer.shape;
        match name {
            "efficiency" => self.inner.is_some() && !matches!(outer, Shape::Stack(_)),
            "outer_velocity_final" => !matches!(outer, Shape::Stack(_)),
            "outer_restitution" => !outer.is_mounted(),
            "first_frequency" => self.is_held().is_some(),
            "inner_restitution" => {
                self.body().is_some() && self.inner.as_ref().is_some_and(|inner| inner.speed > 0.0)
            }
            "inner_displacement" | "inner_velocity" | "inner_velocity_final" => self.inner.is_some(),
            _ => !name.starts_with("inner") || (self.inner.is_some() && self.body().is_some()),
        }
    }

    /// Velocity of what is struck at t = 0 in m/s along z.
    pub fn struck_velocity(&self) -> f64 {
        self.struck_inner().map_or(0.0, |inner| inner.speed)
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
    optional("rigid", Kind::Flag, "`true` instead of a material: the wall does not deform")
        .otherwise("false"),
];

/// Most places that hold a body, and most frequencies.
const MOST_FIXED: usize = 64;
const MOST_FREQUENCIES: u64 = 200;

/// What two keys state of a body.
const MATERIAL: &str = "the material";

static BODY: [Field; 7] = [
    required(
        "file",
        Kind::Text,
        "Mesh (.msh .inp .bdf .med .vtu) or CAD file (.step .stp), relative to the scene file",
    ),
    optional(
        "unit",
        Kind::Choice(&[choice("m"), choice("mm"), choice("um"), choice("cm"), choice("in")]),
        "Unit of length in the file; absent = STEP's own, else m",
    ),
    one_way(None, MATERIAL, "one", BODY_MATERIAL),
    one_way(
        None,
        MATERIAL,
        "groups",
        required(
            "materials",
            Kind::Named(&BODY_MATERIAL),
            "Materials by the names of groups of elements in the file, which have all elements",
        ),
    ),
    optional(
        "fixed",
        Kind::Places(MOST_FIXED),
        "What does not move: names of groups, sets or faces, or points on faces; absent or empty = the body is free",
    ),
    optional(
        "element_size",
        positive(Dimension::LENGTH),
        "Largest size of elements, of CAD; absent = half the thickness of each wall",
    ),
    optional(
        "damping_ratio",
        pure(Bound { low: Some((0.0, true)), high: Some((1.0, false)) }),
        "Modal damping ratio, the same for every mode",
    )
    .otherwise("0"),
];

/// Where a body strikes.
const AT: Field = optional(
    "at",
    Kind::Place,
    "Place on the surface of [body]: the name of a point, set or face, or three coordinates in its file's system",
);

static REDUCED: [Field; 2] = [
    optional("model", Kind::Choice(&[choice("C")]), "Model to run: without a plate there is model C only"),
    optional(
        "frequencies",
        Kind::Count(1, MOST_FREQUENCIES),
        "Number of the lowest eigenfrequencies of [body] that the result lists; absent = none",
    ),
];

// with four elements bands at `coarse` are about 1 %
static REFERENCE: [Field; 1] = [optional(
    "elements_per_contact_radius",
    pure(CONTACT_ELEMENTS),
    "Elements across the contact radius at `paper` resolution",
)
.otherwise("4")];

impl Language for super::Kind {
    fn keys(&self) -> Vec<Field> {
        vec![
            optional(
                "plate",
                Kind::Table(&PLATE),
                "Circular plate that the outer body strikes; with [inner] the scene is one of kind `plate-impact`, with all its keys",
            ),
            optional(
                "wall",
                Kind::Table(&WALL),
                "Flat wall that the outer body strikes; there is no inner body",
            ),
            optional(
                "body",
                Kind::Table(&BODY),
                "Elastic body from a mesh or CAD file that the outer body strikes",
            ),
            required("outer", Kind::Table(with_place(&OUTER)), "The body that strikes"),
            optional(
                "inner",
                Kind::Table(with_place(&INNER)),
                "The body that is struck, required without plate, body and wall",
            ),
            optional(
                "series",
                Kind::Table(&SERIES),
                "Repeated impacts, each with the plastic indentations of those before",
            ),
            optional("reduced", Kind::Table(&REDUCED), "Settings of the reduced model"),
            optional("reference", Kind::Table(&REFERENCE), "Settings of the finite-element reference"),
            optional(
                "uncertainty",
                Kind::Uncertainty,
                "How uncertain the scene's numbers are, by the names of their fields; changes no result",
            ),
        ]
    }

    fn alias(&self) -> Option<Alias> {
        Some(Alias { with: &["plate", "inner"], without: "wall", kind: crate::kinds::plate_impact::NAME })
    }

    fn collisions(&self, root: &Node) -> Vec<Collision> {
        key_collisions(root)
    }

    fn find_files(&self, values: &mut Values, source_name: &str) -> std::result::Result<(), FileFault> {
        let help = "name a file in the folder of the scene file";
        find_file(values, source_name).map_err(|message| FileFault { field: "body.file", message, help })
    }

    fn read(&self, root: &Node, materials: &Node) -> Result<(Setup, ReferenceSettings)> {
        let (outer_table, inner_table) = (root.table("outer")?, root.optional_table("inner")?);
        let [wall, body, plate] = ["wall", "body", "plate"].map(|key| root.optional_table(key));
        let struck = match (wall?, body?) {
            (Some(wall), _) => {
                let material = wall.has("material").then(|| material(materials, wall.text("material")?));
                Some(Struck::Wall(Wall { material: material.transpose()? }))
            }
            (None, Some(body)) => {
                let inner = inner_table.as_ref().map(|inner| place(inner, "at")).transpose()?;
                let at = [place(&outer_table, "at")?, inner.flatten()];
                Some(Struck::Body(Body::read(&body, materials, at)?))
            }
            (None, None) => {
                plate?.map(|plate| read_plate(&plate, materials).map(Struck::Plate)).transpose()?
            }
        };
        let friction = root.number("friction")?;
        let inner = inner_table.map(|inner| body_reading::inner(&inner, materials, friction)).transpose()?;
        let outer = body_reading::outer(&outer_table, materials, friction)?;
        let series = body_reading::series(root)?;
        let setup = GeneralImpact { outer, struck, inner, series }.stating_friction()?;
        let elements = root.table_or_defaults("reference")?.number("elements_per_contact_radius")?;
        let reference = ReferenceSettings {
            elements_per_contact_radius: Some(elements),
            ..ReferenceSettings::of(Geometry::Solid)
        };
        Ok((Setup::new(setup), reference))
    }
}

/// The keys of a body, with the place at which it strikes.
fn with_place(fields: &[Field]) -> &'static [Field] {
    [fields, &[AT]].concat().leak()
}

/// Radius in m of a sphere.
pub(super) fn sphere_radius(shape: &Shape) -> Option<f64> {
    if let Shape::Sphere { radius } = shape { Some(*radius) } else { None }
}
