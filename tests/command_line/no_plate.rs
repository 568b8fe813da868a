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
