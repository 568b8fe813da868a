//! Contact laws: force as a function of the approach of two bodies.

mod hertz;
mod patch_flexibility;
mod residual;

pub use hertz::Hertz;
pub use patch_flexibility::{PatchFlexibility, PatchTable, RADII, TABULATED, Tabulated, WHOLE};
pub use residual::{Residual, State};
