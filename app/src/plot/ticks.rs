//! Round numbers for the marks of an axis.

use crate::format::minus;

/// Fewer marks than these don't show a scale.
const LEAST: usize = 3;

/// The largest of 1, 2 and 5 times a power of ten that is not larger than `value`.
pub(crate) fn round_below(value: f64) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    [5.0, 2.0].map(|m| m * power).into_iter().find(|m| *m <= value).unwrap_or(power)
}

/// Marks at multiples of 1, 2 or 5 times a power of ten within `low..=high`, about `count` of them, but at least three.
pub(crate) fn ticks(low: f64, high: f64, count: usize) -> Vec<f64> {
    let span = high - low;
    if !(span.is_finite() && span > 0.0) {
        return vec![low];
    }
    let raw = span / count.max(1) as f64;
    let power = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= raw).unwrap_or(raw);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    let marks: Vec<f64> = (first..=last).map(|k| k as f64 * step).collect();
    // half the step, at most, each time: three marks are there before long
    if marks.len() < LEAST { ticks(low, high, 2 * count.max(1)) } else { marks }
}

/// The mark's number with as many decimals as its distance to the others asks for.
pub(crate) fn tick_label(value: f64, ticks: &[f64]) -> String {
    let step = ticks.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
    let decimals = if step.is_finite() { (-step.log10().floor()).max(0.0) as usize } else { 0 };
    let text = format!("{value:.decimals$}");
    if value == 0.0 { "0".into() } else { minus(&text) }
}

#[cfg(test)]
mod tests {
    use super::{tick_label, ticks};

    #[test]
    fn marks_are_round_and_inside() {
        assert_eq!(ticks(0.0, 198.0, 5), [0.0, 50.0, 100.0, 150.0]);
        assert_eq!(ticks(-600.0, 350.0, 5), [-600.0, -400.0, -200.0, 0.0, 200.0]);
        assert_eq!(ticks(-660.0, 390.0, 2), [-600.0, -400.0, -200.0, 0.0, 200.0]);
        let small = ticks(0.0, 0.5, 5);
        assert_eq!(tick_label(small[1], &small), "0.1");
        assert_eq!(tick_label(-200.0, &[-200.0, 0.0]), "−200");
    }
}
