//! Scaling of the reduced seal seat: its ledger balances at any speed, and it knows no length but the scene's.

use super::reduced::{fixture, mesh, scene};
use impactcheck::body::cache::Cache;
use impactcheck::body::solid::{Solid, TetMesh};
use impactcheck::kinds::seal_seat::SealSeat;
use impactcheck::kinds::seal_seat::integrate::{Options, integrate};
use impactcheck::kinds::seal_seat::integration::Integration;
use impactcheck::kinds::seal_seat::system::System;
use impactcheck::kinds::seal_seat::{SeatModel, SeatQuantities, Zones, candidates, supports};
use impactcheck::result::Summary;
use impactcheck::scene::{Model, Scene};

/// Of the energy at the start, at the default tolerance of 1e-3.
const RESIDUAL: f64 = 1e-4;

fn at(speed: f64) -> Summary {
    let text = std::fs::read_to_string(fixture("seal-seat.toml")).expect("scene");
    let scene = Scene::parse("seat.toml", &text.replace("\"1 m/s\"", &speed.to_string())).expect("scene");
    assert_eq!(scene.seal_seat().expect("seat").actuator.speed, speed);
    let model = SeatModel::new(&scene, Model::C, Some(8), &mesh(), &Cache::off()).expect("model");
    model.run(1e-3).expect("run")
}

#[test]
fn no_speed_makes_or_loses_energy() {
    for speed in [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0] {
        let summary = at(speed);
        let [energy, momentum] = [summary.energy_residual, summary.momentum_residual].map(Option::unwrap);
        assert!(energy <= RESIDUAL && momentum < 1e-12, "{speed} m/s: {energy} {momentum}");
    }
}

/// So slow that only the nodes that touch from the start are loaded: unilateral contact of a linear body, whose forces grow as
/// the speed.
#[test]
fn slow_impacts_are_proportional_to_their_speed() {
    let [slow, fast] =
        [1e-6, 1e-4].map(|speed| SeatQuantities::of_table(&at(speed).quantities).expect("determined"));
    for (name, a, b) in [
        ("efficiency", slow.efficiency, fast.efficiency),
        ("angle", slow.sphere_angle, fast.sphere_angle),
        ("force on the sphere", slow.sphere_force_peak, fast.sphere_force_peak / 100.0),
        ("force of the actuator", slow.actuator_force_peak, fast.actuator_force_peak / 100.0),
        ("end of contact", slow.sphere_contact_end, fast.sphere_contact_end),
    ] {
        assert!((a / b - 1.0).abs() < 2e-4, "{name}: {a} {b}");
    }
}

/// The scene with all lengths times `scale`, its materials and its speed as they are.
pub fn scaled(scale: f64) -> SealSeat {
    let mut setup = scene().seal_seat().expect("seat").clone();
    let seat = &mut setup.seat;
    let notch = seat.notch.as_mut().expect("notch");
    for length in [
        &mut seat.membrane_radius,
        &mut seat.membrane_thickness,
        &mut seat.island_length,
        &mut seat.island_width,
        &mut seat.island_height,
        &mut seat.seat_distance,
        &mut seat.seated_height,
        &mut seat.bore_radius,
        &mut seat.bore_depth,
        &mut notch.width,
        &mut notch.floor,
        &mut setup.sphere.radius,
        &mut setup.actuator.tip_radius,
    ] {
        *length *= scale;
    }
    setup.actuator.tip_positions.iter_mut().for_each(|x| *x *= scale);
    setup.actuator.mass *= scale.powi(3);
    setup.sphere.mass *= scale.powi(3);
    setup
}

fn run(scale: f64) -> Integration {
    let setup = scaled(scale);
    let small = TetMesh::read(mesh().path()).expect("mesh");
    let points = small.points.iter().map(|p| scale * p).collect();
    let mesh = TetMesh::new(points, small.cells.clone(), small.order).expect("mesh");
    let zones = Zones::expected(&setup);
    let candidates = candidates(&setup, &mesh, &zones);
    let interface: Vec<usize> = candidates.iter().map(|c| c.node).collect();
    let solid = Solid::new(&mesh, &setup.seat.material, &supports(&setup, &mesh), &interface).expect("solid");
    let body = solid.at_interface(8).expect("modes");
    let system = System::new(&setup, &body, &candidates, 8).expect("system");
    integrate(&system, &Options { step: scale * 1e-6, end_time: None, history: false, tolerance: 1e-3 })
        .expect("run")
}

#[test]
fn lengths_times_s_give_forces_times_s_squared_and_times_times_s() {
    // of both flanks: rounding decides to which a node between them belongs
    let impulse = |run: &Integration| run.tally.flank_impulse.iter().sum::<f64>();
    let plain = run(1.0);
    for scale in [1e-3, 1e3] {
        let other = run(scale);
        assert_eq!(other.tally.steps, plain.tally.steps);
        let pairs = [
            (other.state.sphere_velocity[0], plain.state.sphere_velocity[0]),
            (other.state.sphere_velocity[1], plain.state.sphere_velocity[1]),
            (other.state.actuator_velocity, plain.state.actuator_velocity),
            (other.tally.force_peak[0], scale.powi(2) * plain.tally.force_peak[0]),
            (other.tally.force_peak[1], scale.powi(2) * plain.tally.force_peak[1]),
            (other.tally.contact_end[0], scale * plain.tally.contact_end[0]),
            (impulse(&other), scale.powi(3) * impulse(&plain)),
        ];
        for (a, b) in pairs {
            assert!((a / b - 1.0).abs() < 1e-4, "lengths times {scale}: {a} {b}");
        }
    }
}
