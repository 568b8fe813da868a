//! The validation base: random scenes that references have solved (`make validation`), one a line.

use impactcheck_physics::scene::Model;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::LazyLock;

const TABLE: &str = include_str!("../../validation/base.jsonl");
const FINER: &str = include_str!("../../validation/finer.jsonl");

/// A scene of the base that was solved.
#[derive(Debug, Clone, Deserialize)]
pub struct SolvedScene {
    /// Name of the scene.
    pub scene: String,
    /// First digits of the hash of its physical content.
    pub hash: String,
    /// Group of similar scenes that it was drawn in.
    pub stratum: String,
    /// Internal consistency checks that its reference fails; it is no evidence then.
    pub unsound: Vec<String>,
    /// Speed of the outer body, m/s.
    pub speed: f64,
    /// Numbers of the scene that were drawn, by name.
    pub numbers: BTreeMap<String, f64>,
    /// Numbers of model C's result, by name, positive.
    pub results: BTreeMap<String, f64>,
    /// Error of the omitted modes that model C's result states, relative.
    pub truncation: f64,
    /// By quantity, SI.
    pub values: BTreeMap<String, SolvedValues>,
}

/// Values of a quantity, SI, as they stand in the table; `None`: not determined.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(from = "[Option<f64>; 5]")]
pub struct SolvedValues {
    /// The reference's in the limit of fine meshes.
    pub reference: Option<f64>,
    /// Half width of its 95 % band.
    pub band: Option<f64>,
    /// Those of models A, B and C.
    pub models: [Option<f64>; 3],
}

impl From<[Option<f64>; 5]> for SolvedValues {
    fn from([reference, band, a, b, c]: [Option<f64>; 5]) -> Self {
        Self { reference, band, models: [a, b, c] }
    }
}

impl SolvedScene {
    /// Value of `model`, SI.
    pub fn of_model(&self, model: Model, quantity: &str) -> Option<f64> {
        self.values.get(quantity)?.models[model as usize]
    }

    /// With the reference's values on `finer` meshes; without those that have none there.
    pub fn with_finer(&self, finer: &FinerScene) -> Self {
        let with = |(name, values): (&String, &SolvedValues)| {
            let [reference, band] = *finer.values.get(name)?;
            Some((name.clone(), SolvedValues { reference, band, ..*values }))
        };
        Self { values: self.values.iter().filter_map(with).collect(), ..self.clone() }
    }
}

/// A scene of the base on meshes with 1.5 times the elements in every direction, drawn at random (`validation/finer.py`).
#[derive(Debug, Clone, Deserialize)]
pub struct FinerScene {
    /// Name of the scene.
    pub scene: String,
    /// First digits of the hash of its physical content.
    pub hash: String,
    /// The reference's value in the limit of fine meshes and the half width of its 95 % band, by quantity, SI.
    pub values: BTreeMap<String, [Option<f64>; 2]>,
}

/// A scene of the base that was refused or not solved.
#[derive(Debug, Clone, Deserialize)]
pub struct RefusedScene {
    /// Name of the scene.
    pub scene: String,
    /// Group of similar scenes that it was drawn in.
    pub stratum: String,
    /// Why.
    pub refused: String,
}

/// A line of the table.
#[derive(Deserialize)]
#[serde(untagged)]
enum TableLine {
    Refused(RefusedScene),
    Solved(SolvedScene),
}

/// The base.
#[derive(Debug, Default)]
struct Base {
    solved: Vec<SolvedScene>,
    refused: Vec<RefusedScene>,
}

static BASE: LazyLock<Base> = LazyLock::new(|| {
    let mut base = Base::default();
    for line in TABLE.lines().filter_map(|text| serde_json::from_str(text).ok()) {
        match line {
            TableLine::Solved(scene) => base.solved.push(scene),
            TableLine::Refused(scene) => base.refused.push(scene),
        }
    }
    base
});

/// The scenes that were solved.
pub fn solved() -> &'static [SolvedScene] {
    &BASE.solved
}

/// Scenes of the base that were drawn at random and solved on finer meshes.
pub fn finer() -> &'static [FinerScene] {
    static SCENES: LazyLock<Vec<FinerScene>> =
        LazyLock::new(|| FINER.lines().filter_map(|text| serde_json::from_str(text).ok()).collect());
    &SCENES
}

/// The others.
pub fn refused() -> &'static [RefusedScene] {
    &BASE.refused
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No line is passed over because it is not understood.
    #[test]
    fn every_scene_is_solved_or_has_a_reason() {
        assert_eq!(solved().len() + refused().len(), TABLE.lines().count());
        assert!(!solved().is_empty());
        assert!(refused().iter().all(|scene| !scene.refused.is_empty()));
        assert_eq!(finer().len(), FINER.lines().count());
        let is_known = |finer: &FinerScene| solved().iter().any(|scene| scene.hash == finer.hash);
        assert!(finer().iter().all(is_known));
    }

    /// Scenes are compared number by number.
    #[test]
    fn scenes_of_a_group_have_the_same_numbers() {
        // model C of some has no result
        let known = || solved().iter().filter(|scene| !scene.numbers.is_empty());
        for scene in known() {
            let first = known().find(|other| other.stratum == scene.stratum).expect("a scene");
            assert!(scene.results.keys().eq(first.results.keys()), "{}", scene.scene);
            assert!(scene.numbers.keys().eq(first.numbers.keys()), "{}", scene.scene);
        }
    }
}
