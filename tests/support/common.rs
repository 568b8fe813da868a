//! Bodies and scenes that several tests use.
#![allow(dead_code)]

use impactcheck::kinds::plate_impact::PlateImpact;
use impactcheck::scene::*;

/// Steel of Table 1.
pub fn steel() -> Material {
    Material::elastic("steel", 210e9, 0.3, 7780.0)
}

/// Clamped steel plate of Table 1 between two steel spheres of `radius` m, struck at `speed` m/s.
pub fn scaled_plate(radius: f64, speed: f64) -> PlateImpact {
    let steel = steel();
    PlateImpact {
        friction: 0.0,
        plate: Plate {
            radius: 0.033,
            thickness: 0.002,
            edge: Edge::Clamped,
            material: steel.clone(),
            damping_ratio: 0.0,
        },
        outer: Outer::centred(Shape::Sphere { radius }, steel.clone(), speed),
        inner: Inner {
            shape: Shape::Sphere { radius },
            material: steel,
            gap: 0.0,
            speed: 0.0,
            turning: Turning::default(),
        },
        fluid: None,
        series: None,
    }
}
