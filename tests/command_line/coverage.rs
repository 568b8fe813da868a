//! What `coverage` says is what the stored references show.

use assert_cmd::Command;
use serde_json::Value;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn document(command: &str, scenes: &[&str]) -> Value {
    let output = Command::cargo_bin("impactcheck")
        .unwrap()
        .args([command].iter().chain(scenes))
        .args(["--json", "--quiet"])
        .current_dir(ROOT)
        .env_remove("IMPACTCHECK_STORE")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The worst of two scenes that differ in their spheres only is the larger of what each gives alone; a wet scene, whose
/// reference there is not, says so; what no scene has is empty.
#[test]
fn features_are_covered_as_far_as_references_are_stored() {
    let comparators = |found: &Value, feature: &str| -> Vec<Value> {
        let features = found["features"].as_array().unwrap();
        let entry = features.iter().find(|entry| entry["feature"] == feature).unwrap();
        let comparators = entry["partners"].as_array().unwrap().iter();
        let own = |comparator: &&Value| {
            comparator["partner"] != "closed form" && comparator["partner"] != "CalculiX"
        };
        comparators.filter(own).cloned().collect()
    };
    let scenes = ["scaled-plate-r10", "scaled-plate-r6.35", "scenes/examples/wet-valve-plate.toml"];
    let found = document("coverage", &scenes);
    let alone = [0, 1].map(|k| comparators(&document("coverage", &scenes[k..=k]), "clamped edge"));
    let clamped = comparators(&found, "clamped edge");
    for (entry, model) in clamped.iter().zip(["A", "B", "C"]) {
        assert_eq!((&entry["model"], &entry["partner"]), (&model.into(), &"axisymmetric".into()));
        assert_eq!(entry["scenes"], serde_json::json!(scenes[..2]));
        let alone = alone.iter().map(|alone| {
            let entry = alone.iter().find(|entry| entry["model"] == model).unwrap();
            entry["worst_relative"].as_f64().unwrap()
        });
        assert_eq!(entry["worst_relative"].as_f64().unwrap(), alone.fold(0.0, f64::max));
        assert!(entry["band"].as_f64().unwrap() < 0.01);
    }
    assert_eq!(clamped.len(), 3);
    let wet = comparators(&found, "squeeze film");
    assert!(!wet.is_empty());
    assert!(wet.iter().all(|entry| entry["partner"].is_null() && entry["worst_relative"].is_null()));
    assert!(comparators(&found, "bender").is_empty());
}

/// The second program's stored solutions stand beside every model, in a column of their own, with a band.
#[test]
fn the_independent_solver_is_a_separate_comparator() {
    let found = document("coverage", &["scaled-plate-r10", "scenes/validation/free-plate.toml"]);
    for (feature, scene) in [("clamped edge", "scaled-plate-r10"), ("free edge", "free-plate")] {
        let entry = found["features"].as_array().unwrap().iter().find(|f| f["feature"] == feature).unwrap();
        let is_of_c = |p: &&Value| p["partner"] == "CalculiX" && p["model"] == "C";
        let comparator = entry["partners"].as_array().unwrap().iter().find(is_of_c).unwrap();
        assert_eq!(comparator["scenes"], serde_json::json!([scene]));
        let [worst, band] = ["worst_relative", "band"].map(|key| comparator[key].as_f64().unwrap());
        assert!(worst < 0.02 && (1e-4..0.04).contains(&band), "{comparator}");
    }
}

/// What needs references that are not here is told from what was found with them; a scene that has changed since is not.
#[test]
fn references_that_are_elsewhere_are_known_by_what_they_showed() {
    let dir = tempfile::tempdir().unwrap();
    let changed = dir.path().join("compact-bodies.toml");
    let text = std::fs::read_to_string(format!("{ROOT}/scenes/validation/compact-bodies.toml")).unwrap();
    std::fs::write(&changed, text.replacen("10 g", "11 g", 1)).unwrap();
    let comparators = |scene: &str| {
        let found =
            document("coverage", &[scene, "--store", &dir.path().join("store").display().to_string()]);
        let features = found["features"].as_array().unwrap().clone();
        let feature = features.into_iter().find(|f| f["feature"] == "compact outer body").unwrap();
        let comparators = feature["partners"].as_array().unwrap().iter();
        // the contact has its closed form whatever is stored
        Value::Array(
            comparators.filter(|comparator| comparator["partner"] != "closed form").cloned().collect(),
        )
    };
    let known = comparators("scenes/validation/compact-bodies.toml");
    let model_c = known.as_array().unwrap().iter().find(|entry| entry["model"] == "C").unwrap();
    assert_eq!(model_c["partner"], "axisymmetric");
    assert!((1e-4..1e-2).contains(&model_c["worst_relative"].as_f64().unwrap()), "{model_c}");
    let unknown = comparators(&changed.display().to_string());
    assert!(unknown.as_array().unwrap().iter().all(|entry| entry["partner"].is_null()), "{unknown}");
}

/// A comparison keeps in the user's store what it found with a reference of that store, once.
#[test]
fn comparisons_are_stored_with_the_references() {
    let dir = tempfile::tempdir().unwrap();
    let (scene, store) = ("scaled-plate-r6.35", dir.path().join("store"));
    let entry = store.join(scene).join("coarse");
    std::fs::create_dir_all(&entry).unwrap();
    for file in std::fs::read_dir(format!("{ROOT}/fem_reference/solutions/{scene}/coarse")).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), entry.join(file.file_name())).unwrap();
    }
    let record = store.join("validated.jsonl");
    let out = dir.path().join("report").display().to_string();
    let compare = |resolution: &str, models: &str| {
        let store = store.display().to_string();
        let arguments =
            [scene, "--resolution", resolution, "--models", models, "--out", &out, "--store", &store];
        document("compare", &arguments);
        std::fs::read_to_string(&record).ok()
    };
    assert_eq!(compare("paper", "C"), None, "its reference is not of this store");
    let one = compare("coarse", "C").unwrap();
    assert_eq!(one.lines().count(), 1);
    assert!(compare("coarse", "B").unwrap().ends_with(&one));
    // one that can't be read is told of and left alone
    std::fs::write(&record, "no JSON\n").unwrap();
    assert_eq!(compare("coarse", "C").unwrap(), "no JSON\n");
}

