//! Curves over one axis, panel above panel: the figures of studies, sweeps and series of measurements.

use super::polyline::{Point, path};
use super::ticks::{tick_label, ticks};
use maud::{Markup, PreEscaped, html};

/// Width in px.
const CHART_WIDTH: f64 = 760.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 16.0;
const PANEL_HEIGHT: f64 = 300.0;
const PANEL_GAP: f64 = 62.0;
const FONT_SIZE: f64 = 13.0;
/// Height of a row of the legend, px.
const LEGEND_ROW: f64 = 22.0;

/// Okabe and Ito's colours, which colour-blind readers can tell apart, and dashes that do without colours.
const STYLES: [(&str, &str); 7] = [
    ("#0072b2", "none"),
    ("#d55e00", "9 3"),
    ("#009e73", "2.5 2.5"),
    ("#cc79a7", "9 2.5 2 2.5"),
    ("#1a1a1a", "5 2"),
    ("#e69f00", "14 3"),
    ("#56b4e9", "2 2 7 2"),
];

/// Points that belong together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Name in the legend; empty = none.
    pub name: String,
    /// Points in the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// Marks at the points instead of a line through them.
    pub marks: bool,
}

/// One coordinate system.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ChartPanel {
    /// What stands below the horizontal axis, with unit.
    pub x_label: String,
    /// What stands beside the vertical axis, with unit.
    pub y_label: String,
    /// What is drawn; equal places in the list look equal in every panel.
    pub series: Vec<Series>,
    /// Whether the horizontal axis counts something: marks at whole numbers only.
    pub counted: bool,
    /// A band of values across the panel (mean and scatter): middle and half width.
    pub band: Option<(f64, f64)>,
}

/// The chart as a stand-alone SVG; values that are not finite are left out.
pub fn chart(title: &str, panels: &[ChartPanel]) -> String {
    let width = CHART_WIDTH;
    let names: Vec<&Series> = panels.first().map_or_else(Vec::new, |panel| panel.series.iter().collect());
    let legend = legend(&names, width);
    let top = 14.0 + LEGEND_ROW * legend.rows as f64;
    let height = top + panels.len() as f64 * (PANEL_HEIGHT + PANEL_GAP);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {width} {height}")) width=(width) height=(height)
            font-family="DejaVu Sans, Verdana, sans-serif" font-size=(FONT_SIZE) role="img" {
            title { (title) }
            style { (PreEscaped("text{fill:#1a1a1a}.frame{stroke:#444;fill:none}.grid{stroke:#e3e3e3}.band{fill:#ececec}")) }
            rect width=(width) height=(height) fill="#ffffff" {}
            (legend.drawing)
            @for (k, panel) in panels.iter().enumerate() {
                (draw(panel, width, top + k as f64 * (PANEL_HEIGHT + PANEL_GAP)))
            }
        }
    }
    .into_string()
}

struct Legend {
    rows: usize,
    drawing: Markup,
}

fn legend(series: &[&Series], page: f64) -> Legend {
    let (mut x, mut row) = (LEFT, 0);
    let mut items = Vec::new();
    for (k, series) in series.iter().enumerate().filter(|(_, series)| !series.name.is_empty()) {
        let width = 50.0 + 0.62 * FONT_SIZE * series.name.chars().count() as f64;
        if x > LEFT && x + width > page - RIGHT {
            (x, row) = (LEFT, row + 1);
        }
        items.push((k, x, 16.0 + LEGEND_ROW * row as f64, *series));
        x += width;
    }
    let drawing = html! {
        @for (k, x, y, series) in &items {
            @if series.marks { (mark(*k, (x + 15.0, *y))) }
            @else { (line(*k, &[(*x, *y), (x + 30.0, *y)])) }
            text x=(format!("{:.2}", x + 37.0)) y=(y + 4.5) { (series.name) }
        }
    };
    Legend { rows: if items.is_empty() { 0 } else { row + 1 }, drawing }
}

fn line(k: usize, points: &[Point]) -> Markup {
    let (colour, dash) = STYLES[k % STYLES.len()];
    html! {
        path d=(path(points)) fill="none" stroke=(colour) stroke-width="1.8" stroke-dasharray=(dash) stroke-linejoin="round" {}
    }
}

fn mark(k: usize, (x, y): Point) -> Markup {
    let colour = STYLES[k % STYLES.len()].0;
    html! { circle cx=(format!("{x:.2}")) cy=(format!("{y:.2}")) r="3.2" fill=(colour) {} }
}

