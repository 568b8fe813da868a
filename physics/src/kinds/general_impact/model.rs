//! The reduced model: rigid bodies, or a bender or stack with its modes, joined by one contact, or by two with an elastic body between.
//!
//! A rigid outer body and the inner one, if they meet, are solved in the frame of the inner one: errors are then relative to the closing
//! speed, however small it is compared with their own speeds.

mod sideways;

use super::between::Between;
use super::elastic::{self, ElasticBody, OnOtherMesh};
use super::scene::sphere_radius;
use super::{CURVES, GeneralImpact, ImpactQuantities, Kind, Struck};
use crate::body::free_sphere::sphere_residual;
use crate::dynamics::integration::{Converged, Integration, Options};
use crate::dynamics::memory::{self, Bending, Memory, OnsetOfYield};
use crate::dynamics::system::System;
use crate::dynamics::{MovingBody, StopReason, balance_check, error_control, integrate};
use crate::error::{Error, Result};
use crate::kinds::impacts::{Done, Impacts, SAMPLES_PER_CONTACT, stated_error, uncertain, uncountable};
use crate::kinds::rubbing::{Rubbed, Rubbing, is_settled, omitted_stiffening};
use crate::kinds::{Kind as _, SeriesModel};
use crate::material::Material;
use crate::numerics::stopwatch::Stopwatch;
use crate::result::{
    BenderSummary, CUT, ElasticLimit, History, Outcome, Point, StackSummary, Summary, Table,
};
use crate::scene::{self, Inner, Model, Outer, Scene};

/// Tolerance of the runs that compare force peaks with and without what the model omits.
const LOW_ACCURACY: f64 = 1e-6;
/// Quantities whose change is the error by modes or mesh.
const COMPARED: [&str; 3] = ["efficiency", "outer_force_peak", "inner_force_peak"];
/// Change of the force peak by it from which on there is a warning.
const NOTABLE: f64 = 0.01;

/// An impact on a wall or another body, ready to run.
#[derive(Debug)]
pub(super) struct ContactModel {
    scene: Scene,
    /// The impact along the common normal, and the share of the outer body's energy that it has.
    setup: GeneralImpact,
    normal_share: f64,
    system: System,
    /// Velocity in m/s along z of the frame in which `system` moves.
    frame: f64,
    memory: Option<Memory>,
    between: Option<Between>,
    /// Materials of what the outer and the inner body touch.
    faces: [Material; 2],
    /// See [`Self::rubbing`].
    rubbing: Option<Rubbing>,
}

impl ContactModel {
    /// Of `scene`, of an elastic body with so many `modes`, or all there are.
    ///
    /// # Errors
    /// [`Error::Scene`] for another kind of scene, [`Error::Solver`] for a stack that does not reach what it strikes, and as [`Memory::new`].
    pub(super) fn new(scene: &Scene, modes: Option<usize>) -> Result<Self> {
        let given = scene.general_impact()?;
        let setup = given.along_normal().into_owned();
        let frame = if setup.outer.shape.is_mounted() { 0.0 } else { setup.struck_velocity() };
        let outer = MovingBody::outer(&Outer { speed: setup.outer.speed + frame, ..setup.outer.clone() })?;
        let face = setup.face();
        let mut faces = [&*face; 2].map(Material::clone);
        let mut between = None;
        let system = match (&setup.struck, &setup.inner) {
            (Some(Struck::Wall(_)), _) => System::on_wall(outer, &face),
            (Some(Struck::Body(body)), inner) => {
                let elastic = ElasticBody::new(body, given.rubs_along())?;
                faces = elastic.faces(body).map(Material::clone);
                let (system, found) = Between::joined(elastic, body, outer, &setup.outer, inner.as_ref())?;
                between = Some(found);
                with_modes(system, modes)?
            }
            (Some(Struck::Plate(plate)), _) => {
                let (system, found) = Between::of_plate(plate, outer, &setup.outer)?;
                between = Some(found);
                with_modes(system, modes)?
            }
            (None, Some(inner)) => {
                let seen = Inner { speed: inner.speed - frame, gap: 0.0, ..inner.clone() };
                System::of_two_bodies(outer, MovingBody::inner(&seen))
            }
            (None, None) => return Err(Error::Internal("the outer body strikes nothing".into())),
        };
        let inner = setup.inner.as_ref().map_or(&*face, |inner| &inner.material);
        let memory =
            Memory::new([&setup.outer.material, &face, inner], setup.plate().map(Bending::new), &system)?;
        let normal_share = given.outer.angle.cos().powi(2);
        let (scene, setup) = (scene.clone(), setup.clone());
        let model = Self { scene, normal_share, system, frame, memory, between, faces, setup, rubbing: None };
        Ok(Self { rubbing: model.rubbing()?, ..model })
    }

