//! `impactcheck mesh`: meshes the seat of a seal-seat scene.

use super::progress::Bar;
use super::{Context, JsonArgument};
use crate::error::{Error, ExitStatus, Result};
use crate::kinds::{self, Use};
use crate::reference::{self, Resolution};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file (seal-seat), name of a shipped scene, or `-` for standard input
    scene: String,
    /// Mesh file (.vtu); its description (.json) is written next to it [default: the scene's name]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Resolution of the mesh
    #[arg(long, default_value = "paper")]
    resolution: Resolution,
    /// Factor on the element size
    #[arg(long, default_value_t = 1.0, value_name = "X")]
    size_factor: f64,
    #[command(flatten)]
    json: JsonArgument,
}

/// Makes the mesh and prints its numbers.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let factor = arguments.size_factor;
    if !(0.1..=10.0).contains(&factor) {
        return Err(Error::Usage(format!("--size-factor {factor} has to lie between 0.1 and 10")));
    }
    let (_, scene) = super::read_scene(&arguments.scene)?;
    kinds::serving(&scene, Use::MeshFile)?;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.vtu", scene.name)));
    let python = reference::python()?;
    let bar = Bar::new(context, &scene.name);
    bar.part("mesh: gmsh", 0.0);
    let info = reference::make_seat_mesh(&python, &scene, arguments.resolution, factor, &out)?;
    drop(bar);
    if arguments.json.json {
        super::print_json(&info)?;
    } else {
        context.note(format_args!(
            "{}: {} nodes, {} dofs, {} tetrahedra of order {}, quality {:.2} at worst, {:.2} on average",
            out.display(),
            info.nodes,
            info.dofs,
            info.elements,
            info.element_order,
            info.min_quality,
            info.mean_quality
        ));
    }
    Ok(ExitStatus::Pass)
}
