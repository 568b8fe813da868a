//! A reduced model of a scene: bodies reduced to modes, joined and integrated.

use super::Kind;
use super::choice::Plan;
use super::continua::Continua;
use super::joined::{Joined, Wanted, continuum, kirchhoff, kirchhoff_plate};
use super::results::{PlateQuantities, quantities, values};
use super::series::{Done, Impacts};
use super::shared::SharedBodies;
use super::truncation;
use super::validity::film_warning;
use crate::body::cache::Cache;
use crate::dynamics::assured;
use crate::dynamics::integration::{Integration, Options};
use crate::dynamics::ledger_check;
use crate::dynamics::memory::{self, Memory};
use crate::dynamics::system::System;
use crate::dynamics::wet::FluidForces;
use crate::error::{Error, Result};
use crate::kinds::Kind as _;
use crate::result::{BenderSummary, CUT, Choice, ElasticLimit, Outcome, StackSummary, Summary};
use crate::scene::{self, DEFAULT_MODES, Edge, MAX_MODES, Model, Outer, PlateImpact, Scene, Setup, Shape};
use std::time::Instant;

/// The same of an impact beside the centre, where modes with nodal diameters are as many.
const OFF_CENTRE_MODES: usize = 64;
/// Error of a point's force peaks from looking for them, in tolerances: below what they are wrong by.
const PEAK_ERROR: f64 = 0.1;
/// Share of a bender's moment at the strike that is told.
const MOMENT_LEFT: f64 = 0.01;
/// Samples of a history per duration of a Hertz contact.
const SAMPLES_PER_CONTACT: f64 = 400.0;

/// A reduced model, ready to run.
#[derive(Debug, Clone)]
pub struct Reduced {
    model: Model,
    system: System,
    /// Frequency in rad/s of the lowest mode left to the residual flexibility of model C.
    omega_next: f64,
    /// Forces of the fluid; a dry impact has none and takes the dry integrator.
    fluid: Option<FluidForces>,
    /// What its materials remember; elastic ones take the integrator that knows nothing of it.
    memory: Option<Memory>,
    warnings: Vec<String>,
    /// Why it is this model, if it was left to the program.
    choice: Option<Choice>,
    scene: Scene,
}

/// What one impact of a series gives.
pub type Point = crate::result::Point<PlateQuantities>;

impl Reduced {
    /// Builds `model` of `scene`; `modes` overrides the scene's number of modes (model A always has one); if
    /// neither names one, model B takes [`DEFAULT_MODES`] and model C as many as its error estimate asks for.
    ///
    /// # Errors
    /// [`Error::Usage`] for a number of modes that makes no sense, [`Error::Solver`] for what no reduced model covers.
    pub fn new(scene: &Scene, model: Model, modes: Option<usize>) -> Result<Self> {
        Self::in_series(scene.clone(), model, modes, &SharedBodies::default())
    }

    /// As [`Reduced::new`], one of a series of impacts that share `bodies`.
    ///
    /// # Errors
    /// As [`Reduced::new`].
    pub fn in_series(
        scene: Scene,
        model: Model,
        modes: Option<usize>,
        bodies: &SharedBodies,
    ) -> Result<Self> {
        let setup = &*scene.plate_impact()?.along_normal();
        require_covered(setup, Some(model))?;
        let modes = match (model, modes) {
            (Model::A, None | Some(1)) => Some(1),
            (Model::A, Some(n)) => {
                return Err(Error::Usage(format!("--modes {n}: model A has exactly one mode; use model B")));
            }
            (_, Some(0)) => return Err(Error::Usage("--modes 0: at least one mode is needed".into())),
            (_, Some(n)) if n > MAX_MODES => {
                return Err(Error::Usage(format!("--modes {n}: at most {MAX_MODES} modes are possible")));
            }
            (_, modes) => modes.or(scene.reduced.modes),
        };
        let built = match model {
            Model::A | Model::B => {
                let default = if setup.outer.offset > 0.0 { OFF_CENTRE_MODES } else { DEFAULT_MODES };
                kirchhoff(setup, modes.unwrap_or(default), &bodies.kirchhoff)?
            }
            Model::C => {
                let predictor = bodies.predictor(setup)?;
                let wanted = modes.map_or(Wanted::Estimate, Wanted::Modes);
                continuum(setup, wanted, &predictor, bodies.continua())?
            }
        };
        Self::of(built, model, scene, None)
    }

