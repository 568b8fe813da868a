//! One axis of a sweep: the fields that take a value, and its values.

use crate::error::{Error, Result};
use crate::scene::{Field, Template};
use serde::Deserialize;
use std::ops::RangeInclusive;

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Sampling {
    #[default]
    Grid,
    LatinHypercube,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Vary {
    field: Option<String>,
    fields: Option<Vec<String>>,
    from: Option<Number>,
    to: Option<Number>,
    count: Option<usize>,
    #[serde(default)]
    scale: Scale,
    values: Option<Vec<Number>>,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Scale {
    #[default]
    Linear,
    Log,
}

/// A number in SI or a text with unit.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Number {
    Number(f64),
    Text(String),
}

impl Number {
    fn of(&self, field: &Field) -> Result<f64> {
        match self {
            Number::Number(value) => Ok(*value),
            Number::Text(text) => field.parse(text),
        }
    }
}

/// What one number of a point does: the fields that take it and the values it has.
#[derive(Debug)]
pub(super) struct SweepAxis {
    pub(super) fields: Vec<Field>,
    pub(super) values: Values,
}

#[derive(Debug)]
pub(super) enum Values {
    List(Vec<f64>),
    Range { from: f64, to: f64, count: usize, scale: Scale },
}

impl Values {
    pub(super) fn len(&self) -> usize {
        match self {
            Values::List(values) => values.len(),
            Values::Range { count, .. } => *count,
        }
    }

    /// Whether they are evenly spaced by their logarithms.
    pub(super) fn is_logarithmic(&self) -> bool {
        matches!(self, Values::Range { scale: Scale::Log, .. })
    }

    /// From the lowest to the highest.
    pub(super) fn range(&self) -> RangeInclusive<f64> {
        let span = |values: &[f64]| {
            let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
            values.iter().fold((low, high), |(low, high), v| (low.min(*v), high.max(*v)))
        };
        let (low, high) = match self {
            Values::List(values) => span(values),
            Values::Range { from, to, .. } => span(&[*from, *to]),
        };
        low..=high
    }

    /// The value at `s` in 0..=1 of a range.
    fn between(from: f64, to: f64, scale: Scale, s: f64) -> f64 {
        match scale {
            // the ends are met exactly
            _ if s == 1.0 => to,
            Scale::Linear => from + (to - from) * s,
            Scale::Log => from * (to / from).powf(s),
        }
    }

    /// Value number `k` of a grid.
    pub(super) fn of_grid(&self, k: usize) -> f64 {
        match self {
            Values::List(values) => values[k],
            Values::Range { from, to, count, scale } => {
                let s = if *count > 1 { k as f64 / (count - 1) as f64 } else { 0.0 };
                Self::between(*from, *to, *scale, s)
            }
        }
    }

    /// The value at `s` in 0..1 of a sample.
    pub(super) fn of_sample(&self, s: f64) -> f64 {
        match self {
            Values::List(values) => values[((s * values.len() as f64) as usize).min(values.len() - 1)],
            Values::Range { from, to, scale, .. } => Self::between(*from, *to, *scale, s),
        }
    }
}

impl SweepAxis {
    /// What `vary` asks of the scene `template`; `fault` says where it stands in the file.
    ///
    /// # Errors
    /// For values or fields that don't fit.
    pub(super) fn new(
        vary: &Vary,
        sampling: Sampling,
        template: &Template,
        fault: &dyn Fn(String) -> Error,
    ) -> Result<Self> {
        let names = match (&vary.field, &vary.fields) {
            (Some(one), None) => vec![one.clone()],
            (None, Some(several)) if !several.is_empty() => several.clone(),
            _ => {
                return Err(fault(
                    "name either one `field` or several `fields` that take the same value".into(),
                ));
            }
        };
        let fields: Vec<Field> = names.iter().map(|name| template.field(name)).collect::<Result<_>>()?;
        let lead = &fields[0];
        if let Some(other) = fields.iter().find(|field| field.unit() != lead.unit()) {
            return Err(fault(format!(
                "`{}` ({}) and `{}` ({}) can't share values",
                lead.path(),
                lead.unit(),
                other.path(),
                other.unit()
            )));
        }
        let values = match (&vary.values, &vary.from, &vary.to) {
            (Some(list), None, None)
                if !list.is_empty() && vary.count.is_none() && vary.scale == Scale::Linear =>
            {
                Values::List(list.iter().map(|value| value.of(lead)).collect::<Result<_>>()?)
            }
            (None, Some(from), Some(to)) => {
                let (from, to) = (from.of(lead)?, to.of(lead)?);
                let count = match (sampling, vary.count) {
                    (Sampling::Grid, Some(count)) if count >= 1 => count,
                    (Sampling::Grid, _) => {
                        return Err(fault(format!(
                            "count is {}: a range of a grid needs 1 or more",
                            vary.count.map_or("missing".into(), |n| n.to_string())
                        )));
                    }
                    (Sampling::LatinHypercube, None) => 1,
                    (Sampling::LatinHypercube, Some(_)) => {
                        return Err(fault(
                            "`count` belongs to a grid; a Latin hypercube has `samples`".into(),
                        ));
                    }
                };
                if !(from.is_finite() && to.is_finite()) {
                    return Err(fault(format!("from {from} to {to} is no range")));
                }
                if vary.scale == Scale::Log && !(from > 0.0 && to > 0.0) {
                    return Err(fault(format!("from {from} to {to}: a logarithmic range has positive ends")));
                }
                Values::Range { from, to, count, scale: vary.scale }
            }
            _ => {
                return Err(fault(
                    "give either `values = [...]` or `from`, `to` and, for a grid, `count`".into(),
                ));
            }
        };
        Ok(Self { fields, values })
    }
}
