//! `impactcheck reference`: finds the stored finite-element solution of a scene, or computes it.

use super::progress::Bar;
use super::{Context, JsonArgument};
use crate::error::{Error, ExitStatus, Result};
use crate::reference::{Lookup, Resolution, Store, Stored, TargetError};
use crate::scene::{self, Geometry, Scene};
use clap::Args;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file, or the name of a shipped scene
    scene: String,
    /// How fine the mesh is
    #[arg(long, default_value = "paper")]
    resolution: Resolution,
    /// Refine until the 95 % band of efficiency and force peaks is at most this, for example 0.2%
    #[arg(long, value_name = "ERROR", conflicts_with = "resolution")]
    target_error: Option<TargetError>,
    /// Number of processes (three-dimensional references only)
    #[arg(long, default_value_t = 1, value_name = "N")]
    np: usize,
    /// Compute even if there is a stored solution
    #[arg(long)]
    fresh: bool,
    /// Write stress fields (.vtu) at these times, in s
    #[arg(long, value_delimiter = ',', value_name = "T,…")]
    stress_at: Vec<f64>,
    #[command(flatten)]
    json: JsonArgument,
}

/// Finds or computes the reference and prints its summary.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let scene = Scene::read(scene::resolve(&arguments.scene)?)?;
    if arguments.np != 1 && scene.reference.geometry == Geometry::Axisymmetric {
        return Err(Error::Usage(format!(
            "--np {}: an axisymmetric reference runs as one process",
            arguments.np
        )));
    }
    let store = context.store();
    let resolution = arguments.target_error.map_or(arguments.resolution, Resolution::Within);
    let wanted = !arguments.fresh && arguments.stress_at.is_empty();
    let stored = match wanted.then(|| store.find(&scene, resolution)) {
        Some(Lookup::Found(stored)) => {
            context.note(format_args!("found {}", stored.folder.display()));
            *stored
        }
        other => {
            if let Some(lookup @ (Lookup::Stale { .. } | Lookup::Damaged { .. })) = &other {
                context.note(format_args!("{}; computing it again", problem(&scene, resolution, lookup)));
            }
            compute(context, &scene, resolution, &store, &arguments.stress_at)?
        }
    };
    let convergence = stored.outcome.summary.convergence.as_ref();
    if let Some(reached) = convergence.and_then(|c| c["relative_error"].as_f64()) {
        context.note(format_args!("95 % band of efficiency and force peaks: {:.2} %", 100.0 * reached));
    }
    if arguments.json.json {
        super::print_json(&stored.outcome.summary)?;
    } else {
        super::print(&super::reduced::table(&stored.outcome.summary))?;
    }
    Ok(ExitStatus::Pass)
}

/// What is wrong with what the store has.
pub fn problem(scene: &Scene, resolution: Resolution, lookup: &Lookup) -> String {
    let which = format!("the {resolution} reference of `{}`", scene.name);
    match lookup {
        Lookup::Found(_) => format!("{which} is there"),
        Lookup::Missing => format!("{which} is missing"),
        Lookup::Stale { reason } => format!("{which} is stale: {reason}"),
        Lookup::Damaged { file, reason } => format!("{which} is damaged: {}: {reason}", file.display()),
    }
}

/// Computes the reference with a progress bar and puts it into the store.
pub fn compute(
    context: &Context,
    scene: &Scene,
    resolution: Resolution,
    store: &Store,
    stress_at: &[f64],
) -> Result<Stored> {
    let bar = Bar::new(context, &format!("{} ({resolution})", scene.name));
    let stored =
        crate::reference::solve(scene, resolution, store, stress_at, &mut |progress| bar.show(progress))?;
    drop(bar);
    context.note(format_args!("computed {}", stored.folder.display()));
    Ok(stored)
}
