//! The motion: bodies as oscillators, coupled by contacts and fluid, from the first touch to the last release.

pub mod assured;
mod bank;
mod centre;
mod clearance;
pub mod collocation;
mod contact_forces;
pub mod contact_ledger;
mod direct;
pub(crate) mod driver;
pub mod equations;
mod force_peak;
mod free_flight;
mod heating;
pub mod integration;
pub mod integrator;
pub(crate) mod kicks;
mod ladder;
mod ledger_check;
pub mod memory;
mod moving_body;
mod point_laws;
pub(crate) mod recorder;
mod step_bounds;
mod step_table;
pub mod system;
pub mod wet;

pub use contact_ledger::ContactLedger;
pub use driver::StopReason;
pub use ledger_check::ledger_check;
pub use moving_body::MovingBody;

use crate::error::Result;
use integration::{Integration, Options};

/// Integrates the impact of `system`, in a fluid that acts by forces or without.
///
/// # Errors
/// [`crate::Error::Solver`] if a contact has no equilibrium, the step falls below 2^-44 of its base length, or the run does not end;
/// [`crate::Error::BeyondModel`] if the plate bends around the inner body in a film, or rattles endlessly.
pub fn integrate(
    system: &system::System,
    fluid: Option<&wet::FluidForces>,
    options: &Options,
) -> Result<Integration> {
    match fluid {
        None => integrator::integrate(system, options),
        Some(fluid) => wet::integrate(system, fluid, options),
    }
}
