//! ISO/TS 18571:2014, "Road vehicles: objective rating metric for non-ambiguous signals".
//!
//! R = 0.4 Z + 0.2 EP + 0.2 EM + 0.2 ES of corridor, phase, magnitude and slope scores, each
//! between 0 and 1. The standard samples at 10 kHz; nothing here depends on the sampling interval
//! but the width of the slope's smoothing (nine samples) against the length of the signal.

use super::dynamic_time_warping::warping_path;
use serde::Serialize;

/// Half-width of the inner corridor over the reference's largest magnitude.
const INNER_CORRIDOR: f64 = 0.05;
/// Half-width of the outer corridor over the reference's largest magnitude.
const OUTER_CORRIDOR: f64 = 0.5;
/// Largest admissible shift, and with it the smallest overlap, over the length of the signal.
const LARGEST_SHIFT: f64 = 0.2;
/// Half-width of the warping band over the length of the shifted signal.
const WARPING_BAND: f64 = 0.1;
/// Magnitude error at which its score reaches 0.
const LARGEST_MAGNITUDE_ERROR: f64 = 0.5;
/// Slope error at which its score reaches 0.
const LARGEST_SLOPE_ERROR: f64 = 2.0;
/// Half-width in samples of the moving average over the slopes.
const SMOOTHING: usize = 4;

/// Grade of the overall rating.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// R > 0.94.
    Excellent,
    /// 0.80 < R <= 0.94.
    Good,
    /// 0.58 < R <= 0.80.
    Fair,
    /// R <= 0.58.
    Poor,
}

impl std::fmt::Display for Grade {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Grade::Excellent => "excellent",
            Grade::Good => "good",
            Grade::Fair => "fair",
            Grade::Poor => "poor",
        })
    }
}

/// Scores after ISO/TS 18571; 1 is best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iso18571 {
    /// Z: share of the corridors kept.
    pub corridor: f64,
    /// EP: shift of the highest cross-correlation.
    pub phase: f64,
    /// EM: amplitudes after shift and dynamic time warping.
    pub magnitude: f64,
    /// ES: slopes after shift.
    pub slope: f64,
    /// R, the weighted sum.
    pub overall: f64,
}

impl Iso18571 {
    /// Grade of the overall rating.
    pub fn grade(&self) -> Grade {
        match self.overall {
            r if r > 0.94 => Grade::Excellent,
            r if r > 0.80 => Grade::Good,
            r if r > 0.58 => Grade::Fair,
            _ => Grade::Poor,
        }
    }
}

/// Rates `candidate` against `reference`, both sampled on the same uniform time axis.
///
/// `None` where it is not defined: a reference that vanishes (unless the candidate equals it), a
/// value that is not finite, curves of different length or shorter than the slope's smoothing.
pub fn iso18571(reference: &[f64], candidate: &[f64]) -> Option<Iso18571> {
    let finite = reference.iter().chain(candidate).all(|x| x.is_finite());
    if !finite || reference.len() != candidate.len() || reference.len() <= 2 * SMOOTHING {
        return None;
    }
    if reference == candidate {
        return Some(Iso18571 { corridor: 1.0, phase: 1.0, magnitude: 1.0, slope: 1.0, overall: 1.0 });
    }
    if reference.iter().all(|&x| x == 0.0) {
        return None;
    }
    let corridor = corridor(reference, candidate);
    let shift = best_shift(reference, candidate);
    let admissible = LARGEST_SHIFT * reference.len() as f64;
    let phase = linear_score(shift.samples() as f64, admissible);
    let (reference, candidate) = shift.apply(reference, candidate);
    let magnitude = magnitude(reference, candidate);
    let slope = linear_score(
        relative_distance(&smoothed_slope(reference), &smoothed_slope(candidate)),
        LARGEST_SLOPE_ERROR,
    );
    let overall = 0.4 * corridor + 0.2 * (phase + magnitude + slope);
    Some(Iso18571 { corridor, phase, magnitude, slope, overall })
}

/// 1 at no error, 0 from `largest` on.
fn linear_score(error: f64, largest: f64) -> f64 {
    ((largest - error) / largest).clamp(0.0, 1.0)
}

