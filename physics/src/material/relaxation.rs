//! Relaxation of viscoelastic materials: Prony series with one kernel for bulk and shear.
//!
//! E(t) = E_0 (1 - sum g_i (1 - exp(-t/tau_i))); at the angular frequency w the complex modulus is
//! E_0 (1 - sum g_i / (1 + i w tau_i)) (Christensen, Theory of Viscoelasticity, 1982, section 1.6).

use nalgebra::{DMatrix, DVector};
use serde::Serialize;
use std::f64::consts::PI;

/// One term of a Prony series.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Relaxation {
    /// Share g of the instantaneous modulus that relaxes.
    pub ratio: f64,
    /// Time constant tau in s.
    pub time: f64,
}

/// Iterations for the frequency of a relaxing mode.
const FIXED_POINT: usize = 100;

/// Decades on either side of the frequency of a loss factor over which it is fitted.
const DECADES: i32 = 2;
/// Terms on either side, and their distance in decades: with a whole decade the loss factor would swing by 5 %.
const TERMS: i32 = 4;
const DISTANCE: f64 = 0.75;
/// Frequencies per decade at which the fit is made.
const SAMPLES: i32 = 8;
/// Largest relative error of a fitted loss factor that is admitted.
const FIT: f64 = 0.02;

/// Storage and loss modulus over the instantaneous modulus at `frequency` Hz.
pub fn modulus_ratio(terms: &[Relaxation], frequency: f64) -> [f64; 2] {
    terms.iter().fold([1.0, 0.0], |[storage, loss], term| {
        let x = 2.0 * PI * frequency * term.time;
        let share = term.ratio / (1.0 + x * x);
        [storage - share, loss + share * x]
    })
}

/// Frequency in Hz at which a body vibrates in a mode of `instantaneous` Hz: the fixed point of the storage modulus.
pub fn vibration_frequency(terms: &[Relaxation], instantaneous: f64) -> f64 {
    let at = |frequency: f64| instantaneous * modulus_ratio(terms, frequency)[0].sqrt();
    (0..FIXED_POINT).fold(instantaneous, |frequency, _| at(frequency))
}

/// Terms whose loss factor is `loss_factor` over two decades on either side of `frequency` Hz, and the largest relative error of it
/// there; `None` if there are none with positive ratios that hold it to 2 %.
pub fn fit_loss_factor(loss_factor: f64, frequency: f64) -> Option<(Vec<Relaxation>, f64)> {
    // the terms beyond the ends give what those within lack there
    let times: Vec<f64> =
        (-TERMS..=TERMS).map(|k| 10_f64.powf(DISTANCE * f64::from(k)) / (2.0 * PI * frequency)).collect();
    let frequencies: Vec<f64> = (-DECADES * SAMPLES..=DECADES * SAMPLES)
        .map(|k| frequency * 10_f64.powf(f64::from(k) / f64::from(SAMPLES)))
        .collect();
    // loss = loss factor times storage is linear in the ratios
    let system = DMatrix::from_fn(frequencies.len(), times.len(), |row, column| {
        let x = 2.0 * PI * frequencies[row] * times[column];
        (x + loss_factor) / (1.0 + x * x)
    });
    let target = DVector::from_element(frequencies.len(), loss_factor);
    let ratios = system.svd(true, true).solve(&target, 1e-12).ok()?;
    let terms: Vec<Relaxation> = ratios
        .iter()
        .zip(&times)
        .map(|(&ratio, &time)| Relaxation { ratio: rounded(ratio), time: rounded(time) })
        .collect();
    let error = |f: &f64| {
        let [storage, loss] = modulus_ratio(&terms, *f);
        (loss / storage / loss_factor - 1.0).abs()
    };
    let worst = frequencies.iter().map(error).fold(0.0, f64::max);
    let sound = terms.iter().all(|t| t.ratio > 0.0) && ratios.sum() < 1.0 && worst <= FIT;
    sound.then_some((terms, worst))
}

/// To nine digits: terms are part of a scene's identity, which rounding on another machine must not change.
fn rounded(value: f64) -> f64 {
    let unit = 10_f64.powi(value.abs().log10().floor() as i32 - 8);
    (value / unit).round() * unit
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The complex modulus is the transform of the relaxation: by quadrature over time.
    #[test]
    fn storage_and_loss_are_the_transform_of_the_relaxation() {
        let terms = [Relaxation { ratio: 0.3, time: 2e-5 }, Relaxation { ratio: 0.2, time: 3e-4 }];
        for frequency in [100.0, 8e3, 3e5] {
            let w = 2.0 * PI * frequency;
            let [mut storage, mut loss] = [1.0, 0.0];
            // i w times the transform of E(t) - E_0, of each term in its own variable e^(-t/tau)
            for term in &terms {
                let n = 200_000;
                for k in 0..n {
                    let t = 40.0 * term.time * (f64::from(k) + 0.5) / f64::from(n);
                    let weight = 40.0 / f64::from(n) * term.ratio * (-t / term.time).exp();
                    storage -= weight * (w * t).cos();
                    loss += weight * (w * t).sin();
                }
            }
            let [ours, lost] = modulus_ratio(&terms, frequency);
            assert!((ours - storage).abs() < 2e-4 && (lost - loss).abs() < 2e-4, "{frequency}");
        }
    }

    #[test]
    fn a_fitted_loss_factor_holds_over_four_decades() {
        for loss_factor in [1e-3, 0.02, 0.1, 0.3] {
            let (terms, worst) = fit_loss_factor(loss_factor, 1e4).unwrap();
            assert!(worst < FIT, "{loss_factor} {worst}");
            for frequency in [100.0, 700.0, 1e4, 2.3e5, 1e6] {
                let [storage, loss] = modulus_ratio(&terms, frequency);
                assert!(
                    (loss / storage / loss_factor - 1.0).abs() <= 1.05 * worst,
                    "{loss_factor} {frequency}"
                );
            }
        }
        assert!(fit_loss_factor(5.0, 1e4).is_none());
    }
}
