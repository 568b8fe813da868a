//! Bar chart of the discrepancy budget: a row per cause, a panel per quantity, one scale for all.

use crate::comparison::budget::QuantityBudget;
use crate::format::{percent, words};
use crate::plot::polyline::Point;
use crate::plot::svg::{FONT_SIZE, Svg, Theme, x2};
use maud::{Markup, html};
use std::collections::BTreeMap;

const WIDTH: f64 = 760.0;
const LEFT: f64 = 186.0;
const TOP: f64 = 44.0;
const GAP: f64 = 8.0;
const ROW: f64 = 36.0;
const BAR: f64 = 13.0;
/// Room on both sides of a panel's longest bar.
const MARGIN: f64 = 4.0;
/// Font size of the numbers in px.
const SMALL: f64 = 11.5;

/// A cause as people read it.
pub(crate) fn cause_name(cause: &str) -> String {
    match cause {
        "kirchhoff_kinematics" => "Kirchhoff kinematics".into(),
        "half_space_contact" => "half-space contact".into(),
        "mode_truncation_of_c" => "mode truncation of C".into(),
        other => words(other),
    }
}

/// One bar: value and half width of its uncertainty over the magnitude of the reference.
struct BudgetBar {
    class: &'static str,
    value: f64,
    uncertainty: f64,
    /// Half width of the band the value ought to lie in.
    bound: Option<f64>,
}

/// The bars of one quantity from top to bottom, with what uncertain inputs leave `open` last; none if the reference is 0.
fn bars(row: &QuantityBudget, open: Option<f64>) -> Vec<BudgetBar> {
    let scale = row.reference.abs();
    if scale.is_nan() || scale == 0.0 {
        return Vec::new();
    }
    let bar = |class, value: f64, uncertainty: f64| BudgetBar {
        class,
        value: value / scale,
        uncertainty: uncertainty / scale,
        bound: None,
    };
    let remainder = if row.explained.passed() { "fig-remainder" } else { "fig-unexplained" };
    let mut bars = vec![bar("fig-total", row.difference, 0.0)];
    bars.extend(row.parts.iter().map(|part| bar("fig-part", part.value, part.uncertainty)));
    bars.push(BudgetBar { bound: Some(row.bound / scale), ..bar(remainder, row.remainder, 0.0) });
    bars.extend(open.map(|open| BudgetBar { bound: Some(open / scale), ..bar("fig-part", 0.0, 0.0) }));
    bars
}

/// The chart as SVG, coloured by the page it stands in. `open` is 2 u_val of model B by quantity, if inputs are uncertain.
pub(crate) fn budget_figure(rows: &[QuantityBudget], open: &BTreeMap<&str, f64>) -> Markup {
    let names: Vec<String> = rows.first().map_or_else(Vec::new, |row| {
        let causes = row.parts.iter().map(|part| cause_name(&part.cause));
        std::iter::once(format!("model {} − reference", row.model))
            .chain(causes)
            .chain(["remainder and its bound".into()])
            .chain((!open.is_empty()).then(|| "2 u_val, inputs included".into()))
            .collect()
    });
    let panels: Vec<Vec<BudgetBar>> =
        rows.iter().map(|row| bars(row, open.get(&*row.quantity).copied())).collect();
    let ends = panels.iter().flatten().flat_map(|bar| {
        let reach = bar.uncertainty.max(bar.bound.unwrap_or(0.0));
        [bar.value - bar.uncertainty, bar.value + bar.uncertainty, reach, -reach]
    });
    let (low, high) =
        ends.filter(|v| v.is_finite()).fold((0.0_f64, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    let span = if high > low { high - low } else { 1.0 };
    let width = (WIDTH - LEFT - GAP * rows.len() as f64) / rows.len().max(1) as f64;
    let bottom = TOP + ROW * names.len() as f64;
    let x_of = |panel: usize, value: f64| {
        let left = LEFT + panel as f64 * (width + GAP);
        left + MARGIN + (width - 2.0 * MARGIN) * (value - low) / span
    };
    let title = "Error budget: what each simplification adds to model less reference";
    Svg::new(title, [WIDTH, bottom + 6.0], Theme::Inline).around(&html! {
        @for (k, name) in names.iter().enumerate() {
            @let y = TOP + ROW * k as f64;
            // the sum stands apart from its terms
            line class=(if k == 1 { "fig-frame" } else { "fig-grid" }) x1="0" x2=(WIDTH) y1=(x2(y)) y2=(x2(y)) {}
            text x="0" y=(x2(y + 0.5 * ROW + 0.36 * FONT_SIZE)) { (name) }
        }
        @for (p, (row, bars)) in rows.iter().zip(&panels).enumerate() {
            @let middle = LEFT + p as f64 * (width + GAP) + 0.5 * width;
            @for (k, word) in words(&row.quantity).split(", ").enumerate() {
                text x=(x2(middle)) y=(x2(16.0 + 16.0 * k as f64)) text-anchor="middle" { (word) }
            }
            @for (k, bar) in bars.iter().enumerate() {
                (draw(bar, (x_of(p, 0.0), TOP + ROW * k as f64), |value| x_of(p, value), middle))
            }
            @if bars.is_empty() {
                text x=(x2(middle)) y=(x2(TOP + 0.6 * ROW)) text-anchor="middle" { "–" }
            }
        }
    })
}

/// One bar from its `zero`, with its number below at `middle`.
fn draw(bar: &BudgetBar, zero: Point, x_of: impl Fn(f64) -> f64, middle: f64) -> Markup {
    let top = zero.1 + 5.0;
    let (from, to) = (zero.0.min(x_of(bar.value)), zero.0.max(x_of(bar.value)));
    let (low, high) = (x_of(bar.value - bar.uncertainty), x_of(bar.value + bar.uncertainty));
    let number = match bar.bound {
        Some(bound) if bar.value == 0.0 => format!("±{:.2} %", 100.0 * bound),
        Some(bound) => format!("{} (±{:.2})", signed_percent(bar.value), 100.0 * bound),
        None => signed_percent(bar.value),
    };
    html! {
        @if let Some(bound) = bar.bound {
            rect.fig-box x=(x2(x_of(-bound))) y=(x2(top - 2.0)) width=(x2(x_of(bound) - x_of(-bound)))
                height=(x2(BAR + 4.0)) {}
        }
        rect class=(bar.class) x=(x2(from)) y=(x2(top)) width=(x2(to - from)) height=(BAR) {}
        line.fig-frame x1=(x2(zero.0)) x2=(x2(zero.0)) y1=(x2(top - 3.0)) y2=(x2(top + BAR + 3.0)) {}
        @if high - low > 1.0 {
            line.fig-frame x1=(x2(low)) x2=(x2(high)) y1=(x2(top + 0.5 * BAR)) y2=(x2(top + 0.5 * BAR)) {}
        }
        text.fig-halo x=(x2(middle)) y=(x2(zero.1 + ROW - 5.0)) text-anchor="middle" font-size=(SMALL)
            stroke-width="3" stroke-linejoin="round" aria-hidden="true" { (number) }
        text x=(x2(middle)) y=(x2(zero.1 + ROW - 5.0)) text-anchor="middle" font-size=(SMALL) { (number) }
    }
}

/// Per cent with a sign unless it rounds to zero.
fn signed_percent(value: f64) -> String {
    if value.abs() < 5e-5 { "0.00 %".into() } else { percent(Some(value)) }
}
