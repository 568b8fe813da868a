//! Linear algebra, quadrature, roots and oscillators that know nothing of bodies.

pub(crate) mod chebyshev;
pub(crate) mod cholesky;
pub mod duhamel;
pub(crate) mod eigenmodes;
pub mod explicit_runge_kutta;
pub mod least_squares;
pub mod quadrature;
pub(crate) mod root;
pub(crate) mod stages;
pub mod stationary_noise;
pub(crate) mod stopwatch;
pub(crate) mod vectors;
