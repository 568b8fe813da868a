//! All discrepancies of a scene in one picture: quantities in rows, a mark per model on a symmetric logarithmic axis, over the
//! reference's band and the tolerances. Abscissas are per cents of the row's width, so that type keeps its size on any screen.

use crate::comparison::{Discrepancy, ModelComparison, SceneComparison};
use crate::format::{minus, model_name, percent, words};
use crate::plot::colours::{Look, look};
use crate::plot::symmetric_log::SymmetricLog;
use crate::report::page::html::named;
use maud::{Markup, html};

/// Height of a model's lane in a row, and what a row has above and below the lanes, px.
const LANE: f64 = 5.5;
const EDGE: f64 = 2.5;
/// Least height of a row, px.
const LEAST: f64 = 20.0;

/// The picture, in two tables: single numbers with their sign, and curves by the distance from the reference's.
pub(crate) fn discrepancy_picture(comparison: &SceneComparison) -> Markup {
    // a program that has failed has no rows
    let Some(first) = comparison.models.iter().find(|model| !model.discrepancies.is_empty()) else {
        return html! {};
    };
    let is_number =
        |row: &Discrepancy| first.summary.quantities.get(&row.quantity).is_some_and(|q| !q.is_count);
    let names = |is_selected: &dyn Fn(&Discrepancy) -> bool| -> Vec<&str> {
        first.discrepancies.iter().filter(|row| is_selected(row)).map(|row| &*row.quantity).collect()
    };
    let (numbers, curves) = (names(&is_number), names(&|row| row.quantity.ends_with("_rms")));
    let shown = |row: &&Discrepancy| numbers.contains(&&*row.quantity) || row.quantity.ends_with("_max");
    let rows = comparison.models.iter().flat_map(|model| &model.discrepancies).filter(shown);
    let axis = SymmetricLog::over(rows.flat_map(reach), true);
    html! {
        div.pictures-of-discrepancy {
            (table("Single numbers", &numbers, comparison, &axis))
            (table("Curves", &curves, comparison, &SymmetricLog { signed: false, ..axis }))
        }
        p.soft.note {
            "Reduced minus reference over the reference, in %. "
            @for model in &comparison.models { (key(look(&model.model, comparison.names()))) " " (model_name(&model.model, model.summary.modes)) ", " }
            "each over its tolerance (bar in its colour; about the declared bias, where there is one). Grey: uncertainty (95 %) of the "
            @if first.is_on_common_mesh() { "difference, as both are solutions on the same mesh. " } @else { "reference. " }
            "Curves: root mean square of the distance over the reference's peak, with a line to the largest distance."
        }
    }
}

fn table(name: &str, quantities: &[&str], comparison: &SceneComparison, axis: &SymmetricLog) -> Markup {
    let height = height(comparison.models.len());
    let id = if axis.signed { "grid-signed" } else { "grid" };
    html! {
        table.discrepancy-picture data-linear=(axis.linear) data-limit=(axis.limit) {
            thead { tr {
                th scope="col" { (name) }
                th.left scope="col" { (scale(axis, id)) }
            } }
            tbody { @for quantity in quantities { tr data-quantity=(quantity) {
                th scope="row" { (named(quantity.trim_end_matches("_rms"))) }
                td { svg height=(height) width="100%" role="img" aria-label=(description(quantity, comparison)) {
                    (row(quantity, comparison, axis, id))
                } }
            } } }
        }
    }
}

/// The axis above the rows, which use the grid `id` that is defined here.
pub(crate) fn scale(axis: &SymmetricLog, id: &str) -> Markup {
    let zero = axis.ticks().iter().position(|tick| *tick == 0.0).unwrap_or(0);
    html! {
        svg height="22" width="100%" role="img" aria-label="Axis in per cent" {
            defs { g id=(id) { @for tick in axis.ticks() {
                line class=(if tick == 0.0 { "fig-frame" } else { "fig-grid" }) x1=(at(axis, tick)) x2=(at(axis, tick)) y1="0" y2="100%" {}
            } } }
            // next to zero there is no room
            @for (k, tick) in axis.ticks().iter().enumerate().filter(|(_, t)| **t == 0.0 || t.abs() > 5.0 * axis.linear) {
                text class=[(k.abs_diff(zero) % 2 == 1).then_some("alternate")] x=(at(axis, *tick)) y="15" text-anchor="middle" { (label(*tick)) }
            }
        }
    }
}

