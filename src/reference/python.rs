//! Finds the Python that has FEniCSx.

use crate::project::project_root;
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// Environment variable that names the interpreter to use.
const PYTHON_VARIABLE: &str = "IMPACTCHECK_PYTHON";

/// How the modules are installed on Debian.
pub(super) const INSTALL: &str = "`sudo apt-get update` and `sudo apt-get install python3-dolfinx python3-slepc4py python3-gmsh python3-meshio python3-scipy`";

/// An interpreter and the versions of what it can import; `None` = missing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Interpreter {
    pub(super) path: PathBuf,
    pub(super) modules: BTreeMap<String, Option<String>>,
}

impl Interpreter {
    /// Lets the interpreter import all that a reference needs; a module that is there but broken counts as missing.
    fn probe(path: &Path) -> std::result::Result<Self, String> {
        let mut command = fem_reference(path).map_err(|e| e.to_string())?;
        let output = command.arg("versions").output().map_err(|e| format!("it can't be run ({e})"))?;
        let text = String::from_utf8_lossy(&output.stdout);
        // Modules may print while they are imported; the answer comes last.
        let answer = text.rfind('{').and_then(|at| serde_json::from_str(&text[at..]).ok());
        let Some(mut modules) = answer.filter(|_| output.status.success()) else {
            let log = String::from_utf8_lossy(&output.stderr);
            let last = log.lines().last().map(|line| format!(": {line}")).unwrap_or_default();
            return Err(format!("it is no working Python ({}{last})", output.status));
        };
        BTreeMap::remove(&mut modules, "compiler");
        Ok(Interpreter { path: path.to_path_buf(), modules })
    }

    fn missing(&self) -> Vec<&str> {
        self.modules.iter().filter(|(_, version)| version.is_none()).map(|(name, _)| name.as_str()).collect()
    }
}

/// The interpreter that this library has been loaded into.
static OWN: OnceLock<PathBuf> = OnceLock::new();

/// From now on `interpreter` is looked at before others that nobody has named. For Python packages, called once.
pub fn prefer_python(interpreter: PathBuf) {
    OWN.get_or_init(|| interpreter);
}

/// The Python that runs `fem_reference`: the one the environment variable `IMPACTCHECK_PYTHON`
/// names, else the first of the one that [`prefer_python`] was told, `/usr/bin/python3` and every `python3` on `PATH` that can import it with all that it needs.
///
/// # Errors
/// [`Error::Solver`] if there is none; it says where was looked and what was missing. As [`project_root`].
pub fn python() -> Result<PathBuf> {
    project_root()?;
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
            "the Python named by {PYTHON_VARIABLE} can't run the reference: {}; name one that imports dolfinx, gmsh and meshio, or install them on Debian with {INSTALL}",
            looked.join("; ")
        ),
        None => format!(
            "the reference needs a Python that imports dolfinx, gmsh and meshio; looked at: {}; install them on Debian with {INSTALL}, or name an interpreter in {PYTHON_VARIABLE}",
            if looked.is_empty() {
                "/usr/bin/python3 and PATH, no python3 there".to_owned()
            } else {
                looked.join("; ")
            }
        ),
    }))
}

/// The best interpreter there is, complete or not.
///
/// # Errors
/// Why none of the candidates runs.
pub(super) fn best() -> std::result::Result<Interpreter, String> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut reasons = Vec::new();
    let mut found: Vec<Interpreter> = Vec::new();
    for path in candidates(asked(), &path) {
        match Interpreter::probe(&path) {
            Ok(interpreter) => found.push(interpreter),
            Err(reason) => reasons.push(format!("{}: {reason}", path.display())),
        }
    }
    found.into_iter().min_by_key(|i| i.missing().len()).ok_or_else(|| reasons.join("; "))
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
    let first = OWN.get().cloned().into_iter().chain([PathBuf::from("/usr/bin/python3")]);
    for candidate in first.chain(on_path) {
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
///
/// # Errors
/// As [`project_root`].
pub(super) fn fem_reference(python: &Path) -> Result<Command> {
    let root = project_root()?;
    let mut paths = vec![root.clone()];
    paths.extend(std::env::split_paths(&std::env::var_os("PYTHONPATH").unwrap_or_default()));
    let mut command = Command::new(python);
    command.args(["-m", "fem_reference"]).current_dir(&root).stdin(Stdio::null());
    // A folder with a colon in its name can't stand in a search path; -m finds the package anyway.
    if let Ok(joined) = std::env::join_paths(paths) {
        command.env("PYTHONPATH", joined);
    }
    Ok(command)
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

    const COMPLETE: &str =
        r#"{"python": "3.11.2", "dolfinx": "0.5.2", "gmsh": "4.8.4", "meshio": "5.3.4", "compiler": null}"#;
    const BARE: &str = r#"{"python": "3.11.2", "dolfinx": null, "gmsh": "4.8.4", "meshio": null}"#;

    #[test]
    fn an_interpreter_without_dolfinx_is_named_with_what_installs_it() {
        let folder = tempfile::tempdir().expect("folder");
        let bare = fake(folder.path(), "bare", BARE, 0);
        let error = find(Some(bare.clone()), OsStr::new("")).expect_err("incomplete");
        assert_eq!(error.exit_status(), crate::ExitStatus::Solver);
        let said = error.to_string();
        let bare = bare.to_string_lossy();
        for word in [&*bare, "has no dolfinx, meshio", PYTHON_VARIABLE, INSTALL] {
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
