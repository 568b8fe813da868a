//! Curves over one axis, panel above panel: the figures of studies, sweeps and series of measurements.

use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::polyline::{Point, path};
use crate::plot::svg::{Svg, Theme, text_width, x2};
use maud::{Markup, html};

/// Width in px.
pub(crate) const CHART_WIDTH: f64 = 760.0;
pub(crate) const LEFT: f64 = 74.0;
const RIGHT: f64 = 16.0;
const PANEL_HEIGHT: f64 = 300.0;
pub(crate) const PANEL_GAP: f64 = 62.0;
/// Height of a row of the legend, px.
pub(crate) const LEGEND_ROW: f64 = 22.0;

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
    /// Half widths of the bands of marks, in the order of the points; empty = they have none.
    pub half_widths: Vec<f64>,
    /// Which of the looks it has; `None` = that of its place in the list.
    pub look: Option<usize>,
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
    /// Whether the horizontal axis is logarithmic.
    pub logarithmic: bool,
    /// Places on the horizontal axis of which somebody says something, and what.
    pub statements: Vec<(f64, String)>,
    /// A band of values across the panel (mean and scatter): middle and half width.
    pub band: Option<(f64, f64)>,
}

/// The chart as a stand-alone SVG; values that are not finite are omitted.
pub fn chart(title: &str, panels: &[ChartPanel]) -> String {
    let width = CHART_WIDTH;
    let names: Vec<&Series> = panels.first().map_or_else(Vec::new, |panel| panel.series.iter().collect());
    let legend = legend(&names, width);
    let top = 14.0 + LEGEND_ROW * legend.rows as f64;
    let height = top + panels.len() as f64 * (PANEL_HEIGHT + PANEL_GAP);
    let content = html! {
        (legend.drawing)
        @for (k, panel) in panels.iter().enumerate() {
            (draw(panel, width, top + k as f64 * (PANEL_HEIGHT + PANEL_GAP)))
        }
    };
    Svg::new(title, [width, height], Theme::Standalone).around(&content).into_string()
}

struct Legend {
    rows: usize,
    drawing: Markup,
}

fn legend(series: &[&Series], page: f64) -> Legend {
    let (mut x, mut row) = (LEFT, 0);
    let mut items = Vec::new();
    for (k, series) in series.iter().enumerate().filter(|(_, series)| !series.name.is_empty()) {
        let width = 50.0 + text_width(&series.name);
        if x > LEFT && x + width > page - RIGHT {
            (x, row) = (LEFT, row + 1);
        }
        items.push((k, x, 16.0 + LEGEND_ROW * row as f64, *series));
        x += width;
    }
    let drawing = html! {
        @for (k, x, y, series) in &items {
            @if series.marks { (mark(style(*k, series), (x + 15.0, *y))) }
            @else { (line(style(*k, series), &[(*x, *y), (x + 30.0, *y)])) }
            text x=(x2(x + 37.0)) y=(y + 4.5) { (series.name) }
        }
    };
    Legend { rows: if items.is_empty() { 0 } else { row + 1 }, drawing }
}

/// Colour and dashes of series number `k`.
fn style(k: usize, series: &Series) -> (&'static str, &'static str) {
    STYLES[series.look.unwrap_or(k) % STYLES.len()]
}

fn line((colour, dash): (&str, &str), points: &[Point]) -> Markup {
    html! {
        path d=(path(points)) fill="none" stroke=(colour) stroke-width="1.8" stroke-dasharray=(dash) stroke-linejoin="round" {}
    }
}

fn mark((colour, _): (&str, &str), (x, y): Point) -> Markup {
    html! { circle cx=(x2(x)) cy=(x2(y)) r="3.2" fill=(colour) {} }
}

