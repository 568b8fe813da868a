//! What an integration is asked for and what it comes to: its results, and what the balances of energy and momentum leave
//! unexplained.

use super::contact_balance::ContactBalance;
use super::driver::StopReason;
use super::free_flight;
use super::sliding::Slid;
use super::system::{System, dot};
use super::tangential_load::GivenLoad;
use crate::contact::Press;
use crate::result::{History, Losses};

/// Samples between the ends of steps and flights that a requested history has at most: 9 MB.
pub const SAMPLES_BETWEEN: usize = 1 << 17;

/// What the user may choose about the integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Bound aimed at for the relative error of the efficiency from the time integration.
    pub tolerance: f64,
    /// End of the run in s; `None` = when no further contact is possible.
    pub end_time: Option<f64>,
    /// Largest distance of samples in s; `None` = no history is kept.
    pub sample_interval: Option<f64>,
    /// Whether the history of a dry, elastic impact is that of the contact forces alone, which costs little.
    pub forces_alone: bool,
    /// Whether the history comes with how contacts with memory are pressed.
    pub presses: bool,
    /// Most samples of a history between the ends of steps and flights: a long flight has wider intervals.
    pub samples_between: usize,
    /// Relative error of the force peaks from looking for them within the steps; 0 = as exact as rounding permits.
    pub peak_error: f64,
    /// Relative error of force peaks and times of separation, with right numbers of contacts, for which the impact is solved again where
    /// necessary ([`crate::dynamics::error_control`]); `None` where ten tolerances of velocities and force peaks are enough.
    pub results: Option<f64>,
    /// Whether the heat in the drive of a stack is summed up, for its ledger of energy.
    pub heat: bool,
    /// With which steps an earlier run of the same impact converged: they are taken at once. `None` = the impact is solved again until its
    /// results have converged.
    pub converged: Option<Converged>,
}

/// The steps with which the results of an impact have converged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Converged {
    /// Those of this tolerance.
    Tolerance(f64),
    /// Even ones.
    Even {
        /// Halvings of the first length.
        halvings: usize,
        /// Stress along the plate's faces under outer and inner contact, Pa.
        stress: [f64; 2],
        /// Force peaks of the run before, N.
        peaks: [f64; 2],
    },
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 1e-7,
            end_time: None,
            sample_interval: None,
            forces_alone: false,
            presses: false,
            samples_between: SAMPLES_BETWEEN,
            peak_error: 0.0,
            results: None,
            heat: false,
            converged: None,
        }
    }
}

/// Result of the integration.
#[derive(Debug, Clone)]
pub struct Integration {
    /// Velocities of outer and inner body at the end in m/s, signed along z.
    pub velocity: [f64; 2],
    /// Accounts of both contacts.
    pub contacts: [ContactBalance; 2],
    /// Energy that no strain energy, motion or damping accounts for, over the initial energy.
    pub energy_residual: f64,
    /// The same with its sign: positive where energy came out of nothing.
    pub energy_gained: f64,
    /// Largest momentum no impulse accounts for, over the initial momentum.
    pub momentum_residual: f64,
    /// Energy that went into damping and into the fluid.
    pub losses: Losses,
    /// Accepted steps.
    pub steps: u64,
    /// Estimated error of the velocities from the time integration, over the impact speed, if it was looked for
    /// ([`crate::dynamics::error_control`]).
    pub error_estimate: Option<f64>,
    /// With which steps it was found; `None` of a single run.
    pub converged: Option<Converged>,
    /// Tolerance that the integration keeps whatever smaller one is asked for; 0 where it keeps any.
    pub least_tolerance: f64,
    /// What a stack took and gave, if the outer body is one.
    pub supplied: Option<Supplied>,
    /// Why the run ended.
    pub stop: StopReason,
    /// Course over time, if asked for.
    pub history: Option<History>,
    /// How outer and inner contact are pressed at the samples of the history, if asked for and not by the law of the system.
    pub presses: Option<[Vec<Press>; 2]>,
    /// Friction's effect on the motion across the surfaces, which is in these results; `None` where that is omitted.
    pub friction: Option<Settled>,
}

/// How far the motion across the surfaces and that along them have settled.
#[derive(Debug, Clone)]
pub struct Settled {
    /// Error of velocities over the impact speed and of force peaks, relative, by ending the rounds in which they were found in turn.
    pub error: f64,
    /// What friction did along the surfaces.
    pub slid: Slid,
}

/// Impulse of a contact, over the initial momentum, below which it is not counted.
pub const NEGLIGIBLE: f64 = 1e-8;

/// What a fluid did in a run; nothing in a dry one.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct FluidAccount {
    /// Impulse of film and drag on the inner body in N s.
    pub(super) film_impulse: f64,
    pub(super) drag_impulse: f64,
    /// Energy dissipated in film and by drag, J.
    pub(super) dissipated: [f64; 2],
    /// Work of the fluid's force polynomials on the bodies, J.
    pub(super) work: f64,
}

impl FluidAccount {
    pub(super) fn add(&mut self, step: &Self) {
        self.film_impulse += step.film_impulse;
        self.drag_impulse += step.drag_impulse;
        self.dissipated[0] += step.dissipated[0];
        self.dissipated[1] += step.dissipated[1];
        self.work += step.work;
    }
}

