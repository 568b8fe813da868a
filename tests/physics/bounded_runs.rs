//! Runs that have to stay short and bounded whatever the scene requests, and what their results say about themselves.

use approx::assert_relative_eq;
use impactcheck::ExitStatus;
use impactcheck::dynamics::integration::SAMPLES_BETWEEN;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::result::{Outcome, Summary};
use impactcheck::scene::{Model, Scene};

const TABLE_1: &str = r#"
name = "table-1"
kind = "plate-impact"
materials.steel = { youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = "7780 kg/m^3" }
plate = { radius = "33 mm", thickness = "2 mm", edge = "clamped", material = "steel" }
outer = { kind = "sphere", radius = "10 mm", material = "steel", speed = "550 mm/s" }
inner = { kind = "sphere", radius = "10 mm", material = "steel" }
"#;

fn model(text: &str, model: Model) -> Reduced {
    Reduced::new(&Scene::parse("scene.toml", text).expect("valid"), model, None).expect("a model")
}

fn summary(text: &str, which: Model) -> Summary {
    model(text, which).run(1e-7).expect("runs")
}

/// Table 1 with the lines that begin as `lines` do in their place.
fn changed(lines: &[&str]) -> String {
    let key = |line: &str| line.split('=').next().unwrap_or_default().to_owned();
    let unchanged = TABLE_1.lines().filter(|line| !lines.iter().any(|new| key(new) == key(line)));
    unchanged.chain(lines.iter().copied()).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_run_that_goes_on_for_seconds_after_its_impact_has_few_samples() {
    let short = model(TABLE_1, Model::B).run_with_history(1e-7).unwrap();
    let long = model(&changed(&["run = { end_time = \"10 s\" }"]), Model::B);
    let judged = long.run_judged(1e-7).unwrap();
    let recorded = long.run_with_history(1e-7).unwrap();
    assert!(judged.history.len() < 6_000, "{}", judged.history.len());
    assert!(recorded.history.len() < SAMPLES_BETWEEN + 2_000, "{}", recorded.history.len());
    assert_eq!(judged.summary.samples, None);
    assert_eq!(recorded.summary.samples, Some(recorded.history.len()));
    for Outcome { summary, history } in [&judged, &recorded] {
        for name in ["efficiency", "outer_force_peak", "inner_contact_end"] {
            assert_eq!(summary.value(name), short.summary.value(name), "{name}");
        }
        // free of forces the inner body flies on evenly
        let (time, z) = (&history.time, &history["inner_displacement"]);
        let [near, last] = [time.len() / 2, time.len() - 1];
        assert_relative_eq!(time[last], 10.0);
        let speed = (z[last] - z[near]) / (time[last] - time[near]);
        assert_relative_eq!(speed, summary.value("inner_velocity_final").unwrap(), max_relative = 1e-9);
    }
    // the impact itself is sampled as finely as without the flight
    let during = |outcome: &Outcome| outcome.history.time.iter().filter(|t| **t < 150e-6).count();
    assert_eq!(during(&recorded), during(&short));
}

#[test]
fn a_free_block_that_flies_to_the_inner_body_meets_it_when_it_has_crossed_the_gap() {
    let block = |gap: &str| {
        changed(&[
            "plate = { radius = \"50 mm\", thickness = \"25 mm\", edge = \"free\", material = \"steel\" }",
            "outer = { kind = \"sphere\", radius = \"5 mm\", material = \"steel\", speed = \"0.5 m/s\" }",
            &format!(
                "inner = {{ kind = \"sphere\", radius = \"5 mm\", material = \"steel\", gap = \"{gap}\" }}"
            ),
        ])
    };
    for (text, gap) in [(block("1 mm"), 1e-3), (block("10 mm"), 1e-2)] {
        let Outcome { summary, history } = model(&text, Model::B).run_judged(1e-7).unwrap();
        assert!(history.len() < 20_000, "{}", history.len());
        // the block's speed from the momentum that the outer body loses on it
        let [ball, block] = [4.0 / 3.0 * 0.005_f64.powi(3), 0.05_f64.powi(2) * 0.025];
        let speed = ball / block * (0.5 + summary.value("outer_velocity_final").unwrap());
        let arrival = summary.value("inner_contact_end").unwrap();
        assert_relative_eq!(arrival, gap / speed, max_relative = 0.01);
        assert_eq!(summary.value("inner_contacts"), Some(1.0));
    }
}

#[test]
fn a_squeeze_film_takes_a_share_of_the_energy_that_was_there() {
    let film = changed(&[
        "materials.titanium = { youngs_modulus = \"115 GPa\", poisson_ratio = 0.37, density = \"4430 kg/m^3\" }",
        "plate = { radius = \"5.5 mm\", thickness = \"0.3 mm\", edge = \"clamped\", material = \"titanium\" }",
        "outer = { kind = \"sphere\", radius = \"1.5 mm\", material = \"steel\", speed = \"50 mm/s\" }",
        "inner = { kind = \"sphere\", radius = \"1.5 mm\", material = \"steel\", gap = \"10 um\", speed = \"500 mm/s\" }",
        "fluid = { viscosity = \"10 mPa*s\", density = \"1000 kg/m^3\", minimum_gap = \"0.25 um\", squeeze_film = true }",
    ]);
    let summary = Reduced::new(&Scene::parse("film.toml", &film).unwrap(), Model::B, Some(4)).unwrap();
    let summary = summary.run(1e-4).unwrap();
    let text =
        summary.warnings.iter().find_map(|w| w.strip_prefix("the squeeze film dissipates ")).expect("told");
    let share: f64 = text.split(' ').next().unwrap().parse().unwrap();
    let mass = 4.0 / 3.0 * std::f64::consts::PI * 1.5e-3_f64.powi(3) * 7780.0;
    let all = 0.5 * mass * (0.05_f64.powi(2) + 0.5_f64.powi(2));
    assert_relative_eq!(share, 100.0 * summary.losses.unwrap().squeeze_film / all, max_relative = 0.01);
    assert!(share < 100.0);
}

/// A soft light body before a thick sapphire plate, whose heavy inner body gets some 1e-13 N.
#[test]
fn a_contact_that_does_not_count_is_not_one_that_never_was() {
    let faint = changed(&[
        "materials.sapphire = { youngs_modulus = \"350 GPa\", poisson_ratio = 0.27, density = \"3980 kg/m^3\" }",
        "materials.soft = { youngs_modulus = \"1 MPa\", poisson_ratio = 0.49, density = \"1000 kg/m^3\" }",
        "plate = { radius = \"25 mm\", thickness = \"90 mm\", edge = \"simply-supported\", material = \"sapphire\" }",
        "outer = { kind = \"compact\", mass = \"58 mg\", tip_radius = \"1.4 mm\", material = \"soft\", speed = \"5 mm/s\" }",
        "inner = { kind = \"compact\", mass = \"5.3 g\", tip_radius = \"5 mm\", material = \"steel\" }",
    ]);
    let faint = summary(&faint, Model::B);
    let has = |summary: &Summary, words: &str| summary.warnings.iter().any(|w| w.contains(words));
    assert!(faint.value("inner_force_peak").unwrap() > 0.0 && faint.value("inner_contacts") == Some(0.0));
    assert!(!has(&faint, "are never in contact"), "{:?}", faint.warnings);
    assert!(
        has(&faint, "inner body and the plate are in contact with an impulse of"),
        "{:?}",
        faint.warnings
    );
    assert!(has(&faint, "less than the"), "{:?}", faint.warnings);
    let far =
        changed(&["inner = { kind = \"sphere\", radius = \"10 mm\", material = \"steel\", gap = \"5 mm\" }"]);
    let far = summary(&far, Model::B);
    assert!(
        far.value("inner_force_peak") == Some(0.0) && has(&far, "are never in contact"),
        "{:?}",
        far.warnings
    );
}

#[test]
fn a_rod_is_refused_as_a_plate() {
    let rod = |thickness: &str| {
        let plate = format!(
            "plate = {{ radius = \"33 mm\", thickness = \"{thickness}\", edge = \"clamped\", material = \"steel\" }}"
        );
        Scene::parse("rod.toml", &changed(&[&plate]))
    };
    assert!(rod("300 mm").is_ok());
    let refused = rod("1650 mm").expect_err("50 times as thick").to_string();
    assert!(refused.contains("`plate.thickness` is 50.0 times `plate.radius`"), "{refused}");
}

#[test]
fn a_bender_bent_beyond_linear_theory_is_warned_of() {
    let text = std::fs::read_to_string("scenes/validation/bender.toml").unwrap();
    let limit = |speed: &str| {
        let summary = summary(&text.replace("300 mm/s", speed), Model::B);
        let limit = summary.limits.iter().find(|l| l.measure == "outer_tip_deflection_over_length");
        let warned = summary.warnings.iter().any(|w| w.contains("linear beam theory"));
        let deflection = summary.bender.expect("a bender").drive.tip_deflection;
        assert_relative_eq!(limit.expect("a limit").value, deflection / 13.7e-3, max_relative = 1e-12);
        (deflection / 13.7e-3, warned)
    };
    let (little, warned) = limit("300 mm/s");
    assert!((0.005..0.02).contains(&little) && !warned, "{little} {warned}");
    // deflection and speed grow together
    let (much, warned) = limit("12 m/s");
    assert_relative_eq!(much, 40.0 * little, max_relative = 1e-9);
    assert!(warned);
}

const STACK: &str = r#"outer = { kind = "stack", length = "18 mm", area = "25 mm^2", stroke = "17.4 um", blocked_force = "850 N", voltage = "150 V", capacitance = "1.4 uF", density = "8000 kg/m^3", tip_radius = "4 mm", gap = "3 um", material = "steel""#;

fn stack_scene(drive: &str) -> String {
    changed(&[
        "plate = { radius = \"5.5 mm\", thickness = \"0.3 mm\", edge = \"clamped\", material = \"steel\" }",
        &format!("{STACK}{drive} }}"),
        "inner = { kind = \"sphere\", radius = \"1.5 mm\", material = \"steel\" }",
    ])
}

fn stack(drive: &str) -> Summary {
    summary(&stack_scene(drive), Model::B)
}

/// The heat of the resistor closes the balance although its current decays 1e5 times as quickly as the rod vibrates.
#[test]
fn without_resistance_a_drive_is_an_ideal_source() {
    let ideal = stack("");
    let drive = stack(", drive = { resistance = \"1e-6 Ohm\" }");
    for name in ["inner_velocity_final", "outer_force_peak", "inner_force_peak"] {
        assert_relative_eq!(drive.value(name).unwrap(), ideal.value(name).unwrap(), max_relative = 1e-5);
    }
    assert!(drive.energy_residual.unwrap() < 1e-8, "{:?}", drive.energy_residual);
}

/// A stack that charges slowly comes to the plate at (stroke - gap)/(R C), once the impact has nothing to do with the wave in it.
#[test]
fn with_much_resistance_a_drive_comes_to_nothing() {
    for resistance in [1e4, 1e5] {
        let drive = stack(&format!(", drive = {{ resistance = {resistance} }}"));
        let speed = (17.4e-6 - 3e-6) / (resistance * 1.4e-6);
        let inner = -drive.value("inner_velocity_final").unwrap() / speed;
        // a body at rest before one that is held at its speed leaves with up to twice that
        assert!((0.5..2.0).contains(&inner), "{resistance} Ohm: {inner} times the tip's speed");
        assert!(drive.steps.unwrap() < 5_000 && drive.energy_residual.unwrap() < 1e-8, "{drive:?}");
    }
    let text = stack_scene(", drive = { resistance = 1e6 }");
    let refused = Scene::parse("stack.toml", &text).expect_err("presses");
    let said = refused.to_string();
    // 1e5 radians of a rod fixed at one end, omega = pi c/(2 L) but for lateral inertia, over its capacitance
    let wave_speed = (850.0 * 18e-3 / (17.4e-6 * 25e-6 * 8000.0_f64)).sqrt();
    let most = 1e5 * 2.0 * 18e-3 / (std::f64::consts::PI * wave_speed * 1.4e-6);
    assert!(said.contains("`outer.drive.resistance` is 1000000 Ohm"), "{said}");
    assert!(said.contains(&format!("at most {most:.1e}")), "{said}");
    assert_eq!(refused.exit_status(), ExitStatus::InvalidScene);
}

/// A thin soft plate under bodies that rest on patches wider than it is thick: its residual flexibility holds for tiny patches alone.
#[test]
fn contacts_on_a_plate_thinner_than_their_patches_find_an_equilibrium() {
    let thin = changed(&[
        "materials.foam = { youngs_modulus = \"20 MPa\", poisson_ratio = -0.7, density = \"300 kg/m^3\" }",
        "materials.outer = { youngs_modulus = \"45 GPa\", poisson_ratio = 0.29, density = \"1740 kg/m^3\" }",
        "materials.inner = { youngs_modulus = \"1 GPa\", poisson_ratio = -0.3, density = \"800 kg/m^3\" }",
        "plate = { radius = \"1.19 mm\", thickness = \"8 um\", edge = \"simply-supported\", material = \"foam\" }",
        "outer = { kind = \"sphere\", radius = \"0.5 mm\", material = \"outer\", speed = \"187 mm/s\" }",
        "inner = { kind = \"sphere\", radius = \"2 mm\", material = \"inner\", gap = \"60 nm\", speed = \"-48 mm/s\" }",
    ]);
    let summary = summary(&thin, Model::C);
    assert!(summary.energy_residual.unwrap() < 1e-6, "{summary:?}");
    assert!(
        summary.warnings.iter().any(|w| w.contains("is treated as a flat punch")),
        "{:?}",
        summary.warnings
    );
}

/// A contact that turns from loading to unloading within a step has the slope of the other side; the plate under it answers to both contacts.
#[test]
fn plastic_contacts_find_an_equilibrium_at_greatest_approach() {
    let yielding = changed(&[
        "materials.plate = { youngs_modulus = \"200 GPa\", poisson_ratio = 0.29, density = \"8000 kg/m^3\", yield_strength = 243947438.23819935, hardening = 661610720.1682781 }",
        "materials.outer = { youngs_modulus = \"200 GPa\", poisson_ratio = 0.29, density = \"8000 kg/m^3\", yield_strength = 1156215417.73127, hardening = 266887355.42799073 }",
        "materials.inner = { youngs_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7780 kg/m^3\", yield_strength = 108466497.48327512, hardening = 2278525.998847318 }",
        "plate = { radius = 0.02513682252638036, thickness = 0.0005031661358841898, edge = \"clamped\", material = \"plate\" }",
        "outer = { kind = \"sphere\", radius = 0.014936745048570552, material = \"outer\", speed = 0.29261253766465206 }",
        "inner = { kind = \"sphere\", radius = 0.008460648395654195, material = \"inner\", gap = 8.821949844718564e-06 }",
    ]);
    let summary = summary(&yielding, Model::C);
    assert!(summary.energy_residual.unwrap() < 1e-3, "{summary:?}");
}
