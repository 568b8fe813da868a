//! `impactcheck optimise`: the numbers of a scene with which most is transmitted, or another result is largest.

use super::reference::compute;
use super::{Context, JsonArgument};
use crate::comparison::{ModelComparison, compare_scene};
use crate::error::{Error, ExitStatus, Result};
use crate::file::write_file;
use crate::format::{measure, quantity, words};
use crate::kinds;
use crate::optimise::{Confirmation, Objective, Optimum, Problem, Robust, Variable, Watch, confirm};
use crate::reference::{self, Resolution, Stored, Wish};
use crate::report;
use crate::result::Summary;
use crate::scene::{self, Model, Scene, Template};
use clap::Args;
use serde::Serialize;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file, or name of a shipped scene
    scene: String,
    /// Variable and bounds, such as plate.radius=2mm..10mm; repeat for several variables. Fields joined by commas
    /// take the same value
    #[arg(long, required = true, value_name = "FIELD=LOW..HIGH")]
    over: Vec<String>,
    /// Quantity to maximise: one of `reduced --json`, or intended_speed (seal seat: velocity of the sphere in the
    /// intended direction) [default: efficiency; seal seat: intended_speed]
    #[arg(long, value_name = "NAME")]
    objective: Option<String>,
    /// Seal seat: largest angle between the sphere's velocity and the intended direction
    #[arg(long, value_name = "ANGLE")]
    within: Option<String>,
    /// Seal seat: mesh (.vtu) that is adapted to the dimensions [default: a coarse one]
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Reduced model [default: the scene's, or B where there is one]
    #[arg(long)]
    model: Option<Model>,
    /// Number of modes [default: as in `reduced`]
    #[arg(long, value_name = "N")]
    modes: Option<usize>,
    /// Seed of the samples, for several variables
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of samples [default: from the number of variables]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(8..=100_000))]
    samples: Option<u32>,
    /// Robust design: maximise this quantile of the efficiency under the scene's [uncertainty] [default quantile: 5%]
    #[arg(long, value_name = "QUANTILE", num_args = 0..=1, default_missing_value = "5%", value_parser = probability)]
    robust: Option<f64>,
    /// Compare the optimum with its finite-element reference, stored or computed (needs FEniCSx)
    #[arg(long)]
    verify: bool,
    /// Resolution of that reference
    #[arg(long, default_value = "paper")]
    resolution: Resolution,
    /// Folder for the optimum (JSON, SVG, PNG) and its scene (TOML)
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgument,
}

/// The document of `optimise --json`.
#[derive(Debug, Serialize)]
pub(super) struct OptimumDocument {
    #[serde(flatten)]
    pub(super) optimum: Optimum,
    /// What model C says, if another one searched.
    #[serde(skip_serializing_if = "Option::is_none")]
    confirmation: Option<Confirmation>,
    #[serde(skip_serializing_if = "Option::is_none")]
    verification: Option<Verification>,
}

/// The reference's verdict on the optimum.
#[derive(Debug, Serialize)]
struct Verification {
    /// The verdict of the comparison with the scene's tolerances, "missing" without a reference.
    verdict: &'static str,
    /// Why there is no reference.
    #[serde(skip_serializing_if = "Option::is_none")]
    missing: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<Box<Summary>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<Box<ModelComparison>>,
}

/// Parses the probability of a quantile, as a number or in percent.
fn probability(text: &str) -> std::result::Result<f64, String> {
    let value = scene::quantity_in(text, "1")?;
    if (0.01..=0.99).contains(&value) { Ok(value) } else { Err(format!("{text} is not within 1 % to 99 %")) }
}

/// What a search found.
pub(super) struct Solved {
    pub(super) problem: Problem,
    pub(super) document: OptimumDocument,
    /// The exit status of a verification without verdict.
    failure: Option<ExitStatus>,
}

/// Searches the optimum, verifies it if asked to, prints it.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let template = Template::read(scene::resolve(&arguments.scene)?)?;
    let Solved { document, failure, .. } = solve(context, arguments, template, &|_| true)?;
    arguments.json.print(&document, table)?;
    Ok(failure.unwrap_or(ExitStatus::Pass))
}

