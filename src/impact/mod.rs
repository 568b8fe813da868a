//! The impact: from bodies and contacts to a [`History`] and a [`Summary`].

pub mod assured;
mod bank;
mod centre;
pub mod choice;
mod clearance;
pub mod collocation;
mod contact_forces;
mod contact_ledger;
mod contact_pressure;
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
mod rough;
pub mod seal_seat;
mod seat_result;
mod step_bounds;
mod summary;
pub mod system;
mod validity;
pub mod variants;
pub mod wet;

pub use choice::{Candidate, Choice};
pub use contact_ledger::ContactLedger;
pub use contact_pressure::{ContactPatch, ContactPressure};
pub use history::{CURVES, Curves, History, Motion};
pub use integrator::Losses;
pub use outer_body::{Drive, OuterBody};
pub use seat_result::{SEAT_CURVES, SEAT_QUANTITIES, SeatHistory, SeatQuantities, SeatSummary};
pub use summary::{
    BenderSummary, PLATE_QUANTITIES, PlateQuantities, Quantities, SCHEMA_VERSION, Source, Summary,
};

/// Whether this build leaves out fluid, damping, residual flexibility and histories (feature `lean`), to measure what they
/// cost where they are not used.
const LEAN: bool = cfg!(feature = "lean");

/// What a run gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome<Q: Quantities = PlateQuantities> {
    /// The result in a few numbers.
    pub summary: Summary<Q>,
    /// The course over time.
    pub history: Q::History,
}
