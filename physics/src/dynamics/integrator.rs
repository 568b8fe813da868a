//! The time integration of a plate impact: steps of adapted length while bodies touch, exact flight between.

mod judged;
mod peaks;

use self::judged::StepVerdict;
use super::batch::in_blocks;
use super::collocation::{Collocation, POINTS};
use super::contact_balance::{ContactBalance, StepCourse};
use super::contact_forces::{Course, ForceError, StepSolver};
use super::driver::{self, Stepper};
use super::free_flight::{self, Flight};
use super::heating;
use super::integration::{Closing, FluidAccount, Integration, NEGLIGIBLE, Options};
use super::recorder::Recorder;
use super::step_bounds::{AdaptedLength, EnergyAccount, StepBounds, base_step, force_scale, momentum_scale};
use super::step_tables::StepTables;
use super::system::{System, dot};
use super::tangential_load::GivenLoad;
use crate::error::{Error, Result};
use crate::numerics::stages::{STAGES, Stages};
use std::sync::LazyLock;
use wide::f64x4;

/// Contacts beyond which the impact itself does not end: contact chatter of a light plate between heavy bodies that approach each other.
const CHATTER: u32 = 1000;
/// Turn of the quickest vibration per step, rad, from which on the steps are no shorter than it needs: then a foil vibrates too long on a
/// stiff contact, quicker than any of its modes.
const TURN_PER_STEP: f64 = 0.1;
/// Share of a force's admissible defect at which the sweeps may end.
const CONVERGED: f64 = 0.1;
/// Corrections of a touch by what the contacts move over the plate until then; each leaves a hundredth.
const LANDINGS: usize = 4;
/// Level of the first step after a touch.
const START_LEVEL: i32 = 4;

/// Integrates the impact.
///
/// # Errors
/// [`Error::Solver`] if the contact has no equilibrium, the step falls below 2^-44 of its base length, or the run does not end;
/// [`Error::BeyondModel`] if it does not since the bodies rattle, or tremble on their contacts.
pub fn integrate(system: &System, options: &Options) -> Result<Integration> {
    static COLLOCATION: LazyLock<Collocation> = LazyLock::new(Collocation::default);
    let recorder = Recorder::new(system, &COLLOCATION, options);
    let mut stepper = DryStepper::new(system, &COLLOCATION, options, recorder);
    driver::run(&mut stepper)?;
    Ok(stepper.finish())
}

/// State of a run.
struct DryStepper<'a> {
    solver: StepSolver<'a>,
    recorder: Option<Recorder<'a>>,
    end_time: f64,
    bounds: StepBounds,
    length: AdaptedLength,
    tables: StepTables,
    time: f64,
    q: Vec<f64x4>,
    v: Vec<f64x4>,
    next_q: Vec<f64x4>,
    next_v: Vec<f64x4>,
    /// The latest step.
    course: Course,
    energy: EnergyAccount,
    contacts: [ContactBalance; 2],
    steps: u64,
    /// See [`Options`].
    peak_error: f64,
    /// Heat in the drive of a stack, J, if it is asked for.
    heat: Option<f64>,
    damped: bool,
    /// What a load along the surfaces has done.
    given: GivenLoad,
}

/// `blocks` as single coordinates; the last of them may be filled up with ones at rest.
fn flat(blocks: &[f64x4]) -> &[f64] {
    bytemuck::cast_slice(blocks)
}

