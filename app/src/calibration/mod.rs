//! Calibration: inputs of a scene from measured histories, by least squares on a reduced model.

pub mod fit;
mod residuals;

use crate::error::{Error, Result};
use crate::format::quantity;
use crate::kinds;
use crate::measured::{AlignedRecord, ContactEnds, Filtered, Finding, FindingKind, Record, Speed, align_all};
use crate::result::{CUT, SCHEMA_VERSION};
use crate::scene::{Field, Model, Template};
use fit::{Fitted, fit};
use residuals::Signals;
use serde::Serialize;
use std::path::PathBuf;

/// Relative error of the efficiency that the time integration may have: far below what slopes are taken over.
const TOLERANCE: f64 = 1e-8;
/// Range, over the nominal value, in which inputs are looked for.
const REACH: f64 = 0.3;
/// Impacts that a fit may be expected to take.
const IMPACTS: usize = 200;

/// The document of `calibrate --json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Calibration {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Name of the scene.
    pub scene: String,
    /// Name of the reduced model.
    pub model: String,
    /// The inputs.
    pub inputs: Vec<Calibrated>,
    /// Coefficients of correlation of the inputs, along what the records tell. Shape (inputs, inputs).
    pub correlations: Vec<Vec<f64>>,
    /// Number of samples compared.
    pub samples: usize,
    /// Root mean square of the differences before and after, over the span of the signals; offset and drift are taken out.
    pub misfit: [f64; 2],
    /// The records.
    pub records: Vec<CalibrationRecord>,
    /// What the records cannot identify, in sentences.
    pub untold: Vec<String>,
}

/// A record that was used.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CalibrationRecord {
    /// Where it comes from.
    pub file: PathBuf,
    /// What is wrong with it; whether it is that of the scene, whose inputs are looked for, is not judged.
    pub findings: Vec<Finding>,
}

impl CalibrationRecord {
    fn of(record: &AlignedRecord) -> Self {
        let findings = record.findings.iter().filter(|finding| finding.kind != FindingKind::OtherScene);
        CalibrationRecord { file: record.file.clone(), findings: findings.cloned().collect() }
    }
}

/// One input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Calibrated {
    /// Name of its field.
    pub field: String,
    /// SI unit.
    pub unit: &'static str,
    /// What the scene says.
    pub nominal: f64,
    /// What fits.
    pub value: f64,
    /// Its standard deviation (1.96 of it are 95 %), offset, drift and time of the records being unknown and their noise limited to
    /// a band; `None` if the records don't tell it.
    pub standard_deviation: Option<f64>,
}

