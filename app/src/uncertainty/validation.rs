//! What a discrepancy shows when the inputs are uncertain (ASME V&V 20-2009, section 1-6).
//!
//! The error E = S - D of a result S against D, a reference or the mean of measurements, is compared with the standard uncertainty of
//! the comparison, u_val^2 = u_num^2 + u_input^2 + u_D^2: of the numerical solution, of the inputs, of D. The error of the model lies
//! within E ± 2 u_val in 95 % of all cases.
//!
//! A reference solves the same scene with the same nominal inputs, so that their scatter is no part of its difference from the
//! model. There u_val says what a measurement could show: one of bodies that are known no better.

use crate::format::{prefixed, with_unit, words};
use crate::result::Summary;
use crate::scene::Model;
use crate::uncertainty::{PropagatedUncertainty, QuantityUncertainty};
use serde::Serialize;
use std::collections::BTreeMap;

/// Standard uncertainties in half the width of a 95 % band.
pub const COVERAGE: f64 = 2.0;
/// The results that a summary's truncation error is about.
const TRUNCATED: [&str; 4] = ["efficiency", "outer_velocity_final", "outer_force_peak", "inner_force_peak"];

/// An error against the uncertainty of the comparison, in the unit of its quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Assessment {
    /// E = S - D.
    pub error: f64,
    /// Standard uncertainty of the comparison.
    pub u_val: f64,
    /// What it consists of.
    pub parts: Parts,
    /// What E shows.
    pub verdict: Shown,
    /// The same in a sentence.
    pub sentence: String,
    /// If E shows no error: which input would have to be known better for it to show one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub would_decide: Option<String>,
}

/// Standard uncertainties; what is `None` is not known and counts as none.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parts {
    /// Of the numerical solution S: modes left out; of a reference half its 95 % band.
    pub u_num: Option<f64>,
    /// Of the inputs.
    pub u_input: f64,
    /// Of D: half the 95 % band of a reference, or of the mean of measurements.
    #[serde(rename = "u_D")]
    pub u_d: Option<f64>,
    /// What each input makes of `u_input`, by name: the root of its variance, by itself.
    pub inputs: BTreeMap<String, f64>,
}

/// What an error shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Shown {
    /// |E| <= u_val: nothing.
    #[serde(rename = "within")]
    Within,
    /// u_val < |E| <= 2 u_val: a correct model may differ this much.
    #[serde(rename = "undecided")]
    Undecided,
    /// |E| > 2 u_val: an error of the model.
    #[serde(rename = "model error shown")]
    ModelError,
}

impl Shown {
    fn of(error: f64, u_val: f64) -> Self {
        match error.abs() {
            size if size <= u_val => Shown::Within,
            size if size <= COVERAGE * u_val => Shown::Undecided,
            _ => Shown::ModelError,
        }
    }

    /// As documents have it.
    pub fn words(self) -> &'static str {
        match self {
            Shown::Within => "within",
            Shown::Undecided => "undecided",
            Shown::ModelError => "model error shown",
        }
    }
}

/// Propagated input uncertainty of the result called `name`: that of its own model if there is one, else of model C, which stands for
/// the reference and for other programs.
pub fn propagated_of<'s>(
    propagations: &'s BTreeMap<String, PropagatedUncertainty>,
    name: &str,
) -> Option<&'s PropagatedUncertainty> {
    propagations.get(name).or_else(|| propagations.get(&Model::C.to_string()))
}

/// Standard numerical uncertainty of the quantity called `name` in `summary`; `None` if it is not known. That model A has one mode is its error,
/// not one of the solution.
pub fn numerical(summary: &Summary, name: &str) -> Option<f64> {
    let value = summary.value(name)?;
    if summary.model.as_deref() == Some("A") {
        return None;
    }
    let truncated =
        || summary.truncation_error.filter(|_| TRUNCATED.contains(&name)).map(|error| error * value.abs());
    summary.band(name).or_else(truncated).map(|band| band / COVERAGE)
}

impl Assessment {
    /// Of the `error` of a quantity with this `propagated`; `u_num` and `u_d` are the standard uncertainties of both sides. `None` if one of
    /// them is no number.
    pub fn of(
        error: f64,
        (u_num, u_d): (Option<f64>, Option<f64>),
        propagated: &QuantityUncertainty,
    ) -> Option<Self> {
        let u_input = propagated.standard_deviation;
        let alone = |first: f64| u_input * first.max(0.0).sqrt();
        let inputs = propagated.sobol.iter().map(|(name, share)| (name.clone(), alone(share.first)));
        Self::assessed(error, Parts { u_num, u_input, u_d, inputs: inputs.collect() }, propagated.unit)
    }

    /// Of the `error`, in `unit`, of a quantity whose inputs count as exact, as [`of`](Self::of). `None` if neither side's uncertainty is
    /// known either.
    pub fn of_exact_inputs(
        error: f64,
        (u_num, u_d): (Option<f64>, Option<f64>),
        unit: &'static str,
    ) -> Option<Self> {
        u_num.or(u_d)?;
        Self::assessed(error, Parts { u_num, u_input: 0.0, u_d, inputs: BTreeMap::new() }, unit)
    }

