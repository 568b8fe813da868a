//! One impact in even steps: the modes move exactly, the contacts answer at the end of every step.

mod equilibrium;

use self::equilibrium::ApproachTrial;
use super::bending::ForceHistory;
use super::modes::ModeSet;
use super::step_force::{StepForce, mean};
use super::step_length::StepLength;
use super::{CHANGE, CreepingContacts, Ran};
use crate::contact::Press;
use crate::dynamics::contact_balance::{ContactBalance, EvenStep};
use crate::dynamics::driver::{Stepper, StopReason};
use crate::dynamics::integration::{FluidAccount, Integration, NEGLIGIBLE, Options, unexplained_momentum};
use crate::dynamics::recorder::{CURVES, sample};
use crate::dynamics::system::System;
use crate::dynamics::tangential_load::GivenLoad;
use crate::error::{Error, Result};
use crate::material::{Deformation, Relaxation};
use crate::result::{History, Losses};

/// Part of the time since the last contact that a flight takes in one go: what recovers, recovers the slower the later.
const GRADED: f64 = 0.1;
/// e-folds of the time since the last contact in which the samples of a flight are used up: longer than any run.
const FOLDS: f64 = 32.0;
/// Steps after which a run looks for flights that only the bodies' speeds bound.
const PATIENCE: u64 = 4096;
/// Rounding error of the sum of all steps to the end, relative.
const ROUNDING: f64 = 1e-12;
/// Most doublings of a step in flight.
const MAX_DOUBLINGS: usize = 40;

pub(super) struct MemoryStepper<'a> {
    system: &'a System,
    bodies: CreepingContacts,
    /// Relaxation of the plate, and the modes for steps of every length, the shortest first.
    terms: &'a [Relaxation],
    modes: Vec<ModeSet<'a>>,
    step_force: StepForce,
    step_length: StepLength,
    /// Doublings of the shortest step for which contacts and modes are prepared.
    level: usize,
    /// Shortest step, s.
    h: f64,
    time: f64,
    end_time: f64,
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
    contacts: [ContactBalance; 2],
    /// What plate and tips have yielded at each contact for having crept, m. Shape (contact; plate, tip).
    viscoelastic: [[f64; 2]; 2],
    /// Energy lost in each contact, J.
    contact_losses: [f64; 2],
    /// What their laws had taken and dissipated at the start, and have taken now with what is stored beyond half-spaces, J.
    taken_before: [f64; 2],
    dissipated_before: [f64; 2],
    taken: [f64; 2],
    energy: f64,
    /// Energy lost beneath the contacts by creep of plate and tips, and by the modes, J; the power that the modes lose, W.
    viscoelastic_losses: [[f64; 2]; 2],
    modal_loss: f64,
    power: f64,
    /// What the contacts add to the displacement of the plate's centre, m.
    centre: f64,
    loads: ForceHistory,
    sample_interval: f64,
    /// Samples per e-fold of the time since the last contact at most.
    samples_per_fold: f64,
    history: Option<History>,
    presses: Option<[Vec<Press>; 2]>,
}

impl<'a> MemoryStepper<'a> {
    /// With `h` s at most per step.
    pub(super) fn new(
        system: &'a System,
        mut bodies: CreepingContacts,
        terms: &'a [Relaxation],
        h: f64,
        options: &Options,
    ) -> Self {
        // a whole number of steps to the end that is asked for
        let h = options.end_time.map_or(h, |end| end / (end / h).ceil());
        let step_force = bodies.step_force();
        let modes = ModeSet::new(system, terms, h, step_force);
        bodies.prepare(h);
        let offset = [0, 1].map(|i| bodies.contacts[i].depth());
        let start = modes.start();
        let y = system.modal_approach(&modes.motion(&start)[0]);
        let taken = [0, 1].map(|i| bodies.contacts[i].taken(0.0));
        let mut run = Self {
            system,
            terms,
            level: 0,
            modes: vec![modes],
            step_force,
            step_length: StepLength::new(h, system.hertz_impact().duration()),
            h,
            time: 0.0,
            end_time: options.end_time.unwrap_or(f64::INFINITY),
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
            contacts: [ContactBalance::new(NEGLIGIBLE * system.masses[0] * system.speed); 2],
            viscoelastic: Default::default(),
            contact_losses: [0.0; 2],
            taken_before: taken,
            dissipated_before: [0, 1].map(|i| bodies.contacts[i].dissipated()),
            taken,
            energy: taken[0] + taken[1],
            viscoelastic_losses: Default::default(),
            modal_loss: 0.0,
            power: 0.0,
            centre: 0.0,
            loads: ForceHistory::default(),
            sample_interval: options.sample_interval.unwrap_or(0.0),
            samples_per_fold: (options.samples_between as f64 / FOLDS).max(1.0),
            history: options.sample_interval.map(|_| History::new(&CURVES)),
            presses: options.presses.then(Default::default),
            bodies,
        };
        run.record(h);
        run
    }

