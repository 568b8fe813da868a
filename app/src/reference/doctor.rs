//! What the reference needs and what of it is there.

use super::python::{self, Interpreter, PythonCandidate};
use super::trial::solve_trial;
use super::{Lookup, Resolution, Store};
use crate::project::project_root;
use crate::scene::{Scene, shipped};
use serde::Serialize;
use std::io::ErrorKind;
use std::process::{Command, Stdio};

/// Environment variable that names CalculiX's program.
const CALCULIX_VARIABLE: &str = "IMPACTCHECK_CCX";

/// Name of the check for the independent solver.
pub const INDEPENDENT_SOLVER: &str = "CalculiX";

/// One thing that is needed, and whether it is there.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// What it is.
    pub name: String,
    /// Version or state; `None` if it is missing or can't be used.
    pub found: Option<String>,
    /// What it is needed for, or why what is there can't be used.
    pub needed_for: String,
    /// The command that brings it.
    pub install: String,
    /// Whether all else works without it.
    pub optional: bool,
}

/// Checks the project's files, Python and all it will import, a small reference, the C compiler, MPI's launcher, the store
/// and its entries for the shipped scenes.
pub fn doctor(store: &Store) -> Vec<Check> {
    let mut checks = vec![project()];
    let survey = python::survey();
    let chosen = chosen(&survey);
    checks.extend(interpreter(&survey, chosen));
    checks.push(trial(chosen));
    checks.push(Check {
        name: "C compiler".to_owned(),
        found: compiler(),
        needed_for: "computing references: dolfinx and the time loop compile their kernels".to_owned(),
        install: "sudo apt-get install gcc libc6-dev".to_owned(),
        optional: false,
    });
    checks.push(launcher(chosen));
    checks.push(Check {
        name: INDEPENDENT_SOLVER.to_owned(),
        found: calculix(),
        needed_for: "references of an independent solver (`reference --solver calculix`)".to_owned(),
        install: "sudo apt-get install calculix-ccx".to_owned(),
        optional: true,
    });
    checks.push(Check {
        name: "MuJoCo".to_owned(),
        found: mujoco(),
        needed_for: "reference flights of another program (`python -m fem_reference flights`)".to_owned(),
        install: "make setup".to_owned(),
        optional: true,
    });
    let formats = "measured records as UFF 58, TDMS, MATLAB 7.3, HDF5 and Parquet (`--measured`)";
    checks.push(libraries(chosen, "record formats", "pyuff npTDMS h5py pyarrow", formats));
    checks.push(libraries(chosen, "FMPy", "fmpy", "units of other programs as models (`[[external]] fmu`)"));
    checks.push(store_folder(store));
    for path in shipped().unwrap_or_default() {
        if let Ok(scene) = Scene::read(&path) {
            checks.extend(Resolution::ALL.iter().filter_map(|r| entry(store, &scene, *r)));
        }
    }
    checks
}

fn project() -> Check {
    let root = project_root();
    Check {
        name: "project files".to_owned(),
        needed_for: match &root {
            Ok(_) => "shipped scenes, their references, the package fem_reference".to_owned(),
            Err(error) => format!("shipped scenes, their references, the package fem_reference; {error}"),
        },
        found: root.ok().map(|root| root.display().to_string()),
        install: "export IMPACTCHECK_HOME=FOLDER, a checkout of the project".to_owned(),
        optional: false,
    }
}

type Survey = [(PythonCandidate, std::result::Result<Interpreter, String>)];

/// The first interpreter that can compute references, else the one that lacks least.
fn chosen(survey: &Survey) -> Option<&Interpreter> {
    let running = survey.iter().filter_map(|(_, probed)| probed.as_ref().ok());
    running
        .min_by_key(|i| (i.fault().is_some(), i.modules.values().filter(|version| version.is_none()).count()))
}

