//! What the models of a scene are really off by.

use crate::error::Result;
use crate::kinds::plate_impact::PlateQuantities;
use crate::kinds::plate_impact::choice::largest_error;
use crate::kinds::plate_impact::variants::{ContinuumSetup, Simplification, Variants};
use crate::scene::{Model, Scene};

/// Kirchhoff modes of model B tried for the cheapest choice.
const KIRCHHOFF: [usize; 6] = [2, 4, 8, 16, 32, 64];
/// Modes of model C tried for the cheapest choice.
const CONTINUUM: [usize; 13] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96];
/// Modes of the high-fidelity solution, doubled until it stands.
const MODES: [usize; 3] = [32, 64, 128];
/// Change by the last doubling at which it stands; what the next would change is a tenth of the smallest tolerance at most.
const CONVERGED: f64 = 1e-3;
/// By how much a doubling makes the next change smaller: (contact frequency / lowest frequency left out)^2 falls by sixteen.
const DECAY: f64 = 8.0;
/// Relative error of the time integration.
const TOLERANCE: f64 = 1e-6;
/// Modes that model C takes its contact patches from.
const PATCH_MODES: usize = 16;

/// Contact patch over the plate's thickness up to which model C is said to hold.
const LARGEST_PATCH: f64 = 0.55;

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
    /// Errors against `reference` or, without one, against model C; `None` if that does not converge, and for what it does not
    /// cover.
    ///
    /// # Errors
    /// [`crate::Error::Scene`] if the scene is no plate impact.
    pub(super) fn new(scene: &Scene, reference: Option<PlateQuantities>) -> Result<Option<Self>> {
        let speed = scene.plate_impact()?.outer.speed;
        let most = KIRCHHOFF[KIRCHHOFF.len() - 1];
        for (k, modes) in MODES.into_iter().enumerate().skip(usize::from(reference.is_some())) {
            let setup = ContinuumSetup::default();
            let Ok(variants) = Variants::new(scene, [most, modes], PATCH_MODES, &setup) else {
                return Ok(None);
            };
            let continuum = |n| variants.run(Simplification::None, n, TOLERANCE);
            let exact = match &reference {
                Some(reference) => *reference,
                None => {
                    let (Ok(half), Ok(full)) = (continuum(modes / 2), continuum(modes)) else {
                        return Ok(None);
                    };
                    let change = largest_error(&half, &full, speed).0;
                    let doublings = (MODES.len() - 1 - k) as i32;
                    if change > CONVERGED && doublings > 0 && change <= CONVERGED * DECAY.powi(doublings) {
                        continue;
                    }
                    // what is not a number has not converged
                    if change.is_nan() || change > CONVERGED || widest_patch(&variants, &full) > LARGEST_PATCH
                    {
                        return Ok(None);
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
            let fewer = CONTINUUM.into_iter().filter(|n| *n <= modes);
            errors.extend(fewer.map(|n| ((Model::C, n), error(continuum(n)))));
            return Ok(Some(Self { exact, errors }));
        }
        Ok(None)
    }

    /// The cheapest setting with an error of at most `tolerance`.
    pub(super) fn cheapest(&self, tolerance: f64) -> Option<Setting> {
        self.errors.iter().find(|(_, error)| *error <= tolerance).map(|(setting, _)| *setting)
    }
}

/// The wider contact patch at the force peaks of `result` over the plate's thickness.
fn widest_patch(variants: &Variants, result: &PlateQuantities) -> f64 {
    let laws = variants.system(Simplification::KirchhoffPlate, 1).laws;
    let peaks = [result.outer_force_peak, result.inner_force_peak];
    let widest = [0, 1].map(|i| laws[i].contact_radius(peaks[i]));
    widest[0].max(widest[1]) / variants.thickness()
}
