//! Curves: brought to common instants and compared by the published metrics.

mod alignment;
mod curve_metrics;
mod dynamic_time_warping;
mod inner_products;
mod interpolation;
mod iso18571;
mod russell;
mod sprague_geers;

pub(crate) use alignment::peak;
pub use alignment::{AlignedCurve, CommonAxis, SampledCurve, align, sample};
pub use curve_metrics::CurveMetrics;
pub(crate) use interpolation::MonotoneCubic;
pub use iso18571::{Grade, Iso18571, iso18571};
pub use russell::{Russell, russell};
pub use sprague_geers::{SpragueGeers, sprague_geers};
