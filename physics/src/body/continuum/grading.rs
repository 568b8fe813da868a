//! Graded subdivision of a line: small elements at its ends, growing geometrically up to a bound.

/// Wanted element size along a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grading {
    /// Element size at the start, m.
    pub start: f64,
    /// Element size at the end, m; infinite = no wish.
    pub end: f64,
    /// Largest element size, m.
    pub largest: f64,
    /// Ratio of adjacent sizes, > 1.
    pub growth: f64,
}

impl Grading {
    /// Wanted size at the distance `x` from the start of a line of length `length`.
    ///
    /// A size that grows linearly with slope ln(growth) gives elements in geometric progression.
    fn size(&self, x: f64, length: f64) -> f64 {
        let slope = self.growth.ln();
        self.largest.min(self.start + slope * x).min(self.end + slope * (length - x).max(0.0))
    }

    /// Breakpoints from exactly 0 to exactly `length`, strictly increasing, at least one element.
    pub fn breakpoints(&self, length: f64) -> Vec<f64> {
        let mut points = vec![0.0];
        let mut x = 0.0;
        while x < length {
            // Size at the middle of the element to come: a contraction, as half the slope is below 1.
            let mut step = self.size(x, length);
            for _ in 0..30 {
                step = self.size(x + 0.5 * step, length);
            }
            x += step;
            points.push(x);
        }
        // Drop the last point when that hits the end more closely, then stretch to fit.
        let n = points.len();
        if n > 2 && length - points[n - 2] < 0.5 * (points[n - 1] - points[n - 2]) {
            points.pop();
        }
        let last = points.len() - 1;
        let stretch = length / points[last];
        points.iter_mut().for_each(|p| *p *= stretch);
        points[last] = length;
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn breakpoints_are_ordered_graded_and_end_exactly() {
        for (start, end) in [(0.01, f64::INFINITY), (0.01, 0.02), (5.0, 0.003), (2.0, f64::INFINITY)] {
            let grading = Grading { start, end, largest: 0.2, growth: 1.3 };
            let points = grading.breakpoints(1.0);
            assert_eq!((points[0], points[points.len() - 1]), (0.0, 1.0));
            let sizes: Vec<f64> = points.windows(2).map(|p| p[1] - p[0]).collect();
            assert!(sizes.iter().all(|s| *s > 0.0 && *s < 0.2 * 1.2), "{sizes:?}");
            assert!(sizes[0] < 1.4 * start && sizes[sizes.len() - 1] < 1.4 * end, "{sizes:?}");
            for pair in sizes.windows(2) {
                assert!((1.0 / 1.35..1.35).contains(&(pair[1] / pair[0])), "{sizes:?}");
            }
        }
    }

    #[test]
    fn a_line_shorter_than_the_element_size_is_one_element() {
        let grading = Grading { start: 3.0, end: 3.0, largest: 3.0, growth: 1.2 };
        assert_eq!(grading.breakpoints(1.0), vec![0.0, 1.0]);
    }
}
