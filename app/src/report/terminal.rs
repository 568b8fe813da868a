//! A short table for the terminal.

use crate::comparison::{ModelComparison, SceneComparison, Verdict};
use crate::format::significant;
use crate::measured::Measured;
use crate::report::conclusion::{HOLD, assumptions, conclusion, summaries};
use crate::report::page::section::{measured, validation};
use crate::report::summary_column::SummaryColumn;
use crate::report::{Report, kinds, row_in_words};
use crate::result::{Limit, Outcome, Summary};
use crate::scene::Scene;
use crate::uncertainty::validation::COVERAGE;
use anstyle::{AnsiColor, Style};

/// Styles; whoever prints takes them away where they can't be seen.
const YELLOW: Style = AnsiColor::Yellow.on_default();
const GREEN: Style = AnsiColor::Green.on_default().bold();
const RED: Style = AnsiColor::Red.on_default().bold();

/// A verdict in its colour, in these words.
pub(crate) fn coloured(verdict: Verdict, words: &str) -> String {
    let style = match verdict {
        Verdict::Pass => GREEN,
        Verdict::Fail => RED,
        Verdict::NotGated | Verdict::Undecided => YELLOW,
    };
    format!("{style}{words}{style:#}")
}

/// A scene's line: the verdict on its tolerances, and whether the assumptions hold.
pub(crate) fn headline(comparison: &SceneComparison) -> String {
    let verdict = coloured(comparison.verdict, comparison.verdict.words());
    let assumptions = assumptions(comparison).map_or(String::new(), |words| {
        let style = if words == HOLD { Style::new() } else { YELLOW };
        format!(", {style}{words}{style:#}")
    });
    format!("{}: {verdict}{assumptions}\n", comparison.scene)
}

/// A model's verdict.
pub(crate) fn of_model(model: &ModelComparison) -> String {
    coloured(model.verdict, model.verdict_in_words())
}

/// Warnings, what failed and what is undecided; then how many did.
pub(crate) fn findings(comparison: &SceneComparison) -> String {
    let mut text = String::new();
    let mut line = |of: &str, what: String| text += &wrapped(&format!("{of}: {what}"));
    let warning = format!("{YELLOW}warning{YELLOW:#}");
    for shared in shared_warnings(comparison) {
        line(&warning, shared);
    }
    for check in comparison.integrity.iter().filter(|c| c.verdict.failed()) {
        line("reference", check.to_string());
    }
    for (record, effect) in comparison.measured.iter().flat_map(measured::effects) {
        line(&format!("{warning}: {record}"), effect.to_owned());
    }
    for model in &comparison.models {
        for row in model.discrepancies.iter().filter(|d| d.is_reported()) {
            line(&model.model, row_in_words(row));
        }
        for check in model.integrity.iter().filter(|c| c.verdict.failed()) {
            line(&model.model, check.to_string());
        }
    }
    let gated = comparison.gated_verdicts().count();
    for (verdict, what) in [(Verdict::Fail, "outside its tolerance"), (Verdict::Undecided, "undecided")] {
        let count = comparison.gated_verdicts().filter(|v| *v == verdict).count();
        if count > 0 {
            text += &format!("  {what}: {count} of {gated} quantities with a tolerance\n");
        }
    }
    text
}

/// How wide a table may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// 80 columns: of the models, how far they are from the reference.
    Narrow,
    /// As wide as it gets: of the models, the values also.
    Wide,
}

/// Per scene: verdict, conclusion, a table of reference and models, and what is to be known about them.
pub fn terminal(report: &Report, width: Width) -> String {
    let mut text = String::new();
    for scene in &report.scenes {
        let comparison = &scene.comparison;
        let columns = kinds::of(scene.scene).columns();
        text += &headline(comparison);
        text += &wrapped(&conclusion(columns, comparison));
        text += &rows(columns, comparison, width).text();
        if let Some(measured) = &comparison.measured {
            text += &wrapped(&measured::sentence(measured));
            text += &measured_table(measured);
        }
        text += &findings(comparison);
        text += &validation::validation_text(comparison);
        text.push('\n');
    }
    text
}

/// The rows of a comparison.
fn rows(columns: &[SummaryColumn], comparison: &SceneComparison, width: Width) -> TextTable {
    let reference = &comparison.reference;
    let mut table = TextTable::headed(columns);
    table.row("reference", cells(columns, reference, None, width), String::new());
    let bands = columns.iter().map(|column| reference.band(column.quantity));
    if bands.clone().any(|band| band.is_some()) {
        let cell = |(column, band): (&SummaryColumn, Option<f64>)| {
            band.map_or("–".to_owned(), |band| format!("±{}", column.uncertainty(reference, band)))
        };
        table.row("  (95 %)", columns.iter().zip(bands).map(cell).collect(), String::new());
    }
    for model in &comparison.models {
        table.row(&model.model, cells(columns, &model.summary, Some(reference), width), of_model(model));
    }
    if let Some(check) = &comparison.reference_check {
        let words = check.words().to_owned();
        table.row(&check.program, cells(columns, &check.summary, Some(reference), width), words);
    }
    table
}

/// The table of reduced models that have no reference; nothing if there are none.
pub fn alone(scene: &Scene, outcomes: &[Outcome]) -> String {
    if outcomes.is_empty() {
        return String::new();
    }
    let columns = kinds::of(scene).columns();
    let mut table = TextTable::headed(columns);
    for Outcome { summary, .. } in outcomes {
        let model = summary.model.as_deref().unwrap_or_default();
        table.row(model, cells(columns, summary, None, Width::Narrow), String::new());
    }
    format!("{}: reduced models without a reference\n{}", scene.name, table.text())
}

