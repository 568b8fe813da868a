//! A short table for the terminal.

use super::Report;
use super::format::{percent, prefixed, with_unit};
use crate::comparison::{Shown, Verdict};
use crate::result::PlateQuantities;
use anstyle::{AnsiColor, Style};

/// Styles; whoever prints takes them away where they can't be seen.
const YELLOW: Style = AnsiColor::Yellow.on_default();
const GREEN: Style = AnsiColor::Green.on_default().bold();
const RED: Style = AnsiColor::Red.on_default().bold();

/// A verdict in its colour.
pub(super) fn coloured(verdict: Verdict) -> String {
    let style = if verdict.passed() { GREEN } else { RED };
    format!("{style}{verdict}{style:#}")
}

/// A verdict as people are told it, in its colour.
pub(super) fn told(shown: Shown) -> String {
    let style = match shown {
        Shown::Pass | Shown::PassAboutBias => GREEN,
        Shown::Fail => RED,
        Shown::NotGated => YELLOW,
    };
    format!("{style}{}{style:#}", shown.words())
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
        text += &format!("{}: {}\n", comparison.scene, told(comparison.shown()));
        let headings: String = COLUMNS.iter().map(|(heading, ..)| format!("{heading:>22}")).collect();
        text += &format!("  {:<10}{headings}  verdict\n", "");
        text += &format!("  {:<10}{}\n", "reference", cells(reference, None));
        for model in &comparison.models {
            let row = cells(&model.summary.quantities, Some(reference));
            text += &format!("  {:<10}{row}  {}\n", model.model, told(model.shown()));
        }
        if let Some(measured) = &comparison.measured {
            text += &format!("  {}\n", super::measured_section::sentence(measured));
        }
        for check in comparison.integrity.iter().filter(|c| !c.verdict.passed()) {
            text += &format!("  reference: {}\n", super::junit::integrity_failure(check));
        }
        for model in &comparison.models {
            for warning in &model.summary.warnings {
                text += &format!("  {YELLOW}warning:{YELLOW:#} {warning}\n");
            }
            for row in model.discrepancies.iter().filter(|d| !d.verdict.passed()) {
                text += &format!("  {}: {}\n", model.model, super::junit::failure(row));
            }
            for check in model.integrity.iter().filter(|c| !c.verdict.passed()) {
                text += &format!("  {}: {}\n", model.model, super::junit::integrity_failure(check));
            }
        }
        text += &failed(comparison.gated_and_failed());
        text.push('\n');
    }
    for seat in &report.seats {
        text += &super::seal_seat::terminal(seat);
    }
    text
}

/// How many gated quantities failed, if any did.
pub(super) fn failed((gated, failed): (usize, usize)) -> String {
    if failed == 0 { String::new() } else { format!("  {failed} of {gated} gated quantities failed\n") }
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
