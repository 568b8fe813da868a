//! Reduced model of the flexible seal seat (section 4.4) on a coarse mesh of the improved design.
//!
//! Mesh: `impactcheck mesh seal-seat-improved --resolution coarse --size-factor 2.2`, quadratic tetrahedra, 2174 nodes.

use assert_cmd::Command;
use impactcheck::body::cache::Cache;
use impactcheck::kinds::seal_seat::SeatQuantities;
use impactcheck::kinds::seal_seat::{ContactBody, SeatMesh, SeatModel, Zones};
use impactcheck::result::Summary;
use impactcheck::scene::{Model, Scene};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

pub fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name)
}

pub fn scene() -> Scene {
    Scene::read(fixture("seal-seat.toml")).expect("scene")
}

pub fn mesh() -> SeatMesh {
    SeatMesh::open(&fixture("seal-seat-improved-coarse.vtu")).expect("mesh")
}

pub fn model(modes: usize) -> SeatModel {
    SeatModel::new(&scene(), Model::C, Some(modes), &mesh(), &Cache::off()).expect("model")
}

/// Model with 16 modes, built once for all tests.
pub fn sixteen() -> &'static SeatModel {
    static MODEL: OnceLock<SeatModel> = OnceLock::new();
    MODEL.get_or_init(|| model(16))
}

fn determined(summary: &Summary) -> SeatQuantities {
    SeatQuantities::of_table(&summary.quantities).expect("determined")
}

/// Eigenfrequencies of the fixture's mesh in Hz by dolfinx 0.5.2 and SLEPc 3.18 (Krylov-Schur, shift-invert):
/// `python3 -m fem_reference modes --scene scene.json --count 10 --mesh tests/fixtures/seal-seat-improved-coarse.vtu`.
const SLEPC: [f64; 10] = [
    4493.682227800223,
    11707.746592643321,
    13942.499255702645,
    24248.05222102489,
    33763.23730331995,
    42149.393628541264,
    46766.07512512408,
    55724.276975830275,
    57593.32323011873,
    63071.917493595094,
];

#[test]
fn first_ten_frequencies_are_those_of_slepc_on_the_same_mesh() {
    let omega = &sixteen().system().omega;
    for (found, expected) in omega.iter().zip(SLEPC) {
        let frequency = found / (2.0 * std::f64::consts::PI);
        assert!((frequency / expected - 1.0).abs() < 1e-6, "{frequency} Hz, SLEPc {expected} Hz");
    }
}

#[test]
fn energy_and_momentum_balance() {
    let result = sixteen().integrate(0.25e-6, 1e-3, false).expect("run");
    assert!(result.energy_residual < 1e-4, "{}", result.energy_residual);
    assert!(result.momentum_residual < 1e-12, "{}", result.momentum_residual);
    // what the flanks push along the normals is more than what the sphere gets, and not much more
    let [left, right] = result.tally.flank_impulse;
    let system = sixteen().system();
    let [x, z] = result.state.sphere_velocity;
    let momentum = 2.0 * system.sphere_mass * x.hypot(z);
    assert!(left > 0.0 && right > 0.0 && left + right > momentum && left + right < 2.0 * momentum);
}

#[test]
fn launch_converges_in_time_with_second_order_across_contact_events() {
    let velocity = |step: f64| sixteen().integrate(step, 1e-3, false).expect("run").state.sphere_velocity;
    let exact = velocity(1e-6 / 32.0);
    let error = |step: f64| {
        let [x, z] = velocity(step);
        (x - exact[0]).hypot(z - exact[1])
    };
    let errors = [2e-6, 1e-6, 0.5e-6, 0.25e-6].map(error);
    let order = (errors[0] / errors[3]).log(8.0);
    assert!(order > 1.8, "order {order}: {errors:?}");
    assert!(errors[3] < 5e-5, "{errors:?}");
}

