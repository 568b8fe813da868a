//! A first look at an impact: contact patches, force peaks and how quick the contacts are.

use crate::dynamics::impulse_splitting::{self, SplittingPeak};
use crate::dynamics::integration::Options;
use crate::dynamics::integrator::integrate;
use crate::dynamics::system::System;
use crate::error::Result;
use crate::scene::Plate;

/// Smallest patch, over the plate's thickness or radius, that model C meshes its plate for. What the plate lacks to two half-spaces
/// depends on a smaller one by less than the square of this, and elements as flat as that make the stiffness of a thin plate
/// a matter of rounding.
pub(in crate::kinds) const SMALLEST_PATCH: f64 = 0.05;

/// Widest patch, over the tip's radius, of a body that is never reached.
const NEVER_REACHED: f64 = 0.25;
/// Peak of the inner contact over the outer one's below which kicks do not tell it.
const WEAK: f64 = 0.15;

/// What model C has to know of the impact before it is solved, from a model without residual.
#[derive(Debug, Clone, Copy)]
pub(super) struct Predictor {
    /// Radii in m of the patches over which loads are weighted: Hertz's at the force peaks. The result hardly
    /// depends on them: they are rounded, so that an impact that is a little different finds its bodies in the cache.
    pub(super) patch_radius: [f64; 2],
    /// Angular frequency in rad/s of the quicker contact, pi over the duration of a half-sine with its impulse and peak.
    contact_frequency: f64,
}

impl Predictor {
    pub(super) fn of(system: &System) -> Result<Self> {
        let run = integrate(system, &Options { tolerance: 1e-3, ..Options::default() })?;
        let of = |i: usize| (run.contacts[i].force_peak, run.contacts[i].impulse);
        Ok(Self::from(system, of(0), (run.contacts[1].contacts > 0).then(|| of(1))))
    }

    /// As [`Predictor::of`], to a few percent where both contacts press alike: patches that are 3 % wider change no force by more than
    /// 3e-4. `None` if a contact presses much less: it is known to a half, its patch to a quarter.
    pub(super) fn rough(system: &System) -> Option<Self> {
        let [outer, inner] = impulse_splitting::run(system)?;
        let of = |contact: SplittingPeak| (contact.force_peak, contact.impulse);
        (inner.force_peak > WEAK * outer.force_peak).then(|| Self::from(system, of(outer), Some(of(inner))))
    }

    /// From force peaks in N and impulses in N s.
    fn from(system: &System, outer: (f64, f64), inner: Option<(f64, f64)>) -> Self {
        let of = |i: usize, (peak, impulse): (f64, f64)| {
            (rounded(system.laws[i].contact_radius(peak)), 2.0 * peak / impulse)
        };
        let outer = of(0, outer);
        // an inner body that is never reached takes the outer one's patch, as far as it is wide enough for it
        let widest = NEVER_REACHED * system.laws[1].tip_radius;
        let inner = inner.map_or((outer.0.min(widest), outer.1), |inner| of(1, inner));
        Self { patch_radius: [outer.0, inner.0], contact_frequency: outer.1.max(inner.1) }
    }

    /// Radii in m of the patches that model C meshes `plate` for.
    pub(super) fn meshed_patches(&self, plate: &Plate) -> [f64; 2] {
        let smallest = SMALLEST_PATCH * plate.thickness.min(plate.radius);
        self.patch_radius.map(|a| a.max(smallest))
    }

    /// Angular frequency in rad/s below which a mode does not follow the contacts' forces.
    pub(super) fn slow(&self) -> f64 {
        self.contact_frequency
    }

    /// Relative error of a force for want of the damping of what yields under the contacts of `plate`: local waves, about as long as the
    /// patches are wide, of which a model takes few and leaves those from `omega_next` rad/s on to static flexibilities.
    pub(super) fn undamped(&self, plate: &Plate, omega_next: f64) -> f64 {
        let shear = (plate.material.shear_modulus() / plate.material.density).sqrt();
        let [outer, inner] = self.patch_radius;
        let local = shear / outer.max(inner);
        2.0 * plate.damping_ratio * self.slow() / local.max(omega_next)
    }

    /// Relative error of a force when the modes from `omega_next` rad/s on follow statically.
    pub(super) fn truncation_error(&self, omega_next: f64) -> f64 {
        (self.contact_frequency / omega_next).powi(2)
    }
}

/// `value` with three significant digits: off by at most 0.5 %.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
