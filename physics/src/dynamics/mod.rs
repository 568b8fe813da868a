//! The motion: bodies as oscillators, coupled by contacts and fluid, from the first touch to the last release.

pub mod assured;
mod bank;
mod centre;
mod clearance;
mod closing;
pub mod collocation;
mod contact_forces;
mod contact_ledger;
pub mod duhamel;
pub mod explicit_runge_kutta;
mod force_peak;
mod free_flight;
pub mod integrator;
mod ladder;
mod ledger_check;
mod outer_body;
mod point_laws;
pub(crate) mod recorder;
mod step_bounds;
pub mod system;
pub mod wet;

pub use contact_ledger::ContactLedger;
pub use ledger_check::ledger_check;
pub use outer_body::OuterBody;
