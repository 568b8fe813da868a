//! What changed between two comparisons, of two commits, versions or machines.

use crate::error::{Error, Result};
use crate::result::SCHEMA_VERSION;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;

/// Name of the reference among the models.
const REFERENCE: &str = "reference";
/// The document in the folder of a report.
const COMPARISON: &str = "comparison.json";

/// The document of `diff`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Moves {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Numbers that differ, in the order of the first comparison.
    pub moved: Vec<Moved>,
    /// Verdicts that differ, and models that only one comparison has.
    pub verdicts: Vec<MovedVerdict>,
}

/// A number that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Moved {
    /// Name of the scene.
    pub scene: String,
    /// Name of the reduced model, or `reference`.
    pub model: String,
    /// Name of the quantity.
    pub quantity: String,
    /// SI unit.
    pub unit: String,
    /// Value in the first comparison; `None` if it is not there or not determined.
    pub a: Option<f64>,
    /// Value in the second one.
    pub b: Option<f64>,
    /// `(b - a)/|a|`; `None` if that is not known.
    pub relative: Option<f64>,
    /// Half width of the reference's 95 % band, absolute: of the second comparison, else of the first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub band: Option<f64>,
}

impl Moved {
    /// Half width of the band over the magnitude of the first value.
    pub fn relative_band(&self) -> Option<f64> {
        self.band.zip(self.a).map(|(band, a)| band / a.abs()).filter(|share| share.is_finite())
    }
}

/// A verdict that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MovedVerdict {
    /// Name of the scene.
    pub scene: String,
    /// Name of the reduced model.
    pub model: String,
    /// Verdict in the first comparison; `None` if the model is not there.
    pub a: Option<String>,
    /// Verdict in the second one.
    pub b: Option<String>,
}

