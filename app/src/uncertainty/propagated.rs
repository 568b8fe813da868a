//! What a study finds: how the results scatter, and which input makes how much of it.

use super::draw::Inputs;
use super::estimate::{Estimate, Indices, Row, indices, mean, quantile, sorted, standard_deviation};
use super::request::Request;
use crate::result::SCHEMA_VERSION;
use crate::scene::{Correlation, Scene};
use serde::Serialize;
use std::collections::BTreeMap;

/// Probabilities whose quantiles are given; the name of each in the document.
const QUANTILES: [(&str, f64); 5] =
    [("0.025", 0.025), ("0.25", 0.25), ("0.5", 0.5), ("0.75", 0.75), ("0.975", 0.975)];
/// Relative difference of the two standard deviations beyond which local slopes don't tell the scatter.
const NOT_LINEAR: f64 = 0.1;

/// The document of `uncertainty --json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PropagatedUncertainty {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Name of the scene.
    pub scene: String,
    /// Name of the reduced model.
    pub model: String,
    /// Rows of the design.
    pub samples: usize,
    /// Impacts that were run for them.
    pub impacts: usize,
    /// How many of them have no result.
    pub failures: usize,
    /// Whether the accuracy asked for was reached; `None` if a number of rows was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accurate: Option<bool>,
    /// The uncertain inputs, by the names of their fields.
    pub inputs: BTreeMap<String, Input>,
    /// Which of them are correlated.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub correlations: Vec<Correlated>,
    /// The results, by name.
    pub quantities: BTreeMap<&'static str, QuantityUncertainty>,
    /// What else is to be known, in sentences.
    pub notes: Vec<String>,
}

/// An uncertain input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Input {
    /// SI unit.
    pub unit: &'static str,
    /// What the scene says.
    pub nominal: f64,
    /// Standard deviation.
    pub standard_deviation: f64,
}

/// Two correlated inputs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Correlated {
    /// Names of their fields.
    pub between: [String; 2],
    /// Coefficient of correlation of their normal scores.
    pub coefficient: f64,
}

/// The scatter of one result. Values are in `unit`, intervals of 95 %.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantityUncertainty {
    /// SI unit.
    pub unit: &'static str,
    /// With nominal inputs; `None` if that impact has no result.
    pub nominal: Option<f64>,
    /// Mean.
    pub mean: f64,
    /// Its interval.
    pub mean_interval: [f64; 2],
    /// Standard deviation.
    pub standard_deviation: f64,
    /// Its interval.
    pub standard_deviation_interval: [f64; 2],
    /// Standard deviation by the slopes at the nominal inputs alone.
    pub linear_standard_deviation: f64,
    /// Quantiles by their probability.
    pub quantiles: BTreeMap<&'static str, f64>,
    /// Shares of the variance, by inputs; empty if nothing varies. Correlated inputs have theirs together, their names joined by commas.
    pub sobol: BTreeMap<String, Share>,
    /// What one input alone changes, by name.
    pub local: BTreeMap<String, Local>,
    /// All values of the samples in ascending order; not part of the document.
    #[serde(skip)]
    pub values: Vec<f64>,
}

/// Share of the variance that inputs have.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Share {
    /// By themselves.
    pub first: f64,
    /// Its interval.
    pub first_interval: [f64; 2],
    /// With all interactions they take part in.
    pub total: f64,
    /// Its interval.
    pub total_interval: [f64; 2],
}

/// What an input alone changes, the others at their nominal values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Local {
    /// Slope of the result over the input, both in SI.
    pub slope: f64,
    /// The result with the input a standard deviation lower, and a standard deviation higher.
    pub results: [f64; 2],
}

/// The results that one quantity has in the impacts of a study.
#[derive(Debug, Clone)]
pub(super) struct SampledImpacts {
    pub(super) nominal: Option<f64>,
    /// Per input: its value and the result, lowered and raised.
    pub(super) moved: Vec<[(f64, Option<f64>); 2]>,
    pub(super) rows: Vec<Row>,
}

/// `None` for what is not finite. An index lies between 0 and 1: an estimate beyond is taken as the nearer of them.
fn share(Indices { first, total }: Indices) -> Option<Share> {
    let there = [first, total].iter().all(|index| index.value.is_finite());
    // a sum with 0 has no negative zero
    let possible = |value: f64| value.clamp(0.0, 1.0) + 0.0;
    let within = |index: Estimate| {
        let index = Estimate { value: possible(index.value), ..index };
        (index.value, index.interval().map(possible))
    };
    let ((first, first_interval), (total, total_interval)) = (within(first), within(total));
    there.then_some(Share { first, first_interval, total, total_interval })
}

