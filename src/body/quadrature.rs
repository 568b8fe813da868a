//! Gauss-Legendre quadrature.

/// Points in (-1, 1), ascending, and weights of the rule with `count` points, exact for degree 2 count - 1.
pub fn gauss_legendre(count: usize) -> (Vec<f64>, Vec<f64>) {
    let mut points = vec![0.0; count];
    let mut weights = vec![0.0; count];
    for i in 0..count {
        // Newton's iteration from Tricomi's estimate
        let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (count as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut previous, mut value) = (1.0, x);
            for n in 1..count {
                let next = ((2 * n + 1) as f64 * x * value - n as f64 * previous) / (n + 1) as f64;
                (previous, value) = (value, next);
            }
            slope = count as f64 * (x * value - previous) / (x * x - 1.0);
            let change = value / slope;
            x -= change;
            if change.abs() < 1e-15 {
                break;
            }
        }
        points[i] = x;
        weights[i] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
    (points, weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn exact_up_to_degree_twice_the_points_less_one() {
        for count in 1..=12 {
            let (points, weights) = gauss_legendre(count);
            for degree in 0..2 * count as i32 {
                let sum: f64 = points.iter().zip(&weights).map(|(x, w)| w * x.powi(degree)).sum();
                let exact = if degree % 2 == 0 { 2.0 / f64::from(degree + 1) } else { 0.0 };
                assert_relative_eq!(sum, exact, epsilon = 1e-14);
            }
        }
    }
}
