//! Faults of measured records: each is found and named, and clean records are not accused.

use impactcheck::kinds::Approach;
use impactcheck::kinds::plate_impact::approach;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::measured::{
    AlignedRecord, BANDWIDTH, Channel, ContactEnds, Filtered, FindingKind, Record, Speed, align, align_all,
};
use impactcheck::result::Outcome;
use impactcheck::scene::{Model, Scene, resolve};
use std::f64::consts::PI;

struct Bench {
    truth: Outcome,
    model: Filtered,
    ends: ContactEnds,
    approach: Approach,
}

impl Bench {
    fn of(name: &str) -> Self {
        let scene = Scene::read(resolve(name).unwrap()).unwrap();
        let truth = Reduced::new(&scene, Model::B, None).unwrap().run_with_history(1e-7).unwrap();
        let model = Filtered::new(&truth.history, BANDWIDTH).unwrap();
        let approach = approach(scene.plate_impact().unwrap());
        let ends = ContactEnds::of(&truth.summary, &approach).unwrap();
        Bench { model, ends, approach, truth }
    }

    fn efficiency(&self) -> f64 {
        self.truth.summary.value("efficiency").unwrap()
    }

    /// Velocities at 2 MHz with noise of 2 mm/s and offsets, from 200 us before the first touch, which is at 3.2 ms, to `end`.
    fn record(&self, seed: u64, end: f64) -> Record {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut normal = || (-2.0 * (1.0 - random.f64()).ln()).sqrt() * (2.0 * PI * random.f64()).cos();
        let time: Vec<f64> =
            (0..).map(|k| -200e-6 + 0.5e-6 * f64::from(k)).take_while(|t| *t < end).collect();
        let channels = [("outer_velocity", 0.03), ("inner_velocity", -0.01)].map(|(quantity, offset)| {
            let curve = self.model.curve(quantity).unwrap();
            let values = time.iter().map(|t| curve(*t) + offset + 2e-3 * normal()).collect();
            Channel { quantity, values }
        });
        let time = time.iter().map(|t| t + 3.2e-3).collect();
        Record {
            file: "synthetic.csv".into(),
            time,
            channels: channels.into(),
            gaps: Vec::new(),
            integrals: Vec::new(),
        }
    }

    fn align(&self, record: &Record) -> impactcheck::Result<AlignedRecord> {
        align(record, &self.model, self.ends, &self.approach, (BANDWIDTH, Speed::Scene))
    }
}

/// `record` with another signal of each channel: its number, time from the first touch, value.
fn changed(record: &Record, change: impl Fn(usize, f64, f64) -> f64) -> Record {
    let mut record = record.clone();
    for (k, channel) in record.channels.iter_mut().enumerate() {
        for (t, value) in record.time.iter().zip(&mut channel.values) {
            *value = change(k, t - 3.2e-3, *value);
        }
    }
    record
}

fn kinds(record: &AlignedRecord) -> Vec<FindingKind> {
    record.findings.iter().map(|finding| finding.kind).collect()
}

