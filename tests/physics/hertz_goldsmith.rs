//! A sphere on a rigidly held half-space against Hertz's closed form (Goldsmith, Impact, 1960, chapter 4).

use crate::common;
use approx::assert_relative_eq;
use impactcheck::analytical::hertz::HertzImpact;
use impactcheck::body::{ModalBody, kirchhoff};
use impactcheck::dynamics::integration::Options;
use impactcheck::dynamics::integrator::integrate;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::scene::{Model, Scene, resolve};
use std::f64::consts::PI;

#[test]
fn sphere_rebounds_from_a_rigid_half_space() {
    let rigid_plate =
        ModalBody { omega: vec![], damping_ratio: vec![], participation: vec![], residual: None };
    for (radius, speed) in [(0.01, 0.55), (0.001, 1e-4), (0.05, 50.0)] {
        let system = common::scaled_plate(radius, speed).rigid_system(&rigid_plate, [0.0; 2]);
        let result = integrate(&system, &Options { tolerance: 1e-9, ..Options::default() }).unwrap();
        let closed = HertzImpact { mass: system.masses[0], speed, stiffness: system.laws[0].stiffness };
        let contact = result.contacts[0];
        assert_eq!(contact.contacts, 1);
        assert_relative_eq!(contact.force_peak, closed.force_peak(), max_relative = 1e-6);
        assert_relative_eq!(contact.end, closed.duration(), max_relative = 1e-6);
        assert_relative_eq!(result.velocity[0], speed, max_relative = 1e-8);
        assert_relative_eq!(contact.impulse, 2.0 * closed.mass * speed, max_relative = 1e-8);
    }
}

/// Pressure and patch of a contact against Hertz's closed forms in force, radius and moduli (Johnson, Contact Mechanics,
/// 1985, eqs. 3.22 to 3.24), and against the definition: the mean pressure is two thirds of the largest.
#[test]
fn pressure_at_the_force_peak_is_hertzs() {
    let scene = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let summary = Reduced::new(&scene, Model::B, None).unwrap().run(1e-7).unwrap();
    let pressure = summary.contact_pressure.expect("a plate impact");
    // steel on steel, 210 GPa and 0.3 on both sides
    let modulus = 210e9 / (2.0 * (1.0 - 0.3_f64.powi(2)));
    let peaks = ["outer_force_peak", "inner_force_peak"].map(|name| summary.value(name).unwrap());
    for (patch, force) in [pressure.outer, pressure.inner].iter().zip(peaks) {
        let closed = (6.0 * force * modulus.powi(2) / (PI.powi(3) * 0.01_f64.powi(2))).cbrt();
        assert_relative_eq!(patch.maximum_pressure, closed, max_relative = 1e-9);
        assert_relative_eq!(
            patch.contact_radius,
            (0.75 * force * 0.01 / modulus).cbrt(),
            max_relative = 1e-9
        );
        let mean = force / (PI * patch.contact_radius.powi(2));
        assert_relative_eq!(patch.maximum_pressure, 1.5 * mean, max_relative = 1e-9);
    }
    let document = serde_json::to_value(&summary).unwrap();
    assert_eq!(document["contact_pressure"]["outer"]["maximum_pressure"], pressure.outer.maximum_pressure);
}

/// Two equal spheres that strike a plate from both sides at once push its faces alike: the plate bends to neither side and each
/// rebounds as from a rigid half-space. One that recedes as fast as it could be thrown is never reached.
#[test]
fn a_plate_struck_from_both_sides_is_a_rigid_wall() {
    let (radius, speed) = (0.01, 0.55);
    let mut setup = common::scaled_plate(radius, speed);
    let plate = kirchhoff::modes(&setup.plate, 16).unwrap();
    setup.inner.speed = speed;
    let system = setup.rigid_system(&plate, [0.0; 2]);
    let result = integrate(&system, &Options { tolerance: 1e-9, ..Options::default() }).unwrap();
    let closed = HertzImpact { mass: system.masses[0], speed, stiffness: system.laws[0].stiffness };
    for (contact, (velocity, rebound)) in
        result.contacts.iter().zip(result.velocity.into_iter().zip([speed, -speed]))
    {
        assert_relative_eq!(contact.force_peak, closed.force_peak(), max_relative = 1e-6);
        assert_relative_eq!(contact.end, closed.duration(), max_relative = 1e-6);
        assert_relative_eq!(velocity, rebound, max_relative = 1e-8);
    }
    assert!(result.energy_residual < 1e-9 && result.momentum_residual < 1e-9, "{result:?}");
    setup.inner.speed = -10.0 * speed;
    let receding = integrate(&setup.rigid_system(&plate, [0.0; 2]), &Options::default()).unwrap();
    assert_eq!((receding.contacts[1].contacts, receding.velocity[1]), (0, -10.0 * speed));
}
