//! The figure of a scene, after Fig. 10 of the paper: displacement, velocity and contact force of
//! all models over one time axis, efficiencies in boxes.
//!
//! Models differ by colour and dash, bodies by labels at their curves. The colours are those of
//! Okabe and Ito, which colour-blind readers can tell apart.

use super::SceneReport;
use super::efficiency_boxes::EfficiencyBoxes;
use super::format::model_name;
use super::label_placement::{Panel, Rect};
use super::polyline::{Point, path, thinned};
use super::ticks::{tick_label, ticks};
use crate::comparison::{CommonAxis, SampledCurve, sample};
use crate::measured::Measured;
use maud::{Markup, PreEscaped, html};

const WIDTH: f64 = 760.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 40.0;
const PANEL_HEIGHT: f64 = 226.0;
const PANEL_GAP: f64 = 16.0;
const BOTTOM: f64 = 50.0;
/// Font size in px.
const FONT_SIZE: f64 = 13.0;

/// Where the colours come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Theme {
    /// White background, colours in the drawing: a file of its own.
    Standalone,
    /// No colours: the page it stands in gives them, light or dark.
    Inline,
}

/// Colours of the stand-alone drawing; the page's style sheet has the same classes.
const STYLE: &str = "\
.fig-text{fill:#1a1a1a}.fig-frame{stroke:#444;fill:none}.fig-grid{stroke:#e3e3e3}\
.fig-box{fill:#ececec;stroke:#bdbdbd}.fig-halo{stroke:#fff}\
.fig-reference{stroke:#1a1a1a}.fig-A{stroke:#d55e00}.fig-B{stroke:#0072b2}.fig-C{stroke:#009e73}.fig-measured{stroke:#cc79a7}";

/// One of the three panels.
struct Quantity {
    suffix: &'static str,
    label: &'static str,
    factor: f64,
    bodies: &'static [&'static str],
}

const QUANTITIES: [Quantity; 3] = [
    Quantity {
        suffix: "displacement",
        label: "Displacement in µm",
        factor: 1e6,
        bodies: &["outer", "plate", "inner"],
    },
    Quantity {
        suffix: "velocity",
        label: "Velocity in mm/s",
        factor: 1e3,
        bodies: &["outer", "plate", "inner"],
    },
    Quantity { suffix: "force", label: "Contact force in N", factor: 1.0, bodies: &["outer", "inner"] },
];

/// What can be measured: the bodies, by their motion.
const MEASURED: [Quantity; 2] = [
    Quantity {
        suffix: "displacement",
        label: "Displacement in µm",
        factor: 1e6,
        bodies: &["outer", "inner"],
    },
    Quantity { suffix: "velocity", label: "Velocity in mm/s", factor: 1e3, bodies: &["outer", "inner"] },
];

/// Curves of one result, and how they are drawn.
pub(super) struct Line {
    name: String,
    pub(super) short: String,
    class: String,
    dash: &'static str,
    width: f64,
    pub(super) efficiency: f64,
    curves: Vec<SampledCurve>,
}

fn dash(model: &str) -> &'static str {
    match model {
        "A" => "2 2.6",
        "B" => "7 3",
        _ => "9 2.5 2 2.5",
    }
}

fn lines(report: &SceneReport, axis: CommonAxis) -> Vec<Line> {
    let reference = Line {
        name: "FE reference".into(),
        short: "FE".into(),
        class: "fig-reference".into(),
        dash: "none",
        width: 2.1,
        efficiency: report.reference.summary.quantities.efficiency,
        curves: sample(axis, &report.reference.history),
    };
    let reduced = report.reduced.iter().map(|outcome| {
        let model = outcome.summary.model.clone().unwrap_or_default();
        Line {
            name: format!("model {}", model_name(&model, outcome.summary.modes)),
            dash: dash(&model),
            class: format!("fig-{model}"),
            width: 1.7,
            efficiency: outcome.summary.quantities.efficiency,
            curves: sample(axis, &outcome.history),
            short: model,
        }
    });
    std::iter::once(reference).chain(reduced).collect()
}

