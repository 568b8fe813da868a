//! Axes of charts: a range, linear or logarithmic, its marks, and the frame that two of them make.

use crate::format::{rounded, short, with_minus};
use crate::plot::polyline::Point;
use crate::plot::svg::{FONT_SIZE, upright, x2};
use crate::plot::ticks::{tick_label, ticks};
use maud::{Markup, html};

/// A range of values on an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlotAxis {
    low: f64,
    high: f64,
    logarithmic: bool,
}

impl PlotAxis {
    /// From the lowest to the highest of `values`, apart; logarithmic only if all are positive.
    pub(crate) fn over(values: impl Iterator<Item = f64>, logarithmic: bool) -> Self {
        let (low, high) = values
            .filter(|v| v.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let (low, high) = match (low <= high, high - low > 0.0) {
            (false, _) => (0.0, 1.0),
            (true, false) => {
                (low - 0.5 * low.abs().clamp(1e-9, 1.0), high + 0.5 * high.abs().clamp(1e-9, 1.0))
            }
            _ => (low, high),
        };
        PlotAxis { low, high, logarithmic: logarithmic && low > 0.0 }
    }

    /// Linear from `low` to `high`.
    pub(crate) fn linear(low: f64, high: f64) -> Self {
        PlotAxis { low, high, logarithmic: false }
    }

    /// With room of a `share` of its length at both ends.
    pub(crate) fn widened(self, share: f64) -> Self {
        let (low, high) = (self.measure(self.low), self.measure(self.high));
        let room = share * (high - low);
        PlotAxis { low: self.value(low - room), high: self.value(high + room), ..self }
    }

    /// Linear, with room at both ends; from zero if it begins near zero.
    pub(crate) fn of_quantity(self) -> Self {
        let near_zero = self.low >= 0.0 && self.low < 0.3 * self.high;
        let wide = self.widened(0.04);
        if near_zero { PlotAxis { low: 0.0, ..wide } } else { wide }
    }

    /// Where `value` is, from 0 to 1.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let (low, high) = (self.measure(self.low), self.measure(self.high));
        (self.measure(value) - low) / (high - low)
    }

    /// Middle between two values.
    pub(crate) fn between(&self, a: f64, b: f64) -> f64 {
        self.value(0.5 * (self.measure(a) + self.measure(b)))
    }

    /// Round numbers, about `count` of them; of many decades each second or later one.
    pub(crate) fn marks(&self, count: usize) -> Vec<f64> {
        let chosen = if self.logarithmic { self.decades(count) } else { None };
        chosen.unwrap_or_else(|| ticks(self.low, self.high, count))
    }

    /// Marks of a logarithmic axis; `None` if it is too short for them.
    fn decades(&self, count: usize) -> Option<Vec<f64>> {
        let decades = self.low.log10().floor() as i32..=self.high.log10().ceil() as i32;
        let powers = |(every, multiples): (usize, &'static [f64])| -> Vec<f64> {
            let decades = decades.clone().step_by(every);
            let all = decades.flat_map(|k| multiples.iter().map(move |m| m * 10_f64.powi(k)));
            all.filter(|v| (self.low..=self.high).contains(v)).collect()
        };
        let candidates =
            std::iter::once((1, &[1.0, 2.0, 5.0][..])).chain((1..8).map(|every| (every, &[1.0][..])));
        candidates.map(powers).find(|marks| (3..=count).contains(&marks.len()))
    }

    /// The number at a mark.
    pub(crate) fn label(&self, mark: f64, marks: &[f64]) -> String {
        match self.logarithmic {
            true if (1e-3..1e5).contains(&mark) => with_minus(&short(mark)),
            true => with_minus(&format!("{:e}", rounded(mark, 6))),
            false => tick_label(mark, marks),
        }
    }

    /// Where it begins and ends.
    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    fn measure(&self, value: f64) -> f64 {
        if self.logarithmic { value.log10() } else { value }
    }

    fn value(&self, measure: f64) -> f64 {
        if self.logarithmic { 10_f64.powf(measure) } else { measure }
    }
}

/// Two axes in a drawing: left, top, width and height in px.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plot {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) x: PlotAxis,
    pub(crate) y: PlotAxis,
}

impl Plot {
    pub(crate) fn x(&self, value: f64) -> f64 {
        self.left + self.width * self.x.place(value)
    }

