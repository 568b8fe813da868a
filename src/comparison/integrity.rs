//! Whether a result is consistent with itself and with its scene, before it is compared with anything.
//!
//! A stored or computed history may be damaged in ways that no tolerance on the summary sees. What
//! the summary says is therefore found again in the history, as closely as its sampling permits.

use super::alignment::peak;
use super::balance;
use super::discrepancy::Discrepancy;
use super::seal_seat;
use super::verdict::Verdict;
use crate::kinds::plate_impact::PlateCurves;
use crate::kinds::{self, Kind};
use crate::result::{History, Outcome, Source, Summary};
use crate::scene::{PlateImpact, Scene, Setup, Tolerances};
use serde::Serialize;

/// Share of the peak by which the peak force of a reference may differ from that of its history,
/// beyond the sampling: contact forces of finite elements are noisy, and the history's are averages.
const REFERENCE_PEAK_SLACK: f64 = 0.01;
/// The same for a reduced model, whose force is smooth.
const REDUCED_PEAK_SLACK: f64 = 0.002;
/// Share of the initial speed by which velocities may differ that should be the same.
pub(super) const VELOCITY_SLACK: f64 = 1e-3;
/// Relative difference between the efficiency and the one that the final velocity gives.
pub(super) const EFFICIENCY_SLACK: f64 = 2e-3;
/// Share of the peak below which a force counts as none.
const FORCE_FLOOR: f64 = 1e-9;
/// Share of the largest force of all contacts that may be missed in the peak of another.
const UNSEEN_FORCE: f64 = 1e-4;

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

impl Check {
    pub(super) fn new(check: impl Into<String>, unit: &str, found: f64, expected: f64, bound: f64) -> Self {
        let verdict = Verdict::of((found - expected).abs() <= bound);
        Check { check: check.into(), unit: unit.to_owned(), found, expected, bound, verdict }
    }

    /// A number of defects, of which there should be none.
    pub(super) fn count(check: &str, defects: usize) -> Self {
        Check::new(check, "1", defects as f64, 0.0, 0.0)
    }
}

/// All checks of one result.
pub(super) fn check(scene: &Scene, outcome: &Outcome) -> Vec<Check> {
    let (summary, history) = (&outcome.summary, &outcome.history);
    let mut checks = form(kinds::of(scene), summary, history);
    if history.can_be_sampled() {
        checks.extend(sampling(summary, history));
        checks.extend(match &scene.setup {
            Setup::PlateImpact(setup) => plate_impact(setup, outcome),
            Setup::SealSeat(setup) => seal_seat::check(setup, outcome),
        });
    }
    checks
}

/// Whether a result of a plate impact whose curves can be sampled is consistent with itself and with the scene.
fn plate_impact(setup: &PlateImpact, outcome: &Outcome) -> Vec<Check> {
    let summary = &outcome.summary;
    let Some(history) = PlateCurves::of(&outcome.history) else { return Vec::new() };
    let mut checks = start(setup, &history);
    let [outer, inner] = ["outer", "inner"].map(|body| Stated::of(summary, body));
    // a contact that hardly happens is no longer than a sample or two: its peak is known as well as others matter
    let unseen = UNSEEN_FORCE * outer.peak.unwrap_or(0.0).max(inner.peak.unwrap_or(0.0));
    let of = |name, force, stated| contact(name, summary.source, (history.time, force), stated, unseen);
    checks.extend(of("outer", history.outer_force, outer));
    checks.extend(of("inner", history.inner_force, inner));
    checks.extend(end(setup, summary, &history));
    checks.extend(balance::check(setup, summary, &history));
    checks
}

/// Both results are of the same scene.
pub(super) fn same_impact(reference: &Summary, reduced: &Summary) -> Check {
    let differs = reference.scene != reduced.scene || reference.scene_hash != reduced.scene_hash;
    Check::count("same_scene", usize::from(differs))
}

/// Every tolerance names a row, so that a misspelt one doesn't pass unseen.
pub(super) fn tolerances_are_used(tolerances: &Tolerances, rows: &[Discrepancy]) -> Check {
    let unused = tolerances.keys().filter(|name| rows.iter().all(|r| r.quantity != **name));
    Check::count("unknown_tolerances", unused.count())
}

