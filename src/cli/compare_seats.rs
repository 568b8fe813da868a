//! The seal-seat scenes of `compare` and `gate`: the reduced model on the very mesh of the stored reference.

use super::Context;
use super::compare::Arguments;
use crate::body::cache::Cache;
use crate::comparison::compare_scene;
use crate::error::{Error, Result};
use crate::impact::seal_seat::{DEFAULT_TOLERANCE, SeatMesh, SeatModel};
use crate::impact::{Outcome, SeatQuantities};
use crate::project::project_root;
use crate::reference::{Lookup, Stored, Wish};
use crate::report::{Cost, SeatReport};
use crate::scene::{Model, Scene};
use std::path::Path;

/// Name of the series of fields in the folder of a reference.
const ANIMATION: &str = "stress.pvd";

/// Compares every one of `scenes` with its reference.
///
/// # Errors
/// [`Error::Usage`] if the models asked for have none of a seal seat, [`Error::Reference`] naming every reference that
/// can't be used, [`Error::Solver`].
pub fn reports(context: &Context, arguments: &Arguments, scenes: &[Scene]) -> Result<Vec<SeatReport>> {
    if scenes.is_empty() {
        return Ok(Vec::new());
    }
    if !arguments.models.contains(&Model::C) {
        let names: Vec<String> = arguments.models.iter().map(Model::to_string).collect();
        return Err(Error::Usage(format!(
            "--models {}: scene `{}` is a seal seat, which has model C only",
            names.join(","),
            scenes[0].name
        )));
    }
    let references = references(context, arguments, scenes)?;
    scenes.iter().zip(references).map(|(scene, stored)| report(scene, stored)).collect()
}

fn report(scene: &Scene, stored: Stored<SeatQuantities>) -> Result<SeatReport> {
    let mesh = SeatMesh::open(&stored.folder.join("mesh.vtu"))?;
    let model = SeatModel::new(scene, Model::C, None, &mesh, &Cache::from_environment())?;
    let (summary, history) = model.run_with_history(DEFAULT_TOLERANCE)?;
    let reduced = vec![Outcome { summary, history }];
    let animation = Some(stored.folder.join(ANIMATION)).filter(|file| file.is_file());
    // as others find it, who have the project elsewhere
    let root = project_root();
    let animation = animation.map(|file| file.strip_prefix(&root).map(Path::to_path_buf).unwrap_or(file));
    Ok(SeatReport {
        scene: scene.clone(),
        comparison: compare_scene(scene, &stored.outcome, &reduced),
        reference: stored.outcome,
        reduced,
        cost: vec![Cost { setup_seconds: model.setup_seconds, dofs: model.dofs }],
        provenance: stored.provenance,
        animation,
        command: format!("impactcheck compare {}", scene.name),
    })
}

/// The references of all scenes, or one error that names every one that can't be used.
fn references(
    context: &Context,
    arguments: &Arguments,
    scenes: &[Scene],
) -> Result<Vec<Stored<SeatQuantities>>> {
    let store = context.store();
    let (mut found, mut problems) = (Vec::new(), Vec::new());
    for scene in scenes {
        match store.find_as::<SeatQuantities>(scene, arguments.resolution) {
            Lookup::Found(stored) => found.push(*stored),
            Lookup::Missing | Lookup::Stale { .. } if arguments.compute => {
                let wish = Wish::default();
                found.push(super::reference::compute_as(
                    context,
                    scene,
                    arguments.resolution,
                    &store,
                    &wish,
                )?);
            }
            other => problems.push(super::reference::problem(scene, arguments.resolution, &other)),
        }
    }
    if problems.is_empty() {
        return Ok(found);
    }
    problems.push("compute references with `impactcheck reference SCENE` or `--compute`".into());
    Err(Error::Reference(problems.join("\n  ")))
}
