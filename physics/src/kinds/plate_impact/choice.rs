//! `auto`: the cheapest reduced model whose estimated error meets a tolerance, before any continuum is meshed.
//!
//! Where the plate has a closed form (`closed_form`) but no number of its modes is enough at a glance, trial impacts tell.
//!
//! What models A and B lack is estimated by solving the impact once more with spheres that yield as theirs do, which has a closed
//! form too, and once more with the plate as an elastic layer besides (`trials`). Their estimated error is
//!
//!   sqrt((spheres |candidate - yielding| + safety |yielding - layer| + share |all Kirchhoff modes - layer|
//!         + undamped)^2 + floor^2)
//!
//! with the share of what the layer corrects that it may itself be off by, the damping under the contacts that models with few
//! modes lack, and the error that model C was found to have against the finite-element reference as the floor. The same layer
//! with fewer modes tells how many model C needs; built, model C is compared with itself with fewer modes (`truncation`), and
//! has more of them where that finds too large an error. Of a thick plate the layer says little: model C alone is asked.

use super::assembled::Cut;
use super::closed_form;
use super::errors::{COVERED, estimated_percent};
use super::results::PlateQuantities;
use super::trials::{HALF_SPACES, RUNGS, Trials, TruncationError};
use super::truncation::{by_fewer_modes, of_continuum};
use super::validity;
use crate::body::bending;
use crate::dynamics::error_control;
use crate::dynamics::integration::Options;
use crate::dynamics::system::System;
use crate::error::{Error, Result};
use crate::result::{CandidateModel, Choice};
use crate::scene::{Edge, Model, Scene};

/// Tolerance of `auto` when the user names none.
pub const DEFAULT_TOLERANCE: f64 = 0.01;
/// Share of the tolerance that is left to the time integration.
const INTEGRATION_SHARE: f64 = 0.003;
/// Error of models A and B over the difference of their plate to the layer, of a thin plate and per thickness over radius up to that of a
/// thick one: of 776 promises on 7600 scenes that it was not calibrated on two were broken, by a fifth at most.
const SAFETY: [f64; 2] = [1.5, 8.0];
/// What is added to it per fourth power of thickness over radius: the layer has no longitudinal modes.
const LONGITUDINAL: f64 = 1.5;
/// Error of models A and B over what spheres that yield as theirs do change: where that is most of it, they were off by 1.12 of it at most.
const SPHERES: f64 = 1.25;
/// Error over what model C is estimated to lack, of a thin plate and per thickness over radius, in an impact of single touches.
const BUILT_SAFETY: [f64; 2] = [3.0, 2.0];
/// The same of a thick plate over what an eighth to half of its modes change.
const SELF_SAFETY: f64 = 1.5;
/// Modes that model C of a thick plate is built with first.
const FIRST_BUILT: usize = 8;
/// Share of what the layer corrects of Kirchhoff's plate that it may be off by, of a thin plate and per thickness over radius:
/// it does not know what shear does at the rim.
const LAYER_SHARE: [f64; 2] = [0.5, 6.0];
/// Error of Kirchhoff's simply supported plate over (thickness over radius / (1 + nu))^2: the rim's resistance to turning, which
/// the layer does not know either, is felt where bending into a paraboloid costs next to nothing.
const RIM: f64 = 0.03;
/// Truncation error, relative to the tolerance, at which the layer's own modes end.
const REFERENCE_SHARE: f64 = 0.05;
/// Share of the contacts' flexibility, relative to the tolerance, below which more Kirchhoff modes don't help.
const TRUNCATED_SHARE: f64 = 0.25;
/// Patch radius over the plate's thickness up to which the estimate is a promise: of 1400 random scenes 3 of 32 promises were
/// broken beyond, 6 of 3027 up to there.
pub(super) const STATED_ACCURACY: f64 = 0.9;
/// Fewest bending modes that model C is taken with: compared with itself with more or fewer, it would agree by chance too often.
pub(super) const LEAST: usize = 4;
/// Most modes that model C is built with when its first ones turn out to be too few.
const MOST_BUILT: usize = 128;
/// Share of promises that `study auto` finds to be kept on random scenes, at least (seeds 41 to 45, 200 scenes each; the guide has the
/// count).
pub const COVERAGE: f64 = 0.995;
/// Numbers of Kirchhoff modes tried: model A and then B.
const KIRCHHOFF_RUNGS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];

/// A model with its number of modes and estimated error.
type Rated = (Model, usize, f64);

