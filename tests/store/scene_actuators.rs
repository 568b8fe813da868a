//! Reading of outer bodies that drive themselves: bender, magnet, stack.

use super::scene_reading::{VALID, edited, parse, plate_impact, refused, refuses};
use impactcheck::ExitStatus;
use impactcheck::scene::{Scene, Shape};

#[test]
fn a_bender_is_an_outer_body_only() {
    let at = VALID.rfind("\"sphere\"").expect("inner body");
    let inner = format!("{}\"bender\"{}", &VALID[..at], &VALID[at + 8..]);
    refuses(&inner, 23, &["inner.kind", "bender", "sphere, compact"]);
}

#[test]
fn a_bender_is_given_in_exactly_one_way() {
    let bender = |keys: &str| {
        let fixed = "kind = \"bender\"\nlength = 0.0137\ntip_mass = 128e-6\ntip_radius = 0.004";
        let text = edited("kind     = \"sphere\"\nradius   = \"10 mm\"", &format!("{fixed}\n{keys}"));
        text.replacen("speed    = \"550 mm/s\"\n", "", 1)
    };
    let measured = "first_frequency = 500\ntip_stiffness = 2500";
    assert!(Scene::parse("scene.toml", &bender(&format!("{measured}\nspeed = 0.55"))).is_ok());
    refuses(
        &bender(measured),
        16,
        &["the drive is missing", "outer.torque", "outer.tip_deflection", "outer.speed"],
    );
    refuses(
        &bender(&format!("{measured}\ntorque = 4e-3\nspeed = 0.55")),
        24,
        &["outer.torque", "outer.speed", "both"],
    );
    refuses(&bender("first_frequency = 500\nspeed = 0.55"), 16, &["outer.tip_stiffness", "missing", "N/m"]);
    refuses(&bender("speed = 0.55"), 16, &["stiffness and mass", "outer.line_mass", "outer.first_frequency"]);
    let negative = bender(&format!("{measured}\nspeed = 0.55\ndischarge_time = -1"));
    refuses(&negative, 24, &["outer.discharge_time", "at least 0 s"]);
    let foreign = bender(&format!("{measured}\nspeed = 0.55\nradius = 1"));
    refuses(&foreign, 24, &["outer.radius", "bender", "sphere"]);
    // too heavy a tip for the frequency: the bound is k/omega^2
    let heavy = bender("first_frequency = 500\ntip_stiffness = 1000\nspeed = 0.55");
    let said = Scene::parse("scene.toml", &heavy).expect_err("no beam").to_string();
    assert!(said.contains("outer.tip_mass") && said.contains("1.013212e-4 kg"), "{said}");
}

#[test]
fn a_bender_s_circuit_and_offset() {
    let bender = |keys: &str| {
        let fixed = "kind = \"bender\"\nlength = 0.0137\ntip_mass = 128e-6\ntip_radius = 0.004\nfirst_frequency = 500\ntip_stiffness = 2500";
        let text = edited("kind     = \"sphere\"\nradius   = \"10 mm\"", &format!("{fixed}\n{keys}"));
        text.replacen("speed    = \"550 mm/s\"\n", "", 1)
    };
    let outer = |keys: &str| plate_impact(&parse(&bender(keys))).outer.clone();
    let circuit = outer("speed = 0.5\ncapacitance = \"50 nF\"\ndischarge_resistance = \"1 kOhm\"");
    let time = outer("speed = 0.5\ndischarge_time = \"50 us\"");
    let (Shape::Bender(circuit), Shape::Bender(time)) = (circuit.shape, time.shape) else {
        panic!("benders")
    };
    assert!((circuit.discharge_time / time.discharge_time - 1.0).abs() < 1e-12);
    refuses(&bender("speed = 0.5\ncapacitance = 5e-8"), 16, &["outer.discharge_resistance", "missing"]);
    let both = bender("speed = 0.5\ncapacitance = 5e-8\ndischarge_resistance = 1000\ndischarge_time = 1e-4");
    assert!(refused(&both)[0].message.contains("both give the discharge"), "{:?}", refused(&both));
    // the torque that gives a speed at an offset gives it
    let by_speed = outer("speed = 0.5\noffset = \"60 um\"");
    let Shape::Bender(bent) = by_speed.shape else { panic!("a bender") };
    assert!(bent.strike_at > 0.2 && bent.strike_at < 0.6, "{bent:?}");
    let far =
        Scene::parse("scene.toml", &bender("tip_deflection = 1e-4\noffset = 2e-4")).expect_err("too far");
    assert_eq!(far.exit_status(), ExitStatus::InvalidScene);
    assert!(
        far.to_string().contains("`outer.offset` is 0.0002 m") && far.to_string().contains("9.0000e-5 m"),
        "{far}"
    );
}

#[test]
fn a_magnet_is_a_compact_body_with_the_speed_of_its_plunger() {
    let magnet = |stop: &str| {
        let keys = format!(
            "kind = \"magnet\"\nmass = \"5 g\"\ntip_radius = 0.004\nvoltage = \"12 V\"\nresistance = \"8 Ohm\"\ninductance = \"20 mH\"\nstop_inductance = \"{stop}\"\ntravel = \"2 mm\""
        );
        edited("kind     = \"sphere\"\nradius   = \"10 mm\"", &keys).replacen(
            "speed    = \"550 mm/s\"\n",
            "",
            1,
        )
    };
    let setup = plate_impact(&parse(&magnet("60 mH"))).clone();
    assert!(matches!(setup.outer.shape, Shape::Compact { mass: 0.005, tip_radius: 0.004 }));
    assert!(setup.outer.speed > 0.1 && setup.outer.speed < 5.0, "{}", setup.outer.speed);
    let said = Scene::parse("scene.toml", &magnet("10 mH")).expect_err("no pull").to_string();
    assert!(said.contains("`outer.stop_inductance` is 0.01 H") && said.contains("0.02 H"), "{said}");
}

