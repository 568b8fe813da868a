//! Reduced model of the flexible seal seat (section 4.4): modes and full residual flexibility of the seat, rigid sphere
//! and actuator, unilateral contact at the nodes of the seat's mesh.
//!
//! Without friction the sphere's rotation idles: it has no torque, and of the three degrees of freedom in the plane two
//! move.

mod candidates;
mod cholesky;
pub mod contact;
pub mod integrate;
pub mod system;

pub use candidates::{Candidate, Partner, Zones, candidates};
#[cfg(test)] mod scratch;
