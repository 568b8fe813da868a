//! Test of the harness itself: errors put into a history must make the verdict fail, with the
//! summary left untouched; the untouched results pass.

use crate::synthetic_impact;
use crate::synthetic_impact::{alter, gated_scene, reduced, reference, scene};
use impactcheck::comparison::{Check, ComparisonInput, Verdict, compare_scene};
use impactcheck::kinds::plate_impact::CURVES;
use impactcheck::kinds::plate_impact::PlateQuantities;
use impactcheck::result::History;
use impactcheck::result::Outcome;
use impactcheck::scene::Scene;

fn verdict(scene: &Scene, reference: &Outcome, reduced: &Outcome) -> Verdict {
    compare_scene(scene, reference, std::slice::from_ref(reduced)).verdict
}

/// Checks of the reference are gated like its own, whoever makes them; another solver's result is reported alone.
#[test]
fn what_else_is_known_is_judged_in_one_go() {
    let (scene, reference, reduced) = (gated_scene(), reference(), [reduced()]);
    let check = |verdict| Check {
        check: "accepted_reference_efficiency".into(),
        unit: "1".into(),
        found: 0.7,
        expected: 0.6,
        bound: 0.01,
        verdict,
    };
    let other = {
        let mut other = reference.clone();
        other.summary.model = Some("elsewhere".into());
        other
    };
    for verdict in [Verdict::Pass, Verdict::Fail] {
        let input = ComparisonInput::new(&scene, &reference, &reduced);
        let found =
            ComparisonInput { accepted: vec![check(verdict)], other: Some(&other), ..input }.compare();
        assert_eq!((found.verdict, found.models[0].verdict), (verdict, verdict));
        assert_eq!(found.integrity.last(), Some(&check(verdict)));
        assert_eq!(found.reference_check.as_ref().unwrap().program, "elsewhere");
        // rows do not depend on it
        let alone = compare_scene(&scene, &reference, &reduced);
        assert_eq!(found.models[0].discrepancies, alone.models[0].discrepancies);
    }
}

/// Applies `change` to the reference, then to the reduced result; each must fail although the
/// scene has no tolerance at all.
fn must_fail(what: &str, change: impl Fn(&mut Outcome)) {
    let (mut changed_reference, mut changed_reduced) = (reference(), reduced());
    change(&mut changed_reference);
    change(&mut changed_reduced);
    let found = verdict(&scene(), &changed_reference, &reduced());
    assert_eq!(found, Verdict::Fail, "{what} in the reference");
    let found = verdict(&scene(), &reference(), &changed_reduced);
    assert_eq!(found, Verdict::Fail, "{what} in the reduced model");
}

/// `values` as they were `delay` s earlier, on the same axis.
fn delayed(time: &[f64], values: &[f64], delay: f64) -> Vec<f64> {
    time.iter()
        .map(|t| {
            let t = t - delay;
            let k = time.partition_point(|&x| x <= t);
            match k {
                0 => values[0],
                k if k == time.len() => values[k - 1],
                k => {
                    let s = (t - time[k - 1]) / (time[k] - time[k - 1]);
                    values[k - 1] + s * (values[k] - values[k - 1])
                }
            }
        })
        .collect()
}

#[test]
fn untouched_passes() {
    for (scene, expected) in [(scene(), Verdict::NotGated), (gated_scene(), Verdict::Pass)] {
        let comparison = compare_scene(&scene, &reference(), &[reduced()]);
        for check in comparison.integrity.iter().chain(&comparison.models[0].integrity) {
            assert!(check.verdict.passed(), "{check:?}");
        }
        for row in &comparison.models[0].discrepancies {
            assert_eq!(row.verdict, expected, "{row:?}");
        }
        assert_eq!((comparison.verdict, comparison.models[0].verdict), (expected, expected));
    }
}

#[test]
fn three_per_cent_of_force_fails() {
    for name in ["outer_force", "inner_force"] {
        for factor in [0.97, 1.03] {
            must_fail(&format!("{name} times {factor}"), |outcome| {
                outcome.history[name].iter_mut().for_each(|f| *f *= factor);
            });
        }
    }
}

