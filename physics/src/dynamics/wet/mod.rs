//! The time integration of an impact in which the fluid acts by forces: squeeze film or drag.
//!
//! As in the dry one the oscillators answer exactly to forces that are polynomials through points of a step, here
//! Radau's, which let a film stop what it damps within a part of the step. Besides the two contact forces these are
//! now the generalised forces of the fluid, on the inner body and every mode of the plate; they depend on the motion
//! and on its rate, and are solved for implicitly: however stiff the film, the step is as long as its accuracy permits.
//! There is no free flight, since the film acts at any distance.

mod contact_between;
mod fluid_forces;
mod full_newton;
mod guess;
mod run;
mod solve;
mod table;

pub use fluid_forces::{FluidForces, FluidLoad, Tangent};
pub use run::integrate;
