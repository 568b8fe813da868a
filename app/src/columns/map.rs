//! A map: how a file is to be read. Which column is which curve, in which unit and sign, and what is known of who made it. Everything in it may
//! be missing: what is not said is inferred from the file.

use super::column::{Column, Measures, Titles, known_column, listed, unit_in_si};
use super::layout::TextLayout;
use crate::result::{Curve, Quantity};
use crate::scene::quantity_in;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A map.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Map {
    /// Who made the file with what.
    pub provenance: Provenance,
    /// TableForm of the text.
    pub table: TableForm,
    /// The times, where no column has them.
    pub time: Option<Even>,
    /// Columns by the name of the curve, or `time`.
    pub(super) columns: BTreeMap<String, Mapped>,
    /// Results that a program states, by their names.
    quantities: BTreeMap<String, SiNumber>,
    /// Half widths of their 95 % bands.
    uncertainty: BTreeMap<String, SiNumber>,
    /// Its own text.
    #[serde(skip)]
    pub(super) text: String,
}

/// Who made a result with what.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Provenance {
    /// Name of the program.
    pub program: Option<String>,
    /// Its version.
    pub version: Option<String>,
    /// Who ran it.
    pub who: Option<String>,
    /// Elements and their sizes, in words.
    pub mesh: Option<String>,
}

/// TableForm of a table of text.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TableForm {
    /// Lines to leave out at the beginning.
    pub skip: usize,
    /// Between columns: one character, `tab`, or `spaces` for any number of them.
    pub delimiter: Option<String>,
    /// Decimal sign, `.` or `,`.
    pub decimal: Option<String>,
    /// `utf-8`, `utf-16` or `latin-1`.
    pub encoding: Option<String>,
    /// Whether headings stand above the numbers.
    pub headings: bool,
    /// Whether a line of units stands between headings and numbers.
    pub units_line: Option<bool>,
}

impl Default for TableForm {
    fn default() -> Self {
        TableForm {
            skip: 0,
            delimiter: None,
            decimal: None,
            encoding: None,
            headings: true,
            units_line: None,
        }
    }
}

/// Times at even distances.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Even {
    /// Of the first row.
    start: Option<SiNumber>,
    /// Between two rows.
    interval: SiNumber,
}

impl Even {
    /// Start and interval in s.
    ///
    /// # Errors
    /// One sentence.
    pub(super) fn in_si(&self) -> Result<[f64; 2], String> {
        let start = self.start.as_ref().map_or(Ok(0.0), |start| start.in_si("time.start", "s"))?;
        let interval = self.interval.in_si("time.interval", "s")?;
        match interval > 0.0 {
            true => Ok([start, interval]),
            false => Err(format!("time.interval is {interval} s, but it must be above 0")),
        }
    }
}

/// A column.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Mapped {
    column: ColumnPlace,
    /// Its unit; none: the heading's, or SI.
    unit: Option<String>,
    /// -1 if it counts the other way.
    #[serde(default = "one")]
    sign: f64,
    /// What is added after unit and sign.
    offset: Option<SiNumber>,
    /// What the column measures, if not what the curve is.
    #[serde(alias = "kind")]
    quantity: Option<Measures>,
    /// What a volt, or a strain of 1, stands for.
    sensitivity: Option<String>,
    /// By which its channel is late.
    delay: Option<SiNumber>,
    /// A column with the times of this one alone.
    time: Option<ColumnPlace>,
}

fn one() -> f64 {
    1.0
}

/// Where a column is.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum ColumnPlace {
    /// Counted from 1.
    Number(usize),
    Heading(String),
}

/// A number in SI, or one with its unit.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum SiNumber {
    Si(f64),
    WithUnit(String),
}

impl SiNumber {
    fn in_si(&self, name: &str, unit: &str) -> Result<f64, String> {
        let value = match self {
            SiNumber::Si(value) => Ok(*value),
            SiNumber::WithUnit(text) => quantity_in(text, unit).map_err(|reason| format!("{name}: {reason}")),
        };
        value.and_then(
            |v| if v.is_finite() { Ok(v) } else { Err(format!("{name} is {v}, not a finite number")) },
        )
    }
}

impl Map {
    /// Reads the text of a map.
    ///
    /// # Errors
    /// What TOML says.
    pub fn parse(text: &str) -> Result<Self, String> {
        let map: Self = toml::from_str(text).map_err(|error| error.to_string())?;
        Ok(Self { text: text.to_owned(), ..map })
    }

    /// Start and interval of even times, s, if it states them.
    pub(super) fn even(&self) -> Result<Option<[f64; 2]>, String> {
        self.time.as_ref().map(Even::in_si).transpose()
    }

    /// The headings that columns are looked for by.
    pub fn headings(&self) -> Vec<&str> {
        self.columns.values().filter_map(|mapped| mapped.column.heading()).collect()
    }

    /// The columns that it names in a table with these `titles`, those of the `known` curves, in the order of the file.
    pub(super) fn named(&self, titles: &Titles, known: &[Curve]) -> Result<Vec<Column>, String> {
        let columns = self.columns.iter().map(|(name, mapped)| mapped.in_table(name, titles, known));
        let mut columns = columns.collect::<Result<Vec<Column>, String>>()?;
        columns.sort_by_key(|column| column.index);
        Ok(columns)
    }

