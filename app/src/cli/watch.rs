//! Does a job again whenever one of its files changes, until Ctrl-C.

use super::describe;
use crate::error::{Error, ExitStatus, Result};
use crate::interrupt;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

/// How often the files are looked at.
const INTERVAL: Duration = Duration::from_millis(100);
/// Takes what stands on a terminal away; no terminal, no codes.
const CLEAR: &str = "\x1b[H\x1b[2J";

/// Does `job` now and after every change of `files`, errors told and nothing more. An interruption ends the program with
/// the status of the last time.
///
/// # Errors
/// [`Error::Usage`] of the first time: no change of a file mends that.
pub(super) fn watch(files: &[PathBuf], job: impl Fn() -> Result<ExitStatus>) -> Result<ExitStatus> {
    let mut first = true;
    loop {
        let seen = stamps(files);
        super::print(CLEAR)?;
        let status = match job() {
            Err(error @ Error::Usage(_)) if first => return Err(error),
            Err(error) => {
                super::notify(describe(&error));
                error.exit_status()
            }
            Ok(status) => status,
        };
        interrupt::ends_with(status as u8);
        first = false;
        let now = chrono::Utc::now().format("%H:%M:%S UTC");
        super::print(&format!("{now}: watching {}; Ctrl-C ends", names(files)))?;
        wait_for_change(files, seen);
    }
}

/// Until the files are others than `seen` and have stayed the same for an interval: who writes one is done.
fn wait_for_change(files: &[PathBuf], seen: Vec<Stamp>) {
    let mut last = seen.clone();
    loop {
        sleep(INTERVAL);
        let now = stamps(files);
        if now == last && now != seen {
            return;
        }
        last = now;
    }
}

/// Time of the last change and length of a file; `None` = there is no such file.
type Stamp = Option<(SystemTime, u64)>;

fn stamps(files: &[PathBuf]) -> Vec<Stamp> {
    let stamp = |file: &PathBuf| std::fs::metadata(file).and_then(|m| Ok((m.modified()?, m.len()))).ok();
    files.iter().map(stamp).collect()
}

fn names(files: &[PathBuf]) -> String {
    let name = |file: &Path| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    match files {
        [file] => name(file),
        files => format!("{} files", files.len()),
    }
}
