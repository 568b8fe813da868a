//! Closed forms of plates and spheres against finite elements: what truncation errors are estimated with.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use impactcheck::body::continuum::{ContinuumPlate, MeshOptions, WEIGHTED, sphere_residual};
use impactcheck::body::layer::Waves;
use impactcheck::body::{bending, free_sphere, kirchhoff};
use impactcheck::contact::{PatchTable, TABULATED};
use impactcheck::scene::{Edge, Material, Plate};

const EDGES: [Edge; 3] = [Edge::Clamped, Edge::SimplySupported, Edge::Free];

fn material(poisson_ratio: f64) -> Material {
    Material::elastic("m", 210e9, poisson_ratio, 7780.0)
}

fn plate(edge: Edge, thickness_over_radius: f64) -> Plate {
    let radius = 33e-3;
    Plate {
        radius,
        thickness: thickness_over_radius * radius,
        edge,
        material: material(0.3),
        damping_ratio: 0.0,
    }
}

/// What a sphere yields beyond its half-space, in 1/(E r): of the size of 0.4.
#[test]
fn free_sphere_of_lure_is_that_of_finite_elements() {
    let radius = 10e-3;
    for poisson in [-0.8, -0.35, 0.0, 0.2, 0.3, 0.45] {
        let m = material(poisson);
        // from 0.3 on the sphere is far from flat under the patch
        for (patch, wide) in [(0.01, 0.0), (0.03, 0.0), (0.1, 0.0), (0.3, 0.004), (0.4, 0.004)] {
            let unit = 1.0 / (m.youngs_modulus * radius);
            let fe = sphere_residual(radius, &m, patch * radius, &MeshOptions::default()).unwrap() / unit;
            let closed = free_sphere::sphere_residual(radius, &m, patch * radius) / unit;
            // finite elements are off by 3e-4 of the whole flexibility, that of the half-space
            assert_abs_diff_eq!(closed, fe, epsilon = 0.006 + (3e-4 + wide) * 0.6 / patch);
        }
    }
}

#[test]
fn waves_in_closed_form_are_kirchhoffs_finite_elements() {
    for edge in EDGES {
        let plate = plate(edge, 0.05);
        let waves = Waves::new(&plate, 12);
        let (closed, elements) = (waves.kirchhoff(12), kirchhoff::modes(&plate, 12).unwrap());
        let radii = [0.0, 3e-3, 20e-3, 33e-3];
        let (w, v) =
            (waves.shapes(12, &radii), kirchhoff::UnitPlates::default().shapes(&plate, 12, &radii).unwrap());
        for k in 0..closed.omega.len() {
            assert_relative_eq!(closed.omega[k], elements.omega[k], max_relative = 1e-8);
            assert_relative_eq!(
                closed.participation[k][0],
                elements.participation[k][0],
                max_relative = 1e-6
            );
            for (w, v) in w[k].iter().zip(&v[k]) {
                assert_abs_diff_eq!(*w, *v, epsilon = 1e-6 * closed.participation[k][0]);
            }
        }
    }
}

/// Below the frequency at which the thickness shears: frequencies and centres of the bending modes, of thin and of thicker plates, of
/// rubber and of what grows wider when it is stretched.
#[test]
fn bending_modes_in_closed_form_are_those_of_the_continuum() {
    for (edge, ratio, poisson) in [
        (Edge::Clamped, 0.06, 0.3),
        (Edge::Clamped, 0.12, 0.45),
        (Edge::Clamped, 0.1, -0.7),
        (Edge::SimplySupported, 0.1, 0.3),
        (Edge::SimplySupported, 0.03, -0.4),
        (Edge::Free, 0.06, 0.3),
        (Edge::Free, 0.12, -0.6),
    ] {
        let plate = Plate { material: material(poisson), ..plate(edge, ratio) };
        let patch = [0.1 * plate.thickness; 2];
        let fe = ContinuumPlate::new(&plate, patch, 8, &MeshOptions::default().refined(1.5)).unwrap();
        let elements = fe.omega.iter().zip(&fe.participation);
        let elements: Vec<_> = elements.filter(|(_, phi)| phi[0][0] * phi[1][0] > 0.0).collect();
        let closed = bending::modes(&plate, elements.len());
        assert!(closed.len() >= 5, "{edge:?} {ratio}: {}", closed.len());
        for (mode, (omega, phi)) in closed.iter().zip(elements) {
            assert_relative_eq!(mode.omega, *omega, max_relative = 7e-4);
            assert_relative_eq!(mode.under(WEIGHTED[0] * patch[0]), phi[0][0].abs(), max_relative = 2e-3);
        }
    }
}

/// On a thin plate the layer is the continuum: flexibilities, growth with the patch.
#[test]
fn layer_of_a_thin_plate_is_the_continuum() {
    for edge in EDGES {
        let plate = plate(edge, 0.02);
        let patch = [0.2 * plate.thickness; 2];
        let layer = Waves::new(&plate, 16).layer(patch);
        let fe = ContinuumPlate::new(&plate, patch, 8, &MeshOptions::default().refined(1.5)).unwrap();
        let (ours, exact) = (layer.flexibility, fe.flexibility);
        for m in 0..TABULATED {
            assert_relative_eq!(ours.own[0][m], exact.own[0][m], max_relative = 5e-4);
            for n in 0..TABULATED {
                assert_relative_eq!(ours.mutual[m][n], exact.mutual[m][n], max_relative = 5e-4);
            }
            // what bending does not tell: the faces against each other, of the size of Hertz's own flexibility
            let squeezed = |c: &PatchTable| c.own[0][m] + c.own[1][m] - 2.0 * c.mutual[m][m];
            assert_relative_eq!(squeezed(&ours), squeezed(&exact), max_relative = 0.02);
            // and how it changes with the patch
            let growth = |c: &PatchTable| c.own[0][m] - c.own[0][TABULATED - 1];
            let scale = 0.06 * growth(&exact).abs().max(growth(&PatchTable::default()));
            assert!((growth(&ours) - growth(&exact)).abs() <= scale, "{m}");
        }
    }
}
