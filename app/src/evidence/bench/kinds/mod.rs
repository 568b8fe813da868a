//! What is measured, by the kind of scene it is about.

mod plate_impact;

pub use plate_impact::Series;
pub(super) use plate_impact::run;
