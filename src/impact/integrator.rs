//! The time integration of a plate impact: steps of adapted length while bodies touch, exact flight between.

use super::collocation::{Collocation, STAGES, Stages, StepTable};
use super::contact_ledger::{ContactLedger, StepCourse};
use super::free_flight::{self, Flight};
use super::history::History;
use super::recorder::Recorder;
use super::system::{INNER, PLATE, System, dot};
use crate::analytical::hertz::HertzImpact;
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};

/// What the user may choose about the integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Bound aimed at for the relative error of the efficiency from the time integration.
    pub tolerance: f64,
    /// End of the run in s; `None` = when no further contact is possible.
    pub end_time: Option<f64>,
    /// Largest distance of samples in s; `None` = no history is kept.
    pub sample_interval: Option<f64>,
}

impl Default for Options {
    fn default() -> Self {
        Self { tolerance: 1e-7, end_time: None, sample_interval: None }
    }
}

/// Result of the integration.
#[derive(Debug, Clone)]
pub struct Integration {
    /// Velocities of outer and inner body at the end in m/s, signed along z.
    pub velocity: [f64; 2],
    /// Accounts of both contacts.
    pub contacts: [ContactLedger; 2],
    /// Energy that no strain energy, motion or damping accounts for, over the initial energy.
    pub energy_residual: f64,
    /// Largest momentum no impulse accounts for, over the initial momentum.
    pub momentum_residual: f64,
    /// Energy that went into damping and into the fluid.
    pub losses: Losses,
    /// Accepted steps.
    pub steps: u64,
    /// Course over time, if asked for.
    pub history: Option<History>,
}

/// Energy lost during an impact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Losses {
    /// To the damping of the plate's modes, J.
    pub plate_damping: f64,
    /// In the squeeze film, J.
    pub squeeze_film: f64,
    /// By the drag on the inner body, J.
    pub drag: f64,
}

/// Steps after which a run counts as endless.
const MAX_STEPS: u64 = 5_000_000;
/// Step lengths are the base length times 2^-level, level in this range.
const LEVELS: std::ops::RangeInclusive<i32> = -8..=44;
/// Impulse of a contact, over the initial momentum, below which it is not counted.
pub(super) const NEGLIGIBLE: f64 = 1e-8;
/// Iterations for the forces of a step; more means that the step is too long.
const MAX_ITERATIONS: usize = 30;

/// Integrates the impact.
///
/// # Errors
/// [`Error::Solver`] if the contact has no equilibrium, the step falls below 2^-44 of a Hertz contact, or the run does not end.
pub fn integrate(system: &System, options: &Options) -> Result<Integration> {
    let collocation = Collocation::default();
    let recorder = options.sample_interval.map(|interval| Recorder::new(system, &collocation, interval));
    Run::new(system, &collocation, options, recorder).go()
}

/// Tables of the step lengths in use, each half as long as the one before; made when they are first needed.
struct Ladder(Vec<Option<StepTable>>);

impl Ladder {
    fn get(&mut self, system: &System, collocation: &Collocation, index: usize, h: f64) -> &StepTable {
        if self.0[index].is_none() {
            let half = self.0.get(index + 1).and_then(Option::as_ref);
            let table = half.map_or_else(
                || StepTable::new(system, collocation, h),
                |half| half.doubled(system, collocation),
            );
            self.0[index] = Some(table);
        }
        self.0[index].as_ref().expect("made just now")
    }
}

/// State of a run.
struct Run<'a> {
    system: &'a System,
    collocation: &'a Collocation,
    recorder: Option<Recorder<'a>>,
    end_time: f64,
    /// Largest admissible defect of a step, see [`Run::defect`].
    defect_bound: f64,
    base_step: f64,
    tables: Ladder,
    level: i32,
    time: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    next_q: Vec<f64>,
    next_v: Vec<f64>,
    /// Modal approach and force of both contacts at the present time.
    approach: [f64; 2],
    /// Patches at the present time, see [`System::contact`].
    local: [f64; 2],
    force: [f64; 2],
    contacts: [ContactLedger; 2],
    steps: u64,
}

/// A solved step, not yet accepted.
struct Trial {
    approach: [Stages; 2],
    local: [Stages; 2],
    forces: [Stages; 2],
    end_approach: [f64; 2],
    end_local: [f64; 2],
    end_force: [f64; 2],
}

impl<'a> Run<'a> {
    fn new(
        system: &'a System,
        collocation: &'a Collocation,
        options: &Options,
        recorder: Option<Recorder<'a>>,
    ) -> Self {
        let (q, v) = system.initial_state();
        let hit =
            HertzImpact { mass: system.masses[0], speed: system.speed, stiffness: system.laws[0].stiffness };
        Self {
            system,
            collocation,
            recorder,
            end_time: options.end_time.unwrap_or(f64::INFINITY),
            defect_bound: defect_bound(options.tolerance),
            base_step: 0.25 * hit.duration(),
            tables: Ladder(LEVELS.map(|_| None).collect()),
            level: 8,
            time: 0.0,
            next_q: q.clone(),
            next_v: v.clone(),
            approach: system.modal_approach(&q),
            local: system.modal_approach(&q),
            force: [0.0; 2],
            q,
            v,
            contacts: [ContactLedger::new(NEGLIGIBLE * system.masses[0] * system.speed); 2],
            steps: 0,
        }
    }

