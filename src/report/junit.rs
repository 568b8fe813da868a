//! JUnit XML for continuous integration: a suite per scene, a case per model and quantity, its figures as properties.

use super::Report;
use super::format::{percent, short};
use crate::comparison::{Check, Discrepancy, SceneComparison};
use crate::error::{Error, Result};
use crate::result::Quantities;
use quick_junit::{NonSuccessKind, Property, TestCase, TestCaseStatus, TestSuite};

/// JUnit XML. It holds no times, so that equal results give equal files.
///
/// # Errors
/// [`Error::Internal`] if it can't be serialised.
pub fn junit(report: &Report) -> Result<String> {
    let mut document = quick_junit::Report::new("impactcheck");
    document.add_test_suites(report.scenes.iter().map(|scene| suite(&scene.comparison)));
    document.add_test_suites(report.seats.iter().map(|seat| suite(&seat.comparison)));
    document.to_string().map_err(|e| Error::Internal(format!("writing JUnit XML: {e}")))
}

fn suite<Q: Quantities>(comparison: &SceneComparison<Q>) -> TestSuite {
    let mut suite = TestSuite::new(comparison.scene.clone());
    suite.add_property(Property::new("scene_hash", comparison.reference.scene_hash.as_str()));
    for changed in &comparison.changed_tolerances {
        let name = format!("changed_tolerance.{}.{}", changed.model, changed.quantity);
        let now = changed.now.as_deref().unwrap_or("none");
        suite.add_property(Property::new(name, format!("accepted {}, now {now}", changed.accepted)));
    }
    suite.add_test_cases(
        comparison.integrity.iter().map(|c| integrity_case(&comparison.scene, "reference", c)),
    );
    for model in &comparison.models {
        let rows = model.discrepancies.iter().map(|d| case(&comparison.scene, &model.model, d));
        suite.add_test_cases(rows);
        let checks = model.integrity.iter();
        suite.add_test_cases(checks.map(|c| integrity_case(&comparison.scene, &model.model, c)));
    }
    suite
}

fn named(scene: &str, source: &str, name: &str, failure: Option<String>) -> TestCase {
    let status = match failure {
        None => TestCaseStatus::success(),
        Some(message) => {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
            status.set_type("discrepancy").set_message(message);
            status
        }
    };
    classed(scene, source, TestCase::new(name, status))
}

fn classed(scene: &str, source: &str, mut case: TestCase) -> TestCase {
    case.set_classname(format!("{scene}.{source}"));
    case
}

fn case(scene: &str, model: &str, row: &Discrepancy) -> TestCase {
    let mut case = match (row.verdict.passed(), row.tolerance) {
        (true, None) => {
            let mut status = TestCaseStatus::skipped();
            status.set_message("not gated: the scene has no tolerance for it");
            classed(scene, model, TestCase::new(row.quantity.as_str(), status))
        }
        (true, Some(_)) => named(scene, model, &row.quantity, None),
        (false, _) => named(scene, model, &row.quantity, Some(failure(row))),
    };
    case.add_property(Property::new("unit", row.unit.as_str()));
    let numbers = [
        ("reduced", Some(row.reduced)),
        ("reference", Some(row.reference)),
        ("difference", Some(row.difference)),
        ("relative", row.relative),
        ("uncertainty", row.uncertainty),
        ("tolerance", row.tolerance),
        ("bias", row.bias),
        ("tolerance_used", row.used()),
    ];
    add_numbers(&mut case, &numbers);
    case
}

/// The numbers there are, in SI units, as properties of the case.
fn add_numbers(case: &mut TestCase, numbers: &[(&str, Option<f64>)]) {
    for (name, value) in numbers {
        if let Some(value) = value.filter(|v| v.is_finite()) {
            case.add_property(Property::new(*name, value.to_string()));
        }
    }
}

fn integrity_case(scene: &str, source: &str, check: &Check) -> TestCase {
    let failure = (!check.verdict.passed()).then(|| integrity_failure(check));
    let mut case = named(scene, source, &format!("integrity.{}", check.check), failure);
    case.add_property(Property::new("unit", check.unit.as_str()));
    let numbers = [("found", check.found), ("expected", check.expected), ("bound", check.bound)];
    add_numbers(&mut case, &numbers.map(|(name, value)| (name, Some(value))));
    case
}

/// What is wrong with a row, in one sentence with numbers, unit and bound.
pub(crate) fn failure(row: &Discrepancy) -> String {
    let Discrepancy { quantity, unit, .. } = row;
    let [reduced, reference] = [row.reduced, row.reference].map(short);
    let numbers = format!("{quantity}: reduced {reduced} {unit}, reference {reference} {unit}");
    // what 100 % is, so that bounds stand in the same measure as the difference
    let whole = row.relative.filter(|r| *r != 0.0).map(|relative| row.difference / relative);
    let with_share = |value: f64| {
        let share = whole.map_or(String::new(), |whole| format!(" ({})", percent(Some(value / whole))));
        format!("{} {unit}{share}", short(value))
    };
    let difference = with_share(row.difference);
    // a bound has no sign
    let bound = |width| with_share(width).replace("(+", "(\u{b1}");
    match (row.tolerance, row.bias) {
        (None, _) => format!("{numbers}: not a number"),
        (Some(width), None) => format!("{numbers}, difference {difference}, bound {}", bound(width)),
        (Some(width), Some(bias)) => format!(
            "{numbers}, difference {difference} where {} is known, bound {} about it",
            with_share(bias),
            bound(width)
        ),
    }
}

/// What is wrong with a check, in one sentence with numbers, unit and bound.
pub(crate) fn integrity_failure(check: &Check) -> String {
    // all digits: many of these bounds are a matter of rounding
    let Check { check, unit, found, expected, bound, .. } = check;
    format!(
        "{check}: the history says {found} {unit}, the summary or the scene {expected} {unit}; they may differ by {bound} {unit}"
    )
}
