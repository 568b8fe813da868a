//! Computes a reference: one run of `fem_reference`, whose result enters the store when it is proven.

use super::child::{self, Progress, SolverExit};
use super::entry::{self, Stored};
use super::store::Installed;
use super::{Lookup, Resolution, Store, identity, python};
use crate::kinds;
use crate::scene::{Geometry, Scene};
use crate::{Error, Result};
use std::ffi::OsStr;
use std::path::Path;

/// How a reference is computed and what is written beside its summary and history.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Wish {
    /// Instants, in s, at which fields are written.
    pub stress_at: Vec<f64>,
    /// Fields are written at this many instants over the run, or somewhat more.
    pub fields: u32,
    /// Processes, for solid geometry; 0 is 1.
    pub processes: u32,
    /// Processor cores for the time loop, all processes together; 0: those there are.
    pub threads: u32,
}

/// Computes the reference of `scene` at `resolution` and puts it into `store`.
///
/// The result is verified first: checksums, format, and that it is one of this scene with these
/// settings. Until then an older entry stays, and a failed run leaves the store as it was. A solution of another scene of
/// the same name, or with other settings, is kept beside the new one ([`Stored::earlier`]). Where another run computes
/// the same, its result is waited for and taken, unless fields are wished for.
/// The states of a solid run and the impacts of a series are kept beside their place in the store, and a run that was
/// killed goes on from there.
///
/// # Errors
/// [`Error::Scene`] if the solver does not support the scene, [`Error::Solver`] if there is no
/// solver or it fails, [`Error::Io`] if the store can't be written.
pub fn solve(
    scene: &Scene,
    resolution: Resolution,
    store: &Store,
    wish: &Wish,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Stored> {
    solve_with(&python::python()?, scene, resolution, store, wish, progress)
}

/// As [`solve`], with the interpreter `python`.
///
/// # Errors
/// As [`solve`].
pub fn solve_with(
    python: &Path,
    scene: &Scene,
    resolution: Resolution,
    store: &Store,
    wish: &Wish,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Stored> {
    let mut waiting = || {
        let message = "another run of this solution is under way".to_owned();
        progress(&Progress { phase: "waiting".to_owned(), done: 0.0, message, series: None });
    };
    let there = || entry::fingerprint(&store.folder(scene, resolution));
    let before = there();
    let turn = store.turn(scene, resolution, &mut waiting);
    // a run that failed leaves what was there
    if turn.waited
        && there() != before
        && wish.stress_at.is_empty()
        && wish.fields == 0
        && let Lookup::Found(stored) = store.find_here(scene, resolution)
    {
        return Ok(*stored);
    }
    let work = store.work_folder(scene)?;
    let input = work.path().join("scene.json");
    let output = work.path().join("result");
    let document = identity::solver_document(scene, resolution)?;
    std::fs::write(&input, format!("{document:#}\n")).map_err(|e| Error::io("writing", &input, e))?;

    let mut command = python::fem_reference(python)?;
    command.args([OsStr::new("solve"), OsStr::new("--scene"), input.as_os_str()]);
    command.args([OsStr::new("--out"), output.as_os_str()]);
    command.args(["--resolution", resolution.first()]);
    if let Some(file) = kinds::of(scene).body_file(scene) {
        command.arg("--body").arg(file);
    }
    if let Resolution::Calculix(_) = resolution {
        command.args(["--solver", "calculix"]);
    }
    if let Resolution::Within(error) = resolution {
        command.args(["--target-error", &error.share().to_string()]);
    }
    if !wish.stress_at.is_empty() {
        command.arg("--stress-at");
        command.arg(wish.stress_at.iter().map(f64::to_string).collect::<Vec<_>>().join(","));
    }
    if wish.fields > 0 {
        command.args(["--fields", &wish.fields.to_string()]);
    }
    if wish.threads > 0 {
        command.args(["--threads", &wish.threads.to_string()]);
    }
    let solid = scene.reference.geometry == Geometry::Solid;
    if kinds::of(scene).is_resumable(scene) {
        command.arg("--checkpoint").arg(store.checkpoint_folder(scene, resolution)?);
    }
    if solid {
        command.args(["--np", &wish.processes.max(1).to_string()]);
    }
    let ending = child::run(&mut command, progress)
        .map_err(|e| Error::Solver(format!("{} can't be run: {e}", python.display())))?;
    if !ending.status.success() {
        return Err(failure(&ending));
    }

    let unusable = |reason: String| {
        let stray = ending.stray.as_ref().map(|s| format!("; it printed `{s}`")).unwrap_or_default();
        Error::Solver(format!("the reference's solver ended well, but {reason}{stray}{}", log(&ending)))
    };
    if !output.is_dir() {
        return Err(unusable("it wrote no result".to_owned()));
    }
    let origin = match entry::Origin::of(resolution) {
        entry::Origin::Stored => entry::Origin::Computed,
        imported => imported,
    };
    let stored = entry::load(scene, &output, origin).map_err(|d| {
        let file = d.file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        unusable(format!("its {file} {}", d.reason))
    })?;
    if let Some(reason) = identity::staleness(&stored.provenance, scene, resolution)? {
        return Err(unusable(format!("its result is not one of this scene: {reason}")));
    }
    let Installed { folder, earlier } = store.install(&work, &output, scene, resolution)?;
    Ok(Stored { folder, earlier, ..stored })
}

/// The error a failed run ends with.
fn failure(ending: &SolverExit) -> Error {
    // Without an exit code a signal ended it: someone killed it, or the memory ran out.
    let Some(code) = ending.status.code() else {
        return Error::Solver(format!(
            "the reference's solver was ended before it was done ({}); nothing was stored{}",
            ending.status,
            log(ending)
        ));
    };
    match &ending.error {
        Some(message) if code == 3 => {
            let help = "the reduced models may run this scene; the finite-element reference does not";
            Error::Scene(miette::miette!(help = help, "the reference can't run this scene: {message}"))
        }
        Some(message) => Error::Solver(format!("the reference's solver failed: {message}")),
        None => {
            let stray = ending.stray.as_ref().map(|s| format!("; it printed `{s}`")).unwrap_or_default();
            Error::Solver(format!(
                "the reference's solver failed (exit status {code}) without saying why{stray}{}",
                log(ending)
            ))
        }
    }
}

fn log(ending: &SolverExit) -> String {
    if ending.log.is_empty() { String::new() } else { format!("; its last messages:\n{}", ending.log) }
}
