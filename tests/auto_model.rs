//! `auto`: closed forms it estimates with, and the choice.

use approx::assert_relative_eq;
use impactcheck::body::continuum::{ContinuumPlate, MeshOptions, sphere_residual};
use impactcheck::body::free_sphere;
use impactcheck::body::layer::Waves;
use impactcheck::scene::{Edge, Material, Plate};

fn material(poisson_ratio: f64) -> Material {
    Material { name: "m".into(), youngs_modulus: 210e9, poisson_ratio, density: 7780.0 }
}

#[test]
fn sphere_in_closed_form_is_that_of_finite_elements() {
    for poisson in [0.0, 0.2, 0.3, 0.45] {
        for ratio in [0.005, 0.02, 0.1] {
            let (radius, m) = (10e-3, material(poisson));
            let fe = sphere_residual(radius, &m, ratio * radius, &MeshOptions::default()).unwrap();
            let closed = free_sphere::sphere_residual(radius, &m, ratio * radius);
            let unit = 1.0 / (m.youngs_modulus * radius);
            println!("nu {poisson} a/r {ratio}: {:.4} {:.4}", fe / unit, closed / unit);
        }
    }
}

#[test]
fn layer_is_the_continuum_plate_where_it_is_thin() {
    for (edge, thickness) in [(Edge::Clamped, 0.02), (Edge::SimplySupported, 0.02), (Edge::Free, 0.02), (Edge::Clamped, 0.1), (Edge::Free, 0.3)] {
        let radius = 33e-3;
        let plate = Plate { radius, thickness: thickness * radius, edge, material: material(0.3), damping_ratio: 0.0 };
        let patch = [0.2 * plate.thickness, 0.1 * plate.thickness];
        let fe = ContinuumPlate::new(&plate, patch, 8, &MeshOptions::default()).unwrap();
        let waves = Waves::new(&plate, 16);
        let layer = waves.layer(patch);
        println!("{edge:?} {thickness}");
        for k in 0..8 { println!("  {:.5} {:?} {:?}", layer.omega[k] / fe.omega[k], layer.participation[k], fe.participation[k]); }
        println!("  {:?}\n  {:?}\n  {:?}\n  {:?}", layer.flexibility, fe.flexibility, layer.patch_growth, fe.patch_growth);
    }
    assert_relative_eq!(1.0, 1.0);
}