/// The fields named `names` of the scene in `template`, from `records` taken with a `bandwidth` in Hz. Every record may be shifted in time besides.
///
/// # Errors
/// [`Error::Usage`] for fields that can't be calibrated, those of the model, of [`align_all`] and of [`fit()`].
pub fn calibrate(
    template: &Template,
    names: &[String],
    records: &[Record],
    model: Model,
    (bandwidth, speed): (f64, Speed),
) -> Result<Calibration> {
    let fields = names.iter().map(|name| template.field(name)).collect::<Result<Vec<Field>>>()?;
    let nominal = fields.iter().map(|field| nominal(template, field)).collect::<Result<Vec<f64>>>()?;
    let ranges =
        fields.iter().zip(&nominal).map(|(field, x)| (field.path(), [x * (1.0 - REACH), x * (1.0 + REACH)]));
    let approach = kinds::of(template.scene()).approach(template.scene())?;
    records.iter().try_for_each(|record| record.require_in(template.scene()))?;
    let series = kinds::series(ranges, template.scene(), None, IMPACTS)?;
    let run = |values: &[f64]| {
        let numbers: Vec<(&Field, f64)> = fields.iter().zip(values.iter().copied()).collect();
        let scene = template.with(&numbers).map_err(|e| Error::Usage(e.to_string()))?;
        series.model(scene, model, None)?.run_with_history(TOLERANCE)
    };
    let start = run(&nominal)?;
    let ends = ContactEnds::of(&start.summary, &approach).ok_or_else(|| Error::Solver(CUT.into()))?;
    let filtered = Filtered::new(&start.history, bandwidth)?;
    let how = (bandwidth, speed);
    let aligned = align_all(records, &filtered, ends, &approach, how)?;
    let used: Vec<CalibrationRecord> = aligned.iter().map(CalibrationRecord::of).collect();
    let aligned: Vec<AlignedRecord> = aligned.into_iter().filter(|record| !record.is_copy).collect();
    let end = start.history.time.last().copied().unwrap_or(0.0) + 2.0 / bandwidth;
    let signals = Signals::of(&aligned, end, how);
    let differences = |all: &[f64]| {
        let (values, shifts) = all.split_at(fields.len());
        signals.differences(&Filtered::new(&run(values).ok()?.history, bandwidth).ok()?, shifts)
    };
    let root_mean_square = |all: &[f64]| {
        differences(all).map_or(f64::NAN, |d| (d.iter().map(|d| d * d).sum::<f64>() / d.len() as f64).sqrt())
    };
    let shifts = |scale: f64| std::iter::repeat_n(scale, aligned.len());
    let first: Vec<f64> = nominal.iter().copied().chain(shifts(0.0)).collect();
    let scales: Vec<f64> = nominal.iter().map(|x| x.abs()).chain(shifts(1.0 / bandwidth)).collect();
    let covariance = |left: &_, slopes: &_| signals.covariance(left, slopes);
    let stated = |k: usize, value: f64| {
        format!("{} = {}", name(&fields, k), quantity(value, fields.get(k).map_or("s", Field::unit), 4))
    };
    let found = fit(&first, &scales, differences, covariance, stated)?;
    let misfit = [root_mean_square(&first), root_mean_square(&found.values)];
    Ok(Calibration {
        records: used,
        ..document(template, (&fields, &nominal), model, &found, (signals.samples(), misfit))
    })
}

/// What the scene has in `field`, about which it is looked for.
fn nominal(template: &Template, field: &Field) -> Result<f64> {
    let refused = |reason: &str| Error::Usage(format!("`{}` can't be calibrated: {reason}", field.path()));
    if field.is_count() {
        return Err(refused("it takes whole numbers"));
    }
    let value = template.number(field).ok_or_else(|| refused("the scene file does not state it"))?;
    if value == 0.0 { Err(refused("it is 0, which has no size to look about")) } else { Ok(value) }
}

/// Parameter `k` of the fit: one of `fields`, then the times of the records.
fn name(fields: &[Field], k: usize) -> String {
    let time = || format!("the time of record {}", k - fields.len() + 1);
    fields.get(k).map_or_else(time, |field| format!("`{}`", field.path()))
}

