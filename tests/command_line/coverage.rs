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
    let partners = |found: &Value, feature: &str| -> Vec<Value> {
        let features = found["features"].as_array().unwrap();
        let entry = features.iter().find(|entry| entry["feature"] == feature).unwrap();
        entry["partners"].as_array().unwrap().clone()
    };
    let scenes = ["scaled-plate-r10", "scaled-plate-r6.35", "scenes/examples/wet-valve-plate.toml"];
    let found = document("coverage", &scenes);
    let clamped = partners(&found, "clamped edge");
    for (entry, model) in clamped.iter().zip(["A", "B", "C"]) {
        assert_eq!((&entry["model"], &entry["partner"]), (&model.into(), &"axisymmetric".into()));
        assert_eq!(entry["scenes"], serde_json::json!(scenes[..2]));
        let alone = scenes[..2].iter().map(|scene| {
            let alone = partners(&document("coverage", &[scene]), "clamped edge");
            let entry = alone.iter().find(|entry| entry["model"] == model).unwrap();
            entry["worst_relative"].as_f64().unwrap()
        });
        assert_eq!(entry["worst_relative"].as_f64().unwrap(), alone.fold(0.0, f64::max));
        assert!(entry["band"].as_f64().unwrap() < 0.01);
    }
    assert_eq!(clamped.len(), 3);
    let wet = partners(&found, "squeeze film");
    assert!(!wet.is_empty());
    assert!(wet.iter().all(|entry| entry["partner"].is_null() && entry["worst_relative"].is_null()));
    assert!(partners(&found, "bender").is_empty());
}
