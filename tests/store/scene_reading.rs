//! Reading of scene files: what is valid arrives exactly, what is not is refused with field,
//! value, valid range and line, and nothing else happens.

use impactcheck::kinds::plate_impact::PlateImpact;
use impactcheck::scene::{self, Edge, Fault, Geometry, Model, Rigid, Scene, Shape, faults};
use impactcheck::{Error, ExitStatus};

pub(super) const VALID: &str = include_str!("../fixtures/plate-impact.toml");

pub(super) fn parse(text: &str) -> Scene {
    Scene::parse("scene.toml", text).expect("valid scene")
}

pub(super) fn plate_impact(scene: &Scene) -> &PlateImpact {
    scene.plate_impact().expect("a plate impact")
}

/// The valid scene with `from` replaced once; fails if there is nothing to replace.
pub(super) fn edited(from: &str, to: &str) -> String {
    assert!(VALID.contains(from), "`{from}` is not in the scene");
    VALID.replacen(from, to, 1)
}

pub(super) fn refused(text: &str) -> Vec<Fault> {
    match Scene::parse("scene.toml", text) {
        Err(error) => {
            assert_eq!(error.exit_status(), ExitStatus::InvalidScene);
            let Error::Scene(report) = error else { panic!("not a scene error") };
            let rendered = format!("{report:?}");
            let problems = faults(&report);
            assert!(!problems.is_empty(), "{rendered}");
            for problem in &problems {
                let place = format!("scene.toml:{}:", problem.line);
                assert!(rendered.contains(&place), "`{place}` is not in\n{rendered}");
            }
            problems
        }
        Ok(_) => panic!("accepted:\n{text}"),
    }
}

/// The one fault of `text` stands in `line` and says all of `words`.
#[track_caller]
pub(super) fn refuses(text: &str, line: usize, words: &[&str]) {
    let found = refused(text);
    assert_eq!(found.len(), 1, "{found:#?}");
    let said = format!("{} / {}", found[0].message, found[0].help.clone().unwrap_or_default());
    for word in words {
        assert!(said.contains(word), "`{word}` is not in: {said}");
    }
    assert_eq!(found[0].line, line, "{said}");
}

#[test]
fn shipped_scene_has_the_values_of_table_1() {
    let scene = parse(VALID);
    let setup = plate_impact(&scene);
    assert_eq!(scene.name, "scaled-plate-r10");
    assert_eq!((setup.plate.radius, setup.plate.thickness), (0.033, 0.002));
    assert_eq!(setup.plate.edge, Edge::Clamped);
    let steel = &setup.plate.material;
    assert_eq!((steel.youngs_modulus, steel.poisson_ratio, steel.density), (210e9, 0.3, 7780.0));
    assert_eq!(setup.outer.shape, Shape::Sphere { radius: 0.01 });
    assert_eq!(setup.outer.speed, 0.55);
    assert_eq!(setup.inner.gap, 0.0);
    assert_eq!(setup.fluid, None);
    assert_eq!(scene.run.end_time, None);
    assert_eq!((scene.reduced.model, scene.reduced.modes), (Some(Model::B), Some(16)));
    assert_eq!(scene.reference.geometry, Geometry::Axisymmetric);
    assert_eq!(scene.reference.elements_per_contact_radius, Some(12.0));
}

#[test]
fn every_shipped_scene_is_valid_and_named_like_its_file() {
    let paths = scene::shipped().expect("scenes");
    assert!(paths.len() >= 2 && paths.is_sorted(), "{paths:?}");
    for path in paths {
        let scene = Scene::read(&path).expect("valid scene");
        assert_eq!(Some(scene.name.as_str()), path.file_stem().and_then(|s| s.to_str()));
        assert_eq!(scene::resolve(&scene.name).expect("by name"), path);
        assert_eq!(scene::resolve(&path.display().to_string()).expect("by path"), path);
    }
}

const FLUID: &str = r#"gap = "2 um"
[fluid]
viscosity = "1 mPa*s"
density = 1000
minimum_gap = "0.25 um"
squeeze_film = false
added_mass_frequency_ratio = 0.3333
plate_damping_ratio = 0.03
drag_coefficient = 0.4
[run]
end_time = "250 us"
[reduced]"#;

