//! Optimisation from the command line: the optimum, its neighbourhood, its verification.

use super::program::{THIN_PLATE, file, impactcheck, json, text};
use serde_json::Value;
use std::fs;

#[test]
fn optimum_of_fig_16_with_its_neighbourhood() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (file(folder.path(), "thin.toml", THIN_PLATE), folder.path().join("out"));
    let document =
        json(&["optimise", text(&scene), "--over", "plate.radius=2mm..10mm", "--out", text(&out), "--json"]);
    let variable = &document["variables"][0];
    let (best, range) = (variable["optimum"].as_f64().unwrap(), &variable["range_within_1_percent"]);
    // the paper: 5.5 mm
    assert!((best - 5.5e-3).abs() < 0.25e-3, "{document}");
    assert!(range[0].as_f64().unwrap() < best && best < range[1].as_f64().unwrap());
    assert!(variable["curvature"].as_f64().unwrap() < 0.0 && variable["on_bound"] == false);
    let efficiency = document["efficiency"].as_f64().unwrap();
    for point in variable["profile"].as_array().unwrap() {
        assert!(point[1].as_f64().unwrap() <= efficiency, "{point}");
    }
    for name in ["optimum.json", "optimum.svg", "optimum.png"] {
        assert!(fs::metadata(out.join(name)).unwrap().len() > 100);
    }
    // model C runs there too, as by itself
    let by_c = json(&["reduced", text(&out.join("optimum.toml")), "--model", "C", "--json"]);
    let confirmed = document["confirmation"]["efficiency"].as_f64().unwrap();
    assert!((by_c["efficiency"].as_f64().unwrap() - confirmed).abs() < 1e-4, "{confirmed} {by_c}");
    // the scene it writes has this efficiency
    let again = json(&["reduced", text(&out.join("optimum.toml")), "--model", "B", "--json"]);
    assert_eq!(again["efficiency"].as_f64(), Some(efficiency));
}

#[test]
fn optimum_is_verified_by_the_reference_or_a_missing_one_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let scene = file(folder.path(), "thin.toml", THIN_PLATE);
    let store = folder.path().join("store");
    let arguments = [
        "optimise",
        text(&scene),
        "--over",
        "plate.radius=5mm..6mm",
        "--verify",
        "--json",
        "--store",
        text(&store),
    ];
    let ended = impactcheck(&arguments);
    assert_eq!(ended.status, 12, "{}", ended.error);
    let document: Value = serde_json::from_str(&ended.out).expect("the optimum all the same");
    assert_eq!(document["verification"]["verdict"], "missing");
    assert!(document["verification"]["missing"].as_str().unwrap().contains("/no/such/python3"), "{document}");
    for over in [
        "plate.radius",
        "plate.radius=1mm",
        "plate.radius=6mm..5mm",
        "plate.radius=-1mm..5mm",
        "plate.radius=1kg..2kg",
        "plate.radios=1mm..2mm",
        "reduced.modes=1..5",
        "plate.radius,outer.speed=1..2",
    ] {
        let ended = impactcheck(&["optimise", text(&scene), "--over", over]);
        assert_eq!(ended.status, 2, "{over}: {}", ended.error);
        assert!(
            ended.error.contains("plate.") || ended.error.contains("reduced.modes"),
            "{over}: {}",
            ended.error
        );
    }
    let twice =
        ["optimise", text(&scene), "--over", "plate.radius=5mm..6mm", "--over", "plate.radius=5mm..7mm"];
    assert_eq!(impactcheck(&twice).status, 2);
}
