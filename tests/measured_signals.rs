//! Measured signals (section 3.4): synthetic records of known noise, shift, offset and drift, made from a model's history
//! and laid over the finite-element reference.

use impactcheck::impact::Outcome;
use impactcheck::impact::reduced::Reduced;
use impactcheck::measured::{
    AlignedRecord, BANDWIDTH, Channel, Filtered, Record, Series, Speed, align, compare,
};
use impactcheck::reference::{Lookup, Resolution, Store};
use impactcheck::scene::{Model, PlateImpact, Scene, Setup, resolve};

fn scene(name: &str) -> (Scene, PlateImpact) {
    let scene = Scene::read(resolve(name).unwrap()).unwrap();
    let Setup::PlateImpact(setup) = scene.setup.clone();
    (scene, *setup)
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
    let last = truth.summary.quantities.outer_contact_end + 200e-6;
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
    Record { file: "synthetic.csv".into(), time, channels }
}

fn aligned(record: &Record, partner: &Outcome, setup: &PlateImpact, speed: Speed) -> AlignedRecord {
    let filtered = Filtered::new(&partner.history, BANDWIDTH).unwrap();
    align(record, &filtered, &partner.summary.quantities, setup, (BANDWIDTH, speed)).unwrap()
}

#[test]
fn shift_within_a_tenth_of_a_microsecond_and_efficiency_within_half_a_point() {
    for name in ["scaled-plate-r10", "scaled-plate-r6.35"] {
        let (scene, setup) = scene(name);
        let (truth, partner) = (model(&scene, Model::C), reference(&scene));
        for seed in 1..=8 {
            let record = record(&truth, &SIGNALS, Disturbance { seed, ..DISTURBED });
            let f0 = aligned(&record, &truth, &setup, Speed::Scene);
            println!("  truth {:.4}", (f0.shift - 5e-6) * 1e6);
            let found = aligned(&record, &partner, &setup, Speed::Scene);
            let (efficiency, expected) = (found.efficiency.unwrap(), truth.summary.quantities.efficiency);
            println!(
                "{name} {seed}: shift error {:.4} us, efficiency error {:.3} points, band {:.3}",
                (found.shift - 5e-6) * 1e6,
                100.0 * (efficiency - expected),
                100.0 * found.efficiency_uncertainty.unwrap()
            );
            if std::env::var("X").is_ok() {
                continue;
            }
            assert!((found.shift - 5e-6).abs() < 0.1e-6, "{name}, seed {seed}: shift {:e} s", found.shift);
            assert!(
                (efficiency - expected).abs() < 0.005,
                "{name}, seed {seed}: {efficiency}, expected {expected}"
            );
        }
    }
}
