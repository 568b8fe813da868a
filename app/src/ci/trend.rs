//! Results of the gate over commits, in one file of JSON lines: where did a number begin to drift?

use super::commit::{Commit, DIRTY};
use super::json_lines;
use crate::comparison::{SceneComparison, Verdict};
use crate::error::Result;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Name of the reference among the models.
const REFERENCE: &str = "reference";
/// Share of its tolerance by which a number has to have moved to be said to drift.
const DRIFT: f64 = 0.1;

/// The gated numbers of one scene and model, or of its reference, at one commit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Hash of the commit.
    pub commit: String,
    /// When the commit was made, ISO 8601.
    pub date: String,
    /// Name of the scene.
    pub scene: String,
    /// Name of the reduced model, or `reference`.
    pub model: String,
    /// Value in SI units by the name of the quantity.
    pub quantities: BTreeMap<String, f64>,
}

/// The entries of `file`, in the order they were recorded; none if it does not exist.
///
/// # Errors
/// If it can't be read; names the line.
pub fn read(file: &Path) -> Result<Vec<Entry>> {
    json_lines::read(file)
}

/// Adds the gated numbers of `scenes` to `file`. What was recorded before for the same commit, scene and model is
/// replaced, and what was recorded before the files were committed goes.
///
/// # Errors
/// If the file can't be read or written.
pub fn record(file: &Path, scenes: &[SceneComparison], commit: &Commit) -> Result<Vec<Entry>> {
    let mut entries = read(file)?;
    for new in scenes.iter().flat_map(|scene| entries_of(scene, commit)) {
        let belongs = |e: &Entry| e.scene == new.scene && e.model == new.model;
        entries.retain(|e| e.commit == new.commit || !belongs(e) || !e.commit.ends_with(DIRTY));
        match entries.iter_mut().find(|e| belongs(e) && e.commit == new.commit) {
            Some(old) => *old = new,
            None => entries.push(new),
        }
    }
    json_lines::write(file, &entries)?;
    Ok(entries)
}

fn entries_of(scene: &SceneComparison, commit: &Commit) -> Vec<Entry> {
    let entry = |model: &str, quantities| Entry {
        commit: commit.hash.clone(),
        date: commit.date.clone(),
        scene: scene.scene.clone(),
        model: model.to_owned(),
        quantities,
    };
    let mut of_reference = BTreeMap::new();
    let mut entries = Vec::new();
    for model in &scene.models {
        let gated = || model.discrepancies.iter().filter(|row| row.tolerance.is_some());
        let finite = |value: Option<f64>| value.filter(|v| v.is_finite());
        let own = gated().filter_map(|row| Some((row.quantity.clone(), finite(row.reduced)?))).collect();
        // distances of curves are none of the reference itself
        let known = gated().filter(|row| scene.reference.value(&row.quantity).is_some());
        of_reference.extend(known.filter_map(|row| Some((row.quantity.clone(), finite(row.reference)?))));
        entries.push(entry(&model.model, own));
    }
    entries.push(entry(REFERENCE, of_reference));
    entries
}

/// One number over the commits.
#[derive(Debug, Clone, PartialEq)]
pub struct Trend {
    /// Name of the reduced model, or `reference`.
    pub model: String,
    /// Name of the quantity.
    pub quantity: String,
    /// SI unit.
    pub unit: String,
    /// Commit and value, oldest first.
    pub points: Vec<(String, f64)>,
    /// What the gate makes of it now; the reference is not gated.
    pub verdict: Verdict,
    /// Values that do not fail the gate now; for the reference its 95 % band, if known.
    pub admissible: Option<(f64, f64)>,
    /// Those among them that pass; the others are undecided. None if the reference's band is wider than the tolerance.
    pub passing: Option<(f64, f64)>,
    /// Place in `points` of the commit from which on the number is farther than a tenth of its tolerance from where it was
    /// at first.
    pub drifts_since: Option<usize>,
}

impl Trend {
    /// How far the number has come since it was first recorded.
    pub fn change(&self) -> f64 {
        match (self.points.first(), self.points.last()) {
            (Some(first), Some(last)) => last.1 - first.1,
            _ => 0.0,
        }
    }
}

/// The recorded courses of the numbers of `scene` that are gated now, model after model, and of the reference's.
pub fn trends(entries: &[Entry], scene: &SceneComparison) -> Vec<Trend> {
    let own: Vec<&Entry> = entries.iter().filter(|e| e.scene == scene.scene).collect();
    let points = |model: &str, quantity: &str| -> Vec<(String, f64)> {
        let of_model = own.iter().filter(|e| e.model == model);
        of_model.filter_map(|e| Some((e.commit.clone(), *e.quantities.get(quantity)?))).collect()
    };
    let mut trends: Vec<Trend> = Vec::new();
    for model in &scene.models {
        for row in &model.discrepancies {
            let (Some(tolerance), Some(reference)) = (row.tolerance, row.reference) else { continue };
            let (middle, band) = (reference + row.bias.unwrap_or(0.0), row.band().unwrap_or(0.0));
            let about = |width: f64| match row.is_residual() {
                true => Some((0.0, width)),
                false => (width >= 0.0).then_some((middle - width, middle + width)),
            };
            let mut add = |model: &str, verdict, admissible, passing| {
                let known = trends.iter().any(|t| t.model == model && t.quantity == row.quantity);
                let points = points(model, &row.quantity);
                if !points.is_empty() && !known {
                    let drifts_since = began(&points, tolerance);
                    let (model, quantity) = (model.to_owned(), row.quantity.clone());
                    let unit = row.unit.clone();
                    trends.push(Trend {
                        model,
                        quantity,
                        unit,
                        points,
                        verdict,
                        admissible,
                        passing,
                        drifts_since,
                    });
                }
            };
            add(&model.model, row.verdict, about(tolerance + band), about(tolerance - band));
            let own = row.uncertainty.map(|u| (reference - u, reference + u));
            add(REFERENCE, Verdict::NotGated, own, None);
        }
    }
    trends.sort_by_key(|t| t.model == REFERENCE);
    trends
}

/// The first place from which on every value is farther than [`DRIFT`] of `tolerance` from the first value.
fn began(points: &[(String, f64)], tolerance: f64) -> Option<usize> {
    let first = points.first()?.1;
    let near = |point: &(String, f64)| (point.1 - first).abs() <= DRIFT * tolerance;
    let last_near = points.iter().rposition(near)?;
    (last_near + 1 < points.len()).then_some(last_near + 1)
}

#[cfg(test)]
mod tests {
    use super::began;

    #[test]
    fn drift_begins_where_a_number_leaves_its_first_value_for_good() {
        let since = |values: &[f64]| {
            let points: Vec<_> = values.iter().map(|v| (String::new(), *v)).collect();
            began(&points, 1.0)
        };
        assert_eq!(since(&[5.0, 5.05, 4.95]), None);
        assert_eq!(since(&[5.0, 5.3, 5.0, 5.2, 5.3, 5.4]), Some(3), "the first excursion came back");
        assert_eq!(since(&[5.0, 4.0]), Some(1));
        assert_eq!(since(&[5.0]), None);
        assert_eq!(since(&[]), None);
    }
}