/// The choice as far as it has come.
pub(super) struct ChoicePlan<'a> {
    tolerance: f64,
    /// What model C was found to be off by; `None` beyond what was measured.
    floor: Option<f64>,
    pub(super) trials: Trials<'a>,
    /// The impact on the layer with all its modes.
    layer: Option<PlateQuantities>,
    tried: Vec<CandidateModel>,
    pub(super) model: Model,
    /// Kirchhoff modes of models A and B, bending modes of model C.
    pub(super) modes: usize,
    /// The modes that model C is to be built with, unless it stands.
    pub(super) cut: Option<Cut>,
    /// Whether model C takes its plate in closed form.
    pub(super) closed_form: bool,
    error: Option<f64>,
    /// Estimated error of the plate of models A and B with any number of modes, if that is too large for them to be tried.
    hopeless: Option<f64>,
    /// A or B with the smallest estimated error, if model C can't be set up.
    second: Option<Rated>,
    /// Why model C can't be set up.
    refused: Option<String>,
}

/// Relative tolerance of the time integration for a tolerance of `auto`.
pub fn integration_tolerance(tolerance: f64) -> f64 {
    // above this no integration assures itself, and many contacts amplify what it is off by
    (INTEGRATION_SHARE * tolerance).min(error_control::LOW_ACCURACY)
}

impl<'a> ChoicePlan<'a> {
    /// Plans `auto` for `scene`: models A or B, or with which modes model C is to be built.
    ///
    /// # Errors
    /// As [`super::reduced::Reduced::new`].
    pub(super) fn new(scene: &'a Scene, tolerance: f64) -> Result<Self> {
        let setup = scene.plate_impact()?;
        let options = Options {
            tolerance: integration_tolerance(tolerance),
            end_time: scene.run.end_time,
            ..Options::default()
        };
        let trials = Trials::new(setup, REFERENCE_SHARE * tolerance, options)?;
        let (patch, thickness) = (trials.predictor.patch_radius, setup.plate.thickness);
        let wide = patch[0].max(patch[1]) > STATED_ACCURACY * thickness;
        let mut plan = Self {
            tolerance,
            floor: validity::measured_error(patch, thickness).filter(|_| !wide),
            layer: trials.continuum(trials.waves.modes()).ok(),
            trials,
            tried: Vec::new(),
            model: Model::C,
            modes: 0,
            cut: None,
            closed_form: false,
            error: None,
            hopeless: None,
            second: None,
            refused: None,
        };
        if plan.takes_closed_form() {
            return Ok(plan);
        }
        plan.second = plan.kirchhoff(tolerance);
        match plan.second.filter(|(.., error)| *error <= tolerance) {
            Some((model, modes, error)) => (plan.model, plan.modes, plan.error) = (model, modes, Some(error)),
            None if plan.is_thick() => plan.cut = Some(Cut { omega: f64::INFINITY, modes: FIRST_BUILT }),
            None => {
                (plan.modes, plan.error) = plan.continuum();
                plan.cut = Some(plan.trials.cut(plan.modes));
            }
        }
        Ok(plan)
    }

    /// Whether model C with its plate in closed form is estimated to be good enough: as cheap as models A and B.
    fn takes_closed_form(&mut self) -> bool {
        let setup = self.trials.setup;
        let dry = setup.fluid.is_none();
        if !dry || self.floor.is_none() || !closed_form::holds(setup, self.trials.predictor.patch_radius) {
            return false;
        }
        let (modes, error) = self.continuum();
        let (Some(layer), Ok(misshapen)) = (self.layer, self.trials.misshapen()) else { return false };
        let own =
            closed_form::BY_TWICE * TruncationError::between(&misshapen, &layer, setup.outer.speed).error;
        self.error = error.map(|error| error.hypot(own));
        if let Some(taken) = self.tried.iter_mut().find(|tried| tried.modes == modes) {
            taken.estimated_error = self.error;
        }
        // only a layer with twice as many modes tells
        let is_known = 2 * modes <= self.trials.waves.modes();
        self.closed_form = self.met() && is_known && bending::modes(&setup.plate, modes + 1).len() > modes;
        self.modes = modes;
        self.closed_form
    }

