//! The panel of residuals below a panel of the figure: model minus reference on a symmetric logarithmic axis, over the band.

use crate::curves::CommonAxis;
use crate::format::minus;
use crate::plot::polyline::{Point, path_within};
use crate::plot::svg::{FONT_SIZE, upright, x2};
use crate::plot::symmetric_log::SymmetricLog;
use crate::report::figure::geometry::{FigureGeometry, PanelOf};
use crate::report::figure::lines::Line;
use maud::{Markup, html};

/// Share of the largest residual about which the axis is linear; the page's script has the same.
const LINEAR: f64 = 1e-3;

/// What lines may be off by, px: many are noise, which costs most of a page otherwise.
const TOLERANCE: f64 = 0.6;
/// Between a panel and its residuals, px.
const GAP: f64 = 8.0;

pub(crate) fn residuals(
    geometry: &FigureGeometry,
    shown: &PanelOf,
    top: f64,
    end: f64,
    lines: &[Line],
    axis: Option<CommonAxis>,
) -> Markup {
    let Some(((reference, models), axis)) = lines.split_first().zip(axis) else { return html! {} };
    if geometry.residual_height == 0.0 || models.is_empty() {
        return html! {};
    }
    let curves = || reference.curves.iter().filter(|curve| shown.holds(curve));
    let differences: Vec<(&Line, Vec<f64>)> = models
        .iter()
        .flat_map(|model| {
            curves().filter_map(move |of| {
                Some((model, of, model.curves.iter().find(|c| c.quantity == of.quantity)?))
            })
        })
        .map(|(model, of, own)| {
            (model, own.values.iter().zip(&of.values).map(|(a, b)| (a - b) * shown.factor).collect())
        })
        .collect();
    let bands: Vec<Vec<f64>> = reference
        .bands
        .iter()
        .filter(|band| shown.holds(band))
        .map(|band| band.values.iter().map(|v| v * shown.factor).collect())
        .collect();
    let all = differences.iter().map(|(_, values)| values).chain(&bands).flatten();
    let largest = all.map(|v| v.abs()).filter(|v| v.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
    let scale = SymmetricLog { linear: LINEAR * largest, limit: 1.15 * largest, signed: true };
    let (top, height) = (top + GAP, geometry.residual_height - GAP);
    // the values' axis is another one
    let plot = geometry.plot(top, height, end, [0.0, 1.0]);
    let y_of = |v: f64| top + height * (1.0 - scale.place(v));
    let points = |values: &[f64], sign: f64| -> Vec<Point> {
        values.iter().enumerate().map(|(k, v)| (plot.x(axis.time(k) * 1e6), y_of(sign * v))).collect()
    };
    let outline = |band: &[f64]| {
        let lower = points(band, -1.0).into_iter().rev();
        path_within(&points(band, 1.0).into_iter().chain(lower).collect::<Vec<_>>(), TOLERANCE) + "Z"
    };
    let decade = 10_f64.powf(largest.log10().floor());
    let marks = [-decade, 0.0, decade];
    let (left, right) = (plot.left, plot.left + plot.width);
    html! {
        g stroke-width="1" { @for v in marks { line.fig-grid x1=(left) x2=(right) y1=(x2(y_of(v))) y2=(x2(y_of(v))) {} } }
        @for band in &bands { path.fig-band d=(outline(band)) {} }
        @for (line, values) in &differences {
            path class=(format!("residual {}", line.class)) d=(path_within(&points(values, 1.0), TOLERANCE)) fill="none" stroke-width="1.2"
                stroke-dasharray=(line.dash) stroke-linejoin="round" {}
        }
        @for v in marks {
            text x=(left - 8.0) y=(x2(y_of(v) + 0.36 * FONT_SIZE)) text-anchor="end" font-size="11.5" { (label(v)) }
        }
        (upright(17.0, top + 0.5 * height, "model − FE"))
        (plot.outline())
    }
}

/// A power of ten, or zero.
fn label(mark: f64) -> String {
    let number = match mark.abs() {
        size if size == 0.0 || (1e-3..1e4).contains(&size) => format!("{}", (mark * 1e4).round() / 1e4),
        _ => format!("{mark:.0e}"),
    };
    minus(&number)
}
