//! Impacts without a plate: an outer body strikes a wall or another body.

mod features;
mod from_file;
mod set_up;

pub use from_file::scene_of_body;
pub use impactcheck_physics::kinds::general_impact::*;
pub use set_up::announce_set_ups;

use super::{ClosedForm, Feature, Form, Starter, Use};
use crate::error::Result;
use crate::scene::{Model, Scene, Shape};
use std::path::Path;

impl super::Kind for Kind {
    fn serves(&self, purpose: Use) -> bool {
        matches!(purpose, Use::Samples | Use::MeshFile)
    }

    fn starter(&self) -> Starter {
        Starter { about: "A body strikes a wall or another body", text: include_str!("starter.toml") }
    }

    fn features(&self) -> &'static [Feature] {
        &features::FEATURES
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
        spheres && elastic && !yields(setup) && single
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

    fn objective(&self, scene: &Scene) -> &'static str {
        let has = |name: &str| scene.general_impact().is_ok_and(|setup| setup.has(name));
        if has("efficiency") { "efficiency" } else { "outer_restitution" }
    }

    fn starts_in_contact(&self, _: &Scene) -> bool {
        true
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
        let text = include_str!("../../../examples/bodies/bracket.toml").to_owned();
        let text = changed.iter().fold(text, |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replace(from, to)
        });
        let scene = Scene::parse("examples/bodies/bracket.toml", &text).expect("valid");
        kinds::of(&scene).calculix_takes(&scene)
    }

    /// As the solver refuses: nothing else is computed in its name.
    #[test]
    fn calculix_takes_elastic_spheres_on_a_body_only() {
        assert!(taken(&[]));
        assert!(!taken(&[("[outer]", "damping_ratio = 0.01\n\n[outer]")]));
        assert!(!taken(&[("[body]", "yield_strength = \"1 GPa\"\nhardening = \"0 Pa\"\n\n[body]")]));
        let compact = "kind = \"compact\"\nmass = \"2 g\"\ntip_radius = \"4 mm\"\n";
        assert!(!taken(&[("kind     = \"sphere\"\nradius   = \"4 mm\"\n", compact)]));
    }
}
