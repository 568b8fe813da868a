//! Measured signals (section 3.4): synthetic records of known noise, shift, offset and drift, made from a model's history
//! and laid over the finite-element reference.

use impactcheck::kinds::plate_impact::PlateImpact;
use impactcheck::kinds::plate_impact::approach;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::measured::{
    AlignedRecord, BANDWIDTH, Channel, ContactEnds, Filtered, REFERENCE, Record, Series, Speed, align,
    compare,
};
use impactcheck::reference::{Lookup, Resolution, Store};
use impactcheck::result::Outcome;
use impactcheck::scene::{Model, Scene, resolve};

fn determined(outcome: &Outcome, setup: &PlateImpact) -> ContactEnds {
    ContactEnds::of(&outcome.summary, &approach(setup)).unwrap()
}

fn scene(name: &str) -> (Scene, PlateImpact) {
    let scene = Scene::read(resolve(name).unwrap()).unwrap();
    let setup = scene.plate_impact().unwrap().clone();
    (scene, setup)
}

fn model(scene: &Scene, model: Model) -> Outcome {
    Reduced::new(scene, model, None).unwrap().run_with_history(1e-7).unwrap()
}

fn reference(scene: &Scene) -> Outcome {
    match Store::open(None).find(scene, Resolution::Paper) {
        Lookup::Found(stored) => stored.outcome,
        other => panic!("{other:?}"),
    }
}

/// What is put into a record.
#[derive(Clone, Copy)]
struct Disturbance {
    shift: f64,
    /// Noise, offset and drift over the record, relative to the largest value.
    noise: f64,
    offset: f64,
    drift: f64,
    seed: u64,
}

const DISTURBED: Disturbance = Disturbance { shift: 5e-6, noise: 0.02, offset: 0.07, drift: 0.1, seed: 1 };
const SIGNALS: [&str; 4] = ["outer_displacement", "outer_velocity", "inner_displacement", "inner_velocity"];

/// Normally distributed (Box and Muller).
fn normal(random: &mut fastrand::Rng) -> f64 {
    (-2.0 * (1.0 - random.f64()).ln()).sqrt() * (2.0 * std::f64::consts::PI * random.f64()).cos()
}

