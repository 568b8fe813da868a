//! The scenes whose results stand in a folder: those of this run, and those of earlier runs whose pages are there.

use crate::comparison::Verdict;
use crate::error::{Error, Result};
use crate::report::overview::Overview;
use crate::report::{Report, SceneReport};
use crate::result::SCHEMA_VERSION;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::Path;

/// The document of all scenes of a folder.
pub(crate) const DOCUMENT: &str = "comparison.json";
/// Where an entry of the document keeps the scene in short.
const OVERVIEW: &str = "overview";

/// A scene whose results stand in a folder.
pub(crate) struct ExistingScene {
    pub(crate) overview: Overview,
    /// Its entry of the document, if it was not part of this run.
    earlier: Option<Value>,
}

impl ExistingScene {
    /// Whether it was not part of this run.
    pub(crate) fn is_earlier(&self) -> bool {
        self.earlier.is_some()
    }

    /// When it was compared, for a column of that name, and whether in another run than this.
    pub(crate) fn date(&self) -> String {
        let compared = self.compared();
        if self.is_earlier() { format!("{compared}, kept from an earlier run") } else { compared.to_owned() }
    }

    /// The same of one that is kept, as a sentence.
    pub(crate) fn earlier(&self) -> String {
        format!("Kept from an earlier run, not compared again: compared {}.", self.compared())
    }

    fn compared(&self) -> &str {
        self.overview.compared.as_deref().unwrap_or("at an unknown time")
    }
}

/// A folder of a report: this run, and all scenes whose results stand there.
pub struct Folder<'a> {
    pub(super) report: &'a Report<'a>,
    pub(super) scenes: &'a [ExistingScene],
}

/// The document as it is written and read again.
#[derive(Serialize, Deserialize)]
struct ReportDocument {
    schema_version: u32,
    verdict: Value,
    scenes: Vec<Value>,
}

/// The scenes of `report`.
pub(crate) fn of_run(report: &Report) -> Vec<ExistingScene> {
    report.scenes.iter().map(|scene| ExistingScene { overview: Overview::of(scene), earlier: None }).collect()
}

/// The scenes of `report` in the places that they had in the document in `dir`, the others there whose pages are there, and
/// what is new. A document that can't be read keeps nothing.
pub(crate) fn in_folder(report: &Report, dir: &Path) -> Vec<ExistingScene> {
    let mut run = of_run(report);
    let mut existing = Vec::new();
    for entry in entries(dir) {
        let Ok(overview) = Overview::deserialize(&entry[OVERVIEW]) else { continue };
        match run.iter().position(|new| new.overview.scene == overview.scene) {
            Some(place) => existing.push(run.remove(place)),
            None if dir.join(format!("{}.html", overview.scene)).is_file() => {
                existing.push(ExistingScene { overview, earlier: Some(entry) });
            }
            None => {}
        }
    }
    existing.extend(run);
    existing
}

fn entries(dir: &Path) -> Vec<Value> {
    let read = std::fs::read(dir.join(DOCUMENT)).ok();
    let document = read.and_then(|text| serde_json::from_slice::<ReportDocument>(&text).ok());
    document.filter(|d| d.schema_version == SCHEMA_VERSION).map_or_else(Vec::new, |d| d.scenes)
}

/// The worst of the scenes' verdicts.
pub(crate) fn verdict(existing: &[ExistingScene]) -> Verdict {
    Verdict::worst(existing.iter().map(|scene| scene.overview.verdict))
}

/// Pretty JSON of all scenes, ending with a line break.
///
/// # Errors
/// [`Error::Internal`] if it can't be serialised.
pub(crate) fn document(report: &Report, existing: &[ExistingScene]) -> Result<String> {
    let internal = |e: serde_json::Error| Error::Internal(format!("writing the comparison as JSON: {e}"));
    let entry = |scene: &ExistingScene| {
        let is_same = |of_run: &&SceneReport| of_run.comparison.scene == scene.overview.scene;
        match (&scene.earlier, report.scenes.iter().find(is_same)) {
            (None, Some(of_run)) => {
                let mut entry = serde_json::to_value(&of_run.comparison)?;
                entry[OVERVIEW] = serde_json::to_value(&scene.overview)?;
                Ok(entry)
            }
            (earlier, _) => Ok(earlier.clone().unwrap_or_default()),
        }
    };
    let document = ReportDocument {
        schema_version: SCHEMA_VERSION,
        verdict: verdict(existing).name().into(),
        scenes: existing.iter().map(entry).collect::<std::result::Result<_, _>>().map_err(internal)?,
    };
    Ok(serde_json::to_string_pretty(&document).map_err(internal)? + "\n")
}
