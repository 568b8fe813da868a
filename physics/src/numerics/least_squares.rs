//! Linear least squares with few unknowns.

use faer::Mat;
use faer::linalg::solvers::{DenseSolveCore, FullPivLu};

/// Coefficients, their standard errors, and what is left.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit<const N: usize> {
    /// In the units of the values over those of the basis. Shape (N).
    pub coefficients: [f64; N],
    /// Their standard errors, likewise. Shape (N).
    pub errors: [f64; N],
    /// Standard deviation of the values about the fit.
    pub deviation: f64,
}

/// Fits `sum_i coefficients[i] basis[i]` to the values; rows are (basis, value). `None` if the basis is not independent or
/// there are not more rows than coefficients.
pub fn fit<const N: usize>(rows: &[([f64; N], f64)]) -> Option<Fit<N>> {
    if rows.len() <= N {
        return None;
    }
    // columns of length one: the normal equations are then as well conditioned as scaling makes them
    let scale: [f64; N] = std::array::from_fn(|i| {
        rows.iter().map(|(b, _)| b[i] * b[i]).sum::<f64>().sqrt().max(f64::MIN_POSITIVE)
    });
    let normal =
        Mat::from_fn(N, N, |i, j| rows.iter().map(|(b, _)| b[i] * b[j]).sum::<f64>() / (scale[i] * scale[j]));
    let right: [f64; N] = std::array::from_fn(|i| rows.iter().map(|(b, y)| b[i] * y).sum::<f64>() / scale[i]);
    let inverse = FullPivLu::new(normal.as_ref()).inverse();
    let coefficients: [f64; N] =
        std::array::from_fn(|i| (0..N).map(|j| inverse[(i, j)] * right[j]).sum::<f64>() / scale[i]);
    let residual: f64 = rows
        .iter()
        .map(|(b, y)| (y - b.iter().zip(&coefficients).map(|(b, c)| b * c).sum::<f64>()).powi(2))
        .sum();
    let variance = residual / (rows.len() - N) as f64;
    let errors = std::array::from_fn(|i| (variance * inverse[(i, i)]).max(0.0).sqrt() / scale[i]);
    coefficients.iter().all(|c: &f64| c.is_finite()).then_some(Fit {
        coefficients,
        errors,
        deviation: variance.sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::fit;

    #[test]
    fn a_line_with_a_step_is_found_exactly() {
        let rows: Vec<([f64; 3], f64)> = (0..50)
            .map(|k| {
                let (t, step) = (1e-6 * f64::from(k), f64::from(u8::from(k >= 20)));
                ([1.0, t, step], 0.3 + 40.0 * t - 0.7 * step)
            })
            .collect();
        let found = fit(&rows).expect("independent");
        for (c, expected) in found.coefficients.iter().zip([0.3, 40.0, -0.7]) {
            assert!((c / expected - 1.0).abs() < 1e-10, "{found:?}");
        }
        assert!(found.errors[2] < 1e-12);
    }

    #[test]
    fn standard_error_of_a_mean() {
        // values 0 and 2: variance n/(n-1), of the mean 1/(n-1)
        let rows: Vec<([f64; 1], f64)> = (0..10).map(|k| ([1.0], f64::from(2 * (k % 2)))).collect();
        let found = fit(&rows).expect("mean");
        assert!((found.coefficients[0] - 1.0).abs() < 1e-14);
        assert!((found.errors[0] - (1.0_f64 / 9.0).sqrt()).abs() < 1e-12, "{found:?}");
        assert!(fit(&rows[..1]).is_none());
    }
}