    /// Tries models A and B until one meets the tolerance, or more modes don't help; the best with its estimate. None is tried if their
    /// plate alone, with any number of modes, is estimated to be off by more than `bearable`.
    fn kirchhoff(&mut self, bearable: f64) -> Option<Rated> {
        let (layer, speed) = (self.layer?, self.trials.setup.outer.speed);
        let tips = self.trials.tips;
        let kirchhoff = self.trials.converged(tips).ok()?;
        let own = self.kirchhoff_error(&kirchhoff, &layer);
        let safety = self.by_thickness(SAFETY) + LONGITUDINAL * self.thickness_ratio().powi(4);
        self.hopeless = self.total(own).filter(|error| *error > bearable);
        if self.hopeless.is_some() {
            return None;
        }
        let most = self.trials.waves.modes();
        let mut best: Option<Rated> = None;
        for modes in KIRCHHOFF_RUNGS.into_iter().take_while(|n| *n <= most) {
            let model = if modes == 1 { Model::A } else { Model::B };
            let Ok(ours) = self.trials.kirchhoff(modes, HALF_SPACES) else { break };
            let compliant = if tips == HALF_SPACES { Ok(ours) } else { self.trials.kirchhoff(modes, tips) };
            let Ok(compliant) = compliant else { break };
            let spheres = TruncationError::between(&ours, &compliant, speed).times(SPHERES);
            let plate = TruncationError::between(&compliant, &layer, speed).times(safety);
            let error = self.total(spheres.error + plate.error + own);
            self.note(model, modes, error, spheres.or(plate).quantity);
            let Some(error) = error else { break };
            if best.is_none_or(|(.., least)| error < least) {
                best = Some((model, modes, error));
            }
            if error <= self.tolerance || self.trials.omitted(modes) < TRUNCATED_SHARE * self.tolerance {
                break;
            }
        }
        best
    }

    /// What Kirchhoff's plate, of which `kirchhoff` has all modes, may be off by beyond its difference to the `layer`, which is none itself.
    fn kirchhoff_error(&self, kirchhoff: &PlateQuantities, layer: &PlateQuantities) -> f64 {
        let Trials { setup, tips, .. } = self.trials;
        let truncation =
            |ours: &PlateQuantities| TruncationError::between(kirchhoff, ours, setup.outer.speed).error;
        let rim = match setup.plate.edge {
            Edge::SimplySupported => {
                let rim = (self.thickness_ratio() / (1.0 + setup.plate.material.poisson_ratio)).powi(2);
                // where the plate might as well not give way, its rim does not matter either
                let rigid = self.trials.kirchhoff(0, tips);
                rigid.map_or(f64::INFINITY, |rigid| truncation(&rigid)).min(RIM * rim)
            }
            Edge::Clamped | Edge::Free => 0.0,
        };
        // all of the force on an inner body that is not reached, if it almost is
        let missed = layer.inner_force_peak == 0.0 && self.trials.nearly_reach().unwrap_or(true);
        self.by_thickness(LAYER_SHARE) * truncation(layer) + rim + f64::from(u8::from(missed))
    }