    pub(crate) fn y(&self, value: f64) -> f64 {
        self.top + self.height * (1.0 - self.y.place(value))
    }

    pub(crate) fn at(&self, (x, y): (f64, f64)) -> Point {
        (self.x(x), self.y(y))
    }

    /// Lines at the marks.
    pub(crate) fn grid(&self, x_marks: &[f64], y_marks: &[f64]) -> Markup {
        html! {
            g stroke-width="1" {
                @for x in x_marks { line.fig-grid x1=(x2(self.x(*x))) x2=(x2(self.x(*x))) y1=(self.top) y2=(self.top + self.height) {} }
                @for y in y_marks { line.fig-grid x1=(self.left) x2=(self.left + self.width) y1=(x2(self.y(*y))) y2=(x2(self.y(*y))) {} }
            }
        }
    }

    /// Numbers at the marks of both axes, what they are of, and the frame.
    pub(crate) fn frame(&self, x_marks: &[f64], y_marks: &[f64], [x_label, y_label]: [&str; 2]) -> Markup {
        html! { (self.below(x_marks, x_label)) (self.left_labels(y_marks, y_label)) (self.outline()) }
    }

    /// Numbers at the marks of the horizontal axis, and what they are of.
    pub(crate) fn below(&self, marks: &[f64], label: &str) -> Markup {
        let bottom = self.top + self.height;
        html! {
            @for x in marks { text x=(x2(self.x(*x))) y=(bottom + 19.0) text-anchor="middle" { (self.x.label(*x, marks)) } }
            text x=(self.left + 0.5 * self.width) y=(bottom + 41.0) text-anchor="middle" { (label) }
        }
    }

    /// The same of the vertical axis; without a name for an empty `label`.
    pub(crate) fn left_labels(&self, marks: &[f64], label: &str) -> Markup {
        html! {
            @for y in marks {
                text x=(self.left - 8.0) y=(x2(self.y(*y) + 0.36 * FONT_SIZE)) text-anchor="end" { (self.y.label(*y, marks)) }
            }
            @if !label.is_empty() { (upright(17.0, self.top + 0.5 * self.height, label)) }
        }
    }

    /// The frame.
    pub(crate) fn outline(&self) -> Markup {
        html! { rect.fig-frame x=(self.left) y=(self.top) width=(self.width) height=(self.height) {} }
    }
}

#[cfg(test)]
mod tests {
    use super::PlotAxis;

    #[test]
    fn equal_ratios_are_equally_far_apart_on_a_logarithmic_axis() {
        let axis = PlotAxis::over([1.0, 1000.0].into_iter(), true);
        assert!(
            [1.0, 10.0, 100.0, 1000.0]
                .iter()
                .enumerate()
                .all(|(k, v)| (axis.place(*v) - k as f64 / 3.0).abs() < 1e-12)
        );
        assert!((axis.between(10.0, 1000.0) - 100.0).abs() < 1e-9);
        assert_eq!(axis.marks(5), [1.0, 10.0, 100.0, 1000.0]);
        assert_eq!(PlotAxis::over([20.0, 400.0].into_iter(), true).marks(6), [20.0, 50.0, 100.0, 200.0]);
        // of many decades every second one, as powers of ten
        let wide = PlotAxis::over([1e-13, 1.0].into_iter(), true);
        let labels: Vec<String> = wide.marks(7).iter().map(|mark| wide.label(*mark, &[])).collect();
        assert_eq!(labels, ["1e−13", "1e−11", "1e−9", "1e−7", "1e−5", "0.001", "0.1"].map(str::to_owned));
        // within less than a decade, and where there is no logarithm
        assert_eq!(
            PlotAxis::over([3.0, 4.0].into_iter(), true).marks(5),
            [3.0, 3.2, 3.4000000000000004, 3.6, 3.8000000000000003, 4.0]
        );
        assert_eq!(PlotAxis::over([0.0, 4.0].into_iter(), true).place(1.0), 0.25);
    }

    #[test]
    fn nothing_and_one_value_have_an_axis_too() {
        for values in [vec![], vec![2.0], vec![0.0, f64::NAN]] {
            let axis = PlotAxis::over(values.into_iter(), false).of_quantity();
            assert!(axis.place(0.5).is_finite() && axis.low < axis.high, "{axis:?}");
        }
    }
}
