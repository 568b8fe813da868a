//! Where model C holds, by measurement against the finite-element reference, and what is said beyond.
//!
//! Measured (scenes/validation and thinner titanium plates of the same kind; efficiencies agree to 0.1 %):
//!
//! | patch radius / plate thickness | error of the force peaks |
//! |---|---|
//! | up to 0.46 | 0.22 % |
//! | 0.52 | 0.5 % |
//! | 0.70 | 0.6 % |
//! | 1.04 | 15 % |
//!
//! The residual flexibility is taken as quadratic in the patch radii (see [`crate::contact::Residual`]); with a patch
//! as wide as the plate is thick it is not.

use super::rough::Rough;
use crate::scene::{Model, PlateImpact};

/// Patch radius over the plate's thickness, and the error of the force peaks found up to it.
const MEASURED: [(f64, f64); 4] = [(0.46, 0.0022), (0.52, 0.005), (0.70, 0.006), (1.04, 0.15)];
/// Largest patch radius over the plate's thickness at which the force peaks are within 0.5 % of the reference.
const LARGEST_PATCH: f64 = 0.55;

/// Relative error of the force peaks that model C was found to have with contact patches of the radii `patch` in m on a plate of
/// `thickness` m, linear between what was measured; `None` beyond.
pub(super) fn measured_error(patch: [f64; 2], thickness: f64) -> Option<f64> {
    let ratio = patch[0].max(patch[1]) / thickness;
    if ratio <= MEASURED[0].0 {
        return Some(MEASURED[0].1);
    }
    MEASURED.windows(2).find(|pair| ratio <= pair[1].0).map(|pair| {
        let [(from, low), (to, high)] = [pair[0], pair[1]];
        low + (high - low) * (ratio - from) / (to - from)
    })
}

/// What a user has to know before relying on model C of `setup`: one sentence per reason, none if there is no reason.
pub(super) fn warnings(setup: &PlateImpact, rough: &Rough) -> Vec<String> {
    let patch = rough.patch_radius[0].max(rough.patch_radius[1]);
    let ratio = patch / setup.plate.thickness;
    if ratio <= LARGEST_PATCH {
        return Vec::new();
    }
    vec![format!(
        "model {}: the contact patch (radius {:.3} mm) is {ratio:.2} times as wide as the plate is thick ({:.3} mm); force peaks are within 0.5 % of the reference up to {LARGEST_PATCH} and 15 % off at 1.04: compare with the reference before relying on them",
        Model::C,
        1e3 * patch,
        1e3 * setup.plate.thickness
    )]
}