/// The optimum of the scene in `template`, which is believed rather than the one that `arguments` name; written if asked to.
pub(super) fn solve(
    context: &Context,
    arguments: &Arguments,
    template: Template,
    watch: &Watch,
) -> Result<Solved> {
    let mesh = reference::mesh_to_follow(template.scene(), arguments.mesh.as_deref())?;
    if let Some(mesh) = &mesh {
        context.note(format_args!("mesh {}", mesh.path().display()));
    }
    let own = kinds::of(template.scene()).models();
    let usual = own.iter().find(|model| **model == Model::B).or(own.last()).copied();
    let model = arguments.model.or(template.scene().reduced.model).or(usual).unwrap_or(Model::B);
    let within =
        arguments.within.as_ref().map(|text| template.field("intended.angle")?.parse(text)).transpose()?;
    let objective = Objective::of(arguments.objective.as_deref(), within, template.scene())?;
    let variables =
        arguments.over.iter().map(|text| Variable::parse(text, &template)).collect::<Result<Vec<_>>>()?;
    if let Some(folder) = &arguments.out {
        report::check_writable(folder)?;
    }
    let robust =
        arguments.robust.map(|quantile| Robust::new(&template, quantile, arguments.seed)).transpose()?;
    let models = (model, arguments.modes);
    let problem = Problem::new(template, variables, objective, models, mesh.as_ref(), robust)?;
    let optimum = problem.solve(arguments.seed, arguments.samples.map(|n| n as usize), watch)?;
    let confirmation = confirm(&problem, &optimum).unwrap_or_else(|error| {
        context.note(format_args!("warning: model C can't confirm the optimum: {error}"));
        None
    });
    let mut failure = None;
    let verification = if arguments.verify {
        let verification = verify(context, arguments, &problem, &optimum);
        if let Err(error) = &verification {
            context.note(format_args!("no verdict of the reference: {error}"));
        }
        Some(verification.unwrap_or_else(|error| {
            let missing = Some(error.to_string());
            failure = Some(error.exit_status());
            Verification { verdict: "missing", missing, reference: None, model: None }
        }))
    } else {
        None
    };
    let document = OptimumDocument { optimum, confirmation, verification };
    if let Some(folder) = &arguments.out {
        write(context, folder, &problem, &document)?;
    }
    Ok(Solved { problem, document, failure })
}

fn verify(
    context: &Context,
    arguments: &Arguments,
    problem: &Problem,
    optimum: &Optimum,
) -> Result<Verification> {
    let scene = problem.scene(&optimum.values())?;
    let stored = reference_of(context, arguments, &scene)?;
    let outcome = problem.outcome(&optimum.values())?;
    let model = compare_scene(&scene, &stored.outcome, &[outcome]).models.pop();
    let model = model.ok_or_else(|| Error::Internal("one model was compared".into()))?;
    Ok(Verification {
        verdict: model.verdict.name(),
        missing: None,
        reference: Some(Box::new(stored.outcome.summary)),
        model: Some(Box::new(model)),
    })
}

fn reference_of(context: &Context, arguments: &Arguments, scene: &Scene) -> Result<Stored> {
    let store = context.store();
    match store.find_here_or_shipped(scene, arguments.resolution).found() {
        Some(stored) => Ok(stored),
        None => compute(context, scene, arguments.resolution, &store, &Wish::default()),
    }
}

fn write(context: &Context, folder: &Path, problem: &Problem, document: &OptimumDocument) -> Result<()> {
    let svg = document.optimum.figure();
    let json = serde_json::to_string_pretty(document)
        .map_err(|e| Error::Internal(format!("writing the optimum as JSON: {e}")))?;
    let files = [
        ("optimum.json", (json + "\n").into_bytes()),
        ("history.csv", document.optimum.history_csv()?),
        ("optimum.toml", problem.scene_text(&document.optimum.values())?.into_bytes()),
        ("optimum.png", crate::plot::png(&svg, 3.0)?),
        ("optimum.svg", svg.into_bytes()),
    ];
    for (name, bytes) in files {
        write_file(&folder.join(name), &bytes)?;
    }
    context.note(format_args!("wrote {}", folder.join("optimum.svg").display()));
    Ok(())
}