#[test]
fn tolerance_bounds_the_error_of_the_velocity() {
    let quantities = |tolerance| determined(&sixteen().run(tolerance).expect("run"));
    let exact = quantities(1e-5);
    let found = quantities(1e-3);
    let miss = (found.sphere_velocity_x - exact.sphere_velocity_x)
        .hypot(found.sphere_velocity_z - exact.sphere_velocity_z);
    assert!(miss < 1e-3 * exact.sphere_speed, "{miss}");
}

#[test]
fn ten_modes_and_the_residual_are_as_good_as_many() {
    let quantities = |model: &SeatModel| determined(&model.run(1e-4).expect("run"));
    let many = quantities(&model(60));
    for modes in [10, 16, 25] {
        let few = quantities(&model(modes));
        let angle = (few.sphere_angle - many.sphere_angle).to_degrees();
        assert!(angle.abs() < 0.5, "{modes} modes: {angle} degrees off");
        for (name, a, b, bound) in [
            ("speed", few.sphere_speed, many.sphere_speed, 0.01),
            ("force on the sphere", few.sphere_force_peak, many.sphere_force_peak, 0.03),
            ("force of the actuator", few.actuator_force_peak, many.actuator_force_peak, 0.03),
        ] {
            assert!((a / b - 1.0).abs() < bound, "{modes} modes: {name} {a}, with 60 modes {b}");
        }
    }
}

#[test]
fn the_truncation_error_is_estimated_and_a_large_one_warned_of() {
    let many = model(60).run(1e-4).expect("run");
    let value = |summary: &Summary, name: &str| summary.value(name).expect("determined");
    for modes in [8, 16] {
        let few = model(modes).run(1e-4).expect("run");
        let error = ["sphere_speed", "sphere_force_peak", "actuator_force_peak"]
            .map(|name| (value(&few, name) / value(&many, name) - 1.0).abs())
            .into_iter()
            .fold(0.0, f64::max);
        let estimate = few.truncation_error.expect("estimate");
        assert!(estimate > 0.8 * error && estimate < 1.5 * error, "{modes} modes: {estimate}, is {error}");
        let warned = few.warnings.iter().any(|warning| warning.contains("take more (--modes)"));
        assert_eq!(warned, estimate > 0.01, "{modes} modes: {:?}", few.warnings);
    }
    assert!(many.truncation_error.expect("estimate") < 0.005, "{:?}", many.truncation_error);
}

#[test]
fn a_contact_at_single_nodes_is_warned_of() {
    let text = std::fs::read_to_string(fixture("seal-seat.toml")).expect("scene");
    let alone = |speed: &str| {
        let scene = Scene::parse("seat.toml", &text.replace("1 m/s", speed)).expect("scene");
        let model = SeatModel::new(&scene, Model::C, Some(8), &mesh(), &Cache::off()).expect("model");
        let warnings = model.run(1e-2).expect("run").warnings;
        ["nodes of the contact ring only", "in contact with one node only"]
            .map(|what| warnings.iter().any(|w| w.contains(what)))
    };
    assert_eq!(alone("10 mm/s"), [true, true]);
    assert_eq!(alone("10 m/s"), [false, false]);
}

#[test]
fn wider_zones_of_candidates_change_nothing() {
    let scene = scene();
    let setup = scene.seal_seat().expect("seal seat");
    let expected = Zones::expected(setup);
    let wide = Zones { ring: 4.0 * expected.ring, tip: 1.6 * expected.tip };
    let body = mesh().body(setup, &wide, 16, &Cache::off()).expect("body");
    assert!(body.candidates.len() > sixteen().system().candidates.len() + 20);
    let system = impactcheck::kinds::seal_seat::system::System::new(setup, &body.body, &body.candidates, 16)
        .expect("system");
    let options = impactcheck::kinds::seal_seat::integrate::Options {
        step: 1e-6,
        end_time: None,
        history: false,
        tolerance: 1e-3,
    };
    let wide = impactcheck::kinds::seal_seat::integrate::integrate(&system, &options).expect("run");
    let narrow = sixteen().integrate(1e-6, 1e-3, false).expect("run");
    for (a, b) in wide.state.sphere_velocity.iter().zip(narrow.state.sphere_velocity) {
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }
}