/// Models that have changed are renewed in the record beside the references as they are recorded.
#[test]
fn the_record_is_renewed_from_its_own_references() {
    let home = tempfile::tempdir().unwrap();
    let solutions = home.path().join("fem_reference/solutions");
    for folder in [&solutions, &home.path().join("scenes/validation")] {
        std::fs::create_dir_all(folder).unwrap();
    }
    std::fs::write(home.path().join("fem_reference/__main__.py"), "").unwrap();
    for scene in ["scenes/validation/rod.toml", "scenes/validation/repeated-r10.toml"] {
        std::fs::copy(format!("{ROOT}/{scene}"), home.path().join(scene)).unwrap();
    }
    let record = solutions.join("validated.jsonl");
    let right = std::fs::read_to_string(format!("{ROOT}/fem_reference/solutions/validated.jsonl")).unwrap();
    // other models gave other numbers once, of impacts of a series too
    let mut before = right.clone();
    for (scene, quantity) in [("rod", "efficiency"), ("repeated-r10", "impact_2_outer_force_peak")] {
        let of_scene = format!("\"scene\":\"{scene}\"");
        let is_of_b = |line: &&str| line.contains(&of_scene) && line.contains("\"model\":\"B\"");
        let line = right.lines().find(is_of_b).unwrap();
        let (head, tail) = line.split_once(&format!("\"{quantity}\",\"reduced\":")).unwrap();
        before = before.replace(line, &format!("{head}\"{quantity}\",\"reduced\":1{tail}"));
    }
    std::fs::write(&record, before).unwrap();
    let run = Command::cargo_bin("impactcheck")
        .unwrap()
        .args(["coverage", "--record", "--quiet", "--store"])
        .arg(home.path().join("store"))
        .env("IMPACTCHECK_HOME", home.path())
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let entries =
        |text: &str| -> Vec<Value> { text.lines().map(|l| serde_json::from_str(l).unwrap()).collect() };
    for (found, right) in entries(&std::fs::read_to_string(&record).unwrap()).iter().zip(entries(&right)) {
        for (row, right) in found["rows"].as_array().unwrap().iter().zip(right["rows"].as_array().unwrap()) {
            assert_eq!((&row["reference"], &row["band"]), (&right["reference"], &right["band"]));
            let [now, right] = [row, right].map(|row| row["reduced"].as_f64().unwrap());
            assert!((now / right - 1.0).abs() < 1e-3, "{found}: {now} {right}");
        }
    }
}
