//! The module `impactcheck._core`: scenes, models, references and comparisons in the interpreter's process, and the program.
//!
//! What it gives is made into the package's results in Python (`python/impactcheck`): summaries and documents go over as
//! JSON, as the program prints it, curves without a copy. The interpreter's lock is let go while anything is computed.

mod detached;
mod figure;
mod optimise;
mod samples;
mod scene;

use detached::detached;
use impactcheck::cli::in_process::{self, Comparing, ModelRequest, PredictedSummary, RequestedModel};
use impactcheck::interrupt;
use impactcheck::kinds::SharedBodies;
use impactcheck::result::{History, Outcome};
use impactcheck::{Error, Result, cli, fmu, project, reference, report};
use pyo3::prelude::*;
use rayon::prelude::*;
use samples::Samples;
use scene::Scene;
use serde::Serialize;
use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

mod python {
    pyo3::import_exception!(impactcheck._error, Error);
}

static FILES: project::Embedded = impactcheck_embedded::files!();
static UNIT: &[u8] = impactcheck_embedded::unit!();
static LIVE: &[u8] = impactcheck_embedded::live!();

/// An error of the program as Python raises it.
fn raised(error: Error) -> PyErr {
    python::Error::new_err((in_process::in_words(&error), error.exit_status() as u8))
}

fn usage(error: impl ToString) -> PyErr {
    raised(Error::Usage(error.to_string()))
}

fn json(document: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(document).map_err(|e| raised(Error::Internal(e.to_string())))
}

/// A summary as JSON, and the curves by name.
type Run = (String, Vec<(&'static str, Samples)>);

fn run(outcome: Outcome) -> PyResult<Run> {
    let summary = json(&outcome.summary)?;
    Ok((summary, curves(outcome.history)))
}

fn curves(history: History) -> Vec<(&'static str, Samples)> {
    let curves = history.curves.into_iter().map(|curve| (curve.name, Samples(curve.values)));
    let time = ("time", Samples(history.time));
    std::iter::once(time).chain(curves).collect()
}

/// Runs a reduced model of a scene, with what a converged reference would find.
#[pyfunction]
fn predicted(
    py: Python,
    scene: &Scene,
    model: Option<&str>,
    modes: Option<usize>,
    tolerance: Option<f64>,
) -> PyResult<Run> {
    let model = model.map(RequestedModel::from_str).transpose().map_err(usage)?;
    let request = ModelRequest { model, modes, tolerance, mesh: None };
    let solve = || {
        let outcome = in_process::reduced(&scene.scene, &request, &SharedBodies::default())?;
        let prediction = in_process::predicted(&scene.scene, &request, &outcome.summary);
        Ok((outcome, prediction))
    };
    let (outcome, prediction) = detached(py, || (), solve)?.map_err(raised)?;
    let summary = json(&PredictedSummary::of(&scene.scene, &outcome.summary, &prediction))?;
    Ok((summary, curves(outcome.history)))
}

/// Runs a reduced model of every scene, side by side in so many `threads` (those of the machine if it is none).
#[pyfunction]
fn reduced(
    py: Python,
    scenes: Vec<Py<Scene>>,
    model: Option<&str>,
    modes: Option<usize>,
    tolerance: Option<f64>,
    threads: Option<usize>,
) -> PyResult<Vec<Run>> {
    let model = model.map(RequestedModel::from_str).transpose().map_err(usage)?;
    let request = ModelRequest { model, modes, tolerance, mesh: None };
    let (bodies, stopped) = (SharedBodies::default(), AtomicBool::new(false));
    let one = |scene: &Py<Scene>| match stopped.load(Relaxed) {
        true => Err(Error::Internal("interrupted".into())),
        false => in_process::reduced(&scene.get().scene, &request, &bodies),
    };
    let all = || scenes.par_iter().map(one).collect::<Vec<Result<Outcome>>>();
    let run_all = || match threads {
        // threads of their own only for who asks for another number
        None => Ok(all()),
        Some(threads) => {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().map(|own| own.install(all))
        }
    };
    let outcomes = detached(py, || stopped.store(true, Relaxed), run_all)?.map_err(usage)?;
    outcomes.into_iter().map(|outcome| run(outcome.map_err(raised)?)).collect()
}

/// Finds the reference of a scene, or computes it.
#[pyfunction(name = "reference")]
fn find_reference(py: Python, scene: &Scene, resolution: &str, compute: bool) -> PyResult<Run> {
    let resolution = resolution.parse().map_err(usage)?;
    let find = || in_process::reference(scene.placed(), resolution, compute);
    run(detached(py, interrupt::end_children, find)?.map_err(raised)?)
}

/// Compares the scenes, and records measured of one, by an instrument of a bandwidth and with a source of the outer body's speed: the
/// document as JSON, and the figure of each scene as SVG.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "those of the package's function")]
fn compare(
    py: Python,
    scenes: Vec<Py<Scene>>,
    models: Vec<String>,
    resolution: &str,
    compute: bool,
    allow_external: bool,
    out: Option<PathBuf>,
    measured: Vec<PathBuf>,
    how: (Option<String>, Option<String>, Option<PathBuf>),
) -> PyResult<(String, Vec<String>)> {
    let (bandwidth, speed, record_map) = how;
    let speed = speed.map(|name| name.parse()).transpose().map_err(usage)?;
    let models =
        models.iter().map(|name| name.parse()).collect::<std::result::Result<_, _>>().map_err(usage)?;
    let resolution = resolution.parse().map_err(usage)?;
    let request = Comparing {
        models,
        resolution,
        compute,
        allow_external,
        out,
        measured,
        bandwidth,
        speed,
        record_map,
    };
    let scenes: Vec<_> = scenes.iter().map(|scene| scene.get().placed()).collect();
    let compare = || in_process::compare(scenes, request);
    let compared = detached(py, interrupt::end_children, compare)?.map_err(raised)?;
    Ok((json(&compared.comparison)?, compared.figures))
}

/// The folder that holds scenes, meshes and the package `fem_reference`.
#[pyfunction]
fn project_root() -> PyResult<PathBuf> {
    project::project_root().map_err(raised)
}

/// The program, which ends by Ctrl-C as it does alone.
#[pyfunction]
fn main(py: Python, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cli::main(arguments))
}

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    project::embed(FILES);
    fmu::embed(UNIT);
    report::embed_live(LIVE);
    reference::mesh_bodies();
    let interpreter = module.py().import("sys")?.getattr("executable")?;
    if let Ok(interpreter) = interpreter.extract() {
        reference::prefer_python(interpreter);
    }
    module.add_class::<Scene>()?;
    module.add_class::<Samples>()?;
    module.add_function(wrap_pyfunction!(predicted, module)?)?;
    module.add_function(wrap_pyfunction!(reduced, module)?)?;
    module.add_function(wrap_pyfunction!(find_reference, module)?)?;
    module.add_function(wrap_pyfunction!(compare, module)?)?;
    module.add_function(wrap_pyfunction!(figure::figure, module)?)?;
    module.add_function(wrap_pyfunction!(optimise::optimise, module)?)?;
    module.add_function(wrap_pyfunction!(project_root, module)?)?;
    module.add_function(wrap_pyfunction!(main, module)?)
}