    /// Doublings of a step for which nothing can touch, and within which what recovers does so evenly.
    fn flight(&self) -> usize {
        if self.force != [0.0; 2] {
            return 0;
        }
        let closing = |[gap, rate]: [f64; 2]| {
            if rate >= 0.0 { if gap >= 0.0 { f64::INFINITY } else { 0.0 } } else { -gap / rate }
        };
        let [outer, inner] = self.clearances().map(closing);
        let open = if self.steps > PATIENCE { self.certainly_open() } else { 0.0 };
        let recovering = self.loaded.map_or(f64::INFINITY, |loaded| GRADED * (self.time - loaded));
        let since = self.time - self.loaded.unwrap_or(0.0);
        let sampling = self.sample_interval.max(since / self.samples_per_fold);
        let sampling = self.history.as_ref().map_or(f64::INFINITY, |_| sampling);
        let end = self.end_time - self.time;
        let steps =
            outer.min(inner).max(open).min(recovering).min(sampling).min(end) / self.h * (1.0 + ROUNDING);
        if steps < 2.0 { 0 } else { (steps.log2() as usize).min(MAX_DOUBLINGS) }
    }

    /// Takes 2^`doublings` steps at once, in which nothing touches.
    fn fly(&mut self, doublings: usize) {
        let time = self.h * 2.0_f64.powi(doublings as i32);
        let [now, next] = &mut self.state;
        self.modes[0].fly(now, doublings, next);
        // the modes' motion is exact, and so is what they lose
        let [before, _] = self.modes[0].energy(now);
        let [energy, power] = self.modes[0].energy(next);
        (self.modal_loss, self.power) = (self.modal_loss + (before - energy).max(0.0), power);
        self.bodies.prepare(time);
        self.y = self.system.modal_approach(&self.modes[0].motion(next)[0]);
        for i in 0..2 {
            let elastic_below = |part| self.bodies.creep(i, part).deformation(&self.deformed[i][part], 0.0);
            self.x[i] = self.y[i] + self.offset[i] - elastic_below(0) - elastic_below(1);
        }
        self.remember(self.x, [0.0; 2], self.patch);
        self.past =
            [0, 1].map(|i| (self.x[i] - self.bodies.contacts[i].contact_approach()).min(-f64::MIN_POSITIVE));
        self.step_length.reset();
        self.level = 0;
        self.bodies.prepare(self.h);
        self.state.swap(0, 1);
        self.steps += 1;
        self.time += time;
        self.record(self.h);
    }

    /// Takes one step within the `rest` of the run in s.
    fn step(&mut self, rest: f64) -> Result<()> {
        let (free, trial) = self.solved(rest)?;
        let ApproachTrial { x, force, acting, patch, taken, energy, .. } = trial;
        let h = self.step_length.of(self.level);
        let modes = &self.modes[self.level];
        let [now, next] = &mut self.state;
        modes.advance(now, self.step_force.felt([self.force, force], acting), next);
        let coupling = modes.coupling;
        let y = [0, 1].map(|i| free[i] - coupling[i][0] * acting[0] - coupling[i][1] * acting[1]);
        let [_, power] = modes.energy(next);
        self.book(h, (x, y), (force, acting), taken);
        (self.taken, self.energy) = (taken, energy);
        self.remember(x, force, patch);
        self.modal_loss += 0.5 * h * (self.power + power);
        (self.x, self.y, self.force, self.patch, self.power) = (x, y, force, patch, power);
        self.state.swap(0, 1);
        self.steps += 1;
        self.time += h;
        if self.force != [0.0; 2] {
            self.loaded = Some(self.time);
        }
        self.record(h);
        Ok(())
    }

