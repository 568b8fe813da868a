//! Seats near a first one on its mesh, which follows their dimensions.

use super::reduced::{fixture, impactcheck, mesh, scene};
use super::scaling::scaled;
use impactcheck::kinds::seal_seat::SealSeat;
use impactcheck::kinds::seal_seat::{SeatQuantities, SeatSeries};
use impactcheck::numerics::least_squares::fit;
use impactcheck::scene::{Model, Scene};

fn series() -> SeatSeries {
    SeatSeries::new(&scene(), &mesh()).expect("a mesh of the scene")
}

fn changed(change: impl Fn(&mut SealSeat)) -> Scene {
    let mut scene = scene();
    let mut setup = scene.seal_seat().unwrap().clone();
    change(&mut setup);
    scene.setup = setup.into();
    scene
}

fn launch(series: &SeatSeries, scene: &Scene) -> SeatQuantities {
    series.model(scene, Model::C, Some(8)).expect("model").point(1e-4).expect("run").quantities
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

/// New meshes scatter by 0.2 to 0.4 degrees.
#[test]
fn the_direction_is_smooth_in_the_dimensions() {
    let series = series();
    type Change = fn(&mut SealSeat, f64);
    let changes: [(&str, Change); 3] = [
        ("tips", |setup, s| {
            setup.actuator.tip_positions.iter_mut().for_each(|x| *x += x.signum() * 2e-4 * s)
        }),
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
        assert!(cubic.deviation < 0.02, "{name}: {cubic:?}");
        assert!(cubic.coefficients[1].abs() > 5.0 * cubic.deviation, "{name} turns the flight: {cubic:?}");
    }
}

#[test]
fn a_shape_that_a_mesh_cannot_follow_is_an_error() {
    let series = series();
    let message =
        |scene: &Scene| series.model(scene, Model::C, Some(8)).expect_err("another shape").to_string();
    assert!(message(&changed(|setup| setup.seat.notch = None)).contains("notch or a tip"));
    let far = message(&changed(|setup| setup.seat.membrane_thickness *= 0.02));
    assert!(far.contains("can't follow the shape so far"), "{far}");
}

/// As a sweep over a plate: grid, shards, records that are not computed twice, and what can't be said of a point beside it.
#[test]
fn a_sweep_of_seats_gives_the_launches_of_the_series() {
    let folder = tempfile::tempdir().expect("folder");
    let at = |name: &str| folder.path().join(name).to_str().expect("path").to_owned();
    let path = |name: &str| fixture(name).to_str().expect("path").to_owned();
    let (own, mesh) = (path("seal-seat.toml"), path("seal-seat-improved-coarse.vtu"));
    // on a floor above the membrane the notch would end elsewhere
    let plan = format!(
        "scene = '{own}'\nmesh = '{mesh}'\nmodes = 8\ntolerance = 1e-4\n\
         [[vary]]\nfields = ['seat.notch_floor', 'seat.membrane_thickness']\nvalues = ['0.5 mm', '0.52 mm', '0.01 mm']\n\
         [[vary]]\nfield = 'actuator.speed'\nfrom = '0.5 m/s'\nto = '1 m/s'\ncount = 2\n"
    );
    std::fs::write(at("sweep.toml"), &plan).expect("file");
    let run = |rest: &[&str]| {
        let (plan, out) = (at("sweep.toml"), at("out"));
        let arguments = [&["study", rest[0], &plan, "--out", &out][..], &rest[1..]].concat();
        impactcheck(&arguments, folder.path())
    };
    assert_eq!(run(&["sweep", "--shard", "1/2"]).0, 0);
    let (status, _, error) = run(&["merge"]);
    assert!(status == 2 && error.contains("3 of 6 points"), "{error}");
    let (status, text, error) = run(&["sweep", "--json", "--quantity", "sphere_angle"]);
    assert!(status == 0 && error.contains("6 points, 3 of them run now"), "{error}");
    assert!(folder.path().join("out/sweep.svg").is_file() && folder.path().join("out/sweep.csv").is_file());
    let document: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let columns = document["columns"].as_array().expect("columns");
    let value = |row: usize, name: &str| {
        let column = columns.iter().position(|column| column == name).expect("a column");
        document["rows"][row][column].clone()
    };
    let series = series();
    for (row, (thickness, speed)) in
        [(5e-4, 0.5), (5e-4, 1.0), (5.2e-4, 0.5), (5.2e-4, 1.0)].into_iter().enumerate()
    {
        let scene = changed(|setup| {
            setup.seat.membrane_thickness = thickness;
            setup.seat.notch.as_mut().expect("a notch").floor = thickness;
            setup.actuator.speed = speed;
        });
        let launch = launch(&series, &scene);
        for (name, expected) in [("sphere_angle", launch.sphere_angle), ("sphere_speed", launch.sphere_speed)]
        {
            assert_eq!(value(row, name).as_f64(), Some(expected), "{name} of point {row}");
        }
    }
    assert_eq!(value(4, "status"), "failed");
    assert!(value(4, "reason").as_str().expect("a reason").contains("can't follow the shape so far"));
    for (from, to, said) in
        [("modes = 8", "modes = 8\nmodel = 'B'", "has model C only"), (&mesh, "nowhere.vtu", "nowhere.vtu")]
    {
        std::fs::write(at("sweep.toml"), plan.replace(from, to)).expect("file");
        let (status, out, error) = run(&["sweep"]);
        assert!(status != 0 && out.is_empty() && error.contains(said), "{said}: {error}");
    }
    std::fs::write(at("sweep.toml"), &plan).expect("file");
    let (status, _, error) = run(&["sweep", "--quantity", "outer_velocity_final"]);
    assert!(status == 2 && error.contains("sphere_velocity_x"), "{error}");
}

/// A sweep of the friction gives what finite elements find (`friction.rs`).
#[test]
fn friction_is_varied_like_any_number() {
    let folder = tempfile::tempdir().expect("folder");
    let path = |name: &str| folder.path().join(name);
    let write = |name: &str, text: String| std::fs::write(path(name), text).expect("file");
    let text = std::fs::read_to_string(fixture("seal-seat.toml")).expect("scene");
    write("rough.toml", format!("friction = 0.1\n{text}"));
    std::fs::copy(fixture("seal-seat-improved-coarse.vtu"), path("seat.vtu")).expect("mesh");
    let head = "scene = \"rough.toml\"\nmesh = \"seat.vtu\"\n";
    write("plan.toml", format!("{head}[[vary]]\nfield = \"friction\"\nvalues = [0, 0.1]\n"));
    let [plan, out] = ["plan.toml", "out"].map(|name| path(name).display().to_string());
    let (status, _, error) = impactcheck(&["study", "sweep", &plan, "--out", &out], folder.path());
    assert_eq!(status, 0, "{error}");
    let mut table = csv::Reader::from_path(path("out/sweep.csv")).expect("table");
    let column = table.headers().expect("header").iter().position(|name| name.starts_with("sphere_angle"));
    let angle = |row: csv::StringRecord| row[column.expect("a column")].parse::<f64>().expect("number");
    let angles: Vec<f64> = table.records().map(|row| angle(row.expect("row")).to_degrees()).collect();
    assert!((angles[0] - 14.05).abs() < 0.05 && (angles[1] - 10.92).abs() < 0.05, "{angles:?}");
}
