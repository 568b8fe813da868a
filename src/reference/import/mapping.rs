//! How a file from another program is to be read: which column is which curve, in which unit and sign, and what is known of
//! the program.

use crate::curves::table::{self, Column};
use crate::kinds::Kind;
use crate::scene::quantity_in;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A map; everything in it is optional.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Mapping {
    pub(super) provenance: Provenance,
    pub(super) table: Form,
    /// Columns by the name of the curve, or `time`.
    columns: BTreeMap<String, Mapped>,
    /// Results that the program states, by their names.
    quantities: BTreeMap<String, Number>,
    /// Half widths of their 95 % bands.
    uncertainty: BTreeMap<String, Number>,
}

/// Who made the result with what.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Provenance {
    pub(super) program: Option<String>,
    pub(super) version: Option<String>,
    pub(super) who: Option<String>,
    /// Elements and their sizes, in words.
    pub(super) mesh: Option<String>,
}

/// Form of a table of text.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Form {
    /// Lines before the headings.
    pub(super) skip: usize,
    /// Between columns: one character, or "spaces" for any number of them.
    pub(super) delimiter: String,
    /// Whether the first line after those skipped has headings.
    pub(super) headings: bool,
}

impl Default for Form {
    fn default() -> Self {
        Form { skip: 0, delimiter: ",".into(), headings: true }
    }
}

/// A column.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Mapped {
    column: Place,
    /// Its unit; none: SI.
    unit: Option<String>,
    /// -1 if it counts the other way.
    #[serde(default = "one")]
    sign: f64,
    /// What is added after unit and sign.
    offset: Option<Number>,
}

fn one() -> f64 {
    1.0
}

/// Where a column is.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Place {
    /// Counted from 1.
    Number(usize),
    Heading(String),
}

/// A number in SI, or one with its unit.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Number {
    Si(f64),
    WithUnit(String),
}

impl Number {
    fn in_si(&self, name: &str, unit: &str) -> Result<f64, String> {
        let value = match self {
            Number::Si(value) => Ok(*value),
            Number::WithUnit(text) => quantity_in(text, unit).map_err(|reason| format!("{name}: {reason}")),
        };
        value.and_then(
            |v| if v.is_finite() { Ok(v) } else { Err(format!("{name} is {v}, not a finite number")) },
        )
    }
}

impl Mapping {
    /// Reads the text of a map.
    ///
    /// # Errors
    /// What TOML says.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|error| error.to_string())
    }

    /// The headings that columns are looked for by.
    pub(super) fn headings(&self) -> Vec<&str> {
        self.columns.values().filter_map(|mapped| mapped.column.heading()).collect()
    }

    /// The columns in a table with these `headings`; without a map they are named by them.
    ///
    /// # Errors
    /// One sentence with the column.
    pub(super) fn columns(&self, kind: &dyn Kind, headings: &[&str]) -> Result<Vec<Column>, String> {
        if self.columns.is_empty() {
            return table::by_heading(headings.iter().copied(), kind.curves());
        }
        let column = |(name, mapped): (&String, &Mapped)| {
            let (name, si) = table::known_column(name, kind.curves())?;
            let index =
                mapped.column.index(headings).map_err(|reason| format!("columns.{name}: {reason}"))?;
            let unit = mapped.unit.as_deref().map_or(Ok(1.0), |unit| table::in_si(unit, si));
            let unit = unit.map_err(|reason| format!("columns.{name}: {reason}"))?;
            if mapped.sign.abs() != 1.0 {
                return Err(format!("columns.{name}.sign is {}, but it must be 1 or -1", mapped.sign));
            }
            let offset = mapped.offset.as_ref().map_or(Ok(0.0), |offset| offset.in_si(name, si))?;
            Ok(Column { name, index, factor: mapped.sign * unit, offset })
        };
        self.columns.iter().map(column).collect()
    }

    /// The results stated, and their bands, in SI.
    ///
    /// # Errors
    /// One sentence with the quantity.
    pub(super) fn stated(&self, kind: &dyn Kind) -> Result<[BTreeMap<String, f64>; 2], String> {
        let of = |numbers: &BTreeMap<String, Number>| -> Result<BTreeMap<String, f64>, String> {
            let known = |name: &str| kind.quantities().iter().find(|quantity| quantity.name == name);
            let number = |(name, number): (&String, &Number)| {
                let quantity =
                    known(name).ok_or_else(|| format!("`{name}` is no quantity of this kind of scene"))?;
                Ok((name.clone(), number.in_si(name, quantity.unit)?))
            };
            numbers.iter().map(number).collect()
        };
        let bands = of(&self.uncertainty)?;
        match bands.iter().find(|(_, band)| **band < 0.0) {
            Some((name, band)) => Err(format!("uncertainty.{name} is {band}, but it must be 0 or more")),
            None => Ok([of(&self.quantities)?, bands]),
        }
    }
}

impl Place {
    fn heading(&self) -> Option<&str> {
        match self {
            Place::Heading(heading) => Some(heading),
            Place::Number(_) => None,
        }
    }

    fn index(&self, headings: &[&str]) -> Result<usize, String> {
        let absent =
            |what: String| format!("there is no column {what} (there are: {})", headings.join(" | "));
        match self {
            Place::Number(number @ 1..) if *number <= headings.len() => Ok(number - 1),
            Place::Number(number) => Err(absent(number.to_string())),
            Place::Heading(heading) => {
                let found = headings.iter().enumerate().filter(|(_, other)| other.trim() == heading.trim());
                match found.map(|(place, _)| place).collect::<Vec<_>>()[..] {
                    [place] => Ok(place),
                    [] => Err(absent(format!("`{heading}`"))),
                    _ => Err(format!(
                        "several columns are called `{heading}`; name the one that is meant by its number"
                    )),
                }
            }
        }
    }
}
