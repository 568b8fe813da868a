//! Uncertain inputs: how the results of a reduced model scatter with the inputs of a scene, and what that means for a comparison.
//!
//! [`study`] runs the model at quasi-random inputs ([`design`]), in the logs of a sweep; [`estimate`] has the estimators, which know
//! nothing of impacts; [`PropagatedUncertainty`] is what comes out.

pub mod design;
mod draw;
pub mod estimate;
mod propagated;
mod request;
mod study;
pub mod validation;

pub use draw::Inputs;
pub use propagated::{Correlated, Input, Local, PropagatedUncertainty, QuantityUncertainty, Share};
pub use request::{DEFAULT_QUANTITIES, Request, Samples};
pub use study::{study, uncertainty_of};
