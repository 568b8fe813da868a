//! Curves of differently sampled histories on one axis, and the JSON document of a comparison.

use crate::synthetic_impact;
use crate::synthetic_impact::{REDUCED, REFERENCE, SAMPLE_INTERVAL, history, reduced, reference, scene};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use impactcheck::comparison::{Comparison, compare_scene};
use impactcheck::kinds::plate_impact::{CURVES, PlateQuantities};
use impactcheck::result::{Quantity, Source};
use std::f64::consts::PI;

/// The same solution, sampled differently, differs by the interpolation error only.
#[test]
fn other_sampling_is_no_discrepancy() {
    let same = synthetic_impact::reduced_of(&REFERENCE, "B");
    let comparison = compare_scene(&scene(), &reference(), &[same]);
    let model = &comparison.models[0];
    for curve in CURVES.iter().map(|curve| curve.name) {
        let row = model.discrepancy(&format!("{curve}_rms")).unwrap();
        // Averaging over the sampling interval delays a force by half of it: 0.1 % of the peak.
        assert!(row.relative.unwrap() < 1.5e-3, "{row:?}");
        let metrics = model.curves.iter().find(|c| c.quantity == curve).unwrap();
        assert!(metrics.sprague_geers.unwrap() < 1.5e-3, "{metrics:?}");
        assert!(metrics.iso18571.unwrap() > 0.99, "{metrics:?}");
    }
}

/// Root mean square of the difference of two half-sine forces over the window, in closed form.
#[test]
fn rms_of_two_half_sines_matches_the_integral() {
    let (mut m, mut c) = (REFERENCE, REFERENCE);
    m.outer.peak = 250.0;
    c.outer.peak = 200.0;
    let mut coarse = reference();
    coarse.summary = synthetic_impact::summary(&m, Source::Reference);
    coarse.history = history(&m, coarse.history.time.clone(), None);
    let comparison = compare_scene(&scene(), &coarse, &[synthetic_impact::reduced_of(&c, "B")]);
    let window = comparison.window.unwrap();
    assert_eq!((window.start, window.samples), (0.0, 1501));
    assert_relative_eq!(window.end, 1.1 * 180e-6, max_relative = 1e-12);
    let row = comparison.models[0].discrepancy("outer_force_rms").unwrap();
    let expected = 50.0 * (0.5 * 180e-6 / window.end).sqrt();
    assert_relative_eq!(row.difference.unwrap(), expected, max_relative = 1e-3);
    assert_relative_eq!(row.relative.unwrap(), expected / 250.0, max_relative = 1e-3);
    let row = comparison.models[0].discrepancy("outer_force_max").unwrap();
    assert_relative_eq!(row.difference.unwrap(), 50.0, max_relative = 1e-3);
}

/// A reduced history that ends after its last contact goes on in free flight: the spheres' curves
/// cover the window, the plate's end with the history.
#[test]
fn free_flight_extends_the_spheres_but_not_the_plate() {
    let outcome = reduced();
    let end = *outcome.history.time.last().unwrap();
    let velocity = *outcome.history["outer_velocity"].last().unwrap();
    let comparison = compare_scene(&scene(), &reference(), &[outcome]);
    let window = comparison.window.unwrap();
    assert!(end < window.end);
    for curve in &comparison.models[0].aligned {
        let covered = if curve.quantity.starts_with("plate") { end } else { window.end };
        assert_relative_eq!(curve.axis.end, covered);
        assert_eq!(curve.reduced.len(), window.samples);
    }
    let displacement = &comparison.models[0].aligned[0];
    let last = displacement.reduced[window.samples - 1] - displacement.reduced[window.samples - 2];
    let step = window.end / (window.samples - 1) as f64;
    assert_relative_eq!(last / step, velocity, max_relative = 1e-9);
    let force = comparison.models[0].aligned.iter().find(|a| a.quantity == "outer_force").unwrap();
    assert_eq!(*force.reduced.last().unwrap(), 0.0);
}