    /// The results stated, and their bands, in SI; `known` are those there are.
    ///
    /// # Errors
    /// One sentence with the quantity.
    pub fn stated(&self, known: &[Quantity]) -> Result<[BTreeMap<String, f64>; 2], String> {
        let of = |numbers: &BTreeMap<String, SiNumber>| -> Result<BTreeMap<String, f64>, String> {
            let number = |(name, number): (&String, &SiNumber)| {
                let quantity = known.iter().find(|quantity| quantity.name == name);
                let quantity =
                    quantity.ok_or_else(|| format!("`{name}` is no quantity of this kind of scene"))?;
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

impl Mapped {
    fn in_table(&self, name: &str, titles: &Titles, known: &[Curve]) -> Result<Column, String> {
        let (name, si) = known_column(name, known)?;
        let at = |reason: String| format!("columns.{name}: {reason}");
        let index = self.column.index(&titles.headings).map_err(at)?;
        let measures = self.quantity.unwrap_or_else(|| Measures::of(name));
        measures.require_for(name).map_err(at)?;
        let unit = self.unit.as_deref().or_else(|| titles.unit_of(index));
        let factor = match &self.sensitivity {
            None => unit.map_or(Ok(1.0), |unit| unit_in_si(unit, measures.unit(si))),
            Some(sensitivity) => sensitive(sensitivity, unit, measures.unit(si)),
        };
        if self.sign.abs() != 1.0 {
            return Err(format!("columns.{name}.sign is {}, but it must be 1 or -1", self.sign));
        }
        let number = |number: &Option<SiNumber>, what: &str, unit: &str| {
            number.as_ref().map_or(Ok(0.0), |number| number.in_si(&format!("columns.{name}.{what}"), unit))
        };
        let clock = self.time.as_ref().map(|place| place.index(&titles.headings)).transpose().map_err(at)?;
        Ok(Column {
            name,
            index,
            factor: self.sign * factor.map_err(at)?,
            offset: number(&self.offset, "offset", measures.unit(si))?,
            measures,
            delay: number(&self.delay, "delay", "s")?,
            clock,
        })
    }
}

/// Size in `si` of a column in `unit`, which a sensor with a `sensitivity` gives: so much a volt, or a strain of 1.
fn sensitive(sensitivity: &str, unit: Option<&str>, si: &str) -> Result<f64, String> {
    let of_volt = quantity_in(sensitivity, &format!("{si}/V"));
    match of_volt {
        Ok(size) => Ok(size * unit.map_or(Ok(1.0), |unit| unit_in_si(unit, "V"))?),
        Err(_) => {
            let size = quantity_in(sensitivity, si).map_err(|_| {
                format!(
                    "sensitivity is `{sensitivity}`, but it must be in {si}/V, or in {si} for a strain of 1"
                )
            })?;
            Ok(size * unit.map_or(Ok(1.0), |unit| unit_in_si(unit, "1"))?)
        }
    }
}

impl ColumnPlace {
    fn heading(&self) -> Option<&str> {
        match self {
            ColumnPlace::Heading(heading) => Some(heading),
            ColumnPlace::Number(_) => None,
        }
    }

    fn index(&self, headings: &[String]) -> Result<usize, String> {
        let absent =
            |what: String| format!("there is no column {what} (there are: {})", listed(headings, " | "));
        match self {
            ColumnPlace::Number(number @ 1..) if *number <= headings.len() => Ok(number - 1),
            ColumnPlace::Number(number) => Err(absent(number.to_string())),
            ColumnPlace::Heading(heading) => {
                let places = |is: &dyn Fn(&str) -> bool| -> Vec<usize> {
                    let found = headings.iter().enumerate().filter(|(_, other)| is(other));
                    found.map(|(place, _)| place).collect()
                };
                let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<String>>();
                let named = words(heading);
                let mut found = places(&|other| words(other) == named);
                // a channel of a group, or one with a code, may be called by its own name alone
                if found.is_empty() {
                    found = places(&|other| other.split('/').any(|part| words(part) == named));
                }
                match found[..] {
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

/// The text of a map that reads a file as it was read: with the form of its text, and its `columns` in SI units.
pub(super) fn written(form: &str, titles: &Titles, columns: &[Column]) -> String {
    let mut text = format!("{form}[columns]\n");
    for column in columns {
        let measured = match column.measures == Measures::of(column.name) {
            true => String::new(),
            false => format!(", quantity = {:?}", column.measures.name()),
        };
        // a sign and a size together are what unit and sign say
        let unit = titles.unit_of(column.index).map(|unit| format!(", unit = {unit:?}")).unwrap_or_default();
        let _ = writeln!(text, "{} = {{ column = {}{unit}{measured} }}", column.name, column.index + 1);
    }
    text
}

/// The table of a map that says how text of this `layout` is written.
pub(super) fn written_form(layout: &TextLayout, encoding: Option<&str>) -> String {
    let delimiter = match layout.delimiter {
        ' ' => "spaces".to_owned(),
        '\t' => "tab".to_owned(),
        other => other.to_string(),
    };
    let mut text =
        format!("[table]\ndelimiter = {delimiter:?}\ndecimal   = {:?}\n", layout.decimal.to_string());
    if let Some(encoding) = encoding {
        let _ = writeln!(text, "encoding  = {encoding:?}");
    }
    text + "\n"
}
