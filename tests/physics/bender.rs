//! The piezo bender (section 4.3 of the paper): beam elements against closed forms, release and strike, impact.

use crate::common::scaled_plate;
use approx::assert_relative_eq;
use impactcheck::actuator::beam::{Beam, Release};
use impactcheck::actuator::cantilever;
use impactcheck::body::kirchhoff;
use impactcheck::dynamics::MovingBody;
use impactcheck::dynamics::integration::{Integration, Options};
use impactcheck::dynamics::integrator::integrate;
use impactcheck::dynamics::system::System;
use impactcheck::kinds::plate_impact::PlateImpact;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::scene::{Bender, Model, Scene, Shape};
use std::f64::consts::TAU;

/// The bender of section 4.3 at a length of 13.7 mm.
fn measured() -> Bender {
    let (length, stiffness, tip_mass) = (13.7e-3, 2500.0, 128e-6);
    Bender {
        length,
        bending_stiffness: cantilever::bending_stiffness(length, stiffness),
        line_mass: cantilever::mass_from_frequency(500.0, stiffness, tip_mass).expect("a beam") / length,
        tip_mass,
        tip_radius: 4e-3,
        discharge_time: 0.0,
        strike_at: 0.0,
    }
}

/// Membrane of section 4.3 and sapphire sphere, struck by `bender` at 550 mm/s.
fn rocker(bender: Bender) -> PlateImpact {
    let mut setup = scaled_plate(2e-3, 0.55);
    let titanium = &mut setup.plate.material;
    (titanium.youngs_modulus, titanium.poisson_ratio, titanium.density) = (115e9, 0.37, 4430.0);
    (setup.plate.radius, setup.plate.thickness) = (3.1e-3, 0.1e-3);
    let sapphire = &mut setup.inner.material;
    (sapphire.youngs_modulus, sapphire.poisson_ratio, sapphire.density) = (350e9, 0.27, 3980.0);
    setup.outer.material = setup.inner.material.clone();
    setup.outer.shape = Shape::Bender(bender);
    setup
}

fn system(setup: &PlateImpact, modes: usize) -> System {
    let plate = kirchhoff::modes(&setup.plate, modes).unwrap();
    let bodies = MovingBody::both(&setup.outer, &setup.inner).unwrap();
    System::of(&bodies, &plate, &setup.plate.material, [0.0; 2])
}

fn run(setup: &PlateImpact) -> (System, Integration) {
    let system = system(setup, 16);
    let result = integrate(&system, &Options::default()).unwrap();
    (system, result)
}

#[test]
fn frequencies_are_those_of_the_closed_form() {
    for tip_mass in [1e-12, 128e-6, 20e-3] {
        let bender = Bender { tip_mass, ..measured() };
        let exact =
            cantilever::frequencies(bender.length, bender.bending_stiffness, bender.line_mass, tip_mass, 8);
        let beam = Beam::new(&bender, 16).unwrap();
        for (mode, exact) in exact.iter().enumerate() {
            println!(
                "tip {tip_mass:e} kg, mode {mode}: {:.1} Hz, exact {exact:.1} Hz",
                beam.omega[mode] / TAU
            );
            assert_relative_eq!(beam.omega[mode] / TAU, exact, max_relative = 2e-3);
        }
        // cubics: the error falls with the fourth power of the element's length
        let error = |modes| Beam::new(&bender, modes).unwrap().omega[2] / TAU / exact[2] - 1.0;
        let ratio = error(4) / error(8);
        assert!((14.0..18.0).contains(&ratio), "{ratio}");
    }
}

#[test]
fn modes_hold_the_static_deflection() {
    let bender = measured();
    let beam = Beam::new(&bender, 32).unwrap();
    let (length, stiffness) = (bender.length, bender.bending_stiffness);
    let tip_per_force: f64 = beam.tip.iter().zip(&beam.omega).map(|(phi, w)| (phi / w).powi(2)).sum();
    assert_relative_eq!(tip_per_force, length.powi(3) / (3.0 * stiffness), max_relative = 1e-6);
    let bent = beam.bent();
    let tip: f64 = beam.tip.iter().zip(&bent).map(|(phi, q)| phi * q).sum();
    assert_relative_eq!(tip, length.powi(2) / (2.0 * stiffness), max_relative = 1e-3);
    let energy: f64 = beam.omega.iter().zip(&bent).map(|(w, q)| 0.5 * (w * q).powi(2)).sum();
    assert_relative_eq!(energy, cantilever::moment_energy(length, stiffness, 1.0), max_relative = 0.02);
}

