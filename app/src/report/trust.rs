//! How far a model can be trusted in its scene, in a sentence: what it hits, how well, and whether its theory holds there.

use crate::comparison::{Discrepancy, ModelComparison, SceneComparison};
use crate::format::{percent_above, words};
use crate::kinds;
use crate::prediction::auto::Judge;
use crate::prediction::{impact_speed, predicted_errors};
use crate::report::summary_column::SummaryColumn;
use crate::result::Summary;
use crate::scene::{Model, Scene};

/// Discrepancy, relative or in rad, up to which a model is said to be right within it rather than off by it.
pub(crate) const SMALL: f64 = 0.01;
/// Truncation error up to which model C stands for itself with all modes.
const CONVERGED: f64 = 1e-3;
/// Discrepancy from which on it counts as large.
pub(crate) const LARGE: f64 = 0.05;

/// The class of a discrepancy of this size.
pub(crate) fn size_class(off: f64) -> &'static str {
    match off.abs() {
        size if size <= SMALL => "small",
        size if size <= LARGE => "medium",
        _ => "large",
    }
}

/// What the model hits, and how well: the quantities of `columns`, the curves, the numbers of contacts.
pub(crate) fn accuracy(columns: &[SummaryColumn], model: &ModelComparison) -> String {
    let groups = columns.chunk_by(|one, other| one.heading == other.heading);
    let mut phrases: Vec<String> = groups.filter_map(|group| of_group(group, model)).collect();
    phrases.extend(worst_curve(model));
    let counted =
        |row: &&Discrepancy| model.summary.quantities.get(&row.quantity).is_some_and(|q| q.is_count);
    for row in model.discrepancies.iter().filter(counted).filter(|row| row.difference != Some(0.0)) {
        if let Some((own, reference)) = row.reduced.zip(row.reference) {
            phrases.push(format!("{}: {own} instead of {reference}", words(&row.quantity)));
        }
    }
    let truncation = model.summary.truncation_error.filter(|error| *error > SMALL);
    let truncation =
        truncation.map(|error| format!("the truncation error is about {}", percent_above(error)));
    std::iter::once(phrases.join(", ")).chain(truncation).collect::<Vec<_>>().join("; ")
}

/// The worst of some quantities, with the reference's band where that is wider.
fn of_group(group: &[SummaryColumn], model: &ModelComparison) -> Option<String> {
    let rows: Vec<(&SummaryColumn, &Discrepancy)> =
        group.iter().filter_map(|c| Some((c, model.discrepancy(c.quantity)?))).collect();
    let first = group.first().filter(|_| !rows.is_empty())?;
    // in a sentence, not above columns
    let what = if first.heading == "contact ends" { "end of contact" } else { first.heading };
    let size = |is_angle: bool, row: &Discrepancy, of: Option<f64>| {
        let scale = if is_angle { Some(1.0) } else { row.reference.map(f64::abs).filter(|r| *r != 0.0) };
        of.zip(scale).map(|(value, scale)| value.abs() / scale).filter(|v| v.is_finite())
    };
    let sizes: Option<Vec<f64>> = rows.iter().map(|(c, row)| size(c.is_angle, row, row.difference)).collect();
    let Some(worst) = sizes.map(|sizes| sizes.into_iter().fold(0.0, f64::max)) else {
        return Some(format!("{what} not determined"));
    };
    let band = rows.iter().filter_map(|(c, row)| size(c.is_angle, row, row.uncertainty)).fold(0.0, f64::max);
    Some(phrase(what, rows.len() > 1, worst, band, first.is_angle))
}

fn phrase(what: &str, several: bool, worst: f64, band: f64, is_angle: bool) -> String {
    let shown = |size: f64| {
        if is_angle {
            format!("{:.2}°", (100.0 * size.to_degrees() - 1e-9).ceil() / 100.0)
        } else {
            percent_above(size)
        }
    };
    let how = match (worst <= SMALL, several) {
        (true, _) => "within",
        (false, true) => "differs by up to",
        (false, false) => "differs by",
    };
    let band = if band > worst { format!(" (reference ±{})", shown(band)) } else { String::new() };
    format!("{what} {how} {}{band}", shown(worst))
}

