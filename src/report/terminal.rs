//! A short table for the terminal.

use super::Report;
use super::format::{percent, prefixed, with_unit};
use crate::comparison::{ModelComparison, SceneComparison, Verdict};
use crate::result::{PlateQuantities, Quantities};
use anstyle::{AnsiColor, Style};

/// Styles; whoever prints takes them away where they can't be seen.
const YELLOW: Style = AnsiColor::Yellow.on_default();
const GREEN: Style = AnsiColor::Green.on_default().bold();
const RED: Style = AnsiColor::Red.on_default().bold();

/// A verdict in its colour, in these words.
pub(super) fn coloured(verdict: Verdict, words: &str) -> String {
    let style = match verdict {
        Verdict::Pass => GREEN,
        Verdict::Fail => RED,
        Verdict::NotGated | Verdict::Undecided => YELLOW,
    };
    format!("{style}{words}{style:#}")
}

/// A scene's line.
pub(super) fn headline<Q: Quantities>(comparison: &SceneComparison<Q>) -> String {
    let verdict = comparison.verdict;
    format!("{}: {}\n", comparison.scene, coloured(verdict, verdict.words()))
}

/// A model's verdict.
pub(super) fn of_model<Q: Quantities>(model: &ModelComparison<Q>) -> String {
    coloured(model.verdict, model.verdict_in_words())
}

/// One per line: warnings, what failed and what is undecided; then how many did.
pub(super) fn findings<Q: Quantities>(comparison: &SceneComparison<Q>) -> String {
    let mut text = String::new();
    let mut line = |of: &str, what: String| text += &format!("  {of}: {what}\n");
    for check in comparison.integrity.iter().filter(|c| c.verdict.failed()) {
        line("reference", super::junit::integrity_failure(check));
    }
    for model in &comparison.models {
        for warning in &model.summary.warnings {
            line(&format!("{YELLOW}warning{YELLOW:#}"), warning.clone());
        }
        for row in model.discrepancies.iter().filter(|d| d.is_told()) {
            line(&model.model, super::junit::told(row));
        }
        for check in model.integrity.iter().filter(|c| c.verdict.failed()) {
            line(&model.model, super::junit::integrity_failure(check));
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

/// The columns: heading, quantity, unit.
const COLUMNS: [(&str, &str, &str); 5] = [
    ("efficiency", "efficiency", "1"),
    ("outer peak", "outer_force_peak", "N"),
    ("inner peak", "inner_force_peak", "N"),
    ("outer end", "outer_contact_end", "s"),
    ("inner end", "inner_contact_end", "s"),
];

/// Per scene a line for the reference and one per model: values, how far they are from the
/// reference, verdict; then, one per line, what failed.
pub fn terminal(report: &Report) -> String {
    let mut text = String::new();
    for scene in &report.scenes {
        let comparison = &scene.comparison;
        let reference = &comparison.reference.quantities;
        text += &headline(comparison);
        let headings: String = COLUMNS.iter().map(|(heading, ..)| format!("{heading:>22}")).collect();
        text += &format!("  {:<10}{headings}  verdict\n", "");
        text += &format!("  {:<10}{}\n", "reference", cells(reference, None));
        for model in &comparison.models {
            let row = cells(&model.summary.quantities, Some(reference));
            text += &format!("  {:<10}{row}  {}\n", model.model, of_model(model));
        }
        if let Some(measured) = &comparison.measured {
            text += &format!("  {}\n", super::measured_section::sentence(measured));
        }
        text += &findings(comparison);
        text.push('\n');
    }
    for seat in &report.seats {
        text += &super::seal_seat::terminal(seat);
    }
    text
}

fn cells(quantities: &PlateQuantities, reference: Option<&PlateQuantities>) -> String {
    let cell = |(_, quantity, unit): &(&str, &str, &str)| {
        let value = |q: &PlateQuantities| q.get(quantity).unwrap_or(f64::NAN);
        let own = value(quantities);
        let shown = with_unit(own, prefixed(unit, own), 4);
        let relative = reference.map(value).filter(|m| *m != 0.0).map(|m| (own - m) / m.abs());
        let relative = relative.map_or(String::new(), |r| format!(" ({})", percent(Some(r))));
        format!("{:>22}", shown + &relative)
    };
    COLUMNS.iter().map(cell).collect()
}
