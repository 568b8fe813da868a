//! Measured records beside the models: the same metrics as between models and reference, and the efficiency of a series
//! of repeated impacts.

use super::RULE;
use super::align::{AlignedRecord, ContactEnds, Speed, align_all};
use super::area::Area;
use super::filter::{Filtered, SIGNALS};
use super::record::Record;
use crate::curves::{AlignedCurve, CommonAxis, CurveMetrics, MonotoneCubic, SampledCurve};
use crate::error::{Error, Result};
use crate::kinds;
use crate::numerics::stationary_noise::NORMAL_95;
use crate::result::{CUT, Curve, Outcome, Summary};
use crate::scene::Scene;
use crate::uncertainty::PropagatedUncertainty;
use crate::uncertainty::validation::{Assessment, numerical, propagated_of};
use serde::Serialize;
use std::collections::BTreeMap;

/// Name of the reference among the comparators.
pub const REFERENCE: &str = "reference";

/// Measured records of one scene beside its models; part of the comparison document.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    /// The rule of alignment.
    pub rule: &'static str,
    /// Bandwidth in Hz to which the models' curves are filtered.
    pub bandwidth: f64,
    /// Where the outer body's speed before the impact comes from.
    pub speed: Speed,
    /// The result over which the records are laid: "reference" or a model's name.
    pub aligned_with: String,
    /// The records, in the order given.
    pub records: Vec<AlignedRecord>,
    /// Efficiency over the records, each impact once; `None` if none of them shows one.
    pub efficiency: Option<Series>,
    /// Restitution, of scenes without an inner body whose outer body strikes what is held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<Series>,
    /// Which of both is shown.
    #[serde(skip)]
    pub key: &'static str,
    /// Reference, if there is one, and models against the first record.
    pub partners: Vec<MeasuredComparison>,
    /// Time axis of the curves.
    pub window: CommonAxis,
    /// The first record on it.
    #[serde(skip)]
    pub curves: Vec<SampledCurve>,
}

impl Measured {
    /// The efficiency over the records, or without an inner body the restitution.
    pub fn key_series(&self) -> Option<&Series> {
        self.efficiency.as_ref().or(self.restitution.as_ref())
    }
}

impl MeasuredComparison {
    /// Its efficiency, or without an inner body its restitution.
    pub fn key(&self) -> Option<f64> {
        self.efficiency.or(self.restitution)
    }

    /// The same less the mean of the measured ones.
    pub fn key_difference(&self) -> Option<f64> {
        self.efficiency_difference.or(self.restitution_difference)
    }
}

/// Mean and scatter of repeated impacts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Series {
    /// Number of impacts that show the quantity.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation of the impacts; `None` for one.
    pub standard_deviation: Option<f64>,
    /// The values, in the order of the records.
    pub values: Vec<f64>,
}

impl Series {
    /// Mean and scatter of `values`; `None` without any.
    pub fn of(values: Vec<f64>) -> Option<Self> {
        let count = values.len();
        if count == 0 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let standard_deviation = (count > 1).then(|| (squares / (count - 1) as f64).sqrt());
        Some(Series { count, mean, standard_deviation, values })
    }
}

/// The reference or a model against the measurement.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuredComparison {
    /// "reference" or the model's name.
    pub partner: String,
    /// Its efficiency; `None` if its run was cut during a contact.
    pub efficiency: Option<f64>,
    /// Its efficiency less the mean of the measured ones.
    pub efficiency_difference: Option<f64>,
    /// Its restitution, of scenes without an inner body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// Its restitution less the mean of the measured ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution_difference: Option<f64>,
    /// What that difference shows, the inputs being as uncertain as the scene says.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub validation: Option<Assessment>,
    /// Area between the distributions of its efficiency, inputs being as uncertain as that, and of the measured ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub area: Option<Area>,
    /// Curve metrics, the measurement as reference, the comparator filtered.
    pub curves: Vec<CurveMetrics>,
    /// Its filtered curves on the window.
    #[serde(skip)]
    pub filtered: Vec<SampledCurve>,
}