#[test]
fn two_microseconds_of_shift_fail() {
    must_fail("time column shifted", |outcome| {
        outcome.history.time.iter_mut().for_each(|t| *t += 2e-6);
    });
    must_fail("time column shifted after the first instant", |outcome| {
        outcome.history.time.iter_mut().skip(1).for_each(|t| *t += 2e-6);
    });
    must_fail("all curves late", |outcome| {
        let time = outcome.history.time.clone();
        for name in CURVES.iter().map(|curve| curve.name) {
            let curve = &mut outcome.history[name];
            *curve = delayed(&time, curve, 2e-6);
        }
    });
    must_fail("all curves early", |outcome| {
        let time = outcome.history.time.clone();
        for name in CURVES.iter().map(|curve| curve.name) {
            let curve = &mut outcome.history[name];
            *curve = delayed(&time, curve, -2e-6);
        }
    });
    for name in ["outer_force", "inner_force", "outer_velocity", "inner_velocity"] {
        for delay in [-2e-6, 2e-6] {
            must_fail(&format!("{name} alone by {delay} s"), |outcome| {
                let time = outcome.history.time.clone();
                let curve = &mut outcome.history[name];
                *curve = delayed(&time, curve, delay);
            });
        }
    }
}

#[test]
fn swapped_sign_fails() {
    for name in CURVES.iter().map(|curve| curve.name) {
        must_fail(&format!("{name} with the other sign"), |outcome| {
            outcome.history[name].iter_mut().for_each(|v| *v = -*v);
        });
    }
    must_fail("z axis turned", |outcome| {
        for name in CURVES.iter().map(|curve| curve.name).filter(|name| !name.ends_with("force")) {
            outcome.history[name].iter_mut().for_each(|v| *v = -*v);
        }
    });
}

#[test]
fn missing_sample_fails() {
    for place in [0.0, 0.3, 0.7, 1.0] {
        must_fail(&format!("row missing at {place} of the history"), |outcome| {
            let k = (place * (outcome.history.len() - 1) as f64) as usize;
            outcome.history.time.remove(k);
            for name in CURVES.iter().map(|curve| curve.name) {
                outcome.history[name].remove(k);
            }
        });
    }
    for name in CURVES.iter().map(|curve| curve.name) {
        must_fail(&format!("value missing in {name}"), |outcome| {
            outcome.history[name].remove(20);
        });
    }
}

/// The axis is checked by itself: a missing row is seen even if the number of rows was adapted.
#[test]
fn missing_sample_of_the_reference_fails_by_its_axis() {
    let mut changed = reference();
    changed.history.time.remove(700);
    for name in CURVES.iter().map(|curve| curve.name) {
        changed.history[name].remove(700);
    }
    changed.summary.samples = Some(changed.history.len());
    let comparison = compare_scene(&scene(), &changed, &[]);
    assert_eq!(comparison.verdict, Verdict::Fail);
    let failed: Vec<_> = comparison.integrity.iter().filter(|c| !c.verdict.passed()).collect();
    assert_eq!(failed.len(), 1);
    assert_eq!(failed[0].check, "sample_interval");
}

#[test]
fn nan_fails_wherever_it_stands() {
    for name in CURVES.iter().map(|curve| curve.name) {
        must_fail(&format!("NaN in {name}"), |outcome| {
            outcome.history[name][100] = f64::NAN;
        });
        must_fail(&format!("infinity in {name}"), |outcome| {
            outcome.history[name][100] = f64::INFINITY;
        });
    }
    must_fail("NaN in time", |outcome| outcome.history.time[100] = f64::NAN);
    must_fail("NaN in the efficiency", |o| alter(&mut o.summary, "efficiency", |_| f64::NAN));
    must_fail("NaN in a frequency", |o| alter(&mut o.summary, "first_frequency", |_| f64::NAN));
    must_fail("NaN in a velocity", |o| alter(&mut o.summary, "inner_velocity_final", |_| f64::NAN));
    must_fail("NaN in a contact end", |o| alter(&mut o.summary, "outer_contact_end", |_| f64::NAN));
    must_fail("NaN in the energy residual", |o| o.summary.energy_residual = Some(f64::NAN));
    must_fail("NaN in the momentum residual", |o| o.summary.momentum_residual = Some(f64::NAN));
    let mut changed = reference();
    changed.summary.uncertainty.insert("efficiency".into(), f64::NAN);
    assert_eq!(verdict(&scene(), &changed, &reduced()), Verdict::Fail);
}

