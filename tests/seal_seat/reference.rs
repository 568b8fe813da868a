//! Stored references of the two seal-seat designs: found for exactly their scenes, consistent with themselves, and
//! what section 4.4 of the paper found: the initial design throws the sphere to the wrong side, the improved one
//! where it is meant to go.

use impactcheck::kinds::seal_seat::SeatQuantities;
use impactcheck::reference::{Lookup, Resolution, Store, Stored, make_seat_mesh, seat_meshes};
use impactcheck::result::{Source, Summary};
use impactcheck::scene::{Scene, Template, resolve};
use std::path::{Path, PathBuf};

const DESIGNS: [&str; 2] = ["seal-seat-initial", "seal-seat-improved"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The scene file.
fn scene_file(name: &str) -> PathBuf {
    resolve(name).expect("shipped scene")
}

fn stored(name: &str) -> (Scene, Stored) {
    let scene = Scene::read(scene_file(name)).expect("valid scene");
    match Store::open(None).find(&scene, Resolution::Paper) {
        Lookup::Found(stored) => (scene, *stored),
        other => panic!("{name}: {other:?}"),
    }
}

fn determined(summary: &Summary) -> SeatQuantities {
    SeatQuantities::of_table(&summary.quantities).expect("determined")
}

#[test]
fn the_initial_design_throws_to_the_wrong_side_and_the_improved_one_where_it_should() {
    for (name, improved) in DESIGNS.into_iter().zip([false, true]) {
        let (scene, stored) = stored(name);
        let summary = &stored.outcome.summary;
        let (q, setup) = (determined(summary), scene.seal_seat().expect("a seal seat"));
        let miss = (q.sphere_angle - setup.intended_angle).to_degrees();
        assert!(q.sphere_velocity_z > 1.0);
        if improved {
            assert!(miss.abs() < 1.5, "{miss} deg");
        } else {
            assert!(
                (-9.0..-8.0).contains(&q.sphere_angle.to_degrees()),
                "{} deg",
                q.sphere_angle.to_degrees()
            );
        }
        // The band tells the two sides apart.
        assert!(summary.uncertainty["sphere_angle"] < q.sphere_angle.abs());
        assert_eq!(summary.source, Source::Reference);
        // The energy of a run with levels is read to 1e-5; with one time step for all nodes it is exact.
        let levels = summary.solver.as_ref().and_then(|solver| solver["nodes_per_level"].as_array());
        let bound = if levels.is_some_and(|levels| levels.len() > 1) { 1e-5 } else { 1e-10 };
        assert!(summary.energy_residual.unwrap() < bound && summary.momentum_residual.unwrap() < 1e-9);
    }
}

#[test]
fn quantities_are_consistent_with_each_other_and_with_the_history() {
    for name in DESIGNS {
        let (scene, stored) = stored(name);
        let setup = scene.seal_seat().expect("a seal seat");
        let (q, history) = (determined(&stored.outcome.summary), &stored.outcome.history);
        let near = |a: f64, b: f64, relative: f64| assert!((a - b).abs() <= relative * b.abs(), "{a} {b}");
        near(q.sphere_speed, q.sphere_velocity_x.hypot(q.sphere_velocity_z), 1e-12);
        near(q.sphere_angle, q.sphere_velocity_x.atan2(q.sphere_velocity_z), 1e-12);
        let energy = |mass: f64, speed: f64| 0.5 * mass * speed * speed;
        let transmitted = energy(setup.sphere.mass, q.sphere_speed);
        near(q.efficiency, transmitted / energy(setup.actuator.mass, setup.actuator.speed), 1e-12);
        let last = history.time.len() - 1;
        for (axis, v) in [("x", q.sphere_velocity_x), ("z", q.sphere_velocity_z)] {
            near(history[&*format!("sphere_velocity_{axis}")][last], v, 1e-6);
            // The force is what accelerates the sphere.
            let force = &history[&*format!("sphere_force_{axis}")];
            let impulse: f64 = (1..=last)
                .map(|k| 0.5 * (force[k] + force[k - 1]) * (history.time[k] - history.time[k - 1]))
                .sum();
            near(impulse, setup.sphere.mass * v, 2e-3);
        }
        // Every normal of the cone has the component sin(gamma/2) along the seat's axis.
        let axis = setup.ring().axis;
        let along = q.sphere_velocity_x * axis[0] + q.sphere_velocity_z * axis[1];
        let pressed =
            (q.left_flank_impulse + q.right_flank_impulse) * (0.5 * setup.seat.aperture_angle).sin();
        near(pressed, setup.sphere.mass * along, 0.01);
        for (curve, peak) in
            [("sphere_force", q.sphere_force_peak), ("actuator_force", q.actuator_force_peak)]
        {
            let highest = history[curve].iter().copied().fold(0.0, f64::max);
            near(highest, peak, 0.01);
        }
    }
}

#[test]
fn the_summary_has_what_the_contract_names() {
    let (_, stored) = stored(DESIGNS[1]);
    let summary = serde_json::to_value(&stored.outcome.summary).expect("JSON");
    for name in SeatQuantities::ALL.iter().map(|quantity| quantity.name) {
        assert!(summary[name].is_f64(), "{name}");
        assert!(summary["uncertainty"][name].as_f64().is_some_and(|band| band > 0.0), "{name}");
        assert_eq!(summary[name].as_f64(), stored.outcome.summary.value(name));
    }
    for name in ["energy_residual", "momentum_residual", "steps", "solve_seconds", "mesh", "convergence"] {
        assert!(!summary[name].is_null(), "{name}");
    }
}

#[test]
fn a_solution_is_used_for_its_own_scene_only() {
    let template = Template::read(scene_file(DESIGNS[1])).expect("valid scene");
    let fields = ["seat.tilt", "seat.notch_width"].map(|name| template.field(name).expect(name));
    let other = template.with(&[(&fields[0], 0.25), (&fields[1], 0.0015)]).expect("valid");
    match Store::open(None).find(&other, Resolution::Paper) {
        Lookup::Stale { reason } => {
            assert!(reason.contains("seat.tilt: 0.2617") && reason.contains("-> 0.25 rad"), "{reason}");
            assert!(reason.contains("seat.notch.width: 0.0014 -> 0.0015 m"), "{reason}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_shipped_meshes_belong_to_their_scenes_and_a_changed_one_to_none() {
    for name in DESIGNS {
        let scene = Scene::read(scene_file(name)).expect("valid scene");
        let found = seat_meshes(&root().join("meshes"), &scene).expect("meshes");
        assert_eq!(found.len(), 1, "{name}");
        let (path, info) = &found[0];
        assert!(path.ends_with(format!("{name}.vtu")) && info.element_order == 2 && info.min_quality > 0.2);
        // A mesh that is not the one described is not used.
        let folder = tempfile::tempdir().expect("temporary folder");
        let copy = folder.path().join("seat.vtu");
        std::fs::copy(path.with_extension("json"), copy.with_extension("json")).expect("copied");
        let mut bytes = std::fs::read(path).expect("mesh");
        std::fs::write(&copy, &bytes).expect("written");
        assert_eq!(seat_meshes(folder.path(), &scene).expect("meshes").len(), 1);
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        std::fs::write(&copy, &bytes).expect("written");
        assert!(seat_meshes(folder.path(), &scene).expect("meshes").is_empty());
    }
}

#[test]
fn a_mesh_replaces_no_file_of_the_users() {
    let scene = Scene::read(scene_file(DESIGNS[0])).expect("valid scene");
    for (name, text) in
        [("seat.json", "{\"kind\": \"seal-seat\"}"), ("seat.json", "[1]"), ("seat.vtu", "<VTKFile/>")]
    {
        let folder = tempfile::tempdir().expect("temporary folder");
        let own = folder.path().join(name);
        std::fs::write(&own, text).expect("written");
        let out = folder.path().join("seat.vtu");
        let error = make_seat_mesh(Path::new("no-python"), &scene, Resolution::Coarse, 1.0, &out)
            .expect_err("refused");
        assert_eq!(error.exit_status(), impactcheck::ExitStatus::Usage, "{error}");
        assert!(error.to_string().contains(name), "{error}");
        assert_eq!(std::fs::read_to_string(&own).expect("there"), text);
        assert_eq!(std::fs::read_dir(folder.path()).expect("folder").count(), 1);
    }
    // an earlier mesh is replaced: here the solver is reached
    let folder = tempfile::tempdir().expect("temporary folder");
    let shipped = root().join("meshes").join(format!("{}.json", DESIGNS[0]));
    std::fs::copy(shipped, folder.path().join("seat.json")).expect("copied");
    let out = folder.path().join("seat.vtu");
    let error =
        make_seat_mesh(Path::new("no-python"), &scene, Resolution::Coarse, 1.0, &out).expect_err("no Python");
    assert_eq!(error.exit_status(), impactcheck::ExitStatus::Solver, "{error}");
}

#[test]
fn meshing_refuses_what_it_cannot_mesh() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let out = folder.path().join("seat.vtu");
    let seat = scene_file(DESIGNS[0]);
    for (scene, factor, status, words) in [
        (resolve("scaled-plate-r10").expect("shipped"), "1", 3, "`seal-seat`"),
        (seat.clone(), "0", 2, "between 0.1 and 10"),
        (seat, "nan", 2, "between 0.1 and 10"),
    ] {
        let done = std::process::Command::new(env!("CARGO_BIN_EXE_impactcheck"))
            .args(["mesh", "--size-factor", factor, "--out"])
            .arg(&out)
            .arg(scene)
            .output()
            .expect("run");
        let said = String::from_utf8_lossy(&done.stderr).split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(done.status.code(), Some(status), "{said}");
        assert!(said.contains(words), "{said}");
        assert!(!out.exists());
    }
}
