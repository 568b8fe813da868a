//! The reduced models of plate impacts.

use super::{Compared, DEFAULT_TOLERANCE, ReducedModels};
use crate::cli::requested_model::ModelRequest;
use crate::cli::requested_model::{self, RequestedModel};
use crate::cli::{Context, progress};
use crate::curves::CommonAxis;
use crate::error::{Error, Result};
use crate::kinds::SharedBodies;
use crate::kinds::plate_impact::reduced::Reduced;
use crate::prediction::auto;
use crate::reference::Stored;
use crate::result::Outcome;
use crate::scene::{Model, Scene};
use std::time::Instant;

/// Relative error of the efficiency that the time integration may have in a comparison.
const COMPARISON_TOLERANCE: f64 = 1e-7;

/// Models A, B and C.
pub(super) struct Plates;

impl ReducedModels for Plates {
    fn reduced(
        &self,
        _: &Context,
        scene: &Scene,
        request: &ModelRequest,
        bodies: &SharedBodies,
        curves: bool,
    ) -> Result<Outcome> {
        if let Some(mesh) = &request.mesh {
            return Err(Error::Usage(format!(
                "--mesh {}: scene `{}` is no seal seat; the models of plates make their own meshes",
                mesh.display(),
                scene.name
            )));
        }
        let default = RequestedModel::Named(scene.reduced.model.unwrap_or(Model::C));
        let (reduced, tolerance) = match request.model.unwrap_or(default) {
            RequestedModel::Named(model) => {
                (Reduced::in_series(scene.clone(), model, request.modes, bodies)?, self.tolerance(request)?)
            }
            RequestedModel::External => return Err(requested_model::needs_a_reference()),
            RequestedModel::Auto => {
                if let Some(modes) = request.modes {
                    return Err(Error::Usage(format!(
                        "--modes {modes}: --model auto chooses the number of modes"
                    )));
                }
                let tolerance = request.tolerance.unwrap_or(auto::DEFAULT_TOLERANCE);
                (chosen(scene, tolerance, bodies)?, self.tolerance(request)?)
            }
        };
        if curves { reduced.run_with_history(tolerance) } else { reduced.run_judged(tolerance) }
    }

    fn tolerance(&self, request: &ModelRequest) -> Result<f64> {
        match request.model {
            Some(RequestedModel::Auto) => {
                Ok(auto::integration_tolerance(request.tolerance.unwrap_or(auto::DEFAULT_TOLERANCE)))
            }
            _ => request.integration_tolerance(DEFAULT_TOLERANCE),
        }
    }

    fn alone(
        &self,
        scene: &Scene,
        (models, tolerance): (&[RequestedModel], Option<f64>),
    ) -> Result<Vec<Outcome>> {
        let models = set_up(scene, &having(scene, models, |_| ()), tolerance)?;
        models.into_iter().map(|(body, _)| body.run_with_history(COMPARISON_TOLERANCE)).collect()
    }

    fn with_reference(
        &self,
        context: &Context,
        scene: &Scene,
        stored: &Stored,
        (models, tolerance): (&[RequestedModel], Option<f64>),
    ) -> Result<Compared> {
        // the models' curves are drawn and compared as far as the reference's
        let end = CommonAxis::of_reference(&stored.outcome).map_or(0.0, |axis| axis.end);
        let models = having(scene, models, |error| context.note(format_args!("{}: {error}", scene.name)));
        let models = set_up(scene, &models, tolerance)?;
        let outcomes = models.into_iter().map(|(body, set_up)| {
            let outcome = progress::watched(context, &scene.name, || {
                body.run_with_history_until(COMPARISON_TOLERANCE, end)
            })?;
            context.detail(format_args!(
                "{}: model {} set up in {:.1} ms, run in {:.2} ms",
                scene.name,
                body.model(),
                1e3 * set_up,
                1e3 * outcome.summary.solve_seconds
            ));
            if let Some(choice) = &outcome.summary.choice {
                let in_words = requested_model::choice_in_words(choice);
                context.note(format_args!("{}: model {}, {in_words}", scene.name, body.model()));
            }
            Ok(outcome)
        });
        Ok((outcomes.collect::<Result<_>>()?, Vec::new()))
    }
}

/// The model of `scene` that `auto` chooses for `tolerance`.
fn chosen(scene: &Scene, tolerance: f64, bodies: &SharedBodies) -> Result<Reduced> {
    let of = |(model, modes)| {
        let mut scene = scene.clone();
        scene.reduced.modes = None;
        Reduced::in_series(scene, model, modes, bodies)
    };
    let run = |candidate| of(candidate)?.run(auto::integration_tolerance(tolerance));
    let (candidate, choice) = auto::choose(scene, tolerance, run)?;
    Ok(of(candidate)?.chosen(choice))
}

/// Those of `models` that have a form for `scene`; `omitted` gets the reasons of the others. All if none has: running them gives the reason.
fn having(scene: &Scene, models: &[RequestedModel], omitted: impl Fn(&Error)) -> Vec<RequestedModel> {
    let refused = |request: &RequestedModel| match request {
        RequestedModel::Named(model) => Reduced::require(scene, *model).err(),
        RequestedModel::Auto | RequestedModel::External => None,
    };
    let supported: Vec<RequestedModel> =
        models.iter().copied().filter(|request| refused(request).is_none()).collect();
    if supported.is_empty() {
        return models.to_vec();
    }
    models.iter().filter_map(refused).for_each(|error| omitted(&error));
    supported
}

/// The `models` of `scene`, each once, in the order asked for, with the time in s that each took to set up. A model that is
/// named and also chosen by auto is compared as auto chose it.
fn set_up(scene: &Scene, models: &[RequestedModel], tolerance: Option<f64>) -> Result<Vec<(Reduced, f64)>> {
    let timed = |set_up: &dyn Fn() -> Result<Reduced>| {
        let start = Instant::now();
        set_up().map(|body| (body, start.elapsed().as_secs_f64()))
    };
    let mut auto = None;
    if models.contains(&RequestedModel::Auto) {
        let tolerance = tolerance.unwrap_or(auto::DEFAULT_TOLERANCE);
        auto = Some(timed(&|| chosen(scene, tolerance, &SharedBodies::default()))?);
    }
    let named = auto.as_ref().map(|(body, _)| body.model());
    let mut done = Vec::new();
    let mut bodies = Vec::new();
    for request in models {
        match *request {
            RequestedModel::Auto => bodies.extend(auto.take()),
            RequestedModel::Named(model) if named != Some(model) && !done.contains(&model) => {
                done.push(model);
                bodies.push(timed(&|| Reduced::new(scene, model, None))?);
            }
            RequestedModel::Named(_) | RequestedModel::External => {}
        }
    }
    Ok(bodies)
}
