//! Static flexibility of the continuum plate at its contact points.
//!
//! Checks: Kirchhoff's closed forms for thin plates (Timoshenko & Woinowsky-Krieger, Theory of Plates and
//! Shells, section 19; free plate: point load balanced by its uniform inertia), Hertz's half-space, the sum over modes.

use crate::continuum_support::{material, plate_of, steel};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use impactcheck::body::ModalBody;
use impactcheck::body::continuum::{ContinuumPlate, MeshOptions, half_space_flexibility, plate};
use impactcheck::contact::{PatchFlexibility, PatchTable, RADII, WHOLE};
use impactcheck::scene::{Edge, Material};
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
            body.unwrap().flexibility.mutual[WHOLE][WHOLE] / (factor / (PI * rigidity)) - 1.0
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
        plate.flexibility.own[0][WHOLE] / half_space_flexibility(&steel, patch)
    };
    let values = [0.08, 0.04, 0.02, 0.01].map(relative);
    println!("{values:?}");
    for pair in values.windows(2) {
        assert_relative_eq!(pair[1] / pair[0], 0.5, max_relative = 0.05);
    }
    assert!(values[3].abs() < 0.01);
}

/// Between its radii and below them the table of one plate says what plates made for other patches say, within 2 % of the
/// flexibility or of a half-space's, up to patches wider than the plate is thick.
#[test]
fn flexibilities_over_the_patches_are_those_of_plates_made_for_other_patches() {
    let fine = MeshOptions { order: 5, ..MeshOptions::default().refined(1.5) };
    let body = plate_of(10e-3, 1e-3, Edge::Clamped, steel());
    let of = |outer: f64, inner: f64| {
        let plate = ContinuumPlate::new(&body, [outer, inner], 0, &fine).unwrap();
        PatchFlexibility::through(&plate.flexibility, plate.patch_radius)
    };
    for large in [0.2e-3, 1.0e-3] {
        let table = of(large, 0.8 * large);
        for [outer, inner] in [[0.2, 0.2], [0.5, 0.8], [1.0, 0.3], [1.45, 1.1]].map(|a| a.map(|a| a * large))
        {
            let other = of(outer, inner).at([outer * outer, inner * inner]);
            let found = table.at([outer * outer, inner * inner]);
            for (i, (found, expected)) in found.into_iter().zip(other).enumerate() {
                let scale = half_space_flexibility(&steel(), large);
                assert!(
                    (found - expected).abs() < 0.02 * scale.max(expected.abs()),
                    "{large} {outer} {i} {found:e} {expected:e}"
                );
            }
        }
    }
}

/// The same change by change, of any edge and of what bends almost to a paraboloid, whose first mode's curvature is mostly its rim's.
#[test]
fn flexibilities_change_with_the_patch_as_from_plate_to_plate() {
    for (edge, poisson_ratio) in EDGES.into_iter().flat_map(|edge| [(edge, 0.3), (edge, -0.88)]) {
        let body = plate_of(33e-3, 2.4e-3, edge, Material { poisson_ratio, ..steel() });
        let of = |radius: f64| {
            let patch = radius * 0.6 * body.thickness;
            ContinuumPlate::new(&body, [patch; 2], 1, &MeshOptions::default()).unwrap().flexibility
        };
        let table = of(1.0);
        let at = |table: &PatchTable, m: usize| [table.own[0][m], table.mutual[m][m]];
        let [own, mutual] = at(&table, WHOLE);
        let unit = 1.0 / (body.material.plane_strain_modulus() * 0.6 * body.thickness);
        for (m, radius) in RADII.into_iter().enumerate() {
            let (found, other) = (at(&table, m), at(&of(radius), WHOLE));
            for ((found, other), whole) in found.into_iter().zip(other).zip([own, mutual]) {
                // two meshes differ by 3e-4 of the whole
                let bound = 0.01 * unit + 3e-4 * whole.abs();
                assert_abs_diff_eq!(found - whole, other - whole, epsilon = bound);
            }
        }
    }
}

