//! A reduced model of a scene: bodies reduced to modes, joined and integrated.

use super::integrator::{Integration, Options, integrate};
use super::system::System;
use super::{Outcome, PlateQuantities, SCHEMA_VERSION, Source, Summary};
use crate::analytical::hertz::HertzImpact;
use crate::body::continuum::{MeshOptions, cached as continuum};
use crate::body::kirchhoff;
use crate::error::{Error, Result};
use crate::scene::{Material, Model, PlateImpact, Scene, Setup, Shape};
use std::time::Instant;

/// Modes of model B when neither the scene nor the caller names a number (the paper's 16).
pub const DEFAULT_MODES: usize = 16;
/// Samples of a history per duration of a Hertz contact.
const SAMPLES_PER_CONTACT: f64 = 400.0;

/// A reduced model, ready to run.
#[derive(Debug, Clone)]
pub struct Reduced {
    model: Model,
    system: System,
    end_time: Option<f64>,
    scene: String,
    scene_hash: String,
}

impl Reduced {
    /// Builds `model` of `scene`; `modes` overrides the scene's number of modes (model A always has one).
    ///
    /// # Errors
    /// [`Error::Usage`] for a number of modes that makes no sense, [`Error::Solver`] for what no reduced model covers.
    pub fn new(scene: &Scene, model: Model, modes: Option<usize>) -> Result<Self> {
        let Setup::PlateImpact(setup) = &scene.setup;
        if setup.fluid.is_some() {
            return Err(Error::Solver(format!(
                "scene `{}`: [fluid] is set, and this version's reduced models are dry; remove the table to run the dry scene",
                scene.name
            )));
        }
        let modes = match (model, modes) {
            (Model::A, None | Some(1)) => 1,
            (Model::A, Some(n)) => {
                return Err(Error::Usage(format!("--modes {n}: model A has exactly one mode; use model B")));
            }
            (_, Some(0)) => return Err(Error::Usage("--modes 0: at least one mode is needed".into())),
            (_, Some(n)) => n,
            (_, None) => scene.reduced.modes.unwrap_or(DEFAULT_MODES),
        };
        Ok(Self {
            model,
            system: system(setup, model, modes)?,
            end_time: scene.run.end_time,
            scene: scene.name.clone(),
            scene_hash: scene.hash(),
        })
    }

    /// The oscillators and contacts the model consists of.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Runs the impact without keeping its history; `tolerance` bounds the efficiency's relative error from the
    /// time integration.
    ///
    /// # Errors
    /// As [`integrate`].
    pub fn run(&self, tolerance: f64) -> Result<Summary> {
        let start = Instant::now();
        let result = integrate(&self.system, &self.options(tolerance))?;
        Ok(self.summary(&result, start.elapsed().as_secs_f64()))
    }

    /// Runs the impact and keeps its history. The summary's time is that of a run without history.
    ///
    /// # Errors
    /// As [`integrate`].
    pub fn run_with_history(&self, tolerance: f64) -> Result<Outcome> {
        let summary = self.run(tolerance)?;
        let system = &self.system;
        let hit =
            HertzImpact { mass: system.masses[0], speed: system.speed, stiffness: system.laws[0].stiffness };
        let sample_interval = Some(hit.duration() / SAMPLES_PER_CONTACT);
        let result = integrate(system, &Options { sample_interval, ..self.options(tolerance) })?;
        let history = result.history.ok_or_else(|| Error::Internal("a history was asked for".into()))?;
        Ok(Outcome { summary, history })
    }

    fn options(&self, tolerance: f64) -> Options {
        Options { tolerance, end_time: self.end_time, sample_interval: None }
    }

    fn summary(&self, result: &Integration, solve_seconds: f64) -> Summary {
        let system = &self.system;
        let energy = |i: usize| 0.5 * system.masses[i] * result.velocity[i].powi(2);
        Summary {
            schema_version: SCHEMA_VERSION,
            scene: self.scene.clone(),
            scene_hash: self.scene_hash.clone(),
            source: Source::Reduced,
            model: Some(self.model.to_string()),
            modes: Some(system.modes),
            quantities: PlateQuantities {
                efficiency: energy(1) / system.initial_energy(),
                outer_velocity_final: result.velocity[0],
                inner_velocity_final: result.velocity[1],
                outer_force_peak: result.contacts[0].force_peak,
                inner_force_peak: result.contacts[1].force_peak,
                outer_contact_end: result.contacts[0].end,
                inner_contact_end: result.contacts[1].end,
                outer_contacts: result.contacts[0].contacts,
                inner_contacts: result.contacts[1].contacts,
                first_frequency: system.first_frequency,
            },
            energy_residual: result.energy_residual,
            momentum_residual: result.momentum_residual,
            steps: result.steps,
            solve_seconds,
            uncertainty: Default::default(),
            mesh: None,
            solver: None,
            samples: None,
            sample_interval: None,
        }
    }
}

/// The oscillators and contacts of `model`.
fn system(setup: &PlateImpact, model: Model, modes: usize) -> Result<System> {
    let kirchhoff = || Ok(System::new(setup, &kirchhoff::modes(&setup.plate, modes)?, [0.0; 2]));
    match model {
        Model::A | Model::B => kirchhoff(),
        Model::C => {
            let patch = patch_radii(&kirchhoff()?)?;
            let mesh = MeshOptions::default();
            let plate = continuum::plate(&setup.plate, patch, modes, &mesh)?;
            let tip = |shape: &Shape, material: &Material, patch| match *shape {
                Shape::Sphere { radius } => continuum::sphere_residual(radius, material, patch, &mesh),
                // a compact body is rigid but for its Hertz contact
                Shape::Compact { .. } => Ok(0.0),
            };
            let tips = [
                tip(&setup.outer.shape, &setup.outer.material, patch[0])?,
                tip(&setup.inner.shape, &setup.inner.material, patch[1])?,
            ];
            Ok(System::new(setup, &plate, tips))
        }
    }
}

/// Radii in m of the contact patches over which model C weights loads: Hertz's at the force peaks of `system`, a
/// model of the same impact without residual. The result hardly depends on them: they are rounded, so that an
/// impact that is a little different finds its bodies in the cache.
fn patch_radii(system: &System) -> Result<[f64; 2]> {
    let rough = integrate(system, &Options { tolerance: 1e-3, ..Options::default() })?;
    let radius = |i: usize| rounded(system.laws[i].contact_radius(rough.contacts[i].force_peak));
    let outer = radius(0);
    // an inner body that is never reached takes the outer one's patch
    Ok([outer, if rough.contacts[1].contacts > 0 { radius(1) } else { outer }])
}

/// `value` with three significant digits: off by at most 0.5 %.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
