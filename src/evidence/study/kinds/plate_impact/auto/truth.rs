//! What the models of a scene are really off by.

use super::TOLERANCES;
use crate::error::Result;
use crate::kinds::plate_impact::PlateQuantities;
use crate::kinds::plate_impact::errors::largest_error;
use crate::kinds::plate_impact::variants::{ContinuumSetup, Simplification, Variants};
use crate::scene::{Model, Scene};

/// Kirchhoff modes of model B tried for the cheapest choice.
const KIRCHHOFF: [usize; 6] = [2, 4, 8, 16, 32, 64];
/// Modes of model C tried for the cheapest choice.
const CONTINUUM: [usize; 13] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96];
/// Modes of the high-fidelity solution, doubled until it stands.
const MODES: [usize; 3] = [32, 64, 128];
/// Change by the last doubling, over a tolerance, at which it stands; what the next would change is far less.
const CONVERGED: f64 = 1.0 / 3.0;
/// Relative error of the time integration.
const TOLERANCE: f64 = 1e-6;
/// Modes that model C takes its contact patches from.
const PATCH_MODES: usize = 16;

/// A model with its number of modes.
pub(super) type Setting = (Model, usize);

/// What is known of a scene beyond doubt.
pub(super) struct Truth {
    /// What counts as exact.
    pub(super) exact: PlateQuantities,
    /// By how much half as many modes change it, as [`largest_error`] measures; 0 of a reference.
    change: f64,
}

impl Truth {
    /// Model C with at least `modes` modes and so many that a doubling changes little beside `tolerance`, or with as many as are
    /// possible; `None` if it can't be set up or run.
    ///
    /// # Errors
    /// [`crate::Error::Scene`] if the scene is no plate impact.
    pub(super) fn new(scene: &Scene, modes: usize, tolerance: f64) -> Result<Option<Self>> {
        let speed = scene.plate_impact()?.outer.speed;
        let mut found = None;
        for modes in MODES.into_iter().filter(|n| *n >= modes) {
            let Ok(variants) = variants(scene, PATCH_MODES, modes) else { break };
            let run = |n| variants.run(Simplification::None, n, TOLERANCE);
            let (Ok(half), Ok(exact)) = (run(modes / 2), run(modes)) else { break };
            let change = largest_error(&half, &exact, speed).0;
            let truth = found.insert(Self { exact, change });
            if truth.decides(tolerance) {
                break;
            }
        }
        Ok(found)
    }

    /// What the reference found.
    pub(super) fn of_reference(exact: PlateQuantities) -> Self {
        Self { exact, change: 0.0 }
    }

    /// Whether it is exact enough to tell whether a result meets `tolerance`.
    pub(super) fn decides(&self, tolerance: f64) -> bool {
        self.change <= CONVERGED * tolerance
    }

    /// The cheapest settings of `scene` with errors of at most [`TOLERANCES`].
    pub(super) fn cheapest(&self, scene: &Scene) -> Result<[Option<Setting>; TOLERANCES.len()]> {
        let speed = scene.plate_impact()?.outer.speed;
        let most = CONTINUUM[CONTINUUM.len() - 1];
        let Ok(variants) = variants(scene, KIRCHHOFF[KIRCHHOFF.len() - 1], most) else {
            return Ok([None; TOLERANCES.len()]);
        };
        let error = |simplification, n| {
            let result = variants.run(simplification, n, TOLERANCE);
            result.map_or(f64::NAN, |quantities| largest_error(&quantities, &self.exact, speed).0)
        };
        let kirchhoff = |n| error(Simplification::KirchhoffPlate, n);
        // in the order of their cost
        let mut errors = vec![((Model::A, 1), kirchhoff(1))];
        errors.extend(KIRCHHOFF.map(|n| ((Model::B, n), kirchhoff(n))));
        errors.extend(CONTINUUM.map(|n| ((Model::C, n), error(Simplification::None, n))));
        let first = |tolerance| errors.iter().find(|(_, error)| *error <= tolerance).map(|found| found.0);
        Ok(TOLERANCES.map(first))
    }
}

fn variants(scene: &Scene, kirchhoff: usize, continuum: usize) -> Result<Variants<'_>> {
    Variants::new(scene, [kirchhoff, continuum], PATCH_MODES, &ContinuumSetup::default())
}
