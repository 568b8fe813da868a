//! Runs what is left of a sweep, or of a shard of it, in parallel.

use super::plan::Plan;
use super::record::{Record, header};
use crate::error::{Error, Result};
use rayon::prelude::*;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Points whose records are written at once, of what takes long each by itself, and after which time they are in any case.
const BATCH: usize = 64;
const PATIENCE: Duration = Duration::from_millis(300);
/// Ending of a log's name.
const LOG: &str = "records";

/// Part `number` of `of` of a sweep: the points whose index leaves `number - 1` when divided by `of`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// From 1.
    pub number: usize,
    /// How many there are.
    pub of: usize,
}

impl Shard {
    /// The whole sweep.
    pub const WHOLE: Shard = Shard { number: 1, of: 1 };

    /// Whether point `index` belongs to it.
    pub fn contains(&self, index: usize) -> bool {
        index % self.of == self.number - 1
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let parts = text.split_once('/').and_then(|(n, of)| Some((n.parse().ok()?, of.parse().ok()?)));
        match parts {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
            _ => Err(format!("`{text}` is no shard; write for example 3/16, from 1/16 to 16/16")),
        }
    }
}

/// What a run tells while it goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress {
    /// At the start: points of the shard, and how many of them have a record already.
    Start {
        /// Points of the shard.
        points: usize,
        /// Of which done by earlier runs.
        done: usize,
    },
    /// So many more points are recorded.
    Recorded(usize),
}

/// Runs the points of `shard` that have no record in `dir` yet; `on_progress` hears of the progress.
///
/// # Errors
/// [`Error::Usage`] if `dir` belongs to another sweep or the shard is running already, [`Error::Io`] if a record can't
/// be written.
pub fn run(plan: &Plan, dir: &Path, shard: Shard, on_progress: &(dyn Fn(Progress) + Sync)) -> Result<()> {
    fs::create_dir_all(dir).map_err(|e| Error::io("creating", dir, e))?;
    let done = read_all(plan, dir)?;
    let points = (0..plan.len()).filter(|index| shard.contains(*index));
    let (finished, pending): (Vec<usize>, Vec<usize>) = points.partition(|index| done[*index].is_some());
    on_progress(Progress::Start { points: finished.len() + pending.len(), done: finished.len() });
    let log = Log::open(plan, dir, shard)?;
    pending.par_chunks(if plan.is_expensive() { 1 } else { BATCH }).try_for_each(|chunk| {
        let (mut text, mut count, mut since) = (String::new(), 0, Instant::now());
        for (k, index) in chunk.iter().enumerate() {
            plan.evaluate(*index).append_to(&mut text);
            count += 1;
            if k + 1 == chunk.len() || since.elapsed() > PATIENCE {
                log.append(&text)?;
                on_progress(Progress::Recorded(count));
                text.clear();
                (count, since) = (0, Instant::now());
            }
        }
        Ok(())
    })?;
    log.close()
}

/// Runs points number `from` and later, and keeps their records in memory alone.
pub fn in_memory(plan: &Plan, from: usize, on_progress: &(dyn Fn(Progress) + Sync)) -> Vec<Record> {
    on_progress(Progress::Start { points: plan.len(), done: from });
    let run = |index| {
        let record = plan.evaluate(index);
        on_progress(Progress::Recorded(1));
        record
    };
    (from..plan.len()).into_par_iter().map(run).collect()
}

/// The records in all logs of `dir`, by index; the first of each point. Shape (points).
///
/// # Errors
/// [`Error::Usage`] if a log belongs to another sweep, [`Error::Io`] if one can't be read.
pub(super) fn read_all(plan: &Plan, dir: &Path) -> Result<Vec<Option<Record>>> {
    let mut records = vec![None; plan.len()];
    let entries = fs::read_dir(dir).map_err(|e| Error::io("reading", dir, e))?;
    let mut logs: Vec<PathBuf> = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| Error::io("reading", dir, e))?.path();
        if path.extension().is_some_and(|extension| extension == LOG) {
            logs.push(path);
        }
    }
    logs.sort();
    for path in logs {
        read(plan, &path, &mut records)?;
    }
    Ok(records)
}

fn read(plan: &Plan, path: &Path, records: &mut [Option<Record>]) -> Result<()> {
    let failed = |e| Error::io("reading", path, e);
    let file = File::open(path).map_err(failed)?;
    for (number, line) in BufReader::new(file).split(b'\n').enumerate() {
        let line = line.map_err(failed)?;
        if number == 0 {
            // a log that was killed before its first line was complete has no record
            if line != header(plan.hash()).as_bytes() && line.len() >= header(plan.hash()).len() {
                return Err(Error::Usage(format!(
                    "{} belongs to another sweep (the sweep file, its scene or the program has changed); choose another --out or remove that folder",
                    path.display()
                )));
            }
        } else if let Some(record) = Record::parse(&line, plan.results().len())
            && let Some(place) = records.get_mut(record.index)
        {
            place.get_or_insert(record);
        }
    }
    Ok(())
}

/// The log of one shard, locked while it is open.
struct Log {
    path: PathBuf,
    file: Mutex<File>,
}

impl Log {
    fn open(plan: &Plan, dir: &Path, shard: Shard) -> Result<Self> {
        let path = dir.join(format!("{}-of-{}.{LOG}", shard.number, shard.of));
        let failed = |e| Error::io("writing", &path, e);
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(&path).map_err(failed)?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(Error::Usage(format!(
                "shard {shard} is being run by another process ({})",
                path.display()
            )));
        }
        let length = file.seek(SeekFrom::End(0)).map_err(failed)?;
        let expected = header(plan.hash()) + "\n";
        if length < expected.len() as u64 {
            file.set_len(0).map_err(failed)?;
            file.write_all(expected.as_bytes()).map_err(failed)?;
        } else {
            let mut last = [0];
            file.seek(SeekFrom::End(-1)).map_err(failed)?;
            file.read_exact(&mut last).map_err(failed)?;
            if last[0] != b'\n' {
                // the torn line of a process that was killed ends here
                file.write_all(b"\n").map_err(failed)?;
            }
        }
        Ok(Log { path, file: Mutex::new(file) })
    }

    fn append(&self, text: &str) -> Result<()> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(text.as_bytes()).map_err(|e| Error::io("writing", &self.path, e))
    }

    fn close(self) -> Result<()> {
        let file = self.file.into_inner().unwrap_or_else(PoisonError::into_inner);
        file.sync_data().map_err(|e| Error::io("writing", &self.path, e))
    }
}
