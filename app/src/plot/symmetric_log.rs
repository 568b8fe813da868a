//! An axis for signed values of very different sizes: linear about zero, logarithmic farther out.

/// Relative discrepancy up to which the axis is about linear.
const LINEAR: f64 = 1e-4;
/// The axis ends between these, at a power of ten.
const LIMITS: [f64; 2] = [1e-2, 10.0];

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SymmetricLog {
    /// Size up to which it is about linear.
    pub(crate) linear: f64,
    /// Size at which it ends.
    pub(crate) limit: f64,
    /// Whether it has two sides.
    pub(crate) signed: bool,
}

impl SymmetricLog {
    /// An axis that shows `values`.
    pub(crate) fn over(values: impl Iterator<Item = f64>, signed: bool) -> Self {
        let largest = values.map(f64::abs).filter(|v| v.is_finite()).fold(LIMITS[0], f64::max);
        // a value just beyond a power of ten needs no decade of its own
        let limit = 10_f64.powf((largest / 1.6).log10().ceil()).clamp(LIMITS[0], LIMITS[1]);
        SymmetricLog { linear: LINEAR, limit: 1.6 * limit, signed }
    }

    /// Place of `value` on the axis, 0 to 1; what is beyond the end is at the end.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let side = (value.abs() / self.linear).ln_1p() / (self.limit / self.linear).ln_1p();
        let side = side.min(1.0).copysign(value);
        if self.signed { 0.5 * (1.0 + side) } else { side.max(0.0) }
    }

    /// Zero and the powers of ten, from below.
    pub(crate) fn ticks(&self) -> Vec<f64> {
        let decades = (self.linear.log10().round() as i32..).map(|k| 10_f64.powi(k));
        let positive: Vec<f64> = decades.take_while(|tick| *tick <= self.limit).collect();
        let negative = positive.iter().rev().map(|tick| -tick).filter(|_| self.signed);
        negative.chain([0.0]).chain(positive.iter().copied()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::SymmetricLog;

    #[test]
    fn decades_are_equally_far_apart_and_zero_is_in_the_middle() {
        let axis = SymmetricLog { linear: 1e-6, limit: 1.0, signed: true };
        assert_eq!([-2.0, -1.0, 0.0, 1.0].map(|v| axis.place(v)), [0.0, 0.0, 0.5, 1.0]);
        let step = |low: f64| axis.place(10.0 * low) - axis.place(low);
        assert!((step(0.1) - step(0.01)).abs() < 1e-4 && (step(-0.01) + step(0.01)).abs() < 1e-12);
        let half = SymmetricLog { signed: false, ..axis };
        assert_eq!([-1.0, 0.0, 1.0].map(|v| half.place(v)), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn the_axis_ends_beyond_the_largest_value_and_has_zero_among_its_ticks() {
        for largest in [1e-5, 0.012, 0.73, 1.1, 1.54] {
            let axis = SymmetricLog::over([-largest, f64::NAN].into_iter(), true);
            assert!(axis.limit >= largest && axis.place(-largest) >= 0.0, "{axis:?}");
            let ticks = axis.ticks();
            assert!(ticks.contains(&0.0) && ticks.is_sorted() && ticks[0] == -ticks[ticks.len() - 1]);
        }
        assert_eq!(SymmetricLog::over([1.1].into_iter(), true).limit, 1.6);
    }
}
