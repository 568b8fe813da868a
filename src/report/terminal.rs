//! A short table for the terminal.

use crate::comparison::{ModelComparison, SceneComparison, Verdict};
use crate::report::page::section::{measured, validation};
use crate::report::summary_column::SummaryColumn;
use crate::report::{Report, check_failure, kinds, row_told};
use crate::result::{Outcome, Summary};
use crate::scene::Scene;
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

/// A scene's line.
pub(crate) fn headline(comparison: &SceneComparison) -> String {
    let verdict = comparison.verdict;
    format!("{}: {}\n", comparison.scene, coloured(verdict, verdict.words()))
}

/// A model's verdict.
pub(crate) fn of_model(model: &ModelComparison) -> String {
    coloured(model.verdict, model.verdict_in_words())
}

/// One per line: warnings, what failed and what is undecided; then how many did.
pub(crate) fn findings(comparison: &SceneComparison) -> String {
    let mut text = String::new();
    let mut line = |of: &str, what: String| text += &format!("  {of}: {what}\n");
    let warning = format!("{YELLOW}warning{YELLOW:#}");
    for of_reference in &comparison.reference.warnings {
        line(&format!("{warning}: reference"), of_reference.clone());
    }
    for check in comparison.integrity.iter().filter(|c| c.verdict.failed()) {
        line("reference", check_failure(check));
    }
    for (record, effect) in comparison.measured.iter().flat_map(measured::effects) {
        line(&format!("{warning}: {record}"), effect.to_owned());
    }
    for model in &comparison.models {
        for of_model in &model.summary.warnings {
            line(&format!("{warning}: {}", model.model), of_model.clone());
        }
        for row in model.discrepancies.iter().filter(|d| d.is_told()) {
            line(&model.model, row_told(row));
        }
        for check in model.integrity.iter().filter(|c| c.verdict.failed()) {
            line(&model.model, check_failure(check));
        }
    }
    let gated = comparison.gated_verdicts().count();
    for (verdict, did) in [(Verdict::Fail, "failed"), (Verdict::Undecided, "are undecided")] {
        let count = comparison.gated_verdicts().filter(|v| *v == verdict).count();
        if count > 0 {
            text += &format!("  {count} of {gated} gated quantities {did}\n");
        }
    }
    text
}

/// Per scene a line for the reference and one per model: values, how far they are from the
/// reference, verdict; then, one per line, what failed.
pub fn terminal(report: &Report) -> String {
    let mut text = String::new();
    for scene in &report.scenes {
        let comparison = &scene.comparison;
        let (reference, columns) = (&comparison.reference, kinds::of(scene.scene).columns());
        text += &headline(comparison);
        text += &format!("{}  verdict\n", headings(columns));
        text += &format!("  {:<10}{}\n", "reference", cells(columns, reference, None));
        for model in &comparison.models {
            let row = cells(columns, &model.summary, Some(reference));
            text += &format!("  {:<10}{row}  {}\n", model.model, of_model(model));
        }
        if let Some(check) = &comparison.reference_check {
            let row = cells(columns, &check.summary, Some(reference));
            text += &format!("  {:<10}{row}  {}\n", check.program, check.words());
        }
        if let Some(measured) = &comparison.measured {
            text += &format!("  {}\n", measured::sentence(measured));
        }
        text += &findings(comparison);
        text += &validation::validation_text(comparison);
        text.push('\n');
    }
    text
}

/// The same table of reduced models alone; nothing if there are none.
pub fn alone(scene: &Scene, outcomes: &[Outcome]) -> String {
    if outcomes.is_empty() {
        return String::new();
    }
    let columns = kinds::of(scene).columns();
    let mut text = format!("{}: reduced models alone\n{}\n", scene.name, headings(columns));
    for Outcome { summary, .. } in outcomes {
        let model = summary.model.as_deref().unwrap_or_default();
        text += &format!("  {model:<10}{}\n", cells(columns, summary, None));
    }
    text
}

fn headings(columns: &[SummaryColumn]) -> String {
    let headings: String = columns.iter().map(|column| format!("{:>22}", column.heading)).collect();
    format!("  {:<10}{headings}", "")
}

fn cells(columns: &[SummaryColumn], summary: &Summary, reference: Option<&Summary>) -> String {
    let cell = |column: &SummaryColumn| {
        let Some(cell) = column.cell(summary, reference) else { return String::new() };
        cell.value + &cell.off_in_words.map_or(String::new(), |off| format!(" ({off})"))
    };
    columns.iter().map(|column| format!("{:>22}", cell(column))).collect()
}
