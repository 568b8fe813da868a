//! The kinds of scene, each with its reduced models.

mod body_keys;
mod body_reading;
mod consistency;
pub mod flight;
pub mod general_impact;
mod impacts;
pub mod plate_impact;
mod reading;
mod rubbing;
pub mod seal_seat;
mod series;

use crate::error::{Error, Result};
use crate::flight::Launch;
use crate::result::{Curve, History, Outcome, Quantity, Statement, Summary, Table};
use crate::scene::{Language, Model, Scene};

pub use general_impact::{MeshRequest, set_mesher};
pub use reading::{schema, unit_of};
use seal_seat::SeatMesh;
/// The mesh that a series of impacts follows, of kinds that need one.
pub use seal_seat::SeatMesh as FollowedMesh;
pub use series::{Series, SeriesModel, series};

/// What everything that compares, shows or keeps results has to know of a kind of scene.
#[expect(private_bounds, reason = "what a kind adds to the scene language is the affair of this crate")]
pub trait Kind: Language {
    /// Its name in scene files.
    fn name(&self) -> &'static str;

    /// The reduced models it has.
    fn models(&self) -> &'static [Model];

    /// Whether `model`, one of [`Self::models`], has a form for `scene`.
    fn has_form(&self, _scene: &Scene, _model: Model) -> bool {
        true
    }

    /// The quantities of its results, in order, without values.
    fn quantities(&self) -> &'static [Quantity];

    /// The curves of its histories, in order, without samples.
    fn curves(&self) -> &'static [Curve];

    /// Whether results of `scene` have the quantity or curve called `name`, one of this kind.
    fn has(&self, _: &Scene, _name: &str) -> bool {
        true
    }

    /// `model` of `scene`, ready to run, with so many `modes`, its own or the scene's number if it is `None`.
    ///
    /// # Errors
    /// Those of the model's set-up; [`Error::Internal`] of a kind whose models need a mesh.
    fn model(&self, scene: &Scene, model: Model, _modes: Option<usize>) -> Result<Box<dyn SeriesModel>> {
        Err(Error::Internal(format!("model {model} of `{}` needs a mesh", scene.name)))
    }

    /// What the impacts of a [`series`] share: nothing, unless a kind says otherwise.
    ///
    /// # Errors
    /// As [`series`].
    fn series(
        &self,
        _varied: &[(&str, [f64; 2])],
        _: &Scene,
        _mesh: Option<&SeatMesh>,
        _impacts: usize,
    ) -> Result<Box<dyn Series>> {
        Ok(Box::new(series::Independent))
    }

    /// Adds to the `summary` of any model or reference of a scene of this kind how near it comes to the bounds of the
    /// theories behind it, and warns where it is beyond. Without `history` some of it is not known.
    fn judge(&self, _: &Scene, _: &mut Summary, _: Option<&History>) {}

    /// The quantities that the curves of a `history` show, which another program need not state.
    fn shown(&self, _: &Scene, _: &History) -> Table {
        Table::new(self.quantities())
    }

    /// How an impact with the results `summary` launches the sphere that flies; `None` if the run was cut during a contact, or
    /// if none flies.
    fn launch(&self, _: &Summary) -> Option<Launch> {
        None
    }

    /// The meshes that the models of `scene` read, of kinds whose bodies are meshed from files or dimensions.
    fn mesh_requests(&self, _: &Scene) -> Vec<MeshRequest> {
        Vec::new()
    }

    /// What must hold of a result of `scene`; of its curves, if they can be sampled.
    fn checks(&self, scene: &Scene, outcome: &Outcome) -> Vec<Statement>;
}

/// All kinds.
pub const KINDS: &[&dyn Kind] = &[&plate_impact::Kind, &seal_seat::Kind, &general_impact::Kind];

/// The kind called `name`.
pub fn named(name: &str) -> Option<&'static dyn Kind> {
    KINDS.iter().copied().find(|kind| kind.name() == name)
}

/// The kind of `scene`.
pub fn of(scene: &Scene) -> &'static dyn Kind {
    let name = scene.setup.kind();
    named(name).unwrap_or_else(|| unreachable!("a scene of the kind `{name}`"))
}
