//! Plate impacts: an outer body strikes a plate, the plate passes the blow to an inner body.

mod features;
mod place;

pub use impactcheck_physics::kinds::plate_impact::*;

use super::{Approach, ClosedForm, Feature, Place, Starter, Use, Value};
use crate::error::Result;
use crate::result::Summary;
use crate::scene::{Edge, Geometry, Scene, Shape};

impl super::Kind for Kind {
    fn serves(&self, purpose: Use) -> bool {
        matches!(purpose, Use::Records | Use::Samples)
    }

    fn starter(&self) -> Starter {
        Starter {
            about: "A body strikes a plate, the plate transmits the impact to a body behind it",
            text: include_str!("starter.toml"),
        }
    }

    fn features(&self) -> &'static [Feature] {
        &features::FEATURES
    }

    fn revision(&self, geometry: Geometry) -> u32 {
        match geometry {
            Geometry::Axisymmetric => 4,
            Geometry::Solid => 5,
        }
    }

    /// A dry impact of elastic spheres on a plate without damping or friction.
    fn calculix_takes(&self, scene: &Scene) -> bool {
        let Ok(setup) = scene.plate_impact() else { return false };
        let spheres =
            [&setup.outer.shape, &setup.inner.shape].iter().all(|s| matches!(s, Shape::Sphere { .. }));
        let dry =
            setup.fluid.is_none() && setup.plate.damping_ratio == 0.0 && !setup.rubs() && !setup.spins();
        let elastic = !setup.relaxes() && !setup.yields() && setup.series.is_none();
        spheres && dry && elastic && scene.reference.geometry == Geometry::Axisymmetric
    }

    fn is_resumable(&self, scene: &Scene) -> bool {
        scene.reference.geometry == Geometry::Solid
            || scene.plate_impact().is_ok_and(|setup| setup.series.is_some())
    }

    fn closed_forms(&self, scene: &Scene) -> Result<Vec<ClosedForm>> {
        closed_forms::closed_forms(scene.plate_impact()?)
    }

    fn place(&self, scene: &Scene, summary: &Summary) -> Option<Place> {
        place::place(scene.plate_impact().ok()?, summary)
    }

    fn yields(&self, scene: &Scene) -> bool {
        scene.plate_impact().is_ok_and(PlateImpact::yields)
    }

    fn approach(&self, scene: &Scene) -> Result<Approach> {
        scene.plate_impact().map(approach)
    }

    fn starts_in_contact(&self, scene: &Scene) -> bool {
        scene.plate_impact().is_ok_and(|setup| setup.inner.gap == 0.0)
    }

    fn contact_over_half_period(&self, value: &Value) -> Option<f64> {
        PlateQuantities::of(value).map(|quantities| quantities.contact_over_half_period())
    }
}

/// The bodies of `setup` before the impact.
pub fn approach(setup: &PlateImpact) -> Approach {
    let (outer, inner) = (&setup.outer, &setup.inner);
    Approach {
        outer_speed: outer.speed,
        inner_velocity: inner.speed,
        outer_mass: outer.shape.mass(&outer.material),
        inner_mass: Some(inner.shape.mass(&inner.material)),
        has_inner_contact: true,
        is_held: setup.plate.edge != Edge::Free,
        outer_is_rigid: matches!(outer.shape, Shape::Sphere { .. } | Shape::Compact { .. }),
        inner_is_free: setup.fluid.is_none(),
    }
}
