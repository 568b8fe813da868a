//! Impacts on a wall and of two bodies against Hertz's closed form, momentum and energy, and what such scenes refuse.

use approx::assert_relative_eq;
use impactcheck::kinds::{self, Kind};
use impactcheck::result::{Outcome, Summary};
use impactcheck::scene::{Model, Scene};
use std::f64::consts::PI;

const MATERIALS: &str = r#"
[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7780 kg/m^3"
[materials.glass]
youngs_modulus = "64 GPa"
poisson_ratio = 0.2
density = "2500 kg/m^3"
"#;
const OUTER: &str = r#"
[outer]
kind = "sphere"
radius = "10 mm"
material = "steel"
speed = "500 mm/s"
"#;
const PLATE: &str = r#"
[plate]
radius = "33 mm"
thickness = "2 mm"
edge = "clamped"
material = "steel"
"#;
const WALL: &str = "[wall]\nmaterial = \"glass\"\n";
const RIGID: &str = "[wall]\nrigid = true\n";

fn text(kind: &str, tables: &str) -> String {
    format!("name = \"test\"\nkind = \"{kind}\"\n{MATERIALS}{tables}")
}

fn scene(tables: &str) -> Scene {
    Scene::parse("test.toml", &text("impact", tables)).expect("valid")
}

fn ran(scene: &Scene) -> Outcome {
    let kind: &dyn Kind = kinds::of(scene);
    kind.model(scene, Model::C, None).expect("model").run_with_history(1e-9).expect("run")
}

fn value(summary: &Summary, name: &str) -> f64 {
    summary.value(name).unwrap_or_else(|| panic!("{name} is not determined"))
}

fn sphere_mass(radius: f64, density: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3) * density
}

/// 1/E* of steel and a material with Young's modulus `modulus` in Pa and Poisson's ratio `nu`.
fn compliance(modulus: f64, nu: f64) -> f64 {
    (1.0 - 0.3 * 0.3) / 210e9 + (1.0 - nu * nu) / modulus
}

/// Peak, duration and largest approach of an impact of the effective `mass` in kg with `speed` in m/s on the stiffness `k` by Hertz's closed
/// form, against `outcome`.
fn is_hertz(outcome: &Outcome, mass: f64, speed: f64, k: f64) {
    let approach = (1.25 * mass * speed * speed / k).powf(0.4);
    let summary = &outcome.summary;
    assert_relative_eq!(value(summary, "outer_force_peak"), k * approach.powf(1.5), max_relative = 1e-6);
    assert_relative_eq!(
        value(summary, "outer_contact_end"),
        2.943_275 * approach / speed,
        max_relative = 1e-6
    );
    assert_relative_eq!(value(summary, "outer_impulse"), 2.0 * mass * speed, max_relative = 1e-6);
    assert_relative_eq!(value(summary, "outer_restitution"), 1.0, max_relative = 1e-6);
    assert_eq!(value(summary, "outer_contacts"), 1.0);
    let history = &outcome.history;
    let inner = history.curve("inner_displacement");
    let closed = |n: usize| inner.map_or(0.0, |inner| inner[n]) - history["outer_displacement"][n];
    let largest = (0..history.len()).map(closed).fold(0.0, f64::max);
    // between two samples the approach is a parabola
    assert_relative_eq!(largest, approach, max_relative = 2e-5);
}

#[test]
fn a_sphere_on_a_wall_is_hertz_s_impact() {
    for (wall, modulus, nu) in [(WALL, 64e9, 0.2), (RIGID, f64::INFINITY, 0.0)] {
        let scene = scene(&format!("{OUTER}{wall}"));
        let outcome = ran(&scene);
        let mass = sphere_mass(0.01, 7780.0);
        is_hertz(&outcome, mass, 0.5, 4.0 / 3.0 * 0.1 / compliance(modulus, nu));
        assert_relative_eq!(value(&outcome.summary, "outer_velocity_final"), 0.5, max_relative = 1e-6);
        for absent in ["efficiency", "inner_velocity_final"] {
            assert_eq!(outcome.summary.value(absent), None);
        }
        assert_eq!(outcome.history.curve("inner_velocity"), None);
        let broken: Vec<_> =
            kinds::of(&scene).checks(&scene, &outcome).into_iter().filter(|law| !law.holds()).collect();
        assert!(broken.is_empty(), "{broken:?}");
    }
}

