//! How the commands run the reduced models of each kind of scene.

mod plate_impact;
mod seal_seat;

use super::Context;
use super::requested_model::ModelRequest;
use super::requested_model::RequestedModel;
use crate::error::{Error, Result};
use crate::kinds::{self, Kind, SharedBodies};
use crate::reference::{self, Stored};
use crate::report::Cost;
use crate::result::Outcome;
use crate::scene::{Model, Scene};
use std::path::PathBuf;

/// Relative error of the time integration when the caller names none.
const DEFAULT_TOLERANCE: f64 = 1e-7;

/// Results of the models, and what they have cost if they share a mesh with the reference.
pub(super) type Compared = (Vec<Outcome>, Vec<Cost>);

/// The reduced models of a kind of scene.
pub(super) trait ReducedModels: Sync {
    /// Runs the model that is `request` for, the scene's or the kind's last one if none is, one of a series of impacts that share `bodies`; without `curves` its history has no more
    /// samples than its limits need.
    ///
    /// # Errors
    /// Those of the arguments and of the model.
    fn reduced(
        &self,
        _: &Context,
        scene: &Scene,
        request: &ModelRequest,
        _bodies: &SharedBodies,
        _curves: bool,
    ) -> Result<Outcome> {
        if let Some(mesh) = &request.mesh {
            let mesh = mesh.display();
            return Err(Error::Usage(format!("--mesh {mesh}: the models of `{}` have no mesh", scene.name)));
        }
        let model = request.named(scene)?;
        let tolerance = self.tolerance(request)?;
        kinds::of(scene).model(scene, model, request.modes)?.run_with_history(tolerance)
    }

    /// Relative error of the time integration that `request` asks for.
    ///
    /// # Errors
    /// As [`ModelRequest::integration_tolerance`].
    fn tolerance(&self, request: &ModelRequest) -> Result<f64> {
        request.integration_tolerance(DEFAULT_TOLERANCE)
    }

    /// The files that the models of `scene` read, under the names that a unit for co-simulation finds them by.
    ///
    /// # Errors
    /// Those of the mesher.
    fn files(&self, _: &Context, scene: &Scene, _: &ModelRequest) -> Result<Vec<(String, PathBuf)>> {
        let mut files = Vec::new();
        for request in kinds::of(scene).mesh_requests(scene) {
            let own = request.factor == 1.0;
            let mesh = match reference::body_mesh(&request) {
                // without the coarser mesh the error by the mesh is not known, and that is warned of
                Err(_) if !own => continue,
                mesh => mesh?,
            };
            for extension in ["vtu", "json"] {
                let name = format!("{}/{}.{extension}", impactcheck_fmu::MESHES, request.key);
                files.push((name, mesh.with_extension(extension)));
            }
        }
        Ok(files)
    }

    /// Whether [`ReducedModels::with_reference`] solves on the very mesh of the reference.
    fn shares_mesh(&self) -> bool {
        false
    }

    /// Whether `model` takes `scene`.
    fn takes(&self, scene: &Scene, model: Model) -> bool {
        kinds::of(scene).model(scene, model, None).is_ok()
    }

    /// Runs the models `request` for, with the tolerance of `auto`, without a reference; none if they need its mesh.
    ///
    /// # Errors
    /// Those of the models.
    fn alone(&self, scene: &Scene, (models, _): (&[RequestedModel], Option<f64>)) -> Result<Vec<Outcome>> {
        let kind = kinds::of(scene);
        let own = kind.models().iter().filter(|model| models.contains(&RequestedModel::Named(**model)));
        own.map(|model| kind.model(scene, *model, None)?.run_with_history(DEFAULT_TOLERANCE)).collect()
    }

    /// Runs those of the models `request` for that there are, with the tolerance of `auto`, compared with a reference.
    ///
    /// # Errors
    /// Those of the models.
    fn with_reference(
        &self,
        _: &Context,
        scene: &Scene,
        _: &Stored,
        request: (&[RequestedModel], Option<f64>),
    ) -> Result<Compared> {
        Ok((self.alone(scene, request)?, Vec::new()))
    }
}

/// Models that need nothing but the scene.
struct Plain;

impl ReducedModels for Plain {}

/// The kinds whose models need more than the scene: a mesh, or bodies that several of them share.
const MODELS: [(&dyn Kind, &dyn ReducedModels); 2] =
    [(&kinds::plate_impact::Kind, &plate_impact::Plates), (&kinds::seal_seat::Kind, &seal_seat::Seats)];

/// The models of `scene`.
pub(super) fn of(scene: &Scene) -> &'static dyn ReducedModels {
    let name = kinds::of(scene).name();
    MODELS.iter().find(|(kind, _)| kind.name() == name).map_or(&Plain, |(_, models)| *models)
}

/// Whether one of the models `request` for is one of `scene`; `auto` chooses among several.
pub(super) fn has_one_of(scene: &Scene, request: &[RequestedModel]) -> bool {
    let own = kinds::of(scene).models();
    request.iter().any(|request| match request {
        RequestedModel::Named(model) => own.contains(model),
        RequestedModel::Auto => own.len() > 1,
        RequestedModel::External => !scene.external.is_empty(),
    })
}
