//! The features of impacts without a plate.

use crate::kinds::general_impact::{GeneralImpact, Struck, Wall};
use crate::kinds::{Feature, Form};
use crate::scene::{Scene, Shape};

pub(super) static FEATURES: [Feature; 10] = [
    Feature::new("wall", |s| has(s, |i| wall(i).is_some_and(|wall| wall.material.is_some()))).by(Form::Hertz),
    Feature::new("rigid wall", |s| has(s, |i| wall(i).is_some_and(|wall| wall.material.is_none())))
        .by(Form::Hertz),
    Feature::new("two bodies without a plate", |s| has(s, |i| i.struck_inner().is_some())).by(Form::Hertz),
    Feature::new("plate without an inner body", |s| has(s, |i| i.plate().is_some())),
    Feature::new("elastic body from a file", |s| {
        has(s, |i| i.body().is_some_and(|body| !body.fixed.is_empty()))
    }),
    Feature::new("free elastic body from a file", |s| {
        has(s, |i| i.body().is_some_and(|body| body.fixed.is_empty()))
    }),
    Feature::new("no plate, compact body", |s| has(s, |i| matches!(i.outer.shape, Shape::Compact { .. }))),
    Feature::new("no plate, bender or stack", |s| has(s, |i| i.outer.shape.is_mounted())),
    Feature::new("no plate, yielding material", |s| has(s, super::yields)),
    Feature::new("no plate, relaxing material", |s| {
        has(s, |i| i.materials().iter().any(|material| !material.relaxation.is_empty()))
    }),
];

fn has(scene: &Scene, feature: fn(&GeneralImpact) -> bool) -> bool {
    scene.general_impact().is_ok_and(feature)
}

fn wall(impact: &GeneralImpact) -> Option<&Wall> {
    if let Some(Struck::Wall(wall)) = &impact.struck { Some(wall) } else { None }
}
