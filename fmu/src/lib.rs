//! A scene's reduced model as a Functional Mock-up Unit (FMU) for co-simulation, FMI 2.0 and 3.0.
//!
//! Most masters step over a whole impact, and contact forces are too stiff to be coupled across units. So an [`ImpactUnit`] integrates the
//! whole impact at its launch, with the program's own integrator, and then gives its course at any time: results do not depend on
//! the communication steps.
//!
//! Data flows one way: [`source`] (what lies in the unit) -> [`mod@variables`] -> [`mod@unit`] (state, steps) with [`impact`] (one launch)
//! -> [`instance`] -> [`fmi3`], [`fmi2`] (the C interfaces). [`description`] writes `modelDescription.xml`.
#![warn(missing_docs)]

pub mod course;
pub mod description;
pub mod fmi2;
pub mod fmi3;
pub mod impact;
pub mod instance;
mod shared;
pub mod source;
pub mod unit;
pub mod variables;

pub use description::{Identity, Version, model_description};
pub use source::{MESHES, SCENE, SEAT_MESH, SETUP, UnitSetup, UnitSource};
pub use unit::ImpactUnit;
pub use variables::{UnitVariable, variables};