fn draw(panel: &ChartPanel, page: f64, top: f64) -> Markup {
    let points = || panel.series.iter().flat_map(|series| &series.points);
    let ends = |series: &Series| -> Vec<f64> {
        let ends = series.points.iter().zip(&series.half_widths);
        ends.flat_map(|(point, half)| [point.1 - half, point.1 + half]).collect()
    };
    let band = panel.band.map(|(middle, half)| [middle - half, middle + half]);
    let statements = panel.statements.iter().map(|(x, _)| *x);
    let x = PlotAxis::over(points().map(|p| p.0).chain(statements), panel.logarithmic);
    let bars = panel.series.iter().flat_map(ends);
    let y = PlotAxis::over(points().map(|p| p.1).chain(band.into_iter().flatten()).chain(bars), false);
    // marks at the very edge would be cut
    let side = if panel.series.iter().any(|series| series.marks) { 0.03 } else { 0.0 };
    let (width, height) = (page - LEFT - RIGHT, PANEL_HEIGHT);
    let plot = Plot { left: LEFT, top, width, height, x: x.widened(side), y: y.of_quantity() };
    let (mut x_marks, y_marks) = (plot.x.marks((width / 70.0) as usize), plot.y.marks(6));
    x_marks.retain(|x| !panel.counted || x.fract() == 0.0);
    html! {
        @if let Some([from, to]) = band {
            rect.fig-range x=(LEFT) width=(width) y=(x2(plot.y(to))) height=(x2(plot.y(from) - plot.y(to))) {}
        }
        (plot.grid(&x_marks, &y_marks))
        @for (x, statement) in &panel.statements {
            @let right = plot.x.place(*x) > 0.5;
            line.fig-note x1=(x2(plot.x(*x))) x2=(x2(plot.x(*x))) y1=(top) y2=(top + height) {}
            text x=(x2(plot.x(*x) + if right { -6.0 } else { 6.0 })) y=(top + height - 10.0) text-anchor=(if right { "end" } else { "start" }) {
                (statement)
            }
        }
        @for (k, series) in panel.series.iter().enumerate() {
            @let drawn: Vec<Point> = series.points.iter().map(|p| plot.at(*p)).collect();
            @if series.marks {
                @for (point, half) in series.points.iter().zip(&series.half_widths) {
                    @let (x, low, high) = (plot.x(point.0), plot.y(point.1 - half), plot.y(point.1 + half));
                    path d=(format!("M{x:.2} {low:.2}V{high:.2}M{0:.2} {low:.2}H{1:.2}M{0:.2} {high:.2}H{1:.2}", x - 4.0, x + 4.0))
                        fill="none" stroke=(style(k, series).0) {}
                }
                @for point in drawn.iter().filter(|p| p.0.is_finite() && p.1.is_finite()) { (mark(style(k, series), *point)) }
            } @else {
                // a value that is missing is a gap
                @for part in drawn.split(|p| !p.1.is_finite()).filter(|part| !part.is_empty()) {
                    @if let [alone] = part { (mark(style(k, series), *alone)) } @else { (line(style(k, series), part)) }
                }
            }
        }
        (plot.frame(&x_marks, &y_marks, [&panel.x_label, &panel.y_label]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use resvg::usvg::roxmltree::Document;

    #[test]
    fn every_series_is_drawn_and_named_and_the_picture_can_be_rastered() {
        let series = |name: &str, marks| Series {
            name: name.into(),
            points: vec![(1.0, 10.0), (2.0, f64::NAN), (3.0, 20.0), (4.0, 18.0)],
            marks,
            ..Series::default()
        };
        let panel = ChartPanel {
            x_label: "Radius in mm".into(),
            y_label: "Efficiency in %".into(),
            series: vec![series("a < b", false), series("measured", true)],
            counted: true,
            band: Some((15.0, 1.0)),
            ..ChartPanel::default()
        };
        let svg = chart("example", &[panel.clone(), panel]);
        let document = Document::parse(&svg).expect("XML");
        let mut places: Vec<f64> =
            document.descendants().filter_map(|n| n.attribute("cx")?.parse().ok()).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        let &[first, .., beyond, last] = &places[..] else { panic!("{places:?}") };
        assert!(
            ((beyond - first) / (last - beyond) - 2.0).abs() < 1e-3,
            "the marks of 1, 3 and 4: {places:?}"
        );
        let lines = document.descendants().filter_map(|n| n.attribute("d"));
        let reaches = |line: &&str, x: f64| line.contains(&format!("{x:.2} "));
        let beyond_the_gap: Vec<&str> = lines.filter(|line| reaches(line, last)).collect();
        assert_eq!(beyond_the_gap.len(), 2, "one in each panel");
        assert!(beyond_the_gap.iter().all(|line| reaches(line, beyond) && !reaches(line, first)), "{svg}");
        assert!(svg.contains("a &lt; b") && svg.contains("Radius in mm") && !svg.contains("NaN"), "{svg}");
        assert!(!svg.contains(">1.5<") && svg.contains(">3<"), "whole numbers only: {svg}");
        assert!(crate::plot::png(&svg, 1.0).expect("PNG").starts_with(b"\x89PNG"));
    }

    #[test]
    fn nothing_to_draw_is_an_empty_panel() {
        assert!(!chart("empty", &[ChartPanel::default()]).contains("NaN"));
    }
}
