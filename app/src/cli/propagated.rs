//! How results scatter with the inputs of a scene that is compared.

use super::Context;
use super::progress::Counter;
use crate::error::Result;
use crate::result::Outcome;
use crate::scene::{Model, Scene, Template};
use crate::uncertainty::{PropagatedUncertainty, Request, study};
use std::collections::BTreeMap;
use std::path::Path;

/// Half width of the intervals of mean and standard deviation, over the latter, of what scatters: u_input to 5 %.
const PROPAGATION_ACCURACY: f64 = 0.05;

/// How the results of the models that are compared, and of model C, scatter if the scene says how uncertain its inputs are; by name.
pub(super) fn propagate(
    context: &Context,
    file: &Path,
    scene: &Scene,
    reduced: &[Outcome],
) -> Result<BTreeMap<String, PropagatedUncertainty>> {
    if scene.uncertainty.is_none() {
        return Ok(BTreeMap::new());
    }
    let template = Template::read(file)?;
    let mut propagations = BTreeMap::new();
    for model in [Model::A, Model::B, Model::C] {
        let name = model.to_string();
        let mut summaries = reduced.iter().map(|outcome| &outcome.summary);
        let compared = summaries.find(|summary| summary.model.as_ref() == Some(&name));
        if compared.is_none() && model != Model::C {
            continue;
        }
        let counter =
            Counter::new(context, &format!("{}: propagated input uncertainty, model {name}", scene.name));
        let request = Request {
            modes: compared.and_then(|summary| summary.modes),
            ..Request::new(model, PROPAGATION_ACCURACY)
        };
        let found = study((file, &template), &request, None, &|progress| counter.show(progress))?;
        counter.finish();
        propagations.insert(name, found);
    }
    Ok(propagations)
}