#[test]
fn zones_too_narrow_are_widened() {
    let zones = Zones { ring: 1e-5, tip: 1e-5 };
    let wider = zones.widened([1e-5, 0.0]).expect("contact fills the zone");
    assert!(wider.ring > zones.ring && wider.tip == zones.tip);
    assert_eq!(zones.widened([0.5e-5, 0.5e-5]), None);
}

#[test]
fn a_node_that_stands_alone_in_its_zone_has_candidates_around_it() {
    let scene = scene();
    let setup = scene.seal_seat().expect("seal seat");
    let narrow = Zones { ring: 1e-9, tip: 1e-9 };
    let body = mesh().body(setup, &narrow, 1, &Cache::off()).expect("body");
    for contact_body in [ContactBody::Sphere, ContactBody::Tip(0), ContactBody::Tip(1)] {
        let offsets = body.candidates.iter().filter(|c| c.contact_body == contact_body).map(|c| c.offset);
        let (inside, around): (Vec<f64>, Vec<f64>) = offsets.partition(|offset| *offset <= 1e-9);
        assert!(!inside.is_empty() && around.len() >= 4, "{contact_body:?}: {inside:?} {around:?}");
    }
}

#[test]
fn candidates_lie_on_the_exact_surfaces() {
    let scene = scene();
    let setup = scene.seal_seat().expect("seal seat");
    let [cx, cz] = setup.ring().sphere_centre;
    let mut on_ring = 0;
    for candidate in &sixteen().system().candidates {
        let [x, y, z] = candidate.place.into();
        match candidate.contact_body {
            ContactBody::Sphere => {
                // a cone that touches the sphere: r^2 + d^2 at the distance d from the ring
                let distance = (x - cx).hypot(y).hypot(z - cz);
                let expected = setup.sphere.radius.hypot(candidate.offset);
                assert!((distance - expected).abs() < 1e-9, "{distance} {expected}");
                on_ring += usize::from(candidate.offset < 1e-9);
            }
            ContactBody::Tip(tip) => {
                assert_eq!(z, 0.0);
                let near = (x - setup.actuator.tip_positions[tip]).hypot(y);
                assert!((near - candidate.offset).abs() < 1e-15);
            }
        }
    }
    assert!(on_ring > 10, "{on_ring}");
}