    /// The results of an integration; those that a scene does not have are not determined.
    fn table(&self, result: &Integration) -> Table {
        let outer = &self.setup.outer;
        let [first, second] = result.velocity;
        let [contact, behind] = &result.contacts;
        let velocities = [first + self.frame, second + self.frame];
        let energy = |mass: f64, speed: f64| 0.5 * mass * speed * speed;
        let before = energy(self.system.masses[0], outer.speed) / self.normal_share;
        // velocity of what is struck at the outer contact, and of what pushes the inner body
        let [struck, pushed] = match &self.between {
            None => [second, 0.0],
            Some(between) => between.velocities(contact.impulse, behind.impulse),
        };
        let mut table = ImpactQuantities {
            efficiency: energy(self.system.masses[1], velocities[1]) / before,
            outer_velocity_final: velocities[0],
            inner_velocity_final: velocities[1],
            outer_force_peak: contact.force_peak,
            inner_force_peak: behind.force_peak,
            outer_contact_end: contact.end,
            inner_contact_end: behind.end,
            outer_contacts: contact.contacts,
            inner_contacts: behind.contacts,
            outer_restitution: (first - struck) / self.setup.closing_speed(),
            inner_restitution: (pushed - second) / self.setup.inner.as_ref().map_or(0.0, |inner| inner.speed),
            outer_impulse: contact.impulse,
            inner_impulse: behind.impulse,
            first_frequency: self.system.first_frequency,
        }
        .table();
        let pressed: &[&str] = match result.stop {
            StopReason::Pressed => &["outer_contact_end", "outer_contacts", "outer_impulse"],
            _ => &[],
        };
        let absent = ImpactQuantities::ALL.iter().map(|quantity| quantity.name);
        let absent = absent.filter(|name| !self.setup.has(name));
        for name in absent.chain(pressed.iter().copied()) {
            table.value_mut(name).into_iter().for_each(|value| *value = None);
        }
        if result.stop == StopReason::Cut { table.cut() } else { table }
    }

    /// What `of` makes of the impacts.
    fn with_impacts<R>(&self, of: impl FnOnce(Impacts) -> R) -> R {
        let values = |_: &System, result: &Integration| {
            let rubbed = self.rubbed(result).ok().flatten();
            self.of_all_motion(self.table(result), rubbed.as_ref())
        };
        of(Impacts {
            system: &self.system,
            fluid: None,
            memory: self.memory.as_ref(),
            rubbing: self.rubbing.as_ref(),
            series: self.setup.series,
            values: &values,
        })
    }

    fn options(&self, tolerance: f64) -> Options {
        Options { tolerance, end_time: self.scene.run.end_time, ..Options::default() }
    }

    /// The summary, what the materials remembered when the last impact began, and with which steps it converged.
    fn unjudged(&self, tolerance: f64) -> Result<(Summary, Option<Memory>, Option<Converged>)> {
        let start = Stopwatch::start();
        let options = Options { heat: true, ..self.options(tolerance) };
        let Done { last, impacts, memory, warnings } = self.with_impacts(|all| all.all(&options))?;
        let seconds = start.seconds();
        let mut summary = self.summary(&last, tolerance)?;
        summary.solve_seconds = seconds;
        summary.warnings.extend(warnings);
        summary.impacts = impacts;
        summary.elastic_efficiency = self.with_impacts(|all| all.elastic_efficiency(&options));
        summary.elastic_limit = self.elastic_limit(&options);
        Ok((summary, memory, last.converged))
    }

