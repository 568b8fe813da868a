//! The scene: a body that strikes a circular plate with a second body behind it, in a fluid or dry.

mod keys;
mod read;
mod soundness;

pub use keys::MAX_MODES;
pub(in crate::kinds) use keys::PLATE;
pub(in crate::kinds) use read::plate as read_plate;
pub(in crate::kinds) use soundness::slenderness;

use super::NAME;
use crate::error::Result;
use crate::material::Material;
use crate::scene::collision::Collision;
use crate::scene::grammar::Field;
use crate::scene::parts::is_zero;
use crate::scene::values::Node;
use crate::scene::{Fluid, Inner, Language, Outer, Plate, ReferenceSettings, Scene, Series, Setup};
use serde::Serialize;
use std::borrow::Cow;

/// Outer body, circular plate, inner body on its axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlateImpact {
    /// The plate.
    pub plate: Plate,
    /// The striking body.
    pub outer: Outer,
    /// The struck body.
    pub inner: Inner,
    /// Coulomb's coefficient of friction between plate and bodies.
    #[serde(skip_serializing_if = "is_zero")]
    pub friction: f64,
    /// The fluid, if any.
    pub fluid: Option<Fluid>,
    /// How often the impact is repeated, if it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub series: Option<Series>,
}

impl PlateImpact {
    /// The same impact with the outer body's velocity along the plate's normal alone.
    pub fn along_normal(&self) -> Cow<'_, Self> {
        if self.outer.angle == 0.0 {
            return Cow::Borrowed(self);
        }
        let outer = Outer { speed: self.outer.normal_speed(), angle: 0.0, ..self.outer.clone() };
        Cow::Owned(Self { outer, ..self.clone() })
    }

    /// Whether a body turns before the impact.
    pub fn spins(&self) -> bool {
        self.outer.turning.spin != 0.0 || self.inner.turning.spin != 0.0
    }

    /// Whether a body rubs on the plate.
    pub fn rubs(&self) -> bool {
        self.outer.turning.friction > 0.0 || self.inner.turning.friction > 0.0
    }

    /// Materials of outer body, plate and inner body.
    pub fn materials(&self) -> [&Material; 3] {
        [&self.outer.material, &self.plate.material, &self.inner.material]
    }

    /// Whether a body's material is viscoelastic.
    pub fn relaxes(&self) -> bool {
        self.materials().iter().any(|material| !material.relaxation.is_empty())
    }

    /// Whether a body's material may yield.
    pub fn yields(&self) -> bool {
        self.materials().iter().any(|material| material.hardening.is_some())
    }
}

impl From<PlateImpact> for Setup {
    fn from(setup: PlateImpact) -> Self {
        Self::new(setup)
    }
}

impl Scene {
    /// The plate impact, for what knows nothing else.
    ///
    /// # Errors
    /// [`crate::Error::Scene`] if the scene is of another kind.
    pub fn plate_impact(&self) -> Result<&PlateImpact> {
        self.of_kind(NAME)
    }
}

impl Language for super::Kind {
    fn keys(&self) -> Vec<Field> {
        keys::keys()
    }

    fn collisions(&self, root: &Node) -> Vec<Collision> {
        soundness::key_collisions(root)
    }

    fn read(&self, root: &Node, materials: &Node) -> Result<(Setup, ReferenceSettings)> {
        let setup = read::plate_impact(root, materials)?;
        let reference = read::reference(&root.table_or_defaults("reference")?, setup.outer.is_centred())?;
        Ok((setup.into(), reference))
    }
}