/// A record of `truth` as an instrument of 100 kHz gives it, from 100 us before the impact to 200 us after its end.
fn record(truth: &Outcome, signals: &[&'static str], with: Disturbance) -> Record {
    let mut random = fastrand::Rng::with_seed(with.seed);
    let filtered = Filtered::new(&truth.history, BANDWIDTH).unwrap();
    let last = truth.summary.value("outer_contact_end").unwrap() + 200e-6;
    // an uneven axis: any sampling will do
    let mut time = vec![-100e-6];
    while time[time.len() - 1] < last {
        time.push(time[time.len() - 1] + 0.1e-6 * (0.5 + random.f64()));
    }
    let channels = signals
        .iter()
        .map(|quantity| {
            let curve = filtered.curve(quantity).unwrap();
            let true_values: Vec<f64> = time.iter().map(|t| curve(*t)).collect();
            let peak = true_values.iter().fold(0.0_f64, |p, v| p.max(v.abs()));
            let sign = if quantity.starts_with("outer") { -1.0 } else { 1.0 };
            let disturbed = |(t, v): (&f64, &f64)| {
                let slow = with.offset + with.drift * t / (last + 100e-6);
                v + peak * (sign * slow + with.noise * normal(&mut random))
            };
            Channel { quantity, values: time.iter().zip(&true_values).map(disturbed).collect() }
        })
        .collect();
    let time = time.iter().map(|t| t + with.shift).collect();
    Record { file: "synthetic.csv".into(), time, channels, gaps: Vec::new(), integrals: Vec::new() }
}

fn aligned(record: &Record, outcome: &Outcome, setup: &PlateImpact, speed: Speed) -> AlignedRecord {
    let filtered = Filtered::new(&outcome.history, BANDWIDTH).unwrap();
    align(record, &filtered, determined(outcome, setup), &approach(setup), (BANDWIDTH, speed)).unwrap()
}

#[test]
fn shift_within_a_tenth_of_a_microsecond_and_efficiency_within_half_a_point() {
    for name in ["scaled-plate-r10", "scaled-plate-r6.35"] {
        let (scene, setup) = scene(name);
        let truth = model(&scene, Model::C);
        let expected = truth.summary.value("efficiency").unwrap();
        // the model the record was made from, and the finite elements, which differ from it by a little
        for (outcome, seeds) in [(&truth, 1..=8), (&reference(&scene), 1..=3)] {
            let mut bands = Vec::new();
            for seed in seeds {
                let record = record(&truth, &SIGNALS, Disturbance { seed, ..DISTURBED });
                let found = aligned(&record, outcome, &setup, Speed::Scene);
                let (efficiency, band) = (found.efficiency.unwrap(), found.efficiency_uncertainty.unwrap());
                let case = format!("{name}, seed {seed}: {:e} s, {efficiency}", found.shift);
                assert!((found.shift - 5e-6).abs() < 0.1e-6, "{case}");
                assert!((efficiency - expected).abs() < 0.005, "{case}, expected {expected}");
                assert!((efficiency - expected).abs() < 2.0 * band && band < 0.015, "{case} +- {band}");
                bands.push(band);
            }
            // a single record may leave open that its noise is correlated
            let mean = bands.iter().sum::<f64>() / bands.len() as f64;
            assert!(mean < 0.005, "{name}: {bands:?}");
        }
    }
}

#[test]
fn offset_and_drift_that_were_put_in_are_taken_out() {
    let (scene, setup) = scene("scaled-plate-r10");
    let truth = model(&scene, Model::C);
    let record = record(&truth, &SIGNALS, Disturbance { noise: 1e-4, ..DISTURBED });
    let found = aligned(&record, &truth, &setup, Speed::Scene);
    let filtered = Filtered::new(&truth.history, BANDWIDTH).unwrap();
    for signal in &found.signals {
        let curve = filtered.curve(signal.quantity).unwrap();
        let peak = found.time.iter().fold(0.0_f64, |p, t| p.max(curve(*t).abs()));
        for (t, value) in found.time.iter().zip(&signal.values) {
            assert!((value - curve(*t)).abs() < 1e-3 * peak, "{} at {t} s", signal.quantity);
        }
    }
}

#[test]
fn speed_that_differs_from_the_scene_s_is_read_from_a_signal_without_offset() {
    let (scene, setup) = scene("scaled-plate-r10");
    let mut faster = setup.clone();
    faster.outer.speed = 0.62;
    let truth = model(&Scene { setup: faster.into(), ..scene.clone() }, Model::C);
    let disturbance = Disturbance { offset: 0.0, drift: 0.0, ..DISTURBED };
    let record = record(&truth, &SIGNALS, disturbance);
    let found = aligned(&record, &reference(&scene), &setup, Speed::Measured);
    assert!((found.outer_velocity_initial + 0.62).abs() < 0.003, "{}", found.outer_velocity_initial);
    let expected = truth.summary.value("efficiency").unwrap();
    assert!((found.efficiency.unwrap() - expected).abs() < 0.01, "{:?}", found.efficiency);
    // the partner is slower, so that its contacts last 2.4 % (4 us) longer; the shift follows by a part of that
    assert!((found.shift - 5e-6).abs() < 2e-6, "{}", found.shift);
    let trusting_the_scene = aligned(&record, &reference(&scene), &setup, Speed::Scene);
    assert!((trusting_the_scene.efficiency.unwrap() - expected).abs() > 0.05);
}

/// The speed before the impact is then measured too, with the noise of its signal.
#[test]
fn a_measured_speed_widens_the_interval_of_the_efficiency() {
    let (scene, setup) = scene("scaled-plate-r10");
    let truth = model(&scene, Model::C);
    let record = record(&truth, &SIGNALS, Disturbance { offset: 0.0, drift: 0.0, ..DISTURBED });
    let [of_scene, measured] = [Speed::Scene, Speed::Measured]
        .map(|speed| aligned(&record, &truth, &setup, speed).efficiency_uncertainty.unwrap());
    assert!((1.1..3.0).contains(&(measured / of_scene)), "{measured} and {of_scene}");
}

#[test]
fn one_signal_is_enough_and_missing_free_flight_is_reported() {
    let (scene, setup) = scene("scaled-plate-r10");
    let truth = model(&scene, Model::C);
    let expected = truth.summary.value("efficiency").unwrap();
    let quiet = Disturbance { noise: 0.002, ..DISTURBED };
    for signals in
        [&["inner_velocity"][..], &["inner_displacement"], &["outer_velocity", "inner_displacement"]]
    {
        let found = aligned(&record(&truth, signals, quiet), &truth, &setup, Speed::Scene);
        assert!((found.shift - 5e-6).abs() < 0.2e-6, "{signals:?}: {}", found.shift);
        assert!((found.efficiency.unwrap() - expected).abs() < 0.005, "{signals:?}: {:?}", found.efficiency);
    }
    let whole = record(&truth, &SIGNALS, quiet);
    let part = |keep: &dyn Fn(f64) -> bool| {
        let selected: Vec<usize> = (0..whole.time.len()).filter(|i| keep(whole.time[*i])).collect();
        let pick = |values: &[f64]| selected.iter().map(|i| values[*i]).collect::<Vec<f64>>();
        let channels = whole
            .channels
            .iter()
            .map(|c| Channel { quantity: c.quantity, values: pick(&c.values) })
            .collect();
        Record {
            file: "part.csv".into(),
            time: pick(&whole.time),
            channels,
            gaps: Vec::new(),
            integrals: Vec::new(),
        }
    };
    let late = part(&|t| t > 0.0);
    let filtered = Filtered::new(&truth.history, BANDWIDTH).unwrap();
    let error =
        align(&late, &filtered, determined(&truth, &setup), &approach(&setup), (BANDWIDTH, Speed::Scene))
            .unwrap_err();
    assert_eq!(error.exit_status() as u8, 3);
    // 5 us of it, some fifty samples, are before the first touch, but the instrument smears the impact over all of them
    let said = error.to_string().replace('\u{2502}', " ").split_whitespace().collect::<Vec<_>>().join(" ");
    let (before, after) =
        said.split_once(" samples before the first contact, ").unwrap_or_else(|| panic!("{said}"));
    let early: usize = before.rsplit(' ').next().unwrap().parse().unwrap();
    assert!((10..=100).contains(&early) && after.starts_with("0 of them"), "{said}");
    let cut = aligned(&part(&|t| t < 90e-6), &truth, &setup, Speed::Scene);
    assert!(cut.efficiency.is_none() && cut.inner_velocity_final.is_none(), "no free flight to read it from");
}

/// A force cell behind the inner body tells its velocity by the impulse, with a band that holds.
#[test]
fn the_force_on_the_inner_body_shows_the_efficiency() {
    let (scene, setup) = scene("scaled-plate-r10");
    let truth = model(&scene, Model::C);
    let expected = truth.summary.value("efficiency").unwrap();
    let misses = (1..=40).map(|seed| {
        let with = Disturbance { seed, noise: 0.01, offset: 0.05, drift: 0.02, ..DISTURBED };
        let found =
            aligned(&record(&truth, &["outer_velocity", "inner_force"], with), &truth, &setup, Speed::Scene);
        let (efficiency, band) = (found.efficiency.unwrap(), found.efficiency_uncertainty.unwrap());
        assert!(band < 0.02, "{efficiency} +- {band}");
        (efficiency - expected).abs() / band
    });
    let misses: Vec<f64> = misses.collect();
    let within = misses.iter().filter(|miss| **miss <= 1.0).count();
    // 38 of 40 are 95 %; a normal error is beyond twice its band in 1 of 20 000
    assert!(within >= 34 && misses.iter().all(|miss| *miss < 2.0), "{misses:?}");
    assert!(misses.iter().any(|miss| *miss > 0.3), "the bands are too wide: {misses:?}");
}

#[test]
fn models_have_the_same_metrics_and_a_series_has_mean_and_standard_deviation() {
    let (scene, _) = scene("scaled-plate-r10");
    let (truth, reference) = (model(&scene, Model::C), reference(&scene));
    let records: Vec<Record> = (1..=3)
        .map(|seed| record(&truth, &SIGNALS, Disturbance { seed, noise: 0.002, ..DISTURBED }))
        .collect();
    let reduced = [model(&scene, Model::A), model(&scene, Model::C)];
    let certain = Default::default();
    let partners = [(REFERENCE, &reference), ("A", &reduced[0]), ("C", &reduced[1])];
    let found = compare(&scene, &records, &partners, (BANDWIDTH, Speed::Scene), &certain).unwrap();
    // another program's result has no eigenfrequency
    let mut imported = reference.clone();
    *imported.summary.quantities.value_mut("first_frequency").unwrap() = None;
    let with_imported =
        compare(&scene, &records, &[(REFERENCE, &imported)], (BANDWIDTH, Speed::Scene), &certain).unwrap();
    assert_eq!(with_imported.records, found.records);
    // without a reference the first model is what the records are laid over, and E has its band
    let alone = compare(&scene, &records, &partners[1..], (BANDWIDTH, Speed::Scene), &certain).unwrap();
    assert_eq!((alone.aligned_with.as_str(), alone.partners.len()), ("A", 2));
    let of_c =
        &compare(&scene, &records, &partners[2..], (BANDWIDTH, Speed::Scene), &certain).unwrap().partners[0];
    let assessed = of_c.validation.as_ref().unwrap();
    assert!(assessed.error.abs() < 2.0 * assessed.u_val && assessed.parts.u_input == 0.0, "{assessed:?}");
    let of_a = alone.partners[0].validation.as_ref().unwrap();
    assert!(of_a.error.abs() > 2.0 * of_a.u_val, "{of_a:?}");
    let series = found.efficiency.unwrap();
    assert_eq!(series, Series::of(series.values.clone()).unwrap());
    assert!(series.count == 3 && (series.mean - truth.summary.value("efficiency").unwrap()).abs() < 0.005);
    assert!(series.standard_deviation.unwrap() < 0.01);
    assert_eq!(
        found.partners.iter().map(|p| p.partner.as_str()).collect::<Vec<_>>(),
        ["reference", "A", "C"]
    );
    for quantity in SIGNALS {
        let scores: Vec<f64> = found
            .partners
            .iter()
            .map(|p| p.curves.iter().find(|c| c.quantity == quantity).unwrap().sprague_geers.unwrap())
            .collect();
        assert!(scores[1] > 2.0 * scores[2], "{quantity}: model A {} against C {}", scores[1], scores[2]);
        assert!(scores[0] < 0.05, "{quantity}: reference {}", scores[0]);
    }
    assert_eq!(Series::of(vec![1.0, 3.0]).unwrap().standard_deviation, Some(2.0_f64.sqrt()));
    assert!(Series::of(Vec::new()).is_none());
}
