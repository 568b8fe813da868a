//! `auto`: the cheapest reduced model whose estimated error meets a tolerance, before any continuum is meshed.
//!
//! What models A and B lack is estimated by solving the impact once more with the plate as an elastic layer ([`Trials`]). The
//! same layer with fewer modes tells how many model C needs. A candidate's estimated error is
//!
//!   sqrt((safety |candidate - layer| + truncation)^2 + floor^2)
//!
//! with the error that model C itself was found to have against the finite-element reference as the floor.

use super::errors::{COVERED, largest_error};
use super::rough::Rough;
use super::trials::{Cut, RUNGS, Trials};
use super::validity;
use crate::body::layer::Waves;
use crate::dynamics::integrator::Options;
use crate::error::Result;
use crate::result::{Candidate, Choice, PlateQuantities};
use crate::scene::{Model, Scene};

/// Tolerance of `auto` when the user names none.
pub const DEFAULT_TOLERANCE: f64 = 0.01;
/// Share of the tolerance that is left to the time integration.
const INTEGRATION_SHARE: f64 = 0.01;
/// Error over the difference to the layer, which is mostly within a tenth of what it corrects.
const SAFETY: f64 = 1.15;
/// Truncation error, relative to the tolerance, at which the layer's own modes end.
const REFERENCE_SHARE: f64 = 0.05;
/// Share of the contacts' flexibility, relative to the tolerance, below which more Kirchhoff modes don't help.
const LEFT_OUT_SHARE: f64 = 0.25;
/// Numbers of Kirchhoff modes tried: model A and then B.
const KIRCHHOFF_RUNGS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];

/// The choice, and what is known by then of the model chosen.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    pub(super) choice: Choice,
    pub(super) model: Model,
    /// Kirchhoff modes, of models A and B.
    pub(super) modes: usize,
    /// Of model C.
    pub(super) cut: Option<Cut>,
    pub(super) rough: Rough,
    /// Kirchhoff's plate in closed form: models A and B need no eigenproblem any more.
    pub(super) waves: Waves,
    /// A or B with the smallest estimated error, if model C can't be set up.
    pub(super) second: Option<(Model, usize, f64)>,
}

/// Relative tolerance of the time integration for a tolerance of `auto`.
pub fn integration_tolerance(tolerance: f64) -> f64 {
    (INTEGRATION_SHARE * tolerance).min(1e-3)
}

/// Plans `auto` for `scene`.
///
/// # Errors
/// As [`crate::kinds::plate_impact::reduced::Reduced::new`].
pub(super) fn plan(scene: &Scene, tolerance: f64) -> Result<Plan> {
    let setup = scene.plate_impact()?;
    let options = Options {
        tolerance: integration_tolerance(tolerance),
        end_time: scene.run.end_time,
        sample_interval: None,
    };
    let trials = Trials::new(setup, REFERENCE_SHARE * tolerance, options)?;
    let reference = trials.continuum(trials.waves.modes()).ok();
    let mut search = Search {
        floor: validity::measured_error(trials.rough.patch_radius, setup.plate.thickness),
        tolerance,
        tried: Vec::new(),
    };
    let kirchhoff = search.kirchhoff(&trials, reference.as_ref());
    if let Some((model, modes, error)) = kirchhoff.filter(|(_, _, error)| *error <= tolerance) {
        return Ok(search.plan(trials, model, modes, None, Some(error), None));
    }
    let (modes, error) = search.continuum(&trials, reference.as_ref());
    let cut = trials.cut(modes);
    Ok(search.plan(trials, Model::C, modes, Some(cut), error, kirchhoff))
}

/// The search for the cheapest.
struct Search {
    floor: Option<f64>,
    tolerance: f64,
    tried: Vec<Candidate>,
}

impl Search {
    /// Tries models A and B until one meets the tolerance, or more modes don't help; the best with its estimate.
    fn kirchhoff(
        &mut self,
        trials: &Trials,
        reference: Option<&PlateQuantities>,
    ) -> Option<(Model, usize, f64)> {
        let mut best: Option<(Model, usize, f64)> = None;
        for modes in KIRCHHOFF_RUNGS.into_iter().take_while(|n| *n <= trials.waves.modes()) {
            let model = if modes == 1 { Model::A } else { Model::B };
            let difference = match (reference, trials.kirchhoff(modes)) {
                (Some(exact), Ok(ours)) => Some(largest_error(&ours, exact, trials.setup.outer.speed)),
                _ => None,
            };
            let error = difference.and_then(|(error, _)| self.total(SAFETY * error));
            self.note(model, modes, error, difference.map(|(_, name)| name));
            let Some(error) = error else { break };
            if best.is_none_or(|(.., least)| error < least) {
                best = Some((model, modes, error));
            }
            if error <= self.tolerance || trials.left_out(modes) < LEFT_OUT_SHARE * self.tolerance {
                break;
            }
        }
        best
    }

