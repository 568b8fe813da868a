//! A test of the gate itself: errors are put into a stored reference, sealed again with fresh checksums, and
//! the gate has to fail with exit status 10; with the untouched one it has to pass. `harness.rs` puts every error into every curve.

use crate::sealed::{change_summary, copy_shipped, seal};
use assert_cmd::Command;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const SCENES: [&str; 2] = ["scaled-plate-r10", "scaled-plate-r6.35"];

/// A history as a table: header and rows of numbers.
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(path: &Path) -> Self {
        let mut reader = csv::Reader::from_path(path).unwrap();
        let header = reader.headers().unwrap().iter().map(str::to_owned).collect();
        let rows =
            reader.records().map(|r| r.unwrap().iter().map(|x| x.parse().unwrap()).collect()).collect();
        Self { header, rows }
    }

    fn write(&self, path: &Path) {
        let mut writer = csv::Writer::from_path(path).unwrap();
        writer.write_record(&self.header).unwrap();
        for row in &self.rows {
            writer.write_record(row.iter().map(|x| format!("{x:e}"))).unwrap();
        }
        writer.flush().unwrap();
    }

    fn column(&self, name: &str) -> usize {
        self.header.iter().position(|h| h == name).unwrap_or_else(|| panic!("no column {name}"))
    }

    fn scale(&mut self, name: &str, factor: f64) {
        let column = self.column(name);
        self.rows.iter_mut().for_each(|row| row[column] *= factor);
    }

    /// Delays every curve by about `delay` s; the first samples repeat the initial state.
    fn delay(&mut self, delay: f64) {
        let interval = self.rows[1][0] - self.rows[0][0];
        let samples = (delay / interval).round() as usize;
        assert!(samples > 0, "the samples are {interval} s apart");
        let earlier: Vec<Vec<f64>> = self.rows.clone();
        // bands stay: they are as wide as the summary says
        let curves = 1..self.header.iter().take_while(|name| !name.ends_with("_band")).count();
        for (i, row) in self.rows.iter_mut().enumerate() {
            let from = &earlier[i.saturating_sub(samples)];
            row[curves.clone()].copy_from_slice(&from[curves.clone()]);
        }
    }
}

/// A store that holds `scene` only, its solution changed by `change` and its checksums made again.
fn changed(scene: &str, change: impl Fn(&Path)) -> tempfile::TempDir {
    let store = tempfile::tempdir().unwrap();
    let to = store.path().join(scene).join("paper");
    copy_shipped(&format!("{scene}/paper"), &to);
    change(&to);
    seal(&to);
    store
}

/// As [`changed`], of the history alone.
fn store(scene: &str, change: impl Fn(&mut Table)) -> tempfile::TempDir {
    changed(scene, |folder| {
        let history = folder.join("history.csv");
        let mut table = Table::read(&history);
        change(&mut table);
        table.write(&history);
    })
}

/// As [`changed`], of the summary alone.
fn summary(scene: &str, change: impl Fn(&mut Value)) -> tempfile::TempDir {
    changed(scene, |folder| change_summary(folder, &change))
}

/// Exit status of the gate on `scene` with the references of `store`.
fn gate(scene: &str, store: &Path) -> i32 {
    let out = tempfile::tempdir().unwrap();
    run(&["gate", scene, "--models", "B", "--out", out.path().to_str().unwrap()], store).0
}

/// Exit status of the program with the references of `store`, and what it says on standard error.
fn run(arguments: &[&str], store: &Path) -> (i32, String) {
    let mut program = Command::cargo_bin("impactcheck").unwrap();
    program.args(arguments).arg("--store").arg(store).current_dir(env!("CARGO_MANIFEST_DIR"));
    let output = program.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{}{said}", String::from_utf8_lossy(&output.stdout));
    (output.status.code().unwrap(), said)
}

#[test]
fn untouched_reference_passes() {
    for scene in SCENES {
        assert_eq!(gate(scene, store(scene, |_| ()).path()), 0, "{scene}");
    }
}

#[test]
fn three_percent_error_of_a_force_fails() {
    for (scene, force, factor) in [(SCENES[0], "outer_force", 0.97), (SCENES[1], "inner_force", 1.03)] {
        let store = store(scene, |table| table.scale(force, factor));
        assert_eq!(gate(scene, store.path()), 10, "{scene}: {force} x {factor}");
    }
}