/// Energies of a stack from its switching on to the end of a run, J.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Supplied {
    /// Taken from the buffer or the source.
    pub taken: f64,
    /// Given to plate and inner body.
    pub given: f64,
    /// What no heat accounts for of what was taken, but neither held nor given; where none was summed up, heat.
    pub rest: f64,
}

/// The end of a run.
pub(super) struct Closing<'a> {
    pub(super) system: &'a System,
    /// Coordinates and their rates.
    pub(super) q: &'a [f64],
    pub(super) v: &'a [f64],
    /// Energy that the contacts store, J.
    pub(super) stored: f64,
    pub(super) contacts: [ContactBalance; 2],
    pub(super) fluid: FluidAccount,
    pub(super) steps: u64,
    /// Heat in the drive of a stack in J, if it was summed up.
    pub(super) heat: Option<f64>,
    /// What a load along the surfaces did.
    pub(super) along: GivenLoad,
}

impl Closing<'_> {
    /// The results of the run with the `history` that was kept.
    pub(super) fn integration(self, history: Option<History>) -> Integration {
        let Self { system, v, ref contacts, fluid, along, .. } = self;
        let velocity = system.of_bodies(v);
        let [start_q, start_v] = &system.start;
        // of a stack's circuit the coordinates have no energy each
        let initial = match system.stack {
            Some(_) => system.kinetic_energy(),
            None => system.energy(start_q, start_v),
        };
        let end = system.energy(self.q, v);
        let contact_work = contacts[0].work + contacts[1].work;
        let dissipated = fluid.dissipated[0] + fluid.dissipated[1];
        let damped = system.is_damped();
        // damping takes energy out of the bodies; between them and the contacts none may be lost all the same
        let unaccounted = if damped {
            self.stored - contact_work + dissipated + fluid.work
        } else {
            end + self.stored - initial + dissipated - along.work
        };
        let supplied = self.supplied();
        // with its heat the whole ledger of a stack can be told, without it that of the contacts alone
        let unaccounted = match (supplied, self.heat) {
            (Some(supplied), Some(_)) => supplied.rest,
            _ => unaccounted,
        };
        let pressed = contacts[0].closed
            && !contacts[1].closed
            && system.stack.is_some()
            && free_flight::inner_is_gone(system, self.q, v);
        Integration {
            velocity,
            contacts: self.contacts,
            energy_residual: unaccounted.abs() / initial,
            energy_gained: unaccounted / initial,
            momentum_residual: unexplained_momentum(system, v, contacts, &fluid, &along)
                / system.initial_momentum(),
            losses: Losses {
                plate_damping: if damped {
                    initial - end - contact_work + fluid.work + along.work
                } else {
                    0.0
                },
                squeeze_film: fluid.dissipated[0],
                drag: fluid.dissipated[1],
                ..Losses::default()
            },
            steps: self.steps,
            error_estimate: None,
            converged: None,
            least_tolerance: 0.0,
            supplied,
            stop: if pressed {
                StopReason::Pressed
            } else {
                StopReason::of(contacts.iter().any(|c| c.closed))
            },
            history,
            presses: None,
            friction: None,
        }
    }
}

impl Closing<'_> {
    fn supplied(&self) -> Option<Supplied> {
        let [start_q, start_v] = &self.system.start;
        let (before, still) = self.system.account(start_q, start_v)?;
        let (after, moved) = self.system.account(self.q, self.v)?;
        let given = moved + self.stored - still;
        // what was lost until the touch was heat
        let rest = after.taken - before.taken - (after.held - before.held) - given - self.heat.unwrap_or(0.0);
        Some(Supplied { taken: after.taken, given, rest })
    }
}

/// Largest momentum of a body in N s that no impulse accounts for, with the rates `v` at the end.
pub(super) fn unexplained_momentum(
    system: &System,
    v: &[f64],
    [outer, inner]: &[ContactBalance; 2],
    fluid: &FluidAccount,
    along: &GivenLoad,
) -> f64 {
    let velocity = system.of_bodies(v);
    let fluid_impulse = fluid.film_impulse + fluid.drag_impulse;
    let gained = system.masses[1] * (velocity[1] - system.inner_velocity());
    let received = [outer, inner][system.inner_contact()].impulse;
    let mut largest = (gained + received - fluid_impulse).abs();
    if !system.outer_returns() {
        let momentum = system.masses[0] * (velocity[0] + system.speed);
        largest = largest.max((momentum - outer.impulse).abs());
    }
    for k in system.rigid() {
        // rigid motion of a free plate or body: rate / participation = momentum
        let moved = [0, 1].map(|i| system.approach[i][k]);
        let most = moved[0].abs().max(moved[1].abs());
        let [struck, pushed] = moved.map(|moved| moved / most);
        let pushed_along =
            system.tangential_load.as_ref().map_or(0.0, |load| dot(&load.along[k], &along.impulse));
        let momentum = (v[k] - pushed_along) / most + struck * outer.impulse + pushed * inner.impulse;
        largest = largest.max((momentum + fluid.film_impulse).abs());
    }
    largest
}
