//! What messages about a scene file advise: the choices there are, how a key is written.

use super::grammar::{Choice, Field, Kind};
use super::place::Place;
use super::quantity::Dimension;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The choice a value makes, if it is one.
pub(super) fn chosen<'f>(field: &'f Field, value: &Spanned<DeValue>) -> Option<&'f Choice> {
    let Kind::Choice(choices) = &field.kind else { return None };
    let text = value.get_ref().as_str()?;
    choices.iter().find(|c| c.name == text)
}

/// "it can be: a, b".
pub(super) fn alternatives(field: &Field) -> String {
    let Kind::Choice(choices) = &field.kind else { return String::new() };
    let names: Vec<&str> = choices.iter().map(|c| c.name).collect();
    format!("it can be: {}", names.join(", "))
}

/// What a key of this kind has to be, and how to write it.
pub(super) fn needed(kind: &Kind, path: &str) -> (&'static str, String) {
    match kind {
        Kind::Choice(choices) => {
            let names: Vec<&str> = choices.iter().map(|c| c.name).collect();
            ("a text", format!("write one of: \"{}\"", names.join("\", \"")))
        }
        Kind::Quantities(dimension, ..) => (
            "a list",
            format!("write a list in square brackets, for example [\"{}\"]", dimension.describe().2),
        ),
        Kind::Texts(_) => (
            "a list",
            "write a list in square brackets, for example [\"python3\", \"my_model.py\"]".to_owned(),
        ),
        Kind::Place => (
            "a name or three coordinates",
            "write the name of a point, set or face, or a place like [\"1 mm\", \"0 mm\", \"12 mm\"]"
                .to_owned(),
        ),
        Kind::Places(most) => (
            "a list of names or places",
            format!(
                "write a list of at most {most} names or places like [\"base\", [\"33 mm\", \"0 mm\", \"1 mm\"]]"
            ),
        ),
        Kind::Tables(..) => ("a list of tables", "write a list like [{ key = value }]".to_owned()),
        Kind::Named(Field { kind: Kind::Material, .. }) => (
            "a table of materials by group",
            "write materials like { \"name of a group\" = \"steel\" }".to_owned(),
        ),
        Kind::Named(Field { key, .. }) => {
            ("a table", format!("write entries like {{ \"name\" = ... }}, each with its {key}"))
        }
        Kind::Start => (
            "a number, true or false, or a text",
            "write a number, true, false, or the path of a number of the scene, for example \"outer.speed\""
                .to_owned(),
        ),
        Kind::Flag => ("true or false", "write true or false, without quotes".to_owned()),
        Kind::Table(_) | Kind::TableOf(_) | Kind::Tolerances | Kind::Uncertainty => {
            ("a table", format!("write a table [{path}]"))
        }
        _ => ("a text", "write a text in quotes".to_owned()),
    }
}

/// An example of a missing key.
pub(super) fn example(place: &Place, field: &Field) -> String {
    let (key, doc) = (field.key, field.doc);
    match &field.kind {
        Kind::Table(_) => format!("a table [{}]: {doc}", place.key(key)),
        Kind::TableOf(_) => format!("a table [{}.steel]: {doc}", place.key(key)),
        Kind::Quantity(dimension, bound) => {
            let (_, unit, sample) = dimension.describe();
            let quote = if *dimension == Dimension::NONE { "" } else { "\"" };
            // the sample shows how a number is written, not which one would be sensible here
            format!("`{key} = ...`, written like {quote}{sample}{quote}: {doc}, {}", bound.describe(unit))
        }
        Kind::Quantities(dimension, bound, most) => {
            let (_, unit, sample) = dimension.describe();
            format!("`{key} = [\"{sample}\"]`: {doc}, 1 to {most} numbers, each {}", bound.describe(unit))
        }
        Kind::Choice(choices) => format!("`{key} = \"{}\"`: {doc}; {}", choices[0].name, alternatives(field)),
        Kind::Count(low, _) => format!("`{key} = {low}`: {doc}"),
        Kind::Flag => format!("`{key} = true`: {doc}"),
        Kind::Texts(_) => format!("`{key} = [\"...\"]`: {doc}"),
        _ => format!("`{key} = \"...\"`: {doc}"),
    }
}

/// What to write instead of the diameter `name`, if there is the radius among `valid`.
pub(super) fn half_of_it(name: &str, table: &DeTable, valid: &[&str]) -> Option<String> {
    let radius = name.to_lowercase().replace("diameter", "radius");
    if radius == name.to_lowercase() || !valid.contains(&&*radius) {
        return None;
    }
    let text = match table.get(name)?.get_ref() {
        DeValue::String(text) => text.to_string(),
        DeValue::Float(number) => number.as_str().to_owned(),
        DeValue::Integer(number) => number.as_str().to_owned(),
        _ => String::new(),
    };
    let (number, unit) = text.trim().split_once(char::is_whitespace).unwrap_or((text.trim(), ""));
    let half = number.parse::<f64>().ok().filter(|d| d.is_finite()).map(|d| 0.5 * d);
    let value = half.map(|half| {
        if unit.is_empty() {
            format!(": {radius} = {half}")
        } else {
            format!(": {radius} = \"{half} {unit}\"")
        }
    });
    Some(format!("give the radius instead, {radius} = {name} / 2{}; ", value.unwrap_or_default()))
}