#[test]
fn beam_from_measurements_is_the_one_found_by_hand() {
    // by hand: 253 mg move with the tip, of which 0.236 of the beam; 0.175 mm of deflection for 550 mm/s; 4 N mm give
    // that at 13.7 mm
    let bender = measured();
    assert_relative_eq!(bender.line_mass * bender.length, 0.53e-3, max_relative = 0.02);
    let deflection = 0.55 / (TAU * 500.0);
    let moment = cantilever::moment_for_deflection(13.7e-3, bender.bending_stiffness, deflection);
    assert_relative_eq!(moment, 4e-3, max_relative = 5e-3);
    let energy = cantilever::moment_energy(13.7e-3, bender.bending_stiffness, 4e-3);
    assert_relative_eq!(energy, 0.051e-3, max_relative = 5e-3);
}

#[test]
fn strike_is_where_the_tip_passes_its_straight_position() {
    let release = Release::new(&measured()).unwrap();
    let beam = &release.beam;
    let at_tip = |values: &[f64]| beam.tip.iter().zip(values).map(|(phi, q)| phi * q).sum::<f64>();
    let bent = beam.bent();
    assert!(at_tip(&release.displacement).abs() < 1e-12 * at_tip(&bent));
    assert_relative_eq!(-at_tip(&release.velocity), release.speed_per_moment, max_relative = 1e-12);
    // a quarter of a period, but for the higher modes
    assert_relative_eq!(release.time, 0.5e-3, max_relative = 0.05);
    // released at once, no energy is lost
    let energy = |q: &[f64], v: Option<&[f64]>| -> f64 {
        let kinetic: f64 = v.map_or(0.0, |v| v.iter().map(|v| 0.5 * v * v).sum());
        kinetic + q.iter().zip(&beam.omega).map(|(q, w)| 0.5 * (w * q).powi(2)).sum::<f64>()
    };
    assert_relative_eq!(
        energy(&release.displacement, Some(&release.velocity)),
        energy(&bent, None),
        max_relative = 1e-12
    );
}

#[test]
fn discharge_follows_its_equation_of_motion() {
    let bender = Bender { discharge_time: 0.1e-3, ..measured() };
    let release = Release::with_modes(&bender, 4).unwrap();
    let beam = &release.beam;
    // q'' + omega^2 q = omega^2 q_0 e^(-t/tau), by Runge and Kutta
    for (mode, start) in beam.bent().into_iter().enumerate() {
        let square = beam.omega[mode].powi(2);
        let rate = |t: f64, [q, v]: [f64; 2]| [v, square * (start * (-t / 0.1e-3).exp() - q)];
        let (mut state, steps) = ([start, 0.0], 20_000);
        let h = release.time / f64::from(steps);
        let add = |a: [f64; 2], b: [f64; 2], c: f64| [a[0] + c * b[0], a[1] + c * b[1]];
        for step in 0..steps {
            let t = h * f64::from(step);
            let k1 = rate(t, state);
            let k2 = rate(t + 0.5 * h, add(state, k1, 0.5 * h));
            let k3 = rate(t + 0.5 * h, add(state, k2, 0.5 * h));
            let k4 = rate(t + h, add(state, k3, h));
            for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
                state = add(state, k, weight * h / 6.0);
            }
        }
        assert_relative_eq!(
            release.displacement[mode],
            state[0],
            max_relative = 1e-6,
            epsilon = 1e-9 * start.abs()
        );
        assert_relative_eq!(
            release.velocity[mode],
            state[1],
            max_relative = 1e-6,
            epsilon = 1e-9 * start.abs() * beam.omega[mode]
        );
    }
}

