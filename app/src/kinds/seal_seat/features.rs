//! The features of seal seats.

use crate::kinds::Feature;
use crate::kinds::seal_seat::{SealSeat, SphereBody};
use crate::scene::Scene;

pub(super) static FEATURES: [Feature; 4] = [
    Feature::new("seal seat", |s| seat(s, |_| true)),
    Feature::new("seal seat, friction", |s| seat(s, |seat| seat.friction > 0.0)),
    Feature::new("seal seat, elastic sphere", |s| seat(s, |seat| seat.sphere.body == SphereBody::Elastic)),
    Feature::new("seal seat, relaxing", |s| seat(s, |seat| !seat.seat.material.relaxation.is_empty())),
];

fn seat(scene: &Scene, has: fn(&SealSeat) -> bool) -> bool {
    scene.seal_seat().is_ok_and(has)
}
