//! Curves from files that others write: records of instruments, results of other programs. One reader for all, which infers what a map does not
//! say: encoding, delimiter, decimal sign, lines before the numbers, headings and units.

mod blocks;
mod calculix;
mod channels;
mod column;
mod header_clock;
mod iso_mme;
mod layout;
mod ls_dyna;
mod map;
mod rows;
mod series;
mod text;

pub use channels::{ChannelClock, RawChannel, is_binary};
pub use column::{Column, Measures, Titles, known_column, unit_in_si};
pub use layout::TextLayout;
pub use map::{Map, Provenance};
pub use rows::number;
pub use series::Columns;
pub use text::{decoded, require_text};

use crate::format::quantity;
use crate::result::Curve;
use iso_mme::MmeFile;
use ls_dyna::DynaFile;
use rows::Clock;
use std::borrow::Cow;
use std::path::Path;

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

/// What a file consists of.
#[derive(Debug, Clone)]
pub enum RecordSource<'b> {
    /// A table of text.
    Text(Cow<'b, str>),
    /// Channels of another format.
    Channels(Vec<RawChannel>),
}

impl<'b> RecordSource<'b> {
    /// What the text in `bytes` of `file` is, in the encoding that `map` names: a table, or a format of channels that is known by its head.
    ///
    /// # Errors
    /// One sentence, without the name of the file.
    pub fn of_text(file: &Path, bytes: &'b [u8], map: &Map) -> Result<Self, String> {
        let encoding = map.table.encoding.as_deref();
        let text = decoded(bytes, encoding)?;
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("dat") if calculix::is_dat(&text) => return Ok(Self::Text(calculix::dat(&text)?.into())),
            Some("frd") => return Ok(Self::Text(calculix::frd(&text, &map.headings())?.into())),
            _ => {}
        }
        if let Some(format) = DynaFile::of(&text) {
            let channels = format.channels(&text);
            return channels.map(Self::Channels).map_err(|reason| format!("as {}: {reason}", format.name()));
        }
        if let Some(format) = MmeFile::of(&text) {
            let channels = format.channels(file, &text, encoding);
            return channels.map(Self::Channels).map_err(|reason| format!("as ISO-MME: {reason}"));
        }
        Ok(Self::Text(text))
    }

    /// Reads the curves, which `map` describes as far as it says anything; `known` are the curves there are, and it needs `fewest` samples at
    /// least.
    ///
    /// # Errors
    /// One sentence: the line, the column, the channel or the part of the map at fault.
    pub fn read(&self, map: &Map, known: &[Curve], fewest: usize) -> Result<ReadTable, String> {
        match self {
            RecordSource::Text(text) => read(text, map, known, fewest),
            RecordSource::Channels(channels) => read_channels(channels, map, known, fewest),
        }
    }
}

/// Reads the curves of the table in `text`; see [`RecordSource::read`].
///
/// # Errors
/// As there.
pub fn read(text: &str, map: &Map, known: &[Curve], fewest: usize) -> Result<ReadTable, String> {
    let stated = header_clock::stated(text);
    let known_times = map.even()?.or(stated);
    let layout = TextLayout::of(text, &map.table, known_times.is_some(), column::is_unit)?;
    let all = chosen(&layout.titles, map, known)?;
    let times = all.iter().find(|column| column.name == "time");
    // a column that the map calls the time counts more than the header
    let even = if times.is_some() { map.even()? } else { known_times };
    let clock = match (even, times) {
        (Some(even), _) => Clock::Even(even),
        (None, Some(times)) => Clock::Column(times),
        (None, None) => return Err(no_time(&layout.titles)),
    };
    let columns = rows::read(text, &layout, clock, &signals(&layout.titles, &all, known)?, fewest)?;
    let mut how = form_in_words(&layout);
    let of_header = stated.filter(|stated| even == Some(*stated) && map.time.is_none());
    how.extend(of_header.map(|[start, interval]| {
        format!(
            "start {} and interval {} from the header",
            quantity(start, "s", 4),
            quantity(interval, "s", 4)
        )
    }));
    how.extend(left_out(&layout.titles, &all, &[]));
    let form = map::written_form(&layout, map.table.encoding.as_deref());
    Ok(ReadTable { columns, map: map_of(map, &form, &layout.titles, &all), how: in_words(&how) })
}

