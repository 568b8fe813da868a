//! Curves: brought to common instants and compared by the published metrics.

mod alignment;
mod curve_metrics;

pub(crate) use alignment::peak;
pub use alignment::{AlignedCurve, CommonAxis, SampledCurve, align, sample};
pub use curve_metrics::CurveMetrics;
pub(crate) use impactcheck_curves::MonotoneCubic;
pub use impactcheck_curves::{Grade, Iso18571, Russell, SpragueGeers, iso18571, russell, sprague_geers};
