//! The contact forces that run along below the picture.

use crate::curves::at;
use crate::movement::Movement;
use crate::result::Outcome;

/// Samples of a force that is drawn.
const SAMPLES: usize = 600;

/// The contact forces over time: outer and inner one, of reference and model. Times in µs, forces in N.
pub(super) struct ForceCurves {
    pub(super) curves: [[Vec<(f64, f64)>; 2]; 2],
    pub(super) end: f64,
}

impl ForceCurves {
    pub(super) fn new(reference: &Outcome, reduced: &Outcome, movement: &Movement) -> Self {
        let end = movement.times.last().copied().unwrap_or(0.0);
        let time = |k: usize| end * k as f64 / (SAMPLES - 1) as f64;
        let curve = |outcome: &Outcome, name: &str| {
            let values = at(name, &outcome.history, (0..SAMPLES).map(time));
            values.into_iter().enumerate().map(|(k, force)| (1e6 * time(k), force)).collect()
        };
        let of = |outcome| ["outer_force", "inner_force"].map(|name| curve(outcome, name));
        ForceCurves { curves: [of(reference), of(reduced)], end: 1e6 * end }
    }

    pub(super) fn at(&self, curve: &[(f64, f64)], time: f64) -> (f64, f64) {
        let k = (time / self.end * (SAMPLES - 1) as f64).round() as usize;
        curve[k.min(SAMPLES - 1)]
    }
}