impl QuantityUncertainty {
    fn of(unit: &'static str, inputs: &Inputs, impacts: &SampledImpacts) -> Self {
        let SampledImpacts { nominal, moved, rows } = impacts;
        let names = |of: &[usize]| {
            of.iter().map(|k| &*inputs.uncertainty.inputs[*k].field).collect::<Vec<_>>().join(",")
        };
        let (mean, deviation): (Estimate, Estimate) = (mean(rows), standard_deviation(rows));
        let local = |pair: &[(f64, Option<f64>); 2]| {
            let [(from, low), (to, high)] = *pair;
            let results = [low?, high?];
            Some(Local { slope: (results[1] - results[0]) / (to - from), results })
        };
        let locals: Vec<Option<Local>> = moved.iter().map(local).collect();
        let values = sorted(rows);
        let factors = inputs.design.factors.iter().enumerate();
        QuantityUncertainty {
            unit,
            nominal: *nominal,
            mean: mean.value,
            mean_interval: mean.interval(),
            standard_deviation: deviation.value,
            standard_deviation_interval: deviation.interval(),
            linear_standard_deviation: linear_deviation(inputs, &locals),
            quantiles: QUANTILES.iter().map(|(name, p)| (*name, quantile(&values, *p))).collect(),
            sobol: factors.filter_map(|(k, of)| Some((names(of), share(indices(rows, k))?))).collect(),
            local: locals.iter().enumerate().filter_map(|(k, l)| Some((names(&[k]), (*l)?))).collect(),
            values,
        }
    }

    /// The interval that has 95 % of the values, half of the rest on either side.
    pub fn interval(&self) -> [f64; 2] {
        ["0.025", "0.975"].map(|name| self.quantiles.get(name).copied().unwrap_or(f64::NAN))
    }

    /// Inputs and their share of the variance, the largest (with interactions) first.
    pub fn ranking(&self) -> Vec<(&str, &Share)> {
        let mut ranked: Vec<(&str, &Share)> =
            self.sobol.iter().map(|(name, share)| (&**name, share)).collect();
        ranked.sort_by(|a, b| b.1.total.total_cmp(&a.1.total));
        ranked
    }
}

/// Standard deviation of a linear function with these slopes: sqrt(g^T C g), C the covariance of the inputs; NaN if a slope is not known.
fn linear_deviation(inputs: &Inputs, locals: &[Option<Local>]) -> f64 {
    let of = |k: usize| {
        locals[k].map_or(f64::NAN, |local| local.slope * inputs.uncertainty.inputs[k].standard_deviation())
    };
    let parts: Vec<f64> = (0..locals.len()).map(of).collect();
    let own: f64 = parts.iter().map(|part| part * part).sum();
    let mutual = |c: &Correlation| 2.0 * c.coefficient * parts[c.between[0]] * parts[c.between[1]];
    (own + inputs.uncertainty.correlations.iter().map(mutual).sum::<f64>()).max(0.0).sqrt()
}

impl PropagatedUncertainty {
    /// What the impacts of each quantity (name, unit, results) show.
    pub(super) fn of(
        scene: &Scene,
        request: &Request,
        inputs: &Inputs,
        quantities: impl Iterator<Item = (&'static str, &'static str, SampledImpacts)>,
    ) -> Self {
        let uncertainty = &inputs.uncertainty;
        let quantities: BTreeMap<_, _> = quantities
            .map(|(name, unit, impacts)| (name, QuantityUncertainty::of(unit, inputs, &impacts)))
            .collect();
        let correlated = |c: &Correlation| Correlated {
            between: c.between.map(|k| uncertainty.inputs[k].field.clone()),
            coefficient: c.coefficient,
        };
        let mut notes = Vec::new();
        if !uncertainty.correlations.is_empty() {
            notes.push(
                "correlated inputs have their shares of the variance together: how much of it one of them makes alone is not defined"
                    .to_owned(),
            );
        }
        notes.extend(request.quantities.iter().filter_map(|name| curved(name, quantities.get(&**name)?)));
        let input = |of: &crate::scene::UncertainInput| Input {
            unit: of.unit,
            nominal: of.nominal,
            standard_deviation: of.standard_deviation(),
        };
        PropagatedUncertainty {
            schema_version: SCHEMA_VERSION,
            scene: scene.name.clone(),
            model: request.model.to_string(),
            samples: 0,
            impacts: 0,
            failures: 0,
            accurate: None,
            inputs: uncertainty.inputs.iter().map(|of| (of.field.clone(), input(of))).collect(),
            correlations: uncertainty.correlations.iter().map(correlated).collect(),
            quantities,
            notes,
        }
    }
}

/// That the slopes at the nominal inputs don't tell the scatter of the quantity called `name`.
fn curved(name: &str, of: &QuantityUncertainty) -> Option<String> {
    let off = of.linear_standard_deviation / of.standard_deviation - 1.0;
    (off.abs() > NOT_LINEAR).then(|| {
        format!(
            "`{name}` is not linear over the range of its inputs: a linear estimate of the standard deviation differs by {:+.0} %",
            100.0 * off
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_beyond_what_is_possible_is_the_nearest_that_is() {
        let of = |value: f64| Estimate { value, half_width: 0.03 };
        let share = share(Indices { first: of(-0.0004), total: of(1.02) }).unwrap();
        assert_eq!(format!("{:.3} {:.3}", share.first, share.total), "0.000 1.000");
        let within =
            |[low, high]: [f64; 2], [least, most]: [f64; 2]| low == least && (high - most).abs() < 1e-12;
        assert!(within(share.first_interval, [0.0, 0.03]), "{share:?}");
        assert!(
            (share.total_interval[0] - 0.97).abs() < 1e-12 && share.total_interval[1] == 1.0,
            "{share:?}"
        );
    }
}
