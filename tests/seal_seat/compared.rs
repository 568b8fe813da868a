//! The reduced seal seat compared with a reference: verdicts, bands, report.

use super::reduced::{fixture, model, sixteen};
use impactcheck::comparison::{ComparisonInput, GateRules, Verdict, compare_scene};
use impactcheck::kinds::flight::{flight_summary, launch};
use impactcheck::report::{self, Cost, Report, SceneReport};
use impactcheck::result::{Outcome, Source};
use impactcheck::scene::Scene;
use serde_json::Value;

/// A stand-in for a stored reference: model C with more modes, said to be finite elements.
fn stand_in() -> Outcome {
    let Outcome { mut summary, history } = model(40).run_with_history(1e-3).expect("run");
    summary.source = Source::Reference;
    summary.model = None;
    summary.modes = None;
    summary.sample_interval = Some(history.time[1]);
    Outcome { summary, history }
}

fn alter(outcome: &mut Outcome, name: &str, change: fn(f64) -> f64) {
    let value = outcome.summary.quantities.value_mut(name).expect("a quantity");
    *value = value.map(change);
}

fn gated_scene() -> Scene {
    let text = std::fs::read_to_string(fixture("seal-seat.toml")).expect("scene");
    let text = format!(
        "{text}\n[tolerances.C]\nsphere_angle = {{ absolute = \"0.5 deg\" }}\nsphere_speed = {{ relative = 0.01 }}\n\
         sphere_force_peak = {{ relative = 0.03 }}\nactuator_force_peak = {{ relative = 0.03 }}\n"
    );
    Scene::parse("seal-seat.toml", &text).expect("scene")
}

#[test]
fn comparison_passes_the_model_and_fails_whatever_is_tampered_with() {
    let scene = gated_scene();
    let reference = stand_in();
    let good = sixteen().run_with_history(1e-3).expect("run");
    let compared = compare_scene(&scene, &reference, std::slice::from_ref(&good));
    let failed: Vec<_> = compared.models[0].integrity.iter().filter(|c| !c.verdict.passed()).collect();
    assert_eq!(compared.verdict, Verdict::Pass, "{failed:?} {:?}", compared.integrity);
    assert_eq!(compared.models[0].gated(), 4);
    assert_eq!(compared.models[0].curves.len(), 10);
    type Change = fn(&mut Outcome);
    let changes: [(&str, Change); 12] = [
        ("direction", |o| alter(o, "sphere_angle", |v| v + 0.0175)),
        ("speed", |o| alter(o, "sphere_speed", |v| v * 1.02)),
        ("peak of the sphere's force", |o| alter(o, "sphere_force_peak", |v| v * 1.05)),
        ("peak of the actuator's force", |o| alter(o, "actuator_force_peak", |v| v * 0.95)),
        ("efficiency that is not the velocity's", |o| alter(o, "efficiency", |v| v * 1.01)),
        ("not a number", |o| alter(o, "left_flank_impulse", |_| f64::NAN)),
        ("force curve", |o| o.history["sphere_force"].iter_mut().for_each(|f| *f *= 1.05)),
        ("one component of the force", |o| {
            o.history["sphere_force_x"].iter_mut().for_each(|f| *f = -*f);
        }),
        ("velocity curve", |o| o.history["sphere_velocity_x"].iter_mut().for_each(|v| *v *= 1.05)),
        ("path", |o| o.history["actuator_displacement"].iter_mut().for_each(|x| *x *= 1.05)),
        ("a sample lost", |o| {
            o.history.time.pop();
        }),
        ("another scene", |o| o.summary.scene_hash = "0".into()),
    ];
    for (what, change) in changes {
        let mut bad = good.clone();
        change(&mut bad);
        assert_eq!(compare_scene(&scene, &reference, &[bad]).verdict, Verdict::Fail, "{what}");
    }
}