/// Spheres of steel and glass of any size, the inner one at rest, coming or going: even where both are nearly as fast.
#[test]
fn two_unequal_spheres_are_hertz_s_impact_with_momentum_and_energy() {
    for (radius, own) in [(0.02, 0.0), (0.001, 0.0), (0.005, 0.3), (0.01, -0.4995)] {
        let scene = scene(&format!(
            "{OUTER}[inner]\nkind = \"sphere\"\nradius = {radius}\nmaterial = \"glass\"\nspeed = {own}\n"
        ));
        let outcome = ran(&scene);
        let masses = [sphere_mass(0.01, 7780.0), sphere_mass(radius, 2500.0)];
        let (mass, closing) = (masses[0] * masses[1] / (masses[0] + masses[1]), 0.5 + own);
        let curvature = 0.01 * radius / (0.01 + radius);
        is_hertz(&outcome, mass, closing, 4.0 / 3.0 * curvature.sqrt() / compliance(64e9, 0.2));
        let after = [-0.5 + 2.0 * mass * closing / masses[0], own - 2.0 * mass * closing / masses[1]];
        let summary = &outcome.summary;
        for (name, exact) in [("outer_velocity_final", after[0]), ("inner_velocity_final", after[1])] {
            assert_relative_eq!(value(summary, name), exact, epsilon = 1e-6 * closing);
        }
        let efficiency = masses[1] * after[1].powi(2) / (masses[0] * 0.25);
        assert_relative_eq!(value(summary, "efficiency"), efficiency, max_relative = 1e-5);
        let broken: Vec<_> =
            kinds::of(&scene).checks(&scene, &outcome).into_iter().filter(|law| !law.holds()).collect();
        assert!(broken.is_empty(), "{broken:?}");
    }
}

/// Mass and tip radius of a compact body are independent; at an angle the part of the velocity along the normal counts.
#[test]
fn a_compact_body_strikes_with_its_tip_and_along_the_normal() {
    let outer = OUTER.replace("sphere", "compact").replace("radius", "tip_radius") + "mass = \"5 g\"\n";
    let k = 4.0 / 3.0 * 0.1 / compliance(64e9, 0.2);
    is_hertz(&ran(&scene(&format!("{outer}{WALL}"))), 0.005, 0.5, k);
    let oblique = ran(&scene(&format!("{outer}angle = \"60 deg\"\n{WALL}")));
    is_hertz(&oblique, 0.005, 0.25, k);
    // without friction the rest stays
    let along = oblique.summary.sideways.expect("moves sideways").outer_tangential_velocity_final;
    assert_relative_eq!(along, 0.5 * 60f64.to_radians().sin(), max_relative = 1e-12);
}

/// A Maxwell sphere on a rigid wall loses (4/9) T/tau of its speed in a contact that is short against tau (Hunter, J. Mech. Phys. Solids 8,
/// 1960, 219); against a material that relaxes as well, and is as stiff, just as much.
#[test]
fn a_relaxing_sphere_on_a_wall_loses_speed_as_hunter_says() {
    let elastic = ran(&scene(&format!("{OUTER}{RIGID}")));
    for (wall, halves) in [(RIGID, 1.0), ("[wall]\nmaterial = \"steel\"\n", 2.0_f64)] {
        let ratio = 0.01;
        let time = value(&elastic.summary, "outer_contact_end") * halves.powf(0.4) / ratio;
        let relaxing = text("impact", &format!("{OUTER}{wall}")).replacen(
            "density = \"7780 kg/m^3\"",
            &format!("density = \"7780 kg/m^3\"\nrelaxation = [{{ ratio = 0.999999, time = {time} }}]"),
            1,
        );
        let summary = ran(&Scene::parse("test.toml", &relaxing).expect("valid")).summary;
        let lost = 1.0 - value(&summary, "outer_restitution");
        assert_relative_eq!(lost, 4.0 / 9.0 * ratio, max_relative = 0.01);
        assert!(summary.energy_residual.expect("a residual") < 1e-4);
    }
}