    /// `None` without yield strengths, and where a body relaxes or is clamped.
    fn elastic_limit(&self, options: &Options) -> Option<ElasticLimit> {
        let relaxes = self.setup.materials().iter().any(|material| !material.relaxation.is_empty());
        if self.setup.outer.shape.is_mounted() || relaxes {
            return None;
        }
        let faces = &self.faces;
        let inner = self.setup.inner.as_ref().map_or(&faces[1], |inner| &inner.material);
        let pairs = [[&self.setup.outer.material, &faces[0]], [inner, &faces[1]]];
        let onset = OnsetOfYield::new(pairs, self.setup.plate().map(Bending::new), &self.system)?;
        let [closing, _] = self.with_impacts(|all| all.elastic_speeds(&onset, options));
        let outer = closing.map(|speed| speed - self.frame).filter(|speed| *speed > 0.0);
        Some(ElasticLimit { outer, inner: None })
    }

    /// Estimated error by what the model omits: higher modes of an elastic body, found with fewer of them, or how spheres deform.
    fn truncation(&self) -> Option<f64> {
        match &self.between {
            Some(between) => self.change(&self.system, &self.with_fewer_modes(between)),
            None => Some(self.omitted_flexibility()),
        }
    }

    /// Largest difference between two systems of the scene of efficiency (without an inner body: restitution, absolute) and force peaks,
    /// relative; `None` if one of them has no result, or one in contact.
    fn change(&self, own: &System, other: &System) -> Option<f64> {
        let (own, other) = (self.roughly(own)?, self.roughly(other)?);
        let both = |name: &str| own.value(name).zip(other.value(name));
        let relative = |name: &&str| {
            both(name).filter(|(own, _)| *own != 0.0).map(|(own, other)| (other / own - 1.0).abs())
        };
        let rebound = both("outer_restitution").filter(|_| self.setup.inner.is_none());
        let rebound = rebound.map(|(own, other)| (other - own).abs());
        COMPARED.iter().filter_map(relative).chain(rebound).max_by(f64::total_cmp)
    }

    /// Results of `system`, one of the scene; `None` if there are none, or one in contact.
    fn roughly(&self, system: &System) -> Option<Table> {
        let result = integrate(system, None, &self.options(LOW_ACCURACY)).ok()?;
        (result.stop != StopReason::Cut).then(|| self.table(&result))
    }

    /// The scene's system with fewer modes, as the error for want of modes is found.
    fn with_fewer_modes(&self, between: &Between) -> System {
        self.system.lowest(self.system.modes.saturating_sub(between.fewer))
    }

    /// Relative change of the force peak by the flexibility of spheres beyond that of Hertz's half-spaces, which the model omits.
    fn omitted_flexibility(&self) -> f64 {
        let hit = self.system.hertz_impact();
        let patch = (self.system.laws[0].tip_radius * hit.approach_peak()).sqrt();
        let inner = self.setup.inner.as_ref().map(|inner| (&inner.shape, &inner.material));
        let bodies = [Some((&self.setup.outer.shape, &self.setup.outer.material)), inner];
        let residual = bodies.into_iter().flatten().filter_map(|(shape, material)| {
            sphere_radius(shape).map(|radius| sphere_residual(radius, material, patch))
        });
        let softer = self.system.softer([residual.sum(), 0.0, 0.0]);
        let peak = |system: &System| {
            let result = integrate(system, None, &self.options(LOW_ACCURACY)).ok()?;
            Some(result.contacts[0].force_peak).filter(|peak| *peak > 0.0)
        };
        let change = peak(&self.system).zip(peak(&softer)).map(|(own, softer)| (softer / own - 1.0).abs());
        change.unwrap_or(f64::INFINITY)
    }

