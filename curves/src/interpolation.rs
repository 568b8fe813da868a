//! Monotone cubic interpolation: no overshoot where a curve has a kink, as a force has at first touch.
//!
//! F. N. Fritsch, J. Butland, "A method for constructing local monotone piecewise cubic
//! interpolants", SIAM J. Sci. Stat. Comput. 5 (1984), 300-304.

/// Piecewise cubic through given points, monotone wherever the points are.
pub struct MonotoneCubic<'a> {
    x: &'a [f64],
    y: &'a [f64],
    slope: Vec<f64>,
}

impl<'a> MonotoneCubic<'a> {
    /// Interpolant of `y` over strictly increasing `x`; both of the same length, at least 2.
    pub fn new(x: &'a [f64], y: &'a [f64]) -> Self {
        let n = x.len();
        let width: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
        let secant: Vec<f64> = y.windows(2).zip(&width).map(|(w, h)| (w[1] - w[0]) / h).collect();
        let mut slope = vec![0.0; n];
        slope[0] = end_slope(&width, &secant);
        let reversed = |values: &[f64]| values.iter().rev().take(2).copied().collect::<Vec<_>>();
        slope[n - 1] = end_slope(&reversed(&width), &reversed(&secant));
        for k in 1..n - 1 {
            let (left, right) = (secant[k - 1], secant[k]);
            if left * right > 0.0 {
                let (wl, wr) = (width[k - 1] + 2.0 * width[k], 2.0 * width[k - 1] + width[k]);
                slope[k] = (wl + wr) / (wl / left + wr / right);
            }
        }
        MonotoneCubic { x, y, slope }
    }

    /// Value at `x`; outside the points the nearest one's.
    pub fn at(&self, x: f64) -> f64 {
        let n = self.x.len();
        if x <= self.x[0] {
            return self.y[0];
        }
        if x >= self.x[n - 1] {
            return self.y[n - 1];
        }
        let k = self.x.partition_point(|&p| p <= x) - 1;
        let h = self.x[k + 1] - self.x[k];
        let s = (x - self.x[k]) / h;
        let (a, b) = (self.y[k], self.y[k + 1]);
        let rise = s * s * (3.0 - 2.0 * s);
        a + (b - a) * rise + h * s * (1.0 - s) * ((1.0 - s) * self.slope[k] - s * self.slope[k + 1])
    }
}

/// Slope at an end from a parabola through the three outermost points, limited so that the curve
/// stays monotone; `width` and `secant` of the intervals, the outermost first.
fn end_slope(width: &[f64], secant: &[f64]) -> f64 {
    let (&[h0, h1, ..], &[s0, s1, ..]) = (width, secant) else {
        return secant[0];
    };
    let slope = ((2.0 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
    if slope * s0 <= 0.0 {
        0.0
    } else if s0 * s1 < 0.0 && slope.abs() > 3.0 * s0.abs() {
        3.0 * s0
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::MonotoneCubic;

    /// Largest error of exp on an uneven axis of `n` intervals; the points themselves are met exactly.
    fn error_of_exponential(n: u32) -> f64 {
        let x: Vec<f64> = (0..=n).map(|k| (f64::from(k) / f64::from(n)).powi(2)).collect();
        let y: Vec<f64> = x.iter().map(|x| x.exp()).collect();
        let curve = MonotoneCubic::new(&x, &y);
        for (x, y) in x.iter().zip(&y) {
            assert!((curve.at(*x) - y).abs() < 1e-14);
        }
        (0..=5000).map(|k| f64::from(k) / 5000.0).map(|x| (curve.at(x) - x.exp()).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn converges_to_a_smooth_curve_with_third_order() {
        let order = (error_of_exponential(20) / error_of_exponential(80)).log2() / 2.0;
        assert!(order > 2.8, "order {order}");
    }

    #[test]
    fn never_overshoots_a_kink() {
        let x = [0.0, 1.0, 1.5, 3.0, 4.0];
        let y = [0.0, 0.0, 1.0, 1.0, 0.0];
        let curve = MonotoneCubic::new(&x, &y);
        for k in -10..=50 {
            let value = curve.at(f64::from(k) / 10.0);
            assert!((0.0..=1.0).contains(&value));
        }
        assert_eq!(curve.at(0.5), 0.0);
        assert_eq!(curve.at(2.0), 1.0);
    }
}