/// Lowest and highest of `values`, apart.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    match (low <= high, high - low > 0.0) {
        (false, _) => (0.0, 1.0),
        (true, false) => (low - 0.5, high + 0.5),
        _ => (low, high),
    }
}

fn draw(panel: &ChartPanel, page: f64, top: f64) -> Markup {
    let points = || panel.series.iter().flat_map(|series| &series.points);
    let band = panel.band.map(|(middle, half)| [middle - half, middle + half]);
    let (left, right) = range(points().map(|p| p.0));
    let (low, high) = range(points().map(|p| p.1).chain(band.into_iter().flatten()));
    let room = 0.04 * (high - low);
    // a range that begins near zero begins at zero
    let low = if low >= 0.0 && low < 0.3 * high { 0.0 } else { low - room };
    let high = high + room;
    // marks at the very edge would be cut
    let side = if panel.series.iter().any(|series| series.marks) { 0.03 * (right - left) } else { 0.0 };
    let (left, right) = (left - side, right + side);
    let width = page - LEFT - RIGHT;
    let x_of = |x: f64| LEFT + width * (x - left) / (right - left);
    let y_of = |y: f64| top + PANEL_HEIGHT * (high - y) / (high - low);
    let (mut x_marks, y_marks) = (ticks(left, right, (width / 70.0) as usize), ticks(low, high, 6));
    x_marks.retain(|x| !panel.counted || x.fract() == 0.0);
    let at = |value: f64| format!("{value:.2}");
    html! {
        @if let Some([from, to]) = band {
            rect.band x=(LEFT) width=(width) y=(at(y_of(to))) height=(at(y_of(from) - y_of(to))) {}
        }
        g stroke-width="1" {
            @for x in &x_marks { line.grid x1=(at(x_of(*x))) x2=(at(x_of(*x))) y1=(top) y2=(top + PANEL_HEIGHT) {} }
            @for y in &y_marks { line.grid x1=(LEFT) x2=(LEFT + width) y1=(at(y_of(*y))) y2=(at(y_of(*y))) {} }
        }
        @for x in &x_marks {
            text x=(at(x_of(*x))) y=(top + PANEL_HEIGHT + 19.0) text-anchor="middle" { (tick_label(*x, &x_marks)) }
        }
        @for y in &y_marks {
            text x=(LEFT - 8.0) y=(at(y_of(*y) + 0.36 * FONT_SIZE)) text-anchor="end" { (tick_label(*y, &y_marks)) }
        }
        text x=(LEFT + 0.5 * width) y=(top + PANEL_HEIGHT + 41.0) text-anchor="middle" { (panel.x_label) }
        text transform=(format!("translate(17 {:.2}) rotate(-90)", top + 0.5 * PANEL_HEIGHT)) text-anchor="middle" {
            (panel.y_label)
        }
        @for (k, series) in panel.series.iter().enumerate() {
            @let drawn: Vec<Point> = series.points.iter().map(|p| (x_of(p.0), y_of(p.1))).collect();
            @if series.marks {
                @for point in drawn.iter().filter(|p| p.0.is_finite() && p.1.is_finite()) { (mark(k, *point)) }
            } @else { (line(k, &drawn)) }
        }
        rect.frame x=(LEFT) y=(top) width=(width) height=(PANEL_HEIGHT) {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_series_is_drawn_and_named_and_the_picture_can_be_rastered() {
        let series = |name: &str, marks| Series {
            name: name.into(),
            points: vec![(1.0, 10.0), (2.0, f64::NAN), (3.0, 20.0)],
            marks,
        };
        let panel = ChartPanel {
            x_label: "Radius in mm".into(),
            y_label: "Efficiency in %".into(),
            series: vec![series("a < b", false), series("measured", true)],
            counted: true,
            band: Some((15.0, 1.0)),
        };
        let svg = chart("example", &[panel.clone(), panel]);
        assert_eq!(svg.matches("<path").count(), 1 + 2, "legend and both panels");
        assert_eq!(svg.matches("<circle").count(), 1 + 2 * 2);
        assert!(svg.contains("a &lt; b") && svg.contains("Radius in mm") && !svg.contains("NaN"), "{svg}");
        assert!(!svg.contains(">1.5<") && svg.contains(">3<"), "whole numbers only: {svg}");
        assert!(super::super::png(&svg, 1.0).expect("PNG").starts_with(b"\x89PNG"));
    }

    #[test]
    fn nothing_to_draw_is_an_empty_panel() {
        assert!(!chart("empty", &[ChartPanel::default()]).contains("NaN"));
    }
}