    /// The smallest number of bending modes of model C that is enough, at most `most`, by bisection, and its estimate.
    fn continuum(&mut self, trials: &Trials, reference: Option<&PlateQuantities>) -> (usize, Option<f64>) {
        let most = trials.waves.modes();
        let floor = self.floor.unwrap_or(self.tolerance);
        // what the floor leaves; where it leaves nothing, so much that the modes hardly matter beside it
        let room = match floor < self.tolerance {
            true => (self.tolerance.powi(2) - floor.powi(2)).sqrt(),
            false => 0.5 * floor,
        };
        // without the modes of the contact's own frequency nothing is right
        let rungs: Vec<usize> =
            RUNGS.into_iter().filter(|n| *n == most || *n < most && trials.truncation(*n) <= 1.0).collect();
        let mut attempt = |modes: usize| {
            let (truncated, quantity) = trials.truncated(modes, reference);
            let error = self.total(truncated);
            self.note(Model::C, modes, error, quantity);
            (truncated <= room, error)
        };
        let (mut low, mut high) = (0, rungs.len() - 1);
        let mut found = None;
        while low < high {
            let middle = (low + high) / 2;
            match attempt(rungs[middle]) {
                (true, error) => (high, found) = (middle, Some(error)),
                (false, _) => low = middle + 1,
            }
        }
        let error = found.unwrap_or_else(|| attempt(rungs[high]).1);
        self.tried.sort_by(|a, b| (&a.model, a.modes).cmp(&(&b.model, b.modes)));
        (rungs[high], error)
    }

    /// An error with the floor; `None` where there is none.
    fn total(&self, error: f64) -> Option<f64> {
        self.floor.map(|floor| error.hypot(floor)).filter(|error| error.is_finite())
    }

    fn note(&mut self, model: Model, modes: usize, error: Option<f64>, quantity: Option<&str>) {
        self.tried.push(Candidate {
            model: model.to_string(),
            modes,
            estimated_error: error,
            quantity: quantity.map(str::to_owned),
            chosen: false,
        });
    }

    fn plan(
        self,
        trials: Trials,
        model: Model,
        modes: usize,
        cut: Option<Cut>,
        error: Option<f64>,
        second: Option<(Model, usize, f64)>,
    ) -> Plan {
        let met = error.is_some_and(|error| error <= self.tolerance);
        let reason = match (error, self.floor) {
            (Some(_), _) if met => {
                format!("model {model} is the cheapest whose estimated error meets the tolerance")
            }
            (Some(error), Some(floor)) => format!(
                "no reduced model is estimated to meet the tolerance: model {model} comes nearest with {:.2} %, {:.2} % of which are what model C was found to be off by",
                100.0 * error,
                100.0 * floor
            ),
            _ => format!(
                "model {model} is taken without an estimate: the contact patches are wider, over the plate's thickness, than any that were compared with the reference"
            ),
        };
        let choice = Choice {
            tolerance: self.tolerance,
            covers: COVERED.map(str::to_owned).to_vec(),
            estimated_error: error,
            floor: self.floor,
            met,
            tried: self.tried,
            reason,
        };
        let Trials { rough, waves, .. } = trials;
        let mut plan = Plan { choice, model, modes, cut, rough, waves, second };
        plan.mark();
        plan
    }
}

impl Plan {
    /// Marks the candidate that is chosen.
    fn mark(&mut self) {
        let model = self.model.to_string();
        for candidate in &mut self.choice.tried {
            candidate.chosen = candidate.model == model && candidate.modes == self.modes;
        }
    }

    /// The plan without model C, which can't be set up as `error` says; `None` if there is nothing else.
    pub(super) fn without_continuum(mut self, error: &crate::Error) -> Option<Self> {
        let (model, modes, estimate) = self.second?;
        self.choice.estimated_error = Some(estimate);
        self.choice.met = false;
        self.choice.reason = format!(
            "model C can't be set up ({error}); model {model} with {modes} modes comes nearest with an estimated error of {:.2} %",
            100.0 * estimate
        );
        (self.model, self.modes, self.cut, self.second) = (model, modes, None, None);
        self.mark();
        Some(self)
    }
}
