//! Numerical stability over random impacts: what has to hold for every scene that is admissible.
//!
//! Every case is drawn from its own seed, so that one command repeats it alone.

mod draw;

pub use draw::{Case, UnitPlates};

use crate::analytical::hertz::HertzImpact;
use crate::error::Result;
use crate::impact::SCHEMA_VERSION;
use crate::impact::assured::assured;
use crate::impact::explicit_runge_kutta::{self as runge_kutta, DORMAND_PRINCE_8, Equations, Tolerances};
use crate::impact::integrator::{Options, integrate};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Tolerance of the integrator under test: the program's default.
const TOLERANCE: f64 = 1e-7;
const VELOCITY_DIFFERENCE: &str = "velocity_difference";
const VELOCITY_BOUND: f64 = 1e-5;
/// Bounds of the invariants. Momentum relative to the initial one; energy gained relative to the initial one;
/// velocities against the independent solution relative to the impact speed.
const BOUNDS: [(&str, f64); 3] =
    [("momentum", 1e-10), ("energy_gained", 1e-6), (VELOCITY_DIFFERENCE, VELOCITY_BOUND)];
/// Evaluations times state entries that the independent solution of a case may cost; dearer cases (high modes, long
/// runs) go without one and are counted.
const REFERENCE_WORK: f64 = 3e6;
/// Relative tolerance of the independent solution, and that of a second one where the first contradicts.
const REFERENCE_TOLERANCES: [f64; 2] = [1e-11, 1e-13];

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
    /// differs from itself by more than a third of the bound (many contacts, each a kink that the method does not know of).
    pub undecided: Vec<u64>,
    /// Cases with more than one contact at the outer or the inner body.
    pub recontacts: u64,
    /// Cases that do not hold, in the order of their seeds.
    pub failures: Vec<Failure>,
    /// The worst of each invariant.
    pub worst: BTreeMap<&'static str, Worst>,
}