/// The curve with the largest root mean square distance.
fn worst_curve(model: &ModelComparison) -> Option<String> {
    let rows = model.discrepancies.iter().filter(|row| row.quantity.ends_with("_rms"));
    let measured = rows.filter_map(|row| Some((row, row.relative?)));
    let (row, relative) = measured.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let peak = row.scale()?;
    let curve = words(row.quantity.trim_end_matches("_rms"));
    let band = row.uncertainty.map_or(0.0, |band| band / peak);
    Some(phrase(&format!("worst curve ({curve}, rms)"), false, relative, band, false))
}

/// Whether the theories hold that the model shares with the reference, as far as that was computed.
pub(crate) fn validity(scene: &Scene, summary: &Summary) -> Vec<String> {
    let limits = &summary.limits;
    if limits.is_empty() {
        return Vec::new();
    }
    let exceeded: Vec<String> = limits
        .iter()
        .filter(|limit| limit.is_exceeded())
        .map(|limit| format!("{} is {:.1} times its limit", words(&limit.measure), limit.value / limit.bound))
        .collect();
    let range = match exceeded.is_empty() {
        true => "assumptions hold".to_owned(),
        false => format!("assumptions violated: {}", exceeded.join(", ")),
    };
    let yielding = kinds::of(scene).yields(scene) || limits.iter().any(|limit| limit.is_of_yield());
    let unchecked = "elastic limit not checked: no yield strength is specified".to_owned();
    std::iter::once(range).chain((!yielding).then_some(unchecked)).collect()
}

/// What was to be expected of `model` in `scene` by the validation base, without the reference of the scene; `None` where model C, by which
/// it is judged, is not among the models, or has few modes.
pub(crate) fn predicted(
    scene: &Scene,
    comparison: &SceneComparison,
    model: &ModelComparison,
) -> Option<String> {
    let judges = |other: &&ModelComparison| {
        other.model == Model::C.to_string()
            && other.summary.truncation_error.is_none_or(|error| error <= CONVERGED)
    };
    let continuum = &comparison.models.iter().find(judges)?.summary;
    let own = match predicted_errors(scene, continuum) {
        Ok(own) => own,
        Err(reason) => return Some(format!("nothing is predicted: {reason}")),
    };
    let exact = |name: &str| continuum.value(name);
    let judge = Judge { continuum: &exact, own: &own, speed: impact_speed(scene) };
    let value = |name: &str| model.summary.value(name);
    let largest = |names: &[&str]| names.iter().filter_map(|name| judge.error(name, &value)).reduce(f64::max);
    let parts = [
        ("efficiency", largest(&["efficiency"])),
        ("force peaks", largest(&["outer_force_peak", "inner_force_peak"])),
    ];
    let parts: Vec<String> = parts
        .into_iter()
        .filter_map(|(what, error)| Some(format!("{what} within {}", percent_above(error?))))
        .collect();
    (!parts.is_empty()).then(|| format!("predicted by other scenes (95 %): {}", parts.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::{phrase, size_class};

    #[test]
    fn sizes_are_rounded_up_and_have_the_uncertainty_of_the_reference_where_that_is_larger() {
        assert_eq!(phrase("efficiency", false, 0.000_186, 0.000_1, false), "efficiency within 0.019 %");
        assert_eq!(phrase("peak force", true, 0.0101, 0.0, false), "peak force differs by up to 1.1 %");
        assert_eq!(phrase("speed", false, 0.0009, 0.021, false), "speed within 0.090 % (reference ±2.1 %)");
        assert_eq!(phrase("direction", false, 0.2, 0.0, true), "direction differs by 11.46°");
    }

    #[test]
    fn the_class_is_of_the_size_whatever_the_sign() {
        assert_eq!([0.01, -0.011, 0.05, -0.4].map(size_class), ["small", "medium", "medium", "large"]);
        assert_eq!(size_class(f64::NAN), "large");
    }
}
