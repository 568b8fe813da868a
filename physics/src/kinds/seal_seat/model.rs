//! A reduced seal seat of a scene, ready to run.

use super::Kind;
use super::SealSeat;
use super::body::{SeatBody, SeatMesh, Watch};
use super::candidates::{Zones, on_half_space};
use super::doubts;
use super::integrate::{Options, integrate};
use super::integration::Integration;
use super::results::{CURVES, SeatQuantities};
use super::system::System;
use super::truncation;
use crate::body::cache::Cache;
use crate::dynamics::StopReason;
use crate::dynamics::balance_check;
use crate::error::{Error, Result};
use crate::kinds::flight;
use crate::kinds::{Kind as _, SeriesModel};
use crate::material::vibration_frequency;
use crate::numerics::stopwatch::Stopwatch;
use crate::result::{CUT, History, Losses, Outcome, Point, Summary, Table};
use crate::scene::{Model, Scene};
use std::sync::Arc;

/// Modes where neither scene nor caller names a number. With 16 the sphere's force peak was wrong by up to a fifth in random seats
/// (seat-009 of the validation base); with 32 it is within 1 % of that with 64.
pub const DEFAULT_MODES: usize = 32;
/// Relative error of the sphere's velocity from the time integration when the caller names none.
pub const DEFAULT_TOLERANCE: f64 = 1e-3;
/// Steps tried first: per period of the highest mode, and over the actuator's contact if the seat were a heavy half-space.
const FIRST_STEPS: (f64, f64) = (3.0, 30.0);
/// Largest energy residual over the tolerance of the velocity, and what the gaps of closed contacts leave of it however short the
/// step is.
const LEDGER: f64 = 0.1;
const LEAST_RESIDUAL: f64 = 1e-6;
/// Halvings of the step before the tolerance is given up.
const HALVINGS: u32 = 12;
/// Largest coefficient of friction: no contact of two solids has more.
const MOST_FRICTION: f64 = 3.0;
/// Widenings of the zones of contact candidates before the mesh is given up.
const WIDENINGS: u32 = 8;

/// Modes, flexibility and rigid bodies of a scene.
#[derive(Debug, Clone)]
pub struct SeatModel {
    scene: Scene,
    system: System,
    /// With another number of modes, and the share of its difference that is the truncation error.
    compared: (System, f64),
    end_time: Option<f64>,
    first_step: f64,
    /// Velocity of the sphere in m/s at the end of a run with the first step; that run found the contact zones.
    predictor: [f64; 2],
    warnings: Vec<String>,
    /// Wall time in s that building took, the cache's help included.
    pub setup_seconds: f64,
    /// Degrees of freedom of the mesh without those that supports hold.
    pub dofs: usize,
}

impl SeatModel {
    /// Builds the reduced model of a seal-seat scene on `mesh`; `modes` overrides the scene's number of modes.
    ///
    /// The zones of contact candidates are widened until contact stays inside them.
    ///
    /// # Errors
    /// [`Error::Scene`] for another kind of scene, [`Error::Usage`] for a model or number of modes that does not
    /// exist for it, [`Error::Solver`] if the mesh is unusable.
    pub fn new(
        scene: &Scene,
        model: Model,
        modes: Option<usize>,
        mesh: &SeatMesh,
        cache: &Cache,
    ) -> Result<Self> {
        Self::new_with(scene, model, modes, mesh, cache, &mut |_, _| {})
    }

    /// As [`SeatModel::new`], telling how far it is.
    ///
    /// # Errors
    /// As [`SeatModel::new`].
    pub fn new_with(
        scene: &Scene,
        model: Model,
        modes: Option<usize>,
        mesh: &SeatMesh,
        cache: &Cache,
        watch: &mut Watch,
    ) -> Result<Self> {
        let setup = scene.seal_seat()?;
        let build = &mut |zones: &Zones, modes: usize| {
            let seat = mesh.body_with(setup, zones, modes, cache, watch)?;
            watch("impact", 0.95);
            Ok(Arc::new(seat))
        };
        Self::in_zones(scene, (model, modes), mesh, Zones::expected(setup), build)
    }

