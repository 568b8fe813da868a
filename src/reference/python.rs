//! Finds the Python that has FEniCSx.

use crate::project::project_root;
use crate::{Error, Result};
use serde_json::Value;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Environment variable that names the interpreter to use.
const PYTHON_VARIABLE: &str = "IMPACTCHECK_PYTHON";

/// How the modules are installed on Debian.
pub(super) const INSTALL: &str =
    "`sudo apt-get update` and `sudo apt-get install python3-dolfinx python3-gmsh`";

/// Imports the modules and prints their versions; a module that is there but broken counts as missing.
const PROBE: &str = r#"
import importlib, json, platform
found = {"python": platform.python_version()}
for name in ("dolfinx", "gmsh", "cffi"):
    try:
        found[name] = str(getattr(importlib.import_module(name), "__version__", "unknown"))
    except Exception:
        found[name] = None
print("\n" + json.dumps(found))
"#;

/// An interpreter and the versions of what it can import; `None` = missing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Interpreter {
    pub(super) path: PathBuf,
    pub(super) modules: BTreeMap<String, Option<String>>,
}

impl Interpreter {
    fn probe(path: &Path) -> std::result::Result<Self, String> {
        let mut command = Command::new(path);
        command.args(["-c", PROBE]).stdin(Stdio::null());
        let output = command.output().map_err(|e| format!("it can't be run ({e})"))?;
        let text = String::from_utf8_lossy(&output.stdout);
        // Modules may print while they are imported; the answer is the last line.
        let answer = text.lines().last().and_then(|line| serde_json::from_str(line).ok());
        match answer {
            Some(modules) if output.status.success() => Ok(Interpreter { path: path.to_path_buf(), modules }),
            _ => Err(format!("it is no working Python ({})", output.status)),
        }
    }

    fn missing(&self) -> Vec<&str> {
        self.modules.iter().filter(|(_, version)| version.is_none()).map(|(name, _)| name.as_str()).collect()
    }
}

/// The Python that runs `fem_reference`: the one the environment variable `IMPACTCHECK_PYTHON`
/// names, else the first of `/usr/bin/python3` and every `python3` on `PATH` that can import
/// dolfinx, gmsh and cffi.
///
/// # Errors
/// [`Error::Solver`] if there is none; it says where was looked and what was missing.
pub fn python() -> Result<PathBuf> {
    find(asked(), &std::env::var_os("PATH").unwrap_or_default())
}

fn find(asked: Option<PathBuf>, path: &OsStr) -> Result<PathBuf> {
    let mut looked = Vec::new();
    for path in candidates(asked.clone(), path) {
        match Interpreter::probe(&path) {
            Ok(interpreter) if interpreter.missing().is_empty() => return Ok(interpreter.path),
            Ok(interpreter) => {
                looked.push(format!("{} has no {}", path.display(), interpreter.missing().join(", ")))
            }
            Err(reason) => looked.push(format!("{}: {reason}", path.display())),
        }
    }
    Err(Error::Solver(match asked {
        Some(_) => format!(
            "the Python named by {PYTHON_VARIABLE} can't run the reference: {}; name one that imports dolfinx, gmsh and cffi, or install them on Debian with {INSTALL}",
            looked.join("; ")
        ),
        None => format!(
            "the reference needs a Python that imports dolfinx, gmsh and cffi; looked at: {}; install them on Debian with {INSTALL}, or name an interpreter in {PYTHON_VARIABLE}",
            if looked.is_empty() {
                "/usr/bin/python3 and PATH, no python3 there".to_owned()
            } else {
                looked.join("; ")
            }
        ),
    }))
}

/// The best interpreter there is, complete or not; `None` if no candidate runs.
pub(super) fn best() -> Option<Interpreter> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found: Vec<Interpreter> =
        candidates(asked(), &path).iter().filter_map(|path| Interpreter::probe(path).ok()).collect();
    let fewest = found.iter().map(|i| i.missing().len()).min()?;
    found.into_iter().find(|i| i.missing().len() == fewest)
}

fn asked() -> Option<PathBuf> {
    std::env::var_os(PYTHON_VARIABLE).filter(|v| !v.is_empty()).map(PathBuf::from)
}

