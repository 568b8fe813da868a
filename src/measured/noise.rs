//! Standard errors of least squares on a signal whose noise is limited to a band: its samples are not independent.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::f64::consts::{PI, SQRT_2};
use std::ops::Range;

/// Corner frequencies that are tried besides white noise, over the instrument's bandwidth: lowest, highest, number.
const CORNERS: (f64, f64, usize) = (0.05, 4.0, 20);
/// Part by which the ratio of von Neumann is lowered, times the number of values: few values tell the corner poorly, and a corner that
/// is too high makes the intervals too narrow.
const LOWERED: f64 = 3.5;
/// Quantile of the normal distribution for intervals of 95 %.
pub const NORMAL_95: f64 = 1.96;
/// Fewest values that show whether they are independent.
const LEAST_SHOWN: usize = 30;

/// Groups of samples at increasing times, each `width` s long at most.
pub fn groups(time: &[f64], width: f64) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = 0;
    for k in 1..=time.len() {
        if k == time.len() || time[k] - time[start] >= width * (1.0 - 1e-9) {
            found.push(start..k);
            start = k;
        }
    }
    found
}

/// Means of `values` over `groups`.
pub fn means(values: &[f64], groups: &[Range<usize>]) -> Vec<f64> {
    groups.iter().map(|g| values[g.clone()].iter().sum::<f64>() / g.len() as f64).collect()
}

/// Whether neighbours among residuals differ as independent ones do (ratio of von Neumann, within two standard errors).
pub fn looks_white(left: &[f64]) -> bool {
    let squares: f64 = left.iter().map(|r| r * r).sum();
    let differences: f64 = left.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
    left.len() >= LEAST_SHOWN && differences > (2.0 - 4.0 / (left.len() as f64).sqrt()) * squares
}

/// Stationary noise behind a low-pass filter of second order (Butterworth), found from the residuals of a fit.
///
/// Its autocovariance is `variance exp(-a) (cos a + sin a)`, a = sqrt(2) pi corner |lag|.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Variance of a value, in the square of the signal's unit, for intervals of 1.96 standard errors: widened to those of Student's
    /// distribution with as many degrees of freedom as the residuals have.
    pub variance: f64,
    /// -3 dB frequency in Hz; infinite for white noise.
    pub corner: f64,
}

/// What noise of one corner frequency leads one to expect of the residuals.
struct Expected {
    corner: f64,
    /// Ratio of von Neumann: squared differences of neighbours over squares.
    ratio: f64,
    /// Sum of squares over the variance, and its degrees of freedom.
    squares: f64,
    freedom: f64,
}

impl Noise {
    /// From the values at `time` less their least-squares fit on the columns of `basis`; neighbours in time are compared within
    /// `segments`. The corner is that whose expected ratio of squared differences to squares is the one found. `bandwidth` in Hz is the instrument's.
    /// `None` if there are too few values.
    pub fn of(
        (time, values): (&[f64], &DVector<f64>),
        basis: &DMatrix<f64>,
        segments: &[Range<usize>],
        bandwidth: f64,
    ) -> Option<Self> {
        let count = time.len();
        if count < basis.ncols() + 2 {
            return None;
        }
        let space = orthonormal(basis);
        let left = values - &space * space.tr_mul(values);
        let squares = left.norm_squared();
        if squares <= f64::MIN_POSITIVE {
            return Some(Noise { variance: 0.0, corner: f64::INFINITY });
        }
        let neighbours = |v: &dyn Fn(usize) -> f64| -> f64 {
            segments.iter().flat_map(|s| (s.start + 1..s.end).map(|k| (v(k) - v(k - 1)).powi(2))).sum()
        };
        let ratio = neighbours(&|k| left[k]) / squares * (1.0 - LOWERED / count as f64).max(0.0);
        let expected = |corner: f64| {
            let covariance = correlation(time, corner);
            // P V P with P = 1 - Q Q'
            let half = &covariance - &space * space.tr_mul(&covariance);
            let of_left = &half - (&half * &space) * space.transpose();
            let squares = of_left.trace();
            let pair = |k: usize| of_left[(k, k)] + of_left[(k - 1, k - 1)] - 2.0 * of_left[(k, k - 1)];
            let differences: f64 = segments.iter().flat_map(|s| (s.start + 1..s.end).map(pair)).sum();
            Expected {
                corner,
                ratio: differences / squares,
                squares,
                freedom: squares.powi(2) / of_left.norm_squared(),
            }
        };
        let found = matching(ratio, bandwidth, expected);
        let student = StudentsT::new(0.0, 1.0, found.freedom.max(1.0)).ok()?.inverse_cdf(0.975);
        let variance = squares / found.squares * (student / NORMAL_95).powi(2);
        Some(Noise { variance, corner: found.corner })
    }

