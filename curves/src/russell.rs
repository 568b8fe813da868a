//! Russell's error measure of two curves.
//!
//! D. M. Russell, "Error measures for comparing transient data: Part I: development of a
//! comprehensive error measure", Proc. 68th Shock and Vibration Symposium (1997), 175-184.

use super::inner_products::InnerProducts;
use std::f64::consts::FRAC_PI_4;

/// Magnitude, phase and comprehensive error; all 0 for equal curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Russell {
    /// M = sign(x) log10(1 + |x|) with x = (Icc - Imm) / sqrt(Imm Icc).
    pub magnitude: f64,
    /// P = arccos(Imc / sqrt(Imm Icc)) / pi, between 0 and 1.
    pub phase: f64,
    /// C = sqrt(pi/4 (M^2 + P^2)).
    pub comprehensive: f64,
}

/// Error of `candidate` against `reference`, both sampled on the same uniform time axis.
///
/// `None` where it is not defined: a curve that vanishes while the other does not, a value that
/// is not finite, curves of different length or of fewer than two samples.
pub fn russell(reference: &[f64], candidate: &[f64]) -> Option<Russell> {
    let products = InnerProducts::of(reference, candidate)?;
    if products.both_vanish() {
        return Some(Russell { magnitude: 0.0, phase: 0.0, comprehensive: 0.0 });
    }
    let phase = products.phase()?;
    let x = (products.candidate - products.reference) / (products.reference * products.candidate).sqrt();
    let magnitude = (1.0 + x.abs()).log10().copysign(x);
    let comprehensive = (FRAC_PI_4 * (magnitude.powi(2) + phase.powi(2))).sqrt();
    Some(Russell { magnitude, phase, comprehensive })
}
