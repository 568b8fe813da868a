//! Prediction intervals against references that they were not made from.

use impactcheck::evidence::study::{self, Cell};
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::prediction::{Interval, LEVEL, predict, scale};
use impactcheck::report::model_page;
use impactcheck::scene::{Model, Scene, resolve};
use impactcheck::validated::shipped;
use std::path::PathBuf;

/// Folder of the validation scenes.
const VALIDATION: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/validation");

/// Whether `within` of `count` is what the level lets expect, in all but one case of a thousand.
fn is_expected(within: usize, count: usize) -> bool {
    let n = count as f64;
    (within as f64 - LEVEL * n).abs() <= 3.3 * (n * LEVEL * (1.0 - LEVEL)).sqrt() + 1.0
}

/// Halves of large groups predict each other, single scenes of small groups are predicted by all others.
#[test]
fn intervals_from_some_scenes_of_the_base_hold_the_others() {
    let study = study::prediction::run(&mut |_| ()).unwrap();
    let count = |cell: &Cell| if let Cell::Number(share) = cell { *share } else { f64::NAN };
    let mut judged = 0;
    for row in &study.rows {
        let (Cell::Count(values), share) = (row[2], count(&row[3])) else { panic!("{row:?}") };
        if values > 0 {
            let within = (share * values as f64).round() as usize;
            assert!(is_expected(within, values), "{row:?}");
            judged += 1;
        }
    }
    assert!(judged >= 8);
    // by the base, by finer meshes of some of its scenes, and by those values that decide
    for claim in &study.claims[..3] {
        assert!(claim.ours.unwrap() < 0.07, "{claim:?}");
    }
    let svg = study::prediction::figure(&study);
    assert!(svg.matches("<circle").count() > 500 && !svg.contains("NaN"));
}

/// Of a result that has not converged by 5 %: no interval is narrower but that of the frequency.
#[test]
fn intervals_hold_the_error_that_a_result_states() {
    let scene = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let converged = Reduced::new(&scene, Model::C, None).and_then(|model| model.run(1e-7)).unwrap();
    let mut summary = converged.clone();
    summary.integration_error = Some(0.05);
    let [wide, narrow] = [&summary, &converged].map(|summary| predict(&scene, summary).unwrap());
    for name in ["efficiency", "outer_force_peak", "inner_velocity_final"] {
        let scale =
            scale(name, |name| summary.value(name), scene.plate_impact().unwrap().outer.speed).unwrap();
        let half = |interval: &Interval| 0.5 * (interval.high - interval.low) / scale;
        assert!(half(&wide[name]) >= 0.05 && half(&narrow[name]) < 0.02, "{name}: {:?}", wide[name]);
    }
    assert_eq!(wide["first_frequency"].high, narrow["first_frequency"].high);
}

/// Scenes that were chosen by hand, solved on finer meshes than those of the base: their references lie within, but for their bands.
#[test]
fn intervals_hold_the_references_of_the_validation_scenes() {
    let (mut within, mut count, mut missed) = (0, 0, Vec::new());
    for known in
        shipped().unwrap().iter().filter(|known| known.model == "C" && known.partner == "axisymmetric")
    {
        let aside = PathBuf::from(VALIDATION).join(format!("{}.toml", known.scene));
        let Ok(scene) = Scene::read(resolve(&known.scene).unwrap_or(aside)) else { continue };
        if scene.hash() != known.scene_hash {
            continue;
        }
        let Ok(summary) = Reduced::new(&scene, Model::C, None).and_then(|model| model.run(1e-7)) else {
            continue;
        };
        let Ok(intervals) = predict(&scene, &summary) else { continue };
        for row in &known.rows {
            let Some(interval) = intervals.get(row.quantity.as_str()) else { continue };
            let band = row.band.unwrap_or(0.0);
            let held = (interval.low - band..=interval.high + band).contains(&row.reference);
            within += usize::from(held);
            count += 1;
            if !held {
                missed
                    .push(format!("{} {}: {} not in {interval:?}", known.scene, row.quantity, row.reference));
            }
        }
    }
    assert!(count >= 40, "{count}");
    assert!(is_expected(within, count), "{within} of {count}: {missed:#?}");
}

/// The page of a model has a column of intervals, or the reason why there is none.
#[test]
fn the_page_of_a_model_shows_what_a_reference_would_find() {
    let page = |name: &str, more: &str| {
        let text = std::fs::read_to_string(resolve(name).unwrap()).unwrap() + more;
        let scene = Scene::parse(name, &text).unwrap();
        let outcome = Reduced::new(&scene, Model::C, None).unwrap().run_with_history(1e-7).unwrap();
        model_page(&scene, &outcome, &predict(&scene, &outcome.summary))
    };
    assert!(page("scaled-plate-r10", "").contains("a converged reference would find (95 %)"));
    let none = page("scaled-plate-r10", "\n[series]\nimpacts = 2\n");
    assert!(none.contains(
        "no interval of what a converged reference would find: the validation base has no repeated impacts"
    ));
}

/// The scale of a force is the force, of a velocity the impact's speed; negligible parts of an impact have its own.
#[test]
fn what_is_negligible_has_the_scale_of_the_impact() {
    let values = |name: &str| match name {
        "outer_force_peak" => Some(300.0),
        "inner_force_peak" => Some(3.0),
        "inner_velocity_final" | "efficiency" => Some(0.0),
        _ => None,
    };
    let scales =
        ["outer_force_peak", "inner_force_peak", "inner_velocity_final", "efficiency", "first_frequency"]
            .map(|name| scale(name, values, 0.5));
    assert_eq!(scales, [Some(300.0), None, Some(0.5), Some(0.05), None]);
}