impl<'a> DryStepper<'a> {
    fn new(
        system: &'a System,
        collocation: &'a Collocation,
        options: &Options,
        recorder: Option<Recorder<'a>>,
    ) -> Self {
        let (q, v) = system.initial_state();
        let (q, v) = (in_blocks(&q), in_blocks(&v));
        let hit = system.hertz_impact();
        Self {
            recorder,
            end_time: options.end_time.unwrap_or(f64::INFINITY),
            length: AdaptedLength::new(base_step(hit.duration(), options.tolerance), START_LEVEL),
            energy: EnergyAccount::new(&hit, system.kinetic_energy(), options.tolerance),
            bounds: StepBounds::new(options.tolerance),
            tables: StepTables::new(q.len()),
            time: 0.0,
            next_q: q.clone(),
            next_v: v.clone(),
            course: at_rest(
                system.modal_approach(flat(&q)),
                system.energy(&system.start[0], &system.start[1]),
            ),
            solver: StepSolver::new(system, collocation),
            q,
            v,
            contacts: [ContactBalance::new(NEGLIGIBLE * system.masses[0] * system.speed); 2],
            steps: 0,
            peak_error: options.peak_error,
            heat: options.heat.then_some(0.0),
            damped: system.is_damped(),
            given: GivenLoad::default(),
        }
    }

    /// Whether all that goes on is a stack that presses on the plate, in a run without an end.
    fn only_presses(&self) -> bool {
        let (system, n) = (self.solver.system, self.solver.system.size());
        system.stack.is_some()
            && self.end_time.is_infinite()
            && free_flight::inner_is_gone(system, &flat(&self.q)[..n], &flat(&self.v)[..n])
    }

    /// When a flight ends that would take `duration` s if the contacts stayed where they are over the plate, s.
    fn landing(&self, duration: f64) -> f64 {
        let system = self.solver.system;
        if system.tangential_load.is_none() {
            return duration;
        }
        let mut flight = duration;
        for _ in 0..LANDINGS {
            let (mut q, mut v) = (self.q.clone(), self.v.clone());
            free_flight::advance(
                system,
                flight,
                bytemuck::cast_slice_mut(&mut q),
                bytemuck::cast_slice_mut(&mut v),
            );
            let seen = system.touched_at(self.time + flight);
            let approach = seen.modal_approach(flat(&q));
            let closing = usize::from(approach[1] > approach[0]);
            let rate = dot(&seen.approach[closing], &flat(&v)[..system.size()]);
            let later = -approach[closing] / rate;
            if !(rate > 0.0 && later.abs() < 0.5 * flight) {
                break;
            }
            flight += later;
        }
        flight
    }

    /// Flies to the next touch; `false` if there is none before the end.
    fn fly(&mut self) -> Result<bool> {
        let system = self.solver.system;
        let (q, v) = (flat(&self.q), flat(&self.v));
        let seen = system.touched_at(self.time);
        let (flight, more) = match free_flight::next_contact(&seen, q, v, self.end_time - self.time)? {
            Flight::Contact(duration) if self.time + duration < self.end_time => {
                (self.landing(duration), true)
            }
            Flight::Over if self.end_time.is_infinite() => return Ok(false),
            _ => (self.end_time - self.time, false),
        };
        if let Some(recorder) = &mut self.recorder {
            let n = system.size();
            recorder.step(self.time, flight, [&q[..n], &v[..n]], &[[0.0; STAGES]; 2], &[[0.0; STAGES]; 2])?;
        }
        self.add_heat(flight, &[0.0; STAGES]);
        free_flight::advance(
            self.solver.system,
            flight,
            bytemuck::cast_slice_mut(&mut self.q),
            bytemuck::cast_slice_mut(&mut self.v),
        );
        self.time += flight;
        let approach = self.solver.system.touched_at(self.time).modal_approach(flat(&self.q));
        let rates = self.solver.batch.approach_rate(&self.v);
        for ((contact, approach), rate) in self.contacts.iter_mut().zip(approach).zip(rates) {
            // a parabola that comes back to zero at this rate was a quarter of it times its duration deep
            contact.add_flight((0.25 * rate * flight).max(-approach));
        }
        // exact flight keeps the energy of undamped bodies; of others it is not asked for
        self.course = at_rest(approach, self.course.motion);
        self.length.limit_to_level(START_LEVEL);
        Ok(more)
    }