/// One row: grid, band, and in a lane per model its tolerance and its mark.
fn row(quantity: &str, comparison: &SceneComparison, axis: &SymmetricLog, grid: &str) -> Markup {
    let rows = || comparison.models.iter().map(|model| (model, model.discrepancy(quantity)));
    let band = rows().find_map(|(_, row)| row.and_then(|row| Some(row.band()? / row.scale()?)));
    html! {
        @if let Some(band) = band { (bar("fig-band", axis, [-band, band], (1.0, "100%"))) }
        use href=(format!("#{grid}")) {}
        @for (lane, (model, row)) in rows().enumerate() {
            @let look = look(&model.model, comparison.names());
            @let middle = 0.5 * height(comparison.models.len()) + LANE * (lane as f64 - 0.5 * (comparison.models.len() as f64 - 1.0));
            @if let Some((row, relative)) = row.and_then(|row| Some((row, row.relative?))) {
                @if let Some((width, scale)) = row.tolerance.zip(row.scale()) {
                    @let about = row.bias.unwrap_or(0.0);
                    (bar(&format!("fig-tolerance {}", look.class), axis, [(about - width) / scale, (about + width) / scale], (middle - 2.5, "5")))
                }
                @if let Some(largest) = largest(quantity, model) {
                    line class=(look.class) x1=(at(axis, relative)) x2=(at(axis, largest)) y1=(middle) y2=(middle) {}
                }
                svg x=(at(axis, relative)) y=(middle) overflow="visible" data-model=(model.model) data-si=(relative) {
                    title { (model.model) ": " (percent(Some(relative))) }
                    (mark(look.shape, look.class))
                }
            }
        }
    }
}

fn height(models: usize) -> f64 {
    (2.0 * EDGE + LANE * models as f64).max(LEAST)
}

/// What the axis has to show of a row: its discrepancy, its band, its tolerance.
fn reach(row: &Discrepancy) -> Vec<f64> {
    let scale = row.scale().unwrap_or(f64::NAN);
    let tolerance = row.tolerance.map(|width| (width + row.bias.unwrap_or(0.0).abs()) / scale);
    [row.relative, row.band().map(|band| band / scale), tolerance].into_iter().flatten().collect()
}

/// The largest distance of a curve.
fn largest(quantity: &str, model: &ModelComparison) -> Option<f64> {
    model.discrepancy(&format!("{}_max", quantity.strip_suffix("_rms")?))?.relative
}

pub(crate) fn bar(
    class: &str,
    axis: &SymmetricLog,
    [from, to]: [f64; 2],
    (top, height): (f64, &str),
) -> Markup {
    let [left, right] = [from, to].map(|end| 100.0 * axis.place(end));
    // a bar too narrow to be seen is still there
    let width = (right - left).max(0.3);
    html! { rect class=(class) x=(format!("{left:.3}%")) width=(format!("{width:.3}%")) y=(top) height=(height) {} }
}

/// A mark about the origin: triangle, square, circle, diamond, triangle on its tip, cross or flat hexagon.
pub(crate) fn mark(shape: usize, class: &str) -> Markup {
    let class = format!("mark {class}");
    match shape {
        0 => html! { path class=(class) d="M-4.5 3.6H4.5L0-4.4Z" {} },
        1 => html! { path class=(class) d="M-3.6-3.6H3.6V3.6H-3.6Z" {} },
        2 => html! { circle class=(class) r="4" {} },
        3 => html! { path class=(class) d="M0-5L4.2 0L0 5L-4.2 0Z" {} },
        4 => html! { path class=(class) d="M-4.5-3.6H4.5L0 4.4Z" {} },
        5 => html! { path class=(class) d="M-1.5-4.5H1.5V-1.5H4.5V1.5H1.5V4.5H-1.5V1.5H-4.5V-1.5H-1.5Z" {} },
        _ => html! { path class=(class) d="M-5 0L-2.5-3H2.5L5 0L2.5 3H-2.5Z" {} },
    }
}

/// The mark in the key.
fn key(look: Look) -> Markup {
    html! { svg.key viewBox="-6 -6 12 12" aria-hidden="true" { (mark(look.shape, look.class)) } }
}

pub(crate) fn at(axis: &SymmetricLog, value: f64) -> String {
    format!("{:.3}%", 100.0 * axis.place(value))
}

fn label(tick: f64) -> String {
    let number = format!("{}", (1e4 * tick).round() / 100.0);
    minus(&number)
}

/// The row in words.
fn description(quantity: &str, comparison: &SceneComparison) -> String {
    let of_model = |model: &ModelComparison| {
        let relative = model.discrepancy(quantity).and_then(|row| row.relative);
        format!("{} {}", model.model, percent(relative))
    };
    let models: Vec<String> = comparison.models.iter().map(of_model).collect();
    format!("{}: {}", words(quantity), models.join(", "))
}
