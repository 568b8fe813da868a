//! Mesh convergence of the reference: each quantity on its meshes, the fit, and the uncertainty that follows from both.

use crate::comparison::{MeshValues, ORDER, mesh_values};
use crate::format::words;
use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::polyline::path;
use crate::plot::svg::{FONT_SIZE, x2};
use crate::result::Summary;
use maud::{Markup, html};

/// Size of a panel and the room around its axes, px.
const WIDTH: f64 = 300.0;
const HEIGHT: f64 = 190.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 46.0;
/// Points of the fit's curve.
const POINTS: usize = 24;

/// The panels with their caption; nothing without a series of meshes.
pub(crate) fn convergence_html(reference: &Summary) -> Markup {
    let found = mesh_values(reference);
    let shown: Vec<(&str, &MeshValues)> = reference
        .quantities
        .iter()
        .filter_map(|quantity| Some((quantity.name, found.get(quantity.name)?)))
        .filter(|(_, values)| values.fit[0].abs() > values.band)
        .collect();
    if shown.is_empty() {
        return html! {};
    }
    html! {
        figure {
            div.map { @for (name, values) in shown { (panel(name, values)) } }
            figcaption { "Mesh convergence of the reference. Each dot is a mesh; the element size of the finest one is 1. Line: fit "
                "v + c h" sup { (ORDER) } ". Shaded: 95 % uncertainty of the value on the finest mesh. Zero is v, the value for infinitely "
                "fine meshes. Values that are zero within their uncertainty are omitted." }
        }
    }
}

/// Deviations from the limit in % of it over the element size.
fn panel(name: &str, MeshValues { values, fit: [limit, slope], band }: &MeshValues) -> Markup {
    let percent = |value: f64| 100.0 * (value / limit - 1.0);
    let largest = values.last().map_or(1.0, |(size, _)| *size);
    let [low, high] = [-band, *band].map(|half| percent(values[0].1 + half));
    let line: Vec<(f64, f64)> = (0..=POINTS)
        .map(|k| largest * k as f64 / POINTS as f64)
        .map(|h| (h, percent(limit + slope * h.powf(ORDER))))
        .collect();
    let all =
        values.iter().map(|(_, value)| percent(*value)).chain([low, high]).chain(line.iter().map(|p| p.1));
    let plot = Plot {
        left: LEFT,
        top: TOP,
        width: WIDTH - LEFT - RIGHT,
        height: HEIGHT - TOP - BOTTOM,
        x: PlotAxis::linear(0.0, 1.05 * largest),
        y: PlotAxis::over(all, false).widened(0.06),
    };
    let (x_marks, y_marks) = (plot.x.marks(5), plot.y.marks(5));
    let [top, bottom] = [high.max(low), high.min(low)].map(|value| plot.y(value));
    let title = words(name);
    html! {
        svg viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) font-size=(FONT_SIZE) role="img" aria-label=(format!("Mesh convergence: {title}")) {
            rect.fig-band x=(plot.left) width=(plot.width) y=(x2(top)) height=(x2(bottom - top)) {}
            (plot.grid(&x_marks, &y_marks))
            path.fig-C d=(path(&line.into_iter().map(|point| plot.at(point)).collect::<Vec<_>>())) fill="none" stroke-width="1.6" {}
            (plot.below(&x_marks, "element size"))
            (plot.left_labels(&y_marks, "deviation in %"))
            (plot.outline())
            text x=(LEFT) y="17" font-weight="600" { (title) }
            @for (size, value) in values {
                @let (x, y) = plot.at((*size, percent(*value)));
                circle.fig-part cx=(x2(x)) cy=(x2(y)) r="3.2" {}
            }
        }
    }
}
