//! The commit that results belong to.

use crate::error::{Error, Result};
use std::path::Path;
use std::process::Command;

/// A commit of git.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Commit {
    /// Its hash; with [`DIRTY`] behind it if files differ from it.
    pub hash: String,
    /// When it was made, as git says: ISO 8601 with the committer's time zone.
    pub date: String,
}

/// What follows the hash if files under version control differ from the commit.
pub const DIRTY: &str = "-dirty";

/// The commit checked out in `folder`. Changes of the files in `apart` don't make it dirty: they are what a run writes.
///
/// # Errors
/// [`Error::Usage`] if git is missing or the folder is in no repository with a commit.
pub fn current(folder: &Path, apart: &[&Path]) -> Result<Commit> {
    let log = git(folder, &["log", "-1", "--format=%H%n%cI"])?;
    let (hash, date) = log.trim().split_once('\n').ok_or_else(|| unknown(folder, "no commit"))?;
    let changed = git(folder, &["status", "--porcelain", "--untracked-files=no", "--no-renames"])?;
    let root = git(folder, &["rev-parse", "--show-toplevel"])?;
    let root = Path::new(root.trim());
    let apart: Vec<_> = apart.iter().filter_map(|file| std::path::absolute(file).ok()).collect();
    let counts = |line: &str| {
        let file = root.join(line.get(3..).unwrap_or_default().trim_matches('"'));
        !apart.iter().any(|own| file.starts_with(own))
    };
    let dirty = if changed.lines().any(counts) { DIRTY } else { "" };
    Ok(Commit { hash: format!("{hash}{dirty}"), date: date.to_owned() })
}

fn git(folder: &Path, arguments: &[&str]) -> Result<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let output = Command::new("git").arg("-C").arg(folder).args(arguments).output();
    let output = output.map_err(|e| unknown(folder, &format!("git can't be started: {e}")))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    Err(unknown(folder, said.lines().next().unwrap_or("git failed")))
}

fn unknown(folder: &Path, why: &str) -> Error {
    Error::Usage(format!(
        "the commit in {} is not known ({why}); results are recorded by commit: run this in a git repository",
        folder.display()
    ))
}
