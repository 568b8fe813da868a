//! Linear algebra, quadrature and roots that know nothing of mechanics.

pub(crate) mod chebyshev;
pub(crate) mod cholesky;
pub(crate) mod eigenmodes;
pub mod least_squares;
pub mod quadrature;
pub(crate) mod root;
pub(crate) mod vectors;
