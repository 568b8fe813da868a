//! The motion: bodies as oscillators, coupled by contacts and fluid, from the first touch to the last release.

mod balance_check;
mod batch;
mod centre;
mod clearance;
pub mod collocation;
pub mod contact_balance;
mod contact_forces;
mod direct;
pub(crate) mod driver;
pub mod equations;
pub mod error_control;
pub mod even_steps;
mod force_peak;
mod free_flight;
mod heating;
pub(crate) mod impulse_splitting;
pub mod integration;
pub mod integrator;
pub mod memory;
mod moving_body;
mod point_laws;
pub(crate) mod recorder;
pub mod sliding;
mod step_bounds;
mod step_table;
mod step_tables;
pub mod surface_modes;
pub mod system;
pub mod tangential_load;
pub mod wet;

pub use balance_check::balance_check;
pub use contact_balance::ContactBalance;
pub use driver::StopReason;
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
