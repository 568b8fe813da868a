//! What the modes that the reduced seat leaves out would change.
//!
//! Their flexibility is kept, their inertia is lost: an error that falls about with the square of the number of modes. A run
//! with half of them is off by four times as much, and a third of the difference is the error.

use super::integration::Integration;

/// Relative error from which on the user is warned.
const LARGEST: f64 = 0.01;

/// Estimated relative error of the run `all`, the largest of the sphere's velocity and the force peaks, from that with `half` of
/// its modes.
pub(super) fn estimate(all: &Integration, half: &Integration) -> f64 {
    let [a, b] = [all, half].map(|run| run.state.sphere_velocity);
    let velocity = (a[0] - b[0]).hypot(a[1] - b[1]) / a[0].hypot(a[1]);
    let peaks = all.tally.force_peak.iter().zip(half.tally.force_peak).map(|(a, b)| (b / a - 1.0).abs());
    // what has not been thrown or touched has no relative error: NaN, which `max` passes over
    peaks.fold(velocity, f64::max) / 3.0
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
