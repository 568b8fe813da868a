//! The features of plate impacts.

use crate::kinds::plate_impact::PlateImpact;
use crate::kinds::{Feature, Form};
use crate::scene::{Edge, Fluid, Material, Scene, Shape};

/// Thickness over radius from which a plate counts as thick.
const THICK: f64 = 0.3;
/// Thickness over radius up to which a plate counts as thin.
const THIN: f64 = 0.02;

pub(super) static FEATURES: [Feature; 23] = [
    Feature::new("clamped edge", |s| plate(s, |p| p.plate.edge == Edge::Clamped)).by(Form::CircularPlate),
    Feature::new("simply supported edge", |s| plate(s, |p| p.plate.edge == Edge::SimplySupported))
        .by(Form::CircularPlate),
    Feature::new("free edge", |s| plate(s, |p| p.plate.edge == Edge::Free)).by(Form::CircularPlate),
    Feature::new("thick plate (t ≥ 0.3 R)", |s| plate(s, |p| p.plate.thickness >= THICK * p.plate.radius)),
    Feature::new("thin plate (t ≤ 0.02 R)", |s| plate(s, |p| p.plate.thickness <= THIN * p.plate.radius)),
    Feature::new("damped plate", |s| plate(s, |p| p.plate.damping_ratio > 0.0)),
    Feature::new("gap", |s| plate(s, |p| p.inner.gap > 0.0)),
    Feature::new("inner body with a speed", |s| plate(s, |p| p.inner.speed != 0.0)),
    Feature::new("unlike materials", |s| plate(s, unlike)).by(Form::Hertz),
    Feature::new("compact outer body", |s| plate(s, |p| matches!(p.outer.shape, Shape::Compact { .. })))
        .by(Form::Hertz),
    Feature::new("compact inner body", |s| plate(s, |p| matches!(p.inner.shape, Shape::Compact { .. }))),
    Feature::new("relaxing material", |s| plate(s, PlateImpact::relaxes)).by(Form::Hunter),
    Feature::new("yielding material", |s| plate(s, |p| p.yields())),
    Feature::new("impacts in series", |s| plate(s, |p| p.series.is_some())),
    Feature::new("bender", |s| plate(s, |p| matches!(p.outer.shape, Shape::Bender(_)))).by(Form::Cantilever),
    Feature::new("stack", |s| plate(s, |p| matches!(p.outer.shape, Shape::Stack(_)))),
    Feature::new("friction", |s| plate(s, PlateImpact::rubs)),
    Feature::new("off-centre impact", |s| plate(s, |p| p.outer.offset > 0.0)),
    Feature::new("oblique impact", |s| plate(s, |p| p.outer.angle != 0.0)),
    Feature::new("squeeze film", |s| fluid(s, |f| f.squeeze_film)).by(Form::Film),
    Feature::new("shear thinning", |s| fluid(s, |f| f.shear_thinning.is_some())),
    Feature::new("added mass", |s| fluid(s, |f| f.added_mass_frequency_ratio < 1.0)),
    Feature::new("drag", |s| fluid(s, |f| f.drag_coefficient > 0.0)),
];

fn plate(scene: &Scene, has: fn(&PlateImpact) -> bool) -> bool {
    scene.plate_impact().is_ok_and(has)
}

fn fluid(scene: &Scene, has: fn(&Fluid) -> bool) -> bool {
    scene.plate_impact().is_ok_and(|setup| setup.fluid.as_ref().is_some_and(has))
}

fn unlike(setup: &PlateImpact) -> bool {
    let elastic = |m: &Material| (m.youngs_modulus, m.poisson_ratio, m.density);
    let plate = elastic(&setup.plate.material);
    elastic(&setup.outer.material) != plate || elastic(&setup.inner.material) != plate
}
