//! The impact: from bodies and contacts to a [`History`] and a [`Summary`].

mod bank;
mod centre;
pub mod collocation;
mod contact_forces;
mod contact_ledger;
pub mod duhamel;
pub mod explicit_runge_kutta;
mod free_flight;
mod history;
pub mod integrator;
mod ladder;
mod outer_body;
mod point_laws;
mod recorder;
pub mod reduced;
mod step_bounds;
mod summary;
pub mod system;
mod validity;
pub mod variants;
pub mod wet;

pub use contact_ledger::ContactLedger;
pub use history::{CURVES, History, Motion};
pub use integrator::Losses;
pub use outer_body::{Drive, OuterBody};
pub use summary::{BenderSummary, PLATE_QUANTITIES, PlateQuantities, SCHEMA_VERSION, Source, Summary};

/// What a run gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The result in a few numbers.
    pub summary: Summary,
    /// The course over time.
    pub history: History,
}