    fn go(mut self) -> Result<Integration> {
        let mut touching = true;
        while self.time < self.end_time {
            if !touching && self.approach[0] <= 0.0 && self.approach[1] <= 0.0 && !self.fly()? {
                break;
            }
            self.step()?;
            touching = false;
            if self.steps > MAX_STEPS {
                return Err(Error::Solver(format!(
                    "reduced model: no end after {MAX_STEPS} steps, at t = {:.6e} s; set `run.end_time`",
                    self.time
                )));
            }
        }
        Ok(self.finish())
    }

    /// Flies to the next touch; `false` if there is none before the end.
    fn fly(&mut self) -> Result<bool> {
        let (flight, more) = match free_flight::next_touch(self.system, &self.q, &self.v)? {
            Flight::Touch(duration) if self.time + duration < self.end_time => (duration, true),
            Flight::Over if self.end_time.is_infinite() => return Ok(false),
            _ => (self.end_time - self.time, false),
        };
        if let Some(recorder) = &mut self.recorder {
            recorder.step(self.time, flight, &self.q, &self.v, &[[0.0; STAGES]; 2])?;
        }
        free_flight::advance(self.system, flight, &mut self.q, &mut self.v);
        self.time += flight;
        self.approach = self.system.modal_approach(&self.q);
        self.local = self.approach;
        self.force = [0.0; 2];
        self.level = self.level.max(8);
        Ok(more)
    }

    /// Takes one step, as long as the tolerance permits.
    fn step(&mut self) -> Result<()> {
        loop {
            let (start, end) = (*LEVELS.start(), *LEVELS.end());
            if self.level > end {
                return Err(Error::Solver(format!(
                    "reduced model: the time step fell below {:.1e} s at t = {:.6e} s without meeting the tolerance",
                    self.base_step * 0.5_f64.powi(end),
                    self.time
                )));
            }
            self.level = self.level.max(start);
            let h = self.base_step * 0.5_f64.powi(self.level);
            let rest = self.end_time - self.time;
            let last;
            let index = (self.level - start) as usize;
            let impulse_error = 1e-3 * self.defect_bound * self.momentum_scale()[1];
            let table = if rest < h {
                last = StepTable::new(self.system, self.collocation, rest);
                &last
            } else {
                self.tables.get(self.system, self.collocation, index, h)
            };
            let trial = solve(
                self.system,
                table,
                &self.q,
                &self.v,
                (self.approach, self.local, self.force),
                impulse_error / table.h,
                (&mut self.next_q, &mut self.next_v),
            );
            let Some(trial) = trial else {
                self.level += 1;
                continue;
            };
            let h = table.h;
            let defect = self.defect(&trial, h);
            if defect > self.defect_bound {
                let excess = (defect / self.defect_bound).log2() / (STAGES + 1) as f64;
                self.level += (excess.ceil() as i32).clamp(1, 8);
                continue;
            }
            self.accept(&trial, h)?;
            // one level up multiplies the defect of smooth forces by 2^(STAGES+1)
            if defect < self.defect_bound * 0.5_f64.powi(STAGES as i32 + 2) {
                self.level -= 1;
            }
            return Ok(());
        }
    }

    /// Momenta in N s in relation to which the impulses of both contacts have to be right.
    fn momentum_scale(&self) -> [f64; 2] {
        let initial = self.system.masses[0] * self.system.speed;
        [initial, self.contacts[1].impulse.max(0.01 * initial)]
    }

    /// Distance between the force at the end of the step and the polynomial of the step, as an impulse in
    /// relation to the momenta.
    fn defect(&self, trial: &Trial, h: f64) -> f64 {
        let extrapolation = self.collocation.interpolation(1.0);
        let scale = self.momentum_scale();
        (0..2)
            .map(|i| {
                let extrapolated: f64 = extrapolation.iter().zip(&trial.forces[i]).map(|(w, f)| w * f).sum();
                (trial.end_force[i] - extrapolated).abs() * h / scale[i]
            })
            .fold(0.0, f64::max)
    }

