//! A sphere strikes a mass on a spring: the smallest kind of scene, an example of how to add one.

mod model;
mod results;
mod scene;

pub use results::{CURVES, SpringQuantities};
pub use scene::{SpringMass, StrikingSphere, StruckMass};

use super::SeriesModel;
use crate::error::Result;
use crate::kinds::consistency::{SLACK, Stated, contact, displacement_balance, momentum_balance};
use crate::result::{Curve, History, Outcome, Quantity, Statement, Summary, limit};
use crate::scene::{Model, Scene};
use model::SpringModel;

/// Its name in scene files.
pub const NAME: &str = "spring-mass";

/// The registry's entry.
pub struct Kind;

impl super::Kind for Kind {
    fn name(&self) -> &'static str {
        NAME
    }

    /// One oscillator: the least that a reduced model can be.
    fn models(&self) -> &'static [Model] {
        &[Model::A]
    }

    fn quantities(&self) -> &'static [Quantity] {
        SpringQuantities::ALL
    }

    fn curves(&self) -> &'static [Curve] {
        &CURVES
    }

    fn model(&self, scene: &Scene, _: Model, _: Option<usize>) -> Result<Box<dyn SeriesModel>> {
        Ok(Box::new(SpringModel::new(scene)?))
    }

    fn judge(&self, scene: &Scene, summary: &mut Summary, _: Option<&History>) {
        let Ok(bodies) = scene.of_kind::<SpringMass>(NAME) else { return };
        let materials = [&bodies.sphere.material, &bodies.mass.material];
        let force = summary.value("sphere_force_peak").unwrap_or(0.0);
        summary.set_limits(limit::of_contact("sphere", &bodies.law(), force, &materials).collect());
    }

    fn checks(&self, scene: &Scene, outcome: &Outcome) -> Vec<Statement> {
        let (summary, history) = (&outcome.summary, &outcome.history);
        let Ok(bodies) = scene.of_kind::<SpringMass>(NAME) else { return Vec::new() };
        if !history.can_be_sampled() {
            return Vec::new();
        }
        let [path, velocity, force] =
            ["sphere_displacement", "sphere_velocity", "sphere_force"].map(|name| &history[name][..]);
        let (time, interval) = (&history.time[..], summary.sample_interval.unwrap_or(0.0));
        let mut found = contact("sphere", summary.source, (time, force), Stated::of(summary, "sphere"), 0.0);
        found.push(momentum_balance("sphere", bodies.sphere.mass, time, velocity, force, -1.0, interval));
        found.push(displacement_balance("sphere", time, (path, velocity), interval, SLACK));
        found
    }
}
