//! Impacts without a plate from the command line: the starter, sweeps, uncertainty, what lacks a stored reference, imports.

use assert_cmd::Command;
use std::fs;
use std::path::Path;

/// Runs a command in `folder`; what it prints, both streams.
fn run(folder: &Path, arguments: &[&str], status: i32) -> String {
    let mut command = Command::cargo_bin("impactcheck").unwrap();
    command.args(arguments).current_dir(folder).env("IMPACTCHECK_STORE", folder.join("store"));
    let output = command.env("IMPACTCHECK_PYTHON", "/no/such/python3").output().unwrap();
    let said =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned()).concat();
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {said}");
    said
}

/// A folder with the starter scene `wall.toml`.
fn starter() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["new", "wall", "--kind", "impact"], 0);
    folder
}

#[test]
fn a_reference_that_is_missing_is_computed_by_the_command_that_the_message_names() {
    let folder = starter();
    for arguments in [&["compare", "wall.toml"][..], &["gate", "wall.toml"]] {
        let said = run(folder.path(), arguments, 11);
        assert!(said.contains("is missing") && said.contains("reference wall.toml"), "{said}");
    }
    // there is no Python here
    run(folder.path(), &["reference", "wall.toml"], 12);
}

/// The force peak of an elastic impact is compared with Hertz's.
#[test]
fn a_wall_is_covered_by_a_closed_form() {
    let folder = starter();
    let document = run(folder.path(), &["-q", "coverage", "wall.toml", "--json"], 0);
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    let features = document["features"].as_array().unwrap();
    let wall = features.iter().find(|feature| feature["feature"] == "wall").unwrap();
    let rows = wall["partners"].as_array().unwrap();
    let exact = rows.iter().find(|row| row["partner"] == "closed form").unwrap();
    assert!(exact["worst_relative"].as_f64().unwrap() < 1e-8, "{exact}");
}

/// Another program's curves without those that a wall lacks; the gate passes and can fail.
#[test]
fn an_imported_result_is_compared_and_shown() {
    let folder = starter();
    let file = folder.path().join("wall.toml");
    let text = fs::read_to_string(&file).unwrap();
    let tolerances = "\n[tolerances.C]\nouter_force_peak = 0.01\nouter_restitution = 0.01\n\
                      outer_impulse = { absolute = \"1 mN*s\" }\nouter_velocity_rms = { relative_to_peak = 0.01 }\n";
    fs::write(&file, text + tolerances).unwrap();
    run(folder.path(), &["reduced", "wall.toml", "--history", "ours.csv"], 0);
    run(folder.path(), &["reference", "import", "wall.toml", "--from", "ours.csv"], 0);
    let gate = ["gate", "wall.toml", "--resolution", "imported", "--out", "report"];
    let said = run(folder.path(), &gate, 0);
    assert!(said.contains("pass") && !said.contains("incomplete"), "{said}");
    let page = fs::read_to_string(folder.path().join("report/wall.html")).unwrap();
    for shown in ["outer_restitution", "outer_impulse", ">wall<", "The scene in section, to scale"] {
        assert!(page.contains(shown), "{shown}");
    }
    let curves = fs::read_to_string(folder.path().join("ours.csv")).unwrap();
    let force =
        curves.lines().next().unwrap().split(',').position(|name| name.starts_with("outer_force")).unwrap();
    let weaker: Vec<String> = curves
        .lines()
        .map(|line| {
            let cells = line.split(',').enumerate();
            let cell = |(k, cell): (usize, &str)| match (k == force, cell.parse::<f64>()) {
                (true, Ok(value)) => format!("{:e}", 0.95 * value),
                _ => cell.to_owned(),
            };
            cells.map(cell).collect::<Vec<_>>().join(",")
        })
        .collect();
    fs::write(folder.path().join("weaker.csv"), weaker.join("\n")).unwrap();
    let said = run(folder.path(), &["reference", "import", "wall.toml", "--from", "weaker.csv"], 11);
    assert!(said.contains("momentum"), "{said}");
}

#[test]
fn sweeps_and_uncertain_inputs_take_walls_and_leave_out_what_they_lack() {
    let folder = starter();
    let sweep =
        "scene = \"wall.toml\"\n[[vary]]\nfield = \"outer.speed\"\nvalues = [\"100 mm/s\", \"1 m/s\"]\n";
    fs::write(folder.path().join("speeds.toml"), sweep).unwrap();
    let said = run(folder.path(), &["study", "sweep", "speeds.toml"], 0);
    assert!(!said.contains("NaN"), "{said}");
    let table = fs::read_to_string(folder.path().join("speeds-sweep/sweep.csv")).unwrap();
    let heading: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let at = heading.iter().position(|name| name.starts_with("outer_force_peak")).expect("a column");
    let force: Vec<f64> =
        table.lines().skip(1).map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect();
    // Hertz: with the speed to the power 6/5
    assert!((force[1] / force[0] / 10.0_f64.powf(1.2) - 1.0).abs() < 1e-5, "{force:?}");

    let file = folder.path().join("wall.toml");
    let text = fs::read_to_string(&file).unwrap() + "\n[uncertainty]\n\"outer.speed\" = \"1 %\"\n";
    fs::write(&file, text).unwrap();
    let said = run(folder.path(), &["uncertainty", "wall.toml", "--samples", "64"], 0);
    assert!(said.contains("outer_force_peak") && !said.contains("efficiency"), "{said}");
}