    /// With the bodies that `build` gives for zones of contact candidates, from the `zones` on, and modes.
    pub(super) fn in_zones(
        scene: &Scene,
        (model, modes): (Model, Option<usize>),
        mesh: &SeatMesh,
        mut zones: Zones,
        build: &mut dyn FnMut(&Zones, usize) -> Result<Arc<SeatBody>>,
    ) -> Result<Self> {
        let started = Stopwatch::start();
        let setup = scene.seal_seat()?;
        if model != Model::C {
            return Err(Error::Usage(format!(
                "model {model} is one of a plate; a seal seat has model C only (modes of the solid seat with the residual flexibility of its contact nodes)"
            )));
        }
        let modes = modes.or(scene.reduced.modes).unwrap_or(DEFAULT_MODES);
        if setup.friction > MOST_FRICTION {
            return Err(Error::Usage(format!(
                "scene `{}`: friction is {}; model C of a seal seat takes at most {MOST_FRICTION}, since normal and tangential forces do not converge above: \
                 the reference does not need that",
                scene.name, setup.friction
            )));
        }
        if modes == 0 {
            return Err(Error::Usage("--modes 0: at least one mode is needed".into()));
        }
        for _ in 0..WIDENINGS {
            let seat = build(&zones, modes.max(DEFAULT_MODES))?;
            let built = Self::with(scene, setup, mesh, &seat, modes)?;
            let predictor = built.integrate(built.first_step, DEFAULT_TOLERANCE, false)?;
            let wider = zones.widened(predictor.tally.reach).map_or(zones, |wider| wider.at_most(setup));
            if wider == zones {
                let (predictor, setup_seconds) = (predictor.state.sphere_velocity, started.seconds());
                return Ok(Self { predictor, setup_seconds, ..built });
            }
            zones = wider;
        }
        Err(Error::Solver(format!(
            "contact of the seal seat `{}` spreads beyond {:e} m from the ring or {:e} m from a tip",
            scene.name, zones.ring, zones.tip
        )))
    }

    fn with(scene: &Scene, setup: &SealSeat, mesh: &SeatMesh, seat: &SeatBody, modes: usize) -> Result<Self> {
        let system = System::new(setup, &seat.body, &seat.candidates, modes)?;
        let (others, share) = truncation::compared(modes, seat.body.omega.len());
        let highest = system.omega.iter().fold(0.0f64, |a, b| a.max(*b));
        let period = 2.0 * std::f64::consts::PI / (highest * FIRST_STEPS.0);
        Ok(Self {
            scene: scene.clone(),
            first_step: period.min(on_half_space(setup).duration() / FIRST_STEPS.1),
            end_time: scene.run.end_time,
            // until the run that finds the contact zones has been made
            predictor: [f64::NAN; 2],
            compared: (System::new(setup, &seat.body, &seat.candidates, others)?, share),
            system,
            warnings: doubts::of_model(setup, mesh),
            setup_seconds: 0.0,
            dofs: seat.dofs,
        })
    }

    /// What the scene asks of the flight after the launch.
    fn add_flight(&self, summary: &mut Summary) -> Result<()> {
        let launch = flight::launch(&self.scene, summary);
        // it falls as fast as it rose
        let speed = launch.map_or(self.system.speed, |launch| launch.speed);
        flight::add_flight(&self.scene, summary, || self.restitution(speed))
    }

    /// The scene it is a model of.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Modes, contact nodes and rigid bodies.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Time step in s from which [`SeatModel::run`] starts to halve.
    pub fn first_step(&self) -> f64 {
        self.first_step
    }

    /// Runs the impact with a fixed time step in s; the forces of friction are those of a relative `tolerance`.
    ///
    /// # Errors
    /// As [`integrate`].
    pub fn integrate(&self, step: f64, tolerance: f64, history: bool) -> Result<Integration> {
        self.integrate_of(&self.system, step, tolerance, history)
    }

    fn integrate_of(&self, system: &System, step: f64, tolerance: f64, history: bool) -> Result<Integration> {
        let step = match self.end_time {
            // whole steps to the end
            Some(end) => end / (end / step).ceil(),
            None => step,
        };
        integrate(system, &Options { step, end_time: self.end_time, history, tolerance })
    }

    /// Runs the impact; the step is halved until the sphere's velocity changes by less than three times `tolerance`
    /// of its magnitude, of which the finer run has a third as its error (second order), and the energy by less than a tenth of
    /// it.
    ///
    /// # Errors
    /// As [`integrate`] and [`balance_check`]; [`Error::Solver`] if the tolerance can't be reached.
    pub fn run(&self, tolerance: f64) -> Result<Summary> {
        let started = Stopwatch::start();
        let (result, _) = self.converged(tolerance)?;
        let mut summary = self.summary(&result, tolerance, started.seconds())?;
        Kind.judge(&self.scene, &mut summary, None);
        self.add_flight(&mut summary)?;
        Ok(summary)
    }

    /// As [`SeatModel::run`], with the course over time. The summary's time is that of a run without.
    ///
    /// # Errors
    /// As [`SeatModel::run`].
    pub fn run_with_history(&self, tolerance: f64) -> Result<Outcome> {
        let started = Stopwatch::start();
        let (result, step) = self.converged(tolerance)?;
        let mut summary = self.summary(&result, tolerance, started.seconds())?;
        let history = history(&self.integrate(step, tolerance, true)?);
        summary.samples = Some(history.len());
        Kind.judge(&self.scene, &mut summary, Some(&history));
        self.add_flight(&mut summary)?;
        Ok(Outcome { summary, history })
    }

