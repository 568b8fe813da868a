//! Runs that `run.end_time` cuts during a contact: what they have not determined is a number nowhere, and everybody says so.

use crate::synthetic_impact::{
    REDUCED, REFERENCE, SAMPLE_INTERVAL, history, reduced_of, reference, scene, summary,
};
use impactcheck::comparison::{GateRules, Verdict, compare_scene};
use impactcheck::kinds::plate_impact::PlateQuantities;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::report::{
    Attachments, Report, SceneReport, Width, curves_csv, figure, index_page, junit, markdown, scene_page,
    terminal,
};
use impactcheck::result::{Outcome, Source};
use impactcheck::scene::{Model, RunSettings, Scene, Tolerance, resolve};
use std::collections::BTreeMap;

const END: f64 = 40e-6;

fn base(end_time: Option<f64>) -> Scene {
    let scene = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    Scene { run: RunSettings { end_time }, ..scene }
}

#[test]
fn a_reduced_model_does_not_report_what_it_has_not_seen() {
    let model = |end| Reduced::new(&base(end), Model::B, None).unwrap();
    let whole = model(None).run(1e-7).unwrap();
    // both contacts last at 40 us, at 100 us the outer one alone
    for end in [END, 100e-6] {
        let summary = model(Some(end)).run(1e-7).unwrap();
        let document = serde_json::to_value(&summary).unwrap();
        for quantity in PlateQuantities::ALL {
            let of_the_plate = quantity.name == "first_frequency";
            assert_eq!(document[quantity.name].is_null(), !of_the_plate, "{} at {end} s", quantity.name);
        }
        assert!(document.get("contact_pressure").is_none());
        assert!(summary.warnings.iter().any(|w| w.contains("run.end_time")), "{:?}", summary.warnings);
        assert!(summary.energy_residual.unwrap() < 1e-6 && summary.momentum_residual.unwrap() < 1e-9);
        // in a series of impacts it is a failure
        assert!(model(Some(end)).point(1e-7).is_err());
    }
    // an end in free flight cuts nothing
    let later = model(Some(250e-6)).run(1e-7).unwrap();
    assert!(later.warnings.is_empty() && later.undetermined().next().is_none());
    let efficiency = |summary: &impactcheck::result::Summary| summary.value("efficiency").unwrap();
    assert!((efficiency(&later) / efficiency(&whole) - 1.0).abs() < 1e-6);
}

/// The synthetic impact up to [`END`], both sides; `tolerances` of model B by quantity.
fn cut_impact(tolerances: &[&str]) -> (Scene, Outcome, Outcome) {
    let half = Tolerance { relative: Some(0.5), ..Tolerance::default() };
    let tolerances = tolerances.iter().map(|name| ((*name).to_owned(), half)).collect();
    let scene = Scene {
        run: RunSettings { end_time: Some(END) },
        tolerances: BTreeMap::from([("B".to_owned(), tolerances)]),
        ..scene()
    };
    let time: Vec<f64> = (0..=320).map(|k| f64::from(k) * SAMPLE_INTERVAL).collect();
    let mut of_reference = reference();
    of_reference.summary.quantities = summary(&REFERENCE, Source::Reference).quantities.cut();
    of_reference.summary.samples = Some(time.len());
    of_reference.history = history(&REFERENCE, time, Some(SAMPLE_INTERVAL));
    let mut of_model = reduced_of(&REDUCED, "B");
    let time: Vec<f64> = of_model.history.time.iter().copied().filter(|t| *t <= END).collect();
    of_model.summary.quantities = of_model.summary.quantities.cut();
    of_model.summary.samples = Some(time.len());
    of_model.history = history(&REDUCED, time, None);
    (scene, of_reference, of_model)
}

#[test]
fn a_tolerance_of_what_is_not_determined_is_not_met() {
    let (scene, reference, model) = cut_impact(&["first_frequency"]);
    let compared = compare_scene(&scene, &reference, std::slice::from_ref(&model));
    let failed: Vec<_> = compared.models[0].integrity.iter().filter(|c| c.verdict.failed()).collect();
    assert!(compared.verdict.passed(), "{failed:?} {:?}", compared.integrity);
    let row = compared.models[0].discrepancy("efficiency").unwrap();
    assert_eq!(
        (row.verdict, row.reduced, row.reference, row.relative),
        (Verdict::NotGated, None, None, None)
    );
    assert!(compared.models[0].largest().is_none_or(|d| d.quantity == "first_frequency"));
    let document = serde_json::to_value(row).unwrap();
    assert!(["reduced", "reference", "difference", "relative"].iter().all(|field| document[field].is_null()));
    // the curves are compared as far as they go
    assert!(compared.window.is_some_and(|window| (window.end / END - 1.0).abs() < 1e-9));
    assert!(compared.models[0].discrepancy("outer_force_rms").unwrap().reduced.unwrap() > 0.0);

    let (scene, reference, model) = cut_impact(&["efficiency"]);
    let compared = compare_scene(&scene, &reference, &[model]);
    assert_eq!(compared.verdict, Verdict::Fail);
    let rows = compared.models[0].discrepancies.iter().filter(|row| row.verdict.failed());
    assert_eq!(rows.map(|row| row.quantity.as_str()).collect::<Vec<_>>(), ["efficiency"]);
}

#[test]
fn report_and_terminal_say_what_is_not_determined() {
    let (scene, reference, model) = cut_impact(&["efficiency"]);
    let reduced = [model];
    let report = SceneReport {
        scene: &scene,
        comparison: compare_scene(&scene, &reference, &reduced),
        reference: &reference,
        reduced: &reduced,
        provenance: serde_json::json!({}),
        command: "impactcheck compare".into(),
        attachments: Attachments::default(),
    };
    let report = Report { scenes: vec![report], rules: GateRules::default() };
    let sentence = "efficiency: model not determined, reference not determined; a tolerance needs both";
    for text in [terminal(&report, Width::Narrow), junit(&report).unwrap()] {
        // the terminal breaks lines
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(sentence), "{text}");
    }
    assert!(
        terminal(&report, Width::Narrow)
            .lines()
            .any(|line| line.trim_start().starts_with("reference  ") && line.contains("not determined"))
    );
    let drawn = figure(&report.scenes[0], impactcheck::report::Theme::Standalone);
    for text in [index_page(&report), scene_page(&report.scenes[0]), markdown(&report), drawn] {
        assert!(!text.contains("NaN"), "a number that is none");
    }
    assert!(curves_csv(&report.scenes[0]).unwrap().lines().count() > 1000);
}