    /// As [`Reduced::new`] with the bodies of model C from `cache`.
    ///
    /// # Errors
    /// As [`Reduced::new`].
    pub fn new_in(scene: &Scene, model: Model, modes: Option<usize>, cache: &Cache) -> Result<Self> {
        Self::in_series(scene.clone(), model, modes, &SharedBodies::meshed(cache.clone()))
    }

    /// The cheapest model and number of modes whose estimated error meets `tolerance`, or what comes nearest; see
    /// [`Choice`]. The tolerance covers [`super::errors::COVERED`].
    ///
    /// # Errors
    /// [`Error::Scene`] if the scene is no plate impact, [`Error::Solver`] for what no reduced model covers.
    pub fn auto(scene: &Scene, tolerance: f64) -> Result<Self> {
        Self::auto_in(scene, tolerance, &Cache::from_environment())
    }

    /// As [`Reduced::auto`] with the bodies of model C from `cache`.
    ///
    /// # Errors
    /// As [`Reduced::auto`].
    pub fn auto_in(scene: &Scene, tolerance: f64, cache: &Cache) -> Result<Self> {
        let setup = &*scene.plate_impact()?.along_normal();
        require_covered(setup, None)?;
        let normal = Scene { setup: Setup::PlateImpact(Box::new(setup.clone())), ..scene.clone() };
        let mut plan = Plan::new(&normal, tolerance)?;
        let mut continua: Option<Joined> = None;
        while let Some(cut) = plan.cut {
            match continuum(setup, Wanted::Below(cut), &plan.trials.predictor, Continua::meshed(cache)) {
                Ok(built) => {
                    plan.judge(&built.system, built.omega_next);
                    continua = Some(built);
                }
                Err(error) if continua.is_none() => plan.without_continuum(error)?,
                Err(_) => break,
            }
        }
        let kirchhoff = || {
            let waves = &plan.trials.waves;
            let shapes = |radii: &[f64]| Ok(waves.shapes(plan.modes, radii));
            kirchhoff_plate(setup, waves.kirchhoff(plan.modes), shapes)
        };
        let built = continua.map_or_else(kirchhoff, Ok)?;
        Self::of(built, plan.model, scene.clone(), Some(plan.choice()))
    }

    fn of(built: Joined, model: Model, scene: Scene, choice: Option<Choice>) -> Result<Self> {
        let Joined { mut system, omega_next, fluid, mut warnings } = built;
        let memory = Memory::new(scene.plate_impact()?, &system)?;
        let choice = choice.map(|choice| match memory {
            Some(_) => Choice {
                met: false,
                reason: format!("{}; for elastic materials, which these are not", choice.reason),
                ..choice
            },
            None => choice,
        });
        warnings.extend(choice.iter().filter(|choice| !choice.met).map(|choice| choice.reason.clone()));
        if let Some(memory) = &memory {
            system.first_frequency = memory.frequency(system.first_frequency);
        }
        Ok(Self { model, system, omega_next, fluid, memory, warnings, choice, scene })
    }

    /// Refuses a `model` that has no form for impacts like that of `scene`, before anything is built.
    ///
    /// # Errors
    /// [`Error::Solver`] with the reason, [`Error::Scene`] if the scene is no plate impact.
    pub fn require(scene: &Scene, model: Model) -> Result<()> {
        require_covered(scene.plate_impact()?, Some(model))
    }

    /// The model.
    pub fn model(&self) -> Model {
        self.model
    }

    /// Why it is this model, if it was left to the program.
    pub fn choice(&self) -> Option<&Choice> {
        self.choice.as_ref()
    }

    /// The oscillators and contacts the model consists of.
    pub fn system(&self) -> &System {
        &self.system
    }