    /// The end of the next step, and the approaches in m that the modes alone would have there.
    fn solved(&mut self, rest: f64) -> Result<([f64; 2], ApproachTrial)> {
        loop {
            let level = self.step_length.level_within(rest);
            self.prepare(level);
            let [now, next] = &mut self.state;
            let modes = &self.modes[self.level];
            modes.advance(now, [self.step_force.known(self.force), [0.0; 2]], next);
            let free = self.system.modal_approach(&modes.motion(next)[0]);
            match self.solve(free) {
                Some(trial) => {
                    let peaks = self.contacts.map(|contact| contact.force_peak);
                    if self.step_length.keeps(self.time, [self.force, trial.force], peaks) {
                        return Ok((free, trial));
                    }
                }
                None if self.step_length.shorten() => {}
                None => {
                    return Err(Error::Solver(format!(
                        "reduced model: at t = {:.6e} s the contacts find no equilibrium",
                        self.time
                    )));
                }
            }
        }
    }

    /// Prepares modes and contacts for steps of the `level`.
    fn prepare(&mut self, level: usize) {
        for k in self.modes.len()..=level {
            self.modes.push(ModeSet::new(self.system, self.terms, self.step_length.of(k), self.step_force));
        }
        if level != self.level {
            self.level = level;
            self.bodies.prepare(self.step_length.of(level));
        }
    }

    /// Books a step of `h` s that ends with surfaces and bodies approached by `x` and `y` m under `force` N, in which the forces `acting` act and after
    /// which the contacts have `taken` so much work in J.
    fn book(
        &mut self,
        h: f64,
        (x, y): ([f64; 2], [f64; 2]),
        (force, acting): ([f64; 2], [f64; 2]),
        taken: [f64; 2],
    ) {
        let mean = mean(self.step_force.felt([self.force, force], acting));
        for i in 0..2 {
            // touch and release are where the force begins and ends
            let past = x[i] - self.bodies.contacts[i].contact_approach();
            let past =
                if force[i] > 0.0 { past.max(f64::MIN_POSITIVE) } else { past.min(-f64::MIN_POSITIVE) };
            let local_approach = [self.past[i], past];
            let work = mean[i] * (y[i] - self.y[i]);
            let step = EvenStep { h, mean: mean[i], peak: force[i], local_approach, work };
            let [start, time] = [self.past[i], self.time];
            let released = || (time + h * start / (start - past), (start - past) / h);
            self.contacts[i].add_even(&step, released);
            self.past[i] = past;
            self.contact_losses[i] += match self.step_force {
                StepForce::Conserving | StepForce::Mean => taken[i] - self.taken[i],
                StepForce::Linear => mean[i] * (x[i] - self.x[i]),
            };
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
                let viscoelastic = state.depth() - elastic[i][part];
                let mean = 0.5 * (self.force[i] + force[i]);
                self.viscoelastic_losses[i][part] += mean * (viscoelastic - self.viscoelastic[i][part]);
                self.viscoelastic[i][part] = viscoelastic;
            }
        }
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
        let reach = self.modes[0].reach(&self.state[0]);
        let [q, v] = self.modes[0].motion(&self.state[0]);
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

    /// Time in s in which no mode, with all the energy that it has, can close a contact against the rigid motions: however far it could move,
    /// it is no quicker. What recovers, by exp(-t/tau) whatever tau, takes at least as long as since the last contact.
    fn certainly_open(&self) -> f64 {
        let speeds = self.modes[0].most_speeds(&self.state[0]);
        let since = self.time - self.loaded.unwrap_or(0.0);
        let opening = self.clearances().map(|[_, rate]| rate);
        let time = |i: usize| {
            let elastic: f64 = self.system.approach[i].iter().zip(&speeds).map(|(b, v)| (b * v).abs()).sum();
            let dent = (self.x[i] - self.past[i]).abs();
            let elastic_below = (self.y[i] + self.offset[i] - self.x[i]).abs();
            let closing = elastic + (dent + elastic_below) / since - opening[i];
            // 0 for what is no number, before the first contact
            if closing <= 0.0 { f64::INFINITY } else { (-self.past[i] / closing).max(0.0) }
        };
        time(0).min(time(1))
    }

