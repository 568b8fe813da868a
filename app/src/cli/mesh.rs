//! `impactcheck mesh`: meshes the seat of a seal-seat scene, or the body of an impact.

use super::progress::Bar;
use super::{Context, JsonArgument};
use crate::error::{Error, ExitStatus, Result};
use crate::file::write_file;
use crate::format::{prefixed, with_unit};
use crate::kinds::{self, Use};
use crate::reference::{self, Resolution};
use crate::report;
use clap::Args;
use serde_json::Value;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file (seal-seat, or impact with [body]), name of a shipped scene, or `-` for standard input
    scene: String,
    /// Mesh file (.vtu); its description (.json) is written next to it [default: the scene's name]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Write a page that shows the body in 3D to this file (.html); of an impact with [body]
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    /// Resolution of the mesh of a seat
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
    let page = arguments.page.as_ref().map(|file| super::html_file("--page", file)).transpose()?;
    let bar = Bar::new(context, &scene.name);
    bar.part("mesh: gmsh", 0.0);
    let info = reference::make_mesh(&scene, arguments.resolution, factor, &out)?;
    if let Some(file) = page {
        bar.part("the body in 3D", 0.7);
        write_file(file, report::body_page(&scene).as_bytes())?;
    }
    drop(bar);
    if arguments.json.json {
        super::print_json(&info)?;
    } else {
        let number = |key: &str| info[key].to_string();
        context.note(format_args!(
            "{}: {} nodes, {} dofs, {} tetrahedra of order {}, quality {:.2} at worst, {:.2} on average",
            out.display(),
            number("nodes"),
            number("dofs"),
            number("elements"),
            number("element_order"),
            info["min_quality"].as_f64().unwrap_or(f64::NAN),
            info["mean_quality"].as_f64().unwrap_or(f64::NAN)
        ));
        for (name, contact) in ["outer", "inner"].map(|name| (name, &info["contacts"][name])) {
            if contact.is_object() {
                context.note(contact_in_words(name, contact));
            }
        }
    }
    if let Some(file) = page {
        context.note(format_args!("page in {}", file.display()));
    }
    Ok(ExitStatus::Pass)
}

/// Where a body strikes, and how the mesh is there.
fn contact_in_words(name: &str, contact: &Value) -> String {
    let length = |key: &str| {
        contact[key]
            .as_f64()
            .map_or_else(|| "unknown".to_owned(), |value| with_unit(value, prefixed("m", value), 3))
    };
    let normal: Vec<String> = contact["normal"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|c| format!("{:.3}", c.as_f64().unwrap_or(0.0)))
        .collect();
    let radius = |k: usize| match contact["curvatures"][k].as_f64() {
        Some(curvature) if curvature != 0.0 => with_unit(1.0 / curvature, prefixed("m", 1.0 / curvature), 3),
        _ => "flat".to_owned(),
    };
    format!(
        "{name} contact: normal ({}), radii of curvature {} and {}, wall {} in {} layers, elements {}, next edge {} away; {} from the place named",
        normal.join(", "),
        radius(0),
        radius(1),
        length("wall"),
        contact["layers"],
        length("element_size"),
        length("edge_distance"),
        length("distance")
    )
}
