//! The four verdicts at the gate: what passes, fails, is undecided because the reference's band is too wide, or not gated.

use assert_cmd::Command;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Output;

const SCENE: &str = include_str!("../../scenes/scaled-plate-r6.35.toml");

/// The shipped scene with these tolerances only, in a folder of its own.
fn scene(tolerances: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.toml");
    let (scene, _) = SCENE.split_once("# The gate.").unwrap();
    std::fs::write(&file, format!("{scene}{tolerances}")).unwrap();
    (folder, file)
}

fn gate(file: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("impactcheck")
        .unwrap()
        .args(["gate", "--models", "B", "--json", "--quiet", "--out"])
        .arg(file.with_file_name("report"))
        .arg(file)
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env_remove("GITHUB_ACTIONS")
        .output()
        .unwrap()
}

fn status_and_said(output: &Output) -> (i32, String) {
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn document(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

fn junit(file: &Path) -> String {
    std::fs::read_to_string(file.with_file_name("report").join("junit.xml")).unwrap()
}

#[test]
fn a_scene_without_tolerances_has_not_passed() {
    let (_folder, file) = scene("");
    let output = gate(&file, &[]);
    let document = document(&output);
    let model = &document["scenes"][0]["models"][0];
    for verdict in [&document["verdict"], &model["verdict"], &model["discrepancies"][0]["verdict"]] {
        assert_eq!(verdict, "not_gated");
    }
    let (status, said) = status_and_said(&output);
    let expected = "nothing of scene `scaled-plate-r6.35` is gated";
    assert!(status == 0 && said.contains(&format!("warning: {expected}")), "{said}");
    assert!(!junit(&file).contains("<failure"));

    // tolerances of another model gate nothing either
    let (_folder, file) = scene("[tolerances.C]\nefficiency = 0.01\n");
    let (status, said) = status_and_said(&gate(&file, &["--require-tolerances"]));
    assert!(status == 10 && said.contains(&format!("error: {expected}")), "{said}");
    assert!(junit(&file).contains("they are required"));
}

/// Model B is off by 0.0248; the reference knows its efficiency to 0.0004.
#[test]
fn a_row_within_the_uncertainty_is_undecided_and_an_option_sets_how_it_counts() {
    let (_folder, file) = scene("[tolerances.B]\nefficiency = { absolute = 0.0246 }\n");
    let warned = gate(&file, &[]);
    let found = document(&warned);
    assert_eq!(
        (&found["verdict"], &found["scenes"][0]["verdict"]),
        (&"undecided".into(), &"undecided".into())
    );
    let row = &found["scenes"][0]["models"][0]["discrepancies"][0];
    let number = |key: &str| row[key].as_f64().unwrap();
    assert!((number("difference").abs() - number("tolerance")).abs() < number("uncertainty"));
    let how = row["would_decide"].as_str().unwrap();
    assert!(how.contains("--target-error 0.") && how.contains("--resolution"), "{how}");
    assert!(found["scenes"][0]["models"][0]["discrepancies"][1].get("would_decide").is_none());
    let (status, said) = status_and_said(&warned);
    assert!(status == 0 && said.contains("warning: scene `scaled-plate-r6.35` is undecided"), "{said}");
    let report = file.with_file_name("report");
    let read = |name: &str| std::fs::read_to_string(report.join(name)).unwrap();
    assert!(read("junit.xml").contains("<skipped message=\"efficiency: model"));
    assert!(read("comparison.md").starts_with("# impactcheck: undecided"));
    assert!(read("comparison.md").contains(how));
    for page in ["index.html", "scaled-plate-r6.35.html"] {
        assert!(read(page).contains("<span class=\"verdict undecided\">undecided</span>"), "{page}");
    }
    assert!(read("scaled-plate-r6.35.html").contains(how));

    let (status, said) = status_and_said(&gate(&file, &["--undecided", "fail"]));
    assert!(status == 10 && said.contains("error: scene `scaled-plate-r6.35` is undecided"), "{said}");
    assert!(read("junit.xml").contains("<failure message=\"efficiency: model"));
    let (status, said) = status_and_said(&gate(&file, &["--undecided", "pass"]));
    assert!(status == 0 && !said.contains("undecided"), "{said}");
    assert_eq!(status_and_said(&gate(&file, &["--undecided", "maybe"])).0, 2);
}

/// A result of another program that states velocities alone is the reference.
#[test]
fn a_tolerance_without_a_value_to_compare_with_is_undecided_and_fails_where_tolerances_are_required() {
    let tolerances = "[tolerances.B]\nefficiency = { absolute = 0.01 }\nouter_force_peak = { relative = 0.2 }\nouter_force_rms = { relative_to_peak = 0.2 }\n";
    let (folder, file) = scene(tolerances);
    let run = |arguments: &[&str]| {
        let mut command = Command::cargo_bin("impactcheck").unwrap();
        command.args(arguments).current_dir(&folder).env_remove("GITHUB_ACTIONS");
        command.env("IMPACTCHECK_STORE", folder.path().join("store")).output().unwrap()
    };
    let reduced = run(&["reduced", "scene.toml", "--model", "B", "--history", "all.csv"]);
    assert!(reduced.status.success(), "{reduced:?}");
    let all = std::fs::read_to_string(folder.path().join("all.csv")).unwrap();
    let rows: Vec<Vec<&str>> = all.lines().map(|line| line.split(',').collect()).collect();
    let of = |name: &str| rows[0].iter().position(|heading| *heading == name).unwrap();
    let columns = ["time", "outer_velocity", "inner_velocity"].map(of);
    let row = |row: &Vec<&str>| columns.map(|k| row[k]).join(",");
    let mut text = rows.iter().map(row).collect::<Vec<_>>().join("\n");
    // both bodies fly on
    let last = rows.last().unwrap();
    let end: f64 = last[columns[0]].parse().unwrap();
    for k in 1..=rows.len() / 10 {
        text += &format!("\n{},{},{}", end + 1e-7 * k as f64, last[columns[1]], last[columns[2]]);
    }
    std::fs::write(folder.path().join("velocities.csv"), text).unwrap();
    let imported = run(&["reference", "import", "scene.toml", "--from", "velocities.csv"]);
    assert!(imported.status.success(), "{}", String::from_utf8_lossy(&imported.stderr));

    let gate = |rules: &[&str]| {
        let arguments = ["gate", "scene.toml", "--models", "B", "--resolution", "imported", "--json"];
        let output = run(&[&arguments[..], rules, &["--out", "report"]].concat());
        (document(&output), status_and_said(&output))
    };
    let expected = "B.outer_force_peak, B.outer_force_rms";
    let (found, (status, said)) = gate(&[]);
    assert!(status == 0 && said.contains("warning: ") && said.contains(expected), "{said}");
    let rows = found["scenes"][0]["models"][0]["discrepancies"].as_array().unwrap();
    let verdict = |name: &str| &rows.iter().find(|row| row["quantity"] == name).unwrap()["verdict"];
    assert_eq!(found["verdict"], "undecided");
    assert_eq!(
        ["efficiency", "outer_force_peak", "outer_force_rms", "inner_force_rms"].map(verdict),
        ["pass", "undecided", "undecided", "not_gated"]
    );
    for rules in [
        &["--require-tolerances"][..],
        &["--undecided", "fail"],
        &["--require-tolerances", "--undecided", "pass"],
    ] {
        let (_, (status, said)) = gate(rules);
        assert!(status == 10 && said.contains("error: ") && said.contains(expected), "{rules:?}: {said}");
        let failure = "<failure message=\"outer_force_peak: model";
        assert!(junit(&file).contains(failure) && junit(&file).contains("has no value of it"), "{rules:?}");
    }
    assert_eq!(gate(&["--undecided", "pass"]).1.0, 0);
}
