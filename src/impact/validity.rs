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

use super::reduced::Rough;
use crate::body::ModalBody;
use crate::scene::{Model, PlateImpact};

/// Largest patch radius over the plate's thickness at which the force peaks are within 0.5 % of the reference.
const LARGEST_PATCH: f64 = 0.55;
/// Largest change of the relative curvature of a contact by its own force: beyond it the contacts may have no equilibrium.
const LARGEST_CURVATURE: f64 = 1.0;

/// `plate` with its growth with the patches reduced, where it is too strong to be true, to what the contact stands;
/// at the patches of the impact the residual flexibility stays.
pub(super) fn tempered(mut plate: ModalBody, setup: &PlateImpact, rough: &Rough) -> ModalBody {
    let tip = [setup.outer.shape.tip_radius(), setup.inner.shape.tip_radius()];
    let curvature =
        |i: usize| (5.0 * plate.patch_growth[i][i] * tip[i] * rough.force_peak[i]).abs() / LARGEST_CURVATURE;
    let excess = curvature(0).max(curvature(1));
    if excess <= 1.0 {
        return plate;
    }
    let growth = plate.patch_growth;
    let square = rough.patch_radius.map(|a| a * a);
    for i in 0..2 {
        for j in 0..2 {
            let cut = 1.0 - 1.0 / excess;
            plate.patch_growth[i][j] -= cut * growth[i][j];
            plate.residual[i][j] += cut * (growth[i][j] * square[i] + growth[j][i] * square[j]);
        }
    }
    plate
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
