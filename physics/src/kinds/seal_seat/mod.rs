//! Reduced model of the flexible seal seat (section 4.4): modes and full residual flexibility of the seat, rigid sphere
//! and actuator, unilateral contact at the nodes of the seat's mesh.
//!
//! Without friction the sphere's rotation idles: it has no torque, and of the three degrees of freedom in the plane two
//! move. On a rough seat it turns.

mod accumulate;
mod body;
mod candidates;
mod checks;
pub mod contact;
mod contact_set;
mod doubts;
mod drift;
mod friction;
pub mod integrate;
pub mod integration;
mod limits;
mod model;
pub mod nodes;
mod restitution;
mod results;
mod scene;
mod series;
mod shape;
mod surface_compliance;
mod survey;
pub mod system;
pub mod traces;
mod truncation;
mod watch;

use super::Series;
use crate::error::{Error, Result};
use crate::flight::Launch;
use crate::result::{Curve, History, Outcome, Quantity, Statement, Summary};
use crate::scene::{Model, Scene};

pub use body::{SeatBody, SeatMesh, Watch, supports};
pub use candidates::{Candidate, ContactBody, Zones, candidates};
pub use model::{DEFAULT_TOLERANCE, SeatModel, quantities};
pub use results::{CURVES, SeatCurves, SeatQuantities};
pub use scene::{Actuator, ContactRing, Notch, SealSeat, Seat, SeatedSphere, SphereBody};
pub use series::SeatSeries;
pub use survey::Survey;

/// Its name in scene files.
const NAME: &str = "seal-seat";

/// The registry's entry.
pub struct Kind;

impl super::Kind for Kind {
    fn name(&self) -> &'static str {
        NAME
    }

    fn models(&self) -> &'static [Model] {
        &[Model::C]
    }

    fn quantities(&self) -> &'static [Quantity] {
        SeatQuantities::ALL
    }

    fn curves(&self) -> &'static [Curve] {
        &CURVES
    }

    fn series(
        &self,
        _: &[(&str, [f64; 2])],
        scene: &Scene,
        mesh: Option<&SeatMesh>,
        _: usize,
    ) -> Result<Box<dyn Series>> {
        let mesh = mesh.ok_or_else(|| Error::Internal("a series of seal seats has a mesh".into()))?;
        Ok(Box::new(SeatSeries::new(scene, mesh)?))
    }

    fn judge(&self, scene: &Scene, summary: &mut Summary, history: Option<&History>) {
        if let Ok(setup) = scene.seal_seat() {
            limits::judge(setup, summary, history);
        }
    }

    fn launch(&self, summary: &Summary) -> Option<Launch> {
        let [x, z] = ["sphere_velocity_x", "sphere_velocity_z"].map(|name| summary.value(name));
        let (x, z) = (x?, z?);
        Some(Launch { speed: x.hypot(z), angle: x.atan2(z), spin: summary.sphere_spin.unwrap_or(0.0) })
    }

    fn checks(&self, scene: &Scene, outcome: &Outcome) -> Vec<Statement> {
        scene.seal_seat().map_or_else(|_| Vec::new(), |setup| checks::checks(setup, outcome))
    }
}
