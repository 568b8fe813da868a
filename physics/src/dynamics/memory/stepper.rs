//! One impact in even steps: the modes move exactly, the contacts answer at the end of every step.

use super::bending::Loads;
use super::modes::Modes;
use super::{Bodies, CHANGE, MAX_STEPS, Ran};
use crate::dynamics::contact_ledger::ContactLedger;
use crate::dynamics::integration::{FluidAccount, Integration, NEGLIGIBLE, Options, unexplained_momentum};
use crate::dynamics::recorder::{CURVES, sample};
use crate::dynamics::system::System;
use crate::error::{Error, Result};
use crate::material::{Deformation, Relaxation};
use crate::result::{History, Losses};

/// Newton steps after which a contact counts as unsolvable, and the least part of one.
const MAX_ITERATIONS: usize = 60;
const LEAST_FRACTION: f64 = 1e-4;
/// What may be missing of the approaches, over the largest: to stop, and where rounding leaves no more.
const SETTLED: f64 = 1e-13;
const ROUNDING: f64 = 1e-10;

/// Part of the time since the last contact that a flight takes in one go: what recovers, recovers the slower the later.
const GRADED: f64 = 0.1;
/// e-folds of the time since the last contact in which the samples of a flight are used up: longer than any run.
const FOLDS: f64 = 32.0;
/// Most doublings of a step in flight.
const MAX_DOUBLINGS: usize = 40;

/// Approaches tried for the end of a step.
struct Trial {
    x: [f64; 2],
    force: [f64; 2],
    /// Of the forces by the approaches, N/m.
    slope: [f64; 2],
    patch: [f64; 2],
    /// Beyond half-spaces, m/N.
    flexibility: [[f64; 2]; 2],
    /// What is missing, m.
    error: [f64; 2],
}

impl Trial {
    /// Not a number if an error is none.
    fn size(&self) -> f64 {
        let [a, b] = self.error.map(f64::abs);
        if a >= b || a.is_nan() { a } else { b }
    }
}

pub(super) struct Stepper<'a> {
    system: &'a System,
    bodies: Bodies,
    modes: Modes<'a>,
    h: f64,
    time: f64,
    steps: u64,
    /// When a contact had a force last, s.
    loaded: Option<f64>,
    /// States of the modes, now and next.
    state: [Vec<f64>; 2],
    /// What plate and tips give way beyond half-spaces. Shape (contact; plate, tip).
    deformed: [[Deformation; 2]; 2],
    /// Approaches of the surfaces before dents, in m, and what is added to the modal ones for dents there were at the start.
    x: [f64; 2],
    offset: [f64; 2],
    /// Approaches in m beyond that at which the contacts touch; negative without a force.
    past: [f64; 2],
    /// Modal approaches in m, forces in N and patches in m.
    y: [f64; 2],
    force: [f64; 2],
    patch: [f64; 2],
    contacts: [ContactLedger; 2],
    /// What plate and tips have yielded at each contact for having crept, m. Shape (contact; plate, tip).
    crept: [[f64; 2]; 2],
    /// Energy lost in each contact, J.
    contact_losses: [f64; 2],
    /// What their laws had taken at the start, J.
    taken: [f64; 2],
    /// Energy lost beneath the contacts by creep of plate and tips, and by the modes, J; the power that the modes lose, W.
    creep_losses: [[f64; 2]; 2],
    modal_loss: f64,
    power: f64,
    /// What the contacts add to the displacement of the plate's centre, m.
    centre: f64,
    loads: Loads,
    sample_interval: f64,
    /// Samples per e-fold of the time since the last contact at most.
    samples_per_fold: f64,
    history: Option<History>,
}

impl<'a> Stepper<'a> {
    /// With `h` s at most per step.
    pub(super) fn new(
        system: &'a System,
        mut bodies: Bodies,
        terms: &'a [Relaxation],
        h: f64,
        options: &Options,
    ) -> Self {
        // a whole number of steps to the end that is asked for
        let h = options.end_time.map_or(h, |end| end / (end / h).ceil());
        let modes = Modes::new(system, terms, h);
        bodies.prepare(h);
        let offset = [0, 1].map(|i| bodies.contacts[i].depth());
        let start = modes.start();
        let y = system.modal_approach(&modes.motion(&start)[0]);
        let mut run = Self {
            system,
            modes,
            h,
            time: 0.0,
            steps: 0,
            loaded: None,
            state: [start.clone(), start],
            deformed: Default::default(),
            x: [y[0] + offset[0], y[1] + offset[1]],
            offset,
            past: y,
            y,
            force: [0.0; 2],
            patch: [0.0; 2],
            contacts: [ContactLedger::new(NEGLIGIBLE * system.masses[0] * system.speed); 2],
            crept: Default::default(),
            contact_losses: [0.0; 2],
            taken: [0, 1].map(|i| bodies.contacts[i].taken(0.0)),
            creep_losses: Default::default(),
            modal_loss: 0.0,
            power: 0.0,
            centre: 0.0,
            loads: Loads::default(),
            sample_interval: options.sample_interval.unwrap_or(0.0),
            samples_per_fold: (options.samples_between as f64 / FOLDS).max(1.0),
            history: options.sample_interval.map(|_| History::new(&CURVES)),
            bodies,
        };
        run.record();
        run
    }

