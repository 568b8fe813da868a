//! `impactcheck coverage`: which features of scenes are compared with an independent solution.

use super::external::{self, Permission};
use super::requested_model::RequestedModel;
use super::{Context, JsonArgument, compare_inputs, kinds};
use crate::comparison::compare_scene;
use crate::coverage::{CLOSED_FORM, Case, Coverage, Finding, coverage, exact};
use crate::error::{ExitStatus, Result};
use crate::reference::{Resolution, Store, Stored};
use crate::result::{Outcome, Source};
use crate::scene::{self, Model, Scene};
use crate::validated::{self, Validation};
use clap::Args;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene files or names of shipped scenes [default: all scenes of the project]
    scenes: Vec<String>,
    #[command(flatten)]
    permission: Permission,
    /// Update the project's record of compared scenes. Where a reference is not stored here, the models are updated
    /// and its recorded values kept
    #[arg(long)]
    record: bool,
    #[command(flatten)]
    json: JsonArgument,
}

/// Compares every model with every stored reference and tells what that covers; nothing is computed but the models. Of
/// references that are not here it knows the numbers that are recorded.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let scenes = compare_inputs::scenes_or(&arguments.scenes, scene::every)?;
    let (known, mut cases, mut found) = (validated::shipped()?, Vec::new(), Vec::new());
    for (file, scene) in &scenes {
        let store = context.store().for_scene_in(file);
        let stored: Vec<Stored> =
            finest(&store, scene).into_iter().chain(of_other_programs(&store, scene)).collect();
        let programs = match arguments.permission.is_given() {
            true => external::results(context, file, scene, None),
            false => Vec::new(),
        };
        let kind = crate::kinds::of(scene);
        for &model in kind.models().iter().filter(|model| kind.has_form(scene, **model)) {
            let mut validations: Vec<Validation> =
                stored.iter().filter_map(|stored| compared(context, scene, stored, model)).collect();
            if !stored.iter().any(|stored| stored.outcome.summary.source == Source::Reference) {
                let here: Vec<String> = validations.iter().map(|v| v.partner.clone()).collect();
                let recorded = known.iter().filter(|v| v.is_of(scene, model) && !here.contains(&v.partner));
                validations.extend(recorded.map(|v| renewed(context, v, scene, model)));
            }
            validations.extend(compared_with_programs(scene, &programs, model));
            if !validations.is_empty() || kinds::of(scene).takes(scene, model) {
                cases.extend(Case::of_all(scene, model, validations.iter().map(Finding::from)));
            }
            found.extend(validations);
        }
        cases.extend(exact(scene)?);
    }
    if arguments.record {
        validated::record(&found)?;
    }
    let found = coverage(&cases);
    let named = !arguments.scenes.is_empty();
    arguments.json.print(&found, |found| table(found, named))?;
    Ok(ExitStatus::Pass)
}

/// The solution of `scene` on the finest mesh that is stored.
fn finest(store: &Store, scene: &Scene) -> Option<Stored> {
    let shipped = Store::shipped().ok();
    let dofs = |stored: &Stored| stored.outcome.summary.mesh.as_ref().and_then(|mesh| mesh["dofs"].as_u64());
    [Some(store), shipped.as_ref()].into_iter().flatten().find_map(|store| {
        let resolutions = store.resolutions(scene).into_iter();
        let own = resolutions.filter(|resolution| !resolution.is_of_another_program());
        own.filter_map(|resolution| store.find(scene, resolution).found()).max_by_key(dofs)
    })
}

/// What CalculiX says of `scene`, and what was imported.
fn of_other_programs(store: &Store, scene: &Scene) -> impl Iterator<Item = Stored> {
    let calculix = [Resolution::Fine, Resolution::Paper].into_iter().filter_map(Resolution::by_calculix);
    let found = |resolution| store.find_here_or_shipped(scene, resolution).found();
    calculix.into_iter().find_map(found).into_iter().chain(found(Resolution::Imported))
}

/// `model` against the scene's programs, as far as they have results.
fn compared_with_programs(scene: &Scene, programs: &[Outcome], model: Model) -> Vec<Validation> {
    let sound = programs.iter().filter(|program| program.summary.failure.is_none());
    let own = kinds::of(scene).alone(scene, (&[RequestedModel::Named(model)], None)).unwrap_or_default();
    sound.flat_map(|program| Validation::of(scene, &compare_scene(scene, program, &own))).collect()
}

/// `model` against a stored reference; `None` if it does not take the scene, which is reported.
fn compared(context: &Context, scene: &Scene, stored: &Stored, model: Model) -> Option<Validation> {
    match kinds::of(scene).with_reference(context, scene, stored, (&[RequestedModel::Named(model)], None)) {
        Ok((reduced, _)) => Validation::of(scene, &compare_scene(scene, &stored.outcome, &reduced)).pop(),
        Err(error) => {
            context.note(format_args!("{}: model {model}: {error}", scene.name));
            None
        }
    }
}

/// What `recorded` says of the reference beside the model as it is now, if that can be run without the reference.
fn renewed(context: &Context, recorded: &Validation, scene: &Scene, model: Model) -> Validation {
    match kinds::of(scene).alone(scene, (&[RequestedModel::Named(model)], None)) {
        Ok(now) => now.first().map_or_else(|| recorded.clone(), |now| recorded.renewed(&now.summary)),
        Err(error) => {
            context.note(format_args!("{}: model {model}: {error}", scene.name));
            recorded.clone()
        }
    }
}

/// The coverage in lines; of `named` scenes the features that they have.
fn table(found: &Coverage, named: bool) -> String {
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    let mut lines = vec![format!(
        "{:<28} {:<6} {:<14} {:>6}  {}",
        "feature",
        "model",
        "compared with",
        "scenes",
        "largest difference (uncertainty of the comparator, 95 %)"
    )];
    for feature in &found.features {
        let mut name = feature.feature;
        if feature.partners.is_empty() && !named {
            lines.push(format!("{name:<28} no scene has it, or no model takes it"));
        }
        for row in &feature.partners {
            let difference = row.worst_relative.map_or(String::new(), |relative| {
                let quantity = row.quantity.as_deref().unwrap_or_default();
                if row.partner.as_deref() == Some(CLOSED_FORM) {
                    return format!("{relative:.0e}, {quantity}");
                }
                let band = row.band.map_or("unknown".to_owned(), percent);
                format!("{} ({band}), {quantity}", percent(relative))
            });
            let comparator = row.partner.as_deref().unwrap_or("nothing");
            let scenes = row.scenes.len();
            let line = format!("{name:<28} {:<6} {comparator:<14} {scenes:>6}  {difference}", row.model);
            lines.push(line.trim_end().to_owned());
            name = "";
        }
    }
    lines.join("\n")
}
