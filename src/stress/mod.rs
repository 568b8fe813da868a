//! Numerical stability over random impacts: what has to hold for every scene that is admissible.
//!
//! Every case is drawn from its own seed, so that one command repeats it alone.

mod between;
mod draw;
mod independent;
#[cfg(test)]
mod tests;

pub use draw::{Case, UnitPlates, Wet};

use crate::dynamics::assured::assured;
use crate::dynamics::integrate;
use crate::dynamics::integration::{Integration, Options};
use crate::dynamics::system::System;
use crate::dynamics::wet::FluidForces;
use crate::error::{Error, Result};
use crate::result::SCHEMA_VERSION;
use independent::Comparison;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Tolerance of the integrator under test: the program's default.
const TOLERANCE: f64 = 1e-7;
/// Largest difference to the independent solution: of a final velocity, over the impact speed, and of a force peak, relative.
const DIFFERENCE_BOUND: f64 = 1e-5;
/// Bounds of the invariants. Momentum relative to the initial one; energy gained relative to the initial one;
/// velocities against the independent solution relative to the impact speed, force peaks to the independent ones.
const BOUNDS: [(&str, f64); 8] = [
    ("momentum", 1e-10),
    ("energy_gained", 1e-6),
    ("velocity_difference", DIFFERENCE_BOUND),
    ("force_difference", DIFFERENCE_BOUND),
    ("wet_momentum", 1e-10),
    ("wet_energy_gained", 1e-6),
    ("wet_velocity_difference", DIFFERENCE_BOUND),
    ("wet_force_difference", DIFFERENCE_BOUND),
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
    /// Seeds of those that the program refuses in a sentence: whose plate in the fluid bends around the inner body, or rattles
    /// or trembles between bodies far heavier than itself more often than it follows.
    pub beyond_model: Vec<u64>,
    /// Cases with more than one contact at the outer or the inner body.
    pub recontacts: u64,
    /// Cases that do not hold, in the order of their seeds.
    pub failures: Vec<Failure>,
    /// The worst of each invariant.
    pub worst: BTreeMap<&'static str, Worst>,
}

/// What the program makes of each case, to compare two programs bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StressResults {
    /// Version of the document.
    pub schema_version: u32,
    /// Number of cases.
    pub cases: u64,
    /// Seed of the first; the others follow.
    pub seed: u64,
    /// In the order of the seeds.
    pub results: Vec<CaseResult>,
}

/// Result of a case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseResult {
    /// Seed of the case.
    pub seed: u64,
    /// Without a fluid.
    pub dry: CaseMotion,
    /// In the fluid, if the case has one.
    pub wet: Option<CaseMotion>,
}

/// How an impact ends, of outer and inner body, or why it is not solved.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum CaseMotion {
    /// It is solved.
    Solved {
        /// Final velocities in m/s.
        velocity: [f64; 2],
        /// Force peaks in N.
        force_peak: [f64; 2],
        /// Numbers of contacts.
        contacts: [u32; 2],
        /// Steps of the time integration.
        steps: u64,
        /// Relative to the initial momentum.
        momentum_residual: f64,
        /// Relative to the initial energy.
        energy_gained: f64,
    },
    /// It failed or was refused, with the sentence that says why.
    Unsolved(String),
}

/// Runs the cases as [`run`] does, without comparing them with an independent solution.
///
/// # Errors
/// If the modes of a plate can't be computed.
pub fn results(cases: u64, seed: u64, progress: &(dyn Fn() + Sync)) -> Result<StressResults> {
    let plates = UnitPlates::default();
    let result = |i: u64| {
        let case = Case::draw(seed.wrapping_add(i), &plates)?;
        let motion = |system, fluid| CaseMotion::of(integrated(system, fluid, case.end_time));
        let wet = case.wet.as_ref().map(|wet| motion(&wet.system, wet.forces.as_ref()));
        progress();
        Ok(CaseResult { seed: case.seed, dry: motion(&case.system, None), wet })
    };
    let results: Result<_> = (0..cases).into_par_iter().map(result).collect();
    Ok(StressResults { schema_version: SCHEMA_VERSION, cases, seed, results: results? })
}

impl CaseMotion {
    fn of(integrated: Result<Integration>) -> Self {
        match integrated {
            Ok(result) => Self::Solved {
                velocity: result.velocity,
                force_peak: result.contacts.map(|contact| contact.force_peak),
                contacts: result.contacts.map(|contact| contact.contacts),
                steps: result.steps,
                momentum_residual: result.momentum_residual,
                energy_gained: result.energy_gained,
            },
            Err(error) => Self::Unsolved(error.to_string()),
        }
    }
}

