//! Eigenfrequencies of the continuum plate.
//!
//! Goal: the axisymmetric modes of a circular plate from membrane to rod.
//! Checks: an independent finite-element program (steel plate of Table 1), Table 2 of the paper, Kirchhoff's
//! closed form for thin plates (Leissa, Vibration of Plates, NASA SP-160, tables 2.1, 2.3, 2.4), the mass,
//! the order of convergence.

use crate::continuum_support::{material, plate_of, steel, titanium};
use approx::assert_relative_eq;
use impactcheck::body::continuum::{ContinuumPlate, MeshOptions, eigenfrequencies};
use impactcheck::scene::Edge;
use std::f64::consts::TAU;

#[test]
fn clamped_steel_plate_of_table_1_has_the_frequencies_of_an_independent_fe_program() {
    let modes = eigenfrequencies(&plate_of(33e-3, 2e-3, Edge::Clamped, steel()), 6).unwrap();
    let expected = [4655.0, 17719.0, 38433.0, 65557.0, 97848.0, 100_757.0];
    for (k, (mode, expected)) in modes.iter().zip(expected).enumerate() {
        assert_relative_eq!(mode.frequency, expected, max_relative = 1e-3);
        assert_eq!(mode.longitudinal, k == 5, "{mode:?}");
    }
}

#[test]
fn fixed_titanium_plate_to_rod_follows_table_2_of_the_paper() {
    // Thickness mm; first, first longitudinal in kHz and its number. The paper rounds to whole kHz
    // (and has 136 at 0.5 mm); these digits are from an independent FE program.
    let table = [
        (0.1, 28.5, 1116.0, 7),
        (0.5, 133.5, 1117.0, 4),
        (3.0, 340.8, 868.9, 3),
        (6.0, 367.5, 592.5, 2),
        (12.0, 379.5, 443.7, 2),
        (24.0, 385.2, 399.3, 2),
    ];
    for (thickness, first, longitudinal, number) in table {
        let plate = plate_of(3e-3, thickness * 1e-3, Edge::Clamped, titanium());
        let modes = eigenfrequencies(&plate, 10).unwrap();
        let found = modes.iter().position(|m| m.longitudinal).unwrap();
        println!("{thickness} mm: {:.2} {:.2} #{}", modes[0].frequency, modes[found].frequency, found + 1);
        assert_eq!(found + 1, number, "t = {thickness} mm");
        // 0.1 %, or half of the last digit given.
        let half_digit = 0.05;
        assert!((modes[0].frequency / 1e3 - first).abs() < (1e-3 * first).max(half_digit));
        assert_relative_eq!(modes[found].frequency / 1e3, longitudinal, max_relative = 1e-3);
    }
}

#[test]
fn thin_plates_follow_kirchhoff_closed_form() {
    // The rim's boundary layer changes the frequency in proportion to t/R, shear and rotary inertia to (t/R)^2:
    // extrapolated from three thicknesses to 0.
    let cases = [
        (Edge::Clamped, 0, [10.2158, 39.7711, 89.1041]),
        (Edge::SimplySupported, 0, [4.9351, 29.7200, 74.1561]),
        (Edge::Free, 1, [9.0031, 38.4432, 87.7502]),
    ];
    for (edge, rigid, expected) in cases {
        let relative = |thickness: f64| -> Vec<f64> {
            let material = steel();
            let rigidity = material.plane_strain_modulus() * thickness.powi(3) / 12.0;
            let unit = (rigidity / (material.density * thickness)).sqrt() / TAU;
            let modes = eigenfrequencies(&plate_of(1.0, thickness, edge, material), 3 + rigid).unwrap();
            assert_eq!(modes.iter().filter(|m| m.frequency == 0.0).count(), rigid);
            modes[rigid..].iter().zip(expected).map(|(m, k2)| m.frequency / (k2 * unit)).collect()
        };
        let [thin, middle, thick] = [0.006, 0.012, 0.024].map(relative);
        for k in 0..3 {
            let limit = (8.0 * thin[k] - 6.0 * middle[k] + thick[k]) / 3.0;
            println!("{edge:?} {} {} {} -> {limit}", thin[k], middle[k], thick[k]);
            assert!(thick[k] < middle[k] && middle[k] < thin[k]);
            assert_relative_eq!(limit, 1.0, max_relative = 1e-4);
        }
    }
}

/// A simply supported plate of nu near -1 bends into a paraboloid for next to nothing: the corners of its rim, where the stress
/// is singular, then matter as much as bending does.
#[test]
fn the_default_mesh_resolves_the_rim_of_auxetic_plates() {
    for (poisson_ratio, thickness) in [(-0.96, 0.11), (-0.96, 1.0), (-0.9, 0.3), (-0.5, 0.11)] {
        let plate = plate_of(1.0, thickness, Edge::SimplySupported, material(23e9, poisson_ratio, 1500.0));
        let first =
            |options| ContinuumPlate::new(&plate, [0.2 * thickness; 2], 4, &options).unwrap().omega[0];
        let fine = MeshOptions { order: 4, ..MeshOptions::default().refined(2.0) };
        assert_relative_eq!(first(MeshOptions::default()), first(fine), max_relative = 2e-4);
    }
}

#[test]
fn frequencies_of_a_free_plate_converge_with_twice_the_order_of_the_elements() {
    // Free, so that nothing is singular; thick, with equal square elements of side 0.2 / refinement.
    let plate = plate_of(1.0, 0.4, Edge::Free, steel());
    let frequency = |order: usize, refinement: f64| {
        let options = MeshOptions {
            order,
            patch_elements: refinement,
            growth: 1.001,
            depth_growth: 1.001,
            nodes_per_wavelength: 2.0,
            thickness_elements: refinement,
        };
        ContinuumPlate::new(&plate, [0.2; 2], 3, &options).unwrap().omega[1]
    };
    let exact = frequency(6, 3.0);
    for (order, expected) in [(2, 4.0), (3, 6.0)] {
        let error = |refinement| (frequency(order, refinement) - exact) / exact;
        let (coarse, fine) = (error(1.0), error(2.0));
        let observed = (coarse / fine).log2();
        println!("order {order}: observed {observed} ({coarse:e}, {fine:e})");
        assert!(fine > 0.0, "frequencies come from above: {coarse:e} {fine:e}");
        assert!((observed - expected).abs() < 0.5, "order {order}: {observed}");
    }
}