/// The first measured record and everything it is compared with, as the instrument shows it.
fn measured_lines(measured: &Measured) -> Vec<Line> {
    let record = Line {
        name: "measured".into(),
        short: "LDV".into(),
        class: "fig-measured".into(),
        dash: "none",
        width: 1.4,
        efficiency: measured.records.first().and_then(|record| record.efficiency).unwrap_or(f64::NAN),
        curves: measured.curves.clone(),
    };
    let partners = measured.partners.iter().map(|partner| {
        let reference = partner.partner == "reference";
        let name = if reference { "FE reference".into() } else { format!("model {}", partner.partner) };
        Line {
            name,
            short: if reference { "FE".into() } else { partner.partner.clone() },
            class: format!("fig-{}", partner.partner),
            dash: if reference { "none" } else { dash(&partner.partner) },
            width: if reference { 2.1 } else { 1.7 },
            efficiency: partner.efficiency,
            curves: partner.filtered.clone(),
        }
    });
    std::iter::once(record).chain(partners).collect()
}

/// Width in px of `text` in DejaVu Sans, estimated from above.
fn text_width(text: &str) -> f64 {
    0.62 * FONT_SIZE * text.chars().count() as f64
}

/// The figure as SVG; without curves if the reference's history can't be used.
pub fn figure(report: &SceneReport, theme: Theme) -> String {
    let axis = report.comparison.window;
    let lines = axis.map_or_else(Vec::new, |axis| lines(report, axis));
    let title = format!("{}: reduced models and finite-element reference", report.scene.name);
    drawing(&title, &QUANTITIES, &lines, axis, theme)
}

/// The figure of the first measured record beside reference and models (Fig. 12): displacement and velocity of the
/// bodies, filtered to the instrument's bandwidth. `None` if nothing was measured.
pub fn measured_figure(report: &SceneReport, theme: Theme) -> Option<String> {
    let measured = report.comparison.measured.as_ref()?;
    let title = format!("{}: measurement, reduced models and finite-element reference", report.scene.name);
    Some(drawing(&title, &MEASURED, &measured_lines(measured), Some(measured.window), theme))
}

fn drawing(
    title: &str,
    quantities: &[Quantity],
    lines: &[Line],
    axis: Option<CommonAxis>,
    theme: Theme,
) -> String {
    let panels = quantities.len() as f64;
    let height = TOP + panels * PANEL_HEIGHT + (panels - 1.0) * PANEL_GAP + BOTTOM;
    let end = axis.map_or(1.0, |a| a.end * 1e6);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {WIDTH} {height}"))
            width=[(theme == Theme::Standalone).then_some(WIDTH)]
            height=[(theme == Theme::Standalone).then_some(height)]
            font-family="DejaVu Sans, Verdana, sans-serif" font-size=(FONT_SIZE) role="img" {
            title { (title) }
            @if theme == Theme::Standalone {
                style { (PreEscaped(STYLE)) }
                rect width=(WIDTH) height=(height) fill="#ffffff" {}
            }
            (legend(lines))
            @for (k, quantity) in quantities.iter().enumerate() {
                (panel(quantity, TOP + k as f64 * (PANEL_HEIGHT + PANEL_GAP), end, lines, axis))
            }
            (time_labels(end, height))
            @if lines.is_empty() {
                text.fig-text x=(WIDTH / 2.0) y=(TOP + PANEL_HEIGHT / 2.0) text-anchor="middle" {
                    "The history of the reference is damaged and can't be drawn."
                }
            }
        }
    }
    .into_string()
}

pub(super) fn stroke(line: &Line, data: &str) -> Markup {
    html! {
        path class=(line.class) d=(data) fill="none" stroke-width=(line.width)
            stroke-dasharray=(line.dash) stroke-linejoin="round" {}
    }
}

