//! A scene's first contact force as a picture of a few hundred bytes, which outlives the run that made it.

use crate::curves::{CommonAxis, sample};
use crate::plot::colours::Look;
use crate::plot::polyline::path;
use crate::report::{SceneReport, kinds};
use crate::result::{History, Outcome};
use maud::{Markup, html};

/// Size in units of the drawing, which has a fifth of the resolution of the screen: so the path stays short.
const WIDTH: f64 = 24.0;
const HEIGHT: f64 = 7.0;

/// Paths of the reference and of a model.
pub(crate) fn thumbnail(report: &SceneReport, outcome: &Outcome) -> [String; 2] {
    let panel = kinds::of(report.scene).panels().last();
    let curve = panel.and_then(|panel| panel.curves.first()).map(|(_, name)| *name);
    let (Some(axis), Some(curve)) = (report.comparison.window, curve) else { return Default::default() };
    let values = |history: &History| {
        let found = sample(axis, history).into_iter().find(|sampled| sampled.quantity == curve);
        found.map_or_else(Vec::new, |sampled| sampled.values)
    };
    let both = [&report.reference.history, &outcome.history].map(values);
    let peak = both.iter().flatten().copied().filter(|v| v.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
    both.map(|values| drawn_path(axis, &values, peak))
}

fn drawn_path(axis: CommonAxis, values: &[f64], peak: f64) -> String {
    let point = |(k, v): (usize, &f64)| (WIDTH * axis.time(k) / axis.end, HEIGHT * (1.0 - v / peak));
    path(&values.iter().enumerate().map(point).collect::<Vec<_>>())
}

/// The picture; decoration beside the numbers.
pub(crate) fn drawn([reference, own]: &[String; 2], look: Look) -> Markup {
    html! {
        @if !reference.is_empty() {
            svg.thumbnail viewBox=(format!("-0.3 -0.3 {} {}", WIDTH + 0.6, HEIGHT + 0.6)) aria-hidden="true" {
                path.fig-reference d=(reference) {}
                path class=(look.class) d=(own) {}
            }
        }
    }
}
