//! Interpolation through Chebyshev points.

use std::f64::consts::FRAC_PI_2;

/// Polynomials through `count` Chebyshev points of the first kind in `from..to`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chebyshev {
    pub(crate) from: f64,
    pub(crate) to: f64,
    /// Ascending. Shape (count).
    pub(crate) nodes: Vec<f64>,
    /// Barycentric. Shape (count).
    factors: Vec<f64>,
}

impl Chebyshev {
    pub(crate) fn new(from: f64, to: f64, count: usize) -> Self {
        let angle = |j: usize| FRAC_PI_2 * (2 * j + 1) as f64 / count as f64;
        let node = |j: usize| from + (to - from) * 0.5 * (1.0 - angle(j).cos());
        let factor = |j: usize| if j.is_multiple_of(2) { angle(j).sin() } else { -angle(j).sin() };
        Self { from, to, nodes: (0..count).map(node).collect(), factors: (0..count).map(factor).collect() }
    }

    /// What the values at the nodes are multiplied by and summed to have the polynomial at `x` (barycentric: Berrut & Trefethen,
    /// SIAM Rev. 46, 2004, 501). Shape (count).
    pub(crate) fn weights(&self, x: f64) -> Vec<f64> {
        if let Some(at) = self.nodes.iter().position(|node| *node == x) {
            return (0..self.nodes.len()).map(|j| f64::from(u8::from(j == at))).collect();
        }
        let pairs = self.factors.iter().zip(&self.nodes);
        let mut weights: Vec<f64> = pairs.map(|(factor, node)| factor / (x - node)).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        weights
    }
}

/// Sum of the `rows` times their `weights`. Shape of a row.
pub(crate) fn blend<'a>(weights: &[f64], rows: impl IntoIterator<Item = &'a Vec<f64>>) -> Vec<f64> {
    let mut sum = Vec::new();
    for (weight, row) in weights.iter().zip(rows) {
        sum.resize(row.len(), 0.0);
        sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_polynomial_and_a_smooth_function_come_back() {
        let points = Chebyshev::new(0.5, 2.0, 12);
        for x in [0.5, 0.77, points.nodes[3], 1.9, 2.0] {
            let at = |f: fn(f64) -> f64| -> f64 {
                points.weights(x).iter().zip(&points.nodes).map(|(w, node)| w * f(*node)).sum()
            };
            assert_relative_eq!(at(|x| 1.0 - x + x.powi(11)), 1.0 - x + x.powi(11), max_relative = 1e-13);
            assert_relative_eq!(at(f64::exp), x.exp(), max_relative = 1e-12);
        }
    }
}