#[test]
fn shift_by_two_microseconds_fails() {
    for scene in SCENES {
        assert_eq!(gate(scene, store(scene, |table| table.delay(2e-6)).path()), 10, "{scene}");
    }
}

#[test]
fn changed_file_without_new_checksum_is_damage() {
    let scene = SCENES[0];
    let store = store(scene, |_| ());
    let file = store.path().join(scene).join("paper/history.csv");
    let mut text = fs::read_to_string(&file).unwrap();
    text = text.replacen('7', "8", 1);
    fs::write(&file, text).unwrap();
    assert_eq!(gate(scene, store.path()), 11);
}

/// Bands follow from the values on all meshes, the energy's residual is that of the finest one.
#[test]
fn a_summary_that_its_own_mesh_series_contradicts_fails() {
    let scene = SCENES[0];
    assert_eq!(gate(scene, summary(scene, |_| ()).path()), 0);
    let narrow = |summary: &mut Value| {
        let band = summary["uncertainty"]["efficiency"].as_f64().unwrap() / 1000.0;
        summary["uncertainty"]["efficiency"] = json!(band);
        summary["convergence"]["quantities"]["efficiency"]["band"] = json!(band);
    };
    assert_eq!(gate(scene, summary(scene, narrow).path()), 10);
    let residual = |summary: &mut Value| summary["energy_residual"] = json!(0.5);
    let edited = summary(scene, residual);
    assert_eq!(gate(scene, edited.path()), 10);
    // what only looks it up is told as well
    let (status, said) = run(&["reference", scene], edited.path());
    assert_eq!(status, 11);
    assert!(said.contains("contradictions of mesh series"), "{said}");
    let unfounded = |summary: &mut Value| {
        summary["uncertainty"]["efficiency"] = json!(1e-9);
        summary["convergence"]["quantities"].as_object_mut().unwrap().remove("efficiency");
    };
    assert_eq!(gate(scene, summary(scene, unfounded).path()), 10);
    let dropped = |summary: &mut Value| {
        summary["convergence"]["quantities"]["efficiency"]["values"].as_array_mut().unwrap().pop();
    };
    assert_eq!(gate(scene, summary(scene, dropped).path()), 10);
    let without_band = |summary: &mut Value| {
        for bands in ["/uncertainty", "/convergence/quantities"] {
            summary.pointer_mut(bands).unwrap().as_object_mut().unwrap().remove("efficiency");
        }
    };
    assert_eq!(gate(scene, summary(scene, without_band).path()), 10);
    let steps = |summary: &mut Value| summary["steps"] = json!(7);
    assert_eq!(gate(scene, summary(scene, steps).path()), 10);
}

#[test]
fn bands_without_a_series_of_meshes_are_damage() {
    let scene = SCENES[0];
    let remove = |path: &str, key: &str| {
        summary(scene, |document| {
            document.pointer_mut(path).unwrap().as_object_mut().unwrap().remove(key).unwrap();
        })
    };
    for (path, key) in [("", "convergence"), ("/convergence", "meshes"), ("/convergence/meshes/0", "dofs")] {
        let store = remove(path, key);
        let out = store.path().join("out");
        let models = ["--models", "B", "--out", out.to_str().unwrap()];
        for arguments in [
            vec!["reference", scene],
            [&["gate", scene], &models[..]].concat(),
            [&["compare", scene], &models[..]].concat(),
        ] {
            let (status, said) = run(&arguments, store.path());
            assert_eq!(status, 11, "{arguments:?} without {key}");
            assert!(said.contains("summary.json: has no `convergence`"), "{said}");
        }
        assert!(!out.exists());
    }
}

#[test]
fn bands_of_curves_that_the_summary_does_not_know_are_damage() {
    let narrow = store(SCENES[0], |table| table.scale("outer_force_band", 1e-3));
    assert_eq!(gate(SCENES[0], narrow.path()), 11);
}

#[test]
fn the_mesh_of_another_solution_is_damage() {
    let foreign = changed(SCENES[0], |folder| {
        let other = format!("fem_reference/solutions/{}/paper/mesh.vtu", SCENES[1]);
        fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join(other), folder.join("mesh.vtu")).unwrap();
    });
    assert_eq!(gate(SCENES[0], foreign.path()), 11);
}
