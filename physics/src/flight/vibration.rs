//! How hard the valve can be shaken: the least accelerations that take the sphere off its seat and over the saddle (section 5.1.3).

use super::landscape::Landscape;
use super::run::{Ending, MotionMode, MotionRequest, moved};
use super::{Excitation, Setup, Vector, Wave};

/// Relative steps of the amplitude in which a shift is looked for.
const STEP: f64 = 0.05;
/// Relative error with which it is found.
const CLOSE: f64 = 3e-9;
/// Largest amplitude looked at over the one below which nothing can happen.
const HARDEST: f64 = 1e4;

/// Largest accelerations of the valve in m/s^2: amplitudes of a wave, the largest magnitude of a record that is scaled as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds {
    /// Least one at which the sphere comes off one side of its seat; `None` if this direction presses it in.
    pub unseats: Option<f64>,
    /// Least one at which it passes the saddle; `None` if none is found.
    pub shifts: Option<f64>,
    /// What the wave needs at least to give the sphere the energy of the saddle: sqrt(2 dU / m) over the integral of its magnitude, since
    /// d sqrt(2 E / m) / dt is at most the acceleration's; of a half-sine of length T pi sqrt(2 dU / m) / (2 T).
    pub energy_bound: f64,
}

/// The thresholds of a `wave` of base acceleration along `direction` (of length 1).
pub fn thresholds(setup: &Setup, landscape: &Landscape, wave: &Wave, direction: Vector) -> Thresholds {
    thresholds_within(setup, landscape, wave, direction, CLOSE)
}

/// The same, that of a shift with a relative `error`.
pub fn thresholds_within(
    setup: &Setup,
    landscape: &Landscape,
    wave: &Wave,
    direction: Vector,
    error: f64,
) -> Thresholds {
    let unseats = static_limit(setup, landscape, wave, direction);
    let energy_bound = landscape.least_speed(setup.mass) / wave.impulse();
    let shifts = unseats.and_then(|unseats| {
        least(unseats.max(energy_bound), error, |amplitude| {
            shaken_over(setup, landscape, wave, direction, amplitude)
        })
    });
    let largest = |factor: f64| factor * wave.size();
    Thresholds {
        unseats: unseats.map(largest),
        shifts: shifts.map(largest),
        energy_bound: largest(energy_bound),
    }
}

/// Whether the sphere passes the saddle when the valve is shaken with this `amplitude`.
fn shaken_over(setup: &Setup, landscape: &Landscape, wave: &Wave, direction: Vector, amplitude: f64) -> bool {
    let mut setup = setup.clone();
    setup.field.shaken = Some(Excitation { direction, amplitude, wave: wave.clone() });
    setup.end_time += wave.end();
    let (state, mode) = setup.seated(landscape);
    let request = MotionRequest { path: false, beyond: Some(landscape.saddle.x) };
    moved(&setup, landscape, state, mode, request).ending == Ending::Passed
}

/// Least amplitude from `low` on for which something `happens`, with a relative `error`: by steps and halvings.
fn least(low: f64, error: f64, happens: impl Fn(f64) -> bool) -> Option<f64> {
    let (mut below, mut above) = (low, low);
    while !happens(above) {
        if above > HARDEST * low {
            return None;
        }
        (below, above) = (above, above * (1.0 + STEP));
    }
    while above - below > error * above {
        let middle = 0.5 * (below + above);
        if happens(middle) { above = middle } else { below = middle }
    }
    Some(above)
}

/// Least amplitude at which a surface of the seat has no more to carry: the statics of a sphere between two surfaces.
fn static_limit(setup: &Setup, landscape: &Landscape, wave: &Wave, direction: Vector) -> Option<f64> {
    let (state, MotionMode::Wedged(normals, _)) = setup.seated(landscape) else { return Some(0.0) };
    let pull = setup.field.acceleration(setup.mass, f64::INFINITY, state.place);
    let [a, b] = normals;
    let presses = |pull: Vector| [-pull.perp(&b) / a.perp(&b), pull.perp(&a) / a.perp(&b)];
    let (rest, shaken) = (presses(pull), presses(-direction));
    let limits = wave.peaks().into_iter().flat_map(|peak| {
        rest.into_iter()
            .zip(shaken)
            .filter(move |(_, shaken)| shaken * peak < 0.0)
            .map(move |(rest, shaken)| rest / -(shaken * peak))
    });
    limits.reduce(f64::min)
}
