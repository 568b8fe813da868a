//! A search that tells how far it is, and that Ctrl-C ends.

use crate::scene::Scene;
use crate::{detached, raised};
use impactcheck::cli::in_process;
use impactcheck::interrupt;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How often the caller hears of the progress.
const INTERVAL: Duration = Duration::from_millis(100);

/// How far a search is.
struct SearchProgress {
    tried: usize,
    best: Option<f64>,
    reported: Instant,
    /// What the caller's function raised.
    raised: Option<PyErr>,
}

/// The document of `impactcheck optimise` with these `options` as JSON, its figure as SVG, and the best design's scene file; `progress` is
/// called with the number of designs tried and what the best is worth.
#[pyfunction]
pub fn optimise(
    py: Python,
    scene: &Scene,
    options: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, String, String)> {
    let template = scene.template().map_err(raised)?;
    let (stopped, reported) = (AtomicBool::new(false), Instant::now());
    let state = Mutex::new(SearchProgress { tried: 0, best: None, reported, raised: None });
    let state = || -> MutexGuard<SearchProgress> { state.lock().unwrap_or_else(PoisonError::into_inner) };
    let watch = |worth: Option<f64>| {
        let mut so_far = state();
        so_far.tried += 1;
        so_far.best = so_far.best.into_iter().chain(worth).reduce(f64::max);
        if let (Some(progress), true) = (&progress, so_far.reported.elapsed() >= INTERVAL) {
            so_far.reported = Instant::now();
            let (tried, best) = (so_far.tried, so_far.best);
            // what it calls may search, too
            drop(so_far);
            if let Err(error) = Python::attach(|py| progress.call1(py, (tried, best)).map(|_| ())) {
                stopped.store(true, Relaxed);
                state().raised.get_or_insert(error);
            }
        }
        !stopped.load(Relaxed)
    };
    let stop = || {
        stopped.store(true, Relaxed);
        interrupt::end_children();
    };
    let found = detached::detached(py, stop, || in_process::optimise(template, &options, &watch))?;
    if let Some(error) = state().raised.take() {
        return Err(error);
    }
    let found = found.map_err(raised)?;
    Ok((found.document.to_string(), found.figure, found.scene))
}
