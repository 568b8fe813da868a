//! Bands of differences between a model and a reference on the same mesh.
//!
//! Both sides have the mesh's error, and it leaves with the difference: the reference is a control variate. What the mesh
//! does to the difference itself is seen by comparing the same two on a coarser mesh.

use super::ModelComparison;
use super::discrepancy::Discrepancy;
use super::series::ORDER;
use crate::reference::COARSER;

/// Safety factor of the grid convergence index of two meshes (Roache 1994, J. Fluids Eng. 116, 405).
const SAFETY_FACTOR: f64 = 3.0;

impl ModelComparison {
    /// Whether it was judged by the bands of the differences, see [`super::ComparisonInput::coarser`].
    pub fn is_on_common_mesh(&self) -> bool {
        self.discrepancies.iter().any(|row| row.difference_uncertainty.is_some())
    }
}

/// Band of a difference (95 %, in its unit) that was `coarser` on a mesh whose elements are `ratio` > 1 times as large, and is
/// `finer` here.
pub fn difference_band(coarser: f64, finer: f64, ratio: f64) -> f64 {
    SAFETY_FACTOR / (ratio.powf(ORDER) - 1.0) * (finer - coarser).abs()
}

impl Discrepancy {
    /// The row judged by the band of the difference itself, which follows from the same row `before`, on the next coarser mesh.
    /// A band that is not narrower than the reference's own changes nothing.
    pub(super) fn on_common_mesh(self, before: Option<&Self>) -> Self {
        let differences = before.and_then(|before| before.difference).zip(self.difference);
        let band = differences.map(|(before, now)| difference_band(before, now, COARSER));
        match band.zip(self.uncertainty) {
            Some((band, own)) if band < own => self.judged_by(band),
            _ => self,
        }
    }
}
