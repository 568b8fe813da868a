//! `auto`: the cheapest reduced model whose estimated error meets a tolerance, before any continuum is meshed.
//!
//! What models A and B lack is estimated by solving the impact once more with the plate as an elastic layer and the spheres in
//! closed form ([`crate::body::layer`], [`crate::body::free_sphere`]): that has shear, rotary inertia and the
//! local flexibility that Kirchhoff's plate on half-spaces has not, and costs as much as one of their runs. The same layer with
//! fewer modes tells how many model C needs. A candidate's estimated error is
//!
//!   sqrt((safety |candidate - layer| + truncation)^2 + floor^2)
//!
//! with the error that model C itself was found to have against the finite-element reference as the floor.

use super::reduced::{DEFAULT_MODES, fluid_forces, quantities};
use super::results::PlateQuantities;
use super::rough::Rough;
use super::validity;
use crate::body::continuum::ContinuumPlate;
use crate::body::layer::Waves;
use crate::body::{ModalBody, free_sphere};
use crate::dynamics::OuterBody;
use crate::dynamics::integrator::{Options, integrate};
use crate::dynamics::system::System;
use crate::dynamics::wet;
use crate::error::Result;
use crate::fluid::added_mass::{immersed, mass_factor};
use crate::result::{Candidate, Choice};
use crate::scene::{Material, Model, PlateImpact, Scene, Shape};

/// The quantities that a tolerance of `auto` covers, each by itself. The inner body's velocity goes with the efficiency; times
/// of release and numbers of contacts are not covered: a contact that just closes once more changes them by a jump.
pub const COVERED: [&str; 4] = ["efficiency", "outer_velocity_final", "outer_force_peak", "inner_force_peak"];
/// Tolerance of `auto` when the user names none.
pub const DEFAULT_TOLERANCE: f64 = 0.01;
/// Errors of the efficiency are relative to it, or to this if it is smaller.
const SMALL_EFFICIENCY: f64 = 0.05;
/// Share of the tolerance that is left to the time integration.
const INTEGRATION_SHARE: f64 = 0.01;
/// Error over the difference to the layer, which is mostly within a tenth of what it corrects.
const SAFETY: f64 = 1.15;
/// Part of (contact frequency / lowest frequency left out)^2 that a truncated series of continuum modes may be off by beyond
/// what the layer, which has no longitudinal modes, tells.
const TRUNCATION_SHARE: f64 = 0.1;
/// Truncation error, relative to the tolerance, at which the layer's own modes end.
const REFERENCE_SHARE: f64 = 0.05;
/// Share of the contacts' flexibility, relative to the tolerance, below which more Kirchhoff modes don't help.
const LEFT_OUT_SHARE: f64 = 0.25;
/// Numbers of Kirchhoff modes tried: model A and then B.
const KIRCHHOFF_RUNGS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];
/// Numbers of bending modes tried for model C.
const CONTINUUM_RUNGS: [usize; 26] =
    [1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192];

/// Which modes of the continuum plate model C is to have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cut {
    /// Angular frequency in rad/s below which all modes are kept.
    pub(super) omega: f64,
    /// How many that will be at most.
    pub(super) modes: usize,
}

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

/// Largest relative error of the quantities [`COVERED`] in `candidate` against `exact`, and its name; `speed` in m/s is that of
/// the impact.
pub fn largest_error(
    candidate: &PlateQuantities,
    exact: &PlateQuantities,
    speed: f64,
) -> (f64, &'static str) {
    let error = |name: &'static str| {
        let value = |q: &PlateQuantities| q.get(name).unwrap_or(f64::NAN);
        let difference = (value(candidate) - value(exact)).abs();
        (if difference == 0.0 { 0.0 } else { difference / error_scale(name, exact, speed) }, name)
    };
    // a value that is not a number is the largest of all
    let larger =
        |a: (f64, &'static str), b: (f64, &'static str)| if a.0 >= b.0 || a.0.is_nan() { a } else { b };
    COVERED.into_iter().map(error).fold((0.0, COVERED[0]), larger)
}

/// What an error of the quantity `name` is relative to, in its unit; `speed` in m/s is that of the impact.
pub fn error_scale(name: &str, exact: &PlateQuantities, speed: f64) -> f64 {
    match name {
        "efficiency" => exact.efficiency.abs().max(SMALL_EFFICIENCY),
        "outer_velocity_final" => speed,
        _ => exact.get(name).map_or(f64::NAN, f64::abs),
    }
}

/// Plans `auto` for `scene`.
///
/// # Errors
/// As [`crate::kinds::plate_impact::reduced::Reduced::new`].
pub(super) fn plan(scene: &Scene, tolerance: f64) -> Result<Plan> {
    let setup = scene.plate_impact()?;
    let outer = OuterBody::new(&setup.outer)?;
    let few = Waves::new(&setup.plate, DEFAULT_MODES);
    let rough = Rough::of(&system(setup, &outer, few.kirchhoff(DEFAULT_MODES), [0.0; 2]))?;
    let options = Options {
        tolerance: integration_tolerance(tolerance),
        end_time: scene.run.end_time,
        sample_interval: None,
    };
    let slower = setup.fluid.as_ref().map_or(1.0, |fluid| mass_factor(fluid.added_mass_frequency_ratio));
    let truncation = |omega: f64| slower * rough.truncation_error(omega);
    let enough = |n: &usize| truncation(few.frequency(*n + 1)) <= REFERENCE_SHARE * tolerance;
    let most = CONTINUUM_RUNGS.into_iter().find(enough).unwrap_or(CONTINUUM_RUNGS[CONTINUUM_RUNGS.len() - 1]);
    let waves = if most > DEFAULT_MODES { Waves::new(&setup.plate, most) } else { few };
    let layer = waves.layer(rough.patch_radius);
    let trials = Trials { setup, outer, waves, layer, rough, options, tips: tips(setup, &rough) };
    let reference = trials.continuum(most).ok();
    let mut search = Search {
        floor: validity::measured_error(rough.patch_radius, setup.plate.thickness),
        tolerance,
        tried: Vec::new(),
    };
    let kirchhoff = search.kirchhoff(&trials, reference.as_ref());
    if let Some((model, modes, error)) = kirchhoff.filter(|(_, _, error)| *error <= tolerance) {
        return Ok(search.plan(trials, model, modes, None, Some(error), None));
    }
    let (modes, error) = search.continuum(&trials, reference.as_ref(), most, &truncation);
    let cut = trials.cut(modes);
    Ok(search.plan(trials, Model::C, modes, Some(cut), error, kirchhoff))
}

