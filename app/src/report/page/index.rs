//! The page of all scenes: a row per scene and model, by folder, which sorts and can be searched.

use crate::comparison::{AMONG, Verdict};
use crate::error::Result;
use crate::format::{percent, prefixed, significant, words};
use crate::plot::colours::look;
use crate::report::Report;
use crate::report::existing::{self, ExistingScene, Folder};
use crate::report::export::Export;
use crate::report::figure::{course, thumbnail};
use crate::report::overview::{ModelOverview, Overview, RowOverview};
use crate::report::page::coverage;
use crate::report::page::html::{
    EFFICIENCY, assumptions_badge, badge, named, number, page, scrolled, worded,
};
use crate::report::page::live;
use crate::report::page::validated_map::ValidatedMap;
use crate::report::run_times::marked;
use crate::report::trust::size_class;
use maud::{Markup, PreEscaped, html};

/// Sorting and searching; without it the table is what it is.
pub(crate) const SCRIPT: &str = include_str!("assets/index.js");

/// The page of all scenes of a folder.
pub(crate) struct Index;

impl Export<Folder<'_>> for Index {
    fn ending(&self) -> &'static str {
        "html"
    }

    fn bytes(&self, folder: &Folder) -> Result<Vec<u8>> {
        Ok(index_of(folder.report, folder.scenes).into_bytes())
    }
}

/// The page with the verdict of every scene and model.
pub fn index_page(report: &Report) -> String {
    index_of(report, &existing::of_run(report))
}

/// The index of all scenes whose results stand in a folder.
pub(crate) fn index_of(report: &Report, scenes: &[ExistingScene]) -> String {
    let body = html! {
        h1 { "impactcheck " (badge(existing::verdict(scenes))) }
        p.soft { "Reduced models of an impact against explicit finite elements. " (counts(scenes)) }
        @if let Some(map) = ValidatedMap::of(report.validated(), None) {
            details { summary { "Where models were compared with references" } (map.html()) }
        }
        (contents(scenes))
        p #search hidden { label { "Search " input type="search" autocomplete="off"; } " " output role="status" {} }
        (scrolled("Scenes", &table(scenes)))
        p.soft.note { "Curves: the first contact force, the reference in black under the models. Largest difference: shaded by size, whatever the "
            "verdict. Tolerance used: largest share of a tolerance that a quantity uses; where the reference's 95 % "
            "uncertainty contains the bound the verdict is undecided, and the scene's page shows how to decide it. Trend: numbers that "
            "drift over the commits recorded, and the course of the one that has come furthest within its tolerance." }
        p.soft.note { (EFFICIENCY) } p.soft.note { (AMONG) }
        @if report.coverage().is_some() {
            p { a href=(coverage::FILE) { "Coverage" } ": which features of scenes were compared with what, and how far models differ there." }
        }
        @if report.scenes.iter().any(|scene| scene.attachments.live.is_some()) {
            p { a href=(live::FILE) { "Live page" } ": change numbers of a scene and see what the models give." }
        }
        p { "As data: " a href="comparison.json" { "JSON" } " · " a href="comparison.md" { "Markdown" } " · "
            a href="junit.xml" { "JUnit" } }
    };
    page("impactcheck", &[], &body, &html! { script type="text/javascript" { (PreEscaped(SCRIPT)) } })
}

/// How much was gated and what came of it, in a sentence.
fn counts(scenes: &[ExistingScene]) -> String {
    let models = scenes.iter().flat_map(|scene| &scene.overview.models);
    let verdicts: Vec<Verdict> = models.flat_map(|model| model.gated.iter().copied()).collect();
    if verdicts.is_empty() {
        return "Nothing is gated: no scene has tolerances.".into();
    }
    let count = |verdict: Verdict| verdicts.iter().filter(|v| **v == verdict).count();
    let [pass, undecided, fail] = [Verdict::Pass, Verdict::Undecided, Verdict::Fail].map(count);
    let found = if pass == verdicts.len() {
        "all within it".to_owned()
    } else {
        format!("{pass} within it, {undecided} undecided, {fail} not within it")
    };
    let plural = if scenes.len() == 1 { "" } else { "s" };
    format!("{} scene{plural}, {} quantities with a tolerance: {found}.", scenes.len(), verdicts.len())
}

const HEADINGS: [(&str, bool); 8] = [
    ("scene", true),
    ("model", true),
    ("verdict", true),
    ("largest difference", false),
    ("uncertainty (95 %)", false),
    ("tolerance used", false),
    ("efficiency", false),
    ("trend", false),
];

/// The folders in the order in which the scenes name them.
fn folders(scenes: &[ExistingScene]) -> Vec<&str> {
    let mut folders: Vec<&str> = Vec::new();
    for scene in scenes {
        if !folders.contains(&&*scene.overview.folder) {
            folders.push(&scene.overview.folder);
        }
    }
    folders
}

