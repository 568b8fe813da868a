//! The validation base: random scenes that references have solved (`make validation`), one a line.

use crate::kinds::Place;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::LazyLock;

const TABLE: &str = include_str!("../../validation/base.jsonl");
/// Place in its table of what model C found.
const CONTINUUM: &str = "C";

/// A scene of the base that was solved.
#[derive(Debug, Clone, Deserialize)]
pub struct SolvedScene {
    /// Name of the scene.
    pub scene: String,
    /// Hash of its physical content.
    pub hash: String,
    /// Group of similar scenes that it was drawn in.
    pub stratum: String,
    /// Speed of the outer body, m/s.
    pub speed: f64,
    /// Where it lies among others.
    pub place: Option<Place>,
    /// Numbers of the scene that were drawn, by name.
    pub proportions: BTreeMap<String, f64>,
    /// The reference's quantities in the limit of fine meshes, SI.
    pub extrapolated: BTreeMap<String, f64>,
    /// Half widths of their 95 % bands, SI; `None`: not determined.
    pub bands: BTreeMap<String, Option<f64>>,
    /// Those of the models, by model; `None`: not determined.
    models: BTreeMap<String, BTreeMap<String, Option<f64>>>,
}

impl SolvedScene {
    /// Model C's value and the reference's, SI, if both have one.
    pub fn values(&self, quantity: &str) -> Option<[f64; 2]> {
        let model = *self.models.get(CONTINUUM)?.get(quantity)?;
        Some([model?, *self.extrapolated.get(quantity)?])
    }
}

/// A line of the table.
#[derive(Deserialize)]
#[serde(untagged)]
enum TableLine {
    /// A scene that was refused or not solved, with the reason.
    Refused {
        #[serde(rename = "refused")]
        _reason: String,
    },
    Solved(SolvedScene),
}

/// Scenes that were refused or not solved are not among them.
pub fn solved() -> &'static [SolvedScene] {
    static SOLVED: LazyLock<Vec<SolvedScene>> = LazyLock::new(|| {
        let line = |text| match serde_json::from_str(text) {
            Ok(TableLine::Solved(scene)) => Some(scene),
            Ok(TableLine::Refused { .. }) | Err(_) => None,
        };
        TABLE.lines().filter_map(line).collect()
    });
    &SOLVED
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No line is passed over because it is not understood.
    #[test]
    fn every_scene_is_solved_or_has_a_reason() {
        for text in TABLE.lines() {
            let line: TableLine = serde_json::from_str(text).unwrap();
            assert!(
                matches!(&line, TableLine::Refused { _reason } if !_reason.is_empty())
                    || matches!(line, TableLine::Solved(_))
            );
        }
        assert!(!solved().is_empty());
    }
}
