//! Model C on both scenes of Table 1 of the paper, integrated by plain Runge-Kutta.
//!
//! Goal: the continuum plate with residual flexibility, and the spheres' residual, give the impact of an
//! independent finite-element program (converged prototype: (a) efficiency 0.6946 +- 0.0002, peaks 443.1 / 352.1 N
//! +- 0.7, ends 180.5 / 84.5 us; (b) 0.3868 +- 0.0003, 142.9 / 85.35 +- 0.15, 62.4 / 52.2), whatever the
//! patch radius, the number of modes and the mesh.

mod continuum_support;

use approx::assert_relative_eq;
use continuum_support::{Impact, ImpactResult, plate_of, steel};
use impactcheck::body::continuum::{ContinuumPlate, MeshOptions, sphere_residual};
use impactcheck::scene::Edge;
use std::f64::consts::PI;

struct Scene {
    sphere_radius: f64,
    speed: f64,
    patch_radius: f64,
    end: f64,
}

const A: Scene = Scene { sphere_radius: 10e-3, speed: 0.55, patch_radius: 0.30e-3, end: 200e-6 };
const B: Scene = Scene { sphere_radius: 6.35e-3, speed: 0.437, patch_radius: 0.18e-3, end: 80e-6 };

fn run(scene: &Scene, modes: usize, patch_factor: f64, mesh: &MeshOptions) -> ImpactResult {
    let plate = plate_of(33e-3, 2e-3, Edge::Clamped, steel());
    let patch = scene.patch_radius * patch_factor;
    let continuum = ContinuumPlate::new(&plate, [patch; 2], modes, mesh).unwrap();
    let mass = 4.0 / 3.0 * PI * scene.sphere_radius.powi(3) * steel().density;
    let stiffness = 4.0 / 3.0 * 0.5 * steel().plane_strain_modulus() * scene.sphere_radius.sqrt();
    let residual = sphere_residual(scene.sphere_radius, &steel(), patch, mesh).unwrap();
    let impact = Impact {
        plate: continuum.modal_body(modes),
        mass: [mass; 2],
        stiffness: [stiffness; 2],
        sphere_residual: [residual; 2],
        speed: scene.speed,
    };
    let result = impact.run(20e-9, scene.end);
    println!("{modes} modes, patch x{patch_factor}: {result:?}");
    result
}

fn assert_close(result: ImpactResult, expected: ImpactResult, efficiency: f64, force: f64, time: f64) {
    assert!((result.efficiency - expected.efficiency).abs() < efficiency, "{result:?} {expected:?}");
    for c in 0..2 {
        assert_relative_eq!(result.peak[c], expected.peak[c], max_relative = force);
        assert!((result.end[c] - expected.end[c]).abs() < time, "{result:?} {expected:?}");
    }
}

#[test]
fn both_scenes_of_table_1_agree_with_converged_finite_elements() {
    let mesh = MeshOptions::default();
    let fe = ImpactResult { efficiency: 0.6946, peak: [443.1, 352.1], end: [180.5e-6, 84.5e-6] };
    assert_close(run(&A, 16, 1.0, &mesh), fe, 0.001, 2.5e-3, 3e-3);
    let fe = ImpactResult { efficiency: 0.3868, peak: [142.9, 85.35], end: [62.4e-6, 52.2e-6] };
    assert_close(run(&B, 16, 1.0, &mesh), fe, 0.001, 2.5e-3, 3e-3);
}

#[test]
fn patch_radius_and_number_of_modes_hardly_matter() {
    let mesh = MeshOptions::default();
    for scene in [&A, &B] {
        let normal = run(scene, 16, 1.0, &mesh);
        // Bound on the forces. Four modes end below the contact's frequencies; a patch twice as wide
        // as the contact ever is sees less of the plate's local compliance.
        let cases = [(4, 1.0, 6e-3), (6, 1.0, 4e-3), (64, 1.0, 1e-3), (16, 0.5, 2e-3), (16, 2.0, 5e-3)];
        for (modes, patch_factor, force) in cases {
            let other = run(scene, modes, patch_factor, &mesh);
            assert_close(other, normal, 0.001, force, 3e-3);
        }
    }
}

#[test]
fn the_mesh_does_not_matter() {
    let fine = MeshOptions { order: 4, ..MeshOptions::default().refined(1.5) };
    for scene in [&A, &B] {
        let normal = run(scene, 16, 1.0, &MeshOptions::default());
        let refined = run(scene, 16, 1.0, &fine);
        assert_close(normal, refined, 1e-4, 5e-4, 5e-4);
    }
}
