//! JUnit XML for continuous integration: a suite per scene, a case per model and quantity, its figures as properties.

use super::Report;
use super::format::short;
use crate::comparison::{Check, Discrepancy, SceneComparison};
use crate::error::{Error, Result};
use crate::impact::Quantities;
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
    let mut case = TestCase::new(name, status);
    case.set_classname(format!("{scene}.{source}"));
    case
}

fn case(scene: &str, model: &str, row: &Discrepancy) -> TestCase {
    let failure = (!row.verdict.passed()).then(|| failure(row));
    let mut case = named(scene, model, &row.quantity, failure);
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
    let [reduced, reference, difference] = [row.reduced, row.reference, row.difference].map(short);
    let numbers = format!("{quantity}: reduced {reduced} {unit}, reference {reference} {unit}");
    match (row.tolerance.map(short), row.bias.map(short)) {
        (None, _) => format!("{numbers}: not a number"),
        (Some(bound), None) => format!("{numbers}, difference {difference} {unit}, bound {bound} {unit}"),
        (Some(bound), Some(bias)) => format!(
            "{numbers}, difference {difference} {unit} where {bias} {unit} is known, bound {bound} {unit} about it"
        ),
    }
}

/// What is wrong with a check, in one sentence with numbers, unit and bound.
pub(crate) fn integrity_failure(check: &Check) -> String {
    // all digits: many of these bounds are a matter of rounding
    let Check { check, unit, found, expected, bound, .. } = check;
    format!("{check}: found {found} {unit}, expected {expected} {unit} within {bound} {unit}")
}
