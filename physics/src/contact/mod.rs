//! Contact laws: force as a function of the approach of two bodies.

mod dented;
mod elastic_plastic;
mod ellipse;
mod hertz;
mod patch_flexibility;
mod press;
mod radial_slip;
mod residual;
mod tangential;
mod viscoelastic;

pub use dented::DentedContact;
pub(crate) use elastic_plastic::TABOR;
pub use ellipse::{EffectiveSphere, effective_sphere};
pub use hertz::Hertz;
pub use patch_flexibility::{PatchFlexibility, PatchTable, RADII, TABULATED, Tabulated, WHOLE};
pub use press::Press;
pub use residual::{Residual, State};
pub use tangential::TangentialContact;
pub use viscoelastic::ViscoelasticContact;
