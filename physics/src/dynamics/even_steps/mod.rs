//! Time integration of a dry, elastic impact in steps of one length, for errors from 5e-5 on: a few operations per step.
//!
//! The forces are parabolas through three neighbouring steps, to which the oscillators answer exactly. That is of order 4, as
//! Numerov's method, and exact for free vibration, as Gautschi's (Numerische Mathematik 3, 1961, p. 381). A step does not know
//! where within it a contact touches or opens, so that errors fall with its power 2.5 to 4. The integrator with steps of adapted
//! length ([`super::integrator`]) does what is left: smaller errors, histories, loads along the surfaces, benders and stacks.

mod contacts;
mod course;
mod oscillators;

use self::contacts::EvenContacts;
use self::course::ContactCourse;
use self::oscillators::EvenOscillators;
use super::contact_balance::ContactBalance;
use super::driver::{self, Stepper};
use super::free_flight;
use super::integration::{Closing, FluidAccount, Integration, NEGLIGIBLE, Options};
use super::system::System;
use super::tangential_load::GivenLoad;
use crate::analytical::hertz::HertzImpact;
use crate::error::{Error, Result};

/// Open steps from one look at whether the impact is over to the next.
const OPEN_STEPS: u64 = 16;
/// Steps per contact that are tried first, for this error or a larger one, and the power of a smaller one with which there are more.
const FIRST_STEPS: f64 = 25.0;
const FIRST_ERROR: f64 = 1e-3;
const ERROR_POWER: f64 = 0.4;
/// Least duration of the inner contact, over the outer one's, that these steps follow.
const SHORT_CONTACT: f64 = 0.25;
/// A flight longer than so many steps is passed at once.
const LONG_FLIGHT: f64 = 16.0;

/// Whether steps of one length serve the `system` for a run with these `options`.
pub fn serve(system: &System, options: &Options) -> bool {
    options.sample_interval.is_none()
        && !options.heat
        && !system.outer_returns()
        && system.tangential_load.is_none()
}

/// Number of oscillators of the `system` that move by themselves in steps of `h` s.
pub fn moving(system: &System, h: f64) -> usize {
    system.oscillators.iter().filter(|oscillator| oscillators::moves(oscillator, h)).count()
}

/// First length of steps in s to be tried for the relative `error`.
pub fn first_length(system: &System, error: f64) -> f64 {
    let outer = system.hertz_impact().duration();
    let hit =
        HertzImpact { mass: system.masses[1], speed: system.speed, stiffness: system.laws[1].stiffness };
    let inner = if system.can_close(1) { hit.duration() } else { outer };
    let steps = FIRST_STEPS * (FIRST_ERROR / error).max(1.0).powf(ERROR_POWER);
    inner.clamp(SHORT_CONTACT * outer, outer) / steps
}

/// Integrates the impact in steps of `h` s, as `options` has its end.
///
/// # Errors
/// [`Error::Solver`] if the contacts find no equilibrium, bodies touch at the end of the run, or there are too many steps.
pub fn integrate(system: &System, options: &Options, h: f64) -> Result<Integration> {
    let mut stepper = EvenStepper::new(system, options, h);
    driver::run(&mut stepper)?;
    Ok(stepper.finish())
}

/// State of a run.
struct EvenStepper<'a> {
    system: &'a System,
    h: f64,
    end_time: f64,
    time: f64,
    steps: u64,
    oscillators: EvenOscillators,
    contacts: EvenContacts<'a>,
    courses: [ContactCourse; 2],
    balances: [ContactBalance; 2],
    /// Steps since both contacts opened.
    open: u64,
    /// Coordinates and rates of all oscillators when they were last needed.
    state: [Vec<f64>; 2],
}

impl<'a> EvenStepper<'a> {
    fn new(system: &'a System, options: &Options, h: f64) -> Self {
        let (q, v) = system.initial_state();
        let mut oscillators = EvenOscillators::new(system, h);
        oscillators.start_from(&q, &v);
        Self {
            system,
            h,
            end_time: options.end_time.unwrap_or(f64::INFINITY),
            time: 0.0,
            steps: 0,
            contacts: EvenContacts::new(system, oscillators.flexibility),
            oscillators,
            courses: system.modal_approach(&q).map(ContactCourse::open),
            balances: [ContactBalance::new(NEGLIGIBLE * system.masses[0] * system.speed); 2],
            open: 0,
            state: [q, v],
        }
    }

    fn step(&mut self) -> Result<()> {
        let forces = |back: usize| [0, 1].map(|i| self.courses[i].force_before(back));
        let free = self.oscillators.advance([forces(0), forces(1)]);
        let free = [free[0] - self.system.gap[0], free[1] - self.system.gap[1]];
        let found = self.contacts.answer(free, &self.courses).ok_or_else(|| {
            Error::Solver(format!(
                "reduced model: the contacts find no equilibrium at t = {:.6e} s in steps of {:.1e} s",
                self.time, self.h
            ))
        })?;
        for i in 0..2 {
            self.courses[i].go_on(found.approach[i], found.local[i], found.force[i]);
            self.courses[i].book(&mut self.balances[i], self.time, self.h);
        }
        self.time += self.h;
        self.steps += 1;
        self.open = if self.courses.iter().all(ContactCourse::is_at_rest) { self.open + 1 } else { 0 };
        Ok(())
    }

    /// Sets the state to the present one, both contacts open.
    fn take_state(&mut self) {
        let [q, v] = &mut self.state;
        self.oscillators.state(q, v);
    }

    /// Passes a flight of `time` s from the state on.
    fn fly(&mut self, time: f64) {
        let [q, v] = &mut self.state;
        free_flight::advance(self.system, time, q, v);
        self.oscillators.start_from(q, v);
        self.time += time;
        self.courses = self.system.modal_approach(q).map(ContactCourse::open);
    }

    fn finish(self) -> Integration {
        let [q, v] = &self.state;
        let closing = Closing {
            system: self.system,
            q,
            v,
            stored: 0.0,
            contacts: self.balances,
            fluid: FluidAccount::default(),
            steps: self.steps,
            heat: None,
            along: GivenLoad::default(),
        };
        closing.integration(None)
    }
}

impl Stepper for EvenStepper<'_> {
    const MOST_STEPS: u64 = 20_000;

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
        let rest = self.end_time - self.time;
        if self.open % OPEN_STEPS == 1 {
            self.take_state();
            let [q, v] = &self.state;
            let flight = free_flight::safe_time(self.system, q, v).min(rest);
            if flight.is_infinite() {
                return Ok(false);
            }
            if flight > LONG_FLIGHT * self.h {
                self.fly(flight);
                return Ok(true);
            }
        }
        if rest > self.h {
            self.step()?;
            return Ok(true);
        }
        if self.open == 0 {
            return Err(Error::Solver("reduced model: bodies touch at the end of the run".into()));
        }
        self.take_state();
        self.fly(rest);
        Ok(true)
    }
}
