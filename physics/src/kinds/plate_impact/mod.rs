//! An outer body strikes a plate, the plate passes the blow to an inner body: reduced models A, B and C.

pub mod choice;
pub mod errors;
pub mod reduced;
mod results;
mod rough;
mod trials;
mod truncation;
mod validity;
pub mod variants;

use crate::result::{Curve, Quantity};
use crate::scene::Model;

pub use results::{CURVES, Motion, PlateCurves, PlateQuantities};

/// The registry's entry.
pub struct Kind;

impl super::Kind for Kind {
    fn name(&self) -> &'static str {
        "plate-impact"
    }

    fn models(&self) -> &'static [Model] {
        &[Model::A, Model::B, Model::C]
    }

    fn quantities(&self) -> &'static [Quantity] {
        PlateQuantities::ALL
    }

    fn curves(&self) -> &'static [Curve] {
        &CURVES
    }
}
