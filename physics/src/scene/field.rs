//! The numeric fields of a scene file: their names, bounds and places.

use super::grammar;
use super::grammar::Kind;
use super::quantity::{self, Dimension, QuantityError};
use super::values::{Checked, Values};
use crate::{Error, Result};

/// A numeric field of a scene file, such as `plate.thickness` or `materials.steel.density`.
#[derive(Debug, Clone)]
pub struct Field {
    pub(super) path: String,
    pub(super) keys: Vec<String>,
    key: &'static grammar::Field,
}

/// Why a value can't stand in a field.
#[derive(Debug, Clone, PartialEq)]
pub struct Rejected(pub String);

impl std::fmt::Display for Rejected {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl Field {
    /// Its name, keys joined by dots.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Its SI unit; "1" for a pure number.
    pub fn unit(&self) -> &'static str {
        self.dimension().describe().1
    }

    /// Whether it takes whole numbers only.
    pub fn is_count(&self) -> bool {
        matches!(self.key.kind, Kind::Count(..))
    }

    /// Dimension of its numbers.
    pub(super) fn dimension(&self) -> Dimension {
        match self.key.kind {
            Kind::Quantity(dimension, _) | Kind::Quantities(dimension, ..) => dimension,
            _ => Dimension::NONE,
        }
    }

    /// What it is, in a line.
    pub fn description(&self) -> &'static str {
        self.key.doc
    }

    /// Least and largest number that [`Field::check`] admits, in SI. Some kinds of fields admit 0 although it is below the least.
    pub fn limits(&self) -> [f64; 2] {
        match self.key.kind {
            Kind::Quantity(dimension, bound) | Kind::Quantities(dimension, bound, _) => {
                let [smallest, largest] = dimension.span();
                let closed = |end: Option<(f64, bool)>, inside: fn(f64) -> f64| {
                    end.map(|(at, is_valid)| if is_valid { at } else { inside(at) })
                };
                let low = closed(bound.low, f64::next_up).unwrap_or(-largest);
                let high = closed(bound.high, f64::next_down).unwrap_or(largest);
                [if low > 0.0 { low.max(smallest) } else { low }, high.min(largest)]
            }
            Kind::Count(low, high) => [low as f64, high as f64],
            _ => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// Reads a number with unit, or a bare one in SI.
    ///
    /// # Errors
    /// [`Error::Usage`] with the text and what is needed.
    pub fn parse(&self, text: &str) -> Result<f64> {
        let (what, _, sample) = self.dimension().describe();
        let fault = |reason: String| {
            let like =
                if self.dimension() == Dimension::NONE { sample.to_owned() } else { format!("\"{sample}\"") };
            Error::Usage(format!("`{}` = `{text}`: {reason}; write {what}, for example {like}", self.path))
        };
        let number = quantity::parse(text, self.dimension()).map_err(|error| {
            fault(match error {
                QuantityError::NotANumber => "that is not a number with a unit".into(),
                QuantityError::UnknownUnit(u) => format!("`{u}` is not a known unit"),
                QuantityError::MalformedUnit(u) => format!("`{u}` is not a product of units"),
                QuantityError::WrongDimension(u) => {
                    format!("`{u}` is not the unit of {}", self.dimension().in_words())
                }
                QuantityError::OutOfRange => "double precision can't hold it".into(),
            })
        })?;
        Ok(number)
    }

    /// Whether `value`, in SI, may stand in the field.
    ///
    /// # Errors
    /// [`Rejected`] with field, value, bound and unit.
    pub fn check(&self, value: f64) -> std::result::Result<(), Rejected> {
        let unit = self.unit();
        let shown = self.dimension().suffix();
        let rejected =
            |range: String| Rejected(format!("`{}` is {value}{shown}, but it must be {range}", self.path));
        match self.key.kind {
            Kind::Quantity(_, bound) | Kind::Quantities(_, bound, _) if !bound.holds(value) => {
                Err(rejected(bound.describe(unit)))
            }
            Kind::Quantity(dimension, _) | Kind::Quantities(dimension, ..)
                if !dimension.is_plausible(value) =>
            {
                let [low, high] = dimension.span();
                Err(rejected(format!("between {low:e} and {high:e}{shown}")))
            }
            Kind::Quantity(..) | Kind::Quantities(..) => Ok(()),
            Kind::Count(low, high) => {
                let whole = value.fract() == 0.0 && value >= low as f64 && value <= high as f64;
                if whole { Ok(()) } else { Err(rejected(format!("a whole number from {low} to {high}"))) }
            }
            _ => Err(rejected("a number".into())),
        }
    }
}

/// Why the field called `path` changes no reduced model of a scene with these checked `values`, if it does not.
pub(super) fn without_effect(values: &Values, path: &str) -> Option<&'static str> {
    let of_material = |key: &str| path.strip_suffix(key).filter(|rest| rest.starts_with("materials."));
    if path.starts_with("reference.") {
        return Some("only the reference uses it");
    }
    if path.starts_with("flight.") || path.starts_with("vibration.") {
        return Some("only the flight uses it; it does not change the impact");
    }
    let material = of_material(".yield_strength")?;
    (!has(values, &format!("{material}.hardening")))
        .then_some("without `hardening` the material stays elastic")
}

