//! Gauss-Legendre and Gauss-Radau quadrature.

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

/// Points in (-1, 1], ascending, the last of them 1, and weights of Radau's rule with `count` points, exact for degree
/// 2 count - 2.
pub fn gauss_radau(count: usize) -> (Vec<f64>, Vec<f64>) {
    // the zeros of P_(n-1) - P_n: one between any two neighbours among those of P_n, and 1
    let polynomials = |x: f64| -> [f64; 2] {
        (1..=count).fold([0.0, 1.0], |[before, value], n| {
            let n = n as f64;
            [value, ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n]
        })
    };
    let difference = |x: f64| polynomials(x)[0] - polynomials(x)[1];
    let (limits, _) = gauss_legendre(count);
    let point = |i: usize| {
        let (mut low, mut high) = (limits[i], limits[i + 1]);
        let sign = difference(low).signum();
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if difference(middle) * sign > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    };
    let points: Vec<f64> = (0..count).map(|i| if i + 1 == count { 1.0 } else { point(i) }).collect();
    let weight = |x: f64| (1.0 + x) / (count as f64 * polynomials(x)[0]).powi(2);
    let weights = points.iter().map(|x| weight(*x)).collect();
    (points, weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn assert_exact((points, weights): &(Vec<f64>, Vec<f64>), degrees: usize) {
        for degree in 0..degrees as i32 {
            let sum: f64 = points.iter().zip(weights).map(|(x, w)| w * x.powi(degree)).sum();
            let exact = if degree % 2 == 0 { 2.0 / f64::from(degree + 1) } else { 0.0 };
            assert_relative_eq!(sum, exact, epsilon = 1e-14);
        }
    }

    #[test]
    fn gauss_is_exact_up_to_degree_twice_the_points_less_one() {
        for count in 1..=12 {
            assert_exact(&gauss_legendre(count), 2 * count);
        }
    }

    #[test]
    fn radau_is_exact_up_to_one_degree_less_and_has_the_end() {
        for count in 1..=12 {
            let rule = gauss_radau(count);
            assert_exact(&rule, 2 * count - 1);
            assert_eq!(rule.0.last(), Some(&1.0));
            assert!(rule.0.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }
}