    /// Runs to `end_time` s, or until no further contact is possible.
    pub(super) fn go(mut self, end_time: Option<f64>) -> Result<Ran> {
        while end_time.map_or_else(|| !self.is_over(), |end| self.time < end * (1.0 - 1e-12)) {
            match self.flight(end_time) {
                0 => self.step()?,
                doublings => self.fly(doublings),
            }
            if self.steps > MAX_STEPS {
                return Err(Error::Solver(format!(
                    "reduced model: no end after {MAX_STEPS} steps, at t = {:.6e} s; set `run.end_time`",
                    self.time
                )));
            }
        }
        Ok(self.finish())
    }

    /// Doublings of a step for which nothing can touch, and within which what recovers does so evenly.
    fn flight(&self, end_time: Option<f64>) -> usize {
        if self.force != [0.0; 2] {
            return 0;
        }
        let closing = |[gap, rate]: [f64; 2]| {
            if rate >= 0.0 { if gap >= 0.0 { f64::INFINITY } else { 0.0 } } else { -gap / rate }
        };
        let [outer, inner] = self.clearances().map(closing);
        let recovering = self.loaded.map_or(f64::INFINITY, |loaded| GRADED * (self.time - loaded));
        let since = self.time - self.loaded.unwrap_or(0.0);
        let kept = self.sample_interval.max(since / self.samples_per_fold);
        let kept = self.history.as_ref().map_or(f64::INFINITY, |_| kept);
        let end = end_time.map_or(f64::INFINITY, |end| end - self.time);
        let steps = outer.min(inner).min(recovering).min(kept).min(end) / self.h * (1.0 + 1e-12);
        if steps < 2.0 { 0 } else { (steps.log2() as usize).min(MAX_DOUBLINGS) }
    }

    /// Takes 2^`doublings` steps at once, in which nothing touches.
    fn fly(&mut self, doublings: usize) {
        let time = self.h * 2.0_f64.powi(doublings as i32);
        let [now, next] = &mut self.state;
        self.modes.fly(now, doublings, next);
        // the modes' motion is exact, and so is what they lose
        let [before, _] = self.modes.energy(now);
        let [energy, power] = self.modes.energy(next);
        (self.modal_loss, self.power) = (self.modal_loss + before - energy, power);
        self.bodies.prepare(time);
        self.y = self.system.modal_approach(&self.modes.motion(next)[0]);
        for i in 0..2 {
            let beneath = |part| self.bodies.creep(i, part).deformation(&self.deformed[i][part], 0.0);
            self.x[i] = self.y[i] + self.offset[i] - beneath(0) - beneath(1);
        }
        self.remember(self.x, [0.0; 2], self.patch);
        self.past = [0, 1].map(|i| (self.x[i] - self.bodies.contacts[i].touch()).min(-f64::MIN_POSITIVE));
        self.bodies.prepare(self.h);
        self.state.swap(0, 1);
        self.steps += 1;
        self.time += time;
        self.record();
    }

    fn step(&mut self) -> Result<()> {
        let [now, next] = &mut self.state;
        self.modes.advance(now, [self.force, [0.0; 2]], next);
        let free = self.system.modal_approach(&self.modes.motion(next)[0]);
        let (x, force, patch) = self.solve(free).ok_or_else(|| {
            Error::Solver(format!(
                "reduced model: at t = {:.6e} s the contacts find no equilibrium",
                self.time
            ))
        })?;
        let [now, next] = &mut self.state;
        self.modes.advance(now, [self.force, force], next);
        let coupling = self.modes.coupling;
        let y = [0, 1].map(|i| free[i] - coupling[i][0] * force[0] - coupling[i][1] * force[1]);
        self.book(x, y, force);
        self.remember(x, force, patch);
        let [_, power] = self.modes.energy(&self.state[1]);
        self.modal_loss += 0.5 * self.h * (self.power + power);
        (self.x, self.y, self.force, self.patch, self.power) = (x, y, force, patch, power);
        self.state.swap(0, 1);
        self.steps += 1;
        self.time += self.h;
        if self.force != [0.0; 2] {
            self.loaded = Some(self.time);
        }
        self.record();
        Ok(())
    }

