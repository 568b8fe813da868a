//! What a run gives: a [`Summary`] and a [`History`], for every model and partner.

mod choice;
mod contact_pressure;
mod drive;
mod history;
mod losses;
mod seat_result;
mod summary;

pub use choice::{Candidate, Choice};
pub use contact_pressure::{ContactPatch, ContactPressure};
pub use drive::Drive;
pub use history::{CURVES, Curves, History, Motion};
pub use losses::Losses;
pub use seat_result::{SEAT_CURVES, SEAT_QUANTITIES, SeatHistory, SeatQuantities, SeatSummary};
pub use summary::{
    BenderSummary, PLATE_QUANTITIES, PlateQuantities, Quantities, SCHEMA_VERSION, Source, Summary,
};

/// What a run gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome<Q: Quantities = PlateQuantities> {
    /// The result in a few numbers.
    pub summary: Summary<Q>,
    /// The course over time.
    pub history: Q::History,
}
