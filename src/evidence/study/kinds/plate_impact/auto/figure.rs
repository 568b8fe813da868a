//! Estimated against true error, both logarithmic: a panel per tolerance.

use super::{TOLERANCES, number};
use crate::evidence::study::{Cell, Study};
use crate::plot::colours::{MODELS, hex};
use maud::{Markup, html};

const PANEL: f64 = 330.0;
const MARGIN: (f64, f64, f64, f64) = (62.0, 36.0, 12.0, 52.0);
const LEGEND: f64 = 34.0;
/// Decades of both axes.
const DECADES: (i32, i32) = (-5, 0);

/// The study as SVG. A mark above the diagonal is a true error larger than its estimate.
pub fn figure(study: &Study) -> String {
    let width = TOLERANCES.len() as f64 * PANEL;
    let height = PANEL + LEGEND;
    html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height) viewBox=(format!("0 0 {width} {height}"))
            font-family="DejaVu Sans, Verdana, sans-serif" font-size="12" role="img" {
            title { "Models chosen by auto: true error over estimated error" }
            rect width=(width) height=(height) fill="#ffffff" {}
            @for (k, tolerance) in TOLERANCES.iter().enumerate() {
                g transform=(format!("translate({} 0)", k as f64 * PANEL)) { (panel(study, *tolerance)) }
            }
            @for (k, (model, colour)) in MODELS.iter().enumerate() {
                circle cx=(70.0 + 110.0 * k as f64) cy=(height - 14.0) r="4" fill=(hex(*colour)) {}
                text x=(80.0 + 110.0 * k as f64) y=(height - 10.0) fill="#1a1a1a" { "model " (model) }
            }
            circle cx="400" cy=(height - 14.0) r="4" fill="none" stroke="#1a1a1a" {}
            text x="410" y=(height - 10.0) fill="#1a1a1a" { "no accuracy stated" }
        }
    }
    .into_string()
}

fn panel(study: &Study, tolerance: f64) -> Markup {
    let (left, top, right, bottom) = MARGIN;
    let (wide, high) = (PANEL - left - right, PANEL - top - bottom);
    let place = |error: f64| {
        let (from, to) = (f64::from(DECADES.0), f64::from(DECADES.1));
        ((error.log10() - from) / (to - from)).clamp(0.0, 1.0)
    };
    let (x, y) = (|error: f64| left + wide * place(error), |error: f64| top + high * (1.0 - place(error)));
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
            .then(|| (x(estimated), y(exact), colour(row), number(row, "promised") == 1.0))
    });
    let (from, to) = (10f64.powi(DECADES.0), 10f64.powi(DECADES.1));
    html! {
        text x=(left) y=(top - 14.0) fill="#1a1a1a" { "tolerance " (100.0 * tolerance) " %" }
        @for decade in DECADES.0..=DECADES.1 {
            @let at = 10f64.powi(decade);
            line x1=(x(at)) x2=(x(at)) y1=(top) y2=(top + high) stroke="#e3e3e3" {}
            line x1=(left) x2=(left + wide) y1=(y(at)) y2=(y(at)) stroke="#e3e3e3" {}
            text x=(x(at)) y=(top + high + 17.0) text-anchor="middle" fill="#1a1a1a" { "1e" (decade) }
            text x=(left - 6.0) y=(y(at) + 4.0) text-anchor="end" fill="#1a1a1a" { "1e" (decade) }
        }
        line x1=(x(from)) y1=(y(from)) x2=(x(to)) y2=(y(to)) stroke="#777777" {}
        line x1=(x(tolerance)) x2=(x(tolerance)) y1=(top) y2=(top + high) stroke="#777777" stroke-dasharray="4 3" {}
        line x1=(left) x2=(left + wide) y1=(y(tolerance)) y2=(y(tolerance)) stroke="#777777" stroke-dasharray="4 3" {}
        rect x=(left) y=(top) width=(wide) height=(high) fill="none" stroke="#444444" {}
        text x=(left + 0.5 * wide) y=(top + high + 37.0) text-anchor="middle" fill="#1a1a1a" { "estimated relative error" }
        text transform=(format!("translate(15 {}) rotate(-90)", top + 0.5 * high)) text-anchor="middle" fill="#1a1a1a" {
            "true relative error"
        }
        @for (x, y, colour, promised) in marks {
            circle cx=(format!("{x:.1}")) cy=(format!("{y:.1}")) r="3" stroke=(colour) fill=(if promised { &*colour } else { "none" }) {}
        }
    }
}
