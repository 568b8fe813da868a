//! Standard errors of least squares on a signal whose noise is limited to a band: its samples are not independent.

use nalgebra::{Cholesky, DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::f64::consts::PI;
use std::ops::Range;

/// Orders of the low-pass filters (Butterworth) that may have limited the noise: from a single pole to a steep filter. One, or even: the poles are
/// mirrored in pairs.
const ORDERS: [u8; 3] = [1, 2, 6];
/// Their -3 dB frequencies over the instrument's bandwidth: lowest, highest, number.
const CORNERS: (f64, f64, usize) = (0.05, 4.0, 12);
/// White parts of the variance behind the filter.
const WHITE: [f64; 2] = [1e-4, 1e-2];
/// Weight, over that of the most likely spectrum, below which a spectrum is left out.
const NEGLIGIBLE: f64 = 1e-3;
/// Relative accuracy of a half width.
const RESOLUTION: f64 = 1e-4;
/// Quantile of the normal distribution for intervals of 95 %.
pub const NORMAL_95: f64 = 1.96;

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

/// A low-pass filter that may have limited the noise.
struct Filter {
    order: u8,
    /// -3 dB frequency in Hz.
    corner: f64,
}

impl Filter {
    /// Those that are tried for an instrument with a `bandwidth` in Hz.
    fn all(bandwidth: f64) -> impl Iterator<Item = Self> {
        let (low, high, steps) = CORNERS;
        let corner = move |k: usize| bandwidth * low * (high / low).powf(k as f64 / (steps - 1) as f64);
        ORDERS.into_iter().flat_map(move |order| (0..steps).map(move |k| Filter { order, corner: corner(k) }))
    }

    /// Correlation of white noise behind it at `time`. Shape (times, times).
    fn correlation(&self, time: &[f64]) -> DMatrix<f64> {
        // residues of the spectrum 1/(1 + (f/corner)^(2 order)) at its poles; mirrored ones have the same
        let order = usize::from(self.order);
        let pole = |k: usize| (PI * (2 * k + 1) as f64 / (2 * order) as f64).sin_cos();
        let poles: Vec<(f64, f64)> = (0..order.div_ceil(2)).map(pole).collect();
        let residue = |x: f64, (sine, cosine): &(f64, f64)| {
            let (wave, quarter) = (x * cosine).sin_cos();
            (-x * sine).exp() * (sine * quarter + cosine * wave)
        };
        let power: f64 = poles.iter().map(|(sine, _)| sine).sum();
        let mut correlation = DMatrix::identity(time.len(), time.len());
        for j in 0..time.len() {
            for i in j + 1..time.len() {
                let x = 2.0 * PI * self.corner * (time[i] - time[j]).abs();
                correlation[(i, j)] = poles.iter().map(|pole| residue(x, pole)).sum::<f64>() / power;
                correlation[(j, i)] = correlation[(i, j)];
            }
        }
        correlation
    }
}

/// Correlations of the values at `time` that are possible: of white noise, and of noise that a filter limits, with a little white noise behind
/// it. Shapes (times, times).
fn correlations(time: &[f64], bandwidth: f64) -> impl Iterator<Item = DMatrix<f64>> {
    let with_white = |correlation: DMatrix<f64>| {
        WHITE.map(|white| {
            let mut sum = &correlation * (1.0 - white);
            sum.fill_diagonal(1.0);
            sum
        })
    };
    let filtered = Filter::all(bandwidth).flat_map(move |filter| with_white(filter.correlation(time)));
    std::iter::once(DMatrix::identity(time.len(), time.len())).chain(filtered)
}

/// Stationary noise, found from the residuals of a fit: a few values do not show its spectrum, so it is a mixture of those that they leave open.
#[derive(Debug, Clone, PartialEq)]
pub struct Noise {
    components: Vec<Component>,
}

/// Noise of one spectrum.
#[derive(Debug, Clone, PartialEq)]
struct Component {
    /// Its probability; the sum of all is 1.
    weight: f64,
    /// Covariance of the values in the square of the signal's unit. Shape (times, times).
    covariance: DMatrix<f64>,
    /// Distribution of an error over its standard deviation, with as many degrees of freedom as the residuals have.
    student: StudentsT,
}

impl Component {
    /// Half width of the 95 % interval over 1.96 standard deviations.
    fn widening(&self) -> f64 {
        self.student.inverse_cdf(0.975) / NORMAL_95
    }
}

/// Residuals of a fit.
struct Residuals {
    /// Orthonormal columns that the fit has used.
    space: DMatrix<f64>,
    left: DVector<f64>,
}

impl Residuals {
    /// Logarithm of the restricted likelihood (Patterson and Thompson 1971) of noise with this `correlation` and any variance, up to a
    /// constant.
    fn likelihood(&self, correlation: &DMatrix<f64>) -> Option<f64> {
        let factor = Cholesky::new(correlation.clone())?;
        let lower = factor.l_dirty();
        let space = lower.solve_lower_triangular(&self.space)?;
        let left = lower.solve_lower_triangular(&self.left)?;
        let along = space.tr_mul(&left);
        let inner = Cholesky::new(space.tr_mul(&space))?;
        let squares = left.norm_squared() - along.dot(&inner.solve(&along));
        let determinant = |lower: &DMatrix<f64>| 2.0 * lower.diagonal().map(f64::ln).sum();
        let freedom = (self.left.len() - self.space.ncols()) as f64;
        let spread = determinant(lower) + determinant(inner.l_dirty());
        Some(-0.5 * (spread + freedom * squares.max(f64::MIN_POSITIVE).ln()))
    }

    /// Noise with this `correlation` and the variance that the sum of the squares leads to.
    fn component(&self, weight: f64, correlation: DMatrix<f64>) -> Option<Component> {
        // P V P with P = 1 - Q Q'
        let across = &correlation * &self.space;
        let within = self.space.tr_mul(&across);
        let squares = correlation.trace() - within.trace();
        let norm = correlation.norm_squared() - 2.0 * across.norm_squared() + within.norm_squared();
        let student = StudentsT::new(0.0, 1.0, (squares.powi(2) / norm).max(1.0)).ok()?;
        Some(Component { weight, covariance: correlation * (self.left.norm_squared() / squares), student })
    }
}

impl Noise {
    /// From the values at `time` less their least-squares fit on the columns of `basis`. Before the values are seen every spectrum is as likely
    /// as any other. `bandwidth` in Hz is the instrument's. `None` if there are too few values.
    pub fn of((time, values): (&[f64], &DVector<f64>), basis: &DMatrix<f64>, bandwidth: f64) -> Option<Self> {
        if time.len() < basis.ncols() + 2 {
            return None;
        }
        let space = orthonormal(basis);
        let left = values - &space * space.tr_mul(values);
        if left.norm_squared() <= f64::MIN_POSITIVE {
            return Some(Noise { components: Vec::new() });
        }
        let residuals = Residuals { space, left };
        let possible: Vec<(f64, DMatrix<f64>)> = correlations(time, bandwidth)
            .filter_map(|correlation| Some((residuals.likelihood(&correlation)?, correlation)))
            .collect();
        let most = possible.iter().fold(f64::NEG_INFINITY, |most, (likelihood, _)| most.max(*likelihood));
        let components = possible.into_iter().filter(|(likelihood, _)| likelihood - most > NEGLIGIBLE.ln());
        let component = |(likelihood, correlation): (f64, DMatrix<f64>)| {
            residuals.component((likelihood - most).exp(), correlation)
        };
        let mut components = components.map(component).collect::<Option<Vec<_>>>()?;
        let total: f64 = components.iter().map(|component| component.weight).sum();
        components.iter_mut().for_each(|component| component.weight /= total);
        Some(Noise { components })
    }

    /// Covariance of the values, for intervals of 1.96 standard errors. Shape (times, times).
    pub fn covariance(&self, count: usize) -> DMatrix<f64> {
        let of =
            |component: &Component| &component.covariance * (component.weight * component.widening().powi(2));
        self.components.iter().map(of).fold(DMatrix::zeros(count, count), |sum, part| sum + part)
    }

    /// Half width over 1.96 of the 95 % interval of the sum of the values times those of `row`.
    fn standard_error(&self, row: &DVector<f64>) -> f64 {
        let deviation = |component: &Component| row.dot(&(&component.covariance * row)).max(0.0).sqrt();
        let deviations: Vec<f64> = self.components.iter().map(deviation).collect();
        let outside = |half_width: f64| -> f64 {
            let of = |(component, deviation): (&Component, &f64)| {
                2.0 * component.weight * component.student.sf(half_width / deviation)
            };
            self.components.iter().zip(&deviations).map(of).sum()
        };
        // no wider than that of its widest component
        let half_widths = self.components.iter().zip(&deviations).map(|(c, d)| NORMAL_95 * c.widening() * d);
        let (mut low, mut high) = (0.0, half_widths.fold(0.0, f64::max));
        while high - low > RESOLUTION * high {
            let middle = 0.5 * (low + high);
            *(if outside(middle) > 0.05 { &mut low } else { &mut high }) = middle;
        }
        high / NORMAL_95
    }
}

/// Orthonormal columns that span those of `basis`.
pub fn orthonormal(basis: &DMatrix<f64>) -> DMatrix<f64> {
    if basis.ncols() == 0 { basis.clone() } else { basis.clone().qr().q() }
}

/// Least squares on a signal with such noise.
#[derive(Debug, Clone)]
pub struct SignalFit {
    /// One a column of the basis.
    pub coefficients: DVector<f64>,
    /// Their standard errors, for intervals of 1.96 of them. Shape (columns).
    pub errors: DVector<f64>,
}

impl SignalFit {
    /// The coefficients of the columns of `basis` that fit the values at `time`; see [`Noise::of`].
    pub fn of((time, values): (&[f64], &DVector<f64>), basis: &DMatrix<f64>, bandwidth: f64) -> Option<Self> {
        // columns of length one
        let scale = basis.column_iter().map(|c| c.norm().max(f64::MIN_POSITIVE));
        let scale = DVector::from_iterator(basis.ncols(), scale);
        let scaled = DMatrix::from_fn(basis.nrows(), basis.ncols(), |i, j| basis[(i, j)] / scale[j]);
        let noise = Noise::of((time, values), &scaled, bandwidth)?;
        let inverse = scaled.pseudo_inverse(1e-10).ok()?;
        let errors = inverse.row_iter().map(|row| noise.standard_error(&row.transpose()));
        let errors = DVector::from_iterator(basis.ncols(), errors);
        Some(SignalFit {
            coefficients: (&inverse * values).component_div(&scale),
            errors: errors.component_div(&scale),
        })
    }

    /// Coefficient number `k` over its standard error; infinite where nothing scatters.
    pub fn significance(&self, k: usize) -> f64 {
        self.coefficients[k].abs() / self.errors[k]
    }
}
