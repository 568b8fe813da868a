//! An outer body strikes a plate, the plate passes the blow to an inner body: reduced models A, B and C.

pub mod choice;
pub mod errors;
mod limits;
pub mod reduced;
mod results;
mod rough;
mod trials;
mod truncation;
mod validity;
pub mod variants;

use crate::result::{Curve, History, Quantity, Summary};
use crate::scene::{Model, Scene, Setup};

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

    fn judge(&self, scene: &Scene, summary: &mut Summary, history: Option<&History>) {
        if let Setup::PlateImpact(setup) = &scene.setup {
            limits::judge(setup, summary, history);
        }
    }
}
