//! Time integrals of products of two curves, from which the integral error measures are made.

/// Trapezoidal integrals on a uniform axis, in units of the sampling interval (it cancels in every measure).
#[derive(Debug, Clone, Copy)]
pub(super) struct InnerProducts {
    /// Imm: the reference (measurement) with itself.
    pub(super) reference: f64,
    /// Icc: the candidate (computation) with itself.
    pub(super) candidate: f64,
    /// Imc.
    pub(super) mixed: f64,
}

impl InnerProducts {
    /// `None` for curves of different length, fewer than two samples or values that are not finite.
    pub(super) fn of(reference: &[f64], candidate: &[f64]) -> Option<Self> {
        let n = reference.len();
        if n < 2 || candidate.len() != n {
            return None;
        }
        let integral = |a: &[f64], b: &[f64]| {
            let sum: f64 = a.iter().zip(b).map(|(x, y)| x * y).sum();
            sum - 0.5 * (a[0] * b[0] + a[n - 1] * b[n - 1])
        };
        let products = InnerProducts {
            reference: integral(reference, reference),
            candidate: integral(candidate, candidate),
            mixed: integral(reference, candidate),
        };
        (products.reference.is_finite() && products.candidate.is_finite() && products.mixed.is_finite())
            .then_some(products)
    }

    /// Whether both curves are zero throughout.
    pub(super) fn both_vanish(&self) -> bool {
        self.reference == 0.0 && self.candidate == 0.0
    }

    /// arccos(Imc / sqrt(Imm Icc)) / pi; `None` if one of the curves vanishes.
    pub(super) fn phase(&self) -> Option<f64> {
        let norm = (self.reference * self.candidate).sqrt();
        // Rounding may carry the cosine of equal curves beyond 1.
        (norm > 0.0).then(|| (self.mixed / norm).clamp(-1.0, 1.0).acos() / std::f64::consts::PI)
    }
}
