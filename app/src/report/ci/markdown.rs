//! The report as Markdown: verdicts, discrepancies and curve metrics as tables.

use crate::comparison::{AMONG, BandVerdict, Check, Discrepancy, ModelComparison};
use crate::error::Result;
use crate::format::{model_name, percent, prefixed, significant, with_unit, words};
use crate::report::existing::{self, ExistingScene, Folder};
use crate::report::export::Export;
use crate::report::overview::{ModelOverview, Overview};
use crate::report::page::section;
use crate::report::page::validated_map::{self, ValidatedMap};
use crate::report::{Report, SceneReport, kinds};
use std::cmp::Reverse;

/// Most characters of the document: comments on GitHub hold 65 536, and what posts it may add a link.
const MOST: usize = 60_000;
/// Most of them for the table of verdicts.
const MOST_ROWS: usize = 25_000;

/// Verdicts and tables of all scenes of a folder.
pub(crate) struct Markdown;

impl Export<Folder<'_>> for Markdown {
    fn ending(&self) -> &'static str {
        "md"
    }

    fn bytes(&self, folder: &Folder) -> Result<Vec<u8>> {
        Ok(of(folder.report, folder.scenes).into_bytes())
    }
}

/// Markdown of the whole report, as far as it fits into a comment on GitHub.
pub fn markdown(report: &Report) -> String {
    of(report, &existing::of_run(report))
}

/// Markdown of all scenes whose results stand in a folder; those that are kept have their tables on their pages. So have
/// those for which there is no room: the scenes with the worst verdicts come first.
pub(crate) fn of(report: &Report, scenes: &[ExistingScene]) -> String {
    let urgency = |scene: &ExistingScene| Reverse(scene.overview.verdict);
    let rows = scenes.iter().map(|scene| {
        let rows = scene.overview.models.iter().map(|model| row(&scene.overview.scene, model));
        (urgency(scene), rows.collect())
    });
    let mut text = format!(
        "# impactcheck: {}\n\n| scene | model | verdict | efficiency | reference | largest discrepancy of the summary |\n|---|---|---|--:|--:|---|\n",
        existing::verdict(scenes)
    );
    let rows = fitted(&rows.collect::<Vec<_>>(), MOST_ROWS);
    text.extend(rows.iter().flatten().map(String::as_str));
    let omitted = rows.iter().filter(|row| row.is_none()).count();
    if omitted > 0 {
        text += &format!(
            "\n{omitted} more scenes, with no worse verdicts, are in `index.html` and `comparison.json`.\n"
        );
    }
    text += &format!("\n{AMONG}\n");
    if ValidatedMap::of(report.validated(), None).is_some() {
        text += &format!("\n![Where models were compared with references]({})\n", validated_map::FILE);
    }
    let room = MOST.saturating_sub(size(&text));
    text + &sections(report, scenes, urgency, room)
}

/// Size of a text in characters.
fn size(text: &str) -> usize {
    text.chars().count()
}

/// A section per scene, with its tables as far as there is room; the scenes of this run first.
fn sections<O: Ord>(
    report: &Report,
    scenes: &[ExistingScene],
    urgency: impl Fn(&ExistingScene) -> O,
    room: usize,
) -> String {
    let of_run = |own: &SceneReport| scenes.iter().find(|s| s.overview.scene == own.comparison.scene);
    let of_run = |own| of_run(own).expect("the scenes of this run are among those of its folder");
    let own = report.scenes.iter().map(|own| (urgency(of_run(own)), brief(of_run(own), "")));
    let earlier = scenes.iter().filter(|scene| scene.is_earlier());
    let earlier = earlier.map(|scene| (urgency(scene), brief(scene, &scene.earlier())));
    let briefs: Vec<(O, String)> = own.chain(earlier).collect();
    let mut chosen = fitted(&briefs, room / 4);
    let mut left = room - chosen.iter().flatten().map(|text| size(text)).sum::<usize>();
    for k in by_urgency(&briefs).filter(|k| *k < report.scenes.len()) {
        let whole = section(&report.scenes[k]);
        let room = left + chosen[k].as_deref().map_or(0, size);
        let Some(rest) = room.checked_sub(size(&whole)) else { break };
        left = rest;
        chosen[k] = Some(whole);
    }
    chosen.into_iter().flatten().collect()
}

/// Places of the pieces, the most urgent first.
fn by_urgency<O: Ord>(pieces: &[(O, String)]) -> impl Iterator<Item = usize> {
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by_key(|k| &pieces[*k].0);
    order.into_iter()
}

/// The pieces in their order, as far as there is room; the most urgent have theirs first.
fn fitted<O: Ord>(pieces: &[(O, String)], room: usize) -> Vec<Option<String>> {
    let (mut left, mut chosen) = (room, vec![None; pieces.len()]);
    for k in by_urgency(pieces) {
        if let Some(rest) = left.checked_sub(size(&pieces[k].1)) {
            left = rest;
            chosen[k] = Some(pieces[k].1.clone());
        }
    }
    chosen
}