/// What a document of `compare` or `gate` says of the numbers that it compares.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ComparisonDocument {
    schema_version: u32,
    scenes: Vec<SceneEntry>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct SceneEntry {
    scene: String,
    models: Vec<ModelEntry>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct ModelEntry {
    model: String,
    verdict: String,
    discrepancies: Vec<DocumentRow>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct DocumentRow {
    quantity: String,
    unit: String,
    reduced: Option<f64>,
    reference: Option<f64>,
    #[serde(default)]
    uncertainty: Option<f64>,
}

impl ComparisonDocument {
    /// The document `path`, or that of the report in the folder `path`.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none, or it is no document of `compare` or `gate`.
    pub fn read(path: &Path) -> Result<Self> {
        let file = if path.is_dir() { path.join(COMPARISON) } else { path.to_path_buf() };
        let refused = |why: String| Error::Usage(format!("{}: {why}", file.display()));
        let text = std::fs::read_to_string(&file).map_err(|e| refused(e.to_string()))?;
        let document: Self = serde_json::from_str(&text)
            .map_err(|e| refused(format!("is no document of `compare` or `gate`: {e}")))?;
        if document.schema_version != SCHEMA_VERSION {
            let version = document.schema_version;
            return Err(refused(format!(
                "has schema_version {version}; this program reads {SCHEMA_VERSION}"
            )));
        }
        Ok(document)
    }

    fn models(&self) -> impl Iterator<Item = (&str, &ModelEntry)> {
        self.scenes.iter().flat_map(|scene| scene.models.iter().map(|model| (&*scene.scene, model)))
    }

    fn model(&self, scene: &str, model: &str) -> Option<&ModelEntry> {
        self.models().find(|(name, found)| *name == scene && found.model == model).map(|(_, found)| found)
    }
}

/// What changed from `a` to `b` by more than the share `above` of its magnitude.
pub fn moved<'d>(a: &'d ComparisonDocument, b: &'d ComparisonDocument, above: f64) -> Moves {
    let mut moves = Moves { schema_version: SCHEMA_VERSION, moved: Vec::new(), verdicts: Vec::new() };
    let mut listed = BTreeSet::new();
    let new = b.models().filter(|(scene, model)| a.model(scene, &model.model).is_none());
    for (scene, model) in a.models().chain(new) {
        let [before, after] = [a, b].map(|document| document.model(scene, &model.model));
        let verdicts = [before, after].map(|found| found.map(|found| found.verdict.clone()));
        if verdicts[0] != verdicts[1] {
            let [a, b] = verdicts;
            moves.verdicts.push(MovedVerdict { scene: scene.into(), model: model.model.clone(), a, b });
        }
        let (Some(before), Some(after)) = (before, after) else { continue };
        let mut add = |model: &str, row: &DocumentRow, band: Option<f64>, [a, b]: [Option<f64>; 2]| {
            let relative = a.zip(b).map(|(a, b)| (b - a) / a.abs()).filter(|relative| relative.is_finite());
            let entry = Moved {
                scene: scene.into(),
                model: model.into(),
                quantity: row.quantity.clone(),
                unit: row.unit.clone(),
                a,
                b,
                relative,
                band,
            };
            if a != b && relative.is_none_or(|share| share.abs() > above) {
                moves.moved.push(entry);
            }
        };
        let missing =
            |row: &&DocumentRow| !before.discrepancies.iter().any(|other| other.quantity == row.quantity);
        for row in before.discrepancies.iter().chain(after.discrepancies.iter().filter(missing)) {
            let of = |found: &'d ModelEntry| {
                found.discrepancies.iter().find(|other| other.quantity == row.quantity)
            };
            let rows = [of(before), of(after)];
            let both = |side: fn(&DocumentRow) -> Option<f64>| rows.map(|row| row.and_then(side));
            let [old_band, band] = both(|row| row.uncertainty);
            let band = band.or(old_band);
            // all models of a scene have the same reference
            if listed.insert((scene, &*row.quantity)) {
                add(REFERENCE, row, band, both(|row| row.reference));
            }
            add(&before.model, row, band, both(|row| row.reduced));
        }
    }
    moves
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn document(models: serde_json::Value) -> ComparisonDocument {
        let scenes = json!([{ "scene": "x", "models": models }]);
        serde_json::from_value(json!({ "schema_version": SCHEMA_VERSION, "scenes": scenes }))
            .expect("document")
    }

    fn model(name: &str, verdict: &str, reduced: f64, reference: f64) -> serde_json::Value {
        let row =
            json!({ "quantity": "efficiency", "unit": "1", "reduced": reduced, "reference": reference });
        json!({ "model": name, "verdict": verdict, "discrepancies": [row] })
    }

    #[test]
    fn a_difference_is_listed_once_and_equal_results_are_not() {
        let a = document(json!([model("B", "pass", 0.5, 0.4), model("C", "pass", 0.4, 0.4)]));
        let b = document(json!([model("B", "fail", 0.6, 0.44), model("C", "pass", 0.4, 0.44)]));
        assert_eq!(moved(&a, &a, 0.0), Moves { moved: vec![], verdicts: vec![], ..moved(&a, &b, 0.0) });
        let moves = moved(&a, &b, 0.0);
        let found: Vec<_> = moves.moved.iter().map(|m| (&*m.model, m.a, m.b)).collect();
        assert_eq!(found, [("reference", Some(0.4), Some(0.44)), ("B", Some(0.5), Some(0.6))]);
        assert!((moves.moved[1].relative.expect("a share") - 0.2).abs() < 1e-12);
        assert_eq!(moves.verdicts.len(), 1);
        assert_eq!(
            (moves.verdicts[0].a.as_deref(), moves.verdicts[0].b.as_deref()),
            (Some("pass"), Some("fail"))
        );
        assert_eq!(moved(&a, &b, 0.15).moved.len(), 1);
    }

    #[test]
    fn a_model_in_only_one_document_is_reported_as_such() {
        let a = document(json!([model("B", "pass", 0.5, 0.4)]));
        let b = document(json!([model("C", "pass", 0.4, 0.4)]));
        let moves = moved(&a, &b, 0.0);
        assert!(moves.moved.is_empty());
        let found: Vec<_> =
            moves.verdicts.iter().map(|v| (&*v.model, v.a.is_some(), v.b.is_some())).collect();
        assert_eq!(found, [("B", true, false), ("C", false, true)]);
    }
}