fn of_folder<'s>(scenes: &'s [ExistingScene], folder: &str) -> impl Iterator<Item = &'s ExistingScene> {
    scenes.iter().filter(move |scene| scene.overview.folder == folder)
}

/// Links to the folders, with the worst verdict in each.
fn contents(scenes: &[ExistingScene]) -> Markup {
    let folders = folders(scenes);
    html! {
        @if folders.len() > 1 {
            nav.contents aria-label="Folders" { ul { @for (k, folder) in folders.iter().enumerate() { li {
                a href=(format!("#folder-{k}")) { (title(folder)) } " (" (of_folder(scenes, folder).count()) ") "
                (badge(Verdict::worst(of_folder(scenes, folder).map(|scene| scene.overview.verdict))))
            } } } }
        }
    }
}

fn title(folder: &str) -> &str {
    if folder.is_empty() { "–" } else { folder }
}

fn table(scenes: &[ExistingScene]) -> Markup {
    let folders = folders(scenes);
    html! { table.verdicts {
        thead { tr {
            th.left scope="col" { "curves" }
            @for (heading, is_left) in HEADINGS { th.sorts.left[is_left] scope="col" { (named(heading)) } }
            th.left scope="col" { "compared" }
        } }
        @for (k, folder) in folders.iter().enumerate() {
            tbody id=(format!("folder-{k}")) {
                @if folders.len() > 1 { tr.folder { th.left scope="colgroup" colspan="10" { (title(folder)) } } }
                @for scene in of_folder(scenes, folder) { (scene_rows(scene)) }
            }
        }
    } }
}

fn scene_rows(scene: &ExistingScene) -> Markup {
    let overview = &scene.overview;
    html! {
        @if !overview.conclusion.is_empty() {
            tr.conclusion { td.left colspan="10" {
                strong { (link(overview)) } ": " (overview.conclusion)
                @if let Some(words) = &overview.assumptions { " " (assumptions_badge(words)) }
            } }
        }
        @for model in &overview.models { (row(scene, model)) }
        @if overview.models.is_empty() {
            tr { td {} th.left scope="row" { (link(overview)) } td.left { "–" } td.left { (badge(overview.verdict)) } td colspan="6" {} }
        }
    }
}

fn link(overview: &Overview) -> Markup {
    html! { a href=(format!("{}.html", overview.scene)) title=(overview.description) { (overview.scene) } }
}

/// A row; cells sort by `data-sort` where it is not their text that counts.
fn row(scene: &ExistingScene, model: &ModelOverview) -> Markup {
    let overview = &scene.overview;
    let [own, _] = model.efficiency;
    let severity = [Verdict::NotGated, Verdict::Pass, Verdict::Undecided, Verdict::Fail];
    let severity = severity.iter().position(|v| *v == model.verdict);
    let size = model.largest.as_ref().and_then(|d| d.relative).map(f64::abs);
    let used = model.tightest.as_ref().and_then(|d| Some((d, d.used?)));
    let [drifting, recorded] = overview.drift;
    html! {
        tr data-scene=(overview.scene) data-model=(model.model) {
            td.left { (thumbnail::drawn(&model.thumbnail, look(&model.model, overview.models.iter().map(|m| &*m.model)))) }
            th.left scope="row" { (link(overview)) }
            td.left title=(model.name) { (model.model) }
            td.left data-sort=[severity] { (worded(model.verdict, &model.verdict_in_words)) }
            td data-sort=[size] {
                @match &model.largest {
                    Some(d) => { (words(&d.quantity)) " " span class=(format!("off {}", size_class(d.relative.unwrap_or(f64::NAN)))) { (percent(d.relative)) } },
                    None => "–",
                }
            }
            td data-sort=[model.largest.as_ref().and_then(relative_band)] {
                @match model.largest.as_ref().and_then(relative_band) { Some(band) => { "±" (significant(100.0 * band, 2)) " %" }, None => "–" }
            }
            td data-sort=[used.map(|(_, used)| used)] {
                @match used { Some((d, used)) => { (significant(100.0 * used, 2)) " % " span.soft { (words(&d.quantity)) } }, None => "–" }
            }
            (number("reduced", own, prefixed("1", 1.0), 4))
            td data-sort=(drifting) {
                @if recorded > 0 { (drifting) " of " (recorded) } @else { "–" }
                @if let Some(course) = &overview.course { (course::drawn(course)) }
            }
            td.left.soft { (marked(&scene.date())) }
        }
    }
}

/// The reference's band over its value.
fn relative_band(row: &RowOverview) -> Option<f64> {
    row.uncertainty.zip(row.reference).map(|(u, m)| u / m.abs()).filter(|u| u.is_finite())
}
