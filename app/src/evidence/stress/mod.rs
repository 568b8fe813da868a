//! Numerical stability over random impacts: what has to hold for every scene that is admissible.
//!
//! Every case is drawn from its own seed, so that one command repeats it alone.

mod between;
mod independent;
mod kinds;
mod results;
#[cfg(test)]
mod tests;

pub use kinds::{StressCase, StressImpact, UnitPlateModes};
pub use results::{CaseMotion, CaseResult, StressResults, results};

use crate::dynamics::error_control::{all_within, controlled};
use crate::dynamics::integrate;
use crate::dynamics::integration::{Integration, Options};
use crate::error::{Error, Result};
use crate::result::SCHEMA_VERSION;
use crate::sweep;
use independent::{Answer, IndependentCheck};
use kinds::{DRY, MOVING, WET};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Tolerance of the integrator under test: the program's default.
const TOLERANCE: f64 = 1e-7;
/// Largest difference to the independent solution: of a final velocity, over the impact speed, of a force peak and an efficiency, relative.
const DIFFERENCE_BOUND: f64 = 1e-5;
/// The same of the time of the last release, at which a force vanishes slowly.
const END_BOUND: f64 = 3e-4;
/// Error that the results of a sweep's point may have: a sweep's default.
const SWEEP_ERROR: f64 = sweep::DEFAULT_TOLERANCE;
/// Tolerance of the solution that judges a sweep's point where the result differs from it.
const CAREFUL: f64 = 1e-11;
/// One point of a sweep in so many may be wrong.
const WRONG_POINTS: u64 = 1000;
/// Bounds of the invariants. Momentum relative to the initial one; energy gained relative to the initial one; differences to the
/// independent solution.
const BOUNDS: [(&str, f64); 6] = [
    ("momentum", 1e-10),
    ("energy_gained", 1e-6),
    ("velocity_difference", DIFFERENCE_BOUND),
    ("force_difference", DIFFERENCE_BOUND),
    ("efficiency_difference", DIFFERENCE_BOUND),
    ("end_difference", END_BOUND),
];

/// The largest value of an invariant, and where it came from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Worst {
    /// The value, in relation to what `BOUNDS` names.
    pub value: f64,
    /// Its bound; `None` if it is only watched.
    pub bound: Option<f64>,
    /// Seed of the case.
    pub seed: u64,
}

/// A case that does not hold.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Failure {
    /// Seed: `impactcheck stress --cases 1 --seed SEED` repeats the case.
    pub seed: u64,
    /// What does not hold.
    pub reason: String,
    /// The case in words.
    pub case: String,
}

/// What points of a sweep with its default tolerance came to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepReport {
    /// Number of points.
    pub points: u64,
    /// Points whose row says that it is not as exact as it should be.
    pub unconverged: u64,
    /// Seeds of points that are not, and whose row does not say so: velocities, force peaks and times of release beyond the tolerance,
    /// or other numbers of contacts.
    pub wrong: Vec<u64>,
}

impl SweepReport {
    /// Whether no more points are wrong than one in 1000.
    pub fn holds(&self) -> bool {
        self.wrong.len() as u64 <= self.points.div_ceil(WRONG_POINTS)
    }
}

/// What a stress run found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StressReport {
    /// Version of the document.
    pub schema_version: u32,
    /// Number of cases.
    pub cases: u64,
    /// Seed of the first; the others follow.
    pub seed: u64,
    /// Cases that were also solved independently.
    pub compared: u64,
    /// Seeds of those among them that differ from an independent solution which is itself uncertain: at two tolerances it
    /// differs from itself by more than a third of the bound (many contacts, each a kink that the method does not know of); or
    /// whose result warns that it is uncertain by as much.
    pub undecided: Vec<u64>,
    /// Cases that were solved in a fluid as well.
    pub wet: u64,
    /// Of these, compared with an independent solution.
    pub wet_compared: u64,
    /// Cases that were solved with a compact outer body or an inner one that moves as well.
    pub moving: u64,
    /// Of these, compared with an independent solution.
    pub moving_compared: u64,
    /// The same impacts as points of a sweep.
    pub sweep: SweepReport,
    /// Seeds of those that the program refuses in a sentence: whose plate in the fluid bends around the inner body, or rattles
    /// or trembles between bodies far heavier than itself more often than it follows.
    pub beyond_model: Vec<u64>,
    /// Cases with more than one contact at the outer or the inner body.
    pub recontacts: u64,
    /// Cases that do not hold, in the order of their seeds.
    pub failures: Vec<Failure>,
    /// The worst of each invariant.
    pub worst: BTreeMap<String, Worst>,
}

