//! Model `auto`: the simplest model whose predicted error is within a tolerance, here and on the validation base.

use assert_cmd::Command;
use impactcheck::cli::in_process::{ModelRequest, RequestedModel, reduced};
use impactcheck::evidence::study::auto;
use impactcheck::evidence::study::{Cell, Verdict};
use impactcheck::kinds::SharedBodies;
use impactcheck::result::{Choice, Summary};
use impactcheck::scene::{Model, Scene, resolve};
use serde_json::Value;

fn shipped(name: &str) -> Scene {
    Scene::read(resolve(name).unwrap()).unwrap()
}

/// What auto makes of a scene, and why.
fn chosen(scene: &Scene, tolerance: f64) -> (Summary, Choice) {
    let request = ModelRequest {
        model: Some(RequestedModel::Auto),
        tolerance: Some(tolerance),
        ..ModelRequest::default()
    };
    let summary = reduced(scene, &request, &SharedBodies::default()).unwrap().summary;
    let choice = summary.choice.clone().unwrap();
    (summary, choice)
}

/// The stored references of Table 1, and a looser tolerance never takes a costlier model.
#[test]
fn table_1_is_within_the_tolerance_of_its_references() {
    for (name, efficiency, peaks) in
        [("scaled-plate-r10", 0.6946, [443.1, 352.1]), ("scaled-plate-r6.35", 0.3868, [142.9, 85.35])]
    {
        let scene = shipped(name);
        let mut dearest = ("C".to_owned(), usize::MAX);
        for tolerance in [0.03, 0.1, 0.2, 0.3] {
            let (summary, choice) = chosen(&scene, tolerance);
            assert!(choice.met && choice.estimated_error.unwrap() <= tolerance, "{choice:?}");
            let model = (summary.model.clone().unwrap(), summary.modes.unwrap());
            assert!(model <= dearest, "{name}, {tolerance}: {model:?} after {dearest:?}");
            dearest = model;
            let off = |name: &str, exact: f64| (summary.value(name).unwrap() / exact - 1.0).abs();
            assert!(off("efficiency", efficiency) < tolerance);
            assert!(off("outer_force_peak", peaks[0]) < tolerance);
            assert!(off("inner_force_peak", peaks[1]) < tolerance);
        }
        assert_eq!(dearest.0, "B", "{name}");
    }
}

/// The same choice on all scenes of the base, from predictions by others of their group: references decide.
#[test]
fn choices_keep_their_tolerance_on_the_validation_base() {
    let study = auto::run(&mut |_| ()).unwrap();
    assert!(study.claims.iter().all(|claim| claim.verdict != Verdict::Fail), "{:#?}", study.claims);
    assert!(study.claims.iter().filter(|claim| claim.verdict == Verdict::Pass).count() >= 2);
    let models: Vec<Cell> = study.rows.iter().map(|row| row[3]).collect();
    for model in ["A", "B", "C"] {
        assert!(models.contains(&Cell::Text(model)), "{model}");
    }
}

#[test]
fn what_no_model_meets_or_nothing_predicts_has_a_reason() {
    let scene = shipped("scaled-plate-r10");
    let (summary, choice) = chosen(&scene, 1e-4);
    assert!(!choice.met && choice.estimated_error.unwrap() > 1e-4);
    assert_eq!(summary.model.as_deref(), Some("C"));
    assert!(summary.warnings.contains(&choice.reason));
    // unlike all scenes of the base
    let (summary, choice) = chosen(&shipped("scenes/examples/rocker-bender.toml"), 0.03);
    assert_eq!(summary.model.as_deref(), Some("C"));
    assert!(!choice.met && choice.estimated_error.is_none());
    assert!(choice.reason.contains("no scenes with a bender"), "{choice:?}");
    // too thin for model C
    let text = std::fs::read_to_string(resolve("scaled-plate-r10").unwrap()).unwrap();
    let thin = text.replace("\"2 mm\"", "\"0.02 mm\"").replace("\"10 mm\"", "\"0.2 mm\"");
    let (summary, choice) = chosen(&Scene::parse("thin.toml", &thin).unwrap(), 0.003);
    assert_eq!(summary.model, Some(Model::B.to_string()));
    assert!(!choice.met && choice.reason.contains("model C does not run"), "{choice:?}");
}

fn program(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("impactcheck")
        .unwrap()
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().unwrap(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn the_choice_is_in_the_json_and_on_the_terminal() {
    let (status, out, _) =
        program(&["reduced", "scaled-plate-r10", "--model", "auto", "--tolerance", "3%", "--json"]);
    let summary: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((status, &summary["model"]), (0, &"C".into()));
    let choice = &summary["choice"];
    assert_eq!(choice["tolerance"], 0.03);
    assert_eq!(choice["met"], true);
    let tried = choice["tried"].as_array().unwrap();
    let chosen: Vec<&Value> = tried.iter().filter(|candidate| candidate["chosen"] == true).collect();
    assert_eq!(chosen.len(), 1);
    assert_eq!(chosen[0]["estimated_error"], choice["estimated_error"]);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().display().to_string();
    let (status, json, error) = program(&[
        "compare",
        "scaled-plate-r6.35",
        "--models",
        "B,C,auto",
        "--tolerance",
        "0.05",
        "--out",
        &out,
        "--json",
    ]);
    let comparison: Value = serde_json::from_str(&json).unwrap();
    let models = comparison["scenes"][0]["models"].as_array().unwrap();
    assert_eq!((status, models.len()), (0, 2), "{error}");
    assert!(models[1]["summary"]["choice"]["met"] == true && models[0]["summary"]["choice"].is_null());
    assert!(error.contains("predicted to be within the tolerance"), "{error}");
}

#[test]
fn what_makes_no_sense_with_auto_is_refused_in_a_sentence() {
    for (arguments, said) in [
        (
            &["reduced", "scaled-plate-r10", "--model", "auto", "--modes", "3"][..],
            "chooses the number of modes",
        ),
        (&["reduced", "seal-seat-initial", "--model", "auto"], "has model C only"),
        (
            &["reduced", "scaled-plate-r10", "--model", "B", "--tolerance", "5%"],
            "--model auto takes larger ones",
        ),
        (&["compare", "scaled-plate-r10", "--tolerance", "1%"], "not among --models"),
        (&["reduced", "scaled-plate-r10", "--model", "D"], "there are A, B and C, auto, and external"),
    ] {
        let (status, _, error) = program(arguments);
        assert!(status == 2 && error.contains(said), "{arguments:?}: {error}");
    }
}