/// The energy that a yielding sphere loses is plastic work, every impact of a series loses less, and the dent grows less.
#[test]
fn a_series_of_yielding_impacts_on_a_wall_loses_less_and_less() {
    let yielding = text("impact", &format!("{OUTER}{RIGID}[series]\nimpacts = 4\n")).replacen(
        "density = \"7780 kg/m^3\"",
        "density = \"7780 kg/m^3\"\nyield_strength = \"1 GPa\"\nhardening = \"1 GPa\"",
        1,
    );
    let summary = ran(&Scene::parse("test.toml", &yielding).expect("valid")).summary;
    let energy = 0.5 * sphere_mass(0.01, 7780.0) * 0.25;
    let restitutions: Vec<f64> = summary
        .impacts
        .iter()
        .map(|impact| {
            let restitution = impact.value("outer_restitution").expect("determined");
            let work = impact.plastic_work.expect("determined");
            assert_relative_eq!(work, energy * (1.0 - restitution.powi(2)), max_relative = 1e-4);
            restitution
        })
        .collect();
    assert_eq!(restitutions.len(), 4);
    assert!(
        restitutions.windows(2).all(|pair| pair[0] < pair[1]) && restitutions[0] < 0.95,
        "{restitutions:?}"
    );
}

/// A bender on a wall bounces within its run, and its contact force is the same the heavier an inner body is that stands for the wall.
#[test]
fn a_bender_on_a_wall_strikes_as_on_a_heavy_body() {
    let bender = r#"
[outer]
kind = "bender"
length = "30 mm"
first_frequency = "400 Hz"
tip_stiffness = "20 kN/m"
tip_mass = "1 g"
tip_radius = "5 mm"
material = "steel"
speed = "500 mm/s"
"#;
    let end = "[run]\nend_time = \"800 us\"\n";
    let wall = ran(&scene(&format!("{bender}[wall]\nmaterial = \"steel\"\n{end}"))).summary;
    // flat in comparison with the bender's tip
    let heavy =
        "[inner]\nkind = \"compact\"\nmass = \"1000 kg\"\ntip_radius = \"900 m\"\nmaterial = \"steel\"\n";
    let body = ran(&scene(&format!("{bender}{heavy}{end}"))).summary;
    for name in ["outer_force_peak", "outer_contact_end", "outer_impulse", "outer_contacts"] {
        assert_relative_eq!(value(&wall, name), value(&body, name), max_relative = 1e-4);
    }
    assert_eq!(wall.value("outer_restitution"), None);
}

/// With a plate it is the plate impact: the same bodies, hash and results.
#[test]
fn an_impact_with_a_plate_is_a_plate_impact() {
    let tables = format!(
        "{OUTER}{PLATE}[inner]\nkind = \"sphere\"\nradius = \"10 mm\"\nmaterial = \"steel\"\n[tolerances.B]\ninner_force_peak = 0.1\n"
    );
    let [general, plate] = ["impact", "plate-impact"]
        .map(|kind| Scene::parse("test.toml", &text(kind, &tables)).expect("valid"));
    assert_eq!((general.hash(), &general), (plate.hash(), &plate));
    let [general, plate] = [general, plate].map(|scene| {
        let model = kinds::of(&scene).model(&scene, Model::B, None).expect("model");
        Summary { solve_seconds: 0.0, ..model.run(1e-7).expect("run") }
    });
    assert_eq!(general, plate);
}