    /// Covariance of the values at `time`. Shape (times, times).
    pub fn covariance(&self, time: &[f64]) -> DMatrix<f64> {
        correlation(time, self.corner) * self.variance
    }
}

/// What is expected at the corner frequency whose ratio is `ratio`; the ratio increases with it.
fn matching(ratio: f64, bandwidth: f64, expected: impl Fn(f64) -> Expected) -> Expected {
    let (low, high, steps) = CORNERS;
    let corner = |k: usize| bandwidth * low * (high / low).powf(k as f64 / (steps - 1) as f64);
    let mut above = expected(f64::INFINITY);
    for k in (0..steps).rev() {
        if above.ratio <= ratio {
            return above;
        }
        let below = expected(corner(k));
        if below.ratio <= ratio {
            if above.corner.is_infinite() {
                return below;
            }
            let part = (ratio - below.ratio) / (above.ratio - below.ratio).max(f64::MIN_POSITIVE);
            return expected(below.corner * (above.corner / below.corner).powf(part));
        }
        above = below;
    }
    above
}

/// Correlation of noise with the -3 dB frequency `corner`. Shape (times, times).
fn correlation(time: &[f64], corner: f64) -> DMatrix<f64> {
    DMatrix::from_fn(time.len(), time.len(), |i, j| {
        if i == j {
            return 1.0;
        }
        let a = SQRT_2 * PI * corner * (time[i] - time[j]).abs();
        if a > 40.0 { 0.0 } else { (-a).exp() * (a.cos() + a.sin()) }
    })
}

/// Orthonormal columns that span those of `basis`.
pub fn orthonormal(basis: &DMatrix<f64>) -> DMatrix<f64> {
    if basis.ncols() == 0 { basis.clone() } else { basis.clone().qr().q() }
}

/// Least squares on a signal with such noise.
#[derive(Debug, Clone)]
pub struct Estimate {
    /// One a column of the basis.
    pub coefficients: DVector<f64>,
    /// Their covariance, for intervals of 1.96 standard errors. Shape (columns, columns).
    pub covariance: DMatrix<f64>,
}

impl Estimate {
    /// The coefficients of the columns of `basis` that fit the values at `time`; see [`Noise::of`].
    pub fn of(
        (time, values): (&[f64], &DVector<f64>),
        basis: &DMatrix<f64>,
        segments: &[Range<usize>],
        bandwidth: f64,
    ) -> Option<Self> {
        // columns of length one
        let scale = DVector::from_iterator(
            basis.ncols(),
            basis.column_iter().map(|c| c.norm().max(f64::MIN_POSITIVE)),
        );
        let scaled = DMatrix::from_fn(basis.nrows(), basis.ncols(), |i, j| basis[(i, j)] / scale[j]);
        let noise = Noise::of((time, values), &scaled, segments, bandwidth)?;
        let mut inverse = scaled.pseudo_inverse(1e-10).ok()?;
        for (j, mut row) in inverse.row_iter_mut().enumerate() {
            row /= scale[j];
        }
        Some(Estimate {
            coefficients: &inverse * values,
            covariance: &inverse * noise.covariance(time) * inverse.transpose(),
        })
    }

    /// Coefficient number `k` over its standard error; infinite where nothing scatters.
    pub fn significance(&self, k: usize) -> f64 {
        self.coefficients[k].abs() / self.covariance[(k, k)].max(0.0).sqrt()
    }
}
