//! Tests of the flexible seal seat's scene, reduced model and stored references.

mod compared;
mod friction;
mod reduced;
mod reference;
mod relaxing;
mod scaling;
mod scene;
mod series;
