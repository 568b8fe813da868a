//! One panel of the figure: a quantity of all bodies and results over time.

use crate::curves::{CommonAxis, SampledCurve};
use crate::plot::axis::Plot;
use crate::plot::labels::{LabelRoom, Rect};
use crate::plot::polyline::{Point, path, thinned};
use crate::plot::svg::{FONT_SIZE, text_width, x2};
use crate::report::figure::efficiency_boxes::EfficiencyBoxes;
use crate::report::figure::geometry::{FigureGeometry, PanelOf};
use crate::report::figure::lines::{Line, stroke};
use maud::{Markup, html};

/// Lowest and highest value over all lines and bands, with room on both sides.
fn range(shown: &PanelOf, lines: &[Line]) -> (f64, f64) {
    let belongs = |c: &&SampledCurve| shown.holds(c);
    let curves = lines.iter().flat_map(|l| &l.curves).filter(belongs).flat_map(|c| c.values.iter().copied());
    let edges = lines.iter().flat_map(|line| {
        let curve = |band: &SampledCurve| line.curves.iter().find(|c| c.quantity == band.quantity);
        let pairs = line.bands.iter().filter(belongs).filter_map(move |band| Some((curve(band)?, band)));
        pairs
            .flat_map(|(curve, band)| curve.values.iter().zip(&band.values).flat_map(|(v, w)| [v - w, v + w]))
    });
    let values = curves.chain(edges).filter(|v| v.is_finite()).map(|v| v * shown.factor);
    let (low, high) = values.fold((0.0_f64, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
    let room = if high > low { 0.07 * (high - low) } else { 1.0 };
    (if low < 0.0 { low - room } else { -0.5 * room }, high + room)
}

/// One panel with its curves in px.
struct Layout<'a> {
    plot: Plot,
    drawn: Vec<(&'a Line, Vec<Vec<Point>>)>,
    /// Outlines of the bands.
    bands: Vec<Vec<Point>>,
    room: LabelRoom,
}

impl<'a> Layout<'a> {
    /// `headroom` px are kept free at the top.
    fn new(
        geometry: &FigureGeometry,
        shown: &PanelOf,
        (top, end, headroom): (f64, f64, f64),
        lines: &'a [Line],
        axis: Option<CommonAxis>,
    ) -> Self {
        let height = geometry.panel_height;
        let (low, high) = range(shown, lines);
        let high = low + (high - low) * height / (height - headroom);
        let plot = geometry.plot(top, height, end, [low, high]);
        let points = |line: &Line, name: &str| -> Vec<Point> {
            let curve = line.curves.iter().find(|c| c.quantity == name);
            axis.zip(curve).map_or_else(Vec::new, |(axis, curve)| {
                let at = |(k, v): (usize, &f64)| plot.at((axis.time(k) * 1e6, v * shown.factor));
                curve.values.iter().enumerate().map(at).filter(|p| p.1.is_finite()).collect()
            })
        };
        let drawn: Vec<(&Line, Vec<Vec<Point>>)> = lines
            .iter()
            .map(|l| (l, shown.curves.iter().map(|(_, name)| points(l, name)).collect()))
            .collect();
        let area = Rect { x: plot.left + 6.0, y: top + 5.0, width: plot.width - 12.0, height: height - 10.0 };
        let curves = drawn.iter().flat_map(|(_, bodies)| bodies).map(|line| thinned(line, 2.0)).collect();
        let outline = |curve: &SampledCurve, widths: &SampledCurve| {
            let side = |sign: f64| {
                let at = move |(k, v): (usize, &f64)| (k, (v + sign * widths.values[k]) * shown.factor);
                curve.values.iter().enumerate().map(at)
            };
            let time = |k: usize| axis.map_or(0.0, |axis| axis.time(k) * 1e6);
            let edge = side(1.0).chain(side(-1.0).rev());
            edge.filter(|(_, v)| v.is_finite()).map(|(k, v)| plot.at((time(k), v))).collect()
        };
        let bands = lines.iter().flat_map(|line| {
            line.bands.iter().filter(|band| shown.holds(band)).filter_map(|band| {
                Some(outline(line.curves.iter().find(|curve| curve.quantity == band.quantity)?, band))
            })
        });
        let bands = bands.collect();
        Layout { plot, room: LabelRoom { area, curves, taken: Vec::new() }, drawn, bands }
    }
}

/// The boxes fit between the curves in one of their two arrangements, or room is made at the top.
fn layout_with_boxes<'a>(
    geometry: &FigureGeometry,
    shown: &PanelOf,
    top: f64,
    end: f64,
    lines: &'a [Line],
    axis: Option<CommonAxis>,
) -> (Layout<'a>, EfficiencyBoxes) {
    let mut layout = Layout::new(geometry, shown, (top, end, 0.0), lines, axis);
    for arrangement in [EfficiencyBoxes::column(lines.len()), EfficiencyBoxes::row(lines.len())] {
        let (free, place) = layout.room.find_box(arrangement.width(), arrangement.height());
        if free >= 5.0 {
            layout.room.taken.push(place);
            return (layout, arrangement.at(place));
        }
    }
    let row = EfficiencyBoxes::row(lines.len());
    let mut layout = Layout::new(geometry, shown, (top, end, row.height() + 12.0), lines, axis);
    let (_, place) = layout.room.find_box(row.width(), row.height());
    layout.room.taken.push(place);
    (layout, row.at(place))
}

/// The panel whose upper edge is at `top`; the time axis ends at `end` (us).
pub(crate) fn panel(
    geometry: &FigureGeometry,
    shown: &PanelOf,
    top: f64,
    end: f64,
    lines: &[Line],
    axis: Option<CommonAxis>,
) -> Markup {
    let (mut layout, boxes) = if geometry.boxes && shown.boxes {
        let (layout, boxes) = layout_with_boxes(geometry, shown, top, end, lines, axis);
        (layout, Some(boxes))
    } else {
        (Layout::new(geometry, shown, (top, end, 0.0), lines, axis), None)
    };
    let labels: Vec<_> =
        shown.curves.iter().enumerate().map(|(k, (body, _))| body_label(&mut layout, body, k)).collect();
    let plot = &layout.plot;
    let y_marks = plot.y.marks((plot.height / 45.0) as usize);
    html! {
        (plot.grid(&geometry.instants(plot), &y_marks))
        (plot.left_labels(&y_marks, shown.label))
        @for band in &layout.bands { path.fig-band d=(path(band) + "Z") {} }
        @for (line, bodies) in &layout.drawn {
            @for body in bodies { (stroke(line, &path(body))) }
        }
        (plot.outline())
        @if let Some(boxes) = boxes { (boxes.draw(lines)) }
        @for label in labels { (label) }
    }
}

/// The name of curve number `k` at the first line that has it; nothing if none has.
fn body_label(layout: &mut Layout, body: &str, k: usize) -> Markup {
    let zero = layout.plot.y(0.0);
    let mut drawn = layout.drawn.iter().filter(|(_, bodies)| !bodies[k].is_empty());
    let Some((_, reference)) = drawn.next() else { return html! {} };
    let thin: Vec<_> = reference.iter().map(|line| thinned(line, 2.0)).collect();
    let others: Vec<_> = (0..thin.len()).filter(|j| *j != k).map(|j| thin[j].clone()).collect();
    // Where a curve is zero others may be as well; it is labelled elsewhere if there is an elsewhere.
    let away = |p: &&Point| (p.1 - zero).abs() > 0.08 * layout.plot.height;
    let mut own: Vec<Point> = thin[k].iter().filter(away).copied().collect();
    if own.is_empty() {
        own.clone_from(&thin[k]);
    }
    let label = layout.room.place_label(&own, &others, text_width(body), FONT_SIZE);
    let (x, y) = (label.rect.x + 0.5 * label.rect.width, label.rect.y + 0.83 * label.rect.height);
    html! {
        @if let Some((from, to)) = label.leader {
            line.fig-frame x1=(x2(from.0)) y1=(x2(from.1)) x2=(x2(to.0)) y2=(x2(to.1)) stroke-width="0.8" {}
        }
        text.fig-halo x=(x2(x)) y=(x2(y)) text-anchor="middle" stroke-width="3"
            stroke-linejoin="round" aria-hidden="true" { (body) }
        text x=(x2(x)) y=(x2(y)) text-anchor="middle" { (body) }
    }
}
