//! Eigenmodes from the finite-element side: one run of `fem_reference modes` (SLEPc).

use crate::body::continuum::PlateMode;
use crate::interrupt::Scratch;
use crate::reference::{Resolution, identity, python};
use crate::scene::Scene;
use crate::{Error, Result};
use serde::Deserialize;
use std::path::Path;

#[derive(Deserialize)]
struct ModesDocument {
    modes: Vec<SlepcMode>,
}

#[derive(Deserialize)]
struct SlepcMode {
    /// Hz.
    frequency: f64,
    longitudinal: bool,
}

/// The `count` lowest elastic axisymmetric modes of the scene's plate by FEniCSx and SLEPc, ascending; the
/// rigid motion of a free plate is not among them. `python` is the interpreter, see [`crate::reference::python`].
///
/// # Errors
/// [`Error::Scene`] if the scene has no plate, [`Error::Solver`] if the solver fails or its answer can't be read,
/// [`Error::Io`] if no temporary file can be written.
pub fn plate_modes(python: &Path, scene: &Scene, count: usize) -> Result<Vec<PlateMode>> {
    let thickness = scene.plate_impact()?.plate.thickness;
    let failed = |what: String| {
        Error::Solver(format!("modes of the plate of thickness {thickness} m by SLEPc: {what}"))
    };
    let folder = std::env::temp_dir();
    let folder =
        Scratch::new_in(&folder, "impactcheck-").map_err(|e| Error::io("writing into", &folder, e))?;
    let input = folder.path().join("scene.json");
    let document = identity::solver_document(scene, Resolution::Paper)?;
    std::fs::write(&input, document.to_string()).map_err(|e| Error::io("writing", &input, e))?;
    let mut command = python::fem_reference(python)?;
    command.args(["modes", "--count", &count.to_string(), "--scene"]).arg(&input);
    let output = command.output().map_err(|e| failed(format!("{} can't be run: {e}", python.display())))?;
    if !output.status.success() {
        let log = String::from_utf8_lossy(&output.stderr);
        return Err(failed(log.lines().last().unwrap_or("the solver failed without a message").to_owned()));
    }
    let document: ModesDocument = serde_json::from_slice(&output.stdout)
        .map_err(|e| failed(format!("the answer can't be read: {e}")))?;
    if document.modes.len() != count {
        return Err(failed(format!("{} modes were returned, {count} were requested", document.modes.len())));
    }
    let mode = |m: SlepcMode| PlateMode { frequency: m.frequency, longitudinal: m.longitudinal };
    Ok(document.modes.into_iter().map(mode).collect())
}
