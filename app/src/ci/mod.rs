//! What a project needs when a machine runs the gate on every commit: results over commits ([`trend`]), tolerances and
//! references that are changed with a reason only ([`acceptance`], [`tolerance_edit`]; [`tolerance_watch`] tells of those changed by hand).

pub mod acceptance;
pub mod commit;
pub(crate) mod json_lines;
pub mod tolerance_edit;
pub mod tolerance_watch;
pub mod trend;
