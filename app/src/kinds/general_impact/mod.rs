//! Impacts without a plate: an outer body strikes a wall or another body.

mod features;
mod from_file;
mod set_up;

pub use from_file::scene_of_body;
pub use impactcheck_physics::kinds::general_impact::*;
pub use set_up::announce_set_ups;

use super::{Approach, ClosedForm, Feature, Form, Starter, Use};
use crate::error::Result;
use crate::scene::{Geometry, Model, Scene, Shape};
use std::path::Path;

impl super::Kind for Kind {
    fn serves(&self, purpose: Use) -> bool {
        matches!(purpose, Use::Records | Use::Samples | Use::MeshFile)
    }

    fn starter(&self) -> Starter {
        Starter { about: "A body strikes a wall or another body", text: include_str!("starter.toml") }
    }

    fn features(&self) -> &'static [Feature] {
        &features::FEATURES
    }

    fn revision(&self, _: Geometry) -> u32 {
        3
    }

    fn calculix_revision(&self) -> u32 {
        3
    }

    fn body_file<'a>(&self, scene: &'a Scene) -> Option<&'a Path> {
        Some(&scene.general_impact().ok()?.body()?.file)
    }

    /// Dry elastic spheres on a body from a file, without damping.
    fn calculix_takes(&self, scene: &Scene) -> bool {
        let Ok(setup) = scene.general_impact() else { return false };
        let Some(body) = setup.body() else { return false };
        let inner = setup.inner.as_ref().map(|inner| &inner.shape);
        let spheres = [Some(&setup.outer.shape), inner]
            .into_iter()
            .flatten()
            .all(|shape| matches!(shape, Shape::Sphere { .. }));
        let elastic = setup.materials().iter().all(|material| material.relaxation.is_empty());
        let single = setup.series.is_none() && setup.outer.is_centred() && body.damping_ratio == 0.0;
        spheres && elastic && !yields(setup) && single && !setup.rubs() && !setup.spins()
    }

    fn closed_forms(&self, scene: &Scene) -> Result<Vec<ClosedForm>> {
        let of = |relative| ClosedForm {
            form: Form::Hertz,
            models: &[Model::C],
            quantity: "outer_force_peak",
            relative,
        };
        Ok(difference_from_hertz(scene)?.map(of).into_iter().collect())
    }

    fn yields(&self, scene: &Scene) -> bool {
        scene.general_impact().is_ok_and(yields)
    }

    fn approach(&self, scene: &Scene) -> Result<Approach> {
        scene.general_impact().map(approach)
    }

    fn objective(&self, scene: &Scene) -> &'static str {
        let has = |name: &str| scene.general_impact().is_ok_and(|setup| setup.has(name));
        if has("efficiency") { "efficiency" } else { "outer_restitution" }
    }

    fn starts_in_contact(&self, _: &Scene) -> bool {
        true
    }
}

/// The bodies of `setup` before the impact.
fn approach(setup: &GeneralImpact) -> Approach {
    let outer = &setup.outer;
    Approach {
        outer_speed: outer.normal_speed(),
        inner_velocity: setup.inner.as_ref().map_or(0.0, |inner| inner.speed),
        outer_mass: outer.shape.mass(&outer.material),
        inner_mass: setup.inner_mass(),
        has_inner_contact: setup.inner.is_some() && setup.struck.is_some(),
        // a wall is held, too
        is_held: setup.struck.is_some() && setup.is_held() != Some(false),
        outer_is_rigid: !outer.shape.is_mounted(),
        inner_is_free: true,
    }
}

/// Whether a material of `setup` deforms plastically.
fn yields(setup: &GeneralImpact) -> bool {
    setup.materials().iter().any(|material| material.plasticity().is_some())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds;

    fn taken(changed: &[(&str, &str)]) -> bool {
        let text = include_str!("../../../../examples/bodies/bracket.toml").to_owned();
        let text = changed.iter().fold(text, |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replace(from, to)
        });
        let scene = Scene::parse("../examples/bodies/bracket.toml", &text).expect("valid");
        kinds::of(&scene).calculix_takes(&scene)
    }

    /// As the solver refuses: nothing else is computed in its name.
    #[test]
    fn calculix_takes_elastic_spheres_on_a_body_only() {
        assert!(taken(&[]));
        assert!(!taken(&[("[outer]", "damping_ratio = 0.01\n\n[outer]")]));
        assert!(!taken(&[("speed    = \"500 mm/s\"", "speed    = \"500 mm/s\"\nangle    = \"5 deg\"")]));
    }
}
