//! The seal-seat scenes of `compare` and `gate`: the reduced model on the very mesh of the stored reference.

use super::Context;
use super::asked_model::AskedModel;
use super::compare_inputs;
use super::progress::Bar;
use crate::body::cache::Cache;
use crate::ci::acceptance;
use crate::comparison::compare_scene;
use crate::error::{Error, Result};
use crate::kinds::seal_seat::{DEFAULT_TOLERANCE, SeatMesh, SeatModel};
use crate::project::project_root;
use crate::reference::{Resolution, Stored};
use crate::report::{Attachments, Cost, SeatReport};
use crate::result::Outcome;
use crate::result::SeatQuantities;
use crate::scene::{Model, Scene};
use std::path::Path;

/// Name of the series of fields in the folder of a reference.
const ANIMATION: &str = "stress.pvd";

/// Reference and reduced model of one scene.
pub(super) struct SeatRun {
    stored: Stored<SeatQuantities>,
    reduced: Vec<Outcome<SeatQuantities>>,
    cost: Vec<Cost>,
}

/// Refuses models that a seal seat has not.
///
/// # Errors
/// [`Error::Usage`] naming `scene`.
pub(super) fn check_models(scene: &Scene, models: &[AskedModel]) -> Result<()> {
    if models.contains(&AskedModel::Named(Model::C)) {
        return Ok(());
    }
    let names: Vec<String> = models.iter().map(AskedModel::to_string).collect();
    Err(Error::Usage(format!(
        "--models {}: scene `{}` is a seal seat, which has model C only",
        names.join(","),
        scene.name
    )))
}

/// Runs the reduced model.
pub(super) fn run(context: &Context, scene: &Scene, stored: Stored<SeatQuantities>) -> Result<SeatRun> {
    let mesh = SeatMesh::open(&stored.folder.join("mesh.vtu"))?;
    let bar = Bar::new(context, &scene.name);
    let cache = Cache::from_environment();
    let watch = &mut |part, done| bar.part(part, done);
    let model = SeatModel::new_with(scene, Model::C, None, &mesh, &cache, watch)?;
    drop(bar);
    let (summary, history) = model.run_with_history(DEFAULT_TOLERANCE)?;
    let reduced = vec![Outcome { summary, history }];
    let cost = vec![Cost { setup_seconds: model.setup_seconds, dofs: model.dofs }];
    Ok(SeatRun { stored, reduced, cost })
}

/// Compares what was run for the `scene` in `file`, whose tolerances count; `command` makes it again.
pub(super) fn report(
    file: &Path,
    scene: &Scene,
    run: &SeatRun,
    resolution: Resolution,
    command: String,
) -> Result<SeatReport> {
    let SeatRun { stored, reduced, cost } = run;
    let acceptances = acceptance::read(file)?;
    let mut comparison = compare_scene(scene, &stored.outcome, reduced);
    comparison.add_reference_checks(acceptance::checks(&acceptances, &stored.outcome.summary, resolution));
    comparison.changed_tolerances = compare_inputs::changed_tolerances(file, &acceptances)?;
    let animation = stored.folder.join(ANIMATION);
    Ok(SeatReport {
        scene: scene.clone(),
        comparison,
        reference: stored.outcome.clone(),
        reduced: reduced.clone(),
        cost: cost.clone(),
        provenance: stored.provenance.clone(),
        // what can't be drawn is left out
        section: stored.section().ok(),
        stress: stored.section_near(instant_of_peak(stored)).ok().flatten(),
        // the same on every machine, so that equal results give equal reports
        animation: animation
            .is_file()
            .then(|| animation.strip_prefix(project_root()).map(Path::to_owned).unwrap_or(animation)),
        command,
        attachments: Attachments { bands: stored.bands.clone(), acceptances, ..Attachments::default() },
    })
}

/// When the sphere's force is largest, s.
fn instant_of_peak(stored: &Stored<SeatQuantities>) -> f64 {
    let history = &stored.outcome.history;
    let forces = history.time.iter().zip(&history.sphere_force);
    forces.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0.0, |(time, _)| *time)
}
