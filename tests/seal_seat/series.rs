//! Seats near a first one on its mesh, which follows their dimensions.

use super::reduced::{mesh, scene};
use super::scaling::scaled;
use impactcheck::kinds::seal_seat::{SeatQuantities, SeatSeries};
use impactcheck::numerics::least_squares::fit;
use impactcheck::scene::{Scene, SealSeat, Setup};

fn series() -> SeatSeries {
    SeatSeries::new(&scene(), &mesh()).expect("a mesh of the scene")
}

fn changed(change: impl Fn(&mut SealSeat)) -> Scene {
    let mut scene = scene();
    let Setup::SealSeat(setup) = &mut scene.setup else { panic!("a seal seat") };
    change(setup);
    scene
}

fn launch(series: &SeatSeries, scene: &Scene) -> SeatQuantities {
    series.model(scene, Some(8)).expect("model").point(1e-4).expect("run").quantities
}

/// Every surface moves: a mesh that follows them exactly is the first one, scaled.
#[test]
fn a_seat_with_all_lengths_scaled_launches_as_the_first_one() {
    let series = series();
    let plain = launch(&series, &scene());
    for scale in [0.9_f64, 1.15] {
        let other = launch(&series, &changed(|setup| *setup = scaled(scale)));
        for (name, a, b) in [
            ("speed", other.sphere_speed, plain.sphere_speed),
            ("angle", other.sphere_angle, plain.sphere_angle),
            ("force on the sphere", other.sphere_force_peak, scale.powi(2) * plain.sphere_force_peak),
            ("force of the actuator", other.actuator_force_peak, scale.powi(2) * plain.actuator_force_peak),
            ("first frequency", other.first_frequency, plain.first_frequency / scale),
        ] {
            assert!((a / b - 1.0).abs() < 1e-3, "{name} of lengths times {scale}: {a} {b}");
        }
    }
}

/// New meshes scatter by 0.2 to 0.4 degrees. (Tips move from node to node beneath them: on this coarse mesh that leaves as much.)
#[test]
fn the_direction_is_smooth_in_the_dimensions() {
    let series = series();
    let changes: [(&str, fn(&mut SealSeat, f64)); 2] = [
        ("notch", |setup, s| setup.seat.notch.as_mut().expect("a notch").width *= 1.0 + 0.1 * s),
        ("aperture", |setup, s| setup.seat.aperture_angle += 0.05 * s),
    ];
    for (name, change) in changes {
        let row = |k: i32| {
            let s = f64::from(k) / 4.0;
            let angle = launch(&series, &changed(|setup| change(setup, s))).sphere_angle;
            ([1.0, s, s * s, s * s * s], angle.to_degrees())
        };
        let cubic = fit(&(-4..=4).map(row).collect::<Vec<_>>()).expect("nine directions");
        assert!(cubic.scatter < 0.02, "{name}: {cubic:?}");
        assert!(cubic.coefficients[1].abs() > 5.0 * cubic.scatter, "{name} turns the flight: {cubic:?}");
    }
}

#[test]
fn what_a_mesh_cant_follow_is_told() {
    let series = series();
    let told = |scene: &Scene| series.model(scene, Some(8)).expect_err("another shape").to_string();
    assert!(told(&changed(|setup| setup.seat.notch = None)).contains("notch or a tip"));
    let far = told(&changed(|setup| setup.seat.membrane_thickness *= 0.02));
    assert!(far.contains("can't follow the shape so far"), "{far}");
}