#[test]
fn each_fault_is_named_and_the_efficiency_stated_where_it_can_be() {
    let bench = Bench::of("scaled-plate-r10");
    let clean = bench.record(1, 1.2e-3);
    let count = clean.time.len() as f64;
    let late = |share: f64, t: f64| t > -200e-6 + share * 1.4e-3;
    let high_pass = |tau: f64| {
        let mut record = clean.clone();
        for channel in &mut record.channels {
            let keep = tau / (tau + 0.5e-6);
            let (mut before, mut out) = (channel.values[0], channel.values[0]);
            for value in &mut channel.values {
                out = keep * (out + *value - before);
                before = std::mem::replace(value, out);
            }
        }
        record
    };
    let delayed = {
        let mut record = clean.clone();
        record.channels[1].values = bench.record(2, 1.2e-3).channels[1].values.clone();
        record.channels[1].values.rotate_right(20);
        record.channels[1].values[..20].copy_from_slice(&clean.channels[1].values[..20]);
        record
    };
    let missing = {
        let mut record = clean.clone();
        let keep = |k: &usize| !(500..600).contains(k);
        record.time = (0..record.time.len()).filter(keep).map(|k| clean.time[k]).collect();
        for channel in &mut record.channels {
            channel.values = (0..channel.values.len()).filter(keep).map(|k| channel.values[k]).collect();
        }
        record
    };
    // efficiency within its stated uncertainty, where the fault can be cut off or taken out
    for (name, record, kind, is_usable) in [
        (
            "stop",
            changed(&clean, |k, t, v| if k == 1 && t > 700e-6 { -0.6 * v } else { v }),
            FindingKind::EndStop,
            true,
        ),
        (
            "strike",
            changed(&clean, |k, t, v| v + [0.2, -0.15][k] * ((t - 600e-6) / 50e-6).clamp(0.0, 1.0)),
            FindingKind::SecondStrike,
            true,
        ),
        (
            "zeros",
            changed(&clean, |_, t, v| if late(1.0 - 20.0 / count, t) { 0.0 } else { v }),
            FindingKind::Padding,
            true,
        ),
        (
            "clipped",
            changed(&clean, |k, _, v| if k == 0 { v.max(-0.5) } else { v }),
            FindingKind::Clipped,
            true,
        ),
        (
            "both limits",
            changed(&clean, |k, _, v| if k == 0 { v.clamp(-0.5, 0.2) } else { v }),
            FindingKind::Clipped,
            true,
        ),
        ("gap", missing, FindingKind::Gap, true),
        ("delay", delayed, FindingKind::Delay, true),
        ("drift", changed(&clean, |k, t, v| if k == 1 { v + 37.0 * t } else { v }), FindingKind::Drift, true),
        ("AC-coupled", high_pass(5e-3), FindingKind::AcCoupled, false),
    ] {
        let found = bench.align(&record).unwrap();
        assert!(kinds(&found).contains(&kind), "{name}: {:?}", found.findings);
        let (efficiency, uncertainty) = (found.efficiency.unwrap(), found.efficiency_uncertainty.unwrap());
        let error = (efficiency - bench.efficiency()).abs();
        assert!(
            !is_usable || error < 1.5 * uncertainty && uncertainty < 0.01,
            "{name}: {efficiency} +- {uncertainty}"
        );
    }
}

#[test]
fn a_hum_is_taken_out() {
    let bench = Bench::of("scaled-plate-r10");
    let hum =
        changed(&bench.record(1, 20e-3), |k, t, v| v + 0.02 * (k as f64) * (2.0 * PI * 50.0 * t + 1.0).sin());
    let found = bench.align(&hum).unwrap();
    assert_eq!(kinds(&found), [FindingKind::Hum], "{:?}", found.findings);
    assert!((found.efficiency.unwrap() - bench.efficiency()).abs() < 0.01, "{:?}", found.efficiency);
}

/// Noise of a later stage hides that all values are the same.
#[test]
fn an_amplifier_at_its_limit_is_found() {
    let bench = Bench::of("scaled-plate-r10");
    let limited = |k, t: f64, v: f64| if k == 1 { v.max(-0.43) + 3e-4 * (3.3e7 * t).sin() } else { v };
    let found = bench.align(&changed(&bench.record(1, 400e-6), limited)).unwrap();
    assert!(kinds(&found).contains(&FindingKind::Clipped), "{:?}", found.findings);
}

/// What a filter leaves of 1e-17 m/s shows next to zero alone; at the largest values the last digit hides it.
#[test]
fn a_record_without_noise_is_not_held_at_a_limit() {
    let bench = Bench::of("scaled-plate-r10");
    let mut exact = bench.record(1, 400e-6);
    for channel in &mut exact.channels {
        let curve = bench.model.curve(channel.quantity).unwrap();
        let left = |t: f64| 1e-17 * (2e5 * t).sin();
        let written = |t: &f64| format!("{:.8e}", curve(t - 3.2e-3) + left(*t)).parse().unwrap();
        channel.values = exact.time.iter().map(written).collect();
    }
    let found = bench.align(&exact).unwrap();
    assert_eq!(kinds(&found), [], "{:?}", found.findings);
}

