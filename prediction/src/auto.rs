//! `auto`: the simplest reduced model that is predicted to be within a tolerance of a reference.
//!
//! Model C runs first, as it is by default. The predicted error of a simpler model is its difference from model C plus the predicted error
//! of model C.

use super::{LEVEL, predicted_errors, scale};
use impactcheck_physics::dynamics::error_control::LOW_ACCURACY;
use impactcheck_physics::error::Result;
use impactcheck_physics::result::{CandidateModel, Choice, Summary};
use impactcheck_physics::scene::{Model, Scene};
use std::collections::BTreeMap;

/// Tolerance when the user names none.
pub const DEFAULT_TOLERANCE: f64 = 0.01;
/// Share of the tolerance that the time integration may take.
const INTEGRATION: f64 = 0.003;
/// Quantities that a tolerance covers. Times of release and numbers of contacts are not covered: a contact that just closes once more
/// changes them by a jump.
pub const COVERED: [&str; 4] = ["efficiency", "outer_velocity_final", "outer_force_peak", "inner_force_peak"];
/// A model and its number of modes; `None`: as many as the model takes by itself.
pub type Candidate = (Model, Option<usize>);

/// Relative tolerance of the time integration for a tolerance of `auto`.
pub fn integration_tolerance(tolerance: f64) -> f64 {
    // above this many contacts amplify the error
    (INTEGRATION * tolerance).min(LOW_ACCURACY)
}

/// The model of `scene` for a relative `tolerance`, and why; `run` gives the result of a model.
///
/// # Errors
/// That of model C, if no other model runs.
pub fn choose(
    scene: &Scene,
    tolerance: f64,
    run: impl Fn(Candidate) -> Result<Summary>,
) -> Result<(Candidate, Choice)> {
    let choice = |tried: Vec<CandidateModel>, (estimated_error, met), reason: String| Choice {
        tolerance,
        covers: COVERED.map(str::to_owned).to_vec(),
        estimated_error,
        coverage: LEVEL,
        met,
        tried,
        reason,
    };
    let continuum = match run((Model::C, None)) {
        Ok(continuum) => continuum,
        Err(error) => {
            let simpler = (Model::B, None);
            let Ok(Summary { modes, .. }) = run(simpler) else { return Err(error) };
            let tried = vec![candidate(simpler.0, modes.unwrap_or(0), None)];
            let reason = format!("model B is taken without an estimate: model C does not run ({error})");
            return Ok((simpler, choice(chosen(tried), (None, false), reason)));
        }
    };
    let modes = continuum.modes.unwrap_or(0);
    let own = match predicted_errors(scene, &continuum) {
        Ok(own) => own,
        Err(reason) => {
            let tried = vec![candidate(Model::C, modes, None)];
            let reason = format!("model C is taken without an estimate: {reason}");
            return Ok(((Model::C, None), choice(chosen(tried), (None, false), reason)));
        }
    };
    let exact = |name: &str| continuum.value(name);
    let judge = Judge { continuum: &exact, own: &own, speed: super::impact_speed(scene) };
    let mut tried = Vec::new();
    let mut modes_of_b = None;
    for model in [Model::A, Model::B, Model::B] {
        // model B once more with twice as many modes
        let Ok(summary) = run((model, modes_of_b.map(|modes: usize| 2 * modes))) else { continue };
        let modes = summary.modes.unwrap_or(0);
        if model == Model::B {
            modes_of_b = Some(modes);
        }
        let error = judge.largest(|name| summary.value(name));
        tried.push(candidate(model, modes, error));
        if let Some((error, _)) = error.filter(|(error, _)| *error <= tolerance) {
            let reason =
                format!("model {model} is the simplest one that is predicted to be within the tolerance");
            return Ok(((model, Some(modes)), choice(chosen(tried), (Some(error), true), reason)));
        }
    }
    let error = judge.largest(exact);
    tried.push(candidate(Model::C, modes, error));
    let met = error.is_some_and(|(error, _)| error <= tolerance);
    let reason = match error {
        Some(_) if met => "model C is the only one that is predicted to be within the tolerance",
        Some(_) => "no reduced model is predicted to be within the tolerance: model C is nearest",
        None => "model C is taken without an estimate: too few references determine the quantities",
    };
    Ok(((Model::C, None), choice(chosen(tried), (error.map(|(error, _)| error), met), reason.to_owned())))
}

/// What models of a scene are judged by.
pub struct Judge<'a> {
    /// Values of model C, SI.
    pub continuum: &'a dyn Fn(&str) -> Option<f64>,
    /// Predicted errors of model C, relative as [`scale`] has it.
    pub own: &'a BTreeMap<&'static str, f64>,
    /// Of the impact, m/s.
    pub speed: f64,
}

impl Judge<'_> {
    /// Error predicted of the quantity `name` for a model with these values, relative; `None` if it is not determined.
    pub fn error(&self, name: &str, value: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
        let own = self.own.get(name)?;
        let scale = scale(name, self.continuum, self.speed).filter(|scale| *scale > 0.0)?;
        Some(((value(name)? - (self.continuum)(name)?) / scale).abs() + own)
    }

    /// The largest of the quantities [`COVERED`], and which that is; `None` if one is not determined.
    pub fn largest(&self, value: impl Fn(&str) -> Option<f64>) -> Option<(f64, &'static str)> {
        // nothing is relative to what is negligible
        let matters = |name: &&'static str| scale(name, self.continuum, self.speed).is_some();
        let covered = COVERED.into_iter().filter(matters);
        let errors: Option<Vec<_>> = covered.map(|name| Some((self.error(name, &value)?, name))).collect();
        errors?.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))
    }
}

fn candidate(model: Model, modes: usize, error: Option<(f64, &str)>) -> CandidateModel {
    CandidateModel {
        model: model.to_string(),
        modes,
        estimated_error: error.map(|(error, _)| error),
        quantity: error.map(|(_, quantity)| quantity.to_owned()),
        chosen: false,
    }
}

/// With the last one marked.
fn chosen(mut tried: Vec<CandidateModel>) -> Vec<CandidateModel> {
    if let Some(last) = tried.last_mut() {
        last.chosen = true;
    }
    tried
}
