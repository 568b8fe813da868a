//! How the commands run the reduced models of each kind of scene.

mod plate_impact;
mod seal_seat;

use super::Context;
use super::asked_model::AskedModel;
use super::asked_model::ModelRequest;
use crate::error::Result;
use crate::kinds::{self, KINDS, SharedBodies};
use crate::reference::Stored;
use crate::report::Cost;
use crate::result::Outcome;
use crate::scene::{Model, Scene};

/// Results of the models, and what they have cost if they share a mesh with the reference.
pub(super) type Compared = (Vec<Outcome>, Vec<Cost>);

/// The reduced models of a kind of scene.
pub(super) trait ReducedModels: Sync {
    /// Runs the model that is `asked` for, one of a series of impacts that share `bodies`; without `curves` its history has no more
    /// samples than its limits need.
    ///
    /// # Errors
    /// Those of the arguments and of the model.
    fn reduced(
        &self,
        context: &Context,
        scene: &Scene,
        asked: &ModelRequest,
        bodies: &SharedBodies,
        curves: bool,
    ) -> Result<Outcome>;

    /// Whether [`ReducedModels::beside`] solves on the very mesh of the reference.
    fn shares_mesh(&self) -> bool {
        false
    }

    /// Whether `model` takes `scene`.
    fn takes(&self, scene: &Scene, model: Model) -> bool;

    /// Runs the models `asked` for, with the tolerance of `auto`, without a reference; none if they need its mesh.
    ///
    /// # Errors
    /// Those of the models.
    fn alone(&self, _: &Scene, _: (&[AskedModel], Option<f64>)) -> Result<Vec<Outcome>> {
        Ok(Vec::new())
    }

    /// Runs those of the models `asked` for that there are, with the tolerance of `auto`, beside a reference.
    ///
    /// # Errors
    /// Those of the models.
    fn beside(
        &self,
        context: &Context,
        scene: &Scene,
        stored: &Stored,
        asked: (&[AskedModel], Option<f64>),
    ) -> Result<Compared>;
}

/// The models of each of [`KINDS`].
const MODELS: [&dyn ReducedModels; KINDS.len()] = [&plate_impact::Plates, &seal_seat::Seats];

/// The models of `scene`.
pub(super) fn of(scene: &Scene) -> &'static dyn ReducedModels {
    MODELS[kinds::index(scene)]
}

/// Whether one of the models `asked` for is one of `scene`; `auto` chooses among several.
pub(super) fn has_one_of(scene: &Scene, asked: &[AskedModel]) -> bool {
    let own = kinds::of(scene).models();
    asked.iter().any(|asked| match asked {
        AskedModel::Named(model) => own.contains(model),
        AskedModel::Auto => own.len() > 1,
        AskedModel::External => !scene.external.is_empty(),
    })
}
