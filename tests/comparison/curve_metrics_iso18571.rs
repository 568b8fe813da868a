//! ISO/TS 18571 rating against an independent implementation.
//!
//! The expected numbers were made with the PyPI package `objective-rating-metrics` 1.3 (VSI, TU Graz):
//! `ISO18571(reference, comparison)` with its default settings, unrounded (`corridor_rating(-1)`, ...),
//! on the signals below sampled at t = 0, 0.1 ms, ..., 150 ms.

use approx::assert_abs_diff_eq;
use impactcheck::curves::{Grade, iso18571};
use std::f64::consts::PI;

fn sampled(samples: usize, signal: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..samples).map(|k| signal(k as f64 * 1e-4)).collect()
}

/// Contact force of unit peak between `start` and `end`.
fn pulse(t: f64, start: f64, end: f64) -> f64 {
    if t > start && t < end { (PI * (t - start) / (end - start)).sin().max(0.0).powf(1.5) } else { 0.0 }
}

/// Velocity of a body that is turned from -0.55 m/s by `change` within `duration`.
fn turned(t: f64, change: f64, duration: f64) -> f64 {
    -0.55 + change * (1.0 - (PI * (t / duration).min(1.0)).cos()) / 2.0
}

/// Checks corridor, phase, magnitude, slope and overall rating, each to 0.001.
fn check(reference: &[f64], candidate: &[f64], expected: [f64; 5]) {
    let rating = iso18571(reference, candidate).expect("rating is defined");
    let found = [rating.corridor, rating.phase, rating.magnitude, rating.slope, rating.overall];
    for (found, expected) in found.into_iter().zip(expected) {
        assert_abs_diff_eq!(found, expected, epsilon = 0.001);
    }
}

#[test]
fn scaled_sine() {
    let reference = sampled(1501, |t| (20.0 * t).sin());
    let candidate = sampled(1501, |t| 1.3 * (20.0 * t).sin());
    check(&reference, &candidate, [0.478210549657509, 1.0, 0.760597347263203, 0.85, 0.7134036893156442]);
    assert_eq!(iso18571(&reference, &candidate).unwrap().grade(), Grade::Fair);
}

#[test]
fn late_sine() {
    check(
        &sampled(1501, |t| (20.0 * t).sin()),
        &sampled(1501, |t| (20.0 * (t - 0.01)).sin()),
        [0.6976252171795078, 0.6668887408394404, 1.0, 1.0, 0.8124278350396906],
    );
}

#[test]
fn early_sine() {
    let reference = sampled(1501, |t| (20.0 * t).sin());
    let candidate = sampled(1501, |t| (20.0 * (t + 0.004)).sin());
    check(&reference, &candidate, [0.9550921848344741, 0.8667554963357762, 1.0, 1.0, 0.9553879732009445]);
    assert_eq!(iso18571(&reference, &candidate).unwrap().grade(), Grade::Excellent);
}

#[test]
fn two_contacts_three_percent_too_weak() {
    let force = |t| 440.0 * pulse(t, 0.0, 0.08) + 160.0 * pulse(t, 0.08, 0.137);
    check(
        &sampled(1501, force),
        &sampled(1501, |t| 0.97 * force(t)),
        [1.0, 1.0, 0.9900878095195007, 0.985, 0.9950175619039003],
    );
}

#[test]
fn late_and_longer_contact() {
    check(
        &sampled(1501, |t| 440.0 * pulse(t, 0.0, 0.08)),
        &sampled(1501, |t| 432.0 * pulse(t, 0.003, 0.085)),
        [0.8865461247349392, 0.8667554963357762, 0.9941140399389372, 0.9712862815130178, 0.9210496134515219],
    );
}

#[test]
fn velocity_of_a_shorter_contact() {
    check(
        &sampled(1501, |t| turned(t, 0.85, 0.137)),
        &sampled(1501, |t| turned(t, 0.80, 0.12)),
        [0.8886165846489965, 0.653564290473018, 0.9342468141091339, 0.9438066626095296, 0.8617701872979351],
    );
}

#[test]
fn small_displacement_with_ripple() {
    check(
        &sampled(1501, |t| 1e-5 * (30.0 * t).sin() * (-5.0 * t).exp()),
        &sampled(1501, |t| 1e-5 * ((30.0 * t).sin() * (-8.0 * t).exp() + 0.05 * (900.0 * t).sin())),
        [0.7641373836344243, 0.9367088607594937, 0.8961759625178303, 0.0, 0.6722319181092345],
    );
}

#[test]
fn opposite_sign() {
    let reference = sampled(1501, |t| (20.0 * t).sin());
    let candidate = sampled(1501, |t| -(20.0 * t).sin());
    check(
        &reference,
        &candidate,
        [0.03670347569109099, 0.0006662225183210814, 0.0, 0.07874533145471707, 0.030563701071044027],
    );
    assert_eq!(iso18571(&reference, &candidate).unwrap().grade(), Grade::Poor);
}

#[test]
fn chirp_of_another_rate() {
    check(
        &sampled(1501, |t| (20.0 * t + 300.0 * t * t).sin()),
        &sampled(1501, |t| 1.1 * (20.0 * t + 330.0 * t * t).sin()),
        [0.6181759628866993, 0.8667554963357762, 0.9521512939867722, 0.9113802522510959, 0.7933277936694086],
    );
}

#[test]
fn equal_curves_rate_one_and_undefined_ones_do_not_rate() {
    let sine = sampled(101, |t| (200.0 * t).sin());
    assert_eq!(iso18571(&sine, &sine).unwrap().overall, 1.0);
    let zero = vec![0.0; 101];
    assert!(iso18571(&zero, &sine).is_none());
    assert!(iso18571(&sine, &sine[1..]).is_none());
    let mut broken = sine.clone();
    broken[50] = f64::NAN;
    assert!(iso18571(&sine, &broken).is_none());
}