#[test]
fn a_record_of_another_scene_or_a_negated_signal_is_not_taken() {
    let [bench, other] = ["scaled-plate-r10", "scaled-plate-r6.35"].map(Bench::of);
    let found = bench.align(&other.record(1, 400e-6)).unwrap();
    assert!(kinds(&found).contains(&FindingKind::OtherScene), "{:?}", found.findings);
    let clean = bench.record(1, 400e-6);
    let inner_alone = Record { channels: clean.channels[1..].to_vec(), ..clean.clone() };
    for (record, quantity) in [
        (changed(&clean, |k, _, v| if k == 1 { -v } else { v }), "inner_velocity"),
        (changed(&clean, |k, _, v| if k == 0 { -v } else { v }), "outer_velocity"),
        (changed(&inner_alone, |_, _, v| -v), "inner_velocity"),
    ] {
        let said = bench.align(&record).unwrap_err();
        assert_eq!(said.exit_status() as u8, 3);
        let said = said.to_string();
        assert!(said.contains(quantity) && said.contains("wrong sign"), "{said}");
    }
    // a gain of 1.35 in the inner signal: 127 % of the energy
    let gain = changed(&clean, |k, _, v| if k == 1 { 1.35 * v } else { v });
    let said = bench.align(&gain).unwrap_err().to_string();
    assert!(said.contains("no impact gives energy"), "{said}");
    // 1.1 in both: 119 %, which is not the efficiency's alone
    let found = bench.align(&changed(&clean, |_, _, v| 1.1 * v)).unwrap();
    assert!(kinds(&found).contains(&FindingKind::Energy), "{:?}", found.findings);
}

#[test]
fn one_impact_counts_once() {
    let bench = Bench::of("scaled-plate-r10");
    let [first, second] = [1, 2].map(|seed| bench.record(seed, 400e-6));
    let mut again = first.clone();
    again.time.iter_mut().for_each(|t| *t += 1e-3);
    let half = |values: &[f64]| values.iter().copied().step_by(2).collect::<Vec<f64>>();
    let channels =
        first.channels.iter().map(|channel| Channel { values: half(&channel.values), ..channel.clone() });
    let halved = Record { time: half(&first.time), channels: channels.collect(), ..first.clone() };
    let [outer, inner] =
        [0, 1].map(|k| Record { channels: vec![first.channels[k].clone()], ..first.clone() });
    let found = |records: &[Record]| {
        let how = (BANDWIDTH, Speed::Scene);
        let aligned = align_all(records, &bench.model, bench.ends, &bench.approach, how).unwrap();
        aligned.iter().map(kinds).collect::<Vec<_>>()
    };
    let duplicate = vec![FindingKind::Duplicate];
    assert_eq!(found(&[first.clone(), second, again]), [vec![], vec![], duplicate.clone()]);
    assert_eq!(found(&[first.clone(), halved]), [vec![], duplicate.clone()]);
    assert_eq!(found(&[outer, inner]), [duplicate, vec![]]);
    // of two impacts only the decay is the same
    let decay = |seed| changed(&bench.record(seed, 400e-6), |_, t, v| v + 0.1 * (-t / 300e-6).exp());
    assert!(!found(&[decay(1), decay(2)])[1].contains(&FindingKind::Duplicate));
}

#[test]
fn clean_records_have_no_findings() {
    let bench = Bench::of("scaled-plate-r10");
    for seed in 0..20 {
        let found = bench.align(&bench.record(seed, 400e-6)).unwrap();
        assert!(found.findings.is_empty(), "{seed}: {:?}", found.findings);
    }
}
