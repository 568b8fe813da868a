//! CalculiX's solution beside the reference: shown, asked for, missing, contradicting itself, disagreeing.

use crate::sealed::{change_summary, copy_shipped};
use assert_cmd::Command;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const SCENE: &str = "scaled-plate-r10";
const ENTRY: &str = "scaled-plate-r10/calculix-paper";

struct Ended {
    status: i32,
    said: String,
    printed: String,
}

fn run(store: &Path, arguments: &[&str]) -> Ended {
    let mut command = Command::cargo_bin("impactcheck").unwrap();
    command.args(arguments).arg("--store").arg(store).current_dir(ROOT).env("IMPACTCHECK_CCX", "no-such-ccx");
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Ended { status: output.status.code().unwrap(), said: text(&output.stderr), printed: text(&output.stdout) }
}

fn compared(store: &Path, more: &[&str]) -> Ended {
    let out = store.join("report").display().to_string();
    run(store, &[&["compare", SCENE, "--models", "C", "--out", &*out], more].concat())
}

/// A copy of the shipped solution in `store`, whose summary `change` makes another one; its checksum is right.
fn changed(store: &Path, change: impl Fn(&mut Value)) {
    copy_shipped(ENTRY, &store.join(ENTRY));
    change_summary(&store.join(ENTRY), change);
}

/// The plate's frequency as if its mesh series had given `factor` times as much.
fn scaled(summary: &mut Value, factor: f64) {
    let scale = |value: &mut Value| *value = json!(value.as_f64().unwrap() * factor);
    scale(&mut summary["first_frequency"]);
    scale(&mut summary["uncertainty"]["first_frequency"]);
    let series = &mut summary["convergence"]["quantities"]["first_frequency"];
    series["values"].as_array_mut().unwrap().iter_mut().for_each(scale);
    ["extrapolated", "scatter", "band"].into_iter().for_each(|key| scale(&mut series[key]));
}