pub fn impactcheck(arguments: &[&str], cache: &Path) -> (i32, String, String) {
    let mut command = Command::cargo_bin("impactcheck").expect("binary");
    let output = command.args(arguments).env("IMPACTCHECK_CACHE", cache).output().expect("runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("status"), text(output.stdout), text(output.stderr))
}

#[test]
fn the_command_prints_the_summary_writes_the_history_and_remembers_the_body() {
    let folder = tempfile::tempdir().expect("folder");
    let (scene, mesh) = (fixture("seal-seat.toml"), fixture("seal-seat-improved-coarse.vtu"));
    let history = folder.path().join("history.csv");
    let cache = folder.path().join("cache");
    let arguments = [
        "reduced",
        scene.to_str().expect("path"),
        "--mesh",
        mesh.to_str().expect("path"),
        "--history",
        history.to_str().expect("path"),
        "--json",
    ];
    let (status, first, _) = impactcheck(&arguments, &cache);
    assert_eq!(status, 0);
    let (_, second, _) = impactcheck(&arguments, &cache);
    let [first, second]: [Value; 2] = [first, second].map(|text| serde_json::from_str(&text).expect("JSON"));
    for name in [
        "sphere_velocity_x",
        "sphere_velocity_z",
        "sphere_angle",
        "sphere_force_peak",
        "actuator_force_peak",
        "sphere_contact_end",
    ] {
        assert!(first[name].is_f64(), "{name}");
        assert_eq!(first[name], second[name], "{name}: the cached body is another one");
    }
    assert_eq!(first["model"], "C");
    let text = std::fs::read_to_string(history).expect("history");
    assert!(text.starts_with("time,sphere_displacement_x,"));
    assert_eq!(text.lines().count() as u64, 1 + first["samples"].as_u64().expect("samples"));
}

#[test]
fn what_a_seal_seat_has_not_is_refused_in_one_sentence() {
    let folder = tempfile::tempdir().expect("folder");
    let (scene, mesh) = (fixture("seal-seat.toml"), fixture("seal-seat-improved-coarse.vtu"));
    let (scene, mesh) = (scene.to_str().expect("path"), mesh.to_str().expect("path"));
    let plate = fixture("plate-impact.toml");
    let broken = folder.path().join("broken.vtu");
    std::fs::write(&broken, "<VTKFile>").expect("file");
    let broken = broken.to_str().expect("path");
    for (arguments, status, said) in [
        (vec!["reduced", scene, "--mesh", mesh, "--model", "A"], 2, "model A is one of a plate"),
        (vec!["reduced", scene, "--mesh", mesh, "--model", "B"], 2, "model B is one of a plate"),
        (vec!["reduced", scene, "--mesh", mesh, "--modes", "0"], 2, "at least one mode"),
        (vec!["reduced", scene, "--mesh", broken], 12, "can't be read as VTK"),
        (vec!["reduced", scene, "--mesh", "nowhere.vtu"], 1, "nowhere.vtu"),
        (vec!["reduced", plate.to_str().expect("path"), "--mesh", mesh], 2, "is no seal seat"),
    ] {
        let (found, output, error) = impactcheck(&arguments, folder.path());
        assert_eq!((found, output.as_str()), (status, ""), "{arguments:?}: {error}");
        assert!(error.contains(said), "{arguments:?}: {error}");
    }
    // the mesh of another geometry
    let own = std::fs::read_to_string(scene).expect("scene");
    let text = own.replace("tilt               = \"15 deg\"", "tilt               = \"14 deg\"");
    assert_ne!(text, own);
    let other = folder.path().join("other.toml");
    std::fs::write(&other, text).expect("file");
    let (status, _, error) =
        impactcheck(&["reduced", other.to_str().expect("path"), "--mesh", mesh], folder.path());
    assert_eq!(status, 12, "{error}");
    assert!(error.contains("not one of this seat"), "{error}");
}

#[test]
fn the_mesh_of_another_design_is_refused_and_one_without_geometry_has_a_warning() {
    let folder = tempfile::tempdir().expect("folder");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    // as another program would pass it on: without the description beside it
    let mesh = folder.path().join("mesh.vtu");
    std::fs::copy(root.join("meshes/seal-seat-improved.vtu"), &mesh).expect("copied");
    let other = root.join("scenes/seal-seat-initial.toml");
    let arguments = ["reduced", other.to_str().expect("path"), "--mesh", mesh.to_str().expect("path")];
    let (status, output, error) = impactcheck(&arguments, folder.path());
    assert_eq!((status, output.as_str()), (12, ""), "{error}");
    assert!(error.contains("not one of this seat: it was made for another geometry"), "{error}");
    let is_warned = |mesh: &SeatMesh| {
        let model = SeatModel::new(&scene(), Model::C, Some(4), mesh, &Cache::off()).expect("model");
        model.run(1e-2).expect("run").warnings.join(" ")
    };
    assert!(is_warned(&super::reduced::mesh()).contains("has no record of its geometry"));
    let text = std::fs::read_to_string(super::reduced::mesh().path()).expect("mesh");
    let hash = scene().seal_seat().expect("seat").geometry_hash();
    let own = folder.path().join("own.vtu");
    let noted = text.replacen('\n', &format!("\n<!--geometry_hash {hash}-->\n"), 1);
    std::fs::write(&own, noted).expect("written");
    assert!(!is_warned(&SeatMesh::open(&own).expect("mesh")).contains("geometry"));
}

/// A stand-in for the mesher, which waits for the second process before it writes a copy of the fixture's mesh.
#[cfg(unix)]
#[test]
fn two_processes_that_make_the_same_mesh_at_the_same_time_do_not_disturb_each_other() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("folder");
    let here = folder.path();
    let content = std::fs::read(super::reduced::mesh().path()).expect("mesh");
    std::fs::write(here.join("mesh.vtu"), &content).expect("mesh");
    // of another geometry, since those shipped have their meshes with them
    let text = std::fs::read_to_string(fixture("seal-seat.toml")).expect("scene");
    let text = text.replace("\"1.6 mm\"      # from the seated", "\"1.5999 mm\"      # from the seated");
    std::fs::write(here.join("mine.toml"), text).expect("scene");
    let hash = Scene::read(here.join("mine.toml")).expect("scene").seal_seat().expect("seat").geometry_hash();
    let info = serde_json::json!({
        "geometry_hash": hash, "sha256": impactcheck::scene::hash::sha256_hex(&content), "nodes": 2174, "dofs": 6522,
        "elements": 1066, "element_order": 2, "min_quality": 0.3, "mean_quality": 0.8,
    });
    std::fs::write(here.join("mesh.json"), info.to_string()).expect("description");
    let script = format!(
        "#!/bin/sh\nhere='{}'\n[ $3 = versions ] && {{ echo '{{\"python\": \"3\"}}'; exit; }}\n\
         while [ $# -gt 1 ]; do [ \"$1\" = --out ] && out=$2; shift; done\necho \"$out\" > \"$here/out.$$\"\n\
         tries=0; while [ $(ls \"$here\" | grep -c '^out') -lt 2 ] && [ $tries -lt 1200 ]; do sleep 0.05; tries=$((tries+1)); done\n\
         cp \"$here/mesh.vtu\" \"$out\"; cp \"$here/mesh.json\" \"${{out%.vtu}}.json\"\n",
        here.display()
    );
    let python = here.join("python");
    std::fs::write(&python, script).expect("script");
    std::fs::set_permissions(&python, std::fs::Permissions::from_mode(0o755)).expect("executable");
    let run = || {
        std::process::Command::new(assert_cmd::cargo::cargo_bin("impactcheck"))
            .args(["--quiet", "reduced", "mine.toml", "--modes", "2", "--tolerance", "1e-2"])
            .current_dir(here)
            .env("IMPACTCHECK_PYTHON", &python)
            .env("IMPACTCHECK_CACHE", here.join("cache"))
            .output()
            .expect("runs")
    };
    let outputs = std::thread::scope(|scope| {
        let both = [(); 2].map(|()| scope.spawn(run));
        both.map(|one| one.join().expect("runs"))
    });
    for output in &outputs {
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    // the last line has a run time
    let [first, second] = [0, 1].map(|i| String::from_utf8_lossy(&outputs[i].stdout).into_owned());
    assert_eq!(first.rsplit_once(" in ").expect("steps").0, second.rsplit_once(" in ").expect("steps").0);
    let names = std::fs::read_dir(here).expect("folder").map(|entry| entry.expect("entry").path());
    let places: std::collections::BTreeSet<String> = names
        .filter(|path| path.file_stem().is_some_and(|stem| stem == "out"))
        .map(|path| std::fs::read_to_string(path).expect("place"))
        .collect();
    assert_eq!(places.len(), 2, "each has a place of its own: {places:?}");
    let left: Vec<_> = std::fs::read_dir(here.join("cache/meshes")).expect("folder").flatten().collect();
    assert_eq!(left.len(), 2, "{left:?}");
}
