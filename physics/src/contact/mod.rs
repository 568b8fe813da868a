//! Contact laws: force as a function of the approach of two bodies.

mod hertz;
mod residual;

pub use hertz::Hertz;
pub use residual::{Residual, State};