    fn accept(&mut self, trial: &Trial, h: f64) -> Result<()> {
        if let Some(recorder) = &mut self.recorder {
            recorder.step(self.time, h, &self.q, &self.v, &trial.forces)?;
        }
        // start, Gauss points and end of the step; rows of both contacts
        let join = |start: [f64; 2], stages: &[Stages; 2], end: [f64; 2]| -> [[f64; 2]; STAGES + 2] {
            std::array::from_fn(|p| match p {
                0 => start,
                _ if p == STAGES + 1 => end,
                _ => [stages[0][p - 1], stages[1][p - 1]],
            })
        };
        let approach = join(self.approach, &trial.approach, trial.end_approach);
        let local = join(self.local, &trial.local, trial.end_local);
        let force = join(self.force, &trial.forces, trial.end_force);
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            let course = StepCourse {
                time: self.time,
                h,
                approach: approach.map(|y| y[i]),
                local_approach: local.map(|p| p[i]),
                force: force.map(|f| f[i]),
            };
            contact.book(self.collocation, &course);
        }
        std::mem::swap(&mut self.q, &mut self.next_q);
        std::mem::swap(&mut self.v, &mut self.next_v);
        (self.approach, self.local, self.force) = (trial.end_approach, trial.end_local, trial.end_force);
        self.time += h;
        self.steps += 1;
        Ok(())
    }

    fn finish(self) -> Integration {
        let system = self.system;
        let velocity = [dot(&system.outer, &self.v), self.v[INNER] / system.masses[1].sqrt()];
        let [start_q, start_v] = &system.start;
        let initial = system.energy(start_q, start_v);
        let stored = system.contact_energy(self.force);
        let damped = system.is_damped();
        let end = system.energy(&self.q, &self.v);
        let contact_work = self.contacts[0].work + self.contacts[1].work;
        // damping takes energy out of the bodies; between them and the contacts none may be lost all the same
        let unaccounted = if damped { stored - contact_work } else { end + stored - initial };
        let impulses = [self.contacts[0].impulse, self.contacts[1].impulse];
        let mut unexplained = vec![system.masses[1] * velocity[1] + impulses[1]];
        if !system.outer_returns() {
            unexplained.push(system.masses[0] * (velocity[0] + system.speed) - impulses[0]);
        }
        if system.oscillators.get(PLATE).is_some_and(|o| o.omega == 0.0) {
            // rigid motion of a free plate: rate / participation = momentum
            unexplained.push(self.v[PLATE] / system.centre[PLATE] + impulses[0] - impulses[1]);
        }
        let momentum = system.masses[0] * system.speed;
        Integration {
            velocity,
            contacts: self.contacts,
            energy_residual: unaccounted.abs() / initial,
            momentum_residual: unexplained.into_iter().fold(0.0, |worst: f64, p| worst.max(p.abs()))
                / momentum,
            losses: Losses {
                plate_damping: if damped { initial - end - contact_work } else { 0.0 },
                ..Losses::default()
            },
            steps: self.steps,
            history: self.recorder.map(Recorder::finish),
        }
    }
}

/// Defect that a step may have for a relative error `tolerance` of the efficiency. The error of a step is of about
/// twice the order of its defect, so that the bound may fall more slowly than the tolerance; factor and exponent
/// are measured over scenes and numbers of modes (tests/integrator_runge_kutta.rs).
pub(super) fn defect_bound(tolerance: f64) -> f64 {
    0.05 * tolerance.powf(0.8)
}

/// Solves for the forces at the Gauss points and writes the state at the end of the step; `None` if the iteration
/// does not settle within `force_error` N or the contact has no equilibrium.
#[allow(clippy::too_many_arguments)]
fn solve(
    system: &System,
    table: &StepTable,
    q: &[f64],
    v: &[f64],
    (start_approach, start_local, start_force): ([f64; 2], [f64; 2], [f64; 2]),
    force_error: f64,
    (next_q, next_v): (&mut Vec<f64>, &mut Vec<f64>),
) -> Option<Trial> {
    let free = table.free_approach(system, q, v);
    let mut forces = [[start_force[0]; STAGES], [start_force[1]; STAGES]];
    let mut approach = free;
    // what the residual flexibility yields hardly changes from iterate to iterate
    let mut yielded = [0, 1].map(|i| [start_approach[i] - start_local[i]; STAGES]);
    let mut local = free;
    let mut settled = false;
    for _ in 0..MAX_ITERATIONS {
        let mut change: f64 = 0.0;
        for j in 0..STAGES {
            let row = [&table.coupling[0][j], &table.coupling[1][j], &table.coupling[2][j]];
            let mut y = [free[0][j], free[1][j]];
            for l in 0..STAGES {
                y[0] -= row[0][l] * forces[0][l] + row[1][l] * forces[1][l];
                y[1] -= row[1][l] * forces[0][l] + row[2][l] * forces[1][l];
            }
            let (p, f) = system.contact(y, [y[0] - yielded[0][j], y[1] - yielded[1][j]])?;
            for i in 0..2 {
                change = change.max((f[i] - forces[i][j]).abs());
                forces[i][j] = f[i];
                approach[i][j] = y[i];
                local[i][j] = p[i];
                yielded[i][j] = y[i] - p[i];
            }
        }
        if change <= force_error {
            settled = true;
            break;
        }
        if !change.is_finite() {
            return None;
        }
    }
    if !settled {
        return None;
    }
    table.advance(system, &forces, q, v, next_q, next_v);
    let end_approach = system.modal_approach(next_q);
    let guess = [0, 1].map(|i| end_approach[i] - yielded[i][STAGES - 1]);
    let (end_local, end_force) = system.contact(end_approach, guess)?;
    Some(Trial { approach, local, forces, end_approach, end_local, end_force })
}