const TOLERANCES: &str = r#"
[tolerances.B]
efficiency = 0.01
outer_contact_end = { absolute = "0.5 us", bias = "2.8 us" }
outer_force_peak = { relative = 0.01, bias = -0.021 }
inner_force_rms = { relative_to_peak = "3 %" }
energy_residual = 1e-6
[tolerances.C]
first_frequency = { absolute = "1 kHz" }
"#;

#[test]
fn everything_optional_is_read() {
    let sphere = "kind     = \"sphere\"\nradius   = \"10 mm\"";
    let text = edited(sphere, "kind = \"compact\"\nmass = \"32 g\"\ntip_radius = \"4 mm\"")
        .replace("edge      = \"clamped\"", "edge = \"free\"\ndamping_ratio = 1.5")
        .replace("[reduced]", FLUID)
        .replace("axisymmetric\"", "solid\"\nelement_order = 1\nrigid = \"inner\"")
        + TOLERANCES;
    let scene = parse(&text);
    let setup = plate_impact(&scene);
    assert_eq!(setup.outer.shape, Shape::Compact { mass: 0.032, tip_radius: 0.004 });
    assert_eq!((setup.plate.edge, setup.plate.damping_ratio), (Edge::Free, 1.5));
    assert_eq!((setup.inner.gap, scene.run.end_time), (2e-6, Some(250e-6)));
    let fluid = setup.fluid.as_ref().expect("fluid");
    assert_eq!((fluid.viscosity, fluid.density, fluid.minimum_gap), (1e-3, 1000.0, 0.25e-6));
    assert_eq!((fluid.squeeze_film, fluid.added_mass_frequency_ratio), (false, 0.3333));
    assert_eq!((fluid.plate_damping_ratio, fluid.drag_coefficient), (0.03, 0.4));
    assert_eq!(scene.reference.geometry, Geometry::Solid);
    assert_eq!((scene.reference.element_order, scene.reference.rigid), (Some(1), Some(Rigid::Inner)));
    let bounds = &scene.tolerances["B"];
    assert_eq!(bounds["efficiency"].relative, Some(0.01));
    assert_eq!(bounds["outer_contact_end"].absolute, Some(0.5e-6));
    assert_eq!(bounds["outer_contact_end"].bias, Some(2.8e-6));
    assert_eq!(bounds["outer_force_peak"].bias, Some(-0.021));
    assert_eq!(bounds["inner_force_rms"].relative_to_peak, Some(0.03));
    assert_eq!(bounds["energy_residual"].absolute, Some(1e-6));
    assert_eq!(scene.tolerances["C"]["first_frequency"].absolute, Some(1000.0));
}

#[test]
fn settings_of_solid_elements_belong_to_solid_geometry() {
    let solid = edited("geometry = \"axisymmetric\"", "geometry = \"solid\"");
    let settings = parse(&solid).reference;
    assert_eq!((settings.element_order, settings.rigid), (None, None));
    // The default number of elements is that of quadratic ones.
    let sparse = solid.replace("elements_per_contact_radius = 12", "rigid = \"none\"");
    assert_eq!(parse(&sparse).reference.elements_per_contact_radius, Some(3.0));
    assert_eq!(parse(&sparse).reference.rigid, None);
    // Absent geometry is axisymmetric.
    for geometry in ["geometry = \"axisymmetric\"", ""] {
        let text = edited("geometry = \"axisymmetric\"", &format!("{geometry}\nrigid = \"both\""));
        refuses(&text, 33, &["reference.rigid", "belongs to solid geometry"]);
    }
    // one that is off-centre or oblique is solid
    let oblique = edited("geometry = \"axisymmetric\"", "elements_per_thickness = 3")
        .replace("speed    = \"550 mm/s\"", "speed    = \"550 mm/s\"\nangle    = \"10 deg\"");
    assert_eq!(parse(&oblique).reference.elements_per_thickness, Some(3.0));
    refuses(
        &edited("geometry = \"axisymmetric\"", "geometry = \"solid\"\nelement_order = 3"),
        33,
        &["element_order", "from 1 to 2"],
    );
}

#[test]
fn a_bare_number_is_si() {
    let bare =
        edited("\"33 mm\"", "0.033").replace("\"7780 kg/m^3\"", "7780").replace("\"550 mm/s\"", "0.55");
    assert_eq!(parse(&bare), parse(VALID));
    assert_eq!(parse(&edited("\"33 mm\"", "\"0.033\"")), parse(VALID), "a text without unit");
    assert_eq!(parse(&edited("\"33 mm\"", "\"3.3 cm\"")), parse(VALID));
}

