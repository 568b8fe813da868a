//! The frame of every page, and `index.html` with the verdicts. Pages are self-contained: style, script and figures are
//! inside, nothing is loaded. Every number carries its SI value in `data-si`.

use super::format::{Prefixed, model_name, percent, prefixed, significant, with_unit, words};
use super::{Attachments, Report};
use crate::comparison::{Discrepancy, ModelComparison, SceneComparison, Shown, Verdict};
use crate::result::Quantities;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("assets/style.css");

/// A page; `scripts` stand behind its body.
pub(super) fn page(title: &str, styles: &[&str], body: &Markup, scripts: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                @for style in styles.iter().chain([&STYLE]) { style { (PreEscaped(style)) } }
            }
            body { main { (body) } (scripts) }
        }
    }
    .into_string()
}

/// A verdict as people are told it.
pub(super) fn shown(shown: Shown) -> Markup {
    let class = match shown {
        Shown::Pass | Shown::PassAboutBias => "verdict pass",
        Shown::Fail => "verdict fail",
        Shown::NotGated => "verdict open",
    };
    html! { span class=(class) { (shown.words()) } }
}

pub(super) fn badge(verdict: Verdict) -> Markup {
    html! { span class=(format!("verdict {verdict}")) { (verdict) } }
}

/// Something wider than a phone, which scrolls by itself, also by keyboard.
pub(super) fn scrolled(name: &str, content: &Markup) -> Markup {
    html! { div.scroll role="region" tabindex="0" aria-label=(name) { (content) } }
}

/// A drawing as wide as a page, and the same as wide as a phone; the screen decides which is seen.
pub(super) fn drawn(wide: &str, narrow: &str) -> Markup {
    html! { div.wide { (PreEscaped(wide)) } div.narrow { (PreEscaped(narrow)) } }
}

/// A drawing with type that must not shrink with the screen: it scrolls by itself.
pub(super) fn detailed(name: &str, drawing: &Markup) -> Markup {
    html! { div.scroll.detailed role="region" tabindex="0" aria-label=(name) { (drawing) } }
}

/// A cell with a number: SI value in `data-si`, shown with its prefix. Empty `data-si` = not a number.
pub(super) fn number(field: &str, value: Option<f64>, to: Prefixed, digits: usize) -> Markup {
    let finite = value.filter(|v| v.is_finite());
    html! {
        td data-field=(field) data-si=(finite.map_or(String::new(), |v| v.to_string())) {
            (finite.map_or("–".into(), |v| with_unit(v, to, digits)))
        }
    }
}

/// The page with the verdict of every scene and model.
pub fn index_page(report: &Report) -> String {
    let verdict = report.comparison().verdict;
    let body = html! {
        h1 { "impactcheck " (shown(Shown::of(verdict, gated(report), 0))) }
        p.soft { "Reduced models of an impact against explicit finite elements. " (counts(report)) }
        div.cards {
            @for scene in &report.scenes { (card(&scene.scene.description, &scene.comparison, &scene.attachments)) }
            @for seat in &report.seats { (card(&seat.scene.description, &seat.comparison, &seat.attachments)) }
        }
        h2 { "Verdicts" }
        (scrolled("Verdicts", &html! { table.verdicts {
            thead { tr {
                th scope="col" { "scene" } th.left scope="col" { "model" } th.left scope="col" { "verdict" }
                th scope="col" { "efficiency" } th scope="col" { "reference" }
                th.left scope="col" { "largest discrepancy" } th scope="col" { "95 % band" }
                th.left scope="col" { "nearest to its bound" } th scope="col" { "tolerance used" }
            } }
            tbody {
                @for scene in &report.scenes { (index_rows(&scene.comparison)) }
                @for seat in &report.seats { (index_rows(&seat.comparison)) }
            }
        } }))
        p.soft { "The band is the 95 % band of the reference's own numerical error. Tolerance used: how much of its tolerance "
            "the gated quantity nearest to its bound takes; beyond 100 % the model fails." }
        p { "As data: " a href="comparison.json" { "JSON" } " · " a href="comparison.md" { "Markdown" } " · "
            a href="junit.xml" { "JUnit" } }
    };
    page("impactcheck", &[], &body, &html! {})
}

/// Rows of all scenes that have a tolerance.
fn gated(report: &Report) -> usize {
    let scenes = report.scenes.iter().map(|scene| scene.comparison.gated_and_failed().0);
    let seats = report.seats.iter().map(|seat| seat.comparison.gated_and_failed().0);
    scenes.chain(seats).sum()
}