/// Of a beam that is one mode: it passes `share` of its deflection where the cosine does.
#[test]
fn offset_of_a_single_mode_is_the_closed_form() {
    for share in [-0.6, -0.1, 0.3, 0.8_f64] {
        let bender = Bender { strike_at: share, ..measured() };
        let release = Release::with_modes(&bender, 1).unwrap();
        let omega = release.beam.omega[0];
        let deflection = release.beam.tip[0] * release.beam.bent()[0];
        assert_relative_eq!(release.time, share.acos() / omega, max_relative = 1e-9);
        let speed = omega * deflection * (1.0 - share * share).sqrt();
        assert_relative_eq!(release.speed_per_moment, speed, max_relative = 1e-9);
        // and with a discharge: q'' + omega^2 q = omega^2 q_0 e^(-t/tau)
        let slow = Bender { strike_at: share, discharge_time: 0.05e-3, ..measured() };
        let release = Release::with_modes(&slow, 1).unwrap();
        let (x, phase) = (omega * 0.05e-3, omega * release.time);
        let rest = (-release.time / 0.05e-3).exp();
        let passed = (phase.cos() + x * phase.sin() + x * x * rest) / (1.0 + x * x);
        assert_relative_eq!(passed, share, max_relative = 1e-9);
    }
}

/// The tip begins where the plate stands, and displacements there are counted from zero.
#[test]
fn impact_off_the_straight_position_closes_its_balance() {
    for strike_at in [-0.5, 0.5] {
        let (system, result) = run(&rocker(Bender { strike_at, ..measured() }));
        let tip = system.of_bodies(&system.start[0])[0];
        assert_relative_eq!(tip + system.gap[0], 0.0, epsilon = 1e-15);
        assert!(tip.abs() > 1e-5 && tip.signum() == strike_at.signum());
        assert!(result.energy_residual < 1e-6 && result.velocity[1] < -0.3, "{result:?}");
    }
}

#[test]
fn a_light_soft_beam_leaves_its_tip_to_itself() {
    let bender = Bender { line_mass: 1e-6, bending_stiffness: 1e-7, ..measured() };
    let setup = rocker(bender);
    let mut compact = setup.clone();
    compact.outer.shape = Shape::Compact { mass: bender.tip_mass, tip_radius: bender.tip_radius };
    let ([with, alone], modes) = ([run(&setup), run(&compact)], 16);
    assert_eq!(with.0.size(), alone.0.size() + modes - 1);
    assert_relative_eq!(with.1.velocity[1], alone.1.velocity[1], max_relative = 1e-4);
    assert_relative_eq!(with.1.contacts[1].force_peak, alone.1.contacts[1].force_peak, max_relative = 1e-3);
}

#[test]
fn beam_takes_part_in_the_impact() {
    let setup = rocker(measured());
    let (system, result) = run(&setup);
    println!("energy {:.1e}, momentum {:.1e}", result.energy_residual, result.momentum_residual);
    assert!(result.energy_residual < 1e-6 && result.momentum_residual < 1e-12);
    // it pushes on: the inner sphere is faster than after the impact of the tip mass alone
    let mut compact = setup.clone();
    compact.outer.shape = Shape::Compact { mass: 128e-6, tip_radius: 4e-3 };
    assert!(result.velocity[1] < 1.02 * run(&compact).1.velocity[1]);
    // the run ends when the inner sphere is out of reach, long before the bender comes back
    assert!(result.contacts[0].end < 0.5e-3);
    // energy at the strike is that of the drive
    let drive = system.drive.expect("a bender");
    let [q, v] = &system.start;
    assert_relative_eq!(system.energy(q, v), drive.strain_energy, max_relative = 0.03);
    assert_relative_eq!(drive.kinetic_energy, system.initial_energy(), max_relative = 1e-12);
    assert_relative_eq!(result.velocity[1], -0.58, max_relative = 0.02);
}

/// Modes whose waves are no longer than the contact patches are wide add nothing, and take nothing away.
#[test]
fn more_modes_than_the_contact_patches_resolve_change_nothing() {
    let scene = Scene::read(std::path::Path::new("scenes/examples/rocker-bender.toml")).unwrap();
    let run = |modes| Reduced::new(&scene, Model::C, Some(modes)).unwrap().run(1e-6).unwrap();
    let few = run(16);
    for modes in [24, 32, 64] {
        let more = run(modes);
        for name in ["efficiency", "outer_force_peak", "inner_force_peak"] {
            assert_relative_eq!(more.value(name).unwrap(), few.value(name).unwrap(), max_relative = 2e-3);
        }
        assert!(
            more.momentum_residual.is_some_and(|r| r < 1e-10)
                && more.energy_residual.is_some_and(|r| r < 1e-5)
        );
    }
}

