//! What an integration is asked for and what it comes to: its results, and what the balances of energy and momentum leave
//! unexplained.

use super::contact_ledger::ContactLedger;
use super::system::{PLATE, System};
use crate::result::{History, Losses};

/// What the user may choose about the integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Bound aimed at for the relative error of the efficiency from the time integration.
    pub tolerance: f64,
    /// End of the run in s; `None` = when no further contact is possible.
    pub end_time: Option<f64>,
    /// Largest distance of samples in s; `None` = no history is kept.
    pub sample_interval: Option<f64>,
    /// Relative error of the force peaks from looking for them within the steps; 0 = as exact as rounding permits.
    pub peak_error: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { tolerance: 1e-7, end_time: None, sample_interval: None, peak_error: 0.0 }
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
    /// The same with its sign: positive where energy came out of nothing.
    pub energy_gained: f64,
    /// Largest momentum no impulse accounts for, over the initial momentum.
    pub momentum_residual: f64,
    /// Energy that went into damping and into the fluid.
    pub losses: Losses,
    /// Accepted steps.
    pub steps: u64,
    /// Estimated error of the velocities from the time integration, over the impact speed, if it was looked for
    /// ([`crate::dynamics::assured`]).
    pub error_estimate: Option<f64>,
    /// Tolerance that the integration keeps whatever smaller one is asked for; 0 where it keeps any.
    pub kept_tolerance: f64,
    /// Course over time, if asked for.
    pub history: Option<History>,
}

impl Integration {
    /// Whether the run ended while bodies touched: what the impact comes to is then open.
    pub fn is_cut(&self) -> bool {
        self.contacts.iter().any(|contact| contact.closed)
    }
}

/// Impulse of a contact, over the initial momentum, below which it is not counted.
pub(super) const NEGLIGIBLE: f64 = 1e-8;

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

/// The end of a run.
pub(super) struct Closing<'a> {
    pub(super) system: &'a System,
    /// Coordinates and their rates.
    pub(super) q: &'a [f64],
    pub(super) v: &'a [f64],
    /// Energy that the contacts store, J.
    pub(super) stored: f64,
    pub(super) contacts: [ContactLedger; 2],
    pub(super) fluid: FluidAccount,
    pub(super) steps: u64,
}

impl Closing<'_> {
    /// The results of the run with the `history` that was kept.
    pub(super) fn integration(self, history: Option<History>) -> Integration {
        let Self { system, v, ref contacts, fluid, .. } = self;
        let velocity = system.of_bodies(v);
        let [start_q, start_v] = &system.start;
        let initial = system.energy(start_q, start_v);
        let end = system.energy(self.q, v);
        let contact_work = contacts[0].work + contacts[1].work;
        let dissipated = fluid.dissipated[0] + fluid.dissipated[1];
        let damped = system.is_damped();
        // damping takes energy out of the bodies; between them and the contacts none may be lost all the same
        let unaccounted = if damped {
            self.stored - contact_work + dissipated + fluid.work
        } else {
            end + self.stored - initial + dissipated
        };
        Integration {
            velocity,
            contacts: self.contacts,
            energy_residual: unaccounted.abs() / initial,
            energy_gained: unaccounted / initial,
            momentum_residual: unexplained_momentum(system, v, contacts, &fluid)
                / (system.masses[0] * system.speed),
            losses: Losses {
                plate_damping: if damped { initial - end - contact_work + fluid.work } else { 0.0 },
                squeeze_film: fluid.dissipated[0],
                drag: fluid.dissipated[1],
                ..Losses::default()
            },
            steps: self.steps,
            error_estimate: None,
            kept_tolerance: 0.0,
            history,
        }
    }
}

/// Largest momentum of a body in N s that no impulse accounts for, with the rates `v` at the end.
pub(super) fn unexplained_momentum(
    system: &System,
    v: &[f64],
    [outer, inner]: &[ContactLedger; 2],
    fluid: &FluidAccount,
) -> f64 {
    let velocity = system.of_bodies(v);
    let fluid_impulse = fluid.film_impulse + fluid.drag_impulse;
    let gained = system.masses[1] * (velocity[1] - system.inner_velocity());
    let mut largest = (gained + inner.impulse - fluid_impulse).abs();
    if !system.outer_returns() {
        let momentum = system.masses[0] * (velocity[0] + system.speed);
        largest = largest.max((momentum - outer.impulse).abs());
    }
    if system.oscillators.get(PLATE).is_some_and(|o| o.omega == 0.0) {
        // rigid motion of a free plate: rate / participation = momentum
        let plate = v[PLATE] / system.centre[PLATE];
        largest = largest.max((plate + outer.impulse - inner.impulse + fluid.film_impulse).abs());
    }
    largest
}
