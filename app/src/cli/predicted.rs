//! What a converged reference would find, with the result of a reduced model.

use super::requested_model::{ModelRequest, RequestedModel};
use super::{Context, kinds};
use crate::kinds::SharedBodies;
use crate::prediction::{self, Interval, Prediction, Similarity};
use crate::result::Summary;
use crate::scene::{Model, Scene};
use serde::Serialize;
use std::collections::BTreeMap;

/// What a reference of `scene` would find. Model C runs for it as it is by default, unless `summary` is its own.
pub(super) fn predicted(
    context: &Context,
    scene: &Scene,
    request: &ModelRequest,
    summary: &Summary,
) -> Prediction {
    let default = ModelRequest { model: Some(RequestedModel::Named(Model::C)), ..ModelRequest::default() };
    let is_default = request.modes.or(scene.reduced.modes).is_none() && request.tolerance.is_none();
    let is_continuum = is_default && summary.choice.is_none() && summary.model == Some(Model::C.to_string());
    // what it says of its mesh is said once
    let quiet = Context { quiet: true, ..context.clone() };
    prediction::predict_of_any(scene, (summary, is_continuum), |scene| {
        let bodies = SharedBodies::default();
        Ok(kinds::of(scene).reduced(&quiet, scene, &default, &bodies, false)?.summary)
    })
}

/// A summary, and what a converged reference would find.
#[derive(Debug, Serialize)]
pub struct PredictedSummary<'a> {
    #[serde(flatten)]
    pub(super) summary: &'a Summary,
    pub(super) prediction: Option<&'a BTreeMap<&'static str, Interval>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    prediction_reason: Option<&'a String>,
    /// What makes the scene similar to others, of model C.
    #[serde(skip_serializing_if = "Option::is_none")]
    similarity: Option<Similarity>,
}

impl<'a> PredictedSummary<'a> {
    /// Both together, of `scene`.
    pub fn of(scene: &Scene, summary: &'a Summary, prediction: &'a Prediction) -> Self {
        let is_continuum = summary.model == Some(Model::C.to_string());
        Self {
            summary,
            prediction: prediction.as_ref().ok(),
            prediction_reason: prediction.as_ref().err(),
            similarity: is_continuum.then(|| Similarity::of(scene, summary).ok()).flatten(),
        }
    }
}