    fn assessed(error: f64, parts: Parts, unit: &'static str) -> Option<Self> {
        let known = [parts.u_num, Some(parts.u_input), parts.u_d].into_iter().flatten();
        let u_val = known.map(|u| u * u).sum::<f64>().sqrt();
        if !(error.is_finite() && u_val.is_finite()) {
            return None;
        }
        let verdict = Shown::of(error, u_val);
        let to = prefixed(unit, error.abs().max(u_val));
        let [size, uncertainty, both] = [error.abs(), u_val, COVERAGE * u_val].map(|v| with_unit(v, to, 2));
        let sentence = match verdict {
            Shown::Within => format!(
                "|E| = {size} is within u_val = {uncertainty}: with these uncertainties no model error is shown"
            ),
            Shown::Undecided => format!(
                "|E| = {size} lies between u_val = {uncertainty} and twice that: a correct model may differ this much"
            ),
            Shown::ModelError => {
                format!("|E| = {size} is more than 2 u_val = {both}: the model is in error, by E ± {both}")
            }
        };
        let would_decide =
            (verdict != Shown::ModelError).then(|| decisive(error, u_val, &parts.inputs)).flatten();
        Some(Assessment { error, u_val, parts, verdict, sentence, would_decide })
    }
}

/// Which inputs would have to be known how much better for an error to be shown: u_val has to fall to half of it.
fn decisive(error: f64, u_val: f64, inputs: &BTreeMap<String, f64>) -> Option<String> {
    let needed = (error / COVERAGE).powi(2);
    let (name, part) = inputs.iter().max_by(|a, b| a.1.total_cmp(b.1))?;
    let share = (100.0 * (part / u_val).powi(2)).min(100.0);
    let others = u_val * u_val - part * part;
    if others < needed {
        let ratio = ((needed - others).sqrt() / part).min(1.0);
        return Some(format!(
            "`{name}` ({share:.0} % of u_val^2) known to {:.0} % of its standard deviation would show an error of that size",
            100.0 * ratio
        ));
    }
    let all: f64 = inputs.values().map(|u| u * u).sum();
    Some(if u_val * u_val - all < needed {
        format!(
            "`{name}` has the largest share of u_val^2 ({share:.0} %); that alone would not show an error of that size, all inputs known better would"
        )
    } else {
        "better known inputs would not help: the uncertainty of the compared values is too large".to_owned()
    })
}

/// An assessment in a line, after the name of its quantity.
pub fn line(quantity: &str, assessment: &Assessment) -> String {
    let decides = assessment.would_decide.as_ref().map_or(String::new(), |decides| format!("; {decides}"));
    format!("{}: {}: {}{decides}", words(quantity), assessment.verdict.words(), assessment.sentence)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::Share;

    /// Scatter of 0.03, of which two inputs make shares of 0.64 and 0.36.
    fn propagated() -> QuantityUncertainty {
        let share = |first: f64| Share {
            first,
            first_interval: [first; 2],
            total: first,
            total_interval: [first; 2],
        };
        QuantityUncertainty {
            unit: "1",
            nominal: Some(0.7),
            mean: 0.7,
            mean_interval: [0.7; 2],
            standard_deviation: 0.03,
            standard_deviation_interval: [0.03; 2],
            linear_standard_deviation: 0.03,
            quantiles: BTreeMap::new(),
            sobol: [("thickness".to_owned(), share(0.64)), ("speed".to_owned(), share(0.36))].into(),
            local: BTreeMap::new(),
            values: Vec::new(),
        }
    }

    #[test]
    fn parts_add_by_their_squares_and_the_verdict_has_three_steps() {
        for (error, verdict) in [
            (0.04, Shown::Within),
            (-0.05, Shown::Within),
            (0.051, Shown::Undecided),
            (-0.1, Shown::Undecided),
            (0.11, Shown::ModelError),
        ] {
            let found = Assessment::of(error, (Some(0.0), Some(0.04)), &propagated()).expect("numbers");
            assert!((found.u_val - 0.05).abs() < 1e-15, "{found:?}");
            assert_eq!(found.verdict, verdict, "{found:?}");
            assert_eq!(found.would_decide.is_none(), verdict == Shown::ModelError);
        }
        let inputs = Assessment::of(0.0, (None, None), &propagated()).expect("numbers").parts.inputs;
        assert!((inputs["thickness"] - 0.024).abs() < 1e-15 && (inputs["speed"] - 0.018).abs() < 1e-15);
        assert_eq!(Assessment::of(f64::NAN, (None, None), &propagated()), None);
    }

    #[test]
    fn the_input_that_decides_is_named_with_its_required_accuracy() {
        let sentence = |error| {
            let found = Assessment::of(error, (None, None), &propagated()).expect("numbers");
            found.would_decide.expect("none shown")
        };
        // u_val has to fall to 0.02: thickness from 0.024 to sqrt(0.02^2 - 0.018^2) = 0.00872, 36 % of it
        assert!(
            sentence(0.04).contains("`thickness` (64 % of u_val^2) known to 36 % of"),
            "{}",
            sentence(0.04)
        );
        assert!(sentence(0.02).contains("all inputs known better would"), "{}", sentence(0.02));
        let coarse = Assessment::of(0.02, (None, Some(0.03)), &propagated()).expect("numbers");
        assert!(coarse.would_decide.expect("none shown").starts_with("better known inputs would not help"));
    }
}
