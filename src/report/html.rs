//! The frame of every page, and `index.html` with the verdicts. Pages are self-contained: style, script and figures are
//! inside, nothing is loaded. Every number carries its SI value in `data-si`.

use super::Report;
use super::format::{Prefixed, percent, prefixed, significant, with_unit, words};
use super::overview::{ModelOverview, Overview, RowOverview};
use super::run_times::marked;
use super::standing::{self, Standing};
use crate::comparison::{AMONG, ModelComparison, Verdict};
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

pub(super) fn badge(verdict: Verdict) -> Markup {
    worded(verdict, verdict.words())
}

/// The verdict of a model, of which it may be known that it is off.
pub(super) fn model_badge(model: &ModelComparison) -> Markup {
    worded(model.verdict, model.verdict_in_words())
}

fn worded(verdict: Verdict, words: &str) -> Markup {
    let class = match verdict {
        // right where it is known to be wrong: no green for that
        Verdict::Pass if words != verdict.words() => "verdict known",
        Verdict::NotGated => "verdict open",
        Verdict::Pass => "verdict pass",
        Verdict::Undecided => "verdict undecided",
        Verdict::Fail => "verdict fail",
    };
    html! { span class=(class) { (words) } }
}

/// Something wider than a phone, which scrolls by itself, also by keyboard.
pub(super) fn scrolled(name: &str, content: &Markup) -> Markup {
    html! { div.scroll role="region" tabindex="0" aria-label=(name) { (content) } }
}

/// What the efficiency is; eq. (1) of the paper.
const EFFICIENCY: &str = "Efficiency, eq. (1): kinetic energy of the body that is struck through the plate or seat (inner body, sphere) after \
    the last contact over that of the striking body (outer body, actuator) before the first, both of the rigid-body \
    (mass-averaged) velocity.";

/// The name of a quantity in words; what it does not tell by itself is told on hover.
pub(super) fn named(quantity: &str) -> Markup {
    match quantity {
        "efficiency" => html! { abbr title=(EFFICIENCY) { (words(quantity)) } },
        _ => html! { (words(quantity)) },
    }
}

/// A heading for a quantity under another name.
pub(super) fn named_as(heading: &str, quantity: &str) -> Markup {
    if words(quantity) == heading {
        named(quantity)
    } else {
        html! { (heading) }
    }
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
    index_of(&standing::of_run(report))
}

/// The index of all scenes whose results stand in a folder.
pub(super) fn index_of(scenes: &[Standing]) -> String {
    let body = html! {
        h1 { "impactcheck " (badge(standing::verdict(scenes))) }
        p.soft { "Reduced models of an impact against explicit finite elements. " (counts(scenes)) }
        div.cards {
            @for scene in scenes { (card(scene)) }
        }
        h2 { "Verdicts" }
        (scrolled("Verdicts", &html! { table.verdicts {
            thead { tr {
                th scope="col" { "scene" } th.left scope="col" { "model" } th.left scope="col" { "verdict" }
                th scope="col" { (named("efficiency")) } th scope="col" { "reference" }
                th.left scope="col" { "largest discrepancy of the summary" } th scope="col" { "95 % band" }
                th.left scope="col" { "nearest to its bound" } th scope="col" { "tolerance used" }
            } }
            tbody {
                @for scene in scenes { (index_rows(&scene.overview)) }
            }
        } }))
        p.soft { (EFFICIENCY) } p.soft { (AMONG) }
        p.soft { "The band is the 95 % band of the reference's own numerical error. Tolerance used: how much of its tolerance "
            "the gated quantity nearest to its bound takes. Where the band reaches across the bound the verdict is undecided; "
            "the scene's page says what would decide it." }
        p { "As data: " a href="comparison.json" { "JSON" } " · " a href="comparison.md" { "Markdown" } " · "
            a href="junit.xml" { "JUnit" } }
    };
    page("impactcheck", &[], &body, &html! {})
}

