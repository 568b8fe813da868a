//! Whether a result is consistent with itself and with its scene, before it is compared with anything.
//!
//! A stored or computed history may be damaged in ways that no tolerance on the summary sees. What
//! the summary says is therefore found again in the history, as closely as its sampling permits.

use super::discrepancy::Discrepancy;
use super::impacts;
use super::series;
use super::verdict::Verdict;
use crate::format::{measure, quantity, words};
use crate::kinds;
use crate::result::{Curve, History, Outcome, Source, Statement, Summary};
use crate::scene::{Scene, Tolerances};
use serde::Serialize;

/// The check that a program which failed does not pass.
const NO_RESULT: &str = "no_result";

/// A statement about one result that must hold whatever the tolerances are.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// What is checked.
    pub check: String,
    /// Unit.
    pub unit: String,
    /// Value found in the result.
    pub found: f64,
    /// Value that it should have.
    pub expected: f64,
    /// Largest admissible |found - expected|.
    pub bound: f64,
    /// Whether it holds; a value that is not a number fails.
    pub verdict: Verdict,
}

impl std::fmt::Display for Check {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.check == NO_RESULT {
            return write!(f, "there is no result to compare");
        }
        let Check { check, unit, found, expected, bound, .. } = self;
        let [found, expected] = [found, expected].map(|value| measure(*value, unit));
        let [difference, bound] = [self.found - self.expected, *bound].map(|value| quantity(value, unit, 2));
        write!(
            f,
            "{}: found {found}, expected {expected}; difference {difference}, allowed ±{bound}",
            words(check)
        )
    }
}

impl From<Statement> for Check {
    fn from(statement: Statement) -> Self {
        let verdict = Verdict::of(statement.holds());
        let Statement { about, unit, found, expected, bound } = statement;
        Check { check: about, unit: unit.to_owned(), found, expected, bound, verdict }
    }
}

impl Check {
    fn new(check: &str, unit: &'static str, found: f64, expected: f64, bound: f64) -> Self {
        Statement::new(check, unit, found, expected, bound).into()
    }

    /// A number of defects, of which there should be none.
    fn count(check: &str, defects: usize) -> Self {
        Check::new(check, "1", defects as f64, 0.0, 0.0)
    }
}

/// All checks of one result of `scene`.
pub fn check(scene: &Scene, outcome: &Outcome) -> Vec<Check> {
    let (summary, history) = (&outcome.summary, &outcome.history);
    let kind = kinds::of(scene);
    let mut checks = form(scene, summary, history);
    checks.extend(series::contradictions(summary).map(|n| Check::count("contradictions_of_mesh_series", n)));
    if history.can_be_sampled() {
        checks.extend(sampling(summary, history));
    }
    checks.extend(kind.checks(scene, outcome).into_iter().map(Check::from));
    checks
}

/// What a result of `scene` contradicts, itself or the scene: the checks that fail, in words.
pub fn contradictions(scene: &Scene, outcome: &Outcome) -> Vec<String> {
    let checks = check(scene, outcome).into_iter();
    checks.filter(|check| check.verdict.failed()).map(|check| check.to_string()).collect()
}

/// Both results are of the same scene.
pub(super) fn same_impact(reference: &Summary, reduced: &Summary) -> Check {
    let differs = reference.scene != reduced.scene || reference.scene_hash != reduced.scene_hash;
    Check::count("same_scene", usize::from(differs))
}

/// Every tolerance names a row, so that a misspelt one doesn't pass unseen.
pub(super) fn tolerances_are_used(tolerances: &Tolerances, rows: &[Discrepancy]) -> Check {
    let unused = tolerances.keys().filter(|name| rows.iter().all(|row| !impacts::bounds(name, row)));
    Check::count("unknown_tolerances", unused.count())
}

/// Values are numbers, curves are complete, time increases. What a run has not determined is no value, nor is what another
/// program does not state.
fn form(scene: &Scene, summary: &Summary, history: &History) -> Vec<Check> {
    let kind = kinds::of(scene);
    let own = || kind.curves().iter().filter(|curve| kind.has(scene, curve.name));
    let curves = || own().filter_map(stated_curve(summary.source, history));
    // a solver of this program that states no residual has one that is no number
    let residual = |stated: Option<f64>| match summary.source {
        Source::External => stated,
        _ => Some(stated.unwrap_or(f64::NAN)),
    };
    let not_finite = curves()
        .flatten()
        .chain(&history.time)
        .copied()
        .chain(summary.quantities.iter().filter_map(|quantity| quantity.value))
        .chain([summary.energy_residual, summary.momentum_residual].into_iter().filter_map(residual))
        .chain(summary.uncertainty.values().copied())
        .filter(|x| !x.is_finite())
        .count();
    let incomplete = curves().filter(|c| c.len() != history.len() || c.len() < 2).count();
    let failed = summary.failure.as_ref().map(|_| Check::count(NO_RESULT, 1));
    let disordered =
        history.time.windows(2).filter(|w| w[0].partial_cmp(&w[1]) != Some(std::cmp::Ordering::Less));
    let mut checks = vec![
        Check::count("not_finite", not_finite),
        Check::count("incomplete_curves", incomplete),
        Check::count("time_not_increasing", disordered.count()),
    ];
    checks.extend(failed);
    checks
}

/// The values of a curve in a history. Another program need not give all curves.
fn stated_curve<'h>(source: Source, history: &'h History) -> impl Fn(&Curve) -> Option<&'h [f64]> {
    move |curve| match history.curve(curve.name) {
        None if source != Source::External => Some(&[]),
        found => found,
    }
}

/// The history has the samples that the summary states, at the distance it states.
fn sampling(summary: &Summary, history: &History) -> Vec<Check> {
    let time = &history.time;
    let mut checks = vec![Check::new("first_time", "s", time[0], 0.0, 0.0)];
    // A reference that doesn't say how it was sampled can't be checked for missing samples.
    if summary.samples.is_some() || summary.source == Source::Reference {
        let stated = summary.samples.map_or(f64::NAN, |n| n as f64);
        checks.push(Check::new("samples", "1", time.len() as f64, stated, 0.0));
    }
    if summary.sample_interval.is_some() || summary.source == Source::Reference {
        let interval = summary.sample_interval.unwrap_or(f64::NAN);
        let spacing = |w: &[f64]| w[1] - w[0];
        let worst = time.windows(2).map(spacing).fold(interval, |worst, s| {
            if (s - interval).abs() > (worst - interval).abs() { s } else { worst }
        });
        checks.push(Check::new("sample_interval", "s", worst, interval, 0.01 * interval.abs()));
    }
    checks
}
