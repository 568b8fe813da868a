//! The impact: from bodies and contacts to a [`History`] and a [`Summary`].

mod history;
mod summary;

pub use history::{CURVES, History, Motion};
pub use summary::{PLATE_QUANTITIES, PlateQuantities, SCHEMA_VERSION, Source, Summary};

/// What a run gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The result in a few numbers.
    pub summary: Summary,
    /// The course over time.
    pub history: History,
}
