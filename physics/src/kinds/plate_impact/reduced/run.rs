//! Runs of a reduced model, and what they come to.

use super::{Point, Reduced, touching};
use crate::dynamics::StopReason;
use crate::dynamics::balance_check;
use crate::dynamics::error_control;
use crate::dynamics::integration::{Converged, Integration, NEGLIGIBLE, Options, SAMPLES_BETWEEN};
use crate::dynamics::integrator::integrate;
use crate::dynamics::memory::{self, Bending, Memory, OnsetOfYield};
use crate::dynamics::system::System;
use crate::error::{Error, Result};
use crate::kinds::impacts::{Done, Impacts, SAMPLES_PER_CONTACT, stated_error, uncertain, uncountable};
use crate::kinds::plate_impact::results::{PlateQuantities, quantities, values};
use crate::kinds::plate_impact::trials::TruncationError;
use crate::kinds::plate_impact::truncation;
use crate::kinds::plate_impact::validity::film_warning;
use crate::kinds::plate_impact::{Kind, PlateImpact};
use crate::kinds::rubbing::{Rubbed, is_settled, omitted_stiffening};
use crate::kinds::{Kind as _, SeriesModel};
use crate::numerics::stopwatch::Stopwatch;
use crate::result::{
    self, BenderSummary, CUT, ElasticLimit, History, Outcome, StackSummary, Summary, Table, limit,
};
use crate::scene::{self, Edge, Outer, Shape};

/// Samples within steps and flights of a history that only the limits need: the deflection is sampled.
const JUDGED_SAMPLES: usize = 1 << 12;
/// Error of a point's force peaks from looking for them, in tolerances: below what they are wrong by.
const PEAK_ERROR: f64 = 0.1;
/// Error of the time integration in runs that compare meshes, and error by the mesh from which on there is a warning.
const MESH_TOLERANCE: f64 = 1e-6;
const LARGEST_MESH_ERROR: f64 = 0.01;
/// Change of forces by the way that a contact moves, relative, from which on there is a warning.
const NOTABLE_WAY: f64 = 0.01;
/// Relative change of the efficiency over that of the first mode at a contact that moves: 1.3 to 2.5 in three scenes of the validation base
/// (oblique-007, 054 and 080, with their contacts kept in place).
const EFFICIENCY_PER_CHANGE: f64 = 2.5;
/// Share of a bender's moment at the strike from which on there is a warning.
const MOMENT_LEFT: f64 = 0.01;

/// A sentence where the outer body of `setup` slides so far along the plate, during the contact that `result` has, that the plate answers
/// otherwise than the model has it. Contacts move over held plates, whose modes follow by their slopes: left is the curvature of the first mode
/// (1 - r^2/R^2)^2. On a free plate they stay.
fn slides_away(setup: &PlateImpact, result: &Integration, rubbed: &Rubbed) -> Option<String> {
    let Outer { speed, angle, offset, .. } = setup.outer;
    let along = 0.5 * (speed * angle.sin() + rubbed.sideways.outer_tangential_velocity_final);
    let way = along.abs() * result.contacts[0].end;
    let radius = setup.plate.radius;
    let (what, change) = match setup.plate.edge {
        Edge::Free => {
            let change = 2.0 * offset * way / (radius.powi(2) - offset * offset);
            ("but the model of a free plate keeps the contact in place", EFFICIENCY_PER_CHANGE * change)
        }
        Edge::Clamped | Edge::SimplySupported => {
            ("where the model has its modes to the first order alone", 2.0 * (way / radius).powi(2))
        }
    };
    (change > NOTABLE_WAY).then(|| {
        format!(
            "the outer body slides {:.2} mm along the plate, {what}: forces and efficiency may be wrong by about {:.0} %",
            1e3 * way,
            100.0 * change
        )
    })
}

/// Change of the inner body's velocity over the impact speed, in tolerances, below which its results are the integration's error.
fn unresolved(system: &System, result: &Integration, tolerance: f64) -> Option<String> {
    let change = (result.velocity[1] - system.inner_velocity()).abs();
    let error = error_control::ENOUGH * tolerance * system.speed;
    (result.contacts[1].force_peak > 0.0 && change < error).then(|| {
        format!(
            "the velocity of the inner body changes by {change:.1e} m/s, less than the {error:.1e} m/s that the time integration may be wrong by: its results show no more than that the plate hardly moves it"
        )
    })
}

