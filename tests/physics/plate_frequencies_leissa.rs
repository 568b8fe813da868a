//! Kirchhoff plate elements against the closed form of Leissa, Vibration of Plates (1969), chapter 2.
//!
//! Unit plate: frequencies are k^2, the centre's deflection is that of the mass-normalised mode.

use approx::assert_relative_eq;
use impactcheck::analytical::circular_plate::{centre_deflection, frequency_parameters};
use impactcheck::body::kirchhoff::{self, UnitPlate, UnitPlates};
use impactcheck::scene::{Edge, Scene};

#[test]
fn frequencies_and_centre_deflections_of_every_edge() {
    for edge in [Edge::Clamped, Edge::SimplySupported, Edge::Free] {
        for (modes, bound) in [(1, 1e-9), (16, 1e-9), (64, 1e-6)] {
            let plate = UnitPlate::new(edge, 0.3, modes).unwrap();
            let rigid = plate.omega().len() - modes;
            assert_eq!(rigid, usize::from(edge == Edge::Free));
            for (mode, k) in frequency_parameters(edge, 0.3, modes).into_iter().enumerate() {
                assert_relative_eq!(plate.omega()[rigid + mode], k * k, max_relative = bound);
                assert_relative_eq!(
                    plate.centre()[rigid + mode],
                    centre_deflection(edge, k),
                    max_relative = 10.0 * bound
                );
            }
        }
    }
}

/// Near -1 the first frequency goes to zero: no root is passed over.
#[test]
fn no_mode_is_lost_at_any_poisson_ratio() {
    for edge in [Edge::Clamped, Edge::SimplySupported, Edge::Free] {
        for poisson_ratio in [-0.99999, -0.999, -0.99, -0.97, -0.9, -0.5, 0.0, 0.49, 0.4999999] {
            let modes = 24;
            let plate = UnitPlate::new(edge, poisson_ratio, modes).unwrap();
            let rigid = plate.omega().len() - modes;
            for (mode, k) in frequency_parameters(edge, poisson_ratio, modes).into_iter().enumerate() {
                assert_relative_eq!(plate.omega()[rigid + mode], k * k, max_relative = 1e-5);
                assert_relative_eq!(
                    plate.centre()[rigid + mode],
                    centre_deflection(edge, k),
                    max_relative = 1e-5
                );
            }
        }
    }
}

#[test]
fn rigid_mode_of_the_free_plate_carries_its_mass() {
    let plate = UnitPlate::new(Edge::Free, 0.3, 4).unwrap();
    assert_eq!(plate.omega()[0], 0.0);
    assert_relative_eq!(plate.centre()[0], (1.0 / std::f64::consts::PI).sqrt(), max_relative = 1e-10);
}

/// Plates of a series share modes where these are the same: of a clamped edge for every Poisson's ratio.
#[test]
fn plates_of_a_series_have_the_modes_of_their_own() {
    let text = include_str!("../../scenes/scaled-plate-r10.toml");
    for edge in ["clamped", "simply-supported", "free"] {
        let shared = UnitPlates::default();
        for poisson_ratio in [0.3, 0.05, 0.45] {
            let changed = text
                .replace("\"clamped\"", &format!("\"{edge}\""))
                .replace("poisson_ratio  = 0.3", &format!("poisson_ratio = {poisson_ratio}"));
            let scene = Scene::parse("scene.toml", &changed).unwrap();
            let plate = &scene.plate_impact().unwrap().plate;
            assert_eq!(plate.material.poisson_ratio, poisson_ratio);
            let (ours, own) = (shared.modes(plate, 16).unwrap(), kirchhoff::modes(plate, 16).unwrap());
            for k in 0..own.omega.len() {
                assert_relative_eq!(ours.omega[k], own.omega[k], max_relative = 1e-8);
                assert_relative_eq!(ours.participation[k][0], own.participation[k][0], max_relative = 1e-7);
            }
        }
    }
}