/// What a measurement shows of models that have no reference: warnings, efficiencies, and what their differences show.
pub fn measured_alone(found: &Measured) -> String {
    let warnings = measured::effects(found)
        .map(|(record, effect)| wrapped(&format!("{YELLOW}warning{YELLOW:#}: {record}: {effect}")));
    warnings.collect::<String>() + &wrapped(&measured::sentence(found)) + &measured_table(found)
}

/// Of each result the error of its efficiency, or restitution, against the measured one, that error's 95 % band, and what it shows.
fn measured_table(found: &Measured) -> String {
    let points = |value: f64| significant(100.0 * value, 2);
    let mut table = TextTable { rows: Vec::new() };
    let headings =
        [&*format!("{}, %", measured::key_in_words(found)), "E, points", "95 %"].map(str::to_owned);
    table.row("against measured", headings.into(), String::new());
    for comparator in &found.partners {
        let Some((value, difference)) = comparator.key().zip(comparator.key_difference()) else { continue };
        let of = comparator.validation.as_ref();
        let band = of.map_or("–".to_owned(), |of| format!("±{}", points(COVERAGE * of.u_val)));
        let shows = of.map_or(String::new(), |of| of.verdict.words().to_owned());
        let cells = vec![significant(100.0 * value, 4), points(difference), band];
        table.row(&comparator.partner, cells, shows);
    }
    if table.rows.len() > 1 { table.text() } else { String::new() }
}

/// What `summary` gives in the columns; next to `reference` how far it is from it.
fn cells(
    columns: &[SummaryColumn],
    summary: &Summary,
    reference: Option<&Summary>,
    width: Width,
) -> Vec<String> {
    let cell = |column: &SummaryColumn| {
        let Some(cell) = column.cell(summary, reference) else { return "–".to_owned() };
        match (cell.off_in_words, width) {
            (Some(off), Width::Narrow) => off,
            (Some(off), Width::Wide) => format!("{} ({off})", cell.value),
            (None, _) => cell.value,
        }
    };
    columns.iter().map(cell).collect()
}

/// A table in which every column is as wide as its widest cell.
struct TextTable {
    /// Name, cells, remark.
    rows: Vec<(String, Vec<String>, String)>,
}

impl TextTable {
    /// With headings in two lines.
    fn headed(columns: &[SummaryColumn]) -> Self {
        let mut before = "";
        let heading = |column: &SummaryColumn| {
            let same = std::mem::replace(&mut before, column.heading) == column.heading;
            if same { String::new() } else { column.heading.to_owned() }
        };
        let headings = columns.iter().map(heading).collect();
        let places = columns.iter().map(|column| column.place.to_owned()).collect();
        Self { rows: vec![(String::new(), headings, String::new()), (String::new(), places, String::new())] }
    }

    fn row(&mut self, name: &str, cells: Vec<String>, remark: String) {
        self.rows.push((name.to_owned(), cells, remark));
    }

    fn text(&self) -> String {
        let length = |text: &str| text.chars().count();
        let names = self.rows.iter().map(|(name, ..)| length(name)).max().unwrap_or(0);
        let columns = self.rows.first().map_or(0, |(_, cells, _)| cells.len());
        let width = |k: usize| self.rows.iter().map(|(_, cells, _)| length(&cells[k])).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns).map(width).collect();
        let mut text = String::new();
        for (name, cells, remark) in &self.rows {
            let cells: String =
                cells.iter().zip(&widths).map(|(cell, width)| format!("  {cell:>width$}")).collect();
            text += format!("  {name:<names$}{cells}  {remark}").trim_end();
            text.push('\n');
        }
        text
    }
}

/// A paragraph, indented, in lines of at most 80 columns.
fn wrapped(text: &str) -> String {
    if text.is_empty() {
        return String::new();
    }
    let options = textwrap::Options::new(80).initial_indent("  ").subsequent_indent("    ");
    textwrap::fill(text, options) + "\n"
}

/// The warnings of reference and models: a limit that several exceed is one warning with their values, then those of one result each.
fn shared_warnings(comparison: &SceneComparison) -> Vec<String> {
    let mut limits: Vec<(&Limit, Vec<(&str, f64)>)> = Vec::new();
    let mut own = Vec::new();
    for (name, summary) in summaries(comparison) {
        let sentences: Vec<String> = summary.limits.iter().filter_map(Limit::warning).collect();
        for limit in summary.limits.iter().filter(|limit| limit.is_exceeded()) {
            match limits.iter_mut().find(|(first, _)| first.measure == limit.measure) {
                Some((_, values)) => values.push((name, limit.value)),
                None => limits.push((limit, vec![(name, limit.value)])),
            }
        }
        let others = summary.warnings.iter().filter(|warning| !sentences.contains(warning));
        own.extend(others.map(|warning| format!("{name}: {warning}")));
    }
    let of_all = limits.into_iter().filter_map(|(limit, values)| {
        let [first, others @ ..] = &values[..] else { return None };
        let others = others.iter().map(|(name, value)| format!("{name} {}", significant(*value, 2)));
        let others: Vec<String> = others.collect();
        let sentence = limit.warning()?;
        Some(match others.is_empty() {
            true => format!("{}: {sentence}", first.0),
            false => format!("{sentence} ({}; {})", first.0, others.join(", ")),
        })
    });
    of_all.chain(own).collect()
}