/// The best in words.
fn reached(optimum: &Optimum) -> String {
    let Optimum { efficiency, objective, objective_unit, objective_value, summary, .. } = optimum;
    let efficiency = efficiency.map(|efficiency| format!("efficiency {efficiency:.5}"));
    if let (Some(efficiency), "efficiency") = (&efficiency, *objective) {
        return efficiency.clone();
    }
    let efficiency = efficiency.map(|efficiency| format!(", {efficiency}"));
    let unit = if *objective_unit == "1" { String::new() } else { format!(" {objective_unit}") };
    let angle = summary.value("sphere_angle").map(|angle| format!(", direction {:.2}°", angle.to_degrees()));
    let name = words(objective).to_lowercase();
    format!(
        "{name} {objective_value:.5}{unit}{}{}",
        angle.unwrap_or_default(),
        efficiency.unwrap_or_default()
    )
}

fn table(document: &OptimumDocument) -> String {
    let optimum = &document.optimum;
    let mut lines = vec![format!(
        "{}: {} (model {}, {} impacts{})",
        optimum.scene,
        reached(optimum),
        optimum.model,
        optimum.evaluations,
        if optimum.failures > 0 { format!(", {} without result", optimum.failures) } else { String::new() }
    )];
    if let Some(robust) = &optimum.robust {
        lines.push(format!(
            "  {} % quantile of the {} with uncertain inputs: {:.5} ({} samples of every design)",
            100.0 * robust.probability,
            words(optimum.objective).to_lowercase(),
            robust.quantile,
            robust.samples
        ));
    }
    for variable in &optimum.variables {
        let unit = variable.unit;
        let [low, high] = variable.range_within_1_percent.map(|value| quantity(value, unit, 4));
        lines.push(format!("  {} = {}", variable.field, measure(variable.optimum, unit)));
        lines.push(format!("    within 1 % of the best from {low} to {high}"));
        if let Some(curvature) = variable.curvature {
            lines.push(format!(
                "    second derivative of the {} {curvature:.3e} per ({unit})^2",
                words(optimum.objective).to_lowercase()
            ));
        }
        match variable.extreme {
            Some(extreme) => lines.push(format!("    on the {extreme} permitted value")),
            None if variable.on_bound => lines.push("    on a bound: a better value may lie outside".into()),
            None => {}
        }
    }
    if let Some(confirmation) = &document.confirmation {
        lines.push(confirmed(optimum, confirmation));
    }
    if let Some(verification) = &document.verification {
        lines.push(match (&verification.reference, &verification.missing) {
            (Some(reference), _) => format!(
                "  reference: efficiency {}; verdict on the model there: {}",
                reference.value("efficiency").map_or("not determined".into(), |value| format!("{value:.5}")),
                verification.verdict
            ),
            (_, missing) => format!("  reference: missing; {}", missing.as_deref().unwrap_or_default()),
        });
    }
    lines.join("\n")
}

/// What model C says of the optimum, in a sentence.
fn confirmed(optimum: &Optimum, confirmation: &Confirmation) -> String {
    let there = confirmation.efficiency;
    let off = 100.0 * (there / optimum.efficiency.unwrap_or(f64::NAN) - 1.0);
    let own = format!("  model C there: efficiency {there:.5} ({off:+.1} %)");
    match &confirmation.rival {
        Some(rival) if !confirmation.confirmed => {
            format!(
                "{own}, and {:.5} at {} = {}: the optimum of model {} is not confirmed; search with --model C",
                rival.efficiency,
                rival.field,
                quantity(rival.value, rival.unit, 4),
                optimum.model
            )
        }
        Some(rival) => format!("{own}; the best of other peaks and bounds is {:.5}", rival.efficiency),
        None => own,
    }
}