/// Whether checked `values` have something at `path`.
fn has(values: &Values, path: &str) -> bool {
    let (tables, key) = path.rsplit_once('.').unwrap_or(("", path));
    tables
        .split_terminator('.')
        .try_fold(values, |values, table| match values.get(table) {
            Some(Checked::Table(inner)) => Some(&**inner),
            _ => None,
        })
        .is_some_and(|values| values.contains_key(key))
}

/// Every numeric field among `keys` that a scene with these checked `values` has or may have and a reduced model knows.
pub(super) fn fields_of(keys: &'static [grammar::Field], values: &Values) -> Vec<Field> {
    let mut fields = Vec::new();
    collect(keys, Some(values), &mut Vec::new(), &mut fields);
    fields.retain(|field: &Field| without_effect(values, &field.path).is_none());
    fields
}

/// What checked `values` have in `field`, in SI; `None` if they say nothing there.
pub(super) fn number_in(values: &Values, field: &Field) -> Option<f64> {
    let (last, tables) = field.keys.split_last()?;
    let mut values = values;
    for key in tables {
        match values.get(key)? {
            Checked::Table(inner) => values = inner,
            Checked::Numbers(list) => return list.get(index(std::slice::from_ref(last))?).copied(),
            _ => return None,
        }
    }
    match values.get(last)? {
        Checked::Number(number) => Some(*number),
        Checked::Count(count) => Some(*count as f64),
        _ => None,
    }
}

/// The place in a list that the last key names, counted from 1.
pub(super) fn index(keys: &[String]) -> Option<usize> {
    let [key] = keys else { return None };
    key.parse::<usize>().ok()?.checked_sub(1)
}

/// The numeric fields below a table with the keys of `specification`; `values` is what the file has there.
fn collect(
    specification: &'static [grammar::Field],
    values: Option<&Values>,
    keys: &mut Vec<String>,
    found: &mut Vec<Field>,
) {
    let text = |key: &str| match values.and_then(|v| v.get(key)) {
        Some(Checked::Text(text)) => Some(text.as_str()),
        _ => None,
    };
    let table = |key: &str| match values.and_then(|v| v.get(key)) {
        Some(Checked::Table(inner)) => Some(&**inner),
        _ => None,
    };
    let kind = text("kind").map(str::to_owned);
    for field in specification {
        if !field.belongs_to(kind.as_deref()) || is_another_way(specification, values, kind.as_deref(), field)
        {
            continue;
        }
        keys.push(field.key.to_owned());
        match &field.kind {
            Kind::Quantity(..) | Kind::Count(..) => {
                found.push(Field { path: keys.join("."), keys: keys.clone(), key: field });
            }
            // the entries of a list that the file has, counted from 1
            Kind::Quantities(..) => {
                let list = values.and_then(|v| v.get(field.key));
                let count = if let Some(Checked::Numbers(list)) = list { list.len() } else { 0 };
                for entry in 1..=count {
                    keys.push(entry.to_string());
                    found.push(Field { path: keys.join("."), keys: keys.clone(), key: field });
                    keys.pop();
                }
            }
            Kind::Table(inner) => {
                let there = table(field.key);
                // one number alone does not make a table that has to have others
                if there.is_some() || inner.iter().all(|f| !f.required) {
                    collect(inner, there, keys, found);
                }
            }
            Kind::TableOf(inner) => {
                for (name, entry) in table(field.key).into_iter().flatten() {
                    if let Checked::Table(entry) = entry {
                        keys.push(name.clone());
                        collect(inner, Some(entry), keys, found);
                        keys.pop();
                    }
                }
            }
            _ => {}
        }
        keys.pop();
    }
}

/// Whether `field` says in another way than the file what can be said in several; where the file says nothing, also if it takes more
/// numbers than one.
fn is_another_way(
    specification: &[grammar::Field],
    values: Option<&Values>,
    kind: Option<&str>,
    field: &grammar::Field,
) -> bool {
    let is_there = |field: &grammar::Field| values.is_some_and(|v| v.contains_key(field.key));
    let Some(own) = field.alternative(kind).filter(|_| !is_there(field)) else { return false };
    let ways = || specification.iter().filter_map(|other| Some((other, other.alternative(kind)?)));
    let taken = ways().any(|(other, way)| way.group == own.group && is_there(other));
    taken || ways().filter(|(_, way)| *way == own).count() > 1
}