#[test]
fn two_programs_agree_within_both_bands_in_terminal_document_and_report() {
    let store = tempfile::tempdir().unwrap();
    let ended = compared(store.path(), &["--reference-check"]);
    assert_eq!(ended.status, 0, "{}", ended.said);
    let line = ended.printed.lines().find(|line| line.trim_start().starts_with("CalculiX")).unwrap();
    assert!(line.ends_with("agrees"), "{line}");
    let page = fs::read_to_string(store.path().join(format!("report/{SCENE}.html"))).unwrap();
    assert!(page.contains("Independent solver") && page.contains("The same scene solved by CalculiX"));
    // where it is stored it is shown unasked
    let document: Value = serde_json::from_str(&compared(store.path(), &["--json"]).printed).unwrap();
    let check = &document["scenes"][0]["reference_check"];
    assert_eq!((&check["program"], &check["verdict"]), (&json!("CalculiX"), &json!("within")));
    let rows = check["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 8);
    for row in rows {
        let number = |key: &str| row[key].as_f64().unwrap();
        let joint = number("uncertainty").hypot(number("other_uncertainty"));
        assert!(
            (number("joint_band") / joint - 1.0).abs() < 1e-12 && number("difference").abs() <= joint,
            "{row}"
        );
        // bands that wide would say nothing
        assert!(joint < 0.02 * number("reference").abs() && number("difference") != 0.0, "{row}");
    }
}

/// Every scene that both programs have solved: as the record of validated scenes keeps it.
#[test]
fn both_programs_agree_on_every_recorded_scene() {
    let record = fs::read_to_string(Path::new(ROOT).join("fem_reference/solutions/validated.jsonl")).unwrap();
    let lines: Vec<Value> = record.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of_scene = |scene: &Value, calculix: bool| {
        let found = lines.iter().find(|line| {
            line["scene"] == *scene && line["model"] == "C" && (line["partner"] == "CalculiX") == calculix
        });
        found.unwrap_or_else(|| panic!("{scene} of one program only"))
    };
    let scenes: Vec<&Value> = lines
        .iter()
        .filter(|line| line["partner"] == "CalculiX" && line["model"] == "C")
        .map(|line| &line["scene"])
        .collect();
    assert!(scenes.len() >= 7, "{scenes:?}");
    for scene in scenes {
        let rows = |calculix| of_scene(scene, calculix)["rows"].as_array().unwrap();
        for quantity in ["efficiency", "outer_force_peak", "inner_force_peak"] {
            let [own, other] =
                [false, true].map(|by| rows(by).iter().find(|row| row["quantity"] == quantity).unwrap());
            let number = |row: &Value, key: &str| row[key].as_f64().unwrap();
            let joint = number(own, "band").hypot(number(other, "band"));
            let apart = (number(own, "reference") - number(other, "reference")).abs();
            assert!(
                apart <= joint && joint < 0.03 * number(own, "reference"),
                "{scene} {quantity}: {apart} of {joint}"
            );
        }
    }
}

#[test]
fn a_requested_solution_that_is_missing_or_in_contradiction_ends_with_11() {
    let store = tempfile::tempdir().unwrap();
    let missing = compared(store.path(), &["--reference-check", "--resolution", "coarse"]);
    assert_eq!(missing.status, 11, "{}", missing.said);
    assert!(
        missing
            .said
            .contains("the reference of `scaled-plate-r10` (resolution `calculix-coarse`) is missing"),
        "{}",
        missing.said
    );
    changed(store.path(), |summary| summary["efficiency"] = json!(0.5));
    let contradicting = compared(store.path(), &["--reference-check"]);
    assert_eq!(contradicting.status, 11, "{}", contradicting.said);
    assert!(contradicting.said.contains("contradicts itself"), "{}", contradicting.said);
    // unasked, nothing is shown of it
    let unasked = compared(store.path(), &[]);
    assert_eq!((unasked.status, unasked.printed.contains("CalculiX")), (0, false), "{}", unasked.said);
}

#[test]
fn two_programs_that_disagree_end_with_10_where_they_have_to_agree() {
    let store = tempfile::tempdir().unwrap();
    changed(store.path(), |summary| scaled(summary, 1.001));
    let refused = compared(store.path(), &["--reference-check"]);
    assert_eq!(refused.status, 10, "{}", refused.said);
    assert!(refused.printed.contains("differs"), "{}", refused.printed);
    assert_eq!(compared(store.path(), &[]).status, 0);
}

#[test]
fn what_calculix_cannot_do_is_refused_in_words() {
    let store = tempfile::tempdir().unwrap();
    let ended = run(store.path(), &["reference", SCENE, "--solver", "calculix", "--target-error", "1%"]);
    assert_eq!(ended.status, 2, "{}", ended.said);
    assert!(ended.said.contains("coarse, paper and fine, not 1%"), "{}", ended.said);
}

/// Bodies from CAD parts: every quantity of the stored solutions of both programs.
#[test]
fn both_programs_agree_on_the_stored_bodies() {
    let solutions = Path::new(ROOT).join("fem_reference/solutions");
    let mut compared = 0;
    for entry in fs::read_dir(solutions).unwrap() {
        let scene = entry.unwrap().path();
        let [own, other] =
            ["coarse", "calculix-coarse"].map(|folder| scene.join(folder).join("summary.json"));
        if !other.exists() {
            continue;
        }
        let [own, other] = [own, other]
            .map(|file| serde_json::from_str::<Value>(&fs::read_to_string(file).unwrap()).unwrap());
        let names = own["uncertainty"].as_object().unwrap().keys();
        // what both have as one number, no norm of a curve
        let names = names.filter(|name| !other["uncertainty"][*name].is_null() && own[*name].is_number());
        for name in names {
            let number = |of: &Value| of.as_f64().unwrap();
            let joint = number(&own["uncertainty"][name]).hypot(number(&other["uncertainty"][name]));
            let apart = (number(&own[name]) - number(&other[name])).abs();
            assert!(
                apart <= joint && joint < 0.05 * number(&own[name]).abs(),
                "{scene:?} {name}: {apart} of {joint}"
            );
            compared += 1;
        }
    }
    assert!(compared >= 25, "{compared}");
}
