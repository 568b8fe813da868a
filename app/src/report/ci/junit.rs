//! JUnit XML for continuous integration: a suite per scene, a case per model and quantity, its figures as properties. What
//! stops at the gate is a failure; what is not gated, or undecided and to be told, is skipped.

use crate::comparison::{Check, Discrepancy, GateRules, SceneComparison, Undecided, Verdict};
use crate::error::{Error, Result};
use crate::format::{percent, prefixed, with_unit};
use crate::report::Report;
use crate::report::existing::Folder;
use crate::report::export::Export;
use quick_junit::{NonSuccessKind, Property, TestCase, TestCaseStatus, TestSuite};

/// The checks of this run.
pub(crate) struct JUnit;

impl Export<Folder<'_>> for JUnit {
    fn ending(&self) -> &'static str {
        "xml"
    }

    fn bytes(&self, folder: &Folder) -> Result<Vec<u8>> {
        junit(folder.report).map(String::into_bytes)
    }
}

/// JUnit XML. It holds no times, so that equal results give equal files.
///
/// # Errors
/// [`Error::Internal`] if it can't be serialised.
pub fn junit(report: &Report) -> Result<String> {
    let mut document = quick_junit::Report::new("impactcheck");
    document.add_test_suites(report.scenes.iter().map(|scene| suite(&scene.comparison, report.rules)));
    document.to_string().map_err(|e| Error::Internal(format!("writing JUnit XML: {e}")))
}

fn suite(comparison: &SceneComparison, rules: GateRules) -> TestSuite {
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
    if comparison.verdict == Verdict::NotGated && rules.refuse(comparison.verdict) {
        let message = "the scene has no tolerances for these models, and they are required".to_owned();
        suite.add_test_case(named(&comparison.scene, "gate", "tolerances", Some(message)));
    }
    for model in &comparison.models {
        let rows = model.discrepancies.iter().map(|d| case(&comparison.scene, &model.model, d, rules));
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

fn case(scene: &str, model: &str, row: &Discrepancy, rules: GateRules) -> TestCase {
    let skipped = |message: String| {
        let mut status = TestCaseStatus::skipped();
        status.set_message(message);
        classed(scene, model, TestCase::new(row.quantity.as_str(), status))
    };
    let mut case = match (row.verdict, rules.undecided) {
        _ if row.is_refused(rules) && row.verdict != Verdict::NotGated => {
            named(scene, model, &row.quantity, Some(in_words(row)))
        }
        (Verdict::NotGated, _) => skipped("not gated: the scene has no tolerance for it".to_owned()),
        (Verdict::Undecided, Undecided::Warn) => skipped(in_words(row)),
        _ => named(scene, model, &row.quantity, None),
    };
    case.add_property(Property::new("verdict", row.verdict.name()));
    case.add_property(Property::new("unit", row.unit.as_str()));
    let numbers = [
        ("reduced", row.reduced),
        ("reference", row.reference),
        ("difference", row.difference),
        ("relative", row.relative),
        ("uncertainty", row.uncertainty),
        ("difference_uncertainty", row.difference_uncertainty),
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
    let failure = check.verdict.failed().then(|| check.to_string());
    let mut case = named(scene, source, &format!("integrity.{}", check.check), failure);
    case.add_property(Property::new("unit", check.unit.as_str()));
    let numbers = [("found", check.found), ("expected", check.expected), ("bound", check.bound)];
    add_numbers(&mut case, &numbers.map(|(name, value)| (name, Some(value))));
    case
}

/// What is wrong with a row, or open, in one sentence with numbers, unit and bound.
pub(crate) fn in_words(row: &Discrepancy) -> String {
    let to = prefixed(&row.unit, row.reference.filter(|r| *r != 0.0).or(row.reduced).unwrap_or(0.0));
    let side = |value: Option<f64>| value.map_or("not determined".into(), |v| with_unit(v, to, 4));
    let values = format!("{}: model {}, reference {}", row.quantity, side(row.reduced), side(row.reference));
    let Some(difference) = row.difference else {
        return match &row.would_decide {
            Some(how) => format!("{values}: undecided; {how}"),
            None => format!("{values}; a tolerance needs both: set a later `run.end_time`, or none"),
        };
    };
    // what 100 % is, so that bounds have the same measure as the difference
    let whole = row.relative.filter(|r| *r != 0.0).map(|relative| difference / relative);
    let with_share = |value: f64, digits: usize| {
        let share = whole.map_or(String::new(), |whole| format!(" ({})", percent(Some(value / whole))));
        with_unit(value, to, digits) + &share
    };
    // a bound has no sign
    let bound = |width, digits| format!("\u{b1}{}", with_share(width, digits).replace("(+", "(\u{b1}"));
    let compared = format!("{values}, difference {}", with_share(difference, 3));
    let bounded = match (row.tolerance, row.bias) {
        (None, _) => return format!("{values}: not a number"),
        (Some(width), None) => format!("{compared}, tolerance {}", bound(width, 3)),
        (Some(width), Some(bias)) => {
            format!("{compared}, declared bias {} with tolerance {}", with_share(bias, 3), bound(width, 3))
        }
    };
    let whose = row.difference_uncertainty.map_or("reference", |_| "difference on the common mesh");
    match (&row.would_decide, row.band()) {
        (Some(how), Some(band)) => {
            format!("{bounded}, uncertainty (95 %) of the {whose} {}: undecided; {how}", bound(band, 2))
        }
        _ => bounded,
    }
}