/// Joins plate and bodies.
fn system(setup: &PlateImpact, outer: &OuterBody, plate: ModalBody, tips: [f64; 2]) -> System {
    let plate = match &setup.fluid {
        Some(fluid) => immersed(plate, fluid),
        None => plate,
    };
    System::with_outer(setup, outer.clone(), &plate, tips)
}

/// Residual flexibilities in m/N of both bodies in closed form.
fn tips(setup: &PlateImpact, rough: &Rough) -> [f64; 2] {
    let tip = |shape: &Shape, material: &Material, patch: f64| match *shape {
        Shape::Sphere { radius } => free_sphere::sphere_residual(radius, material, patch),
        Shape::Compact { .. } | Shape::Bender(_) => 0.0,
    };
    [
        tip(&setup.outer.shape, &setup.outer.material, rough.patch_radius[0]),
        tip(&setup.inner.shape, &setup.inner.material, rough.patch_radius[1]),
    ]
}

/// Impacts with plates in closed form.
struct Trials<'a> {
    setup: &'a PlateImpact,
    outer: OuterBody,
    waves: Waves,
    layer: ContinuumPlate,
    rough: Rough,
    options: Options,
    tips: [f64; 2],
}

impl Trials<'_> {
    /// Models A and B.
    fn kirchhoff(&self, modes: usize) -> Result<PlateQuantities> {
        self.run(self.waves.kirchhoff(modes), modes, [0.0; 2])
    }

    /// Model C with a layer in the place of the continuum.
    fn continuum(&self, modes: usize) -> Result<PlateQuantities> {
        let plate = self.layer.modal_body(modes, self.rough.slow());
        self.run(plate, modes, self.tips)
    }

    fn run(&self, plate: ModalBody, modes: usize, tips: [f64; 2]) -> Result<PlateQuantities> {
        let system = system(self.setup, &self.outer, plate, tips);
        let shapes = |radii: &[f64]| Ok(self.waves.shapes(modes, radii));
        let result = match fluid_forces(self.setup, shapes)? {
            None => integrate(&system, &self.options)?,
            Some(fluid) => wet::integrate(&system, &fluid, &self.options)?,
        };
        quantities(&system, &result)
    }

    /// Share of the static flexibility at the contacts that Kirchhoff's plate with `modes` modes leaves out, the contacts' own at
    /// their force peaks being one.
    fn left_out(&self, modes: usize) -> f64 {
        let plate = self.waves.kirchhoff(self.waves.modes());
        let rigid = plate.omega.iter().filter(|omega| **omega == 0.0).count();
        let modal = plate.omega.iter().zip(&plate.participation).skip(rigid + modes);
        let flexibility: f64 = modal.map(|(omega, phi)| (phi[0] / omega).powi(2)).sum();
        let system = system(self.setup, &self.outer, plate.clone(), [0.0; 2]);
        let of = |i: usize| {
            let force = self.rough.force_peak[i];
            flexibility * force / system.laws[i].approach(force)
        };
        of(0).max(of(1))
    }

    /// The frequency between bending mode `modes` and the next, and how many modes of any kind there are below.
    fn cut(&self, modes: usize) -> Cut {
        let omega = 0.5 * (self.layer.omega[modes - 1] + self.layer.omega_next(modes));
        let material = &self.setup.plate.material;
        let stretching = (material.plane_strain_modulus() / material.density).sqrt();
        let longitudinal = omega * self.setup.plate.radius / (std::f64::consts::PI * stretching) + 1.0;
        Cut { omega, modes: modes + longitudinal as usize }
    }
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
    fn continuum(
        &mut self,
        trials: &Trials,
        reference: Option<&PlateQuantities>,
        most: usize,
        truncation: &dyn Fn(f64) -> f64,
    ) -> (usize, Option<f64>) {
        let floor = self.floor.unwrap_or(self.tolerance);
        // what the floor leaves; where it leaves nothing, so much that the modes hardly matter beside it
        let room = match floor < self.tolerance {
            true => (self.tolerance.powi(2) - floor.powi(2)).sqrt(),
            false => 0.5 * floor,
        };
        let alone = |modes: usize| truncation(trials.layer.omega_next(modes));
        // without the modes of the contact's own frequency nothing is right
        let rungs: Vec<usize> =
            CONTINUUM_RUNGS.into_iter().filter(|n| *n == most || *n < most && alone(*n) <= 1.0).collect();
        let mut attempt = |modes: usize| {
            let difference = match (reference, trials.continuum(modes)) {
                (Some(exact), Ok(ours)) => Some(largest_error(&ours, exact, trials.setup.outer.speed)),
                _ => None,
            };
            let truncated = difference
                .map_or(alone(modes), |(error, _)| SAFETY * error + TRUNCATION_SHARE * alone(modes));
            let error = self.total(truncated);
            self.note(Model::C, modes, error, difference.map(|(_, name)| name));
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