/// Aligns `records` with the first of the `comparators` (names and results) and compares all of them with the first record; `propagations` are
/// the propagated uncertainties of the scene's inputs, by the name of the model, empty if they are certain.
///
/// # Errors
/// [`Error::Reference`] if the first comparator's history can't be used, [`Error::Scene`] if a record can't be aligned,
/// [`Error::Usage`] if there is no record or comparator, or the bandwidth is not usable.
pub fn compare(
    scene: &Scene,
    records: &[Record],
    comparators: &[(&str, &Outcome)],
    (bandwidth, speed): (f64, Speed),
    propagations: &BTreeMap<String, PropagatedUncertainty>,
) -> Result<Measured> {
    let kind = kinds::of(scene);
    let approach = kind.approach(scene)?;
    records.iter().try_for_each(|record| record.require_in(scene))?;
    let Some(((lead, first), others)) = comparators.split_first() else {
        return Err(Error::Usage("there is no result to compare the record with".into()));
    };
    let who = if *lead == REFERENCE { "the reference".to_owned() } else { format!("model {lead}") };
    let window = CommonAxis::of_reference(first)
        .ok_or_else(|| Error::Reference(format!("the history of {who} of `{}` can't be used", scene.name)))?;
    let model = Filtered::new(&first.history, bandwidth)?;
    let ends = ContactEnds::of(&first.summary, &approach)
        .ok_or_else(|| Error::Reference(format!("{who} of `{}`: {CUT}", scene.name)))?;
    let records = align_all(records, &model, ends, &approach, (bandwidth, speed))?;
    let record = records.first().ok_or_else(|| Error::Usage("no measured file is specified".into()))?;
    let window = CommonAxis { end: window.end.min(record.time.last().copied().unwrap_or(0.0)), ..window };
    if window.end <= window.start {
        return Err(Error::Scene(miette::miette!(
            "{}: the record ends before the impact",
            record.file.display()
        )));
    }
    let (curves, shown) = (sampled(record, window), RecordedQuantity::of(&records, approach.key()));
    // one of both is not known of a scene
    let of_key = |name: &str, value: Option<f64>| value.filter(|_| approach.key() == name);
    // another program need not give the curves that are measured
    let shows = |outcome: &Outcome| curves.iter().all(|c| outcome.history.curve(c.quantity).is_some());
    let others = others.iter().filter(|(_, outcome)| shows(outcome));
    let comparators = std::iter::once(&(*lead, *first))
        .chain(others)
        .map(|(comparator, outcome)| {
            let filtered = Filtered::new(&outcome.history, bandwidth)?;
            let filtered: Vec<SampledCurve> = SIGNALS
                .into_iter()
                .filter_map(|quantity| {
                    let curve = filtered.curve(quantity)?;
                    let values = (0..window.samples).map(|k| curve(window.time(k))).collect();
                    Some(SampledCurve { quantity, values })
                })
                .collect();
            let (validation, area) =
                shown.assessed(&outcome.summary, propagated_of(propagations, comparator));
            Ok(MeasuredComparison {
                partner: (*comparator).to_owned(),
                efficiency: outcome.summary.value("efficiency"),
                efficiency_difference: of_key("efficiency", shown.difference(&outcome.summary)),
                restitution: of_key("outer_restitution", outcome.summary.value("outer_restitution")),
                restitution_difference: of_key("outer_restitution", shown.difference(&outcome.summary)),
                validation,
                area,
                curves: metrics(kind.curves(), (&curves, &filtered), window),
                filtered,
            })
        })
        .collect::<Result<Vec<_>>>()?;
    let [efficiency, restitution] = ["efficiency", "outer_restitution"]
        .map(|name| shown.series.clone().filter(|_| approach.key() == name));
    Ok(Measured {
        key: approach.key(),
        restitution,
        rule: RULE,
        bandwidth,
        speed,
        aligned_with: (*lead).to_owned(),
        efficiency,
        partners: comparators,
        window,
        curves,
        records,
    })
}

/// What the records show of a quantity.
struct RecordedQuantity {
    quantity: &'static str,
    series: Option<Series>,
    /// Standard uncertainty of the mean: the scatter and the noise of each, both over the root of their number; `None` if nothing
    /// is known of it.
    u_d: Option<f64>,
}

impl RecordedQuantity {
    fn of(records: &[AlignedRecord], quantity: &'static str) -> Self {
        let impacts = || records.iter().filter(|record| !record.is_copy);
        let series = Series::of(impacts().filter_map(AlignedRecord::key).collect());
        let u_d = series.as_ref().and_then(|series| {
            let count = series.count as f64;
            let bands = impacts().filter_map(AlignedRecord::key_uncertainty);
            let noise = bands.map(|band| (band / NORMAL_95).powi(2)).sum::<f64>() / count;
            let variance = series.standard_deviation.map_or(0.0, |deviation| deviation.powi(2));
            // the scatter has the noise in it already
            Some((variance.max(noise) / count).sqrt()).filter(|u| *u > 0.0)
        });
        RecordedQuantity { quantity, series, u_d }
    }

    /// What a result has of it less the mean.
    fn difference(&self, summary: &Summary) -> Option<f64> {
        Some(summary.value(self.quantity)? - self.series.as_ref()?.mean)
    }

    /// What the difference of a result shows, given its propagated input uncertainty `propagated`, and the area between both
    /// distributions.
    fn assessed(
        &self,
        summary: &Summary,
        propagated: Option<&PropagatedUncertainty>,
    ) -> (Option<Assessment>, Option<Area>) {
        let propagated = propagated.and_then(|propagated| propagated.quantities.get(self.quantity));
        let Some(error) = self.difference(summary) else { return (None, None) };
        let sides = (numerical(summary, self.quantity), self.u_d);
        let Some(propagated) = propagated else {
            return (Assessment::of_exact_inputs(error, sides, "1"), None);
        };
        let assessment = Assessment::of(error, sides, propagated);
        // the distribution about the result itself
        let shift = summary.value(self.quantity).unwrap_or(f64::NAN) - propagated.nominal.unwrap_or(f64::NAN);
        let moved: Vec<f64> = propagated.values.iter().map(|value| value + shift).collect();
        let values = self.series.as_ref().map_or(&[][..], |series| &series.values);
        (assessment, Area::between(&moved, values).filter(|area| area.area.is_finite()))
    }
}

/// The signals of a record at the instants of `window`.
fn sampled(record: &AlignedRecord, window: CommonAxis) -> Vec<SampledCurve> {
    let of = |channel: &super::Channel| {
        let curve = MonotoneCubic::new(&record.time, &channel.values);
        let values = (0..window.samples).map(|k| curve.at(window.time(k))).collect();
        SampledCurve { quantity: channel.quantity, values }
    };
    record.signals.iter().map(of).collect()
}

fn metrics(
    known: &[Curve],
    (measured, filtered): (&[SampledCurve], &[SampledCurve]),
    axis: CommonAxis,
) -> Vec<CurveMetrics> {
    let pair = |curve: &SampledCurve| {
        let known = known.iter().find(|known| known.name == curve.quantity)?;
        let comparator = filtered.iter().find(|other| other.quantity == curve.quantity)?;
        let aligned = AlignedCurve {
            quantity: known.name,
            unit: known.unit,
            axis,
            reference: curve.values.clone(),
            reduced: comparator.values.clone(),
        };
        Some(CurveMetrics::of(&aligned))
    };
    measured.iter().filter_map(pair).collect()
}
