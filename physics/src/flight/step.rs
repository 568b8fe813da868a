//! One step of Dormand & Prince's method of order 8: with steps of a fraction of the radius its error is at rounding, and a
//! parabola is exact.

use crate::numerics::explicit_runge_kutta::DORMAND_PRINCE_8;

/// State after `h` s from `y` at `time`, where y' = `rate`(time, y).
pub(super) fn step<const N: usize>(
    rate: impl Fn(f64, &[f64; N]) -> [f64; N],
    time: f64,
    y: &[f64; N],
    h: f64,
) -> [f64; N] {
    let (a, b) = DORMAND_PRINCE_8.weights();
    // at its end a step sees what was before it: a shock that ends there has its last value yet, not the 0 that follows
    let last = ((time + h) * (1.0 - 4.0 * f64::EPSILON)).max(time);
    let mut k = [[0.0; N]; 12];
    for (stage, weights) in a.iter().enumerate() {
        let node: f64 = weights.iter().sum();
        k[stage] = rate((time + h * node).min(last), &combined(y, h, weights, &k));
    }
    combined(y, h, b, &k)
}

fn combined<const N: usize>(y: &[f64; N], h: f64, weights: &[f64], k: &[[f64; N]; 12]) -> [f64; N] {
    let mut sum = [0.0; N];
    for (weight, k) in weights.iter().zip(k).filter(|(weight, _)| **weight != 0.0) {
        for (sum, k) in sum.iter_mut().zip(k) {
            *sum += weight * k;
        }
    }
    std::array::from_fn(|i| y[i] + h * sum[i])
}