/// Result of one case.
struct Checked {
    seed: u64,
    values: Vec<(&'static str, f64)>,
    compared: bool,
    undecided: bool,
    recontact: bool,
    failure: Option<Failure>,
}

/// Runs the cases with the seeds `seed`, `seed + 1`, ...; `progress` is called after each.
///
/// # Errors
/// If the modes of a plate can't be computed; a case that fails is in the report.
pub fn run(cases: u64, seed: u64, progress: &(dyn Fn() + Sync)) -> Result<StressReport> {
    let plates = UnitPlates::default();
    let checked: Result<Vec<Checked>> = (0..cases)
        .into_par_iter()
        .map(|i| {
            let checked = check(&Case::draw(seed.wrapping_add(i), &plates)?);
            progress();
            Ok(checked)
        })
        .collect();
    let checked = checked?;
    let mut worst: BTreeMap<&'static str, Worst> = BTreeMap::new();
    for case in &checked {
        for &(name, value) in &case.values {
            let bound = BOUNDS.iter().find(|(n, _)| *n == name).map(|(_, bound)| *bound);
            let entry = worst.entry(name).or_insert(Worst { value, bound, seed: case.seed });
            if value > entry.value || entry.value.is_nan() {
                *entry = Worst { value, bound, seed: case.seed };
            }
        }
    }
    Ok(StressReport {
        schema_version: SCHEMA_VERSION,
        cases,
        seed,
        undecided: checked.iter().filter(|c| c.undecided).map(|c| c.seed).collect(),
        compared: checked.iter().filter(|c| c.compared).count() as u64,
        recontacts: checked.iter().filter(|c| c.recontact).count() as u64,
        failures: checked.into_iter().filter_map(|c| c.failure).collect(),
        worst,
    })
}

/// Runs one case and checks what has to hold.
fn check(case: &Case) -> Checked {
    let failure = |reason: String| Some(Failure { seed: case.seed, reason, case: case.description.clone() });
    let mut checked = Checked {
        seed: case.seed,
        values: Vec::new(),
        compared: false,
        undecided: false,
        recontact: false,
        failure: None,
    };
    let options = Options { tolerance: TOLERANCE, end_time: Some(case.end_time), sample_interval: None };
    let solve = |options: &Options| integrate(&case.system, options);
    let result = match assured(&options, case.system.speed, solve) {
        Ok(result) => result,
        Err(error) => {
            checked.failure = failure(error.to_string());
            return checked;
        }
    };
    checked.recontact = result.contacts.iter().any(|c| c.contacts > 1);
    let peaks = result.contacts.map(|c| c.force_peak);
    if result.velocity.iter().chain(&peaks).any(|value| !value.is_finite()) {
        checked.failure =
            failure(format!("not finite: velocities {:?}, force peaks {peaks:?}", result.velocity));
        return checked;
    }
    checked.values.push(("momentum", result.momentum_residual));
    checked.values.push(("energy_gained", result.energy_gained.max(0.0)));
    checked.values.push(("steps", result.steps as f64));
    if let Some((difference, undecided)) = difference(case, result.velocity) {
        (checked.compared, checked.undecided) = (true, undecided);
        if !undecided {
            checked.values.push((VELOCITY_DIFFERENCE, difference));
        }
    }
    let broken: Vec<String> = BOUNDS
        .iter()
        .filter_map(|(name, bound)| {
            let (_, value) = checked.values.iter().find(|(n, _)| n == name)?;
            // a value that is not a number breaks every bound
            (value.is_nan() || value > bound).then(|| format!("{name} {value:.2e} is above {bound:.0e}"))
        })
        .collect();
    if !broken.is_empty() {
        checked.failure = failure(broken.join("; "));
    }
    checked
}

/// Largest difference of `velocity` to an independent solution over the impact speed, and whether that solution is too
/// uncertain to tell; `None` if it would cost too much.
fn difference(case: &Case, velocity: [f64; 2]) -> Option<(f64, bool)> {
    let apart = |a: [f64; 2], b: [f64; 2]| {
        // max() would drop a value that is not a number
        let [first, second] = [0, 1].map(|i| (a[i] - b[i]).abs() / case.system.speed);
        if first >= second || first.is_nan() { first } else { second }
    };
    let [first, second] = REFERENCE_TOLERANCES;
    let quick = independent(case, first, REFERENCE_WORK)?;
    let difference = apart(quick, velocity);
    if difference <= VELOCITY_BOUND {
        return Some((difference, false));
    }
    let Some(careful) = independent(case, second, 20.0 * REFERENCE_WORK) else {
        return Some((difference, true));
    };
    let difference = apart(careful, velocity);
    Some((difference, difference > VELOCITY_BOUND && apart(careful, quick) > VELOCITY_BOUND / 3.0))
}

/// Velocities of outer and inner body in m/s at the end, by a Runge-Kutta method of order 8 that knows neither modes nor
/// contacts; `None` if that would take more than `work` (see [`REFERENCE_WORK`]).
fn independent(case: &Case, tolerance: f64, work: f64) -> Option<[f64; 2]> {
    let system = &case.system;
    let equations = Equations::new(system);
    let (hit, n) = (hertz(case), system.size());
    let fastest = system.oscillators.iter().map(|o| o.omega + 2.0 * o.alpha).fold(0.0, f64::max);
    let max_evaluations = (work / (n + 20) as f64) as u64;
    // a step of about 3/omega at most, 12 evaluations each
    if fastest * case.end_time / 3.0 * 12.0 > max_evaluations as f64 {
        return None;
    }
    let (mut state, scale) = equations.start(hit.duration());
    let tolerances = Tolerances { relative: tolerance, absolute: tolerance, max_evaluations };
    let rate = |y: &[f64], dy: &mut [f64]| equations.rate(y, dy);
    runge_kutta::integrate(&DORMAND_PRINCE_8, rate, &mut state, &scale, case.end_time, &tolerances)?;
    Some(equations.velocity(&state))
}

/// The outer body's impact on a rigid wall.
fn hertz(case: &Case) -> HertzImpact {
    let system = &case.system;
    HertzImpact { mass: system.masses[0], speed: system.speed, stiffness: system.laws[0].stiffness }
}
