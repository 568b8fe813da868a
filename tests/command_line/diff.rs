//! What `diff` says has moved are the numbers of the two documents.

use assert_cmd::Command;
use serde_json::Value;
use std::path::Path;

fn impactcheck(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::cargo_bin("impactcheck")
        .unwrap()
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env_remove("IMPACTCHECK_STORE")
        .output()
        .unwrap();
    let [out, error] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (output.status.code(), out, error)
}

/// The report of a scene on the mesh `resolution`.
fn report(folder: &Path, resolution: &str) -> String {
    let out = folder.join(resolution).display().to_string();
    let arguments = ["compare", "scaled-plate-r6.35", "--resolution", resolution, "--out", &out, "--quiet"];
    assert_eq!(impactcheck(&arguments).0, Some(0));
    out
}

#[test]
fn a_coarser_reference_moves_and_the_models_stay() {
    let folder = tempfile::tempdir().unwrap();
    let [coarse, paper] = ["coarse", "paper"].map(|resolution| report(folder.path(), resolution));
    let (status, table, _) = impactcheck(&["diff", &paper, &paper]);
    assert_eq!((status, table.trim_end()), (Some(0), "nothing moved"));

    let efficiency = |report: &str| -> f64 {
        let text = std::fs::read_to_string(Path::new(report).join("comparison.json")).unwrap();
        let document: Value = serde_json::from_str(&text).unwrap();
        document["scenes"][0]["reference"]["efficiency"].as_f64().unwrap()
    };
    let (status, json, _) = impactcheck(&["diff", &coarse, &paper, "--json"]);
    let found: Value = serde_json::from_str(&json).unwrap();
    assert_eq!((status, &found["schema_version"]), (Some(0), &1.into()));
    let moved = found["moved"].as_array().unwrap();
    let of_efficiency: Vec<_> = moved.iter().filter(|entry| entry["quantity"] == "efficiency").collect();
    assert_eq!(of_efficiency.len(), 1, "the reference alone, once: {of_efficiency:?}");
    assert_eq!(of_efficiency[0]["model"], "reference");
    assert_eq!(of_efficiency[0]["a"].as_f64().unwrap(), efficiency(&coarse));
    assert_eq!(of_efficiency[0]["b"].as_f64().unwrap(), efficiency(&paper));

    let (_, json, _) = impactcheck(&["diff", &coarse, &paper, "--json", "--above", "5%"]);
    let some: Value = serde_json::from_str(&json).unwrap();
    let verdicts = some["verdicts"].as_array().unwrap().len();
    let some = some["moved"].as_array().unwrap();
    assert!(!some.is_empty() && some.len() < moved.len());
    assert!(some.iter().all(|entry| entry["relative"].as_f64().is_none_or(|share| share.abs() > 0.05)));
    let (_, table, _) = impactcheck(&["diff", &coarse, &paper, "--above", "5%"]);
    assert_eq!(table.lines().count(), 2 + verdicts + some.len());
}

#[test]
fn what_is_no_comparison_is_refused_in_one_sentence() {
    for file in ["README.md", "scenes", "no-such-file.json", "reports/comparison.md"] {
        let (status, out, error) = impactcheck(&["diff", file, file]);
        assert_eq!((status, out.as_str()), (Some(2), ""), "{error}");
        assert!(error.starts_with("error: ") && error.contains(file), "{error}");
    }
}