/// Whatever is left of a damaged history, the answer is a verdict and no panic.
#[test]
fn empty_and_disordered_histories_fail() {
    must_fail("empty history", |outcome| outcome.history = History::default());
    must_fail("time standing still", |outcome| {
        outcome.history.time[50] = outcome.history.time[49];
    });
    must_fail("a single row", |outcome| {
        outcome.history.time.truncate(1);
        for name in CURVES.iter().map(|curve| curve.name) {
            outcome.history[name].truncate(1);
        }
    });
}

/// A summary that was changed by itself contradicts the history, or its own velocities.
#[test]
fn changed_summary_fails() {
    must_fail("efficiency 1 % high", |o| alter(&mut o.summary, "efficiency", |v| v * 1.01));
    must_fail("outer speed 1 % high", |o| alter(&mut o.summary, "outer_velocity_final", |v| v * 1.01));
    must_fail("inner speed swapped", |o| alter(&mut o.summary, "inner_velocity_final", |v| -v));
    must_fail("outer peak 3 % high", |o| alter(&mut o.summary, "outer_force_peak", |v| v * 1.03));
    must_fail("inner peak 3 % low", |o| alter(&mut o.summary, "inner_force_peak", |v| v * 0.97));
    must_fail("outer contact 2 us longer", |o| alter(&mut o.summary, "outer_contact_end", |v| v + 2e-6));
    must_fail("inner contact 2 us shorter", |o| alter(&mut o.summary, "inner_contact_end", |v| v - 2e-6));
    must_fail("another scene", |o| o.summary.scene_hash = "0ther".into());
}

/// A reduced model that is wrong but consistent is caught by the tolerances, and only by them. (The
/// distance of the curves hardly changes here: the drift happens to lead towards the reference.)
#[test]
fn consistent_drift_fails_by_its_tolerance() {
    let mut drifted = synthetic_impact::REDUCED;
    drifted.outer.peak *= 1.03;
    let drifted = synthetic_impact::reduced_of(&drifted, "B");
    assert_eq!(verdict(&scene(), &reference(), &drifted), Verdict::NotGated);
    let comparison = compare_scene(&gated_scene(), &reference(), &[drifted]);
    assert_eq!(comparison.verdict, Verdict::Fail);
    let model = &comparison.models[0];
    assert!(model.integrity.iter().all(|c| c.verdict.passed()));
    for (quantity, expected) in [
        ("outer_force_peak", Verdict::Fail),
        ("outer_velocity_final", Verdict::Fail),
        ("inner_force_peak", Verdict::Pass),
        ("efficiency", Verdict::Pass),
    ] {
        assert_eq!(model.discrepancy(quantity).unwrap().verdict, expected, "{quantity}");
    }
}

/// Every quantity is gated: its own tolerance alone decides.
#[test]
fn each_quantity_is_gated_by_itself() {
    for quantity in PlateQuantities::ALL.iter().map(|quantity| quantity.name) {
        let mut scene = gated_scene();
        let tolerances = scene.tolerances.values_mut().next().unwrap();
        let tolerance = tolerances.get_mut(quantity).unwrap();
        tolerance.bias = Some(tolerance.bias.unwrap_or(0.0) + 0.01);
        let comparison = compare_scene(&scene, &reference(), &[reduced()]);
        let failed: Vec<_> = comparison.models[0]
            .discrepancies
            .iter()
            .filter(|d| d.verdict.failed())
            .map(|d| d.quantity.as_str())
            .collect();
        assert_eq!(failed, [quantity]);
        assert_eq!(comparison.verdict, Verdict::Fail);
    }
}

#[test]
fn tolerance_of_an_unknown_quantity_fails() {
    let mut scene = gated_scene();
    let tolerances = scene.tolerances.values_mut().next().unwrap();
    let tolerance = tolerances["efficiency"];
    tolerances.insert("eficiency".into(), tolerance);
    assert_eq!(verdict(&scene, &reference(), &reduced()), Verdict::Fail);
}
