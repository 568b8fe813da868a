//! What the commands compute, for programs that hold scenes in memory, as the Python package does: the same models, defaults,
//! bounds and sentences; nothing is printed.

pub use super::predicted::PredictedSummary;
pub use super::requested_model::ModelRequest;
pub use super::requested_model::RequestedModel;

use super::compare_arguments::Arguments;
use super::comparison_job::Job;
use super::optimise::{self, Solved};
use super::record_map::RecordMap;
use super::requested_model::within_bounds;
use super::{Context, compare_inputs, kinds, stored_references};
use crate::comparison::Comparison;
use crate::error::{Error, Result};
use crate::kinds::SharedBodies;
use crate::measured::Speed;
use crate::optimise::Watch;
use crate::prediction::Prediction;
use crate::reference::Resolution;
use crate::report::{self, Theme};
use crate::result::{Outcome, Summary};
use crate::scene::{Scene, Template};
use clap::Args;
use std::path::PathBuf;

const QUIET: Context = Context { store: None, quiet: true, verbose: false };

/// What `impactcheck reduced` computes of `scene`, one of a series of impacts that share `bodies`.
///
/// # Errors
/// Those of the command.
pub fn reduced(scene: &Scene, request: &ModelRequest, bodies: &SharedBodies) -> Result<Outcome> {
    if let Some(tolerance) = request.tolerance {
        within_bounds(tolerance, &format!("tolerance {tolerance}")).map_err(Error::Usage)?;
    }
    kinds::of(scene).reduced(&QUIET, scene, request, bodies, true)
}

/// What a reference of `scene` would find, whose model has the `summary`.
pub fn predicted(scene: &Scene, request: &ModelRequest, summary: &Summary) -> Prediction {
    super::predicted::predicted(&QUIET, scene, request, summary)
}

/// A scene and its file, which is empty if there is none.
pub type Placed = (PathBuf, Scene);

/// The stored reference of a scene; if it is missing and may be computed, a new one.
///
/// # Errors
/// Those of `impactcheck reference`.
pub fn reference(scene: Placed, resolution: Resolution, compute: bool) -> Result<Outcome> {
    let mut found = stored_references::look_up(&QUIET, resolution, compute, &[scene])?;
    found.pop().map(|stored| stored.outcome).ok_or_else(|| Error::Internal("a reference was found".into()))
}

/// What a comparison may differ in from that of `impactcheck compare` without options.
#[derive(Debug)]
pub struct Comparing {
    /// The models.
    pub models: Vec<RequestedModel>,
    /// The reference's.
    pub resolution: Resolution,
    /// Whether references that are missing are computed.
    pub compute: bool,
    /// Whether the programs that scenes name may run.
    pub allow_external: bool,
    /// Folder of the report; `None` = none is written.
    pub out: Option<PathBuf>,
    /// Measured histories of the scene.
    pub measured: Vec<PathBuf>,
    /// Bandwidth of the instrument, with its unit, if it is not the usual one.
    pub bandwidth: Option<String>,
    /// Where the outer body's measured speed comes from, if not from the scene.
    pub speed: Option<Speed>,
    /// How the measured files are to be read, if that is not to be inferred.
    pub record_map: Option<PathBuf>,
}

/// A comparison, and the figure of each of its scenes as SVG.
#[derive(Debug)]
pub struct Compared {
    /// As `impactcheck compare --json` prints it.
    pub comparison: Comparison,
    /// Shape (scenes).
    pub figures: Vec<String>,
}

/// What `impactcheck compare` does with `scenes`; with none, with those shipped.
///
/// # Errors
/// Those of the command.
pub fn compare(scenes: Vec<Placed>, request: Comparing) -> Result<Compared> {
    let Comparing { models, resolution, compute, allow_external, out, measured, .. } = request;
    let Comparing { bandwidth, speed, record_map, .. } = request;
    let is_written = out.is_some();
    let mut arguments: Arguments = parsed(&[])?;
    if let Some(bandwidth) = &bandwidth {
        arguments.bandwidth = compare_inputs::bandwidth(bandwidth).map_err(Error::Usage)?;
    }
    arguments.speed = speed.unwrap_or(arguments.speed);
    arguments.measured = measured;
    arguments.record_map = RecordMap::of(record_map);
    arguments.permission.allow_external = allow_external;
    (arguments.models, arguments.resolution, arguments.compute) = (models, Some(resolution), compute);
    arguments.out = out.unwrap_or_default();
    let job =
        if scenes.is_empty() { Job::read(&QUIET, &arguments)? } else { Job::of(&QUIET, &arguments, scenes)? };
    if is_written {
        job.check_folders(&[])?;
    }
    let results = job.results(&QUIET)?;
    let comparisons = job.comparisons(&QUIET, &results)?;
    let entries = if is_written { job.trends(&comparisons, None)? } else { Vec::new() };
    let report = job.report(&QUIET, &results, comparisons, &entries)?;
    if is_written {
        job.write(&report)?;
    }
    let figures = report.scenes.iter().map(|scene| report::figure(scene, Theme::Standalone)).collect();
    Ok(Compared { comparison: report.comparison(), figures })
}

/// An optimum.
#[derive(Debug)]
pub struct Optimised {
    /// As `impactcheck optimise --json` prints it.
    pub document: serde_json::Value,
    /// As SVG.
    pub figure: String,
    /// The scene file of the best design.
    pub scene: String,
}

/// What `impactcheck optimise` does with the scene in `template` and these `options`; `watch` as [`crate::optimise::Problem::solve`] has it.
///
/// # Errors
/// Those of the command.
pub fn optimise(template: Template, options: &[String], watch: &Watch) -> Result<Optimised> {
    let name = [template.scene().name.clone()];
    let arguments: optimise::Arguments = parsed(&[&name, options].concat())?;
    let Solved { problem, document, .. } = optimise::solve(&QUIET, &arguments, template, watch)?;
    Ok(Optimised {
        figure: document.optimum.figure(),
        scene: problem.scene_text(&document.optimum.values())?,
        document: serde_json::to_value(&document).map_err(|e| Error::Internal(e.to_string()))?,
    })
}

/// The arguments of a command that is given these.
fn parsed<A: Args>(given: &[String]) -> Result<A> {
    let command = A::augment_args(clap::Command::new("impactcheck").no_binary_name(true));
    let found = command.try_get_matches_from(given).and_then(|found| A::from_arg_matches(&found));
    found.map_err(|e| {
        let text = e.to_string();
        let sentence = text.split("\n\n").next().unwrap_or_default();
        Error::Usage(sentence.strip_prefix("error: ").unwrap_or(sentence).to_owned())
    })
}

/// What the program says of an error, without its colours.
pub fn in_words(error: &Error) -> String {
    let text = super::describe(error);
    anstream::adapter::strip_str(text.strip_prefix("error: ").unwrap_or(&text)).to_string().trim().to_owned()
}
