//! Where a plate impact lies among others: three numbers that decide how well a reduced model does.

use super::rounded;
use crate::result::Summary;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// What the numbers of a [`Place`] are, in their order.
pub const MEASURES: [&str; 3] = ["patch/thickness", "contact/period", "mass ratio"];

/// A plate impact among others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// Radius of the larger contact patch at the force peak over the plate's thickness.
    pub patch_over_thickness: f64,
    /// End of the outer contact over the plate's first period.
    pub contact_over_period: f64,
    /// Mass of the inner body over that of the outer one.
    pub mass_ratio: f64,
}

impl Place {
    /// Where `scene` lies with the result `summary`; `None` of other kinds of scenes, or if the result does not tell.
    pub fn of(scene: &Scene, summary: &Summary) -> Option<Self> {
        let setup = scene.plate_impact().ok()?;
        let pressure = summary.contact_pressure.as_ref()?;
        let patch = pressure.outer.contact_radius.max(pressure.inner.contact_radius);
        let contact = summary.value("outer_contact_end")? * summary.value("first_frequency")?;
        let [inner, outer] =
            [(&setup.inner.shape, &setup.inner.material), (&setup.outer.shape, &setup.outer.material)]
                .map(|(shape, material)| shape.mass(material));
        let measures = [patch / setup.plate.thickness, contact, inner / outer];
        let [patch_over_thickness, contact_over_period, mass_ratio] = measures.map(rounded);
        let is_known = measures.iter().all(|measure| measure.is_finite() && *measure > 0.0);
        is_known.then_some(Place { patch_over_thickness, contact_over_period, mass_ratio })
    }

    /// The numbers in the order of [`MEASURES`].
    pub fn measures(&self) -> [f64; 3] {
        [self.patch_over_thickness, self.contact_over_period, self.mass_ratio]
    }

    /// Factor, at least 1, by which the number that differs most differs from that of `other`.
    pub fn factor(&self, other: &Place) -> f64 {
        let ratios = self.measures().into_iter().zip(other.measures()).map(|(own, other)| own / other);
        ratios.map(|ratio| ratio.max(1.0 / ratio)).fold(1.0, f64::max)
    }
}
