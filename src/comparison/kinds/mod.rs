//! What a comparison of some kinds of scene has besides discrepancies.

pub mod plate_impact;

pub use plate_impact as budget;