fn legend(lines: &[Line]) -> Markup {
    let mut x = LEFT;
    let items: Vec<_> = lines
        .iter()
        .map(|line| {
            let at = x;
            x += 46.0 + text_width(&line.name);
            (at, line)
        })
        .collect();
    html! {
        @for (x, line) in items {
            (stroke(line, &format!("M{x:.2} 20L{:.2} 20", x + 30.0)))
            text.fig-text x=(format!("{:.2}", x + 37.0)) y="24.5" { (line.name) }
        }
    }
}

fn x_of(time: f64, end: f64) -> f64 {
    LEFT + (WIDTH - LEFT - RIGHT) * time / end
}

fn time_labels(end: f64, height: f64) -> Markup {
    let marks = ticks(0.0, end, 8);
    html! {
        @for t in &marks {
            text.fig-text x=(format!("{:.2}", x_of(*t, end))) y=(height - BOTTOM + 19.0) text-anchor="middle" {
                (tick_label(*t, &marks))
            }
        }
        text.fig-text x=((LEFT + WIDTH - RIGHT) / 2.0) y=(height - 9.0) text-anchor="middle" {
            "Time in µs"
        }
    }
}

/// Lowest and highest value over all lines, with room on both sides.
fn range(quantity: &Quantity, lines: &[Line]) -> (f64, f64) {
    let values = lines
        .iter()
        .flat_map(|l| &l.curves)
        .filter(|c| c.quantity.ends_with(quantity.suffix))
        .flat_map(|c| &c.values)
        .filter(|v| v.is_finite())
        .map(|v| v * quantity.factor);
    let (low, high) = values.fold((0.0_f64, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
    let room = if high > low { 0.07 * (high - low) } else { 1.0 };
    (if low < 0.0 { low - room } else { -0.5 * room }, high + room)
}

/// One panel with its curves in px.
struct Layout<'a> {
    low: f64,
    high: f64,
    top: f64,
    drawn: Vec<(&'a Line, Vec<Vec<Point>>)>,
    room: Panel,
}

impl<'a> Layout<'a> {
    /// `headroom` px are kept free at the top.
    fn new(
        quantity: &Quantity,
        (top, end, headroom): (f64, f64, f64),
        lines: &'a [Line],
        axis: Option<CommonAxis>,
    ) -> Self {
        let (low, high) = range(quantity, lines);
        let high = low + (high - low) * PANEL_HEIGHT / (PANEL_HEIGHT - headroom);
        let y_of = |v: f64| y_of(v, top, low, high);
        let points = |line: &Line, body: &str| -> Vec<Point> {
            let name = format!("{body}_{}", quantity.suffix);
            let curve = line.curves.iter().find(|c| c.quantity == name);
            axis.zip(curve).map_or_else(Vec::new, |(axis, curve)| {
                let at = |(k, v): (usize, &f64)| (x_of(axis.time(k) * 1e6, end), y_of(v * quantity.factor));
                curve.values.iter().enumerate().map(at).filter(|p| p.1.is_finite()).collect()
            })
        };
        let drawn: Vec<(&Line, Vec<Vec<Point>>)> =
            lines.iter().map(|l| (l, quantity.bodies.iter().map(|b| points(l, b)).collect())).collect();
        let area = Rect {
            x: LEFT + 6.0,
            y: top + 5.0,
            width: WIDTH - LEFT - RIGHT - 12.0,
            height: PANEL_HEIGHT - 10.0,
        };
        let curves = drawn.iter().flat_map(|(_, bodies)| bodies).map(|line| thinned(line, 2.0)).collect();
        Layout { low, high, top, room: Panel { area, curves, taken: Vec::new() }, drawn }
    }

    fn y_of(&self, value: f64) -> f64 {
        y_of(value, self.top, self.low, self.high)
    }
}

fn y_of(value: f64, top: f64, low: f64, high: f64) -> f64 {
    top + PANEL_HEIGHT * (high - value) / (high - low)
}

/// The boxes fit between the curves in one of their two arrangements, or room is made at the top.
fn layout_with_boxes<'a>(
    quantity: &Quantity,
    top: f64,
    end: f64,
    lines: &'a [Line],
    axis: Option<CommonAxis>,
) -> (Layout<'a>, EfficiencyBoxes) {
    let mut layout = Layout::new(quantity, (top, end, 0.0), lines, axis);
    for arrangement in [EfficiencyBoxes::column(lines.len()), EfficiencyBoxes::row(lines.len())] {
        let (free, place) = layout.room.find_box(arrangement.width(), arrangement.height());
        if free >= 5.0 {
            layout.room.taken.push(place);
            return (layout, arrangement.at(place));
        }
    }
    let row = EfficiencyBoxes::row(lines.len());
    let mut layout = Layout::new(quantity, (top, end, row.height() + 12.0), lines, axis);
    let (_, place) = layout.room.find_box(row.width(), row.height());
    layout.room.taken.push(place);
    (layout, row.at(place))
}

fn panel(quantity: &Quantity, top: f64, end: f64, lines: &[Line], axis: Option<CommonAxis>) -> Markup {
    let (mut layout, boxes) = if quantity.suffix == "velocity" {
        let (layout, boxes) = layout_with_boxes(quantity, top, end, lines, axis);
        (layout, Some(boxes))
    } else {
        (Layout::new(quantity, (top, end, 0.0), lines, axis), None)
    };
    let labels: Vec<_> =
        quantity.bodies.iter().enumerate().map(|(k, body)| body_label(&mut layout, body, k)).collect();
    let (low, high) = (layout.low, layout.high);
    let width = WIDTH - LEFT - RIGHT;
    let (x_marks, y_marks) = (ticks(0.0, end, 8), ticks(low, high, 5));
    html! {
        g stroke-width="1" {
            @for t in &x_marks {
                line.fig-grid x1=(x2(x_of(*t, end))) x2=(x2(x_of(*t, end))) y1=(top) y2=(top + PANEL_HEIGHT) {}
            }
            @for v in &y_marks {
                line.fig-grid x1=(LEFT) x2=(LEFT + width) y1=(x2(layout.y_of(*v))) y2=(x2(layout.y_of(*v))) {}
            }
        }
        @for v in &y_marks {
            text.fig-text x=(LEFT - 8.0) y=(x2(layout.y_of(*v) + 0.36 * FONT_SIZE)) text-anchor="end" {
                (tick_label(*v, &y_marks))
            }
        }
        text.fig-text transform=(format!("translate(17 {:.2}) rotate(-90)", top + PANEL_HEIGHT / 2.0))
            text-anchor="middle" { (quantity.label) }
        @for (line, bodies) in &layout.drawn {
            @for body in bodies { (stroke(line, &path(body))) }
        }
        rect.fig-frame x=(LEFT) y=(top) width=(width) height=(PANEL_HEIGHT) {}
        @if let Some(boxes) = boxes { (boxes.draw(lines)) }
        @for label in labels { (label) }
    }
}

/// Coordinate with two decimals.
pub(super) fn x2(value: f64) -> String {
    format!("{value:.2}")
}

fn body_label(layout: &mut Layout, body: &str, k: usize) -> Markup {
    let zero = layout.y_of(0.0);
    let Some((_, reference)) = layout.drawn.first() else { return html! {} };
    let thin: Vec<_> = reference.iter().map(|line| thinned(line, 2.0)).collect();
    let others: Vec<_> = (0..thin.len()).filter(|j| *j != k).map(|j| thin[j].clone()).collect();
    // Where a curve is zero others may be as well; it is labelled elsewhere if there is an elsewhere.
    let away = |p: &&Point| (p.1 - zero).abs() > 0.08 * PANEL_HEIGHT;
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
        text.fig-text.fig-halo x=(x2(x)) y=(x2(y)) text-anchor="middle" stroke-width="3"
            stroke-linejoin="round" aria-hidden="true" { (body) }
        text.fig-text x=(x2(x)) y=(x2(y)) text-anchor="middle" { (body) }
    }
}