    /// Takes one step, as long as the tolerance permits.
    fn step(&mut self) -> Result<()> {
        // the end of a step that an event asked for
        let mut shortened = None;
        let mut solved = true;
        loop {
            if self.length.is_exhausted() {
                return Err(self.stuck(solved));
            }
            self.length.limit();
            let h = self.length.length();
            let rest = self.end_time - self.time;
            let shorter = shortened.filter(|w| *w < h.min(rest)).or((rest < h).then_some(rest));
            let (batch, collocation, system) =
                (&self.solver.batch, self.solver.collocation, self.solver.system);
            let scale = momentum_scale(system, &self.contacts);
            let least = self.least_forces(scale);
            let share = StepBounds::share(self.steps);
            let table = match shorter {
                Some(h) => self.tables.other(batch, collocation, h),
                None => self.tables.get(batch, collocation, self.length.level(), h),
            };
            let h = table.h;
            let load = system.tangential_load.as_ref().map(|load| load.step(collocation, self.time, h));
            let trial = self.solver.solve(
                table,
                &self.course,
                (&self.q, &self.v),
                (&mut self.next_q, &mut self.next_v),
                load.as_ref(),
                ForceError {
                    absolute: least.map(|least| {
                        let peak = CONVERGED * share * self.bounds.force_defect * least;
                        peak.min(self.bounds.impulse * scale[1] / h)
                    }),
                    relative: self.bounds.force,
                },
            );
            solved = trial.is_some();
            let Some(trial) = trial else {
                shortened = None;
                self.length.halve();
                continue;
            };
            let energy_error = self.energy_error(&trial);
            let StepVerdict { excess, event, force_defect } =
                self.judge(&trial, scale, self.energy.excess(energy_error, h, 0.0));
            if excess > 1.0 {
                match event {
                    Some(u) if shortened.is_none() => shortened = Some(u * h),
                    _ => {
                        shortened = None;
                        self.length.shorten(excess);
                    }
                }
                continue;
            }
            for (contact, defect) in self.contacts.iter_mut().zip(force_defect) {
                contact.add_defect(defect);
            }
            self.energy.book(energy_error);
            self.accept(trial)?;
            if shorter.is_none() {
                self.length.lengthen(excess);
            }
            return Ok(());
        }
    }

