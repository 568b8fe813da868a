//! Sweeps of one's own: any numeric fields of a scene over ranges or lists, from a file.
//!
//! A [`Plan`] numbers the points; every point's result is a line in an append-only log (`record`) as soon as it is
//! known, so that an interrupted sweep goes on where it stopped, and shards run side by side; a [`Table`] joins what the
//! logs hold.

mod axis;
mod plan;
mod record;
mod references;
mod run;
mod table;

pub use plan::{DEFAULT_TOLERANCE, Draw, Plan};
pub use record::{Outcome, Record};
pub use references::{Known, references};
pub use run::{Progress, Shard, in_memory, run};
pub use table::Table;