    /// Books a step that ends with surfaces and bodies approached by `x` and `y` m under `force` N.
    fn book(&mut self, x: [f64; 2], y: [f64; 2], force: [f64; 2]) {
        for i in 0..2 {
            let mean = 0.5 * (self.force[i] + force[i]);
            // touch and release are where the force begins and ends
            let past = x[i] - self.bodies.contacts[i].touch();
            let past =
                if force[i] > 0.0 { past.max(f64::MIN_POSITIVE) } else { past.min(-f64::MIN_POSITIVE) };
            let forces = [self.force[i], force[i]];
            self.contacts[i].book_even(
                self.time,
                self.h,
                forces,
                [self.past[i], past],
                mean * (y[i] - self.y[i]),
            );
            self.past[i] = past;
            self.contact_losses[i] += mean * (x[i] - self.x[i]);
        }
    }

    /// Lets contacts and residual flexibilities know how a step ended.
    fn remember(&mut self, x: [f64; 2], force: [f64; 2], patch: [f64; 2]) {
        let (elastic, ..) = self.bodies.elastic(self.system, force, patch);
        for i in 0..2 {
            self.bodies.contacts[i].advance(x[i]);
            for part in 0..2 {
                let state = &mut self.deformed[i][part];
                self.bodies.creep(i, part).advance(state, elastic[i][part]);
                let crept = state.depth() - elastic[i][part];
                let mean = 0.5 * (self.force[i] + force[i]);
                self.creep_losses[i][part] += mean * (crept - self.crept[i][part]);
                self.crept[i][part] = crept;
            }
        }
    }

    /// Approaches in m, forces in N and patches in m at the end of the step in which the modes alone would approach by `free` m, by
    /// Newton's method with halved steps; `None` if there is no equilibrium.
    fn solve(&self, free: [f64; 2]) -> Option<([f64; 2], [f64; 2], [f64; 2])> {
        let free = [free[0] + self.offset[0], free[1] + self.offset[1]];
        let scale = free[0].abs().max(free[1].abs()).max(f64::MIN_POSITIVE);
        let mut best = self.trial(free, self.x, self.patch);
        let mut step = self.newton(&best);
        let mut fraction = 1.0;
        for _ in 0..MAX_ITERATIONS {
            if best.size() <= SETTLED * scale {
                break;
            }
            let x = [best.x[0] - fraction * step[0], best.x[1] - fraction * step[1]];
            let trial = self.trial(free, x, best.patch);
            if trial.size() < best.size() {
                (step, fraction) = (self.newton(&trial), 1.0);
                best = trial;
            } else if fraction > LEAST_FRACTION {
                fraction *= 0.5;
            } else if best.size() > ROUNDING * scale {
                // where a contact turns from loading to unloading the slope is that of the other side: beyond it is the right one
                best = self.trial(free, [best.x[0] - step[0], best.x[1] - step[1]], best.patch);
                (step, fraction) = (self.newton(&best), 1.0);
            } else {
                break;
            }
        }
        (best.size() <= ROUNDING * scale).then_some((best.x, best.force, best.patch))
    }

    /// What the contacts answer at the approaches `x`, from the patches of a nearby state on.
    fn trial(&self, free: [f64; 2], x: [f64; 2], patch: [f64; 2]) -> Trial {
        let answer = [0, 1].map(|i| self.bodies.contacts[i].force(x[i]));
        let force = answer.map(|[force, _]| force);
        let (elastic, patch, flexibility) = self.bodies.elastic(self.system, force, patch);
        let beneath = |i: usize, part: usize| {
            self.bodies.creep(i, part).deformation(&self.deformed[i][part], elastic[i][part])
        };
        let coupling = self.modes.coupling;
        let error = [0, 1].map(|i| {
            let moved = coupling[i][0] * force[0] + coupling[i][1] * force[1];
            x[i] + beneath(i, 0) + beneath(i, 1) + moved - free[i]
        });
        Trial { x, force, slope: answer.map(|[_, slope]| slope), patch, flexibility, error }
    }

