//! `impactcheck reference`: finds the stored finite-element solution of a scene, or computes it.

use super::progress::Bar;
use super::{Context, JsonArgument};
use crate::comparison::contradictions;
use crate::error::{Error, ExitStatus, Result};
use crate::reference::{Lookup, Resolution, Store, Stored, TargetError, Wish};
use crate::scene::{Geometry, Scene};
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// Most processes, threads or instants that the solver takes.
const MOST: i64 = 100_000;

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Arguments {
    #[command(subcommand)]
    import: Option<Import>,
    /// Scene file, name of a shipped scene, or `-` for standard input
    #[arg(required = true)]
    scene: Option<String>,
    /// Resolution of the mesh: coarse, paper (standard) or fine
    #[arg(long, default_value = "paper")]
    resolution: Resolution,
    /// Solver: this project's, or CalculiX (`ccx`) as an independent one (dry impacts of elastic spheres on a plate or a body)
    #[arg(long, value_enum, default_value_t = Solver::Fenicsx)]
    solver: Solver,
    /// Refine until the uncertainty (95 %) of efficiency and peak forces is at most this, such as 0.2%
    #[arg(long, value_name = "ERROR", conflicts_with = "resolution")]
    target_error: Option<TargetError>,
    /// Number of processes (three-dimensional references only)
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST))]
    np: u32,
    /// Processor cores for the time loop, all processes together [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST))]
    threads: Option<u32>,
    /// Compute even if a solution is stored
    #[arg(long)]
    fresh: bool,
    /// Write stress fields (.vtu) at these times in s
    #[arg(long, value_delimiter = ',', value_name = "T,…")]
    stress_at: Vec<f64>,
    /// Write at least this many fields over the run (.vtu, and .pvd for ParaView)
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=MOST))]
    fields: u32,
    #[command(flatten)]
    json: JsonArgument,
}

/// The programs that make references: `fem_reference` on FEniCSx, and `ccx`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Solver {
    Fenicsx,
    Calculix,
}

#[derive(Debug, Subcommand)]
enum Import {
    /// Import another program's result as the reference `--resolution imported`
    #[command(
        after_help = "Example: impactcheck reference import my-impact.toml --from abaqus.csv --map examples/import/abaqus.toml"
    )]
    Import(ImportArguments),
}

#[derive(Debug, Args)]
struct ImportArguments {
    /// Scene file, or name of a shipped scene
    scene: String,
    /// Result file: a text table (.csv, .rpt, ...), or CalculiX's .dat or .frd
    #[arg(long, value_name = "FILE")]
    from: PathBuf,
    /// Description of the table (TOML): columns, units, signs, offsets, program, uncertainty [default: headings such
    /// as `time [us],outer_velocity [mm/s]`]
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgument,
}

/// Imports a reference and prints its summary.
fn import(context: &Context, arguments: &ImportArguments) -> Result<ExitStatus> {
    let (file, scene) = super::read_scene(&arguments.scene)?;
    let store = context.store().for_scene_in(&file);
    let stored = crate::comparison::import(&scene, &arguments.from, arguments.map.as_deref(), &store)?;
    context
        .note(format_args!("imported {}; compare with it: --resolution imported", stored.folder.display()));
    if stored.outcome.summary.uncertainty.is_empty() {
        context.note("its uncertainty is not stated: whatever differs from it may be its own error");
    }
    show(&stored, arguments.json)
}

fn show(stored: &Stored, json: JsonArgument) -> Result<ExitStatus> {
    json.print(&stored.outcome.summary, |summary| super::reduced::table(summary, |_| true))?;
    Ok(ExitStatus::Pass)
}

/// Finds or computes the reference and prints its summary.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    if let Some(Import::Import(arguments)) = &arguments.import {
        return import(context, arguments);
    }
    let (file, scene) = super::read_scene(arguments.scene.as_deref().unwrap_or_default())?;
    if arguments.np != 1 && scene.reference.geometry == Geometry::Axisymmetric {
        return Err(Error::Usage(format!(
            "--np {}: an axisymmetric reference runs as one process",
            arguments.np
        )));
    }
    let (scene, store) = (&scene, &context.store().for_scene_in(&file));
    let resolution = resolution(arguments)?;
    let use_stored = !arguments.fresh && arguments.stress_at.is_empty() && arguments.fields == 0;
    let stored = match use_stored.then(|| store.find(scene, resolution)) {
        Some(Lookup::Found(stored)) => {
            context.note(format_args!("found {}", stored.folder.display()));
            require_sound(scene, &stored)?;
            *stored
        }
        Some(lookup @ Lookup::Damaged { .. }) => {
            let problem = problem(scene, resolution, &lookup);
            return Err(Error::Reference(problem).hint(["add `--fresh` to compute it again".into()]));
        }
        other if resolution == Resolution::Imported => {
            let lookup = other.unwrap_or(Lookup::Missing);
            let problem = problem(scene, resolution, &lookup);
            return Err(
                Error::Reference(problem).hint(["import one with `impactcheck reference import`".into()])
            );
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
        context
            .note(format_args!("uncertainty (95 %) of efficiency and peak forces: {:.2} %", 100.0 * reached));
    }
    for warning in &stored.outcome.summary.warnings {
        context.note(format_args!("warning: {warning}"));
    }
    show(&stored, arguments.json)
}

/// Which reference is asked for.
fn resolution(arguments: &Arguments) -> Result<Resolution> {
    let own = arguments.target_error.map_or(arguments.resolution, Resolution::Within);
    match arguments.solver {
        Solver::Fenicsx => Ok(own),
        Solver::Calculix => own.by_calculix().ok_or_else(|| {
            Error::Usage(format!(
                "--solver calculix has the resolutions coarse, paper and fine, not {}",
                own.argument()
            ))
        }),
    }
}

/// That a solution is consistent with itself and its scene, as every comparison asks.
///
/// # Errors
/// [`Error::Reference`] that names what is not.
pub(super) fn require_sound(scene: &Scene, stored: &Stored) -> Result<()> {
    let broken = contradictions(scene, &stored.outcome);
    if broken.is_empty() {
        return Ok(());
    }
    let message =
        format!("{} contradicts itself or its scene:\n  {}", stored.folder.display(), broken.join("\n  "));
    Err(Error::Reference(message).hint(["add `--fresh` to compute it again".into()]))
}

/// What is wrong with what the store has.
pub fn problem(scene: &Scene, resolution: Resolution, lookup: &Lookup) -> String {
    let which = format!("the reference of `{}` (resolution `{}`)", scene.name, resolution.argument());
    match lookup {
        Lookup::Found(_) => format!("{which} is there"),
        Lookup::Missing => format!("{which} is missing: it is not computed yet"),
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
