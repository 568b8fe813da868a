//! Compares two curves, sampled at the same instants, by published metrics.

mod dynamic_time_warping;
mod inner_products;
mod interpolation;
mod iso18571;
mod russell;
mod sprague_geers;

pub use interpolation::MonotoneCubic;
pub use iso18571::{Grade, Iso18571, iso18571};
pub use russell::{Russell, russell};
pub use sprague_geers::{SpragueGeers, sprague_geers};
