//! Linear algebra and quadrature that know nothing of mechanics.

pub(crate) mod cholesky;
pub(crate) mod eigenmodes;
pub mod quadrature;