/// The reference's launch flies in the model's chamber; a model that throws the sphere too weakly has another share of shifts, which a
/// tolerance holds.
#[test]
fn the_launches_of_reference_and_model_have_the_same_flight() {
    let text = std::fs::read_to_string(fixture("seal-seat.toml")).expect("scene");
    let flight =
        "[flight]\nchamber_height = 0.02\nfriction = 0.2\nrestitution = 0.5\n[flight.spring]\nforce = 0.04\n";
    let text = format!("{text}\n{flight}[tolerances.C]\nlanding_share = {{ absolute = 0.1 }}\n");
    let scene = Scene::parse("seal-seat.toml", &text).expect("scene");
    let flown = |mut outcome: Outcome| {
        let launch = launch(&scene, &outcome.summary).expect("a launch");
        outcome.summary.flight = Some(flight_summary(&scene, launch, 0.5).expect("a chamber"));
        outcome
    };
    let reference = stand_in();
    let good = sixteen().run_with_history(1e-3).expect("run");
    let mut weak = good.clone();
    for name in ["sphere_velocity_x", "sphere_velocity_z"] {
        alter(&mut weak, name, |v| 0.3 * v);
    }
    let compared = compare_scene(&scene, &reference, &[flown(good), flown(weak)]);
    let of_reference = compared.reference.flight.as_ref().expect("flown");
    assert_eq!(Some(of_reference.launch), launch(&scene, &reference.summary));
    let rows = [0, 1].map(|k| compared.models[k].discrepancy("landing_share").expect("a row"));
    assert!(rows.iter().all(|row| row.reference == Some(of_reference.share)), "{rows:?}");
    assert!(of_reference.share > 0.5, "{} {:?}", of_reference.share, of_reference.launch);
    assert_eq!(rows.map(|row| row.verdict), [Verdict::Pass, Verdict::Fail]);
    assert_eq!(rows[1].reduced, Some(0.0));
    // without a flight there is neither
    let alone = compare_scene(&gated_scene(), &reference, &[sixteen().run_with_history(1e-3).expect("run")]);
    assert!(alone.reference.flight.is_none() && alone.models[0].discrepancy("landing_share").is_none());
}

/// The error of a mesh that both sides have leaves with the difference; what it does to the difference itself counts.
#[test]
fn on_a_common_mesh_the_band_of_the_difference_decides() {
    let scene = gated_scene();
    let mut reference = stand_in();
    let speed = reference.summary.value("sphere_speed").expect("a speed");
    reference.summary.uncertainty.insert("sphere_speed".into(), 0.1 * speed);
    let good = sixteen().run_with_history(1e-3).expect("run");
    let alone = compare_scene(&scene, &reference, std::slice::from_ref(&good));
    assert_eq!(alone.verdict, Verdict::Undecided);
    let with_coarser = |other: &Outcome, model: &Outcome| {
        let coarser = Some((other, std::slice::from_ref(model)));
        let finer = ComparisonInput::new(&scene, &reference, std::slice::from_ref(&good));
        ComparisonInput { coarser, ..finer }.compare()
    };
    let judged = |of_reference: fn(f64) -> f64, of_model: fn(f64) -> f64| {
        let (mut other, mut model) = (reference.clone(), good.clone());
        alter(&mut other, "sphere_speed", of_reference);
        alter(&mut model, "sphere_speed", of_model);
        let compared = with_coarser(&other, &model);
        let row = compared.models[0].discrepancy("sphere_speed").expect("a row").clone();
        assert_eq!(row.verdict, compared.verdict);
        assert_eq!(row.would_decide.is_some(), row.verdict == Verdict::Undecided);
        (row.verdict, row.difference_uncertainty.expect("a band") / speed)
    };
    assert_eq!(judged(|v| 1.05 * v, |v| 1.05 * v).0, Verdict::Pass);
    // against a tolerance of 1 % a change by 0.2 % of what the mesh does not do to both is little, one of 0.4 % too much
    let (verdict, band) = judged(|v| v, |v| 1.002 * v);
    assert_eq!(verdict, Verdict::Pass);
    assert!((band / (3.0 * 0.002 / (1.5_f64.powf(1.5) - 1.0)) - 1.0).abs() < 1e-2, "{band}");
    assert_eq!(judged(|v| v, |v| 1.004 * v).0, Verdict::Undecided);
    assert_eq!(judged(|v| 1.004 * v, |v| v).0, Verdict::Undecided);
    // what is no narrower than the reference's own band does not count
    let mut other = reference.clone();
    alter(&mut other, "sphere_speed", |v| 1.5 * v);
    assert_eq!(with_coarser(&other, &good), alone);
}