fn document(
    template: &Template,
    (fields, nominal): (&[Field], &[f64]),
    model: Model,
    found: &Fitted,
    (samples, misfit): (usize, [f64; 2]),
) -> Calibration {
    let count = fields.len();
    let sentence = |direction: &Vec<usize>| match &direction[..] {
        [one] => format!("not identifiable from the records: {}", name(fields, *one)),
        several => format!(
            "not identifiable from the records: {} (other combinations fit as well)",
            several.iter().map(|k| name(fields, *k)).collect::<Vec<_>>().join(" and ")
        ),
    };
    let input = |k: usize| Calibrated {
        field: fields[k].path().to_owned(),
        unit: fields[k].unit(),
        nominal: nominal[k],
        value: found.values[k],
        standard_deviation: found.standard_deviations[k],
    };
    Calibration {
        schema_version: SCHEMA_VERSION,
        scene: template.scene().name.clone(),
        model: model.to_string(),
        inputs: (0..count).map(input).collect(),
        correlations: found.correlations[..count].iter().map(|row| row[..count].to_vec()).collect(),
        samples,
        misfit,
        records: Vec::new(),
        untold: found.unidentifiable.iter().map(sentence).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds::plate_impact::reduced::Reduced;
    use crate::measured::{BANDWIDTH, Channel, low_pass};
    use std::path::PathBuf;

    const SCENE: &str = include_str!("../../../scenes/scaled-plate-r10.toml");

    /// A record of the scene with other numbers, as an instrument shows it, with white noise of a share of the largest value.
    fn record(template: &Template, numbers: &[(&Field, f64)], noise: f64, seed: u64) -> Record {
        record_with(template, numbers, (noise, None), seed)
    }

    /// The same with noise below a frequency in Hz.
    fn record_with(
        template: &Template,
        numbers: &[(&Field, f64)],
        (noise, corner): (f64, Option<f64>),
        seed: u64,
    ) -> Record {
        let scene = template.with(numbers).expect("valid");
        let outcome = Reduced::new(&scene, Model::B, None).unwrap().run_with_history(TOLERANCE).unwrap();
        let filtered = Filtered::new(&outcome.history, BANDWIDTH).unwrap();
        let time: Vec<f64> = (0..2000).map(|k| -150e-6 + 0.25e-6 * f64::from(k)).collect();
        let mut random = fastrand::Rng::with_seed(seed);
        let mut normal = || (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
        let mut channel = |quantity: &'static str| {
            let curve = filtered.curve(quantity).expect("measurable");
            let clean: Vec<f64> = time.iter().map(|t| curve(*t)).collect();
            let largest = clean.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            let mut random: Vec<f64> = clean.iter().map(|_| normal()).collect();
            if let Some(corner) = corner {
                random = low_pass(&random, 0.25e-6, corner).expect("filtered");
                let deviation = (random.iter().map(|r| r * r).sum::<f64>() / random.len() as f64).sqrt();
                random.iter_mut().for_each(|r| *r /= deviation);
            }
            let values = clean.iter().zip(random).map(|(v, r)| v + noise * largest * r).collect();
            Channel { quantity, values }
        };
        let channels = vec![channel("outer_velocity"), channel("inner_velocity")];
        // the instrument's clock begins with the record
        let time = time.iter().map(|t| t + 150e-6).collect();
        Record {
            file: PathBuf::from("synthetic.csv"),
            time,
            channels,
            gaps: Vec::new(),
            integrals: Vec::new(),
        }
    }

    #[test]
    fn inputs_are_recovered_from_noisy_records_within_what_is_stated() {
        let template = Template::parse("scene", SCENE).expect("shipped scene");
        let fields = ["plate.thickness", "plate.radius"].map(|name| template.field(name).expect("there"));
        let truth = [2.04e-3, 32.7e-3];
        let numbers: Vec<(&Field, f64)> = fields.iter().zip(truth).collect();
        let records = [1, 2].map(|seed| record(&template, &numbers, 0.01, seed));
        let names = fields.each_ref().map(|field| field.path().to_owned());
        let found =
            calibrate(&template, &names, &records, Model::B, (BANDWIDTH, Speed::Scene)).expect("a fit");
        assert!(found.untold.is_empty() && found.misfit[1] < found.misfit[0], "{found:?}");
        for (input, truth) in found.inputs.iter().zip(truth) {
            let deviation = input.standard_deviation.expect("told");
            assert!((input.value - truth).abs() < 3.5 * deviation, "{found:?}");
            assert!(deviation < 0.01 * truth, "{found:?}");
        }
    }

    /// As if its samples were independent, noise below 20 kHz would lead to a standard deviation several times too small.
    #[test]
    fn noise_of_a_narrow_band_widens_the_standard_deviations() {
        let template = Template::parse("scene", SCENE).expect("shipped scene");
        let field = template.field("plate.thickness").expect("there");
        let names = [field.path().to_owned()];
        let mut squares = 0.0;
        for seed in 0..6 {
            let record = record_with(&template, &[(&field, 2.04e-3)], (0.004, Some(20e3)), seed);
            let found =
                calibrate(&template, &names, &[record], Model::B, (BANDWIDTH, Speed::Scene)).expect("a fit");
            let input = &found.inputs[0];
            squares += ((input.value - 2.04e-3) / input.standard_deviation.expect("told")).powi(2);
        }
        let z = (squares / 6.0).sqrt();
        assert!((0.25..1.7).contains(&z), "root mean square of (value - truth) / standard deviation: {z}");
    }

    /// A sphere's contact knows E/(1 - nu^2) alone.
    #[test]
    fn modulus_and_poisson_s_ratio_of_a_sphere_are_named_as_not_identifiable() {
        let text = SCENE.replace("[plate]", "[materials.ball]\nyoungs_modulus = \"210 GPa\"\npoisson_ratio = 0.3\ndensity = \"7780 kg/m^3\"\n\n[plate]");
        let (before, outer) = text.split_once("[outer]").expect("an outer body");
        let text = format!("{before}[outer]{}", outer.replacen("\"steel\"", "\"ball\"", 1));
        let template = Template::parse("scene", &text).expect("valid");
        let fields = ["materials.ball.youngs_modulus", "materials.ball.poisson_ratio"]
            .map(|name| template.field(name).expect("there"));
        let names = fields.each_ref().map(|field| field.path().to_owned());
        let numbers: Vec<(&Field, f64)> = fields.iter().zip([190e9, 0.25]).collect();
        for seed in 0..3 {
            let record = record(&template, &numbers, 0.002, seed);
            let found =
                calibrate(&template, &names, &[record], Model::B, (BANDWIDTH, Speed::Scene)).expect("a fit");
            assert_eq!(found.untold.len(), 1, "{found:?}");
            assert!(found.inputs.iter().all(|input| input.standard_deviation.is_none()), "{found:?}");
        }
    }

    /// A contact knows E* r^(1/2) alone, and with the mass of a sphere two numbers of its radius, density and modulus. Records without
    /// noise, or with little, tell no more.
    #[test]
    fn what_acts_together_alone_is_named_in_clean_records_too() {
        let text = SCENE.replace("[plate]", "[materials.ball]\nyoungs_modulus = \"210 GPa\"\npoisson_ratio = 0.3\ndensity = \"7780 kg/m^3\"\n\n[plate]");
        let (before, outer) = text.split_once("[outer]").expect("an outer body");
        let (sphere, after) = outer.split_once("[inner]").expect("an inner body");
        let compact = "\nkind = \"compact\"\nmass = \"32 g\"\ntip_radius = \"10 mm\"\nmaterial = \"ball\"\nspeed = \"550 mm/s\"\n";
        let sphere = sphere.replacen("\"steel\"", "\"ball\"", 1);
        let modulus = "materials.ball.youngs_modulus";
        for (outer, names, noise) in [
            (compact, &["outer.tip_radius", modulus][..], 0.0),
            (&sphere, &["outer.radius", "materials.ball.density", modulus], 0.0),
            (&sphere, &["outer.radius", "materials.ball.density", modulus], 1e-5),
        ] {
            let text = format!("{before}[outer]{outer}[inner]{after}");
            let template = Template::parse("scene", &text).expect("valid");
            let fields: Vec<Field> = names.iter().map(|name| template.field(name).expect("there")).collect();
            let numbers: Vec<(&Field, f64)> = fields
                .iter()
                .map(|field| (field, 1.03 * template.number(field).expect("a number")))
                .collect();
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            let records = [record(&template, &numbers, noise, 1)];
            let found =
                calibrate(&template, &names, &records, Model::B, (BANDWIDTH, Speed::Scene)).expect("a fit");
            assert_eq!(found.untold.len(), 1, "{names:?}: {found:?}");
            assert!(found.inputs.iter().all(|input| input.standard_deviation.is_none()), "{found:?}");
        }
    }

    #[test]
    fn parameters_that_are_not_identifiable_are_reported() {
        let template = Template::parse("scene", SCENE).expect("shipped scene");
        let records = [record(&template, &[], 0.01, 3)];
        // undamped: a damping ratio can't be looked for about nothing; a count neither
        for name in ["plate.damping_ratio", "reduced.modes"] {
            let refused =
                calibrate(&template, &[name.to_owned()], &records, Model::B, (BANDWIDTH, Speed::Scene));
            assert!(matches!(refused, Err(Error::Usage(_))), "{name}");
        }
        // one material and model B: all that is seen is E / ((1 - nu^2) rho), so that two of three directions are not told
        let names =
            ["materials.steel.poisson_ratio", "materials.steel.youngs_modulus", "materials.steel.density"];
        let names = names.map(str::to_owned);
        let found =
            calibrate(&template, &names, &records, Model::B, (BANDWIDTH, Speed::Scene)).expect("a fit");
        assert_eq!(found.untold.len(), 2, "{found:?}");
        assert!(found.inputs.iter().all(|input| input.standard_deviation.is_none()), "{found:?}");
    }
}
