//! `impactcheck reference`: finds the stored finite-element solution of a scene, or computes it.

use super::progress::Bar;
use super::{Context, JsonArgument};
use crate::comparison::{self, Verdict};
use crate::error::{Error, ExitStatus, Result};
use crate::reference::{Lookup, Resolution, Store, Stored, TargetError, Wish};
use crate::scene::{Geometry, Scene};
use clap::Args;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file, the name of a shipped scene, or `-` for standard input
    scene: String,
    /// How fine the mesh is: coarse, paper or fine
    #[arg(long, default_value = "paper")]
    resolution: Resolution,
    /// Refine until the 95 % band of efficiency and force peaks is at most this, for example 0.2%
    #[arg(long, value_name = "ERROR", conflicts_with = "resolution")]
    target_error: Option<TargetError>,
    /// Number of processes (three-dimensional references only)
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    np: u32,
    /// Processor cores for the time loop, all processes together [default: those there are]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    threads: Option<u32>,
    /// Compute even if there is a stored solution
    #[arg(long)]
    fresh: bool,
    /// Write stress fields (.vtu) at these times, in s
    #[arg(long, value_delimiter = ',', value_name = "T,…")]
    stress_at: Vec<f64>,
    /// Write fields (.vtu and a .pvd series) at this many instants over the run, or somewhat more
    #[arg(long, default_value_t = 0, value_name = "N")]
    fields: u32,
    #[command(flatten)]
    json: JsonArgument,
}

/// Finds or computes the reference and prints its summary.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let (file, scene) = super::read_scene(&arguments.scene)?;
    if arguments.np != 1 && scene.reference.geometry == Geometry::Axisymmetric {
        return Err(Error::Usage(format!(
            "--np {}: an axisymmetric reference runs as one process",
            arguments.np
        )));
    }
    let (scene, store) = (&scene, &context.store().for_scene_in(&file));
    let resolution = arguments.target_error.map_or(arguments.resolution, Resolution::Within);
    let wanted = !arguments.fresh && arguments.stress_at.is_empty() && arguments.fields == 0;
    let stored = match wanted.then(|| store.find(scene, resolution)) {
        Some(Lookup::Found(stored)) => {
            context.note(format_args!("found {}", stored.folder.display()));
            require_sound(scene, &stored)?;
            *stored
        }
        Some(lookup @ Lookup::Damaged { .. }) => {
            let problem = problem(scene, resolution, &lookup);
            return Err(Error::Reference(format!("{problem}; `--fresh` computes it again")));
        }
        other => {
            if let Some(lookup @ Lookup::Stale { .. }) = &other {
                context.note(format_args!("{}; computing it again", problem(scene, resolution, lookup)));
            }
            if let (Some(Lookup::Missing), Ok(Lookup::Found(shipped))) =
                (&other, Store::shipped().map(|shipped| shipped.find(scene, resolution)))
            {
                context.note(format_args!(
                    "computing it for {}; comparisons would find {} as well",
                    store.root().display(),
                    shipped.folder.display()
                ));
            }
            let wish = Wish {
                stress_at: arguments.stress_at.clone(),
                fields: arguments.fields,
                processes: arguments.np,
                threads: arguments.threads.unwrap_or(0),
            };
            compute(context, scene, resolution, store, &wish)?
        }
    };
    let convergence = stored.outcome.summary.convergence.as_ref();
    if let Some(reached) = convergence.and_then(|c| c["relative_error"].as_f64()) {
        context.note(format_args!("95 % band of efficiency and force peaks: {:.2} %", 100.0 * reached));
    }
    for warning in &stored.outcome.summary.warnings {
        context.note(format_args!("warning: {warning}"));
    }
    if arguments.json.json {
        super::print_json(&stored.outcome.summary)?;
    } else {
        super::print(&super::reduced::table(&stored.outcome.summary))?;
    }
    Ok(ExitStatus::Pass)
}

/// That a solution is consistent with itself and its scene, as every comparison asks.
///
/// # Errors
/// [`Error::Reference`] that names what is not.
fn require_sound(scene: &Scene, stored: &Stored) -> Result<()> {
    let checks = comparison::integrity(scene, &stored.outcome);
    let broken = checks.iter().filter(|check| check.verdict == Verdict::Fail);
    let broken: Vec<String> = broken
        .map(|c| {
            format!(
                "{}: {:.6e} instead of {:.6e} {} (± {:.1e})",
                c.check, c.found, c.expected, c.unit, c.bound
            )
        })
        .collect();
    if broken.is_empty() {
        return Ok(());
    }
    Err(Error::Reference(format!(
        "{} contradicts itself or its scene; `--fresh` computes it again\n  {}",
        stored.folder.display(),
        broken.join("\n  ")
    )))
}

/// What is wrong with what the store has.
pub fn problem(scene: &Scene, resolution: Resolution, lookup: &Lookup) -> String {
    let which = format!("the {} reference of `{}`", resolution.argument(), scene.name);
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
    wish: &Wish,
) -> Result<Stored> {
    let python = crate::reference::python()?;
    let bar = Bar::new(context, &format!("{} ({resolution})", scene.name));
    let stored = crate::reference::solve_with(&python, scene, resolution, store, wish, &mut |p| bar.show(p))?;
    drop(bar);
    context.note(format_args!("computed {}", stored.folder.display()));
    if let Some(earlier) = &stored.earlier {
        context.note(format_args!(
            "what was there, of another scene named `{}` or with other settings, is kept in {}",
            scene.name,
            earlier.display()
        ));
    }
    Ok(stored)
}
