//! The page of one reduced model alone: what a scene without a reference can show.

use crate::format::{self, model_name, prefixed, with_unit};
use crate::kinds::of as kind_of;
use crate::plot::{ChartPanel, chart};
use crate::prediction::Prediction;
use crate::report::figure::curves::curves_chart;
use crate::report::kinds;
use crate::report::page::facts::facts;
use crate::report::page::html::{named, page, scrolled};
use crate::report::page::section::flight::flight_html;
use crate::report::page::section::impacts::course;
use crate::result::{History, Outcome, Summary};
use crate::scene::Scene;
use maud::{Markup, PreEscaped, html};

/// The page of the meshed body of `scene` alone.
pub fn body_page(scene: &Scene) -> String {
    let title = format!("{}: mesh", scene.name);
    let body = html! {
        h1 { (title) }
        p.soft { (scene.description) }
        (kinds::of(scene).body(scene, None))
    };
    page(&format!("{title} · impactcheck"), &[], &body, &html! {})
}

/// The page of the model of `scene` that has the `outcome`, with what a converged reference would find.
pub fn model_page(scene: &Scene, outcome: &Outcome, prediction: &Prediction) -> String {
    let Outcome { summary, history } = outcome;
    let model = format!("model {}", model_name(summary.model.as_deref().unwrap_or("?"), summary.modes));
    let title = format!("{}: {model}", scene.name);
    let landing = flight_html(scene, &[summary], None);
    let shown = kinds::of(scene).body(scene, Some(summary));
    let body = html! {
        h1 { (title) }
        p.soft { (scene.description) }
        p.note { "Reduced model without a reference." }
        @if !summary.warnings.is_empty() { ul { @for warning in &summary.warnings { li { (warning) } } } }
        (scrolled("Results", &quantities(scene, summary, prediction)))
        @match prediction {
            Ok(intervals) => @if let Some(any) = intervals.values().next() {
                p.note { "With a probability of 95 % a finite-element reference would lie in the interval. It comes from the errors of "
                    "model C in " (any.scenes) " solved scenes of the group “" (any.stratum) "”." }
            },
            Err(reason) => p.note { "There is no interval of what a converged reference would find: " (reason) "." },
        }
        @for line in estimates(summary) { p { (line) } }
        @if !shown.0.is_empty() { h2 { "The body" } (shown) }
        h2 { "Curves" }
        figure { (PreEscaped(curves(&title, history))) }
        @if summary.impacts.len() > 1 { h2 { "Impacts in series" } figure { (PreEscaped(series(&title, summary))) } }
        @if !landing.0.is_empty() { h2 { "Landing" } (landing) }
        details { summary { "The result (SI units)" } (facts(&[("", serde_json::to_value(summary).ok().as_ref())])) }
        details { summary { "The scene (SI units)" } (facts(&[("", serde_json::to_value(scene).ok().as_ref())])) }
    };
    page(&format!("{title} · impactcheck"), &[], &body, &html! {})
}

/// Estimated errors and eigenfrequencies, in sentences.
fn estimates(summary: &Summary) -> Vec<String> {
    let errors = [("truncated modes", summary.truncation_error), ("the mesh", summary.mesh_error)];
    let error = |(what, error): (&str, Option<f64>)| Some(format!("{what} {:.2} %", 100.0 * error?));
    let errors: Vec<String> = errors.into_iter().filter_map(error).collect();
    let frequencies: Vec<String> =
        summary.frequencies.iter().map(|hertz| with_unit(*hertz, prefixed("Hz", *hertz), 4)).collect();
    let errors = (!errors.is_empty()).then(|| format!("Estimated error by {}.", errors.join(", by ")));
    let frequencies =
        (!frequencies.is_empty()).then(|| format!("Lowest eigenfrequencies: {}.", frequencies.join(", ")));
    errors.into_iter().chain(frequencies).collect()
}

fn quantities(scene: &Scene, summary: &Summary, prediction: &Prediction) -> Markup {
    let own = summary.quantities.iter().filter(|quantity| kind_of(scene).has(scene, quantity.name));
    let own = own.map(|quantity| (quantity.name, quantity.value, quantity.unit));
    let rows = own.chain(summary.motion().map(|(name, value, unit)| (name, Some(value), unit)));
    let shown = |value: Option<f64>, unit| {
        value.map_or_else(|| "not determined".to_owned(), |value| with_unit(value, prefixed(unit, value), 5))
    };
    let found = prediction.as_ref().ok();
    html! { table {
        @if found.is_some() { thead { tr { th {} th { "model" } th { "a converged reference would find (95 %)" } } } }
        tbody { @for (name, value, unit) in rows { tr {
            th scope="row" { (named(name)) }
            td { (shown(value, unit)) }
            @if let Some(intervals) = found {
                td { @if let Some(one) = intervals.get(name) { (format::interval([one.low, one.high], unit).join(" to ")) } }
            }
        } } }
    } }
}

fn curves(title: &str, history: &History) -> String {
    let curves: Vec<_> = history.curves.iter().map(|c| (c.name, c.unit, &c.values[..])).collect();
    curves_chart(title, &history.time, &curves)
}

fn series(title: &str, summary: &Summary) -> String {
    let panel = ChartPanel {
        x_label: "Number of the impact".into(),
        y_label: "Efficiency in %".into(),
        series: vec![course(summary, String::new())],
        counted: true,
        ..ChartPanel::default()
    };
    chart(title, &[panel])
}