    fn impacts(&self) -> Impacts<'_> {
        let series = self.scene.plate_impact().ok().and_then(|setup| setup.series);
        Impacts { system: &self.system, fluid: self.fluid.as_ref(), memory: self.memory.as_ref(), series }
    }

    /// Runs the impact without keeping its history; `tolerance` bounds the efficiency's relative error from the
    /// time integration.
    ///
    /// # Errors
    /// As [`crate::dynamics::integrate`] and [`ledger_check`].
    pub fn run(&self, tolerance: f64) -> Result<Summary> {
        let (mut summary, _) = self.unjudged(tolerance)?;
        Kind.judge(&self.scene, &mut summary, None);
        self.add_flight(&mut summary)?;
        Ok(summary)
    }

    /// What the scene asks of the flight after the impact.
    fn add_flight(&self, summary: &mut Summary) -> Result<()> {
        let given = || Err(Error::Internal("a flight behind a plate names its restitution".into()));
        crate::flight::add_flight(&self.scene, summary, given)
    }

    /// The summary, and what the materials remembered when the last impact began.
    fn unjudged(&self, tolerance: f64) -> Result<(Summary, Option<Memory>)> {
        let start = Instant::now();
        let options = Options { heat: true, ..self.options(tolerance) };
        let Done { last, impacts, memory, warning } = self.impacts().all(&options)?;
        let mut summary = self.summary(&last, tolerance, start.elapsed().as_secs_f64())?;
        summary.warnings.extend(warning);
        let elastic_efficiency = self.impacts().elastic_efficiency(&options);
        let elastic_limit = self.elastic_limit(&options)?;
        Ok((Summary { impacts, elastic_efficiency, elastic_limit, ..summary }, memory))
    }

    /// `None` without yield strengths, and where bodies relax or bend before they strike.
    fn elastic_limit(&self, options: &Options) -> Result<Option<ElasticLimit>> {
        let setup = self.scene.plate_impact()?;
        let onset = memory::onset_of_yield(setup, &self.system);
        let materials = [&setup.outer.material, &setup.plate.material, &setup.inner.material];
        let covered = !setup.outer.shape.is_held()
            && setup.outer.is_centred()
            && materials.iter().all(|m| m.relaxation.is_empty());
        if !covered || onset == [None; 2] {
            return Ok(None);
        }
        let [outer, inner] = self.impacts().elastic_speeds(onset, options);
        Ok(Some(ElasticLimit { outer, inner }))
    }

    /// Runs the impact for its results alone, as a series of many needs them.
    ///
    /// # Errors
    /// As [`Reduced::run`], [`Error::Solver`] if the run is cut during a contact.
    pub fn point(&self, tolerance: f64) -> Result<Point> {
        let options = Options { peak_error: PEAK_ERROR * tolerance, ..self.options(tolerance) };
        let result = self.impacts().all(&options)?.last;
        ledger_check(result.energy_residual, result.momentum_residual, tolerance.max(result.kept_tolerance))?;
        Ok(Point {
            quantities: self.of_all_energy(quantities(&self.system, &result)?),
            energy_residual: result.energy_residual,
            momentum_residual: result.momentum_residual,
            steps: result.steps,
        })
    }

    /// Runs the impact and keeps its history. The summary's time is that of a run without history.
    ///
    /// # Errors
    /// As [`Reduced::run`].
    pub fn run_with_history(&self, tolerance: f64) -> Result<Outcome> {
        self.run_with_history_until(tolerance, 0.0)
    }

    /// As [`Reduced::run_with_history`]; a history that would end earlier, because no further contact is possible, goes on
    /// until `end` (s) unless the scene names its end.
    ///
    /// # Errors
    /// As [`Reduced::run`].
    pub fn run_with_history_until(&self, tolerance: f64, end: f64) -> Result<Outcome> {
        let (mut summary, memory) = self.unjudged(tolerance)?;
        let system = &self.system;
        let sample_interval = Some(system.hertz_impact().duration() / SAMPLES_PER_CONTACT);
        let options = Options { sample_interval, ..self.options(tolerance) };
        let record = |options: &Options| -> Result<_> {
            let (result, _) = self.impacts().one(options, memory.as_ref())?;
            result.history.ok_or_else(|| Error::Internal("a history was asked for".into()))
        };
        let mut history = record(&options)?;
        if options.end_time.is_none() && history.time.last().is_some_and(|last| *last < end) {
            // so much later that rounding can't leave the last instant out
            history = record(&Options { end_time: Some(end * (1.0 + 1e-9)), ..options })?;
        }
        summary.samples = Some(history.len());
        Kind.judge(&self.scene, &mut summary, Some(&history));
        self.add_flight(&mut summary)?;
        Ok(Outcome { summary, history })
    }

    /// `quantities` of the motion along the plate's normal with the efficiency relative to all kinetic energy of the outer body.
    fn of_all_energy(&self, quantities: PlateQuantities) -> PlateQuantities {
        let angle = self.scene.plate_impact().map_or(0.0, |setup| setup.outer.angle);
        PlateQuantities { efficiency: quantities.efficiency * angle.cos().powi(2), ..quantities }
    }

    fn options(&self, tolerance: f64) -> Options {
        Options { tolerance, end_time: self.scene.run.end_time, ..Options::default() }
    }

    fn summary(&self, result: &Integration, tolerance: f64, solve_seconds: f64) -> Result<Summary> {
        let (system, tolerance) = (&self.system, tolerance.max(result.kept_tolerance));
        let setup = &*self.scene.plate_impact()?.along_normal();
        let end_time = self.scene.run.end_time;
        let truncation = truncation::estimate(setup, self.model, system, self.omega_next, end_time)?;
        let even_steps = result.kept_tolerance > 0.0;
        let unsure =
            result.error_estimate.filter(|error| !even_steps && *error > assured::ENOUGH * tolerance);
        let mut warnings = scene::doubts(&self.scene);
        warnings.extend(self.warnings.iter().cloned());
        warnings.extend(truncation.warning);
        if setup.friction > 0.0 {
            warnings.push("friction is left out: Hertz's contact is smooth; the reference has it".into());
        }
        warnings.extend(film_warning(result.losses.squeeze_film / system.initial_energy()));
        warnings.extend(unsure.map(|error| {
            format!(
                "final velocities are uncertain by {error:.0e} of the impact speed: the many contacts of this impact amplify every error"
            )
        }));
        if let (Some(memory), true) = (&self.memory, even_steps) {
            warnings.extend(memory.warnings.iter().cloned());
            warnings.extend(result.error_estimate.filter(|error| *error > memory::CHANGE / 3.0).map(|error| {
                format!("velocities and force peaks are uncertain by {error:.0e}: ever shorter steps have not settled them")
            }));
        }
        if let (Shape::Bender(bender), Some(drive)) = (&setup.outer.shape, system.drive) {
            let left = (-drive.strike_delay / bender.discharge_time).exp();
            warnings.extend((left > MOMENT_LEFT).then(|| {
                format!(
                    "{:.1} % of the bender's moment is left when it strikes, which the models take as gone",
                    100.0 * left
                )
            }));
        }
        for (body, contact) in ["outer", "inner"].iter().zip(&result.contacts) {
            if contact.contacts == 0 {
                warnings.push(format!("the {body} body and the plate never touch"));
            }
        }
        warnings.extend(ledger_check(result.energy_residual, result.momentum_residual, tolerance)?);
        if self.scene.plate_impact()?.outer.angle != 0.0 {
            warnings.push(
                "motion along the plate is left out: the velocity along its normal alone counts; the reference has both".into(),
            );
        }
        let values = self.of_all_energy(values(system, result));
        let mut table = values.table();
        if result.is_cut() {
            table = table.cut();
            warnings.push(CUT.into());
        }
        if system.stack.is_some() {
            // eq. (1) relates to a kinetic energy before the impact, and the tip vibrates on
            let open = ["efficiency", "outer_velocity_final"].into_iter();
            let pressing = ["outer_contact_end", "outer_contacts"].into_iter().filter(|_| result.pressed);
            for name in open.chain(pressing) {
                table.value_mut(name).into_iter().for_each(|value| *value = None);
            }
        }
        Ok(Summary {
            energy_residual: Some(result.energy_residual),
            momentum_residual: Some(result.momentum_residual),
            steps: Some(result.steps),
            solve_seconds,
            integration_error: result.error_estimate,
            truncation_error: Some(truncation.error),
            bender: system.drive.map(|drive| {
                let transmitted = 0.5 * system.masses[1] * result.velocity[1].powi(2);
                let efficiency = transmitted / drive.strain_energy;
                BenderSummary { strain_energy_efficiency: (!result.is_cut()).then_some(efficiency), drive }
            }),
            stack: result.supplied.map(|supplied| {
                let transmitted = 0.5 * system.masses[1] * result.velocity[1].powi(2);
                StackSummary {
                    electrical_energy: supplied.taken,
                    mechanical_energy: supplied.given,
                    share: (!result.is_cut()).then_some(transmitted / supplied.taken),
                }
            }),
            losses: (system.is_damped() && system.stack.is_none()
                || self.fluid.is_some()
                || self.memory.is_some())
            .then_some(result.losses),
            warnings,
            choice: self.choice.clone(),
            ..Summary::of_reduced(&self.scene, self.model, system.modes, table)
        })
    }
}

