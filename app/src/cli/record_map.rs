//! How files of records are to be read, from the command line.

use super::Context;
use crate::columns::Map;
use crate::error::{Error, Result};
use crate::measured::{ReadRecord, Record};
use crate::reference::{record_bytes, record_source};
use clap::Args;
use std::path::{Path, PathBuf};

/// Between files with the channels of one impact.
const JOINED: char = '+';

#[derive(Debug, Clone, Default, Args)]
pub struct RecordMap {
    /// Description of the measured files (TOML): columns, units, sensors, times [default: inferred from each file]
    #[arg(long, value_name = "FILE", requires = "measured")]
    map: Option<PathBuf>,
    /// Write the map by which the first measured file was read, to check it and to change it
    #[arg(long, value_name = "FILE", requires = "measured")]
    save_map: Option<PathBuf>,
}

impl RecordMap {
    /// The map in `map`.
    pub fn of(map: Option<PathBuf>) -> Self {
        Self { map, save_map: None }
    }

    /// Reads the records in `files`; what was inferred is printed.
    ///
    /// # Errors
    /// Those of map and records; [`Error::Io`] if the map can't be written.
    pub fn records(&self, context: &Context, files: &[PathBuf]) -> Result<Vec<Record>> {
        let map = self.map.as_deref().map_or_else(|| Ok(Map::default()), read_map)?;
        let read = files.iter().map(|file| read_record(file, &map)).collect::<Result<Vec<ReadRecord>>>()?;
        for ReadRecord { record, how, .. } in &read {
            if let Some(how) = how {
                context.note(format_args!("{}: {how}", record.file.display()));
            }
        }
        if let (Some(path), Some(first)) = (&self.save_map, read.first()) {
            crate::file::write_file(path, first.map.as_bytes())?;
        }
        Ok(read.into_iter().map(|read| read.record).collect())
    }
}

/// The record in a file, or in several with the channels of one impact: `outer.csv+inner.csv`.
fn read_record(named: &Path, map: &Map) -> Result<ReadRecord> {
    let names = named.to_string_lossy();
    if named.exists() || !names.contains(JOINED) {
        return read_file(named, map);
    }
    let mut parts = names.split(JOINED).map(|name| read_file(Path::new(name), map));
    let first = parts.next().unwrap_or_else(|| read_file(named, map))?;
    parts.try_fold(first, |found, next| {
        Ok(ReadRecord { record: found.record.joined(&next?.record)?, ..found })
    })
}

fn read_file(file: &Path, map: &Map) -> Result<ReadRecord> {
    let bytes = record_bytes(file)?;
    Record::of(file, &record_source(file, &bytes, map)?, map)
}

fn read_map(path: &Path) -> Result<Map> {
    let text = std::fs::read_to_string(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => Error::Usage(format!("there is no map {}", path.display())),
        _ => Error::io("reading", path, e),
    })?;
    Map::parse(&text).map_err(|reason| Error::Usage(format!("{}: {reason}", path.display())))
}
