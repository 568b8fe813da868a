//! Estimated against true error, both logarithmic: a panel per tolerance.

use super::{TOLERANCES, number};
use crate::evidence::study::{Cell, Study};
use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::colours::{MODELS, hex};
use crate::plot::polyline::path;
use crate::plot::{Svg, Theme};
use maud::{Markup, html};

const PANEL: f64 = 330.0;
const MARGIN: (f64, f64, f64, f64) = (72.0, 36.0, 12.0, 52.0);
const LEGEND: f64 = 34.0;
/// Ends of both axes.
const ERRORS: [f64; 2] = [1e-5, 1.0];

/// The study as SVG. A mark above the diagonal is a true error larger than its estimate.
pub fn figure(study: &Study) -> String {
    let width = TOLERANCES.len() as f64 * PANEL;
    let height = PANEL + LEGEND;
    let drawing = html! {
        @for (k, tolerance) in TOLERANCES.iter().enumerate() {
            g transform=(format!("translate({} 0)", k as f64 * PANEL)) { (panel(study, *tolerance)) }
        }
        @for (k, (model, colour)) in MODELS.iter().enumerate() {
            circle cx=(70.0 + 110.0 * k as f64) cy=(height - 14.0) r="4" fill=(hex(*colour)) {}
            text x=(80.0 + 110.0 * k as f64) y=(height - 10.0) { "model " (model) }
        }
        circle cx="400" cy=(height - 14.0) r="4" fill="none" stroke="#1a1a1a" {}
        text x="410" y=(height - 10.0) { "no accuracy stated" }
    };
    let title = "Models chosen by auto: true error over estimated error";
    Svg::new(title, [width, height], Theme::Standalone).around(&drawing).into_string()
}

fn panel(study: &Study, tolerance: f64) -> Markup {
    let (left, top, right, bottom) = MARGIN;
    let (width, height) = (PANEL - left - right, PANEL - top - bottom);
    let axis = PlotAxis::over(ERRORS.into_iter(), true);
    let plot = Plot { left, top, width, height, x: axis, y: axis };
    let place = |estimated: f64, exact: f64| plot.at([estimated, exact].map(within).into());
    let rows: Vec<&Vec<Cell>> =
        study.rows.iter().filter(|row| number(row, "tolerance") == tolerance).collect();
    let colour = |row: &[Cell]| {
        let model = row.iter().find_map(|cell| match cell {
            Cell::Text(text) => MODELS.iter().find(|(name, _)| name == text),
            _ => None,
        });
        model.map_or("#1a1a1a".to_owned(), |(_, colour)| hex(*colour))
    };
    let marks = rows.iter().filter_map(|row| {
        let (estimated, exact) = (number(row, "estimated_error"), number(row, "true_error"));
        (estimated > 0.0 && exact.is_finite())
            .then(|| (place(estimated, exact), colour(row), number(row, "promised") == 1.0))
    });
    let decades = axis.marks(6);
    let line = |ends: [(f64, f64); 2]| path(&ends.map(|end| plot.at(end)));
    let [from, to] = ERRORS;
    html! {
        text x=(left) y=(top - 14.0) { "tolerance " (100.0 * tolerance) " %" }
        (plot.grid(&decades, &decades))
        path d=(line([(from, from), (to, to)])) stroke="#777777" {}
        @for ends in [[(tolerance, from), (tolerance, to)], [(from, tolerance), (to, tolerance)]] {
            path d=(line(ends)) stroke="#777777" stroke-dasharray="4 3" {}
        }
        (plot.frame(&decades, &decades, ["estimated relative error", "true relative error"]))
        @for ((x, y), colour, promised) in marks {
            circle cx=(format!("{x:.1}")) cy=(format!("{y:.1}")) r="3" stroke=(colour) fill=(if promised { &*colour } else { "none" }) {}
        }
    }
}

/// The error as far as the axes show it.
fn within(error: f64) -> f64 {
    error.clamp(ERRORS[0], ERRORS[1])
}
