//! What a file of a record consists of; binary formats are read by libraries of Python.

use super::kinds::run_to_end;
use super::python;
use crate::columns::{ChannelClock, Map, RawChannel, RecordSource, is_binary, require_text};
use crate::interrupt::Scratch;
use crate::{Error, Result};
use serde::Deserialize;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// Bytes of a file's beginning that show whether it is text.
const HEAD: u64 = 4096;
/// Most bytes of a text: 20 million samples of five channels.
const MOST_BYTES: u64 = 2_000_000_000;

/// The content of the `file` of a record or a result, of a binary one the beginning alone, for [`record_source`].
///
/// # Errors
/// [`Error::Usage`] if there is none, [`Error::Scene`] if it is neither text nor of a format that is known, empty or too large,
/// [`Error::Io`] if it can't be read.
pub fn record_bytes(file: &Path) -> Result<Vec<u8>> {
    let refused = |reason: String| Error::Scene(miette::miette!("{}: {reason}", file.display()));
    let failed = |e: std::io::Error| match e.kind() {
        ErrorKind::NotFound => Error::Usage(format!("there is no measured file {}", file.display())),
        _ => Error::io("reading", file, e),
    };
    let about = std::fs::metadata(file).map_err(failed)?;
    if !about.is_file() {
        return Err(Error::Usage(format!("{} is no file; name a file with a record", file.display())));
    }
    if about.len() == 0 {
        return Err(refused("is empty".into()));
    }
    let mut bytes = Vec::new();
    let mut opened = File::open(file).map_err(failed)?;
    (&mut opened).take(HEAD).read_to_end(&mut bytes).map_err(failed)?;
    if is_binary(&bytes) {
        return Ok(bytes);
    }
    require_text(&bytes).map_err(refused)?;
    if about.len() > MOST_BYTES {
        return Err(refused(format!(
            "has {} bytes; at most {MOST_BYTES} are read of a text; export the stretch around the impact",
            about.len()
        )));
    }
    opened.take(MOST_BYTES).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

/// What the record or the result of another program in `file`, with the content `bytes`, consists of.
///
/// # Errors
/// [`Error::Scene`] if it can't be read, [`Error::Solver`] if the Python or the library for it is missing.
pub fn record_source<'b>(file: &Path, bytes: &'b [u8], map: &Map) -> Result<RecordSource<'b>> {
    match is_binary(bytes) {
        true => channels(file).map(RecordSource::Channels),
        false => RecordSource::of_text(file, bytes, map)
            .map_err(|reason| Error::Scene(miette::miette!("{}: {reason}", file.display()))),
    }
}

/// The first line of the file that `fem_reference` writes.
#[derive(Deserialize)]
struct Head {
    columns: Vec<HeadColumn>,
}

#[derive(Deserialize)]
struct HeadColumn {
    name: String,
    unit: Option<String>,
    rows: usize,
    start: Option<f64>,
    interval: Option<f64>,
    time: Option<usize>,
}

fn channels(file: &Path) -> Result<Vec<RawChannel>> {
    let python = python::reader()?;
    let mut command = python::fem_reference(&python)?;
    // it runs in the project's folder
    command.arg("columns").arg(std::path::absolute(file).map_err(|e| Error::io("finding", file, e))?);
    let folder = std::env::temp_dir();
    let folder =
        Scratch::new_in(&folder, "impactcheck-").map_err(|e| Error::io("writing into", &folder, e))?;
    let out = folder.path().join("columns");
    run_to_end(command.arg("--out").arg(&out), &python)?;
    let bytes = std::fs::read(&out).map_err(|e| Error::io("reading", &out, e))?;
    parsed(&bytes).ok_or_else(|| Error::Internal(format!("the channels of {}", file.display())))
}

/// The channels in a line of JSON with little-endian numbers below it; `None` if that is not what `bytes` are.
fn parsed(bytes: &[u8]) -> Option<Vec<RawChannel>> {
    let end = bytes.iter().position(|byte| *byte == b'\n')?;
    let head: Head = serde_json::from_slice(&bytes[..end]).ok()?;
    let (numbers, rest) = bytes[end + 1..].as_chunks::<8>();
    let rows: usize = head.columns.iter().map(|column| column.rows).sum();
    if !rest.is_empty() || numbers.len() != rows {
        return None;
    }
    let mut numbers = numbers.iter().map(|number| f64::from_le_bytes(*number));
    let channel = |column: HeadColumn| RawChannel {
        values: numbers.by_ref().take(column.rows).collect(),
        clock: match (column.start.zip(column.interval), column.time) {
            (Some((start, interval)), _) => ChannelClock::Even([start, interval]),
            (None, Some(place)) => ChannelClock::Channel(place),
            (None, None) => ChannelClock::Unknown,
        },
        name: column.name,
        unit: column.unit.unwrap_or_default(),
    };
    Some(head.columns.into_iter().map(channel).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fem_reference_writes_is_read() {
        let mut bytes = br#"{"format": "TDMS", "columns": [{"name": "a", "unit": null, "rows": 2, "start": 0.5, "interval": 0.1, "time": null}, {"name": "b", "unit": "V", "rows": 1, "start": null, "interval": null, "time": 0}]}"#.to_vec();
        bytes.push(b'\n');
        for number in [1.5_f64, f64::NAN, -2.0] {
            bytes.extend(number.to_le_bytes());
        }
        let channels = parsed(&bytes).expect("channels");
        assert_eq!(
            (channels[0].clock, channels[1].clock),
            (ChannelClock::Even([0.5, 0.1]), ChannelClock::Channel(0))
        );
        assert!(channels[0].values[0] == 1.5 && channels[0].values[1].is_nan());
        assert_eq!((channels[1].unit.as_str(), &channels[1].values[..]), ("V", &[-2.0][..]));
        // a truncated file is none
        assert!(parsed(&bytes[..bytes.len() - 3]).is_none());
        assert!(parsed(&bytes[..bytes.len() - 8]).is_none());
    }
}
