//! The frame of every page, and what pages share. Pages are self-contained: style, script and figures are
//! inside, nothing is loaded. Every number carries its SI value in `data-si`.

use crate::comparison::{ModelComparison, Verdict};
use crate::format::{Prefixed, with_unit, words};
use crate::report::conclusion::HOLD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("assets/style.css");

/// A page; `scripts` stand behind its body.
pub(crate) fn page(title: &str, styles: &[&str], body: &Markup, scripts: &Markup) -> String {
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

pub(crate) fn badge(verdict: Verdict) -> Markup {
    worded(verdict, verdict.words())
}

/// The verdict of a model, of which it may be known that it is off.
pub(crate) fn model_badge(model: &ModelComparison) -> Markup {
    worded(model.verdict, model.verdict_in_words())
}

pub(crate) fn worded(verdict: Verdict, words: &str) -> Markup {
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

/// The verdict of a scene.
pub(crate) fn scene_badge(verdict: Verdict) -> Markup {
    let title = "Verdict: whether the differences of the models from the reference are within the scene's tolerances.";
    html! { span title=(title) { (badge(verdict)) } }
}

/// Whether the assumptions hold: with the verdict, so that a pass alone does not mislead.
pub(crate) fn assumptions_badge(words: &str) -> Markup {
    let (class, title) = if words == HOLD {
        (
            "verdict pass",
            "All checked assumptions that the models and the reference share hold in this scene.",
        )
    } else {
        (
            "verdict undecided",
            "An assumption that the models and the reference share is violated: both may differ from reality in the same way.",
        )
    };
    html! { span class=(class) title=(title) { (words) } }
}

/// Something wider than a phone, which scrolls by itself, also by keyboard.
pub(crate) fn scrolled(name: &str, content: &Markup) -> Markup {
    html! { div.scroll role="region" tabindex="0" aria-label=(name) { (content) } }
}

/// What the efficiency is; eq. (1) of the paper.
pub(crate) const EFFICIENCY: &str = "Efficiency, eq. (1): kinetic energy of the body that is struck through the plate or seat (inner body, sphere) after \
    the last contact over that of the striking body (outer body, actuator) before the first, both of the rigid-body \
    (mass-averaged) velocity.";

/// The name of a quantity in words; what it does not tell by itself is told on hover.
pub(crate) fn named(quantity: &str) -> Markup {
    match quantity {
        "efficiency" => html! { abbr title=(EFFICIENCY) { (words(quantity)) } },
        _ => html! { (words(quantity)) },
    }
}

/// A heading for a quantity under another name.
pub(crate) fn named_as(heading: &str, quantity: &str) -> Markup {
    if words(quantity) == heading {
        named(quantity)
    } else {
        html! { (heading) }
    }
}

/// A drawing with type that must not shrink with the screen: it scrolls by itself.
pub(crate) fn detailed(name: &str, drawing: &Markup) -> Markup {
    html! { div.scroll.detailed role="region" tabindex="0" aria-label=(name) { (drawing) } }
}

/// A cell with a number: SI value in `data-si`, shown with its prefix. Empty `data-si` = not a number.
pub(crate) fn number(field: &str, value: Option<f64>, to: Prefixed, digits: usize) -> Markup {
    let finite = value.filter(|v| v.is_finite());
    html! {
        td data-field=(field) data-si=(finite.map_or(String::new(), |v| v.to_string())) {
            (finite.map_or("–".into(), |v| with_unit(v, to, digits)))
        }
    }
}
