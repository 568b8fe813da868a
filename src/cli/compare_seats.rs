//! The seal-seat scenes of `compare` and `gate`: the reduced model on the very mesh of the stored reference.

use super::Context;
use super::asked_model::AskedModel;
use super::progress::Bar;
use crate::body::cache::Cache;
use crate::error::{Error, Result};
use crate::kinds::seal_seat::{DEFAULT_TOLERANCE, SeatMesh, SeatModel};
use crate::reference::Stored;
use crate::report::Cost;
use crate::result::Outcome;
use crate::scene::{Model, Scene};

/// Refuses models that a seal seat has not.
///
/// # Errors
/// [`Error::Usage`] naming `scene`.
pub(super) fn check_models(scene: &Scene, models: &[AskedModel]) -> Result<()> {
    if models.contains(&AskedModel::Named(Model::C)) {
        return Ok(());
    }
    let names: Vec<String> = models.iter().map(AskedModel::to_string).collect();
    Err(Error::Usage(format!(
        "--models {}: scene `{}` is a seal seat, which has model C only",
        names.join(","),
        scene.name
    )))
}

/// Runs the reduced model, and says what it has cost.
pub(super) fn run(context: &Context, scene: &Scene, stored: &Stored) -> Result<(Vec<Outcome>, Vec<Cost>)> {
    let mesh = SeatMesh::open(&stored.folder.join("mesh.vtu"))?;
    let bar = Bar::new(context, &scene.name);
    let cache = Cache::from_environment();
    let watch = &mut |part, done| bar.part(part, done);
    let model = SeatModel::new_with(scene, Model::C, None, &mesh, &cache, watch)?;
    drop(bar);
    let outcome = model.run_with_history(DEFAULT_TOLERANCE)?;
    let cost = Cost { setup_seconds: model.setup_seconds, dofs: model.dofs };
    Ok((vec![outcome], vec![cost]))
}