/// Python and all modules that a reference needs, as the package itself imports them.
fn interpreter(survey: &Survey, chosen: Option<&Interpreter>) -> Vec<Check> {
    let others = survey.iter().filter(|(c, _)| chosen.is_none_or(|i| i.path != c.path));
    let others: Vec<String> =
        others.map(|(c, probed)| format!("{}: {}", c.path.display(), state(probed))).collect();
    let others = if others.is_empty() { String::new() } else { format!("; not {}", others.join(", not ")) };
    let check = |name: &str, found: Option<String>| {
        let (needed_for, _) = purpose(name);
        Check {
            found,
            needed_for: format!("computing references{needed_for}"),
            install: install(chosen, name),
            name: if name == "python" { "Python".to_owned() } else { name.to_owned() },
            optional: false,
        }
    };
    let Some(chosen) = chosen else {
        let mut missing = check("python", None);
        missing.needed_for += &others;
        return vec![missing];
    };
    let about = |version: String| format!("{version} ({}; {}{others})", chosen.path.display(), chosen.origin);
    let modules = chosen.modules.iter().map(|(name, found)| match name.as_str() {
        "python" => check(name, found.clone().map(about)),
        _ => check(name, found.clone()),
    });
    modules.collect()
}

/// Which FEniCSx an interpreter has that was not chosen, or why it has none.
fn state(probed: &std::result::Result<Interpreter, String>) -> String {
    match probed {
        Err(reason) => reason.clone(),
        Ok(i) => match i.modules.get("dolfinx").cloned().flatten() {
            None => "no FEniCSx".to_owned(),
            Some(version) => i.fault().unwrap_or_else(|| format!("dolfinx {version}, comes later")),
        },
    }
}

/// Whether a small reference can be solved, from mesh to files.
fn trial(chosen: Option<&Interpreter>) -> Check {
    let solved = match chosen.map(|i| (i.fault(), &i.path)) {
        None => Err("there is no Python".to_owned()),
        Some((Some(fault), _)) => Err(fault),
        Some((None, path)) => solve_trial(path).map_err(|error| error.to_string()),
    };
    let (found, why) = match solved {
        Ok(took) => (Some(format!("solved in {:.1} s", took.as_secs_f64())), String::new()),
        Err(why) => (None, format!("; {why}")),
    };
    Check {
        name: "small reference".to_owned(),
        found,
        needed_for: format!("computing references{why}"),
        install: install(chosen, "dolfinx"),
        optional: false,
    }
}

/// MPI's launcher: the one that belongs to the interpreter's MPI, else the first on `PATH`.
fn launcher(chosen: Option<&Interpreter>) -> Check {
    let path = chosen.and_then(|i| i.launcher.clone()).unwrap_or_else(|| "mpirun".to_owned());
    Check {
        name: "mpirun".to_owned(),
        found: version_of(&path).map(|_| path),
        needed_for: "several processes (`reference --np`)".to_owned(),
        install: install(chosen, "mpirun"),
        optional: false,
    }
}

/// What a module is for, and Debian's package of it.
fn purpose(module: &str) -> (&'static str, &'static str) {
    match module {
        "python" => (" that are not stored", "python3"),
        "gmsh" => (": meshes", "python3-gmsh"),
        "meshio" => (": files of meshes and fields", "python3-meshio"),
        "cffi" => (": compiled element kernels", "python3-cffi"),
        "numpy" => (": arrays", "python3-numpy"),
        "scipy" => (": sparse matrices", "python3-scipy"),
        "slepc4py" => (": eigenmodes", "python3-slepc4py"),
        "mpirun" => ("", "openmpi-bin"),
        _ => (": finite elements", "python3-dolfinx"),
    }
}

/// The command that brings a module: Debian's package into the system's Python, a wheel into another.
fn install(interpreter: Option<&Interpreter>, module: &str) -> String {
    let debian = format!("sudo apt-get install {}", purpose(module).1);
    let Some(chosen) = interpreter.filter(|i| !i.path.starts_with("/usr/bin")) else { return debian };
    let wheel = match module {
        "python" => return "make setup".to_owned(),
        "gmsh" | "meshio" | "cffi" | "numpy" | "scipy" => module,
        "mpirun" => "mpich",
        _ => "dolfinx-solver-real",
    };
    format!(
        "{} -m pip install {wheel} (Linux x86-64, Python 3.12 or later; else {debian})",
        chosen.path.display()
    )
}