    /// Keeps every step of a contact, the last of which took `h` s, and what moves freely at the requested interval.
    fn record(&mut self, h: f64) {
        self.loads.push(self.time, self.force);
        let Some(history) = &mut self.history else { return };
        let centre = self.system.local_centre.displacement(self.patch, self.force);
        let local = [centre, (centre - self.centre) / h];
        self.centre = centre;
        let free = self.force == [0.0; 2];
        if free && history.time.last().is_some_and(|last| self.time - last < self.sample_interval) {
            return;
        }
        let [q, v] = self.modes[0].motion(&self.state[0]);
        history.push(self.time, sample(self.system, [&q, &v], local, self.force));
        for (i, presses) in self.presses.iter_mut().flatten().enumerate() {
            presses.push(self.bodies.contacts[i].press(self.force[i]));
        }
    }

    /// The results.
    pub(super) fn finish(self) -> Ran {
        let system = self.system;
        let [_, v] = self.modes[0].motion(&self.state[0]);
        let velocity = system.of_bodies(&v);
        let [initial, _] = self.modes[0].energy(&self.modes[0].start());
        let [end, _] = self.modes[0].energy(&self.state[0]);
        let work = self.contacts.map(|contact| contact.work);
        let unaccounted = end + self.modal_loss + work[0] + work[1] - initial;
        // each law's own account of what it took; what yields elastically beneath gives all of it back once nothing is loaded
        let law = |i: usize| {
            self.bodies.contacts[i].taken(self.force[i]) - self.taken_before[i] - self.contact_losses[i]
        };
        // what yields elastically gives its energy back, to the other contact also: so creep is the plate's as a whole, a tip's its contact's
        let [[outer_plate, outer_tip], [inner_plate, inner_tip]] = self.viscoelastic_losses;
        let contact_losses = [self.contact_losses[0] + outer_tip, self.contact_losses[1] + inner_tip];
        let plate_loss = outer_plate + inner_plate;
        let elastic_below = work[0] + work[1] - contact_losses[0] - contact_losses[1] - plate_loss;
        let elastic_below = if self.force == [0.0; 2] { -elastic_below } else { 0.0 };
        let gained = unaccounted + law(0) + law(1) + elastic_below;
        let residual = unaccounted.abs() + law(0).abs() + law(1).abs() + elastic_below.abs();
        let integration = Integration {
            velocity,
            contacts: self.contacts,
            energy_residual: residual / initial,
            energy_gained: gained / initial,
            momentum_residual: unexplained_momentum(
                system,
                &v,
                &self.contacts,
                &FluidAccount::default(),
                &GivenLoad::default(),
            ) / system.initial_momentum(),
            losses: Losses {
                plate_damping: self.modal_loss + plate_loss,
                // every law knows what it has dissipated, which is never negative
                contacts: Some([0, 1].map(|i| {
                    let [_, tip] = self.viscoelastic_losses[i];
                    self.bodies.contacts[i].dissipated() - self.dissipated_before[i] + tip
                })),
                ..Losses::default()
            },
            steps: self.steps,
            error_estimate: None,
            converged: None,
            least_tolerance: CHANGE,
            supplied: None,
            stop: StopReason::of(self.contacts.iter().any(|contact| contact.closed)),
            history: self.history,
            presses: self.presses,
            friction: None,
        };
        Ran { integration, contacts: self.bodies.contacts, loads: self.loads }
    }
}

impl Stepper for MemoryStepper<'_> {
    const MOST_STEPS: u64 = 4_000_000;

    fn time(&self) -> f64 {
        self.time
    }

    fn end(&self) -> f64 {
        self.end_time * (1.0 - ROUNDING)
    }

    fn steps(&self) -> u64 {
        self.steps
    }

    fn advance(&mut self) -> Result<bool> {
        if self.end_time.is_infinite() && self.is_over() {
            return Ok(false);
        }
        match self.flight() {
            0 => self.step(self.end_time - self.time)?,
            doublings => self.fly(doublings),
        }
        Ok(true)
    }
}