#[test]
fn torque_deflection_and_speed_are_three_ways_to_say_one_thing() {
    let scene = |drive: &str, beam: &str| {
        let text = std::fs::read_to_string("scenes/examples/rocker-bender.toml").unwrap();
        let outer = text.find("[outer]").unwrap();
        let inner = text.find("[inner]").unwrap();
        let body = format!(
            "[outer]\nkind = \"bender\"\nlength = \"13.7 mm\"\ntip_mass = \"128 mg\"\ntip_radius = \"4 mm\"\nmaterial = \"sapphire\"\n{beam}\n{drive}\n\n"
        );
        Scene::parse("scene.toml", &format!("{}{body}{}", &text[..outer], &text[inner..]))
    };
    let outer = |drive: &str, beam: &str| {
        let scene = scene(drive, beam).unwrap();
        let setup = scene.plate_impact().unwrap();
        setup.outer.clone()
    };
    let measured_beam = "first_frequency = \"500 Hz\"\ntip_stiffness = \"2500 N/m\"";
    let by_torque = outer("torque = \"4 N*mm\"", measured_beam);
    let Shape::Bender(bender) = by_torque.shape else { panic!("a bender") };
    assert_relative_eq!(bender.line_mass, measured().line_mass, max_relative = 1e-12);
    let section =
        format!("bending_stiffness = {:e}\nline_mass = {:e}", bender.bending_stiffness, bender.line_mass);
    let deflection = 4e-3 * bender.length.powi(2) / (2.0 * bender.bending_stiffness);
    let by_deflection = outer(&format!("tip_deflection = {deflection:e}"), &section);
    assert_relative_eq!(by_deflection.speed, by_torque.speed, max_relative = 1e-12);
    let drive = MovingBody::outer(&outer(&format!("speed = {:e}", by_torque.speed), &section)).unwrap().drive;
    assert_relative_eq!(drive.expect("a bender").torque, 4e-3, max_relative = 1e-12);
    for (drive, beam) in [
        ("", measured_beam),
        ("torque = \"4 N*mm\"\nspeed = 0.5", measured_beam),
        ("speed = 0.5", "first_frequency = 500"),
        ("speed = 0.5", ""),
        ("speed = 0.5", "first_frequency = 500\ntip_stiffness = 2500\nline_mass = 0.01"),
        // 128 mg at this stiffness swing at 351 Hz without any beam
        ("speed = 0.5", "first_frequency = 500\ntip_stiffness = 1000"),
    ] {
        assert!(scene(drive, beam).is_err(), "{drive}, {beam}");
    }
}

/// A run ends where the inner body is out of reach, unless its end is given: then the bender strikes as often as it swings back
/// until then, and never passes through the plate.
#[test]
fn a_bender_strikes_again_until_the_given_end() {
    let system = system(&rocker(measured()), 16);
    let short = integrate(&system, &Options::default()).unwrap();
    let options = Options { end_time: Some(2.5e-3), sample_interval: Some(1e-6), ..Options::default() };
    let long = integrate(&system, &options).unwrap();
    let [of_short, of_long] = [&short, &long].map(|run| run.contacts[0]);
    assert!(of_long.contacts > of_short.contacts && of_long.end > 1e-3, "{of_short:?} {of_long:?}");
    assert_eq!(short.contacts[1].contacts, long.contacts[1].contacts);
    assert_relative_eq!(short.velocity[1], long.velocity[1], max_relative = 1e-9);
    assert!(long.energy_residual < 1e-6, "{}", long.energy_residual);
    let force = long.history.as_ref().unwrap().curve("outer_force").unwrap();
    let peak = force.iter().copied().fold(0.0, f64::max);
    assert!(peak <= of_long.force_peak * (1.0 + 1e-6), "{peak} {}", of_long.force_peak);
}
