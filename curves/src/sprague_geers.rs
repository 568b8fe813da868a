//! Sprague and Geers' error measure of two curves.
//!
//! M. A. Sprague, T. L. Geers, "A spectral-element method for modelling cavitation in transient
//! fluid-structure interaction", Int. J. Numer. Meth. Engng 60 (2004), 2467-2499.

use super::inner_products::InnerProducts;

/// Magnitude, phase and comprehensive error; all 0 for equal curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpragueGeers {
    /// M = sqrt(Icc / Imm) - 1: 0.2 means the candidate is 20 % larger, whatever the phase.
    pub magnitude: f64,
    /// P = arccos(Imc / sqrt(Imm Icc)) / pi, between 0 and 1, whatever the magnitude.
    pub phase: f64,
    /// C = sqrt(M^2 + P^2).
    pub comprehensive: f64,
}

/// Error of `candidate` against `reference`, both sampled on the same uniform time axis.
///
/// `None` where it is not defined: a curve that vanishes while the other does not, a value that
/// is not finite, curves of different length or of fewer than two samples.
pub fn sprague_geers(reference: &[f64], candidate: &[f64]) -> Option<SpragueGeers> {
    let products = InnerProducts::of(reference, candidate)?;
    if products.both_vanish() {
        return Some(SpragueGeers { magnitude: 0.0, phase: 0.0, comprehensive: 0.0 });
    }
    let phase = products.phase()?;
    let magnitude = (products.candidate / products.reference).sqrt() - 1.0;
    Some(SpragueGeers { magnitude, phase, comprehensive: magnitude.hypot(phase) })
}