/// A curve of what the law gives strikes as fast as the law; one that can't be is told.
#[test]
fn a_magnet_pulls_by_a_curve() {
    let magnet = |pull: &str| {
        let keys = format!(
            "kind = \"magnet\"\nmass = 0.005\ntip_radius = 0.004\nvoltage = 12\nresistance = 8\ninductance = 0.02\ntravel = 0.002\n{pull}"
        );
        let text = edited("kind     = \"sphere\"\nradius   = \"10 mm\"", &keys);
        text.replacen("speed    = \"550 mm/s\"\n", "", 1)
    };
    let speed = |pull: &str| plate_impact(&parse(&magnet(pull))).outer.speed;
    let law = speed("stop_inductance = 0.06");
    let curve = |key: &str, of: &dyn Fn(f64) -> f64| {
        let points = (0..=20)
            .map(|k| 1e-4 * f64::from(k))
            .map(|way| format!("{{ way = {way:?}, {key} = {:?} }}", of(way)));
        format!("curve = [{}]", points.collect::<Vec<_>>().join(", "))
    };
    let inductance =
        |way: f64| if way == 0.0 { 0.02 } else { 1.0 / (50.0 - way / 0.002 * (50.0 - 1.0 / 0.06)) };
    let force = |way: f64| 0.5 * inductance(way).powi(2) * (50.0 - 1.0 / 0.06) / 0.002;
    for pull in [curve("inductance", &inductance), curve("force", &force)] {
        assert!((speed(&pull) / law - 1.0).abs() < 2e-3, "{} {law}", speed(&pull));
    }
    for (pull, expected) in [
        ("curve = [{ way = 0, force = 1 }, { way = 0.001, force = 2 }]", "0 to `outer.travel`, 0.002 m"),
        ("curve = [{ way = 0, force = 1 }, { way = 0.002, inductance = 0.06 }]", "of one kind"),
        (
            "curve = [{ way = 0, force = 1 }, { way = 0, force = 1 }, { way = 0.002, force = 2 }]",
            "the way 0 m after 0 m",
        ),
        (
            "curve = [{ way = 0, inductance = 0.02 }, { way = 0.002, inductance = 0.01 }]",
            "0.01 H after 0.02 H",
        ),
        (
            "curve = [{ way = 0, inductance = 0.03 }, { way = 0.002, inductance = 0.04 }]",
            "begins with 0.03 H",
        ),
    ] {
        let said = Scene::parse("scene.toml", &magnet(pull)).expect_err(pull).to_string();
        let words = said.split(|c: char| c.is_whitespace() || c == '│').filter(|word| !word.is_empty());
        let said = words.collect::<Vec<_>>().join(" ");
        assert!(said.contains("`outer.curve`") && said.contains(expected), "{pull}: {said}");
    }
    refuses(&magnet(""), 16, &["the pull is missing", "outer.stop_inductance", "outer.curve"]);
}

#[test]
fn an_impossible_stack_is_an_error() {
    let stack = |from: &str, to: &str| {
        let keys = "kind = \"stack\"\nlength = 0.018\narea = 25e-6\nstroke = 17.4e-6\nblocked_force = 850\nvoltage = 150\ncapacitance = 1.4e-6\ndensity = 8000\ntip_radius = 0.004";
        let keys = keys.replacen(from, to, 1);
        let text = edited("kind     = \"sphere\"\nradius   = \"10 mm\"", &keys);
        text.replacen("speed    = \"550 mm/s\"\n", "", 1)
    };
    assert!(Scene::parse("scene.toml", &stack("", "")).is_ok());
    let both = stack("density = 8000", "density = 8000\nfirst_frequency = 3e4");
    refuses(&both, 25, &["outer.density", "outer.first_frequency", "both", "inertia"]);
    refuses(&stack("density = 8000\n", ""), 16, &["inertia is missing", "outer.first_frequency"]);
    refuses(
        &stack("blocked_force = 850", "blocked_force = 0"),
        21,
        &["outer.blocked_force", "greater than 0 N"],
    );
    refuses(&stack("voltage = 150", "voltage = \"150 N\""), 22, &["outer.voltage", "V"]);
    refuses(&stack("density = 8000", "density = 8000\nspeed = 1"), 25, &["outer.speed", "stack"]);
    let drive = stack("density = 8000", "density = 8000\ndrive = { buffer_capacitance = 1e-5 }");
    refuses(&drive, 25, &["outer.drive.resistance", "missing", "Ohm"]);
    for (from, to, parts) in [
        ("capacitance = 1.4e-6", "capacitance = 0.6e-6", ["outer.capacitance", "6.5733e-7 F"]),
        ("density = 8000", "density = 8000\ngap = 36e-6", ["outer.gap", "3.4800e-5 m"]),
        ("density = 8000", "density = 8000\ngap = 36e-6", ["outer.gap", "never reaches"]),
    ] {
        let error = Scene::parse("scene.toml", &stack(from, to)).expect_err("no stack");
        assert_eq!(error.exit_status(), ExitStatus::InvalidScene);
        let said = error.to_string();
        assert!(parts.iter().all(|part| said.contains(part)), "{said}");
    }
}