/// Values are numbers, curves are complete, time increases. What a run has not determined is no value.
fn form(kind: &dyn Kind, summary: &Summary, history: &History) -> Vec<Check> {
    let curves = || kind.curves().iter().map(|curve| history.curve(curve.name).unwrap_or_default());
    let not_finite = curves()
        .flatten()
        .chain(&history.time)
        .copied()
        .chain(summary.quantities.iter().filter_map(|quantity| quantity.value))
        .chain([summary.energy_residual, summary.momentum_residual])
        .chain(summary.uncertainty.values().copied())
        .filter(|x| !x.is_finite())
        .count();
    let incomplete = curves().filter(|c| c.len() != history.len() || c.len() < 2).count();
    let disordered =
        history.time.windows(2).filter(|w| w[0].partial_cmp(&w[1]) != Some(std::cmp::Ordering::Less));
    vec![
        Check::count("not_finite", not_finite),
        Check::count("incomplete_curves", incomplete),
        Check::count("time_not_increasing", disordered.count()),
    ]
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

/// The bodies start as the scene says, and the first touch is at t = 0.
fn start(setup: &PlateImpact, history: &PlateCurves) -> Vec<Check> {
    let speed = setup.outer.speed;
    let velocity = |name: &str, motion: &[f64], expected: f64| {
        Check::new(name, "m/s", motion[0], expected, VELOCITY_SLACK * speed)
    };
    let displacement =
        |name: &str, motion: &[f64]| Check::new(name, "m", motion[0], 0.0, 1e-3 * peak(motion));
    let force = history.outer_force;
    let floor = FORCE_FLOOR * peak(force);
    let touch = force.iter().position(|&f| f > floor).map_or(f64::NAN, |k| history.time[k]);
    vec![
        velocity("outer_velocity_start", history.outer.velocity, -speed),
        velocity("inner_velocity_start", history.inner.velocity, 0.0),
        displacement("outer_displacement_start", history.outer.displacement),
        displacement("plate_displacement_start", history.plate.displacement),
        displacement("inner_displacement_start", history.inner.displacement),
        // The force of the first instant may be zero, that of the next sample is not.
        Check::new("outer_contact_start", "s", touch, 0.0, history.time[2.min(history.time.len() - 1)]),
    ]
}

/// What a summary states of a contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stated {
    /// Largest force in N, if it is determined.
    peak: Option<f64>,
    /// Last release in s, if it is determined.
    end: Option<f64>,
}

impl Stated {
    /// Of the contact of `body`.
    pub(super) fn of(summary: &Summary, body: &str) -> Self {
        let value = |what: &str| summary.value(&format!("{body}_{what}"));
        Stated { peak: value("force_peak"), end: value("contact_end") }
    }
}

/// Sign, peak and end of a contact force over `time`, against what a summary states of it.
pub(super) fn contact(
    name: &str,
    source: Source,
    (time, force): (&[f64], &[f64]),
    stated: Stated,
    unseen: f64,
) -> Vec<Check> {
    let tension = force.iter().fold(0.0_f64, |least, &f| least.min(f));
    let floor = FORCE_FLOOR * peak(force);

    let (at, found) = force.iter().enumerate().fold((0, 0.0), |m, (k, &f)| if f > m.1 { (k, f) } else { m });
    let neighbours = [at.checked_sub(1), Some(at + 1).filter(|&k| k < force.len())];
    let drop = neighbours.into_iter().flatten().map(|k| found - force[k]).fold(0.0, f64::max);
    let slack = match source {
        Source::Reference => REFERENCE_PEAK_SLACK,
        Source::Reduced => REDUCED_PEAK_SLACK,
    };
    // A parabola rises above the higher of its samples by at most an eighth of the drop to the
    // lower neighbour; twice that is allowed.
    let peak_bound = slack * found + 0.25 * drop + unseen;

    let last = force.iter().rposition(|&f| f > floor);
    let (end, end_bound) = last.map_or((0.0, time[1]), |k| {
        let before = k.checked_sub(1).map_or(0.0, |j| time[k] - time[j]);
        let after = time.get(k + 1).map_or(0.0, |t| t - time[k]);
        // Room for the rounding of times written as text.
        (time[k], before.max(after) * 1.001)
    });
    let compared = |what: &str, unit, found, stated: Option<f64>, bound| {
        stated.map(|stated| Check::new(format!("{name}_{what}"), unit, found, stated, bound))
    };
    let tension = Check::new(format!("{name}_tension"), "N", tension, 0.0, 1e-6 * peak(force));
    let peak = compared("force_peak", "N", found, stated.peak, peak_bound);
    let end = compared("contact_end", "s", end, stated.end, end_bound);
    [Some(tension), peak, end].into_iter().flatten().collect()
}

/// Final velocities and efficiency, where they are determined. The last sample tells if it lies in free flight.
fn end(setup: &PlateImpact, summary: &Summary, history: &PlateCurves) -> Vec<Check> {
    let (outer, inner) = (&setup.outer, &setup.inner);
    let last = history.time.len() - 1;
    let flies = history.outer_force[last] == 0.0 && history.inner_force[last] == 0.0;
    let bound = VELOCITY_SLACK * outer.speed;
    let velocity = |name: &str, found: f64| {
        summary.value(name).map(|stated| Check::new(name, "m/s", found, stated, bound))
    };
    let mut checks = Vec::new();
    if flies {
        checks.extend(velocity("outer_velocity_final", history.outer.velocity[last]));
    }
    // In a fluid the inner body slows down after the last contact.
    if flies && setup.fluid.is_none() {
        checks.extend(velocity("inner_velocity_final", history.inner.velocity[last]));
    }
    let mass_ratio = inner.shape.mass(&inner.material) / outer.shape.mass(&outer.material);
    if let (Some(stated), Some(velocity)) =
        (summary.value("efficiency"), summary.value("inner_velocity_final"))
    {
        // Eq. (1).
        let efficiency = mass_ratio * (velocity / outer.speed).powi(2);
        checks.push(Check::new("efficiency", "1", stated, efficiency, EFFICIENCY_SLACK * efficiency));
    }
    checks
}
