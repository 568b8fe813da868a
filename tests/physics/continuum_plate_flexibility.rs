//! Static flexibility of the continuum plate at its contact points.
//!
//! Checks: Kirchhoff's closed forms for thin plates (Timoshenko & Woinowsky-Krieger, Theory of Plates and
//! Shells, section 19; free plate: point load balanced by its uniform inertia), Hertz's half-space, the sum over modes.

use crate::continuum_support::{material, plate_of, steel};
use approx::assert_relative_eq;
use impactcheck::body::continuum::{ContinuumPlate, MeshOptions, half_space_flexibility, plate};
use impactcheck::scene::Edge;
use std::f64::consts::PI;

const EDGES: [Edge; 3] = [Edge::Clamped, Edge::SimplySupported, Edge::Free];

#[test]
fn centre_deflection_of_thin_plates_under_a_small_patch_tends_to_the_closed_form() {
    for edge in EDGES {
        let error = |thickness: f64| {
            let steel = steel();
            let nu = steel.poisson_ratio;
            let rigidity = steel.plane_strain_modulus() * thickness.powi(3) / 12.0;
            let factor = match edge {
                Edge::Clamped => 1.0 / 16.0,
                Edge::SimplySupported => (3.0 + nu) / (1.0 + nu) / 16.0,
                Edge::Free => 1.0 / 48.0 + (3.0 + nu) / (1.0 + nu) / 64.0,
            };
            let plate = plate_of(1.0, thickness, edge, steel);
            let body = ContinuumPlate::new(&plate, [0.5 * thickness; 2], 0, &MeshOptions::default());
            // Between the faces: no indentation in it.
            body.unwrap().flexibility[0][1] / (factor / (PI * rigidity)) - 1.0
        };
        let (coarse, fine) = (error(0.04), error(0.02));
        println!("{edge:?}: t/R 0.04 {coarse:e}, 0.02 {fine:e}");
        // Shear adds about (t/R)^2 ln(R/t), the rim's own compliance about t/R.
        assert!(fine.abs() < 0.012 && fine.abs() < 0.65 * coarse.abs(), "{edge:?} {coarse} {fine}");
    }
}

#[test]
fn a_patch_on_a_large_body_tends_to_the_half_space() {
    // Beyond the half-space remains a constant of the body, while the half-space's part grows as 1/a.
    let steel = steel();
    let body = plate_of(1.0, 2.0, Edge::Clamped, steel.clone());
    let relative = |patch: f64| {
        let plate = ContinuumPlate::new(&body, [patch; 2], 0, &MeshOptions::default()).unwrap();
        plate.flexibility[0][0] / half_space_flexibility(&steel, patch, patch)
    };
    let values = [0.08, 0.04, 0.02, 0.01].map(relative);
    println!("{values:?}");
    for pair in values.windows(2) {
        assert_relative_eq!(pair[1] / pair[0], 0.5, max_relative = 0.05);
    }
    assert!(values[3].abs() < 0.01);
}

/// What a patch gives at its own radius and says of its growth is what smaller patches give.
#[test]
fn the_growth_with_the_patch_is_the_difference_between_plates_made_for_other_patches() {
    let fine = MeshOptions { order: 5, ..MeshOptions::default().refined(1.5) };
    let body = plate_of(10e-3, 1e-3, Edge::Clamped, steel());
    let of = |outer: f64, inner: f64| ContinuumPlate::new(&body, [outer, inner], 0, &fine).unwrap();
    let large = of(0.2e-3, 0.16e-3);
    for (outer, inner) in [(0.1e-3, 0.16e-3), (0.2e-3, 0.08e-3), (0.14e-3, 0.12e-3)] {
        let other = of(outer, inner);
        let step = [outer * outer - 0.2e-3_f64.powi(2), inner * inner - 0.16e-3_f64.powi(2)];
        let scale = half_space_flexibility(&steel(), 0.2e-3, 0.2e-3);
        for i in 0..2 {
            for j in 0..2 {
                let predicted = large.patch_growth[i][j] * step[i] + large.patch_growth[j][i] * step[j];
                let found = other.flexibility[i][j] - large.flexibility[i][j];
                assert!((predicted - found).abs() < 1e-4 * scale, "{i}{j} {predicted:e} {found:e}");
                let largest = step[i].abs().max(step[j].abs());
                assert!(largest == 0.0 || found.abs() > 0.004 * scale, "{i}{j} {found:e}");
            }
        }
    }
}