#[test]
fn numbers_out_of_range_are_refused() {
    refuses(&edited("\"33 mm\"", "\"-33 mm\""), 11, &["plate.radius", "-33 mm", "greater than 0 m"]);
    refuses(&edited("\"33 mm\"", "nan"), 11, &["plate.radius", "nan", "finite", "greater than 0 m"]);
    refuses(&edited("\"33 mm\"", "inf"), 11, &["plate.radius", "inf", "finite", "greater than 0 m"]);
    refuses(&edited("\"33 mm\"", "-inf"), 11, &["plate.radius", "-inf", "finite"]);
    refuses(&edited("\"33 mm\"", "1e999"), 11, &["plate.radius", "1e999"]);
    refuses(&edited("\"33 mm\"", "\"1e999 mm\""), 11, &["plate.radius", "1e999 mm"]);
    refuses(&edited("\"2 mm\"", "\"0 mm\""), 12, &["plate.thickness", "0 mm", "greater than 0 m"]);
    refuses(&edited("0.3", "0.5"), 7, &["materials.steel.poisson_ratio", "0.5", "less than 0.5"]);
    refuses(&edited("0.3", "-1"), 7, &["materials.steel.poisson_ratio", "-1", "greater than -1"]);
    refuses(&edited("\"550 mm/s\"", "0"), 20, &["outer.speed", "is 0", "greater than 0 m/s"]);
    refuses(
        &edited("\n[reduced]", "gap = \"-1 um\"\n[reduced]"),
        26,
        &["inner.gap", "-1 um", "at least 0 m"],
    );
    refuses(
        &edited("\n[outer]", "damping_ratio = -0.1\n[outer]"),
        15,
        &["plate.damping_ratio", "-0.1", "at least 0"],
    );
    for count in ["1.9", "65", "-3"] {
        let text = edited("radius = 12", &format!("radius = {count}"));
        refuses(&text, 33, &["reference.elements_per_contact_radius", count, "at least 2 and at most 64"]);
    }
    for count in ["0", "257", "-1", "16.5", "\"16\""] {
        let text = edited("modes = 16", &format!("modes = {count}"));
        refuses(&text, 29, &["reduced.modes", count, "from 1 to 256"]);
    }
}

#[test]
fn wrong_units_are_refused() {
    refuses(&edited("33 mm", "33 kg"), 11, &["plate.radius", "33 kg", "`kg`", "length", "needed", "33 mm"]);
    refuses(&edited("210 GPa", "210 GN"), 6, &["materials.steel.youngs_modulus", "210 GN", "`GN`", "Pa"]);
    refuses(&edited("550 mm/s", "550 mm"), 20, &["outer.speed", "550 mm", "m/s"]);
    refuses(
        &edited("33 mm", "33 inch"),
        11,
        &["plate.radius", "33 inch", "`inch` is not a known unit", "33 mm"],
    );
    refuses(&edited("33 mm", "thirty"), 11, &["plate.radius", "thirty", "not a number"]);
    refuses(&edited("\"33 mm\"", "[33]"), 11, &["plate.radius", "[33]", "array"]);
    refuses(&edited("\"33 mm\"", "true"), 11, &["plate.radius", "true", "boolean"]);
}

#[test]
fn unknown_keys_are_refused_at_every_level() {
    let extra = |before: &str, key: &str| edited(before, &format!("{key} = 1\n{before}"));
    refuses(&extra("name  ", "nmae"), 1, &["`nmae`", "did you mean `name`"]);
    refuses(&extra("youngs_modulus", "densty"), 6, &["materials.steel.densty", "did you mean `density`"]);
    refuses(&extra("thickness", "raduis"), 12, &["plate.raduis", "did you mean `radius`", "edge"]);
    let diameter = |value: &str, said: &str| {
        let text = edited("thickness", &format!("diameter = {value}\nthickness"));
        refuses(&text, 12, &["plate.diameter", "give the radius instead, radius = diameter / 2", said]);
    };
    diameter("\"66 mm\"", ": radius = \"33 mm\"; ");
    diameter("0.066", ": radius = 0.033; ");
    diameter("true", "/ 2; ");
    refuses(&extra("speed", "sped"), 20, &["outer.sped", "did you mean `speed`"]);
    refuses(&edited("\n[reduced]", "velocity = 1\n[reduced]"), 26, &["inner.velocity", "gap"]);
    refuses(&extra("modes", "mods"), 29, &["reduced.mods", "did you mean `modes`"]);
    refuses(&extra("geometry", "mesh"), 32, &["reference.mesh", "elements_per_contact_radius"]);
    refuses(&edited("[reduced]", "[run]\nend = 1\n[reduced]"), 28, &["run.end", "end_time"]);
    refuses(&edited("[reduced]", "[runs]\n[reduced]"), 27, &["`runs`", "did you mean `run`"]);
    let fluid = "[fluid]\nviscosity = 1e-3\ndensity = 1e3\nminimum_gap = 1e-6\nvelocity = 1\n[reduced]";
    refuses(&edited("[reduced]", fluid), 31, &["fluid.velocity", "viscosity"]);
    refuses(&edited("speed ", "mass = 1\nspeed "), 20, &["outer.mass", "`sphere`", "`compact`"]);
}

