//! The relative errors that estimates of a truncation are about.

use super::results::PlateQuantities;

/// The quantities that an estimated error covers, each by itself. The inner body's velocity goes with the efficiency; times of
/// release and numbers of contacts are not covered: a contact that just closes once more changes them by a jump.
pub const COVERED: [&str; 4] = ["efficiency", "outer_velocity_final", "outer_force_peak", "inner_force_peak"];
/// Errors of the efficiency are relative to it, or to this if it is smaller: that of an inner body with 3 % of the impact speed.
const SMALL_EFFICIENCY: f64 = 1e-3;

/// Largest relative error of the quantities [`COVERED`] in `candidate` against `exact`, and its name; `speed` in m/s is that of
/// the impact.
pub fn largest_error(
    candidate: &PlateQuantities,
    exact: &PlateQuantities,
    speed: f64,
) -> (f64, &'static str) {
    let error = |name: &'static str| {
        let value = |q: &PlateQuantities| q.get(name).unwrap_or(f64::NAN);
        let difference = (value(candidate) - value(exact)).abs();
        (if difference == 0.0 { 0.0 } else { difference / error_scale(name, exact, speed) }, name)
    };
    // a value that is not a number is the largest of all
    let larger =
        |a: (f64, &'static str), b: (f64, &'static str)| if a.0 >= b.0 || a.0.is_nan() { a } else { b };
    COVERED.into_iter().map(error).fold((0.0, COVERED[0]), larger)
}

/// What an error of the quantity `name` is relative to, in its unit; `speed` in m/s is that of the impact.
pub fn error_scale(name: &str, exact: &PlateQuantities, speed: f64) -> f64 {
    match name {
        "efficiency" => exact.efficiency.abs().max(SMALL_EFFICIENCY),
        "outer_velocity_final" => speed,
        _ => exact.get(name).map_or(f64::NAN, f64::abs),
    }
}

/// A relative error that is an estimate, in per cent with two digits.
pub(super) fn estimated_percent(error: f64) -> String {
    let percent = 100.0 * error;
    let decimals = (1.0 - percent.abs().max(1e-3).log10().floor()).clamp(0.0, 4.0);
    format!("{percent:.*} %", decimals as usize)
}
