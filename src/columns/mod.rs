//! Curves from files that others write: records of instruments, results of other programs. One reader for all, which infers what a map does not
//! say: encoding, delimiter, decimal sign, lines before the numbers, headings and units.

mod column;
mod layout;
mod map;
mod rows;
mod text;

pub use column::{Column, Measures, known_column, unit_in_si};
pub use layout::TextLayout;
pub use map::{Map, Provenance};
pub use rows::{Columns, number};
pub use text::decoded;

use crate::result::Curve;
use rows::Clock;

/// What a file says.
#[derive(Debug, Clone)]
pub struct ReadTable {
    /// Its curves.
    pub columns: Columns,
    /// A map that says how it was read, to keep and to change.
    pub map: String,
    /// What was inferred, in words; `None` of comma-separated values with one line of headings, all of which were read.
    pub how: Option<String>,
}

/// Reads the curves of the table in `text`, which `map` describes as far as it says anything; `known` are the curves there are, and it needs
/// `fewest` samples at least.
///
/// # Errors
/// One sentence: the line, the column or the part of the map at fault.
pub fn read(text: &str, map: &Map, known: &[Curve], fewest: usize) -> Result<ReadTable, String> {
    let even = map.time.as_ref().map(map::Even::in_si).transpose()?;
    let layout = TextLayout::of(text, &map.table, even.is_some(), column::is_unit)?;
    let all =
        if map.columns.is_empty() { column::by_heading(&layout, known)? } else { map.named(&layout, known)? };
    let times = all.iter().find(|column| column.name == "time");
    let clock = match (even, times) {
        (Some(even), _) => Clock::Even(even),
        (None, Some(times)) => Clock::Column(times),
        (None, None) => {
            return Err(format!(
                "there is no column `time` (there are: {}); name it in a map, or start and interval under [time]",
                layout.headings.join(" | ")
            ));
        }
    };
    let signals: Vec<&Column> = all.iter().filter(|column| column.name != "time").collect();
    if signals.is_empty() {
        return Err(unknown_columns(&layout, known));
    }
    let columns = rows::read(text, &layout, clock, &signals, fewest)?;
    let is_read = |k: usize| all.iter().any(|column| column.index == k || column.clock == Some(k));
    let left_out = layout.headings.iter().enumerate().filter(|(k, _)| !is_read(*k));
    let left_out: Vec<&str> = left_out.map(|(_, heading)| heading.as_str()).collect();
    let how = in_words(&layout, &left_out);
    // what a user has stated of the columns stays as it is
    let map = match map.columns.is_empty() {
        true => map::written(&layout, map.table.encoding.as_deref(), &all),
        false => map.text.clone(),
    };
    Ok(ReadTable { columns, map, how })
}

/// How a file of this `layout` was read, if that is not plain.
fn in_words(layout: &TextLayout, left_out: &[&str]) -> Option<String> {
    let delimiter = match layout.delimiter {
        ' ' => "spaces".to_owned(),
        '\t' => "tabs".to_owned(),
        other => format!("`{other}`"),
    };
    let mut parts = Vec::new();
    if (layout.delimiter, layout.decimal) != (',', '.') {
        parts.push(format!("columns separated by {delimiter}, decimal sign `{}`", layout.decimal));
    }
    if layout.units.iter().any(|unit| !unit.is_empty()) {
        parts.push("units from the line below the headings".to_owned());
    }
    if !left_out.is_empty() {
        parts.push(format!("not used: {}", left_out.join(", ")));
    }
    (!parts.is_empty()).then(|| format!("{}; --save-map FILE writes how it was read", parts.join("; ")))
}

/// That no column is called as a curve, with a map to fill in.
fn unknown_columns(layout: &TextLayout, known: &[Curve]) -> String {
    let names = column::names(known);
    format!(
        "there is no signal except the time: no column is called as a curve (there are: {}); name them in a map, such as\n\n[columns]\ntime = {{ \
         column = 1, unit = \"s\" }}\n{} = {{ column = 2, unit = \"V\", sensitivity = \"0.5 m/s/V\" }}\n\nwith the curves {}",
        layout.headings.join(" | "),
        names.get(1).unwrap_or(&"outer_velocity"),
        names[1..].join(", ")
    )
}
