//! A sphere on a plate so large that no wave returns during the contact, against Zener's equation
//! (Phys. Rev. 59, 1941, 669) for the infinite plate.

use crate::common;
use approx::assert_relative_eq;
use impactcheck::analytical::{circular_plate::rigidity, zener};
use impactcheck::body::kirchhoff;
use impactcheck::dynamics::integration::Options;
use impactcheck::dynamics::integrator::integrate;

/// Restitution and force peak of the reduced model and of Zener's equation, and Zener's lambda.
fn both(thickness: f64, radius: f64, modes: usize) -> ([f64; 2], [f64; 2], f64) {
    let mut setup = common::scaled_plate(0.01, 0.55);
    setup.plate.thickness = thickness;
    setup.plate.radius = radius;
    // the inner body is far away: one contact only
    setup.inner.gap = 1.0;
    let plate = kirchhoff::modes(&setup.plate, modes).unwrap();
    let system = setup.rigid_system(&plate, [0.0; 2]);
    let contact_time = 200e-6;
    let run = Options { end_time: Some(contact_time), ..Options::default() };
    let result = integrate(&system, &run).unwrap();

    let steel = common::steel();
    let bending = rigidity(steel.youngs_modulus, steel.poisson_ratio, thickness);
    let lambda = zener::inelasticity(
        system.masses[0],
        system.speed,
        system.laws[0].stiffness,
        steel.density * thickness,
        bending,
    );
    let expected = zener::solve(lambda, 20_000);
    let time = (system.masses[0] / (system.laws[0].stiffness * system.speed.sqrt())).powf(0.4);
    assert!(!result.contacts[0].closed, "the contact must end before the run does");
    (
        [result.velocity[0] / system.speed, result.contacts[0].force_peak],
        [expected.restitution, expected.force_peak * system.masses[0] * system.speed / time],
        lambda,
    )
}

#[test]
fn restitution_and_force_peak_before_the_waves_return() {
    for (thickness, radius, modes) in [(0.012, 0.5, 200), (0.008, 0.4, 200)] {
        let (ours, zener, lambda) = both(thickness, radius, modes);
        println!(
            "lambda {lambda:.4}: restitution {:.6} {:.6}, force {:.3} {:.3}",
            ours[0], zener[0], ours[1], zener[1]
        );
        assert!(lambda > 0.05 && lambda < 1.0, "a lambda at which the plate matters, not {lambda}");
        assert_relative_eq!(ours[0], zener[0], epsilon = 1e-3);
        assert_relative_eq!(ours[1], zener[1], max_relative = 1e-3);
    }
}
