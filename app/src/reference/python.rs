//! Finds the Python that has FEniCSx, or what meshes of bodies need.

use crate::project::project_root;
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// Environment variable that names the interpreter to use.
const PYTHON_VARIABLE: &str = "IMPACTCHECK_PYTHON";

/// How FEniCSx is installed.
const INSTALL: &str = if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
    "install them with `pip install \"impactcheck[reference]\"` (Python 3.12 or later; `make setup` in a checkout), or on Debian with `sudo apt-get update` and `sudo apt-get install python3-dolfinx python3-slepc4py python3-gmsh python3-meshio python3-scipy`"
} else {
    "there are wheels of FEniCSx for Linux on x86-64 only: use the container (`docker build --platform linux/amd64 .`) or conda-forge's fenics-dolfinx"
};

/// What a Python is to be used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// Finite-element references.
    References,
    /// Meshes of bodies from files alone, which need no FEniCSx.
    Meshes,
    /// Records in binary formats.
    Records,
    /// Functional Mock-up Units.
    Units,
}

impl Purpose {
    /// The modules that it needs alone; those of FEniCSx take seconds to import. `None` = all.
    fn modules(self) -> Option<&'static [&'static str]> {
        match self {
            Purpose::References => None,
            Purpose::Meshes => Some(&["gmsh", "meshio", "numpy", "scipy"]),
            Purpose::Records => Some(&["numpy", "scipy"]),
            Purpose::Units => Some(&["fmpy", "numpy"]),
        }
    }

    /// Whether it needs the module called `name`.
    fn needs(self, name: &str) -> bool {
        self.modules().is_none_or(|modules| name == "python" || modules.contains(&name))
    }

    /// What is needed, and how it is installed.
    fn in_words(self) -> [&'static str; 2] {
        match self {
            Purpose::References => {
                ["the reference needs a Python that imports dolfinx, gmsh and meshio", INSTALL]
            }
            Purpose::Meshes => [
                "the mesh of a body needs a Python that imports gmsh and meshio",
                "install them with `pip install gmsh meshio scipy`",
            ],
            Purpose::Records => [
                "a record in a binary format needs a Python that imports numpy and scipy",
                "install them with `pip install numpy scipy pyuff npTDMS h5py pyarrow`, or export the record as text (CSV)",
            ],
            Purpose::Units => [
                "a unit needs a Python that imports fmpy",
                "install it with `pip install \"impactcheck[fmu]\"` or `pip install fmpy`",
            ],
        }
    }
}

/// The environment that `make setup` makes in a checkout.
const OWN_ENVIRONMENT: &str = "target/python-tools/bin/python";

/// A Python, and why it is looked at.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PythonCandidate {
    pub(super) path: PathBuf,
    pub(super) origin: &'static str,
}

/// An interpreter and the versions of what it can import; `None` = missing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Interpreter {
    pub(super) path: PathBuf,
    pub(super) origin: &'static str,
    pub(super) modules: BTreeMap<String, Option<String>>,
    /// MPI's launcher that belongs to it.
    pub(super) launcher: Option<String>,
    /// Why its FEniCSx is not supported.
    refused: Option<String>,
}

impl Interpreter {
    /// Lets the interpreter import the `modules`, or all that a reference needs; a module that is there but broken counts as missing.
    fn probe(candidate: &PythonCandidate, modules: Option<&[&str]>) -> std::result::Result<Self, String> {
        let PythonCandidate { path, origin } = candidate;
        let mut command = fem_reference(path).map_err(|e| e.to_string())?;
        let output = command
            .arg("versions")
            .args(modules.unwrap_or_default())
            .output()
            .map_err(|e| format!("it can't be run ({e})"))?;
        let text = String::from_utf8_lossy(&output.stdout);
        // Modules may print while they are imported; the answer comes last.
        let answer = text.rfind('{').and_then(|at| serde_json::from_str(&text[at..]).ok());
        let Some(mut modules) = answer.filter(|_| output.status.success()) else {
            let log = String::from_utf8_lossy(&output.stderr);
            let last = log.lines().last().map(|line| format!(": {line}")).unwrap_or_default();
            return Err(format!("it is no working Python ({}{last})", output.status));
        };
        let mut take = |name: &str| BTreeMap::remove(&mut modules, name).flatten();
        let (launcher, refused) = (take("mpirun"), take("refused"));
        take("compiler");
        Ok(Interpreter { path: path.clone(), origin, modules, launcher, refused })
    }

