//! The page of `diff`: what moved between two comparisons, the largest move first.

use crate::comparison::{Moved, MovedVerdict, Moves};
use crate::format::{percent, prefixed, with_unit, words};
use crate::plot::colours::look;
use crate::plot::symmetric_log::SymmetricLog;
use crate::report::page::discrepancy_picture::{at, bar, mark, scale};
use crate::report::page::html::{page, scrolled};
use crate::report::page::index;
use crate::report::trust::size_class;
use maud::{Markup, PreEscaped, html};

/// Moves that are shown; the document has them all.
const SHOWN: usize = 500;
/// Height of a row's picture, px.
const HEIGHT: f64 = 20.0;

/// The page of `moves` between the comparisons that are called `names`, of what moved by more than the share `above`.
pub fn moves_page(names: [&str; 2], moves: &Moves, above: f64) -> String {
    let size = |row: &Moved| row.relative.map_or(f64::INFINITY, f64::abs);
    let mut rows: Vec<&Moved> = moves.moved.iter().collect();
    rows.sort_by(|a, b| size(b).total_cmp(&size(a)));
    // what is small by itself moves by much and means little
    let (distances, rows): (Vec<&Moved>, Vec<&Moved>) = rows.into_iter().partition(|row| is_distance(row));
    let title = format!("{} of {} and {}", in_words(moves), names[0], names[1]);
    let body = html! {
        h1 { "What changed" }
        p { "A: " code { (names[0]) } ", B: " code { (names[1]) } ". " (in_words(moves)) "." }
        @if above > 0.0 { p.soft { "Moves of up to " (percent(Some(above)).trim_start_matches('+')) " are omitted." } }
        @if !moves.verdicts.is_empty() { h2 { "Verdicts" } (scrolled("Verdicts", &verdicts(&moves.verdicts))) }
        @if !rows.is_empty() {
            h2 { "Numbers" }
            p #search hidden { label { "Search " input type="search" autocomplete="off"; } " " output role="status" {} }
            (numbers("verdicts", &rows))
        }
        @if !distances.is_empty() {
            h2 { "Distances of curves, and residuals" }
            details { summary { (distances.len()) " changed: models against the reference, and conservation" } (numbers("distances", &distances)) }
        }
        @if !moves.moved.is_empty() {
            p.soft.note {
                "B minus A over A, in %, on an axis that is logarithmic beyond its middle. Grey: the uncertainty (95 %) of the reference; what changed less "
                "than that is no more than the mesh leaves open."
            }
        }
    };
    let script =
        html! { @if !rows.is_empty() { script type="text/javascript" { (PreEscaped(index::SCRIPT)) } } };
    page(&title, &[], &body, &script)
}

/// How much moved, in a sentence.
fn in_words(moves: &Moves) -> String {
    let count = |number: usize, what: &str| format!("{number} {what}{}", if number == 1 { "" } else { "s" });
    match (moves.moved.len(), moves.verdicts.len()) {
        (0, 0) => "Nothing changed".into(),
        (numbers, 0) => format!("{} changed, no verdict", count(numbers, "number")),
        (numbers, verdicts) => {
            format!("{} and {} changed", count(numbers, "number"), count(verdicts, "verdict"))
        }
    }
}

fn verdicts(moved: &[MovedVerdict]) -> Markup {
    let shown =
        |verdict: &Option<String>| verdict.as_deref().map_or("absent".to_owned(), |v| v.replace('_', " "));
    html! { table {
        thead { tr { @for heading in ["scene", "model", "A", "B"] { th.left scope="col" { (heading) } } } }
        tbody { @for row in moved { tr {
            th scope="row" { (row.scene) } td.left { (row.model) } td.left { (shown(&row.a)) } td.left { (shown(&row.b)) }
        } } }
    } }
}

/// Whether it is the size of a difference rather than of something.
fn is_distance(row: &Moved) -> bool {
    ["_rms", "_max", "_residual"].iter().any(|ending| row.quantity.ends_with(ending))
}

/// The first of `rows` in a table of its own `class`, which its grid is called by.
fn numbers(class: &str, rows: &[&Moved]) -> Markup {
    let (shown, omitted) = rows.split_at(rows.len().min(SHOWN));
    html! {
        (scrolled("Numbers", &table(class, shown)))
        @if !omitted.is_empty() { p.soft.note { (omitted.len()) " smaller moves are not shown: " code { "--json" } " has them." } }
    }
}

fn table(class: &str, rows: &[&Moved]) -> Markup {
    let sizes = rows.iter().flat_map(|row| [row.relative, row.relative_band()]).flatten();
    let axis = SymmetricLog::over(sizes, true);
    let headings = [
        ("scene", true),
        ("model", true),
        ("quantity", true),
        ("A", false),
        ("B", false),
        ("moved", false),
        ("band", false),
    ];
    html! { table.moves.(class) data-linear=(axis.linear) data-limit=(axis.limit) {
        thead { tr {
            @for (heading, is_left) in headings { th.sorts.left[is_left] scope="col" { (heading) } }
            th.picture.left scope="col" { (scale(&axis, &format!("grid-{class}"))) }
        } }
        tbody { @for row in rows { (number_row(row, &axis, class)) } }
    } }
}

fn number_row(row: &Moved, axis: &SymmetricLog, class: &str) -> Markup {
    let size = [row.a, row.b].into_iter().flatten().map(f64::abs).fold(0.0, f64::max);
    let value = |value: Option<f64>| {
        value.map_or("absent".into(), |value| with_unit(value, prefixed(&row.unit, size), 5))
    };
    let band = row.relative_band();
    html! {
        tr {
            th.left scope="row" { (row.scene) }
            td.left { (row.model) } td.left { (words(&row.quantity)) }
            td data-si=[row.a] { (value(row.a)) } td data-si=[row.b] { (value(row.b)) }
            td data-sort=[row.relative.map(f64::abs)] {
                span class=(row.relative.map_or("off".into(), |share| format!("off {}", size_class(share)))) { (percent(row.relative)) }
            }
            td data-sort=[band] { @match band { Some(band) => { "±" (percent(Some(band)).trim_start_matches('+')) }, None => "–" } }
            td { svg height=(HEIGHT) width="100%" aria-hidden="true" {
                @if let Some(band) = band { (bar("fig-band", axis, [-band, band], (1.0, "100%"))) }
                use href=(format!("#grid-{class}")) {}
                @if let Some(share) = row.relative {
                    svg x=(at(axis, share)) y=(0.5 * HEIGHT) overflow="visible" data-si=(share) { @let look = look(&row.model, []); (mark(look.shape, look.class)) }
                }
            } }
        }
    }
}