/// A run that ends in contact covers nothing beyond its end.
#[test]
fn run_that_ends_in_contact_is_compared_up_to_its_end() {
    let mut outcome = reduced();
    let time: Vec<f64> = outcome.history.time.iter().copied().filter(|&t| t <= 60e-6).collect();
    outcome.history = history(&REDUCED, time, None);
    // without its forces nobody knows that it flies: velocities alone, of another program
    let mut velocities = outcome.clone();
    velocities.history.curves.retain(|curve| curve.name.ends_with("velocity"));
    for (outcome, curves) in [(outcome, CURVES.len()), (velocities, 3)] {
        let comparison = compare_scene(&scene(), &reference(), &[outcome]);
        assert_eq!(comparison.models[0].aligned.len(), curves);
        for curve in &comparison.models[0].aligned {
            assert_relative_eq!(curve.axis.end, 60e-6, max_relative = 1e-12);
        }
    }
}

/// Half a sampling interval is what averaging delays a force by; nothing else may move it.
#[test]
fn averaged_force_is_the_force_half_an_interval_earlier() {
    let averaged = reference().history;
    for k in [100, 400, 900] {
        let t = averaged.time[k] - 0.5 * SAMPLE_INTERVAL;
        let exact = REFERENCE.outer.peak * (PI * t / REFERENCE.outer.end).sin();
        assert_relative_eq!(averaged["outer_force"][k], exact, max_relative = 1e-5);
    }
}

/// Every field that the document promises, with numbers that belong together.
#[test]
fn json_document_has_the_fields_of_the_contract() {
    let comparison = Comparison::new(vec![compare_scene(&scene(), &reference(), &[reduced()])]);
    let document: serde_json::Value =
        serde_json::from_str(&serde_json::to_string(&comparison).unwrap()).unwrap();
    assert_eq!(document["schema_version"], 1);
    // no tolerance is given
    assert_eq!(document["verdict"], "not_gated");
    let scene = &document["scenes"][0];
    assert_eq!(scene["scene"], "synthetic");
    assert_eq!(scene["reference"]["source"], "reference");
    let model = &scene["models"][0];
    assert_eq!((&model["model"], &model["verdict"]), (&"B".into(), &"not_gated".into()));
    let rows = model["discrepancies"].as_array().unwrap();
    for Quantity { name: quantity, unit, .. } in PlateQuantities::ALL.iter().copied() {
        let row = rows.iter().find(|r| r["quantity"] == quantity).unwrap();
        assert_eq!(row["unit"], unit);
        let number = |field: &str| row[field].as_f64().unwrap();
        assert_eq!(number("reduced"), model["summary"][quantity].as_f64().unwrap());
        assert_eq!(number("reference"), scene["reference"][quantity].as_f64().unwrap());
        assert_eq!(number("difference"), number("reduced") - number("reference"));
        let relative = number("difference") / number("reference").abs();
        assert_abs_diff_eq!(number("relative"), relative, epsilon = 1e-15);
        assert!(row["tolerance"].is_null());
        assert_eq!(row["verdict"], "not_gated");
    }
    let efficiency = rows.iter().find(|r| r["quantity"] == "efficiency").unwrap();
    assert_eq!(efficiency["uncertainty"], 2e-4);
    for curve in CURVES.iter().map(|curve| curve.name) {
        for kind in ["rms", "max"] {
            assert!(rows.iter().any(|r| r["quantity"] == format!("{curve}_{kind}")));
        }
        let curves = model["curves"].as_array().unwrap();
        let metrics = curves.iter().find(|c| c["quantity"] == curve).unwrap();
        for field in ["sprague_geers", "russell", "iso18571"] {
            assert!(metrics[field].is_number(), "{field}");
        }
        assert_eq!(metrics["samples"], 1501);
        assert_eq!(metrics["window"][0], 0.0);
    }
    for residual in ["energy_residual", "momentum_residual"] {
        assert!(rows.iter().any(|r| r["quantity"] == residual));
    }
}

/// A velocity of exactly zero in the reference has no relative difference.
#[test]
fn relative_is_null_where_the_reference_is_zero() {
    let mut still = reference();
    synthetic_impact::alter(&mut still.summary, "outer_velocity_final", |_| 0.0);
    let comparison = compare_scene(&scene(), &still, &[reduced()]);
    let row = comparison.models[0].discrepancy("outer_velocity_final").unwrap();
    assert_eq!(row.relative, None);
    assert!(serde_json::to_value(row).unwrap()["relative"].is_null());
}