    /// Why it can't compute a reference; `None` if it should.
    pub(super) fn fault(&self) -> Option<String> {
        self.fault_for(Purpose::References)
    }

    fn fault_for(&self, purpose: Purpose) -> Option<String> {
        let missing = self.modules.iter().filter(|(name, version)| version.is_none() && purpose.needs(name));
        let missing: Vec<&str> = missing.map(|(name, _)| name.as_str()).collect();
        let missing = (!missing.is_empty()).then(|| format!("it has no {}", missing.join(", ")));
        self.refused.clone().filter(|_| purpose == Purpose::References).or(missing)
    }
}

/// The interpreter that this library has been loaded into.
static OWN: OnceLock<PathBuf> = OnceLock::new();

/// From now on `interpreter` is looked at before others that nobody has named. For Python packages, called once.
pub fn prefer_python(interpreter: PathBuf) {
    OWN.get_or_init(|| interpreter);
}

/// The Python that runs `fem_reference`: the one the environment variable `IMPACTCHECK_PYTHON` names, else the first that can
/// import all that a reference needs, in a supported release, of these: the one of [`prefer_python`], the one that
/// `make setup` made, every `python3` on `PATH`, `/usr/bin/python3`.
///
/// # Errors
/// [`Error::Solver`] if there is none; it says where was looked and what was missing. As [`project_root`].
pub fn python() -> Result<PathBuf> {
    found_for(Purpose::References)
}

/// The Python that meshes bodies from files, as [`python`]; it needs no FEniCSx.
///
/// # Errors
/// As [`python`].
pub(super) fn mesher() -> Result<PathBuf> {
    found_for(Purpose::Meshes)
}

/// The Python that reads records in binary formats, as [`python`]; it needs no FEniCSx.
///
/// # Errors
/// As [`python`].
pub(super) fn reader() -> Result<PathBuf> {
    found_for(Purpose::Records)
}

/// The command that runs a unit, which is described on its standard input.
///
/// # Errors
/// As [`python`], for FMPy.
pub fn unit_runner() -> Result<Command> {
    let mut command = fem_reference(&found_for(Purpose::Units)?)?;
    command.arg("unit");
    Ok(command)
}

fn found_for(purpose: Purpose) -> Result<PathBuf> {
    let root = project_root()?;
    find(purpose, &candidates(named(), &root, &std::env::var_os("PATH").unwrap_or_default()))
}

fn find(purpose: Purpose, candidates: &[PythonCandidate]) -> Result<PathBuf> {
    let mut faults = Vec::new();
    for candidate in candidates {
        match Interpreter::probe(candidate, purpose.modules())
            .map(|interpreter| interpreter.fault_for(purpose))
        {
            Ok(None) => return Ok(candidate.path.clone()),
            Ok(Some(fault)) | Err(fault) => faults.push(format!("{}: {fault}", candidate.path.display())),
        }
    }
    let faults = if faults.is_empty() { "no python3 was found".to_owned() } else { faults.join("; ") };
    let [needed, install] = purpose.in_words();
    let message = format!("{needed}; {faults}");
    let other = format!("to use another interpreter, name it in {PYTHON_VARIABLE}");
    Err(Error::Solver(message).hint([install.to_owned(), other]))
}

/// All interpreters that [`python`] looks at, in its order, each with its reason if it does not run.
pub(super) fn survey() -> Vec<(PythonCandidate, std::result::Result<Interpreter, String>)> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let candidates = candidates(named(), &project_root().unwrap_or_default(), &path);
    candidates.into_iter().map(|c| (c.clone(), Interpreter::probe(&c, None))).collect()
}

fn named() -> Option<PathBuf> {
    std::env::var_os(PYTHON_VARIABLE).filter(|v| !v.is_empty()).map(PathBuf::from)
}

