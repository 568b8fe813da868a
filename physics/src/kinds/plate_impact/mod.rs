//! An outer body strikes a plate, the plate passes the blow to an inner body: reduced models A, B and C.

mod assembled;
mod checks;
pub mod closed_forms;
mod continua;
pub mod errors;
mod laws;
mod limits;
mod predictor;
pub mod reduced;
mod results;
mod scene;
pub mod shared;
mod shown;
mod trials;
mod truncation;
mod validity;
pub mod variants;

use super::general_impact::{MeshRequest, off_centre_meshes};
use super::{SeatMesh, Series, SeriesModel};
use crate::error::Result;
use crate::flight::Launch;
use crate::result::{Curve, History, Outcome, Quantity, Statement, Summary, Table};
use crate::scene::{Model, Scene};
use std::f64::consts::FRAC_PI_2;

pub(super) use predictor::SMALLEST_PATCH;
pub use results::{CURVES, Motion, PlateCurves, PlateQuantities};
pub use scene::{MAX_MODES, PlateImpact};
pub(super) use scene::{PLATE, read_plate, slenderness};
pub use validity::FILM_SHARE;
pub(super) use validity::{punches, warnings};

/// Its name in scene files.
pub(super) const NAME: &str = "plate-impact";

/// The registry's entry.
pub struct Kind;

impl super::Kind for Kind {
    fn name(&self) -> &'static str {
        NAME
    }

    fn models(&self) -> &'static [Model] {
        &[Model::A, Model::B, Model::C]
    }

    fn has_form(&self, scene: &Scene, model: Model) -> bool {
        reduced::Reduced::require(scene, model).is_ok()
    }

    fn quantities(&self) -> &'static [Quantity] {
        PlateQuantities::ALL
    }

    fn curves(&self) -> &'static [Curve] {
        &CURVES
    }

    fn model(&self, scene: &Scene, model: Model, modes: Option<usize>) -> Result<Box<dyn SeriesModel>> {
        Ok(Box::new(reduced::Reduced::new(scene, model, modes)?))
    }

    fn series(
        &self,
        varied: &[(&str, [f64; 2])],
        scene: &Scene,
        _: Option<&SeatMesh>,
        impacts: usize,
    ) -> Result<Box<dyn Series>> {
        let varied = varied.iter().copied();
        Ok(Box::new(shared::SharedBodies::for_varied(varied, scene.plate_impact()?, impacts)))
    }

    fn judge(&self, scene: &Scene, summary: &mut Summary, history: Option<&History>) {
        if let Ok(setup) = scene.plate_impact() {
            limits::judge(setup, summary, history);
        }
    }

    fn shown(&self, scene: &Scene, history: &History) -> Table {
        scene
            .plate_impact()
            .map_or_else(|_| Table::new(self.quantities()), |setup| shown::shown(setup, history))
    }

    fn launch(&self, summary: &Summary) -> Option<Launch> {
        // over the rocker the sphere leaves along the floor
        let speed = summary.value("inner_velocity_final")?.abs();
        Some(Launch { speed, angle: FRAC_PI_2, spin: 0.0 })
    }

    fn mesh_requests(&self, scene: &Scene) -> Vec<MeshRequest> {
        let setup = scene.plate_impact().ok().filter(|setup| !setup.outer.is_centred());
        setup.map_or_else(Vec::new, |setup| off_centre_meshes(&setup.plate, &setup.outer))
    }

    fn checks(&self, scene: &Scene, outcome: &Outcome) -> Vec<Statement> {
        let is_cut = scene.run.end_time.is_some();
        scene.plate_impact().map_or_else(|_| Vec::new(), |setup| checks::checks(setup, outcome, is_cut))
    }
}