    fn summary(&self, result: &Integration, tolerance: f64) -> Result<Summary> {
        let tolerance = tolerance.max(result.least_tolerance);
        let is_cut = result.stop == StopReason::Cut;
        let omitted = self.truncation();
        let mut warnings = scene::doubts(&self.scene);
        let what = match &self.between {
            None => "the model omits how spheres deform beyond their contact, which changes the peak force",
            Some(_) => "the model omits higher modes of the body, which change forces or efficiency",
        };
        let notable = omitted.filter(|error| *error > NOTABLE);
        warnings.extend(notable.map(|error| format!("{what} by about {:.1} %", 100.0 * error)));
        let mesh_error = self.between.as_ref().and_then(|between| {
            let other = between.other.as_ref()?;
            Some(other.share.abs() * self.change(&self.system, &other.found.lowest(self.system.modes))?)
        });
        warnings.extend(mesh_error.filter(|error| *error > NOTABLE).map(|error| {
            format!("the body's mesh changes forces or efficiency by about {:.1} %: refine it", 100.0 * error)
        }));
        warnings.extend(self.between.iter().flat_map(|between| between.warnings.iter().cloned()));
        warnings.extend(uncertain(result, tolerance));
        if let (Some(memory), true) = (&self.memory, result.least_tolerance > 0.0) {
            warnings.extend(memory.warnings.iter().cloned());
            warnings.extend(result.error_estimate.filter(|error| *error > memory::CHANGE / 3.0).map(|error| {
                format!("velocities and peak forces are uncertain by {error:.0e}: the step length has not converged")
            }));
        }
        if result.contacts[0].contacts == 0 {
            warnings.push("the bodies are never in contact".into());
        }
        warnings.extend(uncountable(result, tolerance));
        warnings.extend(balance_check(result.energy_residual, result.momentum_residual, tolerance)?);
        let face_yields = self.faces[0].plasticity().is_some();
        warnings.extend((face_yields && self.setup.struck_inner().is_some()).then(|| {
            "the law of plastic contacts takes the inner body's tip as flat and the outer one's as more curved instead".into()
        }));
        let rubbed = self.rubbed(result)?;
        warnings.extend(rubbed.iter().flat_map(Rubbed::warnings));
        let table = self.of_all_motion(self.table(result), rubbed.as_ref());
        let is_omitted = self.rubbing.is_none();
        if is_omitted && self.scene.general_impact()?.moves_along() {
            warnings.push("motion along the surfaces is omitted by the reduced model".into());
        }
        if self.memory.is_some() || self.setup.body().is_some() {
            let scene = self.scene.general_impact()?;
            warnings.extend(omitted_stiffening(self.touching(scene), &scene.outer, scene.inner.as_ref()));
        }
        warnings.extend(is_cut.then(|| CUT.to_owned()));
        let transmitted = self.setup.inner_mass().map(|mass| 0.5 * mass * result.velocity[1].powi(2));
        let transmitted = transmitted.filter(|_| !is_cut);
        let frequencies = match (self.scene.reduced.frequencies, self.setup.body()) {
            (Some(count), Some(body)) => elastic::frequencies(body, count)?,
            _ => Vec::new(),
        };
        let system = &self.system;
        Ok(Summary {
            frequencies,
            energy_residual: Some(result.energy_residual),
            momentum_residual: Some(result.momentum_residual),
            steps: Some(result.steps),
            integration_error: stated_error(result),
            truncation_error: omitted,
            mesh_error,
            bender: system.drive.map(|drive| BenderSummary {
                strain_energy_efficiency: transmitted.map(|energy| energy / drive.strain_energy),
                drive,
            }),
            stack: result.supplied.map(|supplied| StackSummary {
                electrical_energy: supplied.taken,
                mechanical_energy: supplied.given,
                share: transmitted.map(|energy| energy / supplied.taken),
            }),
            losses: self.memory.is_some().then_some(result.losses),
            friction_work: rubbed.as_ref().and_then(Rubbed::friction_work),
            sideways: rubbed.map(|rubbed| rubbed.sideways),
            warnings,
            ..Summary::of_reduced(&self.scene, Model::C, system.modes, table)
        })
    }

    /// The curves of the scene's bodies from all those of the dynamics.
    fn history(&self, all: &History) -> History {
        let own = CURVES.iter().filter(|curve| self.setup.has(curve.name));
        let curves = own.map(|curve| {
            let mut curve = curve.clone();
            curve.values.clone_from(&all[curve.name]);
            let moves = self.frame != 0.0;
            for (value, time) in curve.values.iter_mut().zip(&all.time).filter(|_| moves) {
                *value += match curve.unit {
                    "m" => self.frame * time,
                    "m/s" => self.frame,
                    _ => 0.0,
                };
            }
            curve
        });
        History { time: all.time.clone(), curves: curves.collect() }
    }
}

