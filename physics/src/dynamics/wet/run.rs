//! Steps of adapted length through a wet impact, and what is booked on the way.

mod beyond;
mod judged;
mod ledger;

use self::judged::defect_bound;
use self::ledger::StepAccount;
use super::guess::StepForces;
use super::solve::{END, Trial, Wet};
use super::table::WetTable;
use crate::dynamics::collocation::{Collocation, RADAU_POINTS};
use crate::dynamics::contact_balance::{ContactBalance, StepCourse};
use crate::dynamics::driver::{self, Stepper};
use crate::dynamics::force_peak::SolvedStep;
use crate::dynamics::free_flight;
use crate::dynamics::integration::{Closing, FluidAccount, Integration, NEGLIGIBLE, Options};
use crate::dynamics::recorder::Recorder;
use crate::dynamics::step_bounds::{AdaptedLength, EnergyAccount, StepBounds, base_step, momentum_scale};
use crate::dynamics::system::{System, dot};
use crate::dynamics::tangential_load::GivenLoad;
use crate::dynamics::wet::{FluidForces, FluidLoad};
use crate::error::Result;
use crate::numerics::stages::{STAGES, Stages};
use std::collections::BTreeMap;

/// Steps that get nowhere: so many that advance by less than so much of the base length; and the same where the plate overlaps the inner body,
/// however little: the film's law has a kink where that begins, at which steps don't settle.
const STALLED: (u64, f64) = (1_000, 1e-6);
const STALLED_IN_OVERLAP: f64 = 0.03;
/// The same where the film encloses fluid, which can hardly get out.
const STALLED_ENCLOSED: f64 = 1e-4;
/// Level of the first step.
const START_LEVEL: i32 = 8;

/// Integrates the impact of `system` in a `fluid`.
///
/// # Errors
/// [`crate::Error::Solver`] if a contact has no equilibrium, the step falls below 2^-44 of its base length, or the run does
/// not end.
pub fn integrate(system: &System, fluid: &FluidForces, options: &Options) -> Result<Integration> {
    let collocation = Collocation::radau();
    let recorder = Recorder::new(system, &collocation, options);
    let hit = system.hertz_impact();
    let (q, v) = system.initial_state();
    let mut start = FluidLoad::default();
    let local = system.modal_approach(&q);
    fluid.evaluate(&q, &v, system.indentation(local), &mut start);
    let trial = Trial {
        fluid: vec![[0.0; STAGES]; fluid.size()],
        loads: vec![FluidLoad::default(); STAGES],
        ..Trial::default()
    };
    let mut stepper = WetStepper {
        wet: Wet { system, fluid },
        collocation: &collocation,
        recorder,
        end_time: options.end_time.unwrap_or(f64::INFINITY),
        defect_bound: defect_bound(options.tolerance),
        bounds: StepBounds::new(options.tolerance),
        length: AdaptedLength::new(base_step(hit.duration(), options.tolerance), START_LEVEL),
        tables: BTreeMap::new(),
        looked: 0.0,
        time: 0.0,
        approach: local,
        local,
        force: [0.0; 2],
        load: start,
        late: FluidLoad::default(),
        q,
        v,
        trial,
        before: StepForces::default(),
        contacts: [ContactBalance::new(NEGLIGIBLE * system.masses[0] * system.speed); 2],
        booked: FluidAccount::default(),
        energy: EnergyAccount::new(&hit, system.kinetic_energy(), options.tolerance),
        steps: 0,
    };
    driver::run(&mut stepper)?;
    let closing = Closing {
        heat: None,
        system,
        q: &stepper.q,
        v: &stepper.v,
        stored: system.stored_energy(stepper.force, stepper.local),
        contacts: stepper.contacts,
        fluid: stepper.booked,
        steps: stepper.steps,
        along: GivenLoad::default(),
    };
    Ok(closing.integration(stepper.recorder.map(Recorder::finish)))
}

/// State of a run.
struct WetStepper<'a> {
    wet: Wet<'a>,
    collocation: &'a Collocation<RADAU_POINTS>,
    recorder: Option<Recorder<'a, RADAU_POINTS>>,
    end_time: f64,
    defect_bound: f64,
    bounds: StepBounds,
    length: AdaptedLength,
    tables: BTreeMap<i32, WetTable>,
    /// When it was last looked whether the steps get anywhere, s.
    looked: f64,
    time: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    approach: [f64; 2],
    local: [f64; 2],
    force: [f64; 2],
    /// What the fluid does at the present time.
    load: FluidLoad,
    /// What it does late in a step that is judged.
    late: FluidLoad,
    /// The latest step; its vectors are used again.
    trial: Trial,
    before: StepForces,
    contacts: [ContactBalance; 2],
    booked: FluidAccount,
    energy: EnergyAccount,
    steps: u64,
}

