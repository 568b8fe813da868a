//! What a run gives: a [`Summary`] and a [`History`], for every model and partner.

mod choice;
mod contact_pressure;
mod drive;
mod flight;
mod history;
mod impact;
pub(crate) mod limit;
mod losses;
mod point;
mod statement;
mod summary;
pub(crate) mod table;

pub use choice::{CandidateModel, Choice};
pub use contact_pressure::{ContactPatch, ContactPressure};
pub use drive::Drive;
pub use flight::{FlightSummary, VibrationSummary};
pub use history::{Curve, History};
pub use impact::Impact;
pub use limit::Limit;
pub use losses::Losses;
pub use point::Point;
pub use statement::Statement;
pub use summary::{BenderSummary, ElasticLimit, SCHEMA_VERSION, Sideways, Source, StackSummary, Summary};
pub(crate) use table::quantities;
pub use table::{Quantity, Table};

/// What is said of a run that ended while bodies touched.
pub const CUT: &str = "the run ends at `run.end_time` while bodies are in contact, so that final values are not determined; set a later end, or none";

/// What a run gives, whatever the kind of scene and whoever ran it.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The result in a few numbers.
    pub summary: Summary,
    /// The course over time.
    pub history: History,
}