/// `system` with its lowest `modes`, all if none are named.
fn with_modes(system: System, modes: Option<usize>) -> Result<System> {
    match modes {
        Some(modes) if modes > system.modes => {
            Err(Error::Usage(format!("--modes {modes}: what is struck has {} at most", system.modes)))
        }
        Some(modes) => Ok(system.lowest(modes)),
        None => Ok(system),
    }
}

/// Results of model C of a scene with an elastic body, and what they would be with another basis and mesh; those not determined are `None`.
#[derive(Debug)]
pub struct Neighbours {
    /// As the model has them.
    pub own: Option<Table>,
    /// With fewer modes.
    pub fewer_modes: Option<Table>,
    /// On another mesh, if there is one.
    pub other_mesh: Option<OnOtherMesh<Table>>,
}

/// What modes and mesh change in the results of `scene`; `None` if nothing elastic lies between the bodies.
///
/// # Errors
/// Those of the model.
pub fn neighbours(scene: &Scene) -> Result<Option<Neighbours>> {
    let model = ContactModel::new(scene, None)?;
    let Some(between) = &model.between else { return Ok(None) };
    let other = between.other.as_ref().and_then(|other| {
        let found = model.roughly(&other.found.lowest(model.system.modes))?;
        Some(OnOtherMesh { found, share: other.share })
    });
    Ok(Some(Neighbours {
        own: model.roughly(&model.system),
        fewer_modes: model.roughly(&model.with_fewer_modes(between)),
        other_mesh: other,
    }))
}

/// Relative difference of the force peak of `scene`, with elastic bodies, from Hertz's closed form; `None` for a bender or stack, which
/// have modes of their own, and on an elastic body.
///
/// # Errors
/// [`Error::Scene`] for another kind of scene, and as [`integrate`].
pub fn difference_from_hertz(scene: &Scene) -> Result<Option<f64>> {
    let model = ContactModel::new(scene, None)?;
    if model.between.is_some() || model.setup.outer.shape.is_mounted() {
        return Ok(None);
    }
    let hit = model.system.hertz_impact();
    let options = Options { end_time: Some(2.0 * hit.duration()), ..Options::default() };
    let run = integrate(&model.system, None, &options)?;
    Ok(Some((run.contacts[0].force_peak / hit.force_peak() - 1.0).abs()))
}

impl SeriesModel for ContactModel {
    fn run_with_history(&self, tolerance: f64) -> Result<Outcome> {
        let (mut summary, memory, converged) = self.unjudged(tolerance)?;
        let sample_interval = Some(self.system.hertz_impact().duration() / SAMPLES_PER_CONTACT);
        let options = Options { sample_interval, converged, ..self.options(tolerance) };
        let (result, _) = self.with_impacts(|all| all.one(&options, memory.as_ref()))?;
        let all = result.history.ok_or_else(|| Error::Internal("a history was requested".into()))?;
        let history = self.history(&all);
        summary.samples = Some(history.len());
        Kind.judge(&self.scene, &mut summary, Some(&history));
        Ok(Outcome { summary, history })
    }

    fn run(&self, tolerance: f64) -> Result<Summary> {
        let (mut summary, ..) = self.unjudged(tolerance)?;
        Kind.judge(&self.scene, &mut summary, None);
        Ok(summary)
    }

    /// `tolerance` bounds the error of the time integration in all results.
    fn point(&self, tolerance: f64) -> Result<Point<Table>> {
        let options = error_control::all_within(tolerance, self.options(tolerance));
        let result = self.with_impacts(|all| all.all(&options))?.last;
        let least = result.least_tolerance;
        balance_check(result.energy_residual, result.momentum_residual, tolerance.max(least))?;
        if result.stop == StopReason::Cut {
            return Err(Error::Solver(CUT.into()));
        }
        let enough = options.results.unwrap_or(error_control::ENOUGH * options.tolerance).max(least);
        Ok(Point {
            quantities: self.of_all_motion(self.table(&result), self.rubbed(&result)?.as_ref()),
            energy_residual: result.energy_residual,
            momentum_residual: result.momentum_residual,
            steps: result.steps,
            converged: result.error_estimate.is_none_or(|error| error <= enough)
                && is_settled(&result, enough),
        })
    }
}