/// Runs the cases with the seeds `seed`, `seed + 1`, ...; `progress` is called after each.
///
/// # Errors
/// If the modes of a plate can't be computed; a case that fails is in the report.
pub fn run(cases: u64, seed: u64, progress: &(dyn Fn() + Sync)) -> Result<StressReport> {
    let plates = UnitPlateModes::default();
    let solved: Result<Vec<Vec<StressRun>>> = (0..cases)
        .into_par_iter()
        .map(|i| {
            let case = StressCase::draw(seed.wrapping_add(i), &plates)?;
            let solved = case.impacts().map(|(kind, impact)| solve(case.seed, kind, impact)).collect();
            progress();
            Ok(solved)
        })
        .collect();
    let solved = solved?;
    let all = || solved.iter().flatten();
    let count = |kind: &str, holds: fn(&StressRun) -> bool| {
        all().filter(|solved| solved.kind == kind && holds(solved)).count() as u64
    };
    let seeds = |holds: fn(&StressRun) -> bool| {
        let mut seeds: Vec<u64> = all().filter(|solved| holds(solved)).map(|solved| solved.seed).collect();
        seeds.dedup();
        seeds
    };
    Ok(StressReport {
        schema_version: SCHEMA_VERSION,
        cases,
        seed,
        undecided: seeds(|s| s.undecided),
        compared: count(DRY, |s| s.compared),
        wet: count(WET, |_| true),
        wet_compared: count(WET, |s| s.compared),
        moving: count(MOVING, |_| true),
        moving_compared: count(MOVING, |s| s.compared),
        sweep: SweepReport {
            points: all().filter(|s| s.point.is_some()).count() as u64,
            unconverged: all().filter(|s| s.point == Some(SweepPoint::Unconverged)).count() as u64,
            wrong: seeds(|s| s.point == Some(SweepPoint::Wrong)),
        },
        beyond_model: seeds(|s| s.beyond_model),
        recontacts: count(DRY, |s| s.recontact),
        worst: worst(all()),
        failures: solved.into_iter().filter_map(|case| case.into_iter().find_map(|s| s.failure)).collect(),
    })
}

/// The worst of each value.
fn worst<'a>(solved: impl Iterator<Item = &'a StressRun>) -> BTreeMap<String, Worst> {
    let mut worst = BTreeMap::new();
    for solved in solved {
        for &(name, value) in &solved.values {
            let bound = BOUNDS.iter().find(|(n, _)| *n == name).map(|(_, bound)| *bound);
            let this = Worst { value, bound, seed: solved.seed };
            let entry = worst.entry(format!("{}{name}", solved.kind)).or_insert(this);
            if value > entry.value || entry.value.is_nan() {
                *entry = this;
            }
        }
    }
    worst
}