#[test]
fn tolerances_are_checked() {
    let with = |line: &str| format!("{VALID}[tolerances.B]\n{line}\n");
    let at = VALID.lines().count() + 2;
    refuses(&with("eficiency = 0.1"), at, &["tolerances.B.eficiency", "did you mean `efficiency`"]);
    refuses(&with("outer_force_rsm = 0.1"), at, &["tolerances.B.outer_force_rsm", "`outer_force_rms`"]);
    refuses(&with("efficiency = -0.1"), at, &["tolerances.B.efficiency", "-0.1", "at least 0"]);
    refuses(&with("efficiency = { absolut = 0.1 }"), at, &["efficiency.absolut", "did you mean `absolute`"]);
    refuses(&with("efficiency = {}"), at, &["tolerances.B.efficiency", "bounds nothing"]);
    refuses(&with("efficiency = { bias = 1 }"), at, &["tolerances.B.efficiency", "bounds nothing"]);
    refuses(&with("efficiency = { absolute = nan }"), at, &["tolerances.B.efficiency.absolute", "nan"]);
    refuses(&with("energy_residual = { relative = 0.1 }"), at, &["energy_residual.relative", "absolute"]);
    refuses(
        &with("outer_contact_end = { absolute = \"1 N\" }"),
        at,
        &["outer_contact_end.absolute", "1 N", " s "],
    );
    refuses(
        &with("first_frequency = { relative_to_peak = 1 }"),
        at,
        &["first_frequency.relative_to_peak", "no curve"],
    );
    refuses(&format!("{VALID}[tolerances.D]\nefficiency = 1"), at - 1, &["tolerances.D", "A, B, C"]);
    refuses(&format!("{VALID}[tolerances]\nB = 1"), at, &["tolerances.B", "table"]);
}

#[test]
fn missing_keys_are_named_with_what_to_add() {
    refuses(
        &edited("radius    = \"33 mm\"\n", ""),
        10,
        &["plate.radius", "missing", "33 mm", "greater than 0 m"],
    );
    refuses(&edited("name        = \"scaled-plate-r10\"\n", ""), 1, &["`name`", "missing"]);
    refuses(
        &edited("poisson_ratio  = 0.3\n", ""),
        5,
        &["materials.steel.poisson_ratio", "missing", "less than 0.5"],
    );
    refuses(&edited("speed    = \"550 mm/s\"\n", ""), 16, &["outer.speed", "missing", "550 mm/s"]);
    let table = "[inner]\nkind     = \"sphere\"\nradius   = \"10 mm\"\nmaterial = \"steel\"\n";
    refuses(&edited(table, ""), 1, &["`inner`", "missing", "[inner]"]);
}

#[test]
fn words_are_checked() {
    let material = "material  = \"steel\"";
    refuses(
        &edited(material, "material = \"stel\""),
        14,
        &["plate.material", "stel", "did you mean `steel`"],
    );
    refuses(&edited(material, "material = \"brass\""), 14, &["plate.material", "brass", "there is: steel"]);
    refuses(&edited("clamped", "glued"), 13, &["plate.edge", "glued", "clamped, simply-supported, free"]);
    refuses(&edited("model = \"B\"", "model = \"D\""), 28, &["reduced.model", "\"D\"", "A, B, C"]);
    refuses(
        &edited("axisymmetric", "axisymetric"),
        32,
        &["reference.geometry", "did you mean `axisymmetric`"],
    );
    for name in ["", "../x", "a/b", ".hidden", "a b", "a\\\\b", "\u{e4}"] {
        refuses(&edited("scaled-plate-r10", name), 1, &["`name`", "A-Z a-z 0-9", "dot"]);
    }
    refuses(&edited("scaled-plate-r10", &"x".repeat(101)), 1, &["`name`", "1 to 100"]);
    refuses(&edited("\"scaled-plate-r10\"", "3"), 1, &["`name`", "is 3", "text"]);
}