fn candidates(named: Option<PathBuf>, root: &Path, path: &OsStr) -> Vec<PythonCandidate> {
    let of = |origin| move |path| PythonCandidate { path, origin };
    if let Some(path) = named {
        return vec![PythonCandidate { path, origin: PYTHON_VARIABLE }];
    }
    let on_path = std::env::split_paths(path).map(|folder| folder.join("python3"));
    let all = OWN.get().cloned().map(of("it runs this package")).into_iter();
    let all = all.chain([root.join(OWN_ENVIRONMENT)].map(of("made by `make setup`")));
    let all = all
        .chain(on_path.map(of("on PATH")))
        .chain([PathBuf::from("/usr/bin/python3")].map(of("the system's")));
    let mut found: Vec<PythonCandidate> = Vec::new();
    let mut seen: Vec<PathBuf> = Vec::new();
    for candidate in all {
        // /bin is often a link to /usr/bin: the same program is asked once. The file name stays,
        // because a virtual environment is known by the path it is started from.
        let Some(folder) = candidate.path.parent().and_then(|f| f.canonicalize().ok()) else { continue };
        if candidate.path.is_file() && !seen.contains(&folder) {
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
    if let Ok(search_path) = std::env::join_paths(paths) {
        command.env("PYTHONPATH", search_path);
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

    fn named(path: PathBuf) -> Vec<PythonCandidate> {
        candidates(Some(path), Path::new("/none"), OsStr::new("/usr/bin"))
    }

    const COMPLETE: &str =
        r#"{"python": "3.11.2", "dolfinx": "0.5.2", "gmsh": "4.8.4", "meshio": "5.3.4", "compiler": null}"#;
    const BARE: &str = r#"{"python": "3.11.2", "dolfinx": null, "gmsh": "4.8.4", "meshio": null}"#;
    const TOO_NEW: &str =
        r#"{"python": "3.14.1", "dolfinx": "0.12.0", "refused": "dolfinx 0.12.0 is not supported"}"#;

    #[test]
    fn an_interpreter_without_dolfinx_is_named_with_what_installs_it() {
        let folder = tempfile::tempdir().expect("folder");
        let bare = fake(folder.path(), "bare", BARE, 0);
        let error = find(Purpose::References, &named(bare.clone())).expect_err("incomplete");
        assert_eq!(error.exit_status(), crate::ExitStatus::Solver);
        let said = format!("{error} {}", error.hints().join(" "));
        let bare = bare.to_string_lossy();
        for word in [&*bare, "has no dolfinx, meshio", PYTHON_VARIABLE, INSTALL] {
            assert!(said.contains(word), "`{word}` is not in: {said}");
        }
    }

    /// Meshes of bodies need gmsh, not FEniCSx, whatever its release.
    #[test]
    fn a_mesher_needs_no_dolfinx() {
        let folder = tempfile::tempdir().expect("folder");
        let with = |answer: &str| find(Purpose::Meshes, &named(fake(folder.path(), "some", answer, 0)));
        assert!(with(r#"{"python": "3.13.0", "dolfinx": null, "gmsh": "4.15", "meshio": "5.3"}"#).is_ok());
        assert!(with(BARE).expect_err("incomplete").to_string().contains("has no meshio"));
    }

    #[test]
    fn a_named_interpreter_that_does_not_run_is_not_replaced_by_another() {
        let folder = tempfile::tempdir().expect("folder");
        let broken = fake(folder.path(), "broken", "Segmentation fault", 139);
        for (path, word) in [(folder.path().join("none"), "can't be run"), (broken, "no working Python")] {
            let said = find(Purpose::References, &named(path)).expect_err("unusable").to_string();
            assert!(said.contains(word), "{said}");
        }
    }

    /// The environment of `make setup` comes before PATH; every folder of PATH is looked at once.
    #[test]
    fn candidates_have_an_order() {
        let (first, second) = (tempfile::tempdir().expect("folder"), tempfile::tempdir().expect("folder"));
        let root = tempfile::tempdir().expect("folder");
        let bin = root.path().join("target/python-tools/bin");
        std::fs::create_dir_all(&bin).expect("folder");
        let own = fake(&bin, "python", TOO_NEW, 0);
        fake(first.path(), "python3", BARE, 0);
        let complete = fake(second.path(), "python3", COMPLETE, 0);
        let path = std::env::join_paths([first.path(), second.path(), first.path()]).expect("path");
        let found = candidates(None, root.path(), &path);
        let apart: Vec<&PathBuf> =
            found.iter().map(|c| &c.path).filter(|p| !p.starts_with("/usr/bin")).collect();
        assert_eq!(apart, [&own, &first.path().join("python3"), &complete]);
        assert_eq!(found[0].origin, "made by `make setup`");
        assert_eq!(find(Purpose::References, &found).expect("complete"), complete);
    }

    /// All modules are there, yet the solver would end in a traceback.
    #[test]
    fn an_unsupported_release_is_refused_with_its_reason() {
        let folder = tempfile::tempdir().expect("folder");
        let error =
            find(Purpose::References, &named(fake(folder.path(), "new", TOO_NEW, 0))).expect_err("too new");
        assert_eq!(error.exit_status(), crate::ExitStatus::Solver);
        assert!(error.to_string().contains("dolfinx 0.12.0 is not supported"), "{error}");
    }
}
