//! What the models of a scene are really off by.

use crate::error::Result;
use crate::impact::PlateQuantities;
use crate::impact::choice::largest_error;
use crate::impact::variants::{ContinuumSetup, Simplification, Variants};
use crate::scene::{Model, Scene};

/// Kirchhoff modes of model B tried for the cheapest choice.
const KIRCHHOFF: [usize; 6] = [2, 4, 8, 16, 32, 64];
/// Modes of model C tried for the cheapest choice.
const CONTINUUM: [usize; 12] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64];
/// Modes of the high-fidelity solution, doubled until it stands.
const MODES: [usize; 3] = [64, 128, 256];
/// Change by doubling the modes at which it stands: a sixth of the smallest tolerance.
const CONVERGED: f64 = 5e-4;
/// Relative error of the time integration.
const TOLERANCE: f64 = 1e-6;
/// Modes that model C takes its contact patches from.
const PATCH_MODES: usize = 16;

/// A model with its number of modes.
pub(super) type Setting = (Model, usize);

/// The errors of all settings of a scene.
pub(super) struct Truth {
    /// What counts as exact.
    pub(super) exact: PlateQuantities,
    /// Settings in the order of their cost, and their errors; NaN for one that can't be run.
    errors: Vec<(Setting, f64)>,
}

impl Truth {
    /// Errors against `reference` or, without one, against a converged model C; `None` if that does not converge or is warned
    /// of, and for what model C does not cover.
    ///
    /// # Errors
    /// [`crate::Error::Scene`] if the scene is no plate impact.
    pub(super) fn new(scene: &Scene, reference: Option<PlateQuantities>) -> Result<Option<Self>> {
        let speed = scene.plate_impact()?.outer.speed;
        let most = KIRCHHOFF[KIRCHHOFF.len() - 1];
        for modes in MODES {
            let Ok(variants) = Variants::new(scene, [most, modes], PATCH_MODES, &ContinuumSetup::default())
            else {
                return Ok(None);
            };
            let continuum = |n| variants.run(Simplification::None, n, TOLERANCE);
            let exact = match &reference {
                Some(reference) => reference.clone(),
                None => {
                    let (Ok(half), Ok(full)) = (continuum(modes / 2), continuum(modes)) else {
                        return Ok(None);
                    };
                    // written so that what is not a number has not converged
                    if !(largest_error(&half, &full, speed).0 <= CONVERGED) {
                        continue;
                    }
                    full
                }
            };
            let error = |result: Result<PlateQuantities>| {
                result.map_or(f64::NAN, |quantities| largest_error(&quantities, &exact, speed).0)
            };
            let kirchhoff = |n| error(variants.run(Simplification::KirchhoffPlate, n, TOLERANCE));
            let mut errors = vec![((Model::A, 1), kirchhoff(1))];
            errors.extend(KIRCHHOFF.map(|n| ((Model::B, n), kirchhoff(n))));
            errors.extend(CONTINUUM.map(|n| ((Model::C, n), error(continuum(n)))));
            if modes > CONTINUUM[CONTINUUM.len() - 1] {
                errors.push(((Model::C, modes / 2), error(continuum(modes / 2))));
            }
            return Ok(Some(Self { exact, errors }));
        }
        Ok(None)
    }

    /// The cheapest setting with an error of at most `tolerance`.
    pub(super) fn cheapest(&self, tolerance: f64) -> Option<Setting> {
        self.errors.iter().find(|(_, error)| *error <= tolerance).map(|(setting, _)| *setting)
    }
}