impl Stepper for WetStepper<'_> {
    const MOST_STEPS: u64 = 300_000;

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
        let open = self.steps > 0 && is_open(self.approach);
        let longest = if open {
            // a step that passes no touch, or so short that one in it is found
            let short = 0.5 * self.length.base().min(0.25 * self.energy.contact_time);
            free_flight::safe_step(self.wet.system, &self.q, &self.v).max(short)
        } else {
            self.length.base()
        };
        if self.step(longest, open && self.end_time.is_infinite())? {
            return Ok(false);
        }
        self.check_progress()?;
        Ok(true)
    }
}

impl WetStepper<'_> {
    /// Looks now and then whether the steps get anywhere.
    fn check_progress(&mut self) -> Result<()> {
        let (steps, advance) = STALLED;
        if !self.steps.is_multiple_of(steps) {
            return Ok(());
        }
        let advanced = (self.time - self.looked) / self.length.base();
        if advanced < advance {
            return Err(self.stalled(self.length.length()));
        }
        if advanced < STALLED_IN_OVERLAP {
            self.check_overlap(0.0, |_| true)?;
        }
        if advanced < STALLED_ENCLOSED {
            self.check_neck()?;
        }
        self.looked = self.time;
        Ok(())
    }

    /// Takes one step, as long as the tolerance and `longest` permit. If it `may_end` the run and no contact is possible
    /// after it, it ends at the instant from which that is so, and the answer is `true`.
    fn step(&mut self, longest: f64, may_end: bool) -> Result<bool> {
        self.length.limit();
        while self.length.length() > longest {
            self.length.halve();
        }
        loop {
            if self.length.is_exhausted() {
                return Err(self.stalled(self.length.shortest()));
            }
            let (h, rest) = (self.length.length(), self.end_time - self.time);
            let start = (self.force, &self.load.force[..]);
            let scale = momentum_scale(self.wet.system, &self.contacts);
            let converged = self.converged(scale);
            self.before.guess(self.collocation, h.min(rest), start, &mut self.trial);
            let system = self.wet.system;
            let last;
            let table = if rest < h {
                last = WetTable::new(system, self.collocation, rest);
                &last
            } else {
                self.tables
                    .entry(self.length.level())
                    .or_insert_with(|| WetTable::new(system, self.collocation, h))
            };
            let h = table.h;
            if !self.wet.solve(table, &self.q, &self.v, converged.in_step(h), &mut self.trial) {
                self.length.halve();
                continue;
            }
            let account = self.account(h);
            let force_defect = self.force_defect();
            let excess = (self.defect(h, scale) / self.defect_bound)
                .max(self.energy.excess(account.energy_error, h, account.rounding))
                .max(self.force_excess(force_defect, scale))
                .max(self.missed_contact(h, scale));
            if excess > 1.0 {
                self.length.shorten(excess);
                continue;
            }
            if may_end && let Some(end) = self.end_in_step(h) {
                let table = WetTable::new(system, self.collocation, end);
                if !self.wet.solve(&table, &self.q, &self.v, converged.in_step(end), &mut self.trial) {
                    self.length.halve();
                    continue;
                }
                self.accept(end, &self.account(end))?;
                return Ok(true);
            }
            self.accept(h, &account)?;
            for (contact, defect) in self.contacts.iter_mut().zip(force_defect) {
                contact.add_defect(defect);
            }
            self.length.lengthen(excess);
            return Ok(false);
        }
    }

    /// When in the step of `h` s just solved, in s from its start, contact ceases to be possible; `None` if it is possible
    /// after it. A run ends there and not with the step: the fluid slows the inner body for ever, and the end has to be
    /// the same whatever the steps.
    fn end_in_step(&self, h: f64) -> Option<f64> {
        let system = self.wet.system;
        let forces = self.wet.generalised(&self.trial);
        let over = |t: f64| {
            let (q, v) = self.motion_at(&forces, t, h);
            is_open(system.modal_approach(&q)) && free_flight::is_over(system, &q, &v)
        };
        if !over(h) {
            return None;
        }
        let (mut early, mut late) = (0.0, h);
        for _ in 0..40 {
            let middle = 0.5 * (early + late);
            if over(middle) { late = middle } else { early = middle }
        }
        Some(late)
    }

    /// Coordinates and their rates after `t` s of the step of `h` s just solved, under the generalised `forces` at its nodes.
    fn motion_at(&self, forces: &[Stages], t: f64, h: f64) -> (Vec<f64>, Vec<f64>) {
        let answer = |k: usize| {
            let r = self.collocation.response(&self.wet.system.oscillators[k], t, h);
            let (q, v) = (self.q[k], self.v[k]);
            (
                r.displacement_per_displacement * q
                    + r.displacement_per_velocity * v
                    + dot(&r.displacement_per_force, &forces[k]),
                r.velocity_per_displacement * q
                    + r.velocity_per_velocity * v
                    + dot(&r.velocity_per_force, &forces[k]),
            )
        };
        (0..self.wet.system.size()).map(answer).unzip()
    }

    /// Books the largest contact forces of the step of `h` s just solved.
    fn add_peaks(&mut self, h: f64) {
        let (system, trial) = (self.wet.system, &self.trial);
        let forces = self.wet.generalised(trial);
        let approach = [0, 1].map(|i| with_start(self.approach[i], &trial.approach[i]));
        let force = [0, 1].map(|i| with_start(self.force[i], &trial.forces[i]));
        let motion = |place: f64| {
            let (q, v) = self.motion_at(&forces, place * h, h);
            let weights = self.collocation.interpolation(place);
            let acceleration: Vec<f64> = system
                .oscillators
                .iter()
                .enumerate()
                .map(|(k, o)| dot(&weights, &forces[k]) - o.omega.powi(2) * q[k] - 2.0 * o.alpha * v[k])
                .collect();
            let along = |motion: &[f64], scale: f64| [0, 1].map(|i| scale * dot(&system.approach[i], motion));
            [system.modal_approach(&q), along(&v, h), along(&acceleration, h * h)]
        };
        let step = SolvedStep {
            system,
            collocation: self.collocation,
            h,
            approach: &approach,
            force: &force,
            error: 0.0,
            motion: &motion,
            samples: |intervals: usize| {
                let at = |k: usize| motion(k as f64 / intervals as f64);
                (0..=intervals).map(at).map(|[approach, rate, _]| [approach, rate]).collect()
            },
        };
        let peaks = [0, 1].map(|i| {
            step.peak(i, self.contacts[i].force_peak, |end| {
                let [approach, rate, _] = motion(end as f64);
                system
                    .contact(approach, approach)
                    .is_some_and(|(local, _)| system.force_rate(local, rate)[i] > 0.0)
            })
        });
        for (contact, peak) in self.contacts.iter_mut().zip(peaks) {
            contact.force_peak = peak;
        }
    }

    /// Books the step of `h` s just solved.
    ///
    /// # Errors
    /// [`Error::BeyondModel`] as [`WetStepper::check_overlap`].
    fn accept(&mut self, h: f64, account: &StepAccount) -> Result<()> {
        self.check_overlap(h, |overlap| overlap.depth > self.wet.fluid.minimum_gap())?;
        if let Some(recorder) = &mut self.recorder {
            let forces = self.wet.generalised(&self.trial);
            recorder.step_under(self.time, h, &self.q, &self.v, Stages::default(), |k| forces[k])?;
        }
        for i in 0..2 {
            let trial = &self.trial;
            let course = StepCourse {
                time: self.time,
                h,
                work: account.contact_work[i],
                local_approach: with_start(self.local[i], &trial.local[i]),
                force: with_start(self.force[i], &trial.forces[i]),
            };
            self.contacts[i].book(self.collocation, &course);
        }
        self.add_peaks(h);
        self.booked.add(&account.fluid);
        self.energy.book(account.energy_error);
        let trial = &mut self.trial;
        self.before.keep(h, trial);
        std::mem::swap(&mut self.q, &mut trial.motion.q[END]);
        std::mem::swap(&mut self.v, &mut trial.motion.v[END]);
        std::mem::swap(&mut self.load, &mut trial.loads[END]);
        self.force = trial.end_force;
        for i in 0..2 {
            (self.approach[i], self.local[i]) = (trial.approach[i][END], trial.local[i][END]);
        }
        self.time += h;
        self.steps += 1;
        Ok(())
    }
}

/// Values at the start and Radau's points of a step.
fn with_start(start: f64, stages: &Stages) -> [f64; RADAU_POINTS] {
    std::array::from_fn(|p| if p == 0 { start } else { stages[p - 1] })
}

/// Whether both contacts are open at these approaches.
fn is_open(approach: [f64; 2]) -> bool {
    approach[0] <= 0.0 && approach[1] <= 0.0
}
