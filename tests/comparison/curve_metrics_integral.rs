//! Integral error measures of curves: Sprague-Geers (2004) and Russell (1997).

use approx::assert_abs_diff_eq;
use impactcheck::curves::{russell, sprague_geers};
use std::f64::consts::PI;

/// One period of a sine, `amplitude` and lag in rad; trapezoidal sums over a period are exact.
fn sine(amplitude: f64, lag: f64) -> Vec<f64> {
    (0..=1000).map(|k| amplitude * (2.0 * PI * f64::from(k) / 1000.0 - lag).sin()).collect()
}

/// Closed form for amplitude 1.2 and lag 0.2 pi: M = 0.2, P = 0.2.
#[test]
fn sprague_geers_of_a_scaled_late_sine() {
    let error = sprague_geers(&sine(1.0, 0.0), &sine(1.2, 0.2 * PI)).unwrap();
    assert_abs_diff_eq!(error.magnitude, 0.2, epsilon = 1e-12);
    assert_abs_diff_eq!(error.phase, 0.2, epsilon = 1e-12);
    assert_abs_diff_eq!(error.comprehensive, 0.08_f64.sqrt(), epsilon = 1e-12);
}

/// Closed form for amplitude 1.2 and lag 0.2 pi: x = 1.2 - 1/1.2, M = log10(1 + x), P = 0.2.
#[test]
fn russell_of_a_scaled_late_sine() {
    let error = russell(&sine(1.0, 0.0), &sine(1.2, 0.2 * PI)).unwrap();
    let magnitude = (1.0 + 1.2 - 1.0 / 1.2_f64).log10();
    assert_abs_diff_eq!(error.magnitude, magnitude, epsilon = 1e-12);
    assert_abs_diff_eq!(error.magnitude, 0.135663, epsilon = 1e-6);
    assert_abs_diff_eq!(error.phase, 0.2, epsilon = 1e-12);
    assert_abs_diff_eq!(error.comprehensive, 0.214174, epsilon = 1e-6);
}

/// Magnitude keeps its sign, phase stays in 0 ..= 1.
#[test]
fn sign_of_the_magnitude_and_phase_of_opposite_curves() {
    let weak = (sine(1.0, 0.0), sine(0.8, 0.0));
    assert_abs_diff_eq!(sprague_geers(&weak.0, &weak.1).unwrap().magnitude, -0.2, epsilon = 1e-12);
    assert!(russell(&weak.0, &weak.1).unwrap().magnitude < 0.0);
    let opposite = sine(-1.0, 0.0);
    assert_abs_diff_eq!(sprague_geers(&weak.0, &opposite).unwrap().phase, 1.0, epsilon = 1e-12);
    assert_abs_diff_eq!(russell(&weak.0, &opposite).unwrap().phase, 1.0, epsilon = 1e-12);
}

#[test]
fn undefined_for_a_vanishing_curve_and_for_nan() {
    let (wave, zero) = (sine(1.0, 0.0), vec![0.0; 1001]);
    assert!(sprague_geers(&zero, &wave).is_none() && russell(&wave, &zero).is_none());
    assert_eq!(sprague_geers(&zero, &zero).unwrap().comprehensive, 0.0);
    assert_eq!(russell(&zero, &zero).unwrap().comprehensive, 0.0);
    let mut broken = wave.clone();
    broken[3] = f64::NAN;
    assert!(sprague_geers(&wave, &broken).is_none() && russell(&wave, &broken).is_none());
    assert!(sprague_geers(&wave, &wave[1..]).is_none());
}