    /// The smallest number of bending modes of model C that is enough, by bisection, and its estimate.
    fn continuum(&mut self) -> (usize, Option<f64>) {
        let most = self.trials.waves.modes();
        let floor = self.floor.unwrap_or(self.tolerance);
        // what the floor leaves; where it leaves nothing, so much that the modes hardly matter beside it
        let room = match floor < self.tolerance {
            true => (self.tolerance.powi(2) - floor.powi(2)).sqrt(),
            false => 0.5 * floor,
        };
        // without the modes of the contact's own frequency nothing is right
        let possible = |n: &usize| *n == most || *n < most && self.trials.truncation(*n) <= 1.0;
        let rungs: Vec<usize> = RUNGS.into_iter().filter(|n| *n >= LEAST && possible(n)).collect();
        let safety = self.safety();
        let mut attempt = |modes: usize| {
            let truncation = self.trials.truncated(modes, self.layer.as_ref());
            let error = self.total(safety * truncation.error);
            self.note(Model::C, modes, error, truncation.quantity);
            (safety * truncation.error <= room, error)
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
        (rungs[high], error)
    }

    /// Judges model C as it was built, with its next frequency at `omega_next` rad/s: either it stands, or [`Self::cut`] says
    /// what to build next.
    pub(super) fn judge(&mut self, built: &System, omega_next: f64) {
        self.modes = built.bending_modes();
        let options = &self.trials.options;
        let truncation = if self.is_thick() {
            by_fewer_modes(built, options, 4..8, |_| SELF_SAFETY)
        } else {
            let truncation = self.trials.truncated(self.modes, self.layer.as_ref());
            truncation.or(of_continuum(built, omega_next, options)).times(self.safety())
        };
        self.error = self.total(truncation.error);
        self.note(Model::C, self.modes, self.error, truncation.quantity);
        let more = 2 * built.modes;
        let possible = self.total(0.0).is_some_and(|least| least < self.tolerance);
        let helps = !self.met() && more <= MOST_BUILT && possible;
        self.cut = helps.then_some(Cut { omega: f64::INFINITY, modes: more });
    }

    /// Takes the best of models A and B, as model C can't be set up for the reason `error`.
    ///
    /// # Errors
    /// `error`, if there is nothing else.
    pub(super) fn without_continuum(&mut self, error: Error) -> Result<()> {
        let second = self.second.or_else(|| self.kirchhoff(f64::INFINITY));
        let Some((model, modes, estimate)) = second else { return Err(error) };
        self.refused = Some(error.to_string());
        (self.model, self.modes, self.error, self.cut) = (model, modes, Some(estimate), None);
        Ok(())
    }

    /// A factor from that of a thin plate and what it grows by per thickness over radius; of thick plates it grows no further.
    fn by_thickness(&self, [thin, more]: [f64; 2]) -> f64 {
        thin + more * self.thickness_ratio().min(closed_form::THICKEST)
    }

    /// Error over what model C is estimated to lack.
    fn safety(&self) -> f64 {
        self.by_thickness(BUILT_SAFETY) * closed_form::amplified(self.trials.predictor.repeated_contacts)
    }

    /// An error with what models with few modes lack and with the floor; `None` where that is not known.
    fn total(&self, error: f64) -> Option<f64> {
        let floor = self.floor?;
        Some((error + self.trials.predictor.undamped(&self.trials.setup.plate, 0.0)).hypot(floor))
            .filter(|error| error.is_finite())
    }

    /// Whether the layer says little of the plate: what model C needs it says itself.
    fn is_thick(&self) -> bool {
        self.thickness_ratio() > closed_form::THICKEST
    }

    /// Thickness over radius.
    fn thickness_ratio(&self) -> f64 {
        let plate = &self.trials.setup.plate;
        plate.thickness / plate.radius
    }

    fn met(&self) -> bool {
        self.error.is_some_and(|error| error <= self.tolerance)
    }

    /// Notes a candidate, in the place of an earlier estimate of it.
    fn note(&mut self, model: Model, modes: usize, error: Option<f64>, quantity: Option<&str>) {
        let model = model.to_string();
        self.tried.retain(|tried| tried.model != model || tried.modes != modes);
        let quantity = quantity.map(str::to_owned);
        self.tried.push(CandidateModel { model, modes, estimated_error: error, quantity, chosen: false });
    }

    /// What was chosen, from what, and why.
    pub(super) fn choice(&self) -> Choice {
        let model = self.model.to_string();
        let mut tried = self.tried.clone();
        tried.sort_by(|a, b| (&a.model, a.modes).cmp(&(&b.model, b.modes)));
        for candidate in &mut tried {
            candidate.chosen = candidate.model == model && candidate.modes == self.modes;
        }
        Choice {
            tolerance: self.tolerance,
            covers: COVERED.map(str::to_owned).to_vec(),
            estimated_error: self.error,
            coverage: COVERAGE,
            floor: self.floor,
            met: self.met(),
            tried,
            reason: self.reason(),
        }
    }

    fn reason(&self) -> String {
        let model = self.model;
        match (&self.refused, self.error, self.floor) {
            (Some(refused), Some(error), _) => format!(
                "model C can't be set up ({refused}); model {model} with {} modes comes nearest with an estimated error of {}",
                self.modes,
                estimated_percent(error)
            ),
            (_, Some(_), _) if self.closed_form => closed_form::REASON.to_owned(),
            (_, Some(_), _) if self.met() => {
                let alone = self.hopeless.map_or(String::new(), |error| {
                    format!(
                        "; Kirchhoff's plate has an estimated error of {} with any number of modes",
                        estimated_percent(error)
                    )
                });
                format!(
                    "model {model} is the least expensive one whose estimated error is within the tolerance{alone}"
                )
            }
            (_, Some(error), Some(floor)) => format!(
                "no reduced model is estimated to be within the tolerance: model {model} is nearest with {}, of which {} is the error found for model C",
                estimated_percent(error),
                estimated_percent(floor)
            ),
            (.., Some(_)) => format!(
                "model {model} is taken without an estimate: with fewer modes its contacts have no solution"
            ),
            _ => format!(
                "model {model} is taken without an estimate: the contact patches are wider, over the plate's thickness, than those up to which estimates were found true ({STATED_ACCURACY})"
            ),
        }
    }
}
