//! Stored references that lie within a sweep: scenes that differ from the swept one in the varied fields alone.

use super::plan::Plan;
use crate::reference::{Resolution, Store};
use crate::result::Summary;
use crate::scene::Template;
use std::path::{Path, PathBuf};

/// A reference within a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct Known {
    /// Values of the sweep's parameters, SI, in their order.
    pub parameters: Vec<f64>,
    /// What the reference says, with its bands.
    pub summary: Summary,
}

/// The references of scenes beside the swept one and of shipped ones that lie within the ranges of `plan`, each once.
pub fn references(plan: &Plan, store: &Store) -> Vec<Known> {
    let folder = plan.scene_file().parent().unwrap_or(Path::new(""));
    let folder = std::fs::read_dir(if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let files = folder.into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> =
        files.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    files.extend(crate::scene::every().unwrap_or_default());
    files.sort();
    let mut found: Vec<Known> = Vec::new();
    for known in files.iter().filter_map(|file| known(plan, file, store)) {
        if found.iter().all(|other| other.summary.scene_hash != known.summary.scene_hash) {
            found.push(known);
        }
    }
    found
}

fn known(plan: &Plan, file: &Path, store: &Store) -> Option<Known> {
    let other = Template::read(file).ok()?;
    let fields: Vec<_> = plan.fields().collect();
    let mut numbers = plan.numbers(0);
    let mut parameters = Vec::new();
    for (range, _) in plan.parameters() {
        let values = fields[range.clone()].iter().map(|field| other.number(&other.field(field.path()).ok()?));
        numbers[range.clone()].copy_from_slice(&values.collect::<Option<Vec<f64>>>()?);
        parameters.push(numbers[range.start]);
    }
    let within = plan.ranges().iter().zip(&parameters).all(|(range, value)| range.contains(value));
    let here = plan.template().with(&fields.into_iter().zip(numbers).collect::<Vec<_>>()).ok()?;
    if !within || here.hash() != other.scene().hash() {
        return None;
    }
    let stored = store.for_scene_in(file).find_here_or_shipped(other.scene(), Resolution::Paper).found()?;
    Some(Known { parameters, summary: stored.outcome.summary })
}