/// First line a C compiler says about itself.
fn compiler() -> Option<String> {
    let requested = std::env::var("CC").ok().filter(|c| !c.is_empty());
    let names = requested.map_or_else(|| ["cc", "gcc", "clang"].map(str::to_owned).to_vec(), |c| vec![c]);
    names.iter().find_map(|name| version_of(name))
}

/// First line a program says about itself.
fn version_of(program: &str) -> Option<String> {
    let output = Command::new(program).arg("--version").stdin(Stdio::null()).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    output.status.success().then(|| text.lines().next().unwrap_or("unknown version").to_owned())
}

/// What CalculiX says about itself.
fn calculix() -> Option<String> {
    let named = std::env::var(CALCULIX_VARIABLE).ok().filter(|program| !program.is_empty());
    let program = named.unwrap_or_else(|| "ccx".to_owned());
    let output = Command::new(program).arg("-v").stdin(Stdio::null()).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.lines().find(|line| line.contains("Version")).map(|line| line.trim().to_owned())
}

/// Version of MuJoCo in the project's own Python environment.
fn mujoco() -> Option<String> {
    let python = project_root().ok()?.join("target/python-tools/bin/python");
    let script = "import importlib.metadata as m; print(m.version('mujoco'))";
    let output = Command::new(python).args(["-c", script]).stdin(Stdio::null()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Optional `libraries` of Python, under one `name`.
fn libraries(chosen: Option<&Interpreter>, name: &str, libraries: &str, needed_for: &str) -> Check {
    let script = format!(
        "import importlib.metadata as m\nfor n in '{libraries}'.split():\n try: print(n, m.version(n))\n except m.PackageNotFoundError: pass"
    );
    let listed = chosen.and_then(|i| {
        let output = Command::new(&i.path).args(["-c", &script]).stdin(Stdio::null()).output().ok()?;
        Some(String::from_utf8_lossy(&output.stdout).trim().replace('\n', ", "))
    });
    Check {
        name: name.to_owned(),
        found: listed.filter(|listed| !listed.is_empty()),
        needed_for: needed_for.to_owned(),
        install: match chosen {
            Some(i) => format!("{} -m pip install {libraries}", i.path.display()),
            None => format!("pip install {libraries}"),
        },
        optional: true,
    }
}

fn store_folder(store: &Store) -> Check {
    let root = store.root().display().to_string();
    let needed_for = "references that need no solver".to_owned();
    let (found, needed_for) = match std::fs::read_dir(store.root()) {
        Ok(_) => (Some(root), needed_for),
        // It is made with the first solution.
        Err(e) if e.kind() == ErrorKind::NotFound => {
            (Some(format!("{root} (nothing there yet)")), needed_for)
        }
        Err(e) => (None, format!("{needed_for}; {root} can't be read: {e}")),
    };
    let install = "impactcheck reference SCENE".to_owned();
    Check { name: "store of references".to_owned(), found, needed_for, install, optional: false }
}

/// The state of one entry. Only the `paper` resolution is expected to be there.
fn entry(store: &Store, scene: &Scene, resolution: Resolution) -> Option<Check> {
    let (found, needed_for) = match store.find_here_or_shipped(scene, resolution) {
        Lookup::Missing if resolution != Resolution::Paper => return None,
        Lookup::Missing => (None, "comparing; it is not stored".to_owned()),
        Lookup::Stale { reason } => (None, format!("comparing; what is stored is stale: {reason}")),
        Lookup::Damaged { file, reason } => {
            (None, format!("comparing; what is stored is damaged: {} {reason}", file.display()))
        }
        Lookup::Found(stored) => {
            let created = stored.provenance["created"].as_str().unwrap_or("at an unknown time").to_owned();
            (Some(format!("intact, computed {created}")), "comparing".to_owned())
        }
    };
    Some(Check {
        name: format!("reference of {} at {resolution} resolution", scene.name),
        found,
        needed_for,
        install: format!("impactcheck reference {} --resolution {resolution} --fresh", scene.name),
        optional: false,
    })
}
