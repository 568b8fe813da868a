//! What the modes that the reduced seat leaves out would change.
//!
//! Their flexibility is kept, their inertia is lost. A run with fewer modes than the default is compared with one with the default:
//! 16 and 8 modes may agree, and both lack a mode that matters. Otherwise the error falls about with the square of the number of
//! modes. A run with half of them has four times the error, and a third of the difference is the error.

use super::integration::Integration;

/// Relative error from which on the user is warned.
const LARGEST: f64 = 0.01;

/// The number of modes that a model with so many is compared with, when there are `all`, and the share of the difference that is its
/// error.
pub(super) fn compared(modes: usize, all: usize) -> (usize, f64) {
    if modes < all { (all, 1.0) } else { (modes / 2, 1.0 / 3.0) }
}

/// Relative difference of two runs, the largest of the sphere's velocity and the force peaks.
pub(super) fn difference(run: &Integration, other: &Integration) -> f64 {
    let [a, b] = [run, other].map(|run| run.state.sphere_velocity);
    let velocity = (a[0] - b[0]).hypot(a[1] - b[1]) / a[0].hypot(a[1]);
    let peaks = run.tally.force_peak.iter().zip(other.tally.force_peak).map(|(a, b)| (b / a - 1.0).abs());
    // what has not been thrown or touched has no relative error: NaN, which `max` passes over
    peaks.fold(velocity, f64::max)
}

/// What has to be told of the `error` of a model with that many `modes`.
pub(super) fn warning(error: f64, modes: usize) -> Option<String> {
    (error > LARGEST).then(|| {
        format!(
            "{modes} modes are few: the truncated modes change the sphere's velocity or the peak forces by about {:.1} %; take more (--modes)",
            100.0 * error
        )
    })
}