/// Verdict of a scene whose tables are on its page, and the command that makes it.
fn brief(scene: &ExistingScene, when: &str) -> String {
    let Overview { scene, verdict, command, .. } = &scene.overview;
    let when = if when.is_empty() { String::new() } else { format!("{when} ") };
    format!(
        "\n## {0}: {verdict}\n\n{when}Its tables are on [its page]({scene}.html).\n\nMade by:\n\n    {command}\n",
        escape(scene)
    )
}

/// A model's row in the table of verdicts.
fn row(scene: &str, model: &ModelOverview) -> String {
    let largest = model.largest.as_ref();
    let largest = largest.map_or("–".into(), |d| format!("{} {}", words(&d.quantity), percent(d.relative)));
    let [own, reference] = model.efficiency.map(|e| significant(e.unwrap_or(f64::NAN), 4));
    let (scene, name, verdict) = (escape(scene), escape(&model.name), &model.verdict_in_words);
    format!("| {scene} | {name} | {verdict} | {own} | {reference} | {largest} |\n")
}

fn section(scene: &SceneReport) -> String {
    let comparison = &scene.comparison;
    let mut text = format!(
        "\n## {}: {}\n\n{}\n",
        escape(&comparison.scene),
        comparison.verdict,
        escape(&scene.scene.description),
    );
    for drawing in kinds::of(scene.scene).drawings(scene) {
        if let Some(caption) = drawing.caption {
            text += &format!("\n![{caption}]({}{}.svg)\n", comparison.scene, drawing.ending);
        }
    }
    for warning in &comparison.reference.warnings {
        text += &format!("\nWarning, reference: {}\n", escape(warning));
    }
    text += &failures("the reference", &comparison.integrity);
    text += &section::budget::budget_markdown(&comparison.budget);
    text += &section::validation::validation_markdown(comparison);
    text += &section::measured::measured_markdown(scene);
    text += &section::reference_check::reference_check_markdown(comparison.reference_check.as_ref());
    for model in &comparison.models {
        text += &model_section(model);
    }
    text += &format!("\nMade by:\n\n    {}\n", scene.command);
    text
}

fn model_section(model: &ModelComparison) -> String {
    let name = escape(&model_name(&model.model, model.summary.modes));
    let mut text = format!(
        "\n### Model {name}: {}\n\n| quantity | reduced | reference | difference | relative | uncertainty (95 %) | \\|E\\| against u | tolerance | bias | verdict |\n|---|--:|--:|--:|--:|--:|---|--:|--:|---|\n",
        model.verdict_in_words()
    );
    for row in &model.discrepancies {
        text += &format!("{}\n", discrepancy(row));
    }
    for (row, how) in model.discrepancies.iter().filter_map(|row| Some((row, row.would_decide.as_ref()?))) {
        text += &format!("\nUndecided, {}: {}\n", words(&row.quantity), escape(how));
    }
    for warning in &model.summary.warnings {
        text += &format!("\nWarning: {}\n", escape(warning));
    }
    text += "\n| curve | Sprague-Geers | Russell | ISO/TS 18571 | corridor | phase | magnitude | slope | grade | window | samples |\n|---|--:|--:|--:|--:|--:|--:|--:|---|--:|--:|\n";
    let score = |value: Option<f64>| value.map_or("–".into(), |v| format!("{v:.3}"));
    for curve in &model.curves {
        text += &format!(
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} to {} | {} |\n",
            words(&curve.quantity),
            score(curve.sprague_geers),
            score(curve.russell),
            score(curve.iso18571),
            score(curve.iso18571_corridor),
            score(curve.iso18571_phase),
            score(curve.iso18571_magnitude),
            score(curve.iso18571_slope),
            curve.grade.map_or("–".into(), |g| g.to_string()),
            significant(curve.window[0] * 1e6, 4),
            with_unit(curve.window[1], prefixed("s", curve.window[1]), 4),
            curve.samples,
        );
    }
    text + &failures(&format!("model {name}"), &model.integrity)
}

fn discrepancy(row: &Discrepancy) -> String {
    let to = prefixed(&row.unit, row.size());
    let show = |value: Option<f64>, digits| value.map_or("–".into(), |v| with_unit(v, to, digits));
    let optional = |value: Option<f64>| show(value, 3);
    format!(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
        words(&row.quantity),
        show(row.reduced, 5),
        show(row.reference, 5),
        show(row.difference, 3),
        percent(row.relative),
        optional(row.uncertainty),
        row.band_verdict.map_or("–", BandVerdict::words),
        optional(row.tolerance),
        optional(row.bias),
        row.verdict,
    )
}

/// What a result contradicts itself in; nothing if it doesn't.
fn failures(of: &str, checks: &[Check]) -> String {
    let failed: Vec<_> = checks.iter().filter(|c| c.verdict.failed()).collect();
    if failed.is_empty() {
        return String::new();
    }
    let mut text = format!("\nThe result of {of} contradicts itself or its scene:\n\n");
    for check in failed {
        text += &format!("- {check}\n");
    }
    text
}

/// Text without what Markdown would take for markup or for a column.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '|' | '*' | '`' | '[' | ']' | '\\' => escaped.extend(['\\', c]),
            '\n' | '\r' => escaped.push(' '),
            _ => escaped.push(c),
        }
    }
    escaped
}
