//! The page of coverage: features of scenes in rows, models and what they are compared with in columns.

use crate::coverage::{CLOSED_FORM, Coverage, FeatureComparison, FeatureCoverage};
use crate::format::{percent_above, words};
use crate::report::existing::ExistingScene;
use crate::report::page::html::{page, scrolled};
use crate::report::trust::size_class;
use maud::{Markup, html};

/// Its name without ending, which no scene of a report may have.
pub(crate) const NAME: &str = "coverage";
/// Its file.
pub(crate) const FILE: &str = "coverage.html";

/// Difference that is told as such: nobody needs its digits.
const NEGLIGIBLE: f64 = 1e-6;
const MODELS: [&str; 3] = ["A", "B", "C"];
/// The comparators that have a column of their own; all others are other programs.
const COMPARATORS: [&str; 3] = ["axisymmetric", "solid", CLOSED_FORM];

/// The page of `coverage`; scenes with a page among those `existing` are linked.
pub(crate) fn of(coverage: &Coverage, existing: &[ExistingScene]) -> String {
    let pages: Vec<&str> = existing.iter().map(|scene| &*scene.overview.scene).collect();
    let body = html! {
        h1 { "Coverage" }
        p { a href="index.html" { "All scenes" } }
        p { (description(coverage)) }
        (scrolled("Coverage", &table(coverage, &pages)))
        p.soft.note {
            "Models A, B and C: the largest relative difference to finite elements or another program in any scene with the feature, and the "
            "uncertainty (95 %) of the comparator there. Compared with: the same of the nearest model, and the scenes. "
            "Closed forms are of a part of a model: the plate's or the bender's frequencies, the contact on a rigid half-space, the film "
            "above a plane; they have no uncertainty. All entries are found from the scenes, records and formulas of this program."
        }
    };
    page("Coverage", &[], &body, &html! {})
}

/// How many features have a comparator, and which have none.
fn description(coverage: &Coverage) -> String {
    let is_compared = |feature: &&FeatureCoverage| feature.partners.iter().any(|p| p.partner.is_some());
    let (compared, alone): (Vec<_>, Vec<_>) = coverage.features.iter().partition(is_compared);
    let names: Vec<&str> = alone.iter().map(|feature| feature.feature).collect();
    let rest = match names.len() {
        0 => "every one is compared with something independent".to_owned(),
        _ => format!(
            "{} of them are compared with something independent; not: {}",
            compared.len(),
            names.join(", ")
        ),
    };
    format!("{} features that a scene can have; {rest}.", coverage.features.len())
}

fn table(coverage: &Coverage, pages: &[&str]) -> Markup {
    html! { table.coverage {
        thead {
            tr { td {} th.left scope="colgroup" colspan="3" { "reduced model" } th.left scope="colgroup" colspan="4" { "compared with" } }
            tr {
                th.left scope="col" { "feature" }
                @for heading in MODELS.iter().chain(&COMPARATORS) { th.left scope="col" { (heading) } }
                th.left scope="col" { "other program" }
            }
        }
        tbody { @for feature in &coverage.features { tr {
            th.left scope="row" { (feature.feature) }
            @if feature.partners.is_empty() { td.left.soft colspan="7" { "no scene has it" } }
            @else {
                @for model in MODELS { td.left { (of_model(feature, model)) } }
                @for comparator in COMPARATORS { td.left { (of_comparator(&with(feature, |name| name == comparator), pages)) } }
                td.left { (of_comparator(&with(feature, |name| !COMPARATORS.contains(&name)), pages)) }
            }
        } } }
    } }
}

/// The entries of a feature whose comparator's name `is_selected`.
fn with(feature: &FeatureCoverage, is_selected: impl Fn(&str) -> bool) -> Vec<&FeatureComparison> {
    feature.partners.iter().filter(|p| p.partner.as_deref().is_some_and(&is_selected)).collect()
}

/// The largest difference of a model to any comparator that solves whole scenes.
fn of_model(feature: &FeatureCoverage, model: &str) -> Markup {
    let own: Vec<&FeatureComparison> = feature.partners.iter().filter(|p| p.model == model).collect();
    let whole = own.iter().filter(|p| p.partner.is_some() && p.partner.as_deref() != Some(CLOSED_FORM));
    let worst = whole
        .max_by(|a, b| a.worst_relative.partial_cmp(&b.worst_relative).unwrap_or(std::cmp::Ordering::Equal));
    html! {
        @match (worst, own.is_empty()) {
            (Some(worst), _) => (difference(worst)),
            (None, true) => span.soft { "not for it" },
            (None, false) => span.alone { "not compared" },
        }
    }
}

