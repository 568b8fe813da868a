//! Models and reference say when the theories that they share no longer hold.

use impactcheck::comparison::compare_scene;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::kinds::schema;
use impactcheck::reference::{Lookup, Resolution, Store};
use impactcheck::report::{Attachments, SceneReport, scene_page};
use impactcheck::result::{Limit, Summary};
use impactcheck::scene::{Model, Scene};
use std::f64::consts::PI;

const BASE: &str = include_str!("../../scenes/scaled-plate-r10.toml");

/// The scene with `from` replaced by `to`.
fn scene(from: &str, to: &str) -> Scene {
    assert!(BASE.contains(from));
    Scene::parse("scene.toml", &BASE.replacen(from, to, 1)).expect("valid")
}

fn with_yield_strength(value: &str) -> Scene {
    scene("density ", &format!("yield_strength = \"{value}\"\ndensity "))
}

fn run(scene: &Scene, model: Model) -> Summary {
    Reduced::new(scene, model, None).expect("model").run_with_history(1e-6).expect("run").summary
}

fn limit<'s>(summary: &'s Summary, measure: &str) -> &'s Limit {
    summary.limits.iter().find(|limit| limit.measure == measure).unwrap_or_else(|| panic!("{measure}"))
}

fn warned(summary: &Summary, measure: &str) -> bool {
    summary.warnings.iter().any(|warning| warning.starts_with(&format!("{measure} is ")))
}

#[test]
fn the_scenes_of_the_paper_are_within_all_bounds_and_seventeen_gigapascals_are_not() {
    for model in [Model::A, Model::B, Model::C] {
        let slow = run(&scene("a", "a"), model);
        assert_eq!(slow.limits.len(), 6);
        assert!(slow.limits.iter().all(|limit| !limit.is_exceeded()), "{model}: {:?}", slow.limits);
    }
    for model in [Model::A, Model::B] {
        let fast = run(&scene("550 mm/s", "100 m/s"), model);
        let pressure = fast.contact_pressure.expect("contacts").outer;
        assert!(pressure.maximum_pressure > 16e9);
        for measure in [
            "outer contact radius / tip radius",
            "outer shear strain",
            "inner shear strain",
            "plate deflection / thickness",
            "outer impact speed / wave speed",
        ] {
            assert!(warned(&fast, measure), "{model}: {measure} {:?}", fast.warnings);
        }
        // by hand: steel's bar speed, Hertz's a/r, 0.31 p0 / G
        let found = |measure| limit(&fast, measure).value;
        assert!(
            (found("outer_impact_speed_over_wave_speed") - 100.0 / (210e9_f64 / 7780.0).sqrt()).abs() < 1e-12
        );
        let by_pressure = PI * pressure.maximum_pressure / (210e9 / 0.91);
        assert!((found("outer_contact_radius_over_tip_radius") / by_pressure - 1.0).abs() < 1e-9);
        let strain = 0.31 * pressure.maximum_pressure / (210e9 / 2.6);
        assert!((found("outer_shear_strain") / strain - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_yield_strength_is_checked_and_changes_nothing_else() {
    let (without, soft, hard) = (scene("a", "a"), with_yield_strength("1 GPa"), with_yield_strength("2 GPa"));
    assert_eq!(without.hash(), soft.hash());
    assert_eq!(
        schema()["properties"]["materials"]["additionalProperties"]["required"].as_array().unwrap().len(),
        3
    );
    let [plain, soft_run, hard_run] = [&without, &soft, &hard].map(|scene| run(scene, Model::B));
    assert_eq!(plain.quantities, soft_run.quantities);
    let measure = "outer_contact_pressure_over_onset_of_yield";
    assert!(plain.limits.iter().all(|limit| limit.measure != measure));
    // onset at p0 = 1.6 Y
    let expected = soft_run.contact_pressure.unwrap().outer.maximum_pressure / 1.6e9;
    assert!((limit(&soft_run, measure).value / expected - 1.0).abs() < 1e-12);
    assert!(warned(&soft_run, "outer contact pressure / onset of yield"));
    assert!(!warned(&hard_run, "outer contact pressure / onset of yield"), "{:?}", hard_run.warnings);

    // the stored reference is one of this scene still, and is judged alike
    let Lookup::Found(stored) = Store::open(None).find(&soft, Resolution::Paper) else { panic!("stale") };
    let reference = &stored.outcome.summary;
    assert!(warned(reference, "outer contact pressure / onset of yield"));
    for measure in [measure, "plate_deflection_over_thickness", "inner_shear_strain"] {
        let (one, other) = (limit(reference, measure).value, limit(&soft_run, measure).value);
        assert!((one / other - 1.0).abs() < 0.1, "{measure}: {one} {other}");
    }
}

#[test]
fn the_page_reports_the_limits_and_what_was_not_checked() {
    for (scene, checked) in [(scene("a", "a"), false), (with_yield_strength("1 GPa"), true)] {
        let Lookup::Found(stored) = Store::open(None).find(&scene, Resolution::Paper) else {
            panic!("stored")
        };
        let reduced = [Reduced::new(&scene, Model::B, None).unwrap().run_with_history(1e-6).unwrap()];
        let page = scene_page(&SceneReport {
            scene: &scene,
            comparison: compare_scene(&scene, &stored.outcome, &reduced),
            reference: &stored.outcome,
            reduced: &reduced,
            provenance: serde_json::Value::Null,
            command: String::new(),
            attachments: Attachments::default(),
        });
        assert!(page.contains("<h2>Assumptions</h2>"));
        assert_eq!(
            page.matches("Elastic limit not checked: no yield strength is specified").count(),
            usize::from(!checked)
        );
        assert_eq!(page.contains("the contact yields"), checked);
        // the sentence at the top says what the measures say
        assert_eq!(page.contains("assumptions hold"), !checked);
        let beyond = "assumptions violated: outer contact pressure over onset of yield is ";
        assert_eq!(page.contains(beyond), checked);
        assert!(page.contains("Reference: contact pressure at the force peaks"));
    }
}