/// Refuses what `model`, or the one that is to be chosen, does not have.
fn require_covered(setup: &PlateImpact, model: Option<Model>) -> Result<()> {
    let Outer { offset, .. } = setup.outer;
    if offset == 0.0 || (model.is_some_and(|model| model < Model::C) && setup.plate.edge != Edge::Free) {
        return Ok(());
    }
    Err(Error::Solver(format!(
        "`outer.offset` is {offset} m: beside the centre of the plate only models A and B take an impact, if its edge is clamped or simply supported; the reference takes all"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the references found it: 6 % too low with 10 mPa s, half a percent in water.
    #[test]
    fn a_film_that_is_too_strong_for_bodies_without_dents_is_told() {
        let viscous = include_str!("../../../../scenes/validation/viscous-film.toml");
        let water = include_str!("../../../../scenes/validation/squeeze-film.toml");
        for (text, told) in [(viscous, true), (water, false)] {
            let scene = Scene::parse("film.toml", text).unwrap();
            let summary = Reduced::new(&scene, Model::B, None).unwrap().run(1e-4).unwrap();
            assert_eq!(
                summary.warnings.iter().any(|w| w.contains("squeeze film takes")),
                told,
                "{summary:?}"
            );
        }
    }

    #[test]
    fn a_contact_half_as_wide_as_its_sphere_is_refused_by_the_sphere_s_name() {
        let text = include_str!("../../../../tests/fixtures/plate-impact.toml");
        let [start, end] = ["[outer]", "[inner]"].map(|table| text.find(table).expect("a table"));
        let soft = text.replace(
            &text[start..end],
            "[outer]\nkind = \"sphere\"\nradius = \"5 mm\"\nmaterial = \"soft\"\nspeed = \"20 m/s\"\n\n",
        ) + "\n[materials.soft]\nyoungs_modulus = \"1.8 MPa\"\npoisson_ratio = 0.4\ndensity = \"1100 kg/m^3\"\n";
        let scene = Scene::parse("soft.toml", &soft).unwrap();
        let refused = Reduced::new(&scene, Model::C, None).expect_err("too wide").to_string();
        assert!(refused.contains("`outer.radius`, 2.500 mm"), "{refused}");
        assert!(Reduced::new(&scene, Model::B, None).is_ok());
    }

    /// A result whose ledger is off says so, and is none if it is far off.
    #[test]
    fn the_ledger_of_a_run_is_judged() {
        let text = include_str!("../../../../tests/fixtures/plate-impact.toml");
        let scene = Scene::parse("plate-impact.toml", text).unwrap();
        let reduced = Reduced::new(&scene, Model::B, None).unwrap();
        let sound = reduced.impacts().all(&reduced.options(1e-7)).unwrap().last;
        let summary = |energy_residual: f64| {
            reduced.summary(&Integration { energy_residual, ..sound.clone() }, 1e-7, 0.0)
        };
        assert_eq!(summary(sound.energy_residual).unwrap().warnings, Vec::<String>::new());
        let off = summary(1e-5).unwrap();
        assert!(off.warnings.iter().any(|w| w.contains("ledger of energy")), "{:?}", off.warnings);
        assert!(matches!(summary(0.02), Err(Error::Solver(_))));
    }
}