#[test]
fn modes_and_residual_together_are_the_static_flexibility_whatever_the_number_of_modes() {
    for edge in EDGES {
        let body = plate_of(33e-3, 2e-3, edge, steel());
        let continuum = ContinuumPlate::new(&body, [0.3e-3, 0.5e-3], 40, &MeshOptions::default()).unwrap();
        let between = |modes| continuum.modal_body(modes, 0.0).residual.unwrap().at([0.0; 2])[1].abs();
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

/// In a film, whose pressure acts on modes alone.
#[test]
fn the_last_mode_in_a_film_has_the_flexibility_of_all_that_are_left_out() {
    let body = plate_of(33e-3, 2e-3, Edge::Clamped, steel());
    let patch = [0.3e-3, 0.5e-3];
    let continuum = ContinuumPlate::new(&body, patch, 12, &MeshOptions::default()).unwrap();
    for modes in [1, 3, 12] {
        // by modes, and by the residual
        let [plain, in_film] = [continuum.modal_body(modes, 0.0), continuum.modal_body_in_film(modes, 0.0)]
            .map(|plate| {
                assert_eq!(plate.omega.len(), modes);
                let modal = plate.participation.iter().zip(&plate.omega);
                let modal = modal.map(|([outer, inner], omega)| outer * inner / omega.powi(2)).sum::<f64>();
                [modal, plate.residual.unwrap().at(patch.map(|a| a * a))[1]]
            });
        let all = plain[0] + plain[1];
        assert_relative_eq!(in_film[0], all, max_relative = 1e-9);
        assert_abs_diff_eq!(in_film[1], 0.0, epsilon = 1e-9 * all);
        assert!(modes == 12 || plain[1] > 1e-3 * all, "{modes}: {plain:?}");
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
    let at = |body: &ModalBody, square| body.residual.unwrap().at(square);
    let (ours, theirs) = (at(&one, [4e-8, 1e-7]), at(&other, [1e-7, 4e-8]));
    for i in 0..3 {
        assert_relative_eq!(ours[i], theirs[2 - i], max_relative = 1e-8);
    }
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
    let own = |body: &ModalBody| body.residual.unwrap().at([4e-8; 2])[0];
    assert_relative_eq!(own(&a), 100.0 * own(&b), max_relative = 1e-6);
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
            Ok::<f64, impactcheck::Error>(body.flexibility.mutual[WHOLE][WHOLE] * 16.0 * PI * rigidity)
        };
        assert_relative_eq!(deflection(0.003).unwrap(), 1.0, max_relative = 2e-3);
        assert_relative_eq!(deflection(0.002).unwrap(), 1.0, max_relative = 5e-3);
        let error = deflection(0.0003).unwrap_err().to_string();
        assert!(error.contains("too thin"), "{error}");
    }
}

/// Small elements under a small patch move with their neighbours: their rounding spoils nothing. Meshes that differ a little
/// agree, where a mesh of such elements all over would not.
#[test]
fn small_patches_do_not_spoil_thin_plates() {
    for (thickness, patch, poisson_ratio) in [(0.0036, 0.03, 0.3), (0.01, 0.001, 0.3), (0.01, 0.03, 0.49)] {
        let body = plate_of(1.0, thickness, Edge::Clamped, material(23e9, poisson_ratio, 1500.0));
        let deflection = |scale: f64| {
            let patch = [scale * patch * thickness; 2];
            let plate = ContinuumPlate::new(&body, patch, 4, &MeshOptions::default()).unwrap();
            plate.flexibility.mutual[WHOLE][WHOLE]
        };
        assert_relative_eq!(deflection(1.0), deflection(1.003), max_relative = 2e-3);
        let kirchhoff = 1.0 / (16.0 * PI * body.material.plane_strain_modulus() * thickness.powi(3) / 12.0);
        assert_relative_eq!(deflection(1.0), kirchhoff, max_relative = 5e-3);
    }
}

#[test]
fn impossible_requests_are_refused_with_the_value() {
    let body = plate_of(33e-3, 2e-3, Edge::Clamped, steel());
    let options = MeshOptions::default();
    for bad in [0.0, -1e-3, f64::NAN, 16.5e-3] {
        let error = plate(&body, [0.3e-3, bad], 4, &options).unwrap_err().to_string();
        assert!(error.contains(&format!("{bad:e} m")), "{error}");
    }
    let bad = MeshOptions { growth: 1.0, ..options };
    let error = plate(&body, [0.3e-3; 2], 4, &bad).unwrap_err().to_string();
    assert!(error.contains("growth"), "{error}");
}
