//! Where models hold, by measurement against the finite-element reference, and what is said beyond.
//!
//! Measured (scenes/validation, thinner titanium plates of the same kind, soft plates under polymer spheres):
//!
//! | patch radius of the first look / plate thickness | error of the force peaks |
//! |---|---|
//! | up to 0.46 | 0.22 % |
//! | 1.04 | 1 % |
//!
//! With wider patches Hertz's distribution of the pressure is lost, and nothing was measured.
//!
//! In a fluid the film of the models knows how the contact deforms the surfaces, but not how its own pressure does (no
//! elastohydrodynamics). Over the random scenes in a film of the validation base the efficiency is wrong by up to 0.21 of the film's loss
//! (`film-001`: 0.763, finite elements 0.743).

use crate::dynamics::system::System;
use crate::scene::Model;

/// Widest patch radius over the plate's thickness that was measured, and the error of the force peaks found up to it.
const MEASURED: (f64, f64) = (1.05, 0.01);
/// Share of the film's loss by which the efficiency may be wrong: the film of the models does not deform plate and inner body.
pub const FILM_SHARE: f64 = 0.25;
/// Error of the efficiency by it that is reported.
const FILM_ERROR: f64 = 0.01;
/// Share of the patch that the contacts have to be able to exceed before they become punches.
const REACH: f64 = 1.2;

/// What a user has to know of a squeeze film that dissipates `loss` J in an impact of `system`.
///
/// The share is of the energy of both bodies; the efficiency relates to that of the outer one.
pub(super) fn film_warning(loss: f64, system: &System) -> Option<String> {
    let share = loss / system.kinetic_energy();
    let error = FILM_SHARE * loss / system.initial_energy();
    (FILM_SHARE * share > FILM_ERROR).then(|| {
        format!(
            "the squeeze film dissipates {:.1} % of the energy, uncertain by {FILM_SHARE} of that, since its pressure does not deform the surfaces (no elastohydrodynamics): the efficiency may be wrong by {error:.3}; compare with the reference",
            100.0 * share
        )
    })
}

/// What a user has to know before relying on model C, made to `system`, with contact patches of the radii `patch` in m on a plate of
/// `thickness` m: one sentence per reason, none if there is no reason.
pub(in crate::kinds) fn warnings(thickness: f64, patch: [f64; 2], system: &System) -> Vec<String> {
    let mut warnings = Vec::new();
    let widest_patch = patch[0].max(patch[1]);
    let ratio = widest_patch / thickness;
    let (widest, error) = MEASURED;
    if ratio > widest {
        warnings.push(format!(
            "model {}: the contact patch (radius {:.3} mm) is {ratio:.2} times as wide as the plate is thick ({:.3} mm); force peaks are within {:.0} % of the reference up to {widest} and unknown beyond: compare with the reference before relying on them",
            Model::C,
            1e3 * widest_patch,
            1e3 * thickness,
            100.0 * error
        ));
    }
    warnings.extend(punches(system, patch));
    warnings
}

/// A sentence for each contact that becomes a flat punch before its radius is that of the `patch` in m.
pub(in crate::kinds) fn punches(system: &System, patch: [f64; 2]) -> Vec<String> {
    let reach = system.residual.map_or([f64::INFINITY; 2], |residual| residual.reach(&system.laws));
    let near = |k: &usize| system.can_close(*k) && reach[*k] < REACH * patch[*k];
    let punch = |k: usize| {
        format!(
            "model {}: above a contact radius of {:.3} mm the contact (about {:.3} mm) is treated as a flat punch: compare with the reference, or take fewer modes",
            Model::C,
            1e3 * reach[k],
            1e3 * patch[k]
        )
    };
    (0..2).filter(near).map(punch).collect()
}
