//! Seal seats: a sphere is launched out of a flexibly mounted conical seat.

mod features;

pub use impactcheck_physics::kinds::seal_seat::*;

use super::{Feature, INTENDED_SPEED, Starter, Use, Value};
use crate::scene::{Geometry, Scene};

/// What a direction beyond the bound costs, per rad: more than any design gains by it.
const ASTRAY: f64 = 10.0;

impl super::Kind for Kind {
    fn serves(&self, purpose: Use) -> bool {
        purpose == Use::MeshFile
    }

    fn starter(&self) -> Starter {
        Starter {
            about: "A sphere is launched out of a flexibly mounted conical seat",
            text: include_str!("starter.toml"),
        }
    }

    fn features(&self) -> &'static [Feature] {
        &features::FEATURES
    }

    fn revision(&self, _: Geometry) -> u32 {
        4
    }

    fn geometry_hash(&self, scene: &Scene) -> Option<String> {
        scene.seal_seat().ok().map(|setup| setup.geometry_hash())
    }

    fn objective(&self, _: &Scene) -> &'static str {
        INTENDED_SPEED
    }

    fn intended_speed(&self, scene: &Scene, within: f64, value: &Value) -> Option<f64> {
        let intended = scene.seal_seat().ok()?.intended_angle;
        let [x, z] = [value("sphere_velocity_x")?, value("sphere_velocity_z")?];
        let along = x * intended.sin() + z * intended.cos();
        let astray = ((x.atan2(z) - intended).abs() - within).max(0.0);
        Some(along - ASTRAY * astray * along.abs())
    }
}
