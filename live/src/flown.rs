//! The flight after an impact, for drawing.

use impactcheck_physics::flight::{Vector, fly};
use impactcheck_physics::kinds::flight::flight_of;
use impactcheck_physics::result::Summary;
use impactcheck_physics::scene::Scene;
use serde_json::{Value, json};

/// Points of a path that are drawn at most.
const POINTS: usize = 2000;

/// Corners of the chamber, centres of the sphere in both seats and on its way, and its radius, in m; null without a flight.
pub(crate) fn drawn(scene: &Scene, summary: &Summary) -> Value {
    let Some(flight) = &summary.flight else { return Value::Null };
    let Ok((setup, landscape)) = flight_of(scene, flight.restitution) else { return Value::Null };
    let path = fly(&setup, &landscape, &flight.launch, true).path;
    let every = path.len().div_ceil(POINTS).max(1);
    let last = path.last().into_iter();
    let places = path.iter().step_by(every).chain(last).map(|state| [state.place.x, state.place.y]);
    let of = |places: &[Vector]| -> Vec<[f64; 2]> { places.iter().map(|place| [place.x, place.y]).collect() };
    json!({
        "corners": of(setup.chamber.corners()), "seats": of(&setup.chamber.seats()),
        "path": places.collect::<Vec<_>>(), "radius": setup.radius,
    })
}