#[test]
fn modes_and_residual_together_are_the_static_flexibility_whatever_the_number_of_modes() {
    for edge in EDGES {
        let body = plate_of(33e-3, 2e-3, edge, steel());
        let continuum = ContinuumPlate::new(&body, [0.3e-3, 0.5e-3], 40, &MeshOptions::default()).unwrap();
        let between = |modes| continuum.modal_body(modes).residual[0][1].abs();
        let (few, many) = (between(2), between(40));
        println!("{edge:?}: R01 {few:e} with 2 modes, {many:e} with 40");
        // Through the thickness nothing is indented: waves shorter than the thickness do not matter.
        assert!(many < 0.05 * few, "{edge:?}: {few:e} {many:e}");
        for pair in continuum.omega.windows(2) {
            assert!(pair[0] < pair[1]);
        }
        assert_eq!(continuum.omega_next(40), continuum.omega[40]);
    }
}

#[test]
fn a_free_plate_moves_rigidly_with_its_mass_and_a_supported_one_does_not() {
    let body = plate_of(33e-3, 2e-3, Edge::Free, steel());
    let free = plate(&body, [0.3e-3; 2], 3, &MeshOptions::default()).unwrap();
    assert_eq!(free.omega.len(), 4);
    assert_eq!(free.omega[0], 0.0);
    for phi in free.participation[0] {
        assert_relative_eq!(phi * phi * body.mass(), 1.0, max_relative = 1e-14);
    }
    assert!(free.omega[1] > 0.0);
    let clamped = plate_of(33e-3, 2e-3, Edge::Clamped, steel());
    let clamped = plate(&clamped, [0.3e-3; 2], 3, &MeshOptions::default()).unwrap();
    assert!(clamped.omega.len() == 3 && clamped.omega[0] > 0.0);
}

#[test]
fn faces_are_interchangeable_with_their_patches() {
    let body = plate_of(33e-3, 4e-3, Edge::SimplySupported, steel());
    let options = MeshOptions::default();
    let one = plate(&body, [0.3e-3, 0.5e-3], 8, &options).unwrap();
    let other = plate(&body, [0.5e-3, 0.3e-3], 8, &options).unwrap();
    assert_relative_eq!(one.residual[0][0], other.residual[1][1], max_relative = 1e-9);
    assert_relative_eq!(one.residual[0][1], other.residual[0][1], max_relative = 1e-9);
    for (a, b) in one.participation.iter().zip(&other.participation) {
        assert_relative_eq!(a[0].abs(), b[1].abs(), max_relative = 1e-9);
    }
}

#[test]
fn stiffness_only_scales_a_soft_plate() {
    let soft = material(2.6e9, 0.3, 1320.0);
    let options = MeshOptions::default();
    let a = plate(&plate_of(8e-3, 2e-3, Edge::Clamped, soft.clone()), [0.2e-3; 2], 6, &options);
    let stiff = material(260e9, 0.3, 1320.0);
    let b = plate(&plate_of(8e-3, 2e-3, Edge::Clamped, stiff), [0.2e-3; 2], 6, &options);
    let (a, b) = (a.unwrap(), b.unwrap());
    assert_relative_eq!(a.omega[5] * 10.0, b.omega[5], max_relative = 1e-9);
    assert_relative_eq!(a.residual[0][0], 100.0 * b.residual[0][0], max_relative = 1e-6);
}

#[test]
fn membranes_are_right_down_to_a_five_hundredth_and_refused_when_rounding_spoils_them() {
    let options = MeshOptions::default();
    for nu in [0.3, 0.49] {
        let rubber = material(1e6, nu, 1000.0);
        let deflection = |thickness: f64| {
            let body = plate_of(1.0, thickness, Edge::Clamped, rubber.clone());
            let body = ContinuumPlate::new(&body, [0.01; 2], 4, &options)?;
            let rigidity = rubber.plane_strain_modulus() * thickness.powi(3) / 12.0;
            Ok::<f64, impactcheck::Error>(body.flexibility[0][1] * 16.0 * PI * rigidity)
        };
        assert_relative_eq!(deflection(0.003).unwrap(), 1.0, max_relative = 2e-3);
        assert_relative_eq!(deflection(0.002).unwrap(), 1.0, max_relative = 5e-3);
        let error = deflection(0.0003).unwrap_err().to_string();
        assert!(error.contains("too thin"), "{error}");
    }
}

#[test]
fn impossible_requests_are_refused_with_the_value() {
    let body = plate_of(33e-3, 2e-3, Edge::Clamped, steel());
    let options = MeshOptions::default();
    for bad in [0.0, -1e-3, f64::NAN, 33e-3] {
        let error = plate(&body, [0.3e-3, bad], 4, &options).unwrap_err().to_string();
        assert!(error.contains(&format!("{bad:e} m")), "{error}");
    }
    let bad = MeshOptions { growth: 1.0, ..options };
    let error = plate(&body, [0.3e-3; 2], 4, &bad).unwrap_err().to_string();
    assert!(error.contains("growth"), "{error}");
}
