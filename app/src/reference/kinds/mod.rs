//! What `fem_reference` makes of some kinds of scene besides solutions: modes of plates, meshes of seats and of other bodies.

mod general_impact;
mod plate_impact;
mod seal_seat;

pub use general_impact::{body_groups, body_mesh, mesh_bodies};
pub use plate_impact::plate_modes;
pub use seal_seat::{SeatMeshInfo, make_seat_mesh, mesh_to_follow, seat_mesh, seat_mesh_with, seat_meshes};

use super::{Resolution, child, python};
use crate::error::ExitStatus;
use crate::interrupt::Scratch;
use crate::scene::Scene;
use crate::{Error, Result};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Meshes the body or the seat of `scene` into `out` (`.vtu`), with a description (`.json`) that is returned; `size_factor` enlarges all
/// elements.
///
/// # Errors
/// [`Error::Usage`] if `out` is no `.vtu` file or a file of the user's would be replaced, else those of the mesher.
pub fn make_mesh(scene: &Scene, resolution: Resolution, size_factor: f64, out: &Path) -> Result<Value> {
    let internal = |e: serde_json::Error| Error::Internal(format!("the mesh's description: {e}"));
    match scene.general_impact() {
        Ok(setup) => general_impact::make_body_mesh(setup, size_factor, &replaceable(out)?),
        Err(_) => {
            let info = make_seat_mesh(&python::python()?, scene, resolution, size_factor, out)?;
            serde_json::to_value(info).map_err(internal)
        }
    }
}

/// The whole path of the mesh file `out`, unless a file there, or its description, is no mesh of this program.
fn replaceable(out: &Path) -> Result<PathBuf> {
    if out.extension().is_none_or(|e| e != "vtu") {
        return Err(Error::Usage(format!("{} has to end in .vtu", out.display())));
    }
    let text = std::fs::read_to_string(out.with_extension("json")).ok();
    let described = text.and_then(|text| serde_json::from_str::<Value>(&text).ok());
    let is_described = described.is_some_and(|described| described["sha256"].is_string());
    let there = [out.to_path_buf(), out.with_extension("json")].into_iter().find(|file| file.exists());
    match there {
        Some(file) if !is_described => Err(Error::Usage(format!(
            "{} exists and is no mesh of this program with its description; choose another --out (a .vtu file; the \
             description goes into the .json file of the same name)",
            file.display()
        ))),
        _ => std::path::absolute(out).map_err(|e| Error::io("finding", out, e)),
    }
}

/// Why `fem_reference` made nothing.
struct Refused {
    /// Its last line.
    message: String,
    /// Whether the scene is at fault.
    is_of_scene: bool,
}

impl Refused {
    /// A fault of the scene as the scene's, any other as the solver's.
    fn error(self) -> Error {
        match self.is_of_scene {
            true => Error::Scene(miette::miette!("{}", self.message)),
            false => Error::Solver(self.message),
        }
    }
}

impl From<String> for Refused {
    fn from(message: String) -> Self {
        Self { message, is_of_scene: false }
    }
}

/// Has `fem_reference` write the mesh of `document` to `out` and its description.
fn mesh_with(
    python: &Path,
    document: &Value,
    options: &[&str],
    size_factor: f64,
    out: &Path,
) -> std::result::Result<(), Refused> {
    let folder = std::env::temp_dir();
    let folder = Scratch::new_in(&folder, "impactcheck-")
        .map_err(|e| format!("writing into {}: {e}", folder.display()))?;
    let input = folder.path().join("scene.json");
    std::fs::write(&input, document.to_string()).map_err(|e| format!("writing {}: {e}", input.display()))?;
    let mut command = python::fem_reference(python).map_err(|e| e.to_string())?;
    command.arg("mesh").args(options).args(["--size-factor", &size_factor.to_string(), "--scene"]);
    command.arg(&input).arg("--out").arg(out);
    run(&mut command, python)
}

/// Runs a command of `fem_reference` to its end.
///
/// # Errors
/// [`Error::Scene`] if its input is at fault, else [`Error::Solver`].
pub(super) fn run_to_end(command: &mut std::process::Command, python: &Path) -> Result<()> {
    run(command, python).map_err(Refused::error)
}

/// As [`run_to_end`], with the reason as a text.
fn run(command: &mut std::process::Command, python: &Path) -> std::result::Result<(), Refused> {
    let ending =
        child::run(command, &mut |_| {}).map_err(|e| format!("{} can't be run: {e}", python.display()))?;
    if ending.status.success() {
        return Ok(());
    }
    let last = ending.log.lines().last().unwrap_or("it failed without a message").to_owned();
    let last = ending.error.unwrap_or(last);
    Err(Refused {
        message: last.strip_prefix("error: ").unwrap_or(&last).to_owned(),
        is_of_scene: ending.status.code() == Some(ExitStatus::InvalidScene as i32),
    })
}