/// What one run gave.
#[derive(Default)]
struct StressRun {
    seed: u64,
    /// Beginning of its values' names.
    kind: &'static str,
    values: Vec<(&'static str, f64)>,
    compared: bool,
    undecided: bool,
    recontact: bool,
    beyond_model: bool,
    /// As a point of a sweep; `None` where there is no result.
    point: Option<SweepPoint>,
    failure: Option<Failure>,
}

/// A point of a sweep beside the result.
#[derive(Clone, Copy, PartialEq)]
enum SweepPoint {
    Right,
    Wrong,
    /// Its row says that it is not as exact as it should be.
    Unconverged,
}

/// Options of a run with the program's default tolerance.
fn options(impact: &StressImpact) -> Options {
    Options { tolerance: TOLERANCE, end_time: impact.end_time, ..Options::default() }
}

/// Solves an impact as the program does.
fn integrated(impact: &StressImpact, options: &Options) -> Result<Integration> {
    controlled(options, &impact.system, impact.forces.as_ref())
}

/// Solves an impact and looks at what has to hold.
fn solve(seed: u64, kind: &'static str, impact: &StressImpact) -> StressRun {
    let mut solved = StressRun { seed, kind, ..StressRun::default() };
    let broken = match integrated(impact, &options(impact)) {
        Ok(result) => {
            let point = integrated(impact, &all_within(SWEEP_ERROR, options(impact)));
            solved.point = point.ok().map(|point| compare_point(impact, &point, &result));
            judge(impact, &result, &mut solved)
        }
        Err(Error::BeyondModel(_)) => {
            solved.beyond_model = true;
            vec![]
        }
        Err(error) => vec![error.to_string()],
    };
    solved.failure = (!broken.is_empty()).then(|| Failure {
        seed,
        reason: broken.join("; "),
        case: impact.description.clone(),
    });
    solved
}

/// Adds the values of `result` to `solved`; gives what does not hold.
fn judge(impact: &StressImpact, result: &Integration, solved: &mut StressRun) -> Vec<String> {
    solved.recontact = result.contacts.iter().any(|c| c.contacts > 1);
    let peaks = result.contacts.map(|c| c.force_peak);
    if result.velocity.iter().chain(&peaks).any(|value| !value.is_finite()) {
        return vec![format!("not finite: velocities {:?}, force peaks {peaks:?}", result.velocity)];
    }
    solved.values.push(("momentum", result.momentum_residual));
    solved.values.push(("energy_gained", result.energy_gained.max(0.0)));
    solved.values.push(("steps", result.steps as f64));
    let mut broken = Vec::new();
    match independent::compare(impact, result) {
        IndependentCheck::TooExpensive => {}
        IndependentCheck::Undecided => (solved.compared, solved.undecided) = (true, true),
        IndependentCheck::Differences(found) => {
            solved.compared = true;
            solved.values.extend([
                ("velocity_difference", found.velocity),
                ("force_difference", found.force),
                ("efficiency_difference", found.efficiency),
                ("end_difference", found.end),
            ]);
            if let Some(theirs) = found.contacts {
                let ours = result.contacts.map(|c| c.contacts);
                broken.push(format!("{ours:?} contacts, in the independent solution {theirs:?}"));
            }
        }
    }
    broken.extend(BOUNDS.iter().filter_map(|(name, bound)| {
        let (_, value) = solved.values.iter().find(|(n, _)| n == name)?;
        // a value that is not a number breaks every bound
        (value.is_nan() || value > bound).then(|| format!("{name} {value:.2e} is above {bound:.0e}"))
    }));
    broken
}

/// Compares a sweep's `point` with the `result`; where they differ, with a solution whose error is certainly the smaller one.
fn compare_point(impact: &StressImpact, point: &Integration, result: &Integration) -> SweepPoint {
    if point.error_estimate.is_some_and(|error| error > SWEEP_ERROR) {
        return SweepPoint::Unconverged;
    }
    let agrees = |with: &Integration| {
        let found = Answer::from(point).differences(Answer::from(with), &impact.system);
        let within =
            [found.velocity, found.force, found.end].iter().all(|difference| *difference <= SWEEP_ERROR);
        within && found.contacts.is_none()
    };
    let careful = Options { tolerance: CAREFUL, ..options(impact) };
    let solved = || integrate(&impact.system, impact.forces.as_ref(), &careful);
    if agrees(result) || solved().is_ok_and(|careful| agrees(&careful)) {
        SweepPoint::Right
    } else {
        SweepPoint::Wrong
    }
}
