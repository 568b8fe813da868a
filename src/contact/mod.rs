//! Contact laws: force as a function of the approach of two bodies.

mod hertz;
pub mod residual;

pub use hertz::Hertz;
