//! Random dry impacts over the range that scenes permit.

use super::super::parameter::{logarithmic_at, scene};
use crate::contact::Hertz;
use crate::kinds::plate_impact::PlateImpact;
use crate::scene::{Edge, Inner, Material, Outer, Plate, Scene, Shape};

/// Numbers that a scene is drawn from.
pub(super) const DIMENSIONS: usize = 20;
/// Radius of the plate in m: the equations know ratios of lengths only.
const PLATE_RADIUS: f64 = 20e-3;
/// Impact speeds in m/s.
const SPEEDS: std::ops::RangeInclusive<f64> = 1e-5..=100.0;

/// The impact at the place `x` of the unit cube, called `name`; `None` if the speed is out of all proportion.
///
/// All three materials from 10 MPa to 1 TPa, Poisson's ratio -0.99 to 0.499 and 500 to 20 000 kg/m^3, each for itself; plates of
/// any edge 0.002 to 2 radii thick, a quarter of them damped; an outer sphere of 0.02 to 1 plate radii, an inner one of 0.1
/// to 10 times that; one in four of either replaced by a compact body of a hundredth to a hundred times its mass; three of ten
/// with a gap. The speed is what makes the outer contact patch on a rigid plate 0.003 to 1.5 times as wide as the plate is thick, or the
/// sphere's radius if that is smaller.
pub(super) fn draw(name: &str, x: &[f64]) -> Option<Scene> {
    let between = |axis: usize, low: f64, high: f64| logarithmic_at(low, high, x[axis]);
    let material = |name: &str, first: usize| {
        Material::elastic(
            name,
            between(first, 1e7, 1e12),
            -0.99 + 1.489 * x[first + 1],
            between(first + 2, 500.0, 2e4),
        )
    };
    let compact = |radius: f64, material: &Material, share: f64, ratio: f64| {
        let sphere = Shape::Sphere { radius };
        match share < 0.25 {
            true => Shape::Compact { mass: ratio * sphere.mass(material), tip_radius: radius },
            false => sphere,
        }
    };
    let thickness = PLATE_RADIUS * between(9, 0.002, 2.0);
    let plate = Plate {
        radius: PLATE_RADIUS,
        thickness,
        edge: [Edge::Clamped, Edge::SimplySupported, Edge::Free][((x[10] * 3.0) as usize).min(2)],
        material: material("plate", 0),
        damping_ratio: if x[11] < 0.25 { logarithmic_at(1e-4, 1.0, 4.0 * x[11]) } else { 0.0 },
    };
    let (outer_material, inner_material) = (material("outer", 3), material("inner", 6));
    let outer_radius = PLATE_RADIUS * between(12, 0.02, 1.0);
    let inner_radius = outer_radius * between(13, 0.1, 10.0);
    let outer_shape = compact(outer_radius, &outer_material, x[14], between(15, 0.01, 100.0));
    let inner_shape = compact(inner_radius, &inner_material, x[16], between(17, 0.01, 100.0));
    // a Hertz impact on a rigid plate with the patch a has the approach a^2/r
    let patch = thickness.min(outer_radius) * between(18, 0.003, 1.5);
    let approach = patch * patch / outer_radius;
    let stiffness = Hertz::new(outer_radius, &outer_material, &plate.material).stiffness;
    let speed = (0.8 * stiffness * approach.powf(2.5) / outer_shape.mass(&outer_material)).sqrt();
    let gap = if x[19] < 0.3 { approach * logarithmic_at(1e-3, 10.0, x[19] / 0.3) } else { 0.0 };
    SPEEDS.contains(&speed).then(|| {
        let setup = PlateImpact {
            friction: 0.0,
            plate,
            outer: Outer::centred(outer_shape, outer_material, speed),
            inner: Inner { shape: inner_shape, material: inner_material, gap, speed: 0.0 },
            fluid: None,
            series: None,
        };
        scene(name, setup)
    })
}
