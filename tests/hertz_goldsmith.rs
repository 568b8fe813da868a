//! A sphere on a rigidly held half-space against Hertz's closed form (Goldsmith, Impact, 1960, chapter 4).

mod common;

use approx::assert_relative_eq;
use impactcheck::analytical::hertz::HertzImpact;
use impactcheck::body::ModalBody;
use impactcheck::impact::integrator::{Options, integrate};
use impactcheck::impact::system::System;

#[test]
fn sphere_rebounds_from_a_rigid_half_space() {
    let held = ModalBody {
        omega: vec![],
        damping_ratio: vec![],
        participation: vec![],
        residual: [[0.0; 2]; 2],
        patch_growth: [[0.0; 2]; 2],
    };
    for (radius, speed) in [(0.01, 0.55), (0.001, 1e-4), (0.05, 50.0)] {
        let system = System::new(&common::scaled_plate(radius, speed), &held, [0.0; 2]);
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