    /// The first result that meets the tolerance, and its step.
    fn converged(&self, tolerance: f64) -> Result<(Integration, f64)> {
        let (mut step, mut coarse) = (self.first_step, self.predictor);
        for _ in 0..HALVINGS {
            step *= 0.5;
            let result = self.integrate(step, tolerance, false)?;
            let fine = result.state.sphere_velocity;
            let change = (coarse[0] - fine[0]).hypot(coarse[1] - fine[1]);
            let balanced = result.energy_residual <= (LEDGER * tolerance).max(LEAST_RESIDUAL);
            if balanced && change <= 3.0 * tolerance * fine[0].hypot(fine[1]) {
                return Ok((result, step));
            }
            coarse = fine;
        }
        Err(Error::Solver(format!(
            "the sphere's velocity does not reach a relative error of {tolerance} with steps down to {step:e} s"
        )))
    }

    /// Runs the impact for its results alone, as a series of many needs them.
    ///
    /// # Errors
    /// As [`SeatModel::run`], [`Error::Solver`] if the run is cut during a contact.
    pub fn point(&self, tolerance: f64) -> Result<Point<SeatQuantities>> {
        let (result, _) = self.converged(tolerance)?;
        balance_check(result.energy_residual, result.momentum_residual, tolerance)?;
        if result.stop == StopReason::Cut {
            return Err(Error::Solver(CUT.into()));
        }
        Ok(Point {
            quantities: quantities(&self.system, &result),
            energy_residual: result.energy_residual,
            momentum_residual: result.momentum_residual,
            steps: result.tally.steps,
            converged: true,
        })
    }

    fn is_rough(&self) -> bool {
        self.system.friction > 0.0
    }

    fn summary(&self, result: &Integration, tolerance: f64, solve_seconds: f64) -> Result<Summary> {
        let mut table = quantities(&self.system, result).table();
        let mut warnings = self.warnings.clone();
        warnings.extend(doubts::of_contacts(&self.system, result));
        let step = result.time / result.tally.steps as f64;
        let (other, share) = &self.compared;
        let error =
            share * truncation::difference(result, &self.integrate_of(other, step, tolerance, false)?);
        warnings.extend(truncation::warning(error, self.system.omega.len()));
        warnings.extend(balance_check(result.energy_residual, result.momentum_residual, tolerance)?);
        if result.stop == StopReason::Cut {
            table = table.cut();
            warnings.push(CUT.into());
        }
        Ok(Summary {
            energy_residual: Some(result.energy_residual),
            momentum_residual: Some(result.momentum_residual),
            steps: Some(result.tally.steps),
            solve_seconds,
            truncation_error: Some(error),
            sphere_spin: self.is_rough().then_some(result.state.spin),
            friction_work: self.is_rough().then_some(result.rubbed),
            losses: (!self.system.relaxation.is_empty())
                .then(|| Losses { bodies: Some([0.0, result.relaxed, 0.0]), ..Losses::default() }),
            warnings,
            ..Summary::of_reduced(&self.scene, Model::C, self.system.omega.len(), table)
        })
    }
}

/// The values at the end of a run of `system`, wherever that is.
pub fn quantities(system: &System, result: &Integration) -> SeatQuantities {
    let [x, z] = result.state.sphere_velocity;
    let tally = &result.tally;
    SeatQuantities {
        efficiency: system.sphere_mass * (x * x + z * z) / (system.actuator_mass * system.speed.powi(2)),
        sphere_velocity_x: x,
        sphere_velocity_z: z,
        sphere_speed: x.hypot(z),
        sphere_angle: x.atan2(z),
        sphere_force_peak: tally.force_peak[0],
        actuator_force_peak: tally.force_peak[1],
        actuator_velocity_final: result.state.actuator_velocity,
        sphere_contact_end: tally.contact_end[0],
        actuator_contact_end: tally.contact_end[1],
        left_flank_impulse: tally.flank_impulse[0],
        right_flank_impulse: tally.flank_impulse[1],
        first_frequency: system.omega.first().map_or(0.0, |omega| {
            vibration_frequency(&system.relaxation, omega / (2.0 * std::f64::consts::PI))
        }),
    }
}

/// The samples of a run as curves.
fn history(result: &Integration) -> History {
    let mut history = History::new(&CURVES);
    for s in &result.samples {
        let ([x, z], [vx, vz], [fx, fz]) = (s.sphere, s.sphere_velocity, s.sphere_force);
        let sample = [x, z, vx, vz, fx.hypot(fz), fx, fz, s.actuator, s.actuator_velocity, s.actuator_force];
        history.push(s.time, sample);
    }
    history
}

impl SeriesModel for SeatModel {
    fn run_with_history(&self, tolerance: f64) -> Result<Outcome> {
        SeatModel::run_with_history(self, tolerance)
    }

    fn run(&self, tolerance: f64) -> Result<Summary> {
        SeatModel::run(self, tolerance)
    }

    fn point(&self, tolerance: f64) -> Result<Point<Table>> {
        SeatModel::point(self, tolerance).map(|point| point.map(|found| found.table()))
    }
}