#[test]
fn scenes_that_contradict_themselves_are_refused_in_a_sentence() {
    let inner = "[inner]\nkind = \"sphere\"\nradius = \"10 mm\"\nmaterial = \"steel\"\n";
    let held = OUTER.replace("\"sphere\"\nradius = \"10 mm\"", "\"bender\"\nlength = \"30 mm\"\nfirst_frequency = \"400 Hz\"\ntip_stiffness = \"20 kN/m\"\ntip_mass = \"1 g\"\ntip_radius = \"5 mm\"");
    for (tables, said) in [
        (format!("{OUTER}{PLATE}{RIGID}"), "the scene has two of [plate], [body] and [wall]"),
        (format!("{OUTER}{WALL}rigid = true\n"), "`wall.material` and `wall.rigid` exclude each other"),
        (format!("{OUTER}[wall]\n"), "`wall.material` is missing"),
        (format!("{OUTER}[wall]\nrigid = false\n"), "`wall.material` is missing"),
        (format!("{OUTER}{RIGID}{inner}"), "nothing lies behind a wall"),
        (OUTER.to_owned(), "`inner` is missing: without [plate], [body] and [wall]"),
        (format!("{OUTER}offset = \"1 mm\"\n{RIGID}"), "`outer.offset` is 0.001 m"),
        (format!("{OUTER}{inner}speed = \"-500 mm/s\"\n"), "must be greater than -0.5 m/s"),
        (
            format!("{OUTER}{RIGID}[fluid]\nviscosity = 1e-3\ndensity = 1e3\nminimum_gap = 1e-6\n"),
            "`fluid` does not belong to kind `impact`",
        ),
        (
            format!("{OUTER}{RIGID}[reference]\nelements_per_contact_radius = 1\n"),
            "`reference.elements_per_contact_radius` is 1",
        ),
        (format!("{OUTER}{RIGID}[reduced]\nmodel = \"A\"\n"), "`reduced.model` is \"A\""),
        (format!("{OUTER}{RIGID}[tolerances.A]\nefficiency = 0.1\n"), "`A` is not a reduced model"),
        (format!("{OUTER}{RIGID}[tolerances.C]\nplate_velocity_rms = 0.1\n"), "not a quantity that can have"),
        (format!("{OUTER}[body]\nfile = \"casing.step\"\n"), "the material is missing in [body]"),
        (format!("{OUTER}[body]\nfile = \"none.step\"\nmaterial = \"steel\"\n"), "`outer.at` is missing"),
        (
            format!("{OUTER}at = \"top\"\n[body]\nfile = \"none.step\"\nmaterial = \"steel\"\n"),
            "`body.file` is \"none.step\", but \"none.step\" can't be read",
        ),
        (format!("{OUTER}at = \"top\"\n{RIGID}"), "`at` is a place on [body]"),
        (format!("{OUTER}at = [\"1 mm\", \"2 mm\"]\n{RIGID}"), "it must be a name or three coordinates"),
        (format!("{held}{RIGID}"), "`run.end_time` is missing"),
    ] {
        let refused = Scene::parse("test.toml", &text("impact", &tables)).expect_err(said);
        let stated = format!("{:?}", refused);
        let flat =
            |text: &str| text.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert!(flat(&stated).contains(said), "{said}: {stated}");
        assert_eq!(refused.exit_status() as u8, 3);
    }
}

#[test]
fn models_that_need_a_plate_are_refused_by_name() {
    let scene = scene(&format!("{OUTER}{RIGID}"));
    for (model, modes, said) in [(Model::B, None, "has model C only"), (Model::C, Some(4), "has no modes")] {
        let refused = kinds::of(&scene).model(&scene, model, modes).expect_err(said);
        assert!(refused.to_string().contains(said), "{refused}");
    }
}
