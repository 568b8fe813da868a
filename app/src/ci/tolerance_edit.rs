//! New biases and bounds in a scene file, everything else of which stays as it is, comments included.

use super::acceptance::ToleranceChange;
use crate::comparison::{Discrepancy, SceneComparison};
use crate::error::{Error, Result};
use toml_edit::{DocumentMut, Formatted, InlineTable, Item, TableLike, Value};

/// Share of the bound that rounding of a bias may take.
const ROUNDING: f64 = 0.02;
/// A residual's new bound over its value.
const RESIDUAL_MARGIN: f64 = 2.0;

/// The text of the scene file with the tolerances of all rows that fail changed so that they pass: the difference found
/// becomes the bias, the bound about it stays; of a residual the bound is raised. Nothing else is touched.
///
/// # Errors
/// [`Error::Usage`] if a tolerance is not where it should be, or the row holds what is not a number.
pub fn edited(text: &str, comparison: &SceneComparison) -> Result<(String, Vec<ToleranceChange>)> {
    let invalid = |what: String| Error::Usage(format!("the scene file can't be edited: {what}"));
    let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| invalid(e.to_string()))?;
    let mut changes = Vec::new();
    for model in &comparison.models {
        for row in model.discrepancies.iter().filter(|row| row.verdict.failed()) {
            let place = format!("tolerances.{}.{}", model.model, row.quantity);
            if row.is_undetermined() {
                return Err(Error::Usage(format!(
                    "`{place}`: what a run has not determined can't be accepted"
                )));
            }
            if row.tolerance.is_none() || !row.difference.is_some_and(f64::is_finite) {
                return Err(Error::Usage(format!("`{place}`: what is not a number can't be accepted")));
            }
            let found = document
                .get_mut("tolerances")
                .and_then(|t| t.get_mut(&model.model))
                .and_then(|t| t.get_mut(&row.quantity));
            let item = found.ok_or_else(|| invalid(format!("there is no `{place}`")))?;
            let from = shown(item);
            change(item, row).ok_or_else(|| invalid(format!("`{place}` = {from} has no bound to go by")))?;
            let to = shown(item);
            changes.push(ToleranceChange {
                model: model.model.clone(),
                quantity: row.quantity.clone(),
                from,
                to,
            });
        }
    }
    Ok((document.to_string(), changes))
}

/// A value without the comment behind it.
pub(super) fn shown(item: &Item) -> String {
    item.as_value().map_or_else(|| item.to_string(), |value| value.clone().decorated("", "").to_string())
}

/// Line (from 1) of the tolerance of `quantity` in the text of a scene file, else of the model's table.
pub fn line_of(text: &str, model: &str, quantity: &str) -> Option<usize> {
    let root = toml::de::DeTable::parse(text).ok()?;
    let models = root.get_ref().get("tolerances")?.get_ref().as_table()?;
    let (key, table) = models.get_key_value(model)?;
    let found = table.get_ref().as_table().and_then(|t| t.get_key_value(quantity));
    let start = found.map_or(key.span().start, |(key, _)| key.span().start);
    Some(1 + text[..start].matches('\n').count())
}

fn change(item: &mut Item, row: &Discrepancy) -> Option<()> {
    if row.is_residual() {
        let bound = rounded_up(RESIDUAL_MARGIN * row.reduced?.abs().max(row.reference?.abs()));
        return match item.as_table_like_mut() {
            Some(terms) => put(terms, "absolute", bound),
            None => {
                set_number(item.as_value_mut()?, bound);
                Some(())
            }
        };
    }
    // a bare number is a relative bound
    if let Some(bound) = item.as_value().filter(|v| v.is_float() || v.is_integer()).cloned() {
        let mut terms = InlineTable::new();
        terms.insert("relative", bound.decorated(" ", ""));
        *item.as_value_mut()? = Value::InlineTable(terms).decorated(" ", "");
    }
    let terms = item.as_table_like_mut()?;
    let key = ["relative", "absolute", "relative_to_peak"].into_iter().find(|k| terms.contains_key(k))?;
    let bound = terms.get(key)?.as_value()?.clone();
    let (size, unit) = number_and_unit(&bound)?;
    // what a bias of 1 in the terms of the bound is in SI
    let scale = match (key, row.relative) {
        ("absolute", _) => unit
            .as_deref()
            .map_or(Some(1.0), |unit| crate::scene::quantity_in(&format!("1 {unit}"), &row.unit).ok())?,
        ("relative", Some(relative)) if relative != 0.0 => row.difference? / relative,
        _ => row.tolerance? / size,
    };
    let difference = row.difference?;
    let step = 10_f64.powf((ROUNDING * size).abs().log10().floor());
    let bias = difference / scale;
    let bias = if step > 0.0 { (bias / step).round() * step } else { bias };
    let decimals = if step > 0.0 { (-step.log10()).round().max(0.0) as usize } else { 12 };
    let text = format!("{bias:.decimals$}");
    let value = match unit {
        Some(unit) => Value::from(format!("{text} {unit}")),
        None => text.parse::<f64>().ok().map(Value::from)?,
    };
    insert(terms, "bias", value)
}

/// Number and unit of a bound: `0.01`, `"0.5 us"`.
fn number_and_unit(value: &Value) -> Option<(f64, Option<String>)> {
    match value {
        Value::Float(number) => Some((*number.value(), None)),
        Value::Integer(number) => Some((*number.value() as f64, None)),
        Value::String(text) => {
            let (number, unit) = text.value().trim().split_once(char::is_whitespace)?;
            Some((number.parse().ok()?, Some(unit.trim().to_owned())))
        }
        _ => None,
    }
}

/// Two digits, not smaller than `value`.
fn rounded_up(value: f64) -> f64 {
    let unit = 10_f64.powf(value.abs().log10().floor() - 1.0);
    let rounded = (value / unit).ceil() * unit;
    // the shortest number that reads the same
    format!("{rounded:.1e}").parse().unwrap_or(rounded)
}

fn put(terms: &mut dyn TableLike, key: &str, number: f64) -> Option<()> {
    let mut value = Value::from(number);
    set_number(&mut value, number);
    insert(terms, key, value)
}

/// Writes small numbers as people do.
fn set_number(value: &mut Value, number: f64) {
    let text = if (1e-3..1e6).contains(&number.abs()) { format!("{number}") } else { format!("{number:e}") };
    let parsed = text.parse::<Value>().unwrap_or_else(|_| Value::Float(Formatted::new(number)));
    let decor = value.decor().clone();
    *value = parsed;
    *value.decor_mut() = decor;
}

/// Puts a value in the place of `key`, or behind the other terms.
fn insert(terms: &mut dyn TableLike, key: &str, mut value: Value) -> Option<()> {
    match terms.get_mut(key).and_then(Item::as_value_mut) {
        Some(old) => {
            *value.decor_mut() = old.decor().clone();
            *old = value;
        }
        None => {
            // the space before the brace moves behind the new last term
            if let Some(last) = terms.iter().last().map(|(key, _)| key.to_owned()) {
                terms.get_mut(&last)?.as_value_mut()?.decor_mut().set_suffix("");
            }
            terms.insert(key, Item::Value(value.decorated(" ", " ")));
        }
    }
    Some(())
}