/// A history of model C with another modulus of the sphere.
fn record(folder: &Path, scene: &str, modulus: &str) -> String {
    let text = fs::read_to_string(folder.join(scene)).unwrap();
    let other =
        text.replacen("name        = \"", "name        = \"other-", 1).replacen("210 GPa", modulus, 1);
    assert_ne!(text, other);
    fs::write(folder.join("other.toml"), other).unwrap();
    run(folder, &["reduced", "other.toml", "--history", "record.csv"], 0);
    fs::read_to_string(folder.join("record.csv")).unwrap()
}

/// A record of the rebound from a wall shows the restitution; the page has it. What a wall does not have is refused by name, and so is
/// energy out of nothing.
#[test]
fn records_of_a_rebound_show_the_restitution() {
    let folder = starter();
    let table = record(folder.path(), "wall.toml", "210 GPa");
    let compare = ["compare", "wall.toml", "--measured", "record.csv", "--out", "report"];
    let document = run(folder.path(), &[&["-q"], &compare[..], &["--json"]].concat(), 0);
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    let found = &document["measured"];
    assert!((found["restitution"]["mean"].as_f64().unwrap() - 1.0).abs() < 1e-3, "{found}");
    assert!(found["partners"][0]["restitution_difference"].as_f64().unwrap().abs() < 1e-3, "{found}");
    assert!(found["efficiency"].is_null() && found["partners"][0]["efficiency_difference"].is_null());
    let said = run(folder.path(), &compare, 0);
    assert!(said.contains("Measured restitution: 100.00 %") && said.contains("restitution, %"), "{said}");
    let page = fs::read_to_string(folder.path().join("report/wall-measured.html")).unwrap();
    assert!(page.contains(">restitution<") && !page.contains("Efficiency in %"));
    // there is no inner body to name
    assert!(page.contains(">outer</text>") && !page.contains(">inner</text>"));
    assert!(!page.contains("not determined"));

    let inner = table.lines().enumerate();
    let inner: String =
        inner.map(|(k, row)| format!("{row},{}\n", if k == 0 { "inner_velocity" } else { "0" })).collect();
    fs::write(folder.path().join("record.csv"), inner).unwrap();
    let said = run(folder.path(), &compare, 3);
    assert!(said.contains("`inner_velocity` is measured"), "{said}");

    // a body that comes back with 1.2 times its speed
    let mut rows = table.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let headings = rows.next().unwrap();
    let [time, velocity] =
        ["time", "outer_velocity"].map(|name| headings.iter().position(|other| *other == name).unwrap());
    let rows: Vec<[f64; 2]> = rows.map(|row| [time, velocity].map(|k| row[k].parse().unwrap())).collect();
    let end = rows.last().unwrap()[0];
    let flight = |from: f64, v: f64| (0..300).map(move |k| [from + 1e-6 * f64::from(k), v]);
    let fast = rows.iter().map(|[t, v]| [*t, -0.5 + 1.1 * (v + 0.5)]);
    let all = flight(-300e-6, -0.5).chain(fast).chain(flight(end + 1e-6, 0.6));
    let rows: String = all.map(|[t, v]| format!("{t},{v}\n")).collect();
    fs::write(folder.path().join("record.csv"), format!("time,outer_velocity\n{rows}")).unwrap();
    let said = run(folder.path(), &compare, 3);
    assert!(said.contains("no impact gives energy") && said.contains("outer body has 144"), "{said}");
}

/// Two bodies have one contact; the inner one shows the efficiency.
#[test]
fn records_of_two_bodies_show_the_efficiency() {
    let folder = starter();
    let text = fs::read_to_string(folder.path().join("wall.toml")).unwrap();
    let inner = "[inner]\nkind = \"sphere\"\nradius = \"8 mm\"\nmaterial = \"aluminium\"\n";
    let wall = "[wall]                           # or [plate]; without both the outer body strikes [inner]\n\
                material = \"aluminium\"           # or rigid = true\n";
    assert!(text.contains(wall));
    let text = text.replace(wall, inner).replace("\"wall\"", "\"two\"");
    fs::write(folder.path().join("two.toml"), text).unwrap();
    record(folder.path(), "two.toml", "210 GPa");
    let compare = ["-q", "compare", "two.toml", "--measured", "record.csv", "--out", "report", "--json"];
    let document = run(folder.path(), &compare, 0);
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    let found = &document["measured"];
    let expected = document["models"][0]["efficiency"].as_f64().unwrap();
    assert!((found["efficiency"]["mean"].as_f64().unwrap() - expected).abs() < 1e-3 * expected, "{found}");
    assert!(found["restitution"].is_null(), "{found}");
}

/// The modulus of a sphere that strikes a wall, from its motion.
#[test]
fn inputs_of_an_impact_on_a_wall_are_calibrated() {
    let folder = starter();
    record(folder.path(), "wall.toml", "180 GPa");
    let calibrate =
        ["calibrate", "wall.toml", "--over", "materials.steel.youngs_modulus", "--measured", "record.csv"];
    let document = run(folder.path(), &[&["-q"], &calibrate[..], &["--json"]].concat(), 0);
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    let value = document["inputs"][0]["value"].as_f64().unwrap();
    assert!((value / 180e9 - 1.0).abs() < 0.02, "{document}");
}
