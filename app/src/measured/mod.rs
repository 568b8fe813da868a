//! Measured signals: histories from laser vibrometers beside the models (section 3.4, Figs. 12 and 13 of the paper).
//!
//! Two vibrometers see the outer and the inner body; each gives displacement, velocity or both. A record begins at any
//! time, and its signals may carry an offset and a drift, a part that is linear in time. The rule by which both are taken out and
//! the record is laid over the models is [`RULE`]; the report states it too.

mod align;
mod area;
mod compare;
mod duplicate;
mod filter;
mod finding;
mod flight;
mod judge;
mod record;
pub(crate) mod screen;
mod shift;
mod shortened;
mod structure;

pub use align::{AlignedRecord, ChannelCorrection, ContactEnds, Speed, align, align_all};
pub use area::Area;
pub use compare::{Measured, MeasuredComparison, REFERENCE, Series, compare};
pub use filter::{Filtered, low_pass};
pub use finding::{Finding, FindingKind};
pub use record::{Channel, ReadRecord, Record};

/// Bandwidth in Hz of the paper's vibrometers.
pub const BANDWIDTH: f64 = 100e3;

/// The rule of alignment, as it stands in the report.
pub const RULE: &str = "Offset and drift of a signal come from the free flight before the first and after the last contact, where the \
velocity is constant: a velocity is fitted there with a step, an offset and a drift, a displacement with a straight line \
on each side. Before the impact the inner body is at rest and the outer one has the scene's speed (with `--speed measured` \
the speed is read from the signal, which then has no offset). A displacement is zero at the first contact. The shift in time \
is the one that minimises the squared distance to the reference (without one, to the finest model), filtered to the instrument's bandwidth, over the contact and \
as much time before and after it; each signal over its noise in free flight (at least 1 % of its span) and with any offset, drift \
and amplitude, so that another speed or efficiency hardly moves it. The efficiency is that of the measured velocities. Its 95 % interval \
follows from the noise in free flight and its correlation in time. Padding and what follows a further impact are not used.";