/// Result of one case.
struct Checked {
    seed: u64,
    values: Vec<(&'static str, f64)>,
    compared: bool,
    undecided: bool,
    recontact: bool,
    wet: bool,
    wet_compared: bool,
    beyond_model: bool,
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
        wet: checked.iter().filter(|c| c.wet).count() as u64,
        wet_compared: checked.iter().filter(|c| c.wet_compared).count() as u64,
        beyond_model: checked.iter().filter(|c| c.beyond_model).map(|c| c.seed).collect(),
        recontacts: checked.iter().filter(|c| c.recontact).count() as u64,
        failures: checked.into_iter().filter_map(|c| c.failure).collect(),
        worst,
    })
}

/// Names of the values of a run, in the order of `BOUNDS`, and that of its steps.
const DRY: [&str; 5] = ["momentum", "energy_gained", "velocity_difference", "force_difference", "steps"];
const WET: [&str; 5] =
    ["wet_momentum", "wet_energy_gained", "wet_velocity_difference", "wet_force_difference", "wet_steps"];

/// Runs one case and checks what has to hold.
fn check(case: &Case) -> Checked {
    let dry = solve(&case.system, None, case.end_time, &DRY);
    let mut checked = Checked {
        seed: case.seed,
        compared: dry.compared,
        undecided: dry.undecided,
        recontact: dry.recontact,
        wet: case.wet.is_some(),
        wet_compared: false,
        beyond_model: dry.beyond_model,
        failure: dry.failure(case.seed, &case.description),
        values: dry.values,
    };
    if let Some(wet) = &case.wet {
        let solved = solve(&wet.system, wet.forces.as_ref(), case.end_time, &WET);
        checked.wet_compared = solved.compared;
        checked.beyond_model |= solved.beyond_model;
        checked.undecided |= solved.undecided;
        let description = format!("{}, {}", case.description, wet.description);
        checked.failure = checked.failure.or(solved.failure(case.seed, &description));
        checked.values.extend(solved.values);
    }
    checked
}

/// What one run gave.
#[derive(Default)]
struct Solved {
    values: Vec<(&'static str, f64)>,
    compared: bool,
    undecided: bool,
    recontact: bool,
    beyond_model: bool,
    reason: Option<String>,
}

impl Solved {
    fn failure(&self, seed: u64, case: &str) -> Option<Failure> {
        self.reason.clone().map(|reason| Failure { seed, reason, case: case.to_owned() })
    }
}

/// Solves an impact until `end_time` s as the program does.
fn integrated(system: &System, fluid: Option<&FluidForces>, end_time: f64) -> Result<Integration> {
    let options = Options { tolerance: TOLERANCE, end_time: Some(end_time), ..Options::default() };
    assured(&options, system, |options| integrate(system, fluid, options))
}

/// Solves an impact until `end_time` s and looks at what has to hold; `names` are those of its values.
fn solve(system: &System, fluid: Option<&FluidForces>, end_time: f64, names: &[&'static str; 5]) -> Solved {
    match integrated(system, fluid, end_time) {
        Ok(result) => judge(system, fluid, end_time, names, &result),
        Err(Error::BeyondModel(_)) => Solved { beyond_model: true, ..Solved::default() },
        Err(error) => Solved { reason: Some(error.to_string()), ..Solved::default() },
    }
}

fn judge(
    system: &System,
    fluid: Option<&FluidForces>,
    end_time: f64,
    names: &[&'static str; 5],
    result: &Integration,
) -> Solved {
    let mut solved =
        Solved { recontact: result.contacts.iter().any(|c| c.contacts > 1), ..Solved::default() };
    let peaks = result.contacts.map(|c| c.force_peak);
    if result.velocity.iter().chain(&peaks).any(|value| !value.is_finite()) {
        solved.reason = Some(format!("not finite: velocities {:?}, force peaks {peaks:?}", result.velocity));
        return solved;
    }
    let [momentum, energy, velocity, force, steps] = *names;
    solved.values.push((momentum, result.momentum_residual));
    solved.values.push((energy, result.energy_gained.max(0.0)));
    solved.values.push((steps, result.steps as f64));
    match independent::compare(system, fluid, end_time, result, DIFFERENCE_BOUND) {
        Comparison::TooDear => {}
        Comparison::Undecided => (solved.compared, solved.undecided) = (true, true),
        Comparison::Differences(values) => {
            solved.compared = true;
            solved.values.extend([velocity, force].into_iter().zip(values));
        }
    }
    let broken: Vec<String> = BOUNDS
        .iter()
        .filter_map(|(name, bound)| {
            let (_, value) = solved.values.iter().find(|(n, _)| n == name)?;
            // a value that is not a number breaks every bound
            (value.is_nan() || value > bound).then(|| format!("{name} {value:.2e} is above {bound:.0e}"))
        })
        .collect();
    if !broken.is_empty() {
        solved.reason = Some(broken.join("; "));
    }
    solved
}