impl Reduced {
    fn impacts(&self) -> Impacts<'_> {
        let series = self.scene.plate_impact().ok().and_then(|setup| setup.series);
        Impacts {
            system: &self.system,
            fluid: self.fluid.as_ref(),
            memory: self.memory.as_ref(),
            rubbing: self.rubbing.as_ref(),
            series,
            values: &|system, result| values(system, result).table(),
        }
    }

    /// Runs the impact without keeping its history; `tolerance` bounds the efficiency's relative error from the
    /// time integration.
    ///
    /// # Errors
    /// As [`crate::dynamics::integrate`] and [`balance_check`].
    pub fn run(&self, tolerance: f64) -> Result<Summary> {
        let (mut summary, ..) = self.unjudged(tolerance)?;
        Kind.judge(&self.scene, &mut summary, None);
        self.add_flight(&mut summary)?;
        Ok(summary)
    }

    /// What the scene asks of the flight after the impact.
    fn add_flight(&self, summary: &mut Summary) -> Result<()> {
        let given = || Err(Error::Internal("a flight behind a plate names its restitution".into()));
        crate::kinds::flight::add_flight(&self.scene, summary, given)
    }

    /// The summary, what the materials remembered when the last impact began, and with which steps it converged.
    fn unjudged(&self, tolerance: f64) -> Result<(Summary, Option<Memory>, Option<Converged>)> {
        let start = Stopwatch::start();
        let options = Options { heat: true, ..self.options(tolerance) };
        let Done { last, impacts, memory, warnings } = self.impacts().all(&options)?;
        let mut summary = self.summary(&last, tolerance, start.seconds())?;
        summary.warnings.extend(warnings);
        let elastic_efficiency = self.impacts().elastic_efficiency(&options);
        let elastic_limit = self.elastic_limit(&options)?;
        summary.warnings.extend(self.yields_by_bending(elastic_limit, &last)?);
        Ok((Summary { impacts, elastic_efficiency, elastic_limit, ..summary }, memory, last.converged))
    }

    /// What the bodies do along the plate, of a `result` with forces; `None` where they do not move so, or the run was cut.
    fn rubbed(&self, result: &Integration) -> Result<Option<Rubbed>> {
        self.rubbing.as_ref().map_or(Ok(None), |rubbing| rubbing.solve(result))
    }

    /// `None` without yield strengths, and where bodies relax or bend before they strike.
    fn elastic_limit(&self, options: &Options) -> Result<Option<ElasticLimit>> {
        let setup = self.scene.plate_impact()?;
        let materials = setup.materials();
        let covered = !setup.outer.shape.is_mounted()
            && setup.outer.is_centred()
            && materials.iter().all(|m| m.relaxation.is_empty());
        let limit = |onset: OnsetOfYield| {
            let [outer, inner] = self.impacts().elastic_speeds(&onset, options);
            ElasticLimit { outer, inner }
        };
        let [outer, plate, inner] = materials;
        Ok(OnsetOfYield::new(
            [[outer, plate], [inner, plate]],
            Some(Bending::new(&setup.plate)),
            &self.system,
        )
        .filter(|_| covered)
        .map(limit))
    }

    /// Contacts of an elastic model whose pressure alone would not yield, but does with the bending of the plate.
    fn yields_by_bending(&self, limit: Option<ElasticLimit>, result: &Integration) -> Result<Vec<String>> {
        let setup = self.scene.plate_impact()?;
        let Some(limit) = limit.filter(|_| !setup.yields()) else { return Ok(Vec::new()) };
        let plate = &setup.plate.material;
        let bodies =
            [("outer", limit.outer, &setup.outer.material), ("inner", limit.inner, &setup.inner.material)];
        let contacts = bodies.into_iter().zip(&self.system.laws).zip(&result.contacts);
        let warnings = contacts.filter_map(|(((body, speed, material), law), contact)| {
            let speed = speed.filter(|speed| *speed < self.system.speed)?;
            let by_pressure = limit::of_contact(body, law, contact.force_peak, &[material, plate])
                .any(|limit| limit.is_of_yield() && limit.is_exceeded());
            (!by_pressure).then(|| {
                format!(
                    "the {body} contact yields from an impact speed of {speed:.3} m/s on, where the bending of the plate adds to its stress, but the model is elastic; specify `hardening` of the material, or reduce the speed"
                )
            })
        });
        Ok(warnings.collect())
    }

    /// Runs the impact for its results alone, as a series of many needs them.
    ///
    /// # Errors
    /// As [`Reduced::run`], [`Error::Solver`] if the run is cut during a contact.
    pub fn point(&self, tolerance: f64) -> Result<Point> {
        self.solved(tolerance, self.options(tolerance))
    }

    /// As [`Reduced::point`] with all results right to `error`, as [`error_control::all_within`] has it, or
    /// [`Point::converged`] false.
    ///
    /// # Errors
    /// As [`Reduced::point`].
    pub fn all_within(&self, error: f64) -> Result<Point> {
        self.solved(error, error_control::all_within(error, self.options(error)))
    }

    /// The results with `options`, whose ledger balances to `tolerance`.
    fn solved(&self, tolerance: f64, options: Options) -> Result<Point> {
        let options = Options { peak_error: PEAK_ERROR * options.tolerance, ..options };
        let result = self.impacts().all(&options)?.last;
        balance_check(
            result.energy_residual,
            result.momentum_residual,
            tolerance.max(result.least_tolerance),
        )?;
        let enough =
            options.results.unwrap_or(error_control::ENOUGH * options.tolerance).max(result.least_tolerance);
        Ok(Point {
            quantities: self
                .of_all_energy(quantities(&self.system, &result)?, self.rubbed(&result)?.as_ref()),
            energy_residual: result.energy_residual,
            momentum_residual: result.momentum_residual,
            steps: result.steps,
            converged: result.error_estimate.is_none_or(|error| error <= enough)
                && is_settled(&result, enough),
        })
    }

    /// Runs the impact and keeps its history. The summary's time is that of a run without history.
    ///
    /// # Errors
    /// As [`Reduced::run`].
    pub fn run_with_history(&self, tolerance: f64) -> Result<Outcome> {
        self.run_with_history_until(tolerance, 0.0)
    }

    /// As [`Reduced::run_with_history`] with a history of no more samples in flight than the limits need, which does not count as one
    /// that was kept.
    ///
    /// # Errors
    /// As [`Reduced::run`].
    pub fn run_judged(&self, tolerance: f64) -> Result<Outcome> {
        let mut outcome = self.sampled(tolerance, 0.0, JUDGED_SAMPLES)?;
        outcome.summary.samples = None;
        Ok(outcome)
    }

    /// As [`Reduced::run_with_history`]; a history that would end earlier, because no further contact is possible, goes on
    /// until `end` (s) unless the scene names its end.
    ///
    /// # Errors
    /// As [`Reduced::run`].
    pub fn run_with_history_until(&self, tolerance: f64, end: f64) -> Result<Outcome> {
        self.sampled(tolerance, end, SAMPLES_BETWEEN)
    }

    /// Results and history of a single impact, from one integration.
    fn unjudged_course(&self, tolerance: f64) -> Result<(Table, History)> {
        let sample_interval = Some(self.system.hertz_impact().duration() / SAMPLES_PER_CONTACT);
        let options = Options { sample_interval, ..self.options(tolerance) };
        let (result, _) = self.impacts().one(&options, self.memory.as_ref())?;
        let table = self.table(&result, self.rubbed(&result)?.as_ref());
        Ok((table, result.history.ok_or_else(|| Error::Internal("a history was requested".into()))?))
    }

    /// A run until `end` s with at most `samples_between` samples within steps and flights.
    fn sampled(&self, tolerance: f64, end: f64, samples_between: usize) -> Result<Outcome> {
        let (mut summary, memory, converged) = self.unjudged(tolerance)?;
        let system = &self.system;
        let sample_interval = Some(system.hertz_impact().duration() / SAMPLES_PER_CONTACT);
        let options = Options { sample_interval, samples_between, converged, ..self.options(tolerance) };
        let record = |options: &Options| -> Result<_> {
            let (result, _) = self.impacts().one(options, memory.as_ref())?;
            result.history.ok_or_else(|| Error::Internal("a history was requested".into()))
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

    /// `quantities` of the motion along the plate's normal with the efficiency of all motion.
    fn of_all_energy(&self, quantities: PlateQuantities, rubbed: Option<&Rubbed>) -> PlateQuantities {
        let Ok(PlateImpact { outer, .. }) = self.scene.plate_impact() else { return quantities };
        let [outer_mass, inner_mass] = self.system.masses;
        let along = rubbed.and_then(|rubbed| rubbed.sideways.inner_tangential_velocity_final);
        let along =
            along.map_or(0.0, |along| inner_mass * along * along / (outer_mass * outer.speed * outer.speed));
        let efficiency = quantities.efficiency * outer.angle.cos().powi(2) + along;
        PlateQuantities { efficiency, ..quantities }
    }

    /// Relative error by the mesh of the plate, from what another one changes.
    fn mesh_error(&self) -> Option<f64> {
        let options = Options { tolerance: MESH_TOLERANCE, ..self.options(MESH_TOLERANCE) };
        let run = |system: &System| quantities(system, &integrate(system, &options).ok()?).ok();
        let other = self.other.as_ref()?;
        let (found, own) = (run(&other.found)?, run(&self.system)?);
        Some(other.share.abs() * TruncationError::between(&found, &own, self.system.speed).error)
    }

    fn options(&self, tolerance: f64) -> Options {
        Options { tolerance, end_time: self.scene.run.end_time, ..Options::default() }
    }

    /// The quantities of `result`, without those that it does not determine.
    fn table(&self, result: &Integration, rubbed: Option<&Rubbed>) -> Table {
        let system = &self.system;
        let mut table = self.of_all_energy(values(system, result), rubbed).table();
        if result.stop == StopReason::Cut {
            table = table.cut();
        }
        if system.stack.is_some() {
            // eq. (1) relates to a kinetic energy before the impact, and the tip vibrates on
            let open = ["efficiency", "outer_velocity_final"].into_iter();
            let pressing = ["outer_contact_end", "outer_contacts"]
                .into_iter()
                .filter(|_| result.stop == StopReason::Pressed);
            for name in open.chain(pressing) {
                table.value_mut(name).into_iter().for_each(|value| *value = None);
            }
        }
        table
    }

    fn summary(&self, result: &Integration, tolerance: f64, solve_seconds: f64) -> Result<Summary> {
        let (system, tolerance) = (&self.system, tolerance.max(result.least_tolerance));
        let setup = &*self.scene.plate_impact()?.along_normal();
        let end_time = self.scene.run.end_time;
        let truncation =
            truncation::estimate(setup, self.model, system, self.omega_next, end_time, result.steps)?;
        let mesh_error = self.mesh_error();
        let even_steps = result.least_tolerance > 0.0;
        let mut warnings = scene::doubts(&self.scene);
        warnings.extend(self.warnings.iter().cloned());
        warnings.extend(truncation.warning);
        warnings.extend(mesh_error.filter(|error| *error > LARGEST_MESH_ERROR).map(|error| {
            format!("the plate's mesh changes forces or efficiency by about {:.1} %", 100.0 * error)
        }));
        let rubbed = self.rubbed(result)?;
        warnings.extend(rubbed.iter().flat_map(Rubbed::warnings));
        let given = self.scene.plate_impact()?;
        warnings.extend(rubbed.iter().filter_map(|rubbed| slides_away(given, result, rubbed)));
        if self.memory.is_some() {
            let contacts = touching(setup, system);
            warnings.extend(omitted_stiffening(contacts, &setup.outer, Some(&setup.inner)));
        }
        warnings.extend(film_warning(result.losses.squeeze_film, system));
        warnings.extend(uncertain(result, tolerance));
        if let (Some(memory), true) = (&self.memory, even_steps) {
            warnings.extend(memory.warnings.iter().cloned());
            warnings.extend(result.error_estimate.filter(|error| *error > memory::CHANGE / 3.0).map(|error| {
                format!("velocities and peak forces are uncertain by {error:.0e}: step length and bending of the plate have not converged")
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
            if contact.contacts > 0 {
                continue;
            }
            warnings.push(match contact.force_peak > 0.0 {
                false => format!("the {body} body and the plate are never in contact"),
                true => format!(
                    "the {body} body and the plate are in contact with an impulse of {:.1e} N s, below {NEGLIGIBLE:.0e} of the outer body's momentum: it does not count as a contact",
                    contact.impulse
                ),
            });
        }
        warnings.extend(unresolved(system, result, tolerance));
        warnings.extend(uncountable(result, tolerance));
        warnings.extend(balance_check(result.energy_residual, result.momentum_residual, tolerance)?);
        if result.stop == StopReason::Cut {
            warnings.push(CUT.into());
        }
        let table = self.table(result, rubbed.as_ref());
        Ok(Summary {
            energy_residual: Some(result.energy_residual),
            momentum_residual: Some(result.momentum_residual),
            steps: Some(result.steps),
            solve_seconds,
            integration_error: stated_error(result),
            mesh_error,
            truncation_error: Some(truncation.error),
            bender: system.drive.map(|drive| {
                let transmitted = 0.5 * system.masses[1] * result.velocity[1].powi(2);
                let efficiency = transmitted / drive.strain_energy;
                BenderSummary {
                    strain_energy_efficiency: (result.stop != StopReason::Cut).then_some(efficiency),
                    drive,
                }
            }),
            stack: result.supplied.map(|supplied| {
                let transmitted = 0.5 * system.masses[1] * result.velocity[1].powi(2);
                StackSummary {
                    electrical_energy: supplied.taken,
                    mechanical_energy: supplied.given,
                    share: (result.stop != StopReason::Cut).then_some(transmitted / supplied.taken),
                }
            }),
            losses: (system.is_damped() && system.stack.is_none()
                || self.fluid.is_some()
                || self.memory.is_some())
            .then_some(result.losses),
            friction_work: rubbed.as_ref().and_then(Rubbed::friction_work),
            sideways: rubbed.map(|rubbed| rubbed.sideways),
            warnings,
            choice: self.choice.clone(),
            ..Summary::of_reduced(&self.scene, self.model, system.modes, table)
        })
    }
}

impl SeriesModel for Reduced {
    fn run_with_history(&self, tolerance: f64) -> Result<Outcome> {
        Reduced::run_with_history(self, tolerance)
    }

    fn run(&self, tolerance: f64) -> Result<Summary> {
        Reduced::run(self, tolerance)
    }

    fn course(&self, tolerance: f64) -> Result<(Table, History)> {
        if self.scene.plate_impact()?.series.is_none() {
            return self.unjudged_course(tolerance);
        }
        let Outcome { summary, history } = Reduced::run_with_history(self, tolerance)?;
        Ok((summary.quantities, history))
    }

    /// `tolerance` bounds the error of the time integration in all results.
    fn point(&self, tolerance: f64) -> Result<result::Point<Table>> {
        self.all_within(tolerance).map(|point| point.map(|found| found.table()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Model, Scene};

    /// A result whose ledger is off says so, and is none if it is far off.
    #[test]
    fn the_balance_of_a_run_is_judged() {
        let text = include_str!("../../../../../tests/fixtures/plate-impact.toml");
        let scene = Scene::parse("plate-impact.toml", text).unwrap();
        let reduced = Reduced::new(&scene, Model::B, None).unwrap();
        let sound = reduced.impacts().all(&reduced.options(1e-7)).unwrap().last;
        let summary = |energy_residual: f64| {
            reduced.summary(&Integration { energy_residual, ..sound.clone() }, 1e-7, 0.0)
        };
        assert_eq!(summary(sound.energy_residual).unwrap().warnings, Vec::<String>::new());
        let off = summary(1e-5).unwrap();
        assert!(off.warnings.iter().any(|w| w.contains("balance of energy")), "{:?}", off.warnings);
        assert!(matches!(summary(0.02), Err(Error::Solver(_))));
    }
}
