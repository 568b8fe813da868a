//! Steps of one length against Hertz's closed form, conservation, and steps of adapted length.

use crate::common::scaled_plate;
use impactcheck::analytical::hertz::HertzImpact;
use impactcheck::body::{ModalBody, kirchhoff};
use impactcheck::dynamics::even_steps;
use impactcheck::dynamics::integration::{Integration, Options};
use impactcheck::dynamics::integrator::integrate;
use impactcheck::dynamics::system::System;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::scene::{Model, Scene};

/// In so many steps per contact of the outer body on a rigid wall.
fn in_steps(system: &System, steps: f64) -> Integration {
    even_steps::integrate(system, &Options::default(), system.hertz_impact().duration() / steps).unwrap()
}

/// Largest error of velocities, over the speed, force peaks and times of release, relative.
fn error(found: &Integration, exact: &Integration, speed: f64) -> f64 {
    let relative = |a: f64, b: f64| (a / b - 1.0).abs();
    (0..2).fold(0.0, |largest: f64, i| {
        let [found_contact, exact_contact] = [found, exact].map(|result| &result.contacts[i]);
        assert_eq!(found_contact.contacts, exact_contact.contacts);
        largest
            .max((found.velocity[i] - exact.velocity[i]).abs() / speed)
            .max(relative(found_contact.force_peak, exact_contact.force_peak))
            .max(relative(found_contact.end, exact_contact.end))
    })
}

/// The order is 2.5 or more: half the step, at most a fifth of the error.
#[test]
fn a_rebound_from_a_rigid_wall_converges_to_hertzs() {
    let wall = ModalBody { omega: vec![], damping_ratio: vec![], participation: vec![], residual: None };
    let system = scaled_plate(0.01, 0.55).rigid_system(&wall, [0.0; 2]);
    let closed =
        HertzImpact { mass: system.masses[0], speed: system.speed, stiffness: system.laws[0].stiffness };
    let errors = [20.3, 40.3, 80.3, 160.3].map(|steps| {
        let result = in_steps(&system, steps);
        let contact = result.contacts[0];
        assert_eq!(contact.contacts, 1);
        assert!(result.momentum_residual < 1e-12, "{}", result.momentum_residual);
        let relative = |a: f64, b: f64| (a / b - 1.0).abs();
        relative(contact.force_peak, closed.force_peak())
            .max(relative(contact.end, closed.duration()))
            .max(relative(result.velocity[0], system.speed))
    });
    assert!(errors[0] < 2e-3 && errors[3] < 1e-5, "{errors:?}");
    assert!(errors.windows(2).all(|pair| pair[1] < 0.2 * pair[0]), "{errors:?}");
}

/// Models A, B and C: with and without a residual flexibility, damped, with a gap, free, with quick modes.
#[test]
fn they_agree_with_steps_of_adapted_length() {
    for (name, model) in [
        ("scaled-plate-r10", Model::A),
        ("scaled-plate-r10", Model::B),
        ("scaled-plate-r10", Model::C),
        ("validation/damped-plate", Model::B),
        ("validation/inner-gap", Model::C),
        ("validation/free-plate", Model::B),
        ("validation/thin-plate", Model::B),
    ] {
        let scene = Scene::read(format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap();
        let reduced = Reduced::new(&scene, model, (model != Model::A).then_some(16)).unwrap();
        let system = reduced.system();
        let exact = integrate(system, &Options { tolerance: 1e-10, ..Options::default() }).unwrap();
        let [coarse, fine] = [64.0, 256.0].map(|steps| {
            let found = in_steps(system, steps);
            assert!(found.momentum_residual < 1e-12, "{name}: {}", found.momentum_residual);
            assert!(found.energy_residual < 64.0 / (steps * steps), "{name}: {}", found.energy_residual);
            error(&found, &exact, system.speed)
        });
        assert!(coarse < 2e-3 && fine < 0.1 * coarse.max(1e-4), "{name} {model}: {coarse:e}, {fine:e}");
    }
}

/// Most of 64 modes turn far in a step: they follow as under static forces, and nothing grows.
#[test]
fn modes_quicker_than_the_steps_do_not_resonate() {
    let setup = scaled_plate(0.01, 0.55);
    let system = setup.rigid_system(&kirchhoff::modes(&setup.plate, 64).unwrap(), [0.0; 2]);
    let exact = integrate(&system, &Options { tolerance: 1e-10, ..Options::default() }).unwrap();
    for steps in [40.0, 47.0, 55.0, 63.0, 70.0] {
        let found = in_steps(&system, steps);
        let h = system.hertz_impact().duration() / steps;
        assert!(even_steps::moving(&system, h) < 20);
        assert!(error(&found, &exact, system.speed) < 3e-3, "{steps}");
    }
}