/// How much was gated and what came of it, in a sentence.
fn counts(scenes: &[Standing]) -> String {
    let models = scenes.iter().flat_map(|scene| &scene.overview.models);
    let verdicts: Vec<Verdict> = models.flat_map(|model| model.gated.iter().copied()).collect();
    if verdicts.is_empty() {
        return "Nothing is gated: no scene has tolerances.".into();
    }
    let count = |verdict| verdicts.iter().filter(|v| **v == verdict).count();
    format!(
        "{} scene{}, {} gated quantities: {} within their tolerances, {} undecided, {} not within.",
        scenes.len(),
        if scenes.len() == 1 { "" } else { "s" },
        verdicts.len(),
        count(Verdict::Pass),
        count(Verdict::Undecided),
        count(Verdict::Fail)
    )
}

/// A scene in short.
fn card(scene: &Standing) -> Markup {
    let overview = &scene.overview;
    let [drifting, recorded] = overview.drift;
    html! {
        section.card {
            h2 { (scene_link(overview)) " " (badge(overview.verdict)) }
            p.soft { (overview.description) }
            ul.models { @for model in &overview.models { li { (model_line(model)) } } }
            @if drifting > 0 { p { strong { "Drift: " } (drifting) " of " (recorded) " numbers recorded over commits." } }
            p.soft { (marked(&scene.when())) }
        }
    }
}

/// Verdict of a model with its largest discrepancy, the band it is to be seen against, and what the gate makes of it.
pub(super) fn model_line(model: &ModelOverview) -> Markup {
    html! {
        (worded(model.verdict, &model.verdict_in_words)) " model " (model.name)
        @if let Some(d) = &model.largest {
            ": largest discrepancy of the summary " strong { (percent(d.relative)) } " (" (words(&d.quantity)) (relative_band(d)) ")"
        }
        "; "
        @if let Some((d, used)) = model.tightest.as_ref().and_then(|d| Some((d, d.used?))) {
            (model.gated.len()) " of " (model.rows) " rows gated, at most " (significant(100.0 * used, 2))
            " % of a tolerance used (" (words(&d.quantity)) ")"
        } @else { "nothing gated" }
    }
}

fn relative_band(row: &RowOverview) -> String {
    let band = row.uncertainty.zip(row.reference).map(|(u, m)| 100.0 * u / m.abs()).filter(|u| u.is_finite());
    band.map_or_else(String::new, |band| format!("; 95 % band of the reference ±{} %", significant(band, 2)))
}

fn scene_link(overview: &Overview) -> Markup {
    html! { a href=(format!("{}.html", overview.scene)) { (overview.scene) } }
}

fn index_rows(overview: &Overview) -> Markup {
    html! {
        @for model in &overview.models { (index_row(overview, model)) }
        @if overview.models.is_empty() {
            tr {
                th scope="row" { (scene_link(overview)) } td.left { "–" }
                td.left { (badge(overview.verdict)) }
            }
        }
    }
}

fn index_row(overview: &Overview, model: &ModelOverview) -> Markup {
    let plain = prefixed("1", 1.0);
    let [own, reference] = model.efficiency;
    html! {
        tr data-scene=(overview.scene) data-model=(model.model) {
            th scope="row" { (scene_link(overview)) }
            td.left { (model.name) }
            td.left { (worded(model.verdict, &model.verdict_in_words)) }
            (number("reduced", own, plain, 4))
            (number("reference", reference, plain, 4))
            td.left { @if let Some(d) = &model.largest { (words(&d.quantity)) " " (percent(d.relative)) } @else { "–" } }
            @match model.largest.as_ref().and_then(|d| d.uncertainty.map(|u| (d, u))) {
                Some((d, u)) => { (number("uncertainty", Some(u), prefixed(&d.unit, d.reference.unwrap_or(u)), 2)) }
                None => { td { "–" } }
            }
            td.left { @if let Some(d) = &model.tightest { (words(&d.quantity)) } @else { "–" } }
            td { @if let Some(used) = model.tightest.as_ref().and_then(|d| d.used) { (significant(100.0 * used, 2)) " %" } @else { "–" } }
        }
    }
}
