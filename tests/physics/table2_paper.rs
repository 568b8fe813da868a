//! Table 2 of the paper: eigenfrequencies of a fixed plate of radius 3 mm from plate to rod.
//!
//! Goal: first and first longitudinal eigenfrequency and its number from the continuum plate of model C, and the
//! document of the study. Checks: the paper's values (whole kHz), an independent FE prototype (four digits), a finer
//! mesh of the same plate, FEniCSx with SLEPc where it is installed.

use assert_cmd::Command;
use impactcheck::body::continuum::{ContinuumPlate, MeshOptions};
use impactcheck::evidence::study::table2::{self, PAPER};
use serde_json::Value;
use std::f64::consts::TAU;

/// Thickness m, first and first longitudinal eigenfrequency kHz: independent FE prototype.
const PROTOTYPE: [(f64, f64, f64); 6] = [
    (0.1e-3, 28.5, 1116.0),
    (0.5e-3, 133.5, 1117.0),
    (3e-3, 340.8, 868.9),
    (6e-3, 367.5, 592.5),
    (12e-3, 379.5, 443.7),
    (24e-3, 385.2, 399.3),
];

#[test]
fn frequencies_and_numbers_of_an_independent_fe_prototype() {
    for ((thickness, first, longitudinal), (_, paper)) in PROTOTYPE.into_iter().zip(PAPER) {
        let ours = table2::reduced(thickness).unwrap();
        // 0.1 %, or half of the last digit given
        for (ours, theirs) in [(ours.first, first), (ours.longitudinal, longitudinal)] {
            assert!(
                (ours / 1e3 - theirs).abs() <= (1e-3 * theirs).max(0.05),
                "{thickness} m: {ours} {theirs}"
            );
        }
        assert_eq!(ours.number, paper.number, "t = {thickness} m");
    }
}

#[test]
fn a_finer_mesh_changes_no_first_frequency_by_more_than_2e_4() {
    for (thickness, _) in PAPER {
        let ours = table2::reduced(thickness).unwrap();
        let plate = table2::plate(thickness);
        let fine = MeshOptions { order: 4, ..MeshOptions::default().refined(2.5) };
        // the patch only makes the mesh finer at the axis
        let patch = [0.4 * thickness.min(plate.radius); 2];
        let exact = ContinuumPlate::new(&plate, patch, 8, &fine).unwrap().omega[0] / TAU;
        let error = ours.first / exact - 1.0;
        println!("{thickness} m: {error:e}");
        assert!((0.0..2e-4).contains(&(error + 1e-9)), "from above: {thickness} m: {error:e}");
    }
}

/// The document of the study; `python` names an interpreter, or one that does not exist.
fn study(python: Option<&str>, out: &std::path::Path) -> (Value, String) {
    let mut command = Command::cargo_bin("impactcheck").unwrap();
    command.args(["study", "table2", "--json", "--out"]).arg(out);
    command.current_dir(env!("CARGO_MANIFEST_DIR"));
    if let Some(python) = python {
        command.env("IMPACTCHECK_PYTHON", python);
    }
    let output = command.output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{error}");
    (serde_json::from_slice(&output.stdout).unwrap(), error)
}

/// The claims whose verdict is `verdict`.
fn claims<'a>(document: &'a Value, verdict: &str) -> Vec<&'a str> {
    let claims = document["claims"].as_array().unwrap().iter();
    claims.filter(|c| c["verdict"] == verdict).map(|c| c["claim"].as_str().unwrap()).collect()
}

#[test]
fn without_fenicsx_its_columns_are_null_and_a_line_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let (document, error) = study(Some("/nonexistent/python3"), folder.path());
    assert!(error.contains("columns of FEniCSx stay empty"), "{error}");
    assert_eq!(document["study"], "table2");
    let rows = document["rows"].as_array().unwrap();
    let width = document["columns"].as_array().unwrap().len();
    assert_eq!(rows.len(), 6);
    for row in rows {
        assert_eq!(row.as_array().unwrap().len(), width);
        for (column, value) in document["columns"].as_array().unwrap().iter().zip(row.as_array().unwrap()) {
            assert_eq!(value.is_null(), column.as_str().unwrap().ends_with("fenicsx"), "{column}");
        }
    }
    assert_eq!(claims(&document, "unchecked").len(), 6);
    // The paper's 136 kHz is the one value that two independent discretisations do not give.
    assert_eq!(claims(&document, "fail"), ["t = 0.5 mm: first eigenfrequency"]);
    assert_eq!(claims(&document, "pass").len(), 17);
    for extension in ["json", "csv", "md"] {
        assert!(folder.path().join(format!("table2.{extension}")).is_file(), "{extension}");
    }
}

#[test]
fn continuum_plate_and_slepc_agree_within_a_tenth_of_a_per_cent() {
    let Ok(python) = impactcheck::reference::python() else {
        eprintln!("skipped: FEniCSx is not installed");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let (document, _) = study(python.to_str(), folder.path());
    assert_eq!(claims(&document, "unchecked").len(), 0);
    assert_eq!(claims(&document, "fail"), ["t = 0.5 mm: first eigenfrequency"]);
}

#[test]
fn an_unknown_study_and_a_folder_that_is_a_file_are_refused_before_anything_is_computed() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let out = file.path().to_str().unwrap();
    for (arguments, status, word) in [
        (vec!["study", "table3"], 2, "did you mean `table2`?"),
        (vec!["study", "table2", "--out", out], 2, out),
    ] {
        let output = Command::cargo_bin("impactcheck").unwrap().args(arguments).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(status), "{error}");
        assert!(error.contains(word) && output.stdout.is_empty(), "{error}");
    }
}