/// The scenes of `entries`, all with one comparator, and the difference of the model that comes nearest to it.
fn of_comparator(entries: &[&FeatureComparison], pages: &[&str]) -> Markup {
    let size = |comparator: &&&FeatureComparison| comparator.worst_relative.unwrap_or(f64::INFINITY);
    let Some(nearest) = entries.iter().min_by(|a, b| size(a).total_cmp(&size(b))) else {
        return html! { span.soft { "–" } };
    };
    let as_near = entries.iter().filter(|entry| entry.worst_relative == nearest.worst_relative);
    let models: Vec<&str> = as_near.map(|entry| &*entry.model).collect();
    let count = nearest.scenes.len();
    html! {
        (models.join(", ")) ": " (difference(nearest))
        details {
            summary { (count) " scene" @if count != 1 { "s" } }
            ul.plain { @for scene in &nearest.scenes { li {
                @if pages.contains(&&**scene) { a href=(format!("{scene}.html")) { (scene) } } @else { (scene) }
            } } }
        }
    }
}

/// The largest difference of an entry, with the comparator's band and the quantity.
fn difference(entry: &FeatureComparison) -> Markup {
    let Some(relative) = entry.worst_relative else { return html! { "–" } };
    let quantity = entry.quantity.as_deref().map(words).unwrap_or_default();
    let is_exact = entry.partner.as_deref() == Some(CLOSED_FORM);
    html! {
        span class=(format!("off {}", size_class(relative))) data-si=(relative) { (size(relative)) }
        @if !is_exact { " " span.value { "± " @match entry.band { Some(band) => (percent_above(band)), None => "unknown" } } }
        " " span.soft { (quantity) }
    }
}

/// A relative size, of which nothing below [`NEGLIGIBLE`] matters.
fn size(relative: f64) -> String {
    if relative < NEGLIGIBLE { format!("< {}", percent_above(NEGLIGIBLE)) } else { percent_above(relative) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(model: &str, comparator: Option<&str>, worst: f64) -> FeatureComparison {
        FeatureComparison {
            model: model.into(),
            partner: comparator.map(str::to_owned),
            scenes: vec!["here".into(), "elsewhere".into()],
            worst_relative: comparator.map(|_| worst),
            band: comparator.map(|_| 0.002),
            quantity: comparator.map(|_| "inner_force_peak".into()),
        }
    }

    /// Every cell says what there is, a feature without comparator that it has none.
    #[test]
    fn cells_have_the_largest_difference_of_a_model_and_the_nearest_model_of_a_comparator() {
        let compared = FeatureCoverage {
            feature: "gap",
            partners: vec![
                entry("A", Some("axisymmetric"), 0.5),
                entry("C", Some("axisymmetric"), 0.001),
                entry("C", Some("solid"), 0.02),
                entry("C", Some("elsewhere's program"), 0.03),
                entry("B", Some(CLOSED_FORM), 1e-9),
            ],
        };
        let of_c = of_model(&compared, "C").into_string();
        assert!(
            of_c.contains("3.0 %") && of_c.contains("± 0.20 %") && of_c.contains("inner force, peak"),
            "{of_c}"
        );
        assert!(of_model(&compared, "B").into_string().contains("not compared"));
        let axisymmetric =
            of_comparator(&with(&compared, |name| name == "axisymmetric"), &["here"]).into_string();
        assert!(axisymmetric.starts_with("C: ") && axisymmetric.contains("2 scenes"), "{axisymmetric}");
        assert!(
            axisymmetric.contains("<a href=\"here.html\">here</a>")
                && axisymmetric.contains("<li>elsewhere</li>")
        );
        let exact = of_comparator(&with(&compared, |name| name == CLOSED_FORM), &[]).into_string();
        assert!(exact.contains("&lt; 0.00010 %") && !exact.contains('±'), "{exact}");
        let alone = FeatureCoverage { feature: "drag", partners: vec![entry("B", None, 0.0)] };
        assert!(of_model(&alone, "A").into_string().contains("not for it"));
        let coverage = Coverage { schema_version: 1, features: vec![compared, alone] };
        assert_eq!(
            description(&coverage),
            "2 features that a scene can have; 1 of them are compared with something independent; not: drag."
        );
        let page = of(&coverage, &[]);
        assert_eq!(page.matches("<th class=\"left\" scope=\"row\">").count(), 2, "{page}");
    }
}
