//! Where a plate impact lies among others: three numbers that decide how well a reduced model does, and a fourth of a squeeze film.

use crate::result::Summary;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// A plate impact among others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// Radius of the larger contact patch at the force peak over the plate's thickness.
    pub patch_over_thickness: f64,
    /// End of the outer contact over the plate's first period.
    pub contact_over_period: f64,
    /// Mass of the inner body over that of the outer one.
    pub mass_ratio: f64,
    /// Stokes number of the squeeze film, m v/(6 pi mu R^2) of the inner body at the outer one's speed; `None`: no film.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stokes_number: Option<f64>,
}

impl Place {
    /// Where `scene` lies with the result `summary`; `None` of kinds of scenes without a place, beside the centre of the plate or at an
    /// angle, or if the result does not tell.
    pub fn of(scene: &Scene, summary: &Summary) -> Option<Self> {
        super::of(scene).place(scene, summary)
    }

    /// The numbers in the order of [`MEASURES`](crate::prediction::MEASURES).
    pub fn measures(&self) -> [f64; 3] {
        [self.patch_over_thickness, self.contact_over_period, self.mass_ratio]
    }

    /// Factor, at least 1, by which the number that differs most differs from that of `other`; infinite if only one of them has
    /// a film, which no other scene tells anything of.
    pub fn factor(&self, other: &Place) -> f64 {
        let ratios = self.measures().into_iter().zip(other.measures()).map(|(own, other)| own / other);
        let film = match (self.stokes_number, other.stokes_number) {
            (None, None) => 1.0,
            (Some(own), Some(other)) => own / other,
            _ => f64::INFINITY,
        };
        ratios.chain([film]).map(|ratio| ratio.max(1.0 / ratio)).fold(1.0, f64::max)
    }
}
