//! The collocation integrator against classical Runge-Kutta with tiny steps, against conservation of momentum and
//! energy, and against itself at other tolerances.

use crate::common::scaled_plate;
use crate::runge_kutta;
use approx::assert_relative_eq;
use impactcheck::body::kirchhoff;
use impactcheck::dynamics::integration::{Integration, Options};
use impactcheck::dynamics::integrator::integrate;
use impactcheck::dynamics::system::System;
use impactcheck::kinds::plate_impact::PlateImpact;
use impactcheck::scene::{Edge, Shape};

fn system(setup: &PlateImpact, modes: usize) -> System {
    setup.rigid_system(&kirchhoff::modes(&setup.plate, modes).unwrap(), [0.0; 2])
}

fn run(system: &System, tolerance: f64) -> Integration {
    integrate(system, &Options { tolerance, ..Options::default() }).unwrap()
}

fn efficiency(system: &System, result: &Integration) -> f64 {
    system.masses[1] * result.velocity[1].powi(2) / (system.masses[0] * system.speed.powi(2))
}

/// Impacts that differ in what they exercise.
fn cases() -> Vec<(&'static str, PlateImpact)> {
    let mut damped = scaled_plate(0.01, 0.55);
    damped.plate.damping_ratio = 0.05;
    let mut overdamped = scaled_plate(0.00635, 0.437);
    overdamped.plate.damping_ratio = 1.7;
    let mut free = scaled_plate(0.01, 0.55);
    free.plate.edge = Edge::Free;
    free.inner.gap = 5e-6;
    let mut supported = scaled_plate(0.008, 2.0);
    supported.plate.edge = Edge::SimplySupported;
    supported.inner.shape = Shape::Compact { mass: 0.002, tip_radius: 0.02 };
    vec![
        ("Table 1, 10 mm", scaled_plate(0.01, 0.55)),
        ("Table 1, 6.35 mm", scaled_plate(0.00635, 0.437)),
        ("damped", damped),
        ("overdamped", overdamped),
        ("free, with a gap", free),
        ("simply supported, light inner body", supported),
    ]
}

#[test]
fn same_velocities_as_runge_kutta() {
    for (name, setup) in cases() {
        let system = system(&setup, 6);
        let h = 5e-9;
        let steps = 80_000;
        let end_time = Some(h * steps as f64);
        let ours = integrate(&system, &Options { tolerance: 1e-9, end_time, ..Options::default() }).unwrap();
        let theirs = runge_kutta::final_velocities(&system, None, h, steps);
        for body in 0..2 {
            println!("{name}: {:.10} {:.10}", ours.velocity[body], theirs[body]);
            assert_relative_eq!(ours.velocity[body], theirs[body], epsilon = 2e-7 * system.speed);
        }
    }
}

#[test]
fn momentum_and_energy_are_conserved() {
    for (name, setup) in cases() {
        let result = run(&system(&setup, 16), 1e-7);
        println!("{name}: momentum {:.1e}, energy {:.1e}", result.momentum_residual, result.energy_residual);
        assert!(result.momentum_residual < 1e-12, "{name}: {:e}", result.momentum_residual);
        assert!(result.energy_residual < 2e-6, "{name}: {:e}", result.energy_residual);
    }
}

#[test]
fn error_of_the_efficiency_follows_the_tolerance() {
    for (name, setup) in cases() {
        for modes in [1, 16, 64] {
            let system = system(&setup, modes);
            let exact = efficiency(&system, &run(&system, 1e-12));
            for tolerance in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8] {
                let error = (efficiency(&system, &run(&system, tolerance)) / exact - 1.0).abs();
                println!("{name}, {modes} modes: tolerance {tolerance:.0e}, error {error:.1e}");
                assert!(error < 3.0 * tolerance, "{name}, {modes} modes: {error:e} at {tolerance:e}");
            }
        }
    }
}

#[test]
fn nothing_happens_after_the_end() {
    for (name, setup) in cases() {
        let system = system(&setup, 16);
        let natural = run(&system, 1e-8);
        let longer =
            integrate(&system, &Options { tolerance: 1e-8, end_time: Some(0.02), ..Options::default() })
                .unwrap();
        for contact in 0..2 {
            assert_eq!(natural.contacts[contact].contacts, longer.contacts[contact].contacts, "{name}");
            assert_relative_eq!(
                natural.contacts[contact].end,
                longer.contacts[contact].end,
                max_relative = 1e-12
            );
        }
        assert_relative_eq!(natural.velocity[1], longer.velocity[1], max_relative = 1e-9);
    }
}

#[test]
fn a_recorded_history_agrees_with_the_account() {
    for (name, setup) in cases() {
        let system = system(&setup, 16);
        let options = Options { sample_interval: Some(2e-8), ..Options::default() };
        let result = integrate(&system, &options).unwrap();
        let history = result.history.as_ref().unwrap();
        assert!(history.time.windows(2).all(|t| t[0] < t[1]), "{name}: time increases");
        for (force, contact) in ["outer_force", "inner_force"].into_iter().zip(&result.contacts) {
            let force = &history[force];
            // trapezoidal rule over the samples
            let impulse: f64 = (1..history.len())
                .map(|i| 0.5 * (force[i] + force[i - 1]) * (history.time[i] - history.time[i - 1]))
                .sum();
            assert_relative_eq!(impulse, contact.impulse, max_relative = 1e-4, epsilon = 1e-12);
            let peak = force.iter().copied().fold(0.0, f64::max);
            assert_relative_eq!(peak, contact.force_peak, max_relative = 1e-4);
        }
        // velocity is the derivative of displacement
        for body in ["outer", "plate", "inner"] {
            let of = |what: &str| &history[&*format!("{body}_{what}")];
            let (velocity, displacement) = (of("velocity"), of("displacement"));
            let way: f64 = (1..history.len())
                .map(|i| 0.5 * (velocity[i] + velocity[i - 1]) * (history.time[i] - history.time[i - 1]))
                .sum();
            let last = displacement.last().unwrap();
            assert_relative_eq!(way, last, epsilon = 1e-9, max_relative = 1e-4);
        }
    }
}
