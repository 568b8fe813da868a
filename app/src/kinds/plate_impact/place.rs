//! Where a plate impact lies among others.

use crate::format::rounded;
use crate::kinds::Place;
use crate::kinds::plate_impact::PlateImpact;
use crate::prediction::stokes_number;
use crate::result::Summary;

/// Significant digits of its numbers: the same on every machine.
const DIGITS: usize = 7;

/// The place of `setup` with the result `summary`; `None` beside the centre of the plate or at an angle, or if the result does not tell.
pub(super) fn place(setup: &PlateImpact, summary: &Summary) -> Option<Place> {
    let pressure = summary.contact_pressure.as_ref().filter(|_| setup.outer.is_centred())?;
    let patch = pressure.outer.contact_radius.max(pressure.inner.contact_radius);
    let contact = summary.value("outer_contact_end")? * summary.value("first_frequency")?;
    let [outer, inner] =
        [(&setup.outer.shape, &setup.outer.material), (&setup.inner.shape, &setup.inner.material)]
            .map(|(shape, material)| shape.mass(material));
    let stokes_number = stokes_number(setup).map(|value| rounded(value, DIGITS));
    let measures = [patch / setup.plate.thickness, contact, inner / outer];
    let [patch_over_thickness, contact_over_period, mass_ratio] =
        measures.map(|value| rounded(value, DIGITS));
    let is_known = measures.iter().all(|measure| measure.is_finite() && *measure > 0.0);
    is_known.then_some(Place { patch_over_thickness, contact_over_period, mass_ratio, stokes_number })
}
