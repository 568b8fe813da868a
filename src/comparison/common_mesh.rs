//! Bands of differences between a model and a reference on the same mesh.
//!
//! Both sides have the mesh's error, and it leaves with the difference: the reference is a control variate. What the mesh
//! does to the difference itself is seen by comparing the same two on a coarser mesh.

use super::series::ORDER;
use super::verdict::Verdict;
use super::{ModelComparison, SceneComparison, undecided};

/// Safety factor of the grid convergence index of two meshes (Roache 1994, J. Fluids Eng. 116, 405).
const SAFETY_FACTOR: f64 = 3.0;

impl ModelComparison {
    /// Whether it was judged by the bands of the differences, see [`SceneComparison::judge_on_common_mesh`].
    pub fn is_on_common_mesh(&self) -> bool {
        self.discrepancies.iter().any(|row| row.difference_uncertainty.is_some())
    }
}

/// Band of a difference (95 %, in its unit) that was `coarser` on a mesh whose elements are `ratio` > 1 times as large, and is
/// `finer` here.
pub fn difference_band(coarser: f64, finer: f64, ratio: f64) -> f64 {
    SAFETY_FACTOR / (ratio.powf(ORDER) - 1.0) * (finer - coarser).abs()
}

impl SceneComparison {
    /// Judges by the bands of the differences themselves, from the comparison of the same scene on a `coarser` mesh whose
    /// elements are `ratio` > 1 times as large; on either mesh model and reference are solutions on the very same one. A band
    /// that is not narrower than the reference's own changes nothing.
    pub fn judge_on_common_mesh(&mut self, coarser: &SceneComparison, ratio: f64) {
        let sound = Verdict::of_soundness(self.integrity.iter().map(|check| check.verdict));
        for model in &mut self.models {
            let Some(other) = coarser.models.iter().find(|other| other.model == model.model) else {
                continue;
            };
            for row in &mut model.discrepancies {
                let before = other.discrepancy(&row.quantity).and_then(|before| before.difference);
                let change =
                    before.zip(row.difference).map(|(before, now)| difference_band(before, now, ratio));
                // a difference that the mesh changes more than the reference has no band of its own
                if let Some((band, _)) = change.zip(row.uncertainty).filter(|(band, own)| band < own) {
                    row.judge_by(band);
                }
            }
            undecided::tell(&mut model.discrepancies, &self.reference);
            model.judge(sound);
        }
        self.verdict = Verdict::worst(self.models.iter().map(|model| model.verdict).chain([sound]));
    }
}
