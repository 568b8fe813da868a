//! What `fem_reference` makes of some kinds of scene besides solutions: modes of plates, meshes of seats and of other bodies.

mod general_impact;
mod plate_impact;
mod seal_seat;

pub use general_impact::{body_groups, body_mesh, mesh_bodies};
pub use plate_impact::plate_modes;
pub use seal_seat::{SeatMeshInfo, make_seat_mesh, mesh_to_follow, seat_mesh, seat_mesh_with, seat_meshes};

use super::{child, python};
use crate::error::ExitStatus;
use crate::interrupt::Scratch;
use serde_json::Value;
use std::path::Path;

/// Why `fem_reference` made nothing.
struct Refused {
    /// Its last line.
    message: String,
    /// Whether the scene is at fault.
    is_of_scene: bool,
}

impl From<String> for Refused {
    fn from(message: String) -> Self {
        Self { message, is_of_scene: false }
    }
}

/// Has `fem_reference` write the mesh of `document` to `out` and its description beside it.
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
