//! Tests of the flexible seal seat's scene, reduced model and stored references.

mod reduced;
mod reference;
mod scaling;
mod scene;