/// How much was gated and failed, in a sentence.
fn counts(report: &Report) -> String {
    fn rows<Q: Quantities>(scene: &SceneComparison<Q>) -> impl Iterator<Item = &Discrepancy> {
        scene.models.iter().flat_map(|model| &model.discrepancies)
    }
    let rows = || {
        let scenes = report.scenes.iter().flat_map(|scene| rows(&scene.comparison));
        scenes.chain(report.seats.iter().flat_map(|seat| rows(&seat.comparison)))
    };
    let gated = gated(report);
    if gated == 0 {
        return "Nothing is gated: no scene has tolerances.".into();
    }
    let failed = rows().filter(|row| !row.verdict.passed()).count();
    let scenes = report.scenes.len() + report.seats.len();
    let plural = |n: usize| if n == 1 { "" } else { "s" };
    let outcome = if failed == 0 { "all within".into() } else { format!("{failed} not within") };
    format!("{scenes} scene{}, {gated} gated quantities, {outcome} their tolerances.", plural(scenes))
}

/// A scene in short.
fn card<Q: Quantities>(
    description: &str,
    comparison: &SceneComparison<Q>,
    attachments: &Attachments,
) -> Markup {
    html! {
        section.card {
            h2 { (scene_link(comparison)) " " (shown(comparison.shown())) }
            p.soft { (description) }
            ul.models { @for model in &comparison.models { li { (model_line(model)) } } }
            @let drifting = attachments.trends.iter().filter(|trend| trend.drifts_since.is_some()).count();
            @if drifting > 0 { p { strong { "Drift: " } (drifting) " of " (attachments.trends.len()) " numbers recorded over commits." } }
        }
    }
}

/// Verdict of a model with its largest discrepancy, the band it is to be seen against, and what the gate makes of it.
pub(super) fn model_line<Q: Quantities>(model: &ModelComparison<Q>) -> Markup {
    html! {
        (shown(model.shown())) " model " (model_name(&model.model, model.summary.modes))
        @if let Some(d) = model.largest() {
            ": largest discrepancy " strong { (percent(d.relative)) } " (" (words(&d.quantity)) (relative_band(d)) ")"
        }
        "; "
        @if let Some((d, used)) = model.tightest().and_then(|d| Some((d, d.used()?))) {
            (model.gated()) " of " (model.discrepancies.len()) " rows gated, at most " (significant(100.0 * used, 2))
            " % of a tolerance used (" (words(&d.quantity)) ")"
        } @else { "nothing gated" }
    }
}

fn relative_band(row: &Discrepancy) -> String {
    let band = row.uncertainty.map(|u| 100.0 * u / row.reference.abs()).filter(|u| u.is_finite());
    band.map_or_else(String::new, |band| format!("; 95 % band of the reference ±{} %", significant(band, 2)))
}

fn scene_link<Q: Quantities>(comparison: &SceneComparison<Q>) -> Markup {
    html! { a href=(format!("{}.html", comparison.scene)) { (comparison.scene) } }
}

fn index_rows<Q: Quantities>(comparison: &SceneComparison<Q>) -> Markup {
    html! {
        @for model in &comparison.models { (index_row(comparison, model)) }
        @if comparison.models.is_empty() {
            tr {
                th scope="row" { (scene_link(comparison)) } td.left { "–" }
                td.left { (badge(comparison.verdict)) }
            }
        }
    }
}

fn index_row<Q: Quantities>(comparison: &SceneComparison<Q>, model: &ModelComparison<Q>) -> Markup {
    let efficiency = |quantities: &Q| quantities.value("efficiency");
    let plain = prefixed("1", 1.0);
    let largest = model.largest();
    let tightest = model.tightest();
    html! {
        tr data-scene=(comparison.scene) data-model=(model.model) {
            th scope="row" { (scene_link(comparison)) }
            td.left { (model_name(&model.model, model.summary.modes)) }
            td.left { (shown(model.shown())) }
            (number("reduced", efficiency(&model.summary.quantities), plain, 4))
            (number("reference", efficiency(&comparison.reference.quantities), plain, 4))
            td.left { @if let Some(d) = largest { (words(&d.quantity)) " " (percent(d.relative)) } @else { "–" } }
            @match largest.and_then(|d| d.uncertainty.map(|u| (d, u))) {
                Some((d, u)) => { (number("uncertainty", Some(u), prefixed(&d.unit, d.reference), 2)) }
                None => { td { "–" } }
            }
            td.left { @if let Some(d) = tightest { (words(&d.quantity)) } @else { "–" } }
            td { @if let Some(used) = tightest.and_then(Discrepancy::used) { (significant(100.0 * used, 2)) " %" } @else { "–" } }
        }
    }
}
