//! Random dry impacts over the range that model C covers.

use crate::contact::Hertz;
use crate::scene::{Edge, Inner, Material, Outer, Plate, PlateImpact, Scene, Shape};
use crate::study::parameter::{logarithmic_at, scene};

/// Numbers that a scene is drawn from.
pub(super) const DIMENSIONS: usize = 14;
/// Radius of the plate in m: the equations know ratios of lengths only.
const PLATE_RADIUS: f64 = 20e-3;
/// Impact speeds in m/s that are of interest.
const SPEEDS: std::ops::RangeInclusive<f64> = 1e-3..=30.0;
/// Largest contact patch over the radius of a body for which Hertz's law is meant.
const LARGEST_PATCH: f64 = 0.2;

/// The impact at the place `x` of the unit cube, called `name`; `None` if bodies or speed are out of all proportion.
///
/// Plates from 0.004 to 1 radius thick of any edge, a quarter of them damped; spheres of 0.5 to 30 thicknesses, one inner body
/// in five compact instead; plate moduli 2 to 400 GPa, those of the bodies 50 to 500 GPa; three of ten with a gap. The speed is what
/// makes the outer contact patch 0.005 to 0.5 thicknesses wide on a rigid plate.
pub(super) fn draw(name: &str, x: &[f64]) -> Option<Scene> {
    let between = |axis: usize, low: f64, high: f64| logarithmic_at(low, high, x[axis]);
    let material = |name: &str, youngs_modulus, poisson_ratio, density| Material {
        name: name.into(),
        youngs_modulus,
        poisson_ratio,
        density,
        yield_strength: None,
    };
    let thickness = PLATE_RADIUS * between(3, 0.004, 1.0);
    let plate = Plate {
        radius: PLATE_RADIUS,
        thickness,
        edge: [Edge::Clamped, Edge::SimplySupported, Edge::Free][((x[10] * 3.0) as usize).min(2)],
        material: material("plate", between(0, 2e9, 4e11), 0.1 + 0.35 * x[1], between(2, 1e3, 1.2e4)),
        damping_ratio: if x[12] < 0.25 { logarithmic_at(1e-3, 0.1, 4.0 * x[12]) } else { 0.0 },
    };
    let bodies = material("bodies", between(6, 5e10, 5e11), 0.15 + 0.25 * x[7], between(8, 2.5e3, 1.2e4));
    let outer_radius = thickness * between(4, 0.5, 30.0);
    let inner_radius = outer_radius * between(5, 0.4, 2.5);
    let outer_shape = Shape::Sphere { radius: outer_radius };
    let sphere = Shape::Sphere { radius: inner_radius };
    let inner_shape = match x[13] {
        share if share < 0.2 => Shape::Compact {
            mass: sphere.mass(&bodies) * logarithmic_at(0.3, 3.0, 5.0 * share),
            tip_radius: inner_radius,
        },
        _ => sphere,
    };
    // the speed of a Hertz impact on a rigid plate with the patch a: approach a^2/r
    let patch = thickness * between(9, 0.005, 0.5);
    let approach = patch * patch / outer_radius;
    let stiffness = Hertz::new(outer_radius, &bodies, &plate.material).stiffness;
    let speed = (0.8 * stiffness * approach.powf(2.5) / outer_shape.mass(&bodies)).sqrt();
    let gap = if x[11] < 0.3 { approach * logarithmic_at(0.01, 2.0, x[11] / 0.3) } else { 0.0 };
    let sound = outer_radius.max(inner_radius) <= 2.0 * PLATE_RADIUS
        && patch <= LARGEST_PATCH * outer_radius.min(inner_radius)
        && SPEEDS.contains(&speed);
    sound.then(|| {
        let setup = PlateImpact {
            plate,
            outer: Outer { shape: outer_shape, material: bodies.clone(), speed },
            inner: Inner { shape: inner_shape, material: bodies, gap },
            fluid: None,
        };
        scene(name, setup)
    })
}