#[test]
fn report_shows_the_seat_among_the_scenes() {
    let scene = gated_scene();
    let reference = stand_in();
    let reduced = vec![sixteen().run_with_history(1e-3).expect("run")];
    let seat = SceneReport {
        scene: &scene,
        comparison: compare_scene(&scene, &reference, &reduced),
        reference: &reference,
        reduced: &reduced,
        provenance: serde_json::json!({"created": "2026-01-01T00:00:00Z"}),
        command: "impactcheck compare seal-seat-improved".into(),
        attachments: report::Attachments {
            cost: vec![Cost { setup_seconds: 1.0, dofs: 5929 }],
            ..report::Attachments::default()
        },
    };
    let angle = reference.summary.value("sphere_angle").expect("determined").to_degrees();
    let report = Report { scenes: vec![seat], rules: GateRules::default() };
    let document: Value = serde_json::from_str(&report::json(&report).expect("JSON")).expect("JSON");
    assert_eq!(document["verdict"], "pass");
    assert_eq!(document["scenes"][0]["scene"], "seal-seat-improved");
    assert!(document["scenes"][0]["models"][0]["summary"]["sphere_angle"].is_f64());
    assert!(report::junit(&report).expect("JUnit").contains("classname=\"seal-seat-improved.C\""));
    assert!(report::markdown(&report).contains("## seal-seat-improved: pass"));
    assert!(report::terminal(&report, report::Width::Narrow).contains(&format!("{angle:+.2}°")));
    let folder = tempfile::tempdir().expect("folder");
    let written = report::write(&report, folder.path()).expect("files");
    for name in
        ["seal-seat-improved.html", "seal-seat-improved-section.svg", "seal-seat-improved.csv", "index.html"]
    {
        assert!(written.iter().any(|path| path.ends_with(name)), "{name}");
    }
    let page = std::fs::read_to_string(folder.path().join("seal-seat-improved.html")).expect("page");
    assert!(
        page.contains("intended, with the reference's speed: +15.00°")
            && page.contains(&format!("reference: {angle:+.2}°"))
    );
    // drawn to scale on the page, and with its curves in a figure of its own
    let number = |start: &str| -> f64 {
        let text = page.split(start).nth(1).expect("drawn").split('"').next().expect("end");
        text.parse().expect("number")
    };
    let sphere = page.split("class=\"fig-body sphere\"").nth(1).expect("sphere");
    let radius: f64 =
        sphere.split("r=\"").nth(1).and_then(|r| r.split('"').next()?.parse().ok()).expect("radius");
    let setup = scene.seal_seat().expect("seal seat");
    assert!((radius / number("data-scale=\"") / setup.sphere.radius - 1.0).abs() < 1e-3, "{radius} px");
    let figure = report::printed_figure(&report.scenes[0], 85.0);
    for name in ["sphere x", "sphere z", "actuator", "Contact force in N"] {
        assert!(figure.contains(&format!(">{name}<")), "{name}");
    }
    let index = std::fs::read_to_string(folder.path().join("index.html")).expect("page");
    assert!(index.contains("seal-seat-improved.html"));
    let curves = std::fs::read_to_string(folder.path().join("seal-seat-improved.csv")).expect("curves");
    assert_eq!(curves.lines().next().expect("header").split(',').count(), 21);
}
