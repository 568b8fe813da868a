//! Materials and plates for the tests of the continuum bodies.
#![allow(dead_code)] // each test file uses its part

use impactcheck::scene::{Edge, Material, Plate};

pub fn material(youngs_modulus: f64, poisson_ratio: f64, density: f64) -> Material {
    Material::elastic("material", youngs_modulus, poisson_ratio, density)
}

pub fn steel() -> Material {
    material(210e9, 0.3, 7780.0)
}

pub fn titanium() -> Material {
    material(115e9, 0.37, 4430.0)
}

pub fn plate_of(radius: f64, thickness: f64, edge: Edge, material: Material) -> Plate {
    Plate { radius, thickness, edge, material, damping_ratio: 0.0 }
}
