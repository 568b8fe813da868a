//! The reduced model of seal seats; beside a stored reference it runs on the reference's very mesh.

use super::{Compared, ReducedModels};
use crate::body::cache::Cache;
use crate::cli::Context;
use crate::cli::progress::Bar;
use crate::cli::requested_model::{ModelRequest, RequestedModel};
use crate::error::Result;
use crate::kinds::SharedBodies;
use crate::kinds::seal_seat::{DEFAULT_TOLERANCE, SeatMesh, SeatModel};
use crate::reference::{self, Resolution, Stored};
use crate::report::Cost;
use crate::result::Outcome;
use crate::scene::{Model, Scene};
use std::path::PathBuf;

/// Model C.
pub(super) struct Seats;

impl ReducedModels for Seats {
    fn reduced(
        &self,
        context: &Context,
        scene: &Scene,
        request: &ModelRequest,
        _: &SharedBodies,
        _: bool,
    ) -> Result<Outcome> {
        let model = request.named(scene)?;
        let cache = Cache::from_environment();
        let bar = Bar::new(context, &scene.name);
        let mesh = SeatMesh::open(&mesh_of(scene, request, &cache, &bar)?)?;
        let reduced = SeatModel::new_with(scene, model, request.modes, &mesh, &cache, &mut |part, done| {
            bar.part(part, done)
        })?;
        drop(bar);
        context.note(format_args!(
            "mesh {}, {} degrees of freedom; set up in {:.2} s",
            mesh.path().display(),
            reduced.dofs,
            reduced.setup_seconds
        ));
        let tolerance = self.tolerance(request)?;
        reduced.run_with_history(tolerance)
    }

    fn tolerance(&self, request: &ModelRequest) -> Result<f64> {
        request.integration_tolerance(DEFAULT_TOLERANCE)
    }

    fn files(
        &self,
        context: &Context,
        scene: &Scene,
        request: &ModelRequest,
    ) -> Result<Vec<(String, PathBuf)>> {
        let bar = Bar::new(context, &scene.name);
        let mesh = mesh_of(scene, request, &Cache::from_environment(), &bar)?;
        Ok(vec![(impactcheck_fmu::SEAT_MESH.into(), mesh)])
    }

    fn shares_mesh(&self) -> bool {
        true
    }

    fn takes(&self, _: &Scene, model: Model) -> bool {
        model == Model::C
    }

    fn alone(&self, _: &Scene, _: (&[RequestedModel], Option<f64>)) -> Result<Vec<Outcome>> {
        Ok(Vec::new())
    }

    fn with_reference(
        &self,
        context: &Context,
        scene: &Scene,
        stored: &Stored,
        (models, _): (&[RequestedModel], Option<f64>),
    ) -> Result<Compared> {
        if !models.contains(&RequestedModel::Named(Model::C)) {
            return Ok(Compared::default());
        }
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
}

/// The mesh that `request` names, or the one of the seat of `scene`.
fn mesh_of(scene: &Scene, request: &ModelRequest, cache: &Cache, bar: &Bar) -> Result<PathBuf> {
    match &request.mesh {
        Some(path) => Ok(path.clone()),
        None => reference::seat_mesh_with(scene, Resolution::Paper, cache, &mut |step: &_| bar.show(step)),
    }
}