/// Reads the curves of `channels`; see [`RecordSource::read`].
fn read_channels(
    channels: &[RawChannel],
    map: &Map,
    known: &[Curve],
    fewest: usize,
) -> Result<ReadTable, String> {
    let titles = channels::titles(channels);
    let all = chosen(&titles, map, known)?;
    let wanted = signals(&titles, &all, known)?;
    let times = all.iter().find(|column| column.name == "time");
    let columns = channels::read(channels, map.even()?, times, &wanted, fewest)?;
    let clocks: Vec<usize> = all.iter().filter_map(|column| channels[column.index].times()).collect();
    let how: Vec<String> = left_out(&titles, &all, &clocks).into_iter().collect();
    Ok(ReadTable { columns, map: map_of(map, "", &titles, &all), how: in_words(&how) })
}

/// The columns that `map` names, or the headings.
fn chosen(titles: &Titles, map: &Map, known: &[Curve]) -> Result<Vec<Column>, String> {
    if map.columns.is_empty() { column::by_heading(titles, known) } else { map.named(titles, known) }
}

/// Those of the columns `all` that are no times.
fn signals<'c>(titles: &Titles, all: &'c [Column], known: &[Curve]) -> Result<Vec<&'c Column>, String> {
    let signals: Vec<&Column> = all.iter().filter(|column| column.name != "time").collect();
    if signals.is_empty() { Err(unknown_columns(titles, known)) } else { Ok(signals) }
}

/// That nothing says when the samples were taken.
fn no_time(titles: &Titles) -> String {
    format!(
        "there is no column `time` (there are: {}); name it in a map, or start and interval under [time]",
        titles.listed()
    )
}

/// The user's map if it names columns, else one of what was inferred.
fn map_of(map: &Map, form: &str, titles: &Titles, all: &[Column]) -> String {
    // what a user has stated of the columns stays as it is
    if map.columns.is_empty() { map::written(form, titles, all) } else { map.text.clone() }
}

/// The columns that were not read; those with the places `clocks` have the times of others.
fn left_out(titles: &Titles, all: &[Column], clocks: &[usize]) -> Option<String> {
    let is_read = |k: usize| {
        clocks.contains(&k) || all.iter().any(|column| column.index == k || column.clock == Some(k))
    };
    let others = titles.headings.iter().enumerate().filter(|(k, _)| !is_read(*k));
    let others: Vec<&str> = others.map(|(_, heading)| heading.as_str()).collect();
    (!others.is_empty()).then(|| format!("not used: {}", column::listed(&others, ", ")))
}

/// What is not plain of a text of this `layout`.
fn form_in_words(layout: &TextLayout) -> Vec<String> {
    let delimiter = match layout.delimiter {
        ' ' => "spaces".to_owned(),
        '\t' => "tabs".to_owned(),
        other => format!("`{other}`"),
    };
    let mut parts = Vec::new();
    if (layout.delimiter, layout.decimal) != (',', '.') {
        parts.push(format!("columns separated by {delimiter}, decimal sign `{}`", layout.decimal));
    }
    if layout.titles.units.iter().any(|unit| !unit.is_empty()) {
        parts.push("units from the line below the headings".to_owned());
    }
    parts
}

fn in_words(parts: &[String]) -> Option<String> {
    (!parts.is_empty()).then(|| format!("{}; --save-map FILE writes how it was read", parts.join("; ")))
}

/// That no column is called as a curve, with a map to fill in.
fn unknown_columns(titles: &Titles, known: &[Curve]) -> String {
    let names = column::names(known);
    format!(
        "there is no signal except the time: no column is called as a curve (there are: {}); name them in a map, such as\n\n[columns]\ntime = {{ \
         column = 1, unit = \"s\" }}\n{} = {{ column = 2, unit = \"V\", sensitivity = \"0.5 m/s/V\" }}\n\nwith the curves {}",
        titles.listed(),
        names.get(1).unwrap_or(&"outer_velocity"),
        names[1..].join(", ")
    )
}
