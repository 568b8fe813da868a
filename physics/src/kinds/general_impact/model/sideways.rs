//! What the bodies do along their surfaces, from the contact forces of the model.

use super::ContactModel;
use crate::body::continuum::{MeshOptions, ModesAlong, cached};
use crate::dynamics::integration::Integration;
use crate::error::Result;
use crate::kinds::general_impact::{GeneralImpact, Struck};
use crate::kinds::rubbing::{Rubbed, Rubbing, StruckSurface, Touching, rubs_along};
use crate::result::Table;
use crate::scene::Edge;

impl ContactModel {
    /// The same with the efficiency of all motion: what the inner body has along the surfaces counts.
    pub(super) fn of_all_motion(&self, mut table: Table, rubbed: Option<&Rubbed>) -> Table {
        let along = rubbed.and_then(|rubbed| rubbed.sideways.inner_tangential_velocity_final);
        if let (Some(along), Some(Some(efficiency))) =
            (along, table.value_mut("efficiency").map(Option::as_mut))
        {
            let [outer, inner] = self.system.masses;
            *efficiency +=
                inner * along * along * self.normal_share / (outer * self.setup.outer.speed.powi(2));
        }
        table
    }

    /// The bodies, if they move along the surfaces as the model has it: not where a body that relaxes turns.
    pub(super) fn rubbing(&self) -> Result<Option<Rubbing>> {
        let scene = self.scene.general_impact()?;
        let GeneralImpact { outer, inner, struck, .. } = scene;
        let relaxes = !self.faces[0].relaxation.is_empty();
        let surface = match struck {
            Some(Struck::Body(_)) => {
                let rigid = self.between.as_ref().map_or_else(Vec::new, |between| between.rigid.clone());
                StruckSurface::elastic(rigid, &self.system)
            }
            Some(Struck::Plate(plate)) => {
                let rubs = rubs_along(outer, inner.as_ref()) && !relaxes && plate.edge != Edge::Free;
                let along = match rubs {
                    true => cached::modes_along(plate, &MeshOptions::default())?,
                    false => ModesAlong::default(),
                };
                StruckSurface::plate(plate, 0.0, &self.system, &along)
            }
            Some(Struck::Wall(_)) => StruckSurface::Moving(Vec::new()),
            None => StruckSurface::OtherBody,
        };
        if !scene.moves_along() || surface.vibrates() && relaxes {
            return Ok(None);
        }
        let aside = self.between.as_ref().map_or_else(Vec::new, |between| between.aside.clone());
        let (outer, inner, contacts) = (outer.clone(), inner.clone(), self.touching(scene));
        Ok(Some(Rubbing { outer, inner, struck: surface, tilt: None, aside, contacts }))
    }

    /// Both contacts of `scene`.
    pub(super) fn touching(&self, scene: &GeneralImpact) -> [Touching; 2] {
        let GeneralImpact { outer, inner, .. } = scene;
        let laws = self.system.laws;
        let behind = inner.as_ref().map_or(&outer.material, |inner| &inner.material);
        let [struck, pushed] = self.faces.clone();
        [(laws[0], [outer.material.clone(), struck]), (laws[1], [behind.clone(), pushed])]
    }

    /// What the bodies do along the surfaces; `None` where they do not move so, or the run was cut.
    pub(super) fn rubbed(&self, result: &Integration) -> Result<Option<Rubbed>> {
        self.rubbing.as_ref().map_or(Ok(None), |rubbing| rubbing.solve(result))
    }
}
