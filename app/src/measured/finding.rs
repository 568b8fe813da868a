//! What is wrong with a record, and what that does to its results.

use serde::Serialize;

/// Kind of a fault of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FindingKind {
    /// The free flight is not straight, or its drift is large.
    Drift,
    /// A vibration of the mains.
    Hum,
    /// The signal stops at a limit.
    Clipped,
    /// Samples are missing.
    Gap,
    /// Samples that nothing measured.
    Padding,
    /// A further impact during the free flight.
    SecondStrike,
    /// A body was stopped during its free flight.
    EndStop,
    /// The sensor does not pass constant values.
    AcCoupled,
    /// One signal is late.
    Delay,
    /// The impact is counted already.
    Duplicate,
    /// The curves are not those of the scene.
    OtherScene,
    /// More energy after the impact than before, as far as its uncertainty tells.
    Energy,
}

/// A fault of a record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// What it is.
    pub kind: FindingKind,
    /// Where it begins and ends, s on the record's own clock.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// Signal, size, and what becomes of the results: a sentence.
    pub effect: String,
}

impl Finding {
    /// Of `kind`, between the times `span`.
    pub fn new(kind: FindingKind, [from, to]: [f64; 2], effect: String) -> Self {
        Finding { kind, from, to, effect }
    }
}
