//! Fluid on the inner side of the plate (section 3.5 of the paper): squeeze film, drag, added mass, damping.
//!
//! Each effect has its own switch in the scene, and what is off does not exist: added mass and damping change the
//! modes of the plate before the impact, and only film or drag need the integrator for wet scenes.

pub mod added_mass;
pub mod deflection;
mod drag;
pub mod film;
mod indentation;
mod viscosity;

pub use deflection::Deflection;
pub use drag::Drag;
pub use film::{Film, FilmForces, Profile, Ring};
pub use indentation::Indentation;
pub use viscosity::Viscosity;
