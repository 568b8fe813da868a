//! What the reference needs and what of it is there.

use super::{Lookup, Resolution, Store, python};
use crate::scene::{Scene, shipped};
use serde::Serialize;
use std::process::{Command, Stdio};

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
}

/// Checks Python and its modules, the C compiler, the store and its entries for the shipped scenes.
pub fn doctor(store: &Store) -> Vec<Check> {
    let mut checks = interpreter();
    checks.push(Check {
        name: "C compiler".to_owned(),
        found: compiler(),
        needed_for: "computing references: dolfinx and the time loop compile their kernels".to_owned(),
        install: "sudo apt-get install gcc libc6-dev".to_owned(),
    });
    checks.push(store_folder(store));
    for path in shipped().unwrap_or_default() {
        if let Ok(scene) = Scene::read(&path) {
            checks.extend(Resolution::ALL.iter().filter_map(|r| entry(store, &scene, *r)));
        }
    }
    checks
}

fn interpreter() -> Vec<Check> {
    let best = python::best();
    let version = |module: &str| best.as_ref().and_then(|b| b.modules.get(module).cloned().flatten());
    let check = |name: &str, found: Option<String>, needed_for: &str, package: &str| Check {
        name: name.to_owned(),
        found,
        needed_for: needed_for.to_owned(),
        install: format!("sudo apt-get install {package}"),
    };
    let python = best.as_ref().zip(version("python")).map(|(b, v)| format!("{v} ({})", b.path.display()));
    vec![
        check("Python", python, "computing references that are not stored", "python3"),
        check("dolfinx", version("dolfinx"), "computing references: finite elements", "python3-dolfinx"),
        check("gmsh", version("gmsh"), "computing references: meshes", "python3-gmsh"),
        check("cffi", version("cffi"), "computing references: compiled element kernels", "python3-cffi"),
    ]
}

/// First line a C compiler says about itself.
fn compiler() -> Option<String> {
    let asked = std::env::var("CC").ok().filter(|c| !c.is_empty());
    let names = asked.map_or_else(|| ["cc", "gcc", "clang"].map(str::to_owned).to_vec(), |c| vec![c]);
    names.iter().find_map(|name| {
        let output = Command::new(name).arg("--version").stdin(Stdio::null()).output().ok()?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        output.status.success().then(|| text.lines().next().unwrap_or("unknown version").to_owned())
    })
}

fn store_folder(store: &Store) -> Check {
    let root = store.root().display().to_string();
    let read = std::fs::read_dir(store.root());
    let needed_for = match &read {
        Ok(_) => "references that need no solver".to_owned(),
        Err(error) => format!("references that need no solver; {root} can't be read: {error}"),
    };
    Check {
        name: "store of references".to_owned(),
        found: read.ok().map(|_| root),
        needed_for,
        install: "impactcheck reference SCENE".to_owned(),
    }
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
    })
}
