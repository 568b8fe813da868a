//! Sentences of the program on a page.

use crate::format::with_minus;
use maud::{Markup, html};

/// A sentence made for a terminal as a page shows it: what stands in backticks as code, minus signs as such.
pub(crate) fn prose(sentence: &str) -> Markup {
    let parts = sentence.split('`').enumerate();
    html! {
        @for (k, part) in parts { @if k % 2 == 1 { code { (part) } } @else { (with_minus(part)) } }
    }
}

#[cfg(test)]
mod tests {
    use super::{prose, with_minus};

    #[test]
    fn sentences_for_terminals_become_prose() {
        assert_eq!(
            with_minus("-0.4 (-1e-3 rad, scene-r10, --np 2, 2026-01-02)"),
            "−0.4 (−1e−3 rad, scene-r10, --np 2, 2026-01-02)"
        );
        assert_eq!(prose("set `x --y -1` to -1").into_string(), "set <code>x --y -1</code> to −1");
    }
}