/// ||c - m||_1 / ||m||_1; 0 for equal curves also when they vanish.
fn relative_distance(reference: &[f64], candidate: &[f64]) -> f64 {
    let distance: f64 = reference.iter().zip(candidate).map(|(m, c)| (c - m).abs()).sum();
    let norm: f64 = reference.iter().map(|m| m.abs()).sum();
    if distance == 0.0 { 0.0 } else { distance / norm }
}

/// Mean over the samples: 1 in the inner corridor, 0 outside the outer one, quadratic between.
fn corridor(reference: &[f64], candidate: &[f64]) -> f64 {
    let peak = reference.iter().fold(0.0_f64, |p, m| p.max(m.abs()));
    let (inner, outer) = (INNER_CORRIDOR * peak, OUTER_CORRIDOR * peak);
    let score = |distance: f64| {
        if distance < inner {
            1.0
        } else if distance > outer {
            0.0
        } else {
            ((outer - distance) / (outer - inner)).powi(2)
        }
    };
    let sum: f64 = reference.iter().zip(candidate).map(|(m, c)| score((c - m).abs())).sum();
    sum / reference.len() as f64
}

/// Shift of the candidate in samples.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shift {
    /// The candidate is late: its first samples are dropped.
    Left(usize),
    /// The candidate is early: its last samples are dropped.
    Right(usize),
}

impl Shift {
    fn samples(self) -> usize {
        match self {
            Shift::Left(m) | Shift::Right(m) => m,
        }
    }

    /// Both curves where they overlap once the candidate is shifted.
    fn apply<'a>(self, reference: &'a [f64], candidate: &'a [f64]) -> (&'a [f64], &'a [f64]) {
        let n = reference.len();
        match self {
            Shift::Left(m) => (&reference[..n - m], &candidate[m..]),
            Shift::Right(m) => (&reference[m..], &candidate[..n - m]),
        }
    }
}

/// Correlation coefficient of two curves (their means removed); 0 if one of them is constant.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        let (x, y) = (x - mean_a, y - mean_b);
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    let norm = (aa * bb).sqrt();
    if norm > 0.0 { ab / norm } else { 0.0 }
}

/// The shift of highest correlation, the smallest one among equals.
fn best_shift(reference: &[f64], candidate: &[f64]) -> Shift {
    let largest = (LARGEST_SHIFT * reference.len() as f64).floor() as usize;
    let shifts = (0..=largest).flat_map(|m| [Shift::Left(m), Shift::Right(m)]);
    let mut best = (f64::NEG_INFINITY, Shift::Left(0));
    for shift in shifts {
        let (m, c) = shift.apply(reference, candidate);
        let value = correlation(m, c);
        if value > best.0 {
            best = (value, shift);
        }
    }
    best.1
}

/// Score of the amplitudes after dynamic time warping.
fn magnitude(reference: &[f64], candidate: &[f64]) -> f64 {
    let band = (WARPING_BAND * reference.len() as f64).ceil() as usize;
    let path = warping_path(reference, candidate, band);
    let (m, c): (Vec<f64>, Vec<f64>) = path.into_iter().map(|(i, j)| (reference[i], candidate[j])).unzip();
    linear_score(relative_distance(&m, &c), LARGEST_MAGNITUDE_ERROR)
}

/// Central differences (one-sided at the ends) per sample, then a moving average over nine
/// samples, over fewer near the ends so that it stays centred.
fn smoothed_slope(curve: &[f64]) -> Vec<f64> {
    let n = curve.len();
    let slope: Vec<f64> = (0..n)
        .map(|i| match i {
            0 => curve[1] - curve[0],
            i if i == n - 1 => curve[n - 1] - curve[n - 2],
            i => 0.5 * (curve[i + 1] - curve[i - 1]),
        })
        .collect();
    (0..n)
        .map(|i| {
            let half = SMOOTHING.min(i).min(n - 1 - i);
            slope[i - half..=i + half].iter().sum::<f64>() / (2 * half + 1) as f64
        })
        .collect()
}