    /// Forces in N in relation to which those of a step have to be right at least, see [`force_scale`].
    fn least_forces(&self, scale: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| force_scale(&[], self.contacts[i].force_peak, scale[i], self.energy.contact_time))
    }

    /// Angular frequency in rad/s of the bodies' quickest vibration while the contacts are as stiff as at their force peaks.
    fn quickest_vibration(&self) -> f64 {
        let system = self.solver.system;
        let stiffness = system.tangent([0, 1].map(|i| system.laws[i].approach(self.contacts[i].force_peak)));
        let on_contact = |i: usize| (stiffness[i][i] * dot(&system.approach[i], &system.approach[i])).sqrt();
        on_contact(0).max(on_contact(1)).max(system.highest_frequency())
    }

    /// Why no step is short enough; whether the last one could be `solved`.
    fn stuck(&self, solved: bool) -> Error {
        let [_, _, [outer, inner]] = self.course.end();
        Error::Solver(if solved || self.solver.system.residual.is_none() {
            format!(
                "reduced model: the time step fell below {:.1e} s at t = {:.6e} s without meeting the tolerance",
                self.length.shortest(),
                self.time
            )
        } else {
            format!(
                "reduced model: at t = {:.6e} s, with contact forces of {outer:.4} N and {inner:.4} N, the contacts find no equilibrium: the residual flexibility of the truncated modes is not valid for such large contact areas; take fewer modes, or model B",
                self.time
            )
        })
    }

    /// Energy in J that the step makes from nothing. Damped bodies lose some: then what the contacts store beyond the work
    /// done on them, which misses vibrations quicker than the step.
    fn energy_error(&self, trial: &Course) -> f64 {
        let stored = trial.stored - self.course.stored;
        if self.damped {
            stored - trial.work[0] - trial.work[1]
        } else {
            stored + trial.motion - self.course.motion - trial.along_work
        }
    }

    fn accept(&mut self, trial: Course) -> Result<()> {
        if let Some(recorder) = &mut self.recorder {
            let n = self.solver.system.size();
            let state = [&flat(&self.q)[..n], &flat(&self.v)[..n]];
            recorder.step(self.time, trial.h, state, &trial.stages(), &trial.along)?;
        }
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            let course = StepCourse {
                time: self.time,
                h: trial.h,
                local_approach: trial.local_approach[i],
                force: trial.force[i],
                work: trial.work[i],
            };
            contact.book(self.solver.collocation, &course);
        }
        self.add_peaks(&trial);
        if self.solver.system.tangential_load.is_some() {
            self.given.book(self.solver.collocation, trial.h, &trial.along, trial.along_work);
        }
        self.add_heat(trial.h, &trial.stages()[0]);
        std::mem::swap(&mut self.q, &mut self.next_q);
        std::mem::swap(&mut self.v, &mut self.next_v);
        self.time += trial.h;
        self.steps += 1;
        self.course = trial;
        Ok(())
    }

    /// Books the heat of the next `h` s under the outer contact's `force` in N, if that is asked for.
    fn add_heat(&mut self, h: f64, force: &Stages) {
        if let Some(heat) = &mut self.heat {
            let StepSolver { system, collocation, .. } = &self.solver;
            *heat += heating::heat(system, collocation, h, [flat(&self.q), flat(&self.v)], force);
        }
    }

    fn finish(self) -> Integration {
        let system = self.solver.system;
        let n = system.size();
        let closing = Closing {
            system,
            q: &flat(&self.q)[..n],
            v: &flat(&self.v)[..n],
            stored: self.course.stored,
            contacts: self.contacts,
            fluid: FluidAccount::default(),
            steps: self.steps,
            heat: self.heat,
            along: self.given,
        };
        closing.integration(self.recorder.map(Recorder::finish))
    }
}

impl Stepper for DryStepper<'_> {
    const MOST_STEPS: u64 = 5_000_000;

    fn time(&self) -> f64 {
        self.time
    }

    fn end(&self) -> f64 {
        self.end_time
    }

    fn steps(&self) -> u64 {
        self.steps
    }

    fn advance(&mut self) -> Result<bool> {
        let [approach, ..] = self.course.end();
        let begun = self.steps > 0;
        if begun && approach[1] <= 0.0 && (self.only_presses() || approach[0] <= 0.0 && !self.fly()?) {
            return Ok(false);
        }
        self.step()?;
        Ok(true)
    }

    /// Whether the integration or the impact itself is to blame.
    fn endless(&self) -> Error {
        let contacts: u32 = self.contacts.iter().map(|contact| contact.contacts).sum();
        let vibration = self.quickest_vibration();
        let turned = vibration * self.time;
        let sentence = format!(
            "reduced model: no end after {} steps, {contacts} contacts and {turned:.1e} rad of a vibration of {vibration:.1e} rad/s between the contacts, at t = {:.6e} s; set `run.end_time`, or take fewer modes",
            Self::MOST_STEPS,
            self.time
        );
        if contacts > CHATTER || turned > TURN_PER_STEP * self.steps as f64 {
            Error::BeyondModel(sentence)
        } else {
            Error::Solver(sentence)
        }
    }
}

/// Both contacts open at the modal approaches `y` in m, the bodies with the energy `motion` in J.
fn at_rest(y: [f64; 2], motion: f64) -> Course {
    let mut course = Course { motion, ..Course::default() };
    for i in 0..2 {
        course.approach[i][POINTS - 1] = y[i];
        course.local_approach[i][POINTS - 1] = y[i];
    }
    course
}