    /// Newton's step in the approaches, m, to be taken off: as if the flexibility did not change with the patches.
    fn newton(&self, trial: &Trial) -> [f64; 2] {
        let Trial { slope, flexibility, error, .. } = trial;
        let growth = |i: usize| self.bodies.creep(i, 0).growth().max(self.bodies.creep(i, 1).growth());
        let per_force = |i: usize, j: usize| growth(i) * flexibility[i][j] + self.modes.coupling[i][j];
        let [a, b] = [1.0 + per_force(0, 0) * slope[0], per_force(0, 1) * slope[1]];
        let [c, e] = [per_force(1, 0) * slope[0], 1.0 + per_force(1, 1) * slope[1]];
        let determinant = a * e - b * c;
        [(e * error[0] - b * error[1]) / determinant, (a * error[1] - c * error[0]) / determinant]
    }

    /// Whether no contact can touch any more: what every mode can reach by itself does not close the gaps that rigid motions open.
    fn is_over(&self) -> bool {
        if self.force != [0.0; 2] {
            return false;
        }
        self.clearances().iter().all(|[gap, rate]| *gap >= 0.0 && *rate >= 0.0)
    }

    /// Least gap of each contact in m that the modes leave by themselves, without forces, and the rate in m/s at which rigid motions open it.
    fn clearances(&self) -> [[f64; 2]; 2] {
        let reach = self.modes.reach(&self.state[0]);
        let [q, v] = self.modes.motion(&self.state[0]);
        [0, 1].map(|i| {
            let (mut gap, mut rate) =
                (self.system.gap[i] - self.offset[i] + self.bodies.contacts[i].depth(), 0.0);
            for (k, oscillator) in self.system.oscillators.iter().enumerate() {
                let b = self.system.approach[i][k];
                if oscillator.omega == 0.0 {
                    gap -= b * q[k];
                    rate -= b * v[k];
                } else {
                    gap -= b.abs() * reach[k];
                }
            }
            [gap, rate]
        })
    }

    /// Keeps every step of a contact, and what moves freely at the interval asked for.
    fn record(&mut self) {
        self.loads.push(self.time, self.force);
        let Some(history) = &mut self.history else { return };
        let centre = self.system.local_centre.displacement(self.patch, self.force);
        let local = [centre, (centre - self.centre) / self.h];
        self.centre = centre;
        let free = self.force == [0.0; 2];
        if free && history.time.last().is_some_and(|last| self.time - last < self.sample_interval) {
            return;
        }
        let [q, v] = self.modes.motion(&self.state[0]);
        history.push(self.time, sample(self.system, [&q, &v], local, self.force));
    }

    fn finish(self) -> Ran {
        let system = self.system;
        let [_, v] = self.modes.motion(&self.state[0]);
        let velocity = system.of_bodies(&v);
        let [initial, _] = self.modes.energy(&self.modes.start());
        let [end, _] = self.modes.energy(&self.state[0]);
        let work = self.contacts.map(|contact| contact.work);
        let unaccounted = end + self.modal_loss + work[0] + work[1] - initial;
        // each law's own account of what it took; what yields elastically beneath gives all of it back once nothing is loaded
        let law =
            |i: usize| self.bodies.contacts[i].taken(self.force[i]) - self.taken[i] - self.contact_losses[i];
        // what yields elastically gives its energy back, to the other contact also: so creep is the plate's as a whole, a tip's its contact's
        let [[outer_plate, outer_tip], [inner_plate, inner_tip]] = self.creep_losses;
        let contact_losses = [self.contact_losses[0] + outer_tip, self.contact_losses[1] + inner_tip];
        let plate_loss = outer_plate + inner_plate;
        let beneath = work[0] + work[1] - contact_losses[0] - contact_losses[1] - plate_loss;
        let beneath = if self.force == [0.0; 2] { -beneath } else { 0.0 };
        let gained = unaccounted + law(0) + law(1) + beneath;
        let residual = unaccounted.abs() + law(0).abs() + law(1).abs() + beneath.abs();
        let integration = Integration {
            velocity,
            contacts: self.contacts,
            energy_residual: residual / initial,
            energy_gained: gained / initial,
            momentum_residual: unexplained_momentum(system, &v, &self.contacts, &FluidAccount::default())
                / system.initial_momentum(),
            losses: Losses {
                plate_damping: self.modal_loss + plate_loss,
                // what yields knows what it has dissipated, which is never negative
                contacts: Some([0, 1].map(|i| {
                    let dissipated = self.bodies.contacts[i].dissipated();
                    dissipated.map_or(contact_losses[i], |all| all - self.taken[i])
                })),
                ..Losses::default()
            },
            steps: self.steps,
            error_estimate: None,
            kept_tolerance: CHANGE,
            supplied: None,
            pressed: false,
            history: self.history,
        };
        Ran { integration, contacts: self.bodies.contacts, loads: self.loads }
    }
}
