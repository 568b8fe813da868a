//! The kinds of scene: their physics, and what the program has to know of each besides.
//!
//! A kind has a folder here and a line in [`KINDS`]; its pages are below `report/kinds`, its runs from the command line below
//! `cli/kinds`, in lists of the same length and order.

mod approach;
mod features;
pub mod general_impact;
mod place;
pub mod plate_impact;
pub mod seal_seat;

pub use approach::Approach;
pub use features::Feature;
pub use general_impact::{announce_set_ups, scene_of_body};
pub use impactcheck_physics::kinds::*;
pub use place::Place;
pub use plate_impact::closed_forms::{ClosedForm, Form};
pub use plate_impact::shared::SharedBodies;

use crate::error::{Error, Result};
use crate::result::Summary;
use crate::scene::{Geometry, Scene};
use impactcheck_physics::kinds as physics;
use std::path::Path;

/// What not every kind of scene can be used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Use {
    /// Measured records of its bodies' motion are compared with it.
    Records,
    /// Its uncertain inputs are sampled.
    Samples,
    /// Its mesh is a file that can be made by itself.
    MeshFile,
}

/// A quantity of a result by its name, SI.
pub type Value<'a> = dyn Fn(&str) -> Option<f64> + 'a;

/// A scene file to start from.
#[derive(Debug, Clone, Copy)]
pub struct Starter {
    /// What happens in a scene of this kind, in a line.
    pub about: &'static str,
    /// A valid scene file whose name is `NAME`.
    pub text: &'static str,
}

/// What the program has to know of a kind of scene.
pub trait Kind: physics::Kind {
    /// Whether a scene of this kind can be used so.
    fn serves(&self, _purpose: Use) -> bool {
        false
    }

    /// A scene file to start from.
    fn starter(&self) -> Starter;

    /// The features that scenes of this kind can have.
    fn features(&self) -> &'static [Feature];

    /// Counts changes of `fem_reference` that change the results of this kind with this `geometry`; raising it makes their stored
    /// solutions stale.
    fn revision(&self, _: Geometry) -> u32 {
        1
    }

    /// The same of the results by CalculiX.
    fn calculix_revision(&self) -> u32 {
        1
    }

    /// Hash of the geometry that a mesh file belongs to, if there is such a file.
    fn geometry_hash(&self, _: &Scene) -> Option<String> {
        None
    }

    /// Whether references of this kind have a mesh, whose file lies with the solution.
    fn has_mesh(&self) -> bool {
        true
    }

    /// The file besides the scene that its reference is made from, if there is one.
    fn body_file<'a>(&self, _: &'a Scene) -> Option<&'a Path> {
        None
    }

    /// Whether the deck for CalculiX describes `scene`.
    fn calculix_takes(&self, _: &Scene) -> bool {
        false
    }

    /// Whether the reference of `scene` keeps what it has done, to go on from there.
    fn is_resumable(&self, scene: &Scene) -> bool {
        scene.reference.geometry == Geometry::Solid
    }

    /// Parts of the models of `scene` compared with closed forms.
    ///
    /// # Errors
    /// Those of the models.
    fn closed_forms(&self, _: &Scene) -> Result<Vec<ClosedForm>> {
        Ok(Vec::new())
    }

    /// Where `scene` with the result `summary` lies among others; `None` if that is not known.
    fn place(&self, _: &Scene, _: &Summary) -> Option<Place> {
        None
    }

    /// Whether a material of `scene` deforms plastically.
    fn yields(&self, _: &Scene) -> bool {
        false
    }

    /// The bodies of `scene` before the impact, of kinds that serve [`Use::Records`].
    ///
    /// # Errors
    /// [`Error::Scene`] of other kinds.
    fn approach(&self, scene: &Scene) -> Result<Approach> {
        Err(refused(scene, Use::Records))
    }

    /// What `optimise` maximises of a scene by itself: a quantity, or [`INTENDED_SPEED`].
    fn objective(&self, _: &Scene) -> &'static str {
        "efficiency"
    }

    /// The speed in m/s along the direction that `scene` intends; a result whose direction differs from it by more than `within` (rad)
    /// has less. Of kinds whose objective is [`INTENDED_SPEED`].
    fn intended_speed(&self, _: &Scene, _within: f64, _: &Value) -> Option<f64> {
        None
    }

    /// Whether the contact whose duration decides on the efficiency begins at the start of `scene`.
    fn starts_in_contact(&self, _: &Scene) -> bool {
        false
    }

    /// Duration of that contact over half the first period.
    fn contact_over_half_period(&self, _: &Value) -> Option<f64> {
        None
    }
}

/// Name of the objective that a kind with an intended direction has.
pub const INTENDED_SPEED: &str = "intended_speed";

/// All kinds.
pub const KINDS: &[&dyn Kind] = &[&plate_impact::Kind, &seal_seat::Kind, &general_impact::Kind];

/// The place of the kind of `scene` among [`KINDS`].
pub fn index(scene: &Scene) -> usize {
    let name = physics::of(scene).name();
    KINDS
        .iter()
        .position(|kind| kind.name() == name)
        .expect("every kind of the physics is one of the program")
}

/// The kind of `scene`.
pub fn of(scene: &Scene) -> &'static dyn Kind {
    KINDS[index(scene)]
}

/// The kind of `scene`, if it serves `purpose`.
///
/// # Errors
/// [`Error::Scene`] if it does not.
pub fn serving(scene: &Scene, purpose: Use) -> Result<&'static dyn Kind> {
    let kind = of(scene);
    if kind.serves(purpose) { Ok(kind) } else { Err(refused(scene, purpose)) }
}

/// That `scene` has the models of its kind only.
pub fn models_only(scene: &Scene) -> String {
    let kind = of(scene);
    let models: Vec<String> = kind.models().iter().map(ToString::to_string).collect();
    format!("scene `{}` is of kind `{}`, which has model {} only", scene.name, kind.name(), models.join(", "))
}

fn refused(scene: &Scene, purpose: Use) -> Error {
    let serving = KINDS.iter().filter(|kind| kind.serves(purpose)).map(|kind| kind.name());
    let (name, kind) = (&scene.name, of(scene).name());
    let needed = serving.collect::<Vec<_>>();
    Error::Scene(miette::miette!(
        help = format!("name a scene of kind = \"{}\"", needed.join("\" or \"")),
        "scene `{name}` is of kind `{kind}`, but this runs scenes of kind `{}` only",
        needed.join("` or `")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn the_program_has_every_kind_of_the_physics_in_its_order() {
        let ours = KINDS.iter().map(|kind| kind.name());
        assert!(ours.eq(physics::KINDS.iter().map(|kind| kind.name())));
    }

    #[test]
    fn a_starter_is_a_scene_of_its_kind() {
        for kind in KINDS {
            let scene = Scene::parse("starter.toml", kind.starter().text).expect("valid");
            assert_eq!(of(&scene).name(), kind.name());
        }
    }

    #[test]
    fn a_refusal_names_the_kinds_that_serve() {
        let scene = Scene::parse("starter.toml", KINDS[1].starter().text).expect("valid");
        let Err(Error::Scene(refused)) = serving(&scene, Use::Records) else {
            panic!("a seat has no records")
        };
        let expected = "scene `NAME` is of kind `seal-seat`, but this runs scenes of kind `plate-impact` or `impact` only";
        assert_eq!(refused.to_string(), expected);
        assert!(serving(&scene, Use::MeshFile).is_ok());
    }
}
