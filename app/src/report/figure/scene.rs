//! The figure of a scene, after Fig. 10 of the paper: displacement, velocity and contact force of
//! all models over one time axis, efficiencies in boxes.
//!
//! Models differ by colour and dash, bodies by labels at their curves; the reference's 95 % band is shaded. The colours
//! are those of Okabe and Ito, which colour-blind readers can tell apart.

use crate::curves::CommonAxis;
use crate::format::significant;
use crate::measured::{Measured, REFERENCE};
use crate::plot::svg::{Svg, Theme, text_width, x2};
use crate::report::SceneReport;
use crate::report::figure::geometry::{FigureGeometry, PanelOf};
use crate::report::figure::lines::{Line, lines, measured_lines, stroke};
use crate::report::figure::panel::panel;
use crate::report::figure::residuals::residuals;
use crate::report::kinds;
use maud::{Markup, html};

/// Height of a row of the legend in px.
const LEGEND_ROW: f64 = 20.0;
/// Widths in mm a figure of its own can have.
pub const FIGURE_WIDTHS: std::ops::RangeInclusive<f64> = 75.0..=300.0;

/// Motion of both bodies: what can be measured.
pub(crate) const MOTION: [PanelOf; 2] = [
    PanelOf {
        label: "Displacement in µm",
        factor: 1e6,
        curves: &[("outer", "outer_displacement"), ("inner", "inner_displacement")],
        boxes: false,
    },
    PanelOf {
        label: "Velocity in mm/s",
        factor: 1e3,
        curves: &[("outer", "outer_velocity"), ("inner", "inner_velocity")],
        boxes: true,
    },
];

/// The figure as SVG, inline with residuals; without curves if the reference's history can't be used.
pub fn figure(report: &SceneReport, theme: Theme) -> String {
    match theme {
        Theme::Standalone => scene_drawing(report, &FigureGeometry::PAGE, theme),
        Theme::Inline => scene_drawing(report, &FigureGeometry::PAGE.with_residuals(), theme),
    }
}

/// The figure for a paper, `width` mm wide (within [`FIGURE_WIDTHS`]), as stand-alone SVG with its size in mm and type of
/// 7.5 pt or more.
pub fn printed_figure(report: &SceneReport, width: f64) -> String {
    scene_drawing(report, &FigureGeometry::printed(width), Theme::Standalone)
}

fn scene_drawing(report: &SceneReport, geometry: &FigureGeometry, theme: Theme) -> String {
    let axis = report.comparison.window;
    let mut lines = axis.map_or_else(Vec::new, |axis| lines(report, axis));
    if !geometry.boxes {
        // a column is narrow: lines of 1 pt
        lines.iter_mut().for_each(|line| line.width *= 0.8);
    }
    let title = format!("{}: reduced models and finite-element reference", report.scene.name);
    drawing(&title, geometry, kinds::of(report.scene).panels(), &lines, axis, theme)
}

/// The figure of the first measured record with reference and models (Fig. 12): displacement and velocity of the
/// bodies of the scene called `scene`, filtered to the instrument's bandwidth.
pub fn measured_figure(scene: &str, measured: &Measured, theme: Theme) -> String {
    let has_reference = measured.partners.iter().any(|comparator| comparator.partner == REFERENCE);
    let results =
        if has_reference { ", reduced models and finite-element reference" } else { " and reduced models" };
    let lines = measured_lines(measured);
    let [displacement, velocity] = MOTION;
    let panels = [displacement, PanelOf { boxes: measured.key == "efficiency", ..velocity }];
    let title = format!("{scene}: measurement{results}");
    drawing(&title, &FigureGeometry::PAGE, &panels, &lines, Some(measured.window), theme)
}

fn drawing(
    title: &str,
    geometry: &FigureGeometry,
    panels: &[PanelOf],
    lines: &[Line],
    axis: Option<CommonAxis>,
    theme: Theme,
) -> String {
    let count = panels.len() as f64;
    let legend = FigureLegend::new(geometry, lines);
    let top = legend.height + 14.0;
    let FigureGeometry { width, panel_height, gap, bottom, .. } = *geometry;
    let pair_height = geometry.pair_height();
    let height = top + count * pair_height + (count - 1.0) * gap + bottom;
    let end = axis.map_or(1.0, |a| a.end * 1e6);
    let time = geometry.plot(height - bottom, 0.0, end, [0.0, 1.0]);
    let content = html! {
        (legend.drawing)
        @for (k, shown) in panels.iter().enumerate() {
            (panel(geometry, shown, top + k as f64 * (pair_height + gap), end, lines, axis))
            (residuals(geometry, shown, top + k as f64 * (pair_height + gap) + panel_height, end, lines, axis))
        }
        (time.below(&geometry.instants(&time), "Time in µs"))
        @if lines.is_empty() {
            text x=(width / 2.0) y=(top + panel_height / 2.0) text-anchor="middle" {
                "The history of the reference is damaged and can't be drawn."
            }
        }
    };
    Svg::new(title, [width, height], theme).printed(geometry.millimetres).around(&content).into_string()
}

/// Names of the lines above the panels, in as many rows as they need.
struct FigureLegend {
    height: f64,
    drawing: Markup,
}

impl FigureLegend {
    fn new(geometry: &FigureGeometry, lines: &[Line]) -> Self {
        let name = |line: &Line| match geometry.boxes {
            true => line.name.clone(),
            false => format!("{}: efficiency {} %", line.name, significant(100.0 * line.efficiency, 3)),
        };
        let (mut x, mut row) = (geometry.left, 0);
        let mut items = Vec::new();
        for line in lines {
            let name = name(line);
            let advance = 46.0 + text_width(&name);
            if x > geometry.left && x + advance > geometry.width {
                (x, row) = (geometry.left, row + 1);
            }
            items.push((x, 20.0 + LEGEND_ROW * f64::from(row), line, name));
            x += advance;
        }
        let drawing = html! {
            @for (x, y, line, name) in items {
                (stroke(line, &format!("M{x:.2} {y}L{:.2} {y}", x + 30.0)))
                text x=(x2(x + 37.0)) y=(y + 4.5) { (name) }
            }
        };
        FigureLegend { height: 26.0 + LEGEND_ROW * f64::from(row), drawing }
    }
}