#[test]
fn shear_thinning_is_given_in_full_or_not_at_all() {
    let fluid = |keys: &str| {
        let water = "[fluid]\nviscosity = 1e-3\ndensity = 1e3\nminimum_gap = 1e-6";
        edited("[reduced]", &format!("{water}\n{keys}\n[reduced]"))
    };
    let law = "relaxation_time = 1\npower_index = 0.5";
    assert!(Scene::parse("scene.toml", &fluid(&format!("infinite_shear_viscosity = 1e-4\n{law}"))).is_ok());
    refuses(&fluid(law), 27, &["fluid.infinite_shear_viscosity", "missing"]);
    let said = Scene::parse("scene.toml", &fluid(&format!("infinite_shear_viscosity = 1\n{law}")));
    let said = said.expect_err("thickening").to_string();
    assert!(said.contains("fluid.infinite_shear_viscosity") && said.contains("0.001 Pa*s"), "{said}");
}

#[test]
fn all_faults_are_reported_at_once_in_the_order_of_the_file() {
    let text = edited("\"33 mm\"", "-1").replace("\"550 mm/s\"", "nan").replace("modes", "mode");
    let lines: Vec<usize> = refused(&text).iter().map(|p| p.line).collect();
    assert_eq!(lines, [11, 20, 29]);
}

#[test]
fn text_that_is_not_toml_is_refused_with_its_line() {
    refuses(&edited("\n[outer]", "radius = 1\n[outer]"), 15, &["not valid TOML", "duplicate key"]);
    refuses(&edited("[outer]", "[plate]\n[outer]"), 16, &["not valid TOML", "duplicate key"]);
    refuses(&edited("\"33 mm\"", "\"33 mm"), 11, &["not valid TOML"]);
    refuses(&edited("\"33 mm\"", "33 mm"), 11, &["not valid TOML"]);
    let deep = format!("x = {}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(Scene::parse("deep.toml", &deep).is_err());
}

/// The valid scene without settings of its reference, with further keys of the outer body.
fn struck(keys: &str) -> String {
    let (physics, _) = VALID.split_once("[reference]").expect("settings");
    let speed = "speed    = \"550 mm/s\"";
    assert!(physics.contains(speed));
    physics.replace(speed, &format!("{speed}\n{keys}"))
}

#[test]
fn an_off_centre_or_oblique_impact_is_solved_in_three_dimensions() {
    let scene = parse(&struck("offset = \"2 mm\"\nangle = \"-30 deg\""));
    let outer = &plate_impact(&scene).outer;
    assert_eq!((outer.offset, outer.is_centred()), (0.002, false));
    assert!((outer.angle + std::f64::consts::FRAC_PI_6).abs() < 1e-15);
    assert_eq!(scene.reference.geometry, Geometry::Solid);
    assert_eq!(scene.reference.elements_per_contact_radius, Some(3.0));
    // said or not: what is zero is what it always was
    let centred = parse(&struck("offset = 0\nangle = 0"));
    assert_eq!((centred.hash(), centred.reference.geometry), (parse(VALID).hash(), Geometry::Axisymmetric));
    assert_ne!(scene.hash(), centred.hash());
}

#[test]
fn an_unsupported_off_centre_impact_is_refused() {
    for (text, words) in [
        (struck("offset = \"-1 mm\""), "outer.offset"),
        (struck("offset = \"33 mm\""), "less than `plate.radius`"),
        (struck("angle = \"90 deg\""), "outer.angle"),
        (struck("offset = 0.001").replace("edge ", "damping_ratio = 0.1\nedge "), "undamped"),
        (struck("angle = 0.1") + "\n[reference]\ngeometry = \"axisymmetric\"", "no axis of symmetry"),
    ] {
        let error = Scene::parse("plate-impact.toml", &text).expect_err(words).to_string();
        assert!(error.contains(words), "{error}");
    }
}