fn candidates(asked: Option<PathBuf>, path: &OsStr) -> Vec<PathBuf> {
    if let Some(path) = asked {
        return vec![path];
    }
    let on_path = std::env::split_paths(path).map(|folder| folder.join("python3"));
    let mut found: Vec<PathBuf> = Vec::new();
    let mut seen: Vec<PathBuf> = Vec::new();
    for candidate in std::iter::once(PathBuf::from("/usr/bin/python3")).chain(on_path) {
        // /bin is often a link to /usr/bin: the same program is asked once. The file name stays,
        // because a virtual environment is told by the path it is started from.
        let Some(folder) = candidate.parent().and_then(|f| f.canonicalize().ok()) else { continue };
        if candidate.is_file() && !seen.contains(&folder) {
            seen.push(folder);
            found.push(candidate);
        }
    }
    found
}

/// A command that runs `fem_reference` of this project with `python`.
pub(super) fn fem_reference(python: &Path) -> Command {
    let root = project_root();
    let mut paths = vec![root.clone()];
    paths.extend(std::env::split_paths(&std::env::var_os("PYTHONPATH").unwrap_or_default()));
    let mut command = Command::new(python);
    command.args(["-m", "fem_reference"]).current_dir(&root).stdin(Stdio::null());
    // A folder with a colon in its name can't stand in a search path; -m finds the package anyway.
    if let Ok(joined) = std::env::join_paths(paths) {
        command.env("PYTHONPATH", joined);
    }
    command
}

/// Versions of everything a reference depends on, as `fem_reference versions` reports them;
/// null = missing.
///
/// # Errors
/// [`Error::Solver`] if it can't be run or does not answer in JSON.
pub fn versions(python: &Path) -> Result<Value> {
    let failed =
        |what: String| Error::Solver(format!("`{} -m fem_reference versions` {what}", python.display()));
    let mut command = fem_reference(python);
    let output = command.arg("versions").output().map_err(|e| failed(format!("can't be run: {e}")))?;
    if !output.status.success() {
        let log = String::from_utf8_lossy(&output.stderr);
        let last = log.lines().last().unwrap_or("it says nothing").to_owned();
        return Err(failed(format!("failed ({}): {last}", output.status)));
    }
    serde_json::from_slice(&output.stdout).map_err(|e| failed(format!("does not answer in JSON: {e}")))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    /// A program that answers the probe with `answer` and ends with `status`.
    fn fake(folder: &Path, name: &str, answer: &str, status: u8) -> PathBuf {
        let path = folder.join(name);
        std::fs::write(&path, format!("#!/bin/sh\necho '{answer}'\nexit {status}\n")).expect("script");
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).expect("executable");
        path
    }

    const COMPLETE: &str = r#"{"python": "3.11.2", "dolfinx": "0.5.2", "gmsh": "4.8.4", "cffi": "1.15.1"}"#;
    const BARE: &str = r#"{"python": "3.11.2", "dolfinx": null, "gmsh": null, "cffi": "1.15.1"}"#;

    #[test]
    fn an_interpreter_without_dolfinx_is_named_with_what_installs_it() {
        let folder = tempfile::tempdir().expect("folder");
        let bare = fake(folder.path(), "bare", BARE, 0);
        let error = find(Some(bare.clone()), OsStr::new("")).expect_err("incomplete");
        assert_eq!(error.exit_status(), crate::ExitStatus::Solver);
        let said = error.to_string();
        let bare = bare.to_string_lossy();
        for word in [&*bare, "has no dolfinx, gmsh", PYTHON_VARIABLE, INSTALL] {
            assert!(said.contains(word), "`{word}` is not in: {said}");
        }
    }

    #[test]
    fn a_named_interpreter_that_does_not_run_is_not_replaced_by_another() {
        let folder = tempfile::tempdir().expect("folder");
        let broken = fake(folder.path(), "broken", "Segmentation fault", 139);
        for (path, word) in [(folder.path().join("none"), "can't be run"), (broken, "no working Python")] {
            let said = find(Some(path), OsStr::new("/usr/bin")).expect_err("unusable").to_string();
            assert!(said.contains(word), "{said}");
        }
    }

    #[test]
    fn every_python3_on_the_path_is_asked_in_turn() {
        let (first, second) = (tempfile::tempdir().expect("folder"), tempfile::tempdir().expect("folder"));
        fake(first.path(), "python3", BARE, 0);
        let complete = fake(second.path(), "python3", COMPLETE, 0);
        let path = std::env::join_paths([first.path(), second.path(), first.path()]).expect("path");
        let asked = candidates(None, &path);
        let on_path: Vec<&PathBuf> = asked.iter().filter(|p| !p.starts_with("/usr/bin")).collect();
        assert_eq!(on_path, [&first.path().join("python3"), &complete]);
        assert_eq!(find(Some(complete.clone()), &path).expect("complete"), complete);
    }
}
