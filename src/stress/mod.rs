//! Numerical stability over random impacts: what has to hold for every scene that is admissible.
//!
//! Every case is drawn from its own seed, so that one command repeats it alone.

mod between;
mod draw;
mod independent;

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
    /// differs from itself by more than a third of the bound (many contacts, each a kink that the method does not know of).
    pub undecided: Vec<u64>,
    /// Cases that were solved in a fluid as well.
    pub wet: u64,
    /// Of these, compared with an independent solution.
    pub wet_compared: u64,
    /// Seeds of those whose plate in the fluid bends around the inner body, which the program refuses to compute.
    pub beyond_model: Vec<u64>,
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
        beyond_model: false,
        failure: dry.failure(case.seed, &case.description),
        values: dry.values,
    };
    if let Some(wet) = &case.wet {
        let solved = solve(&wet.system, wet.forces.as_ref(), case.end_time, &WET);
        checked.wet_compared = solved.compared;
        checked.beyond_model = solved.beyond_model;
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

/// Solves an impact until `end_time` s as the program does, and looks at what has to hold; `names` are those of its values.
fn solve(system: &System, fluid: Option<&FluidForces>, end_time: f64, names: &[&'static str; 5]) -> Solved {
    let options = Options { tolerance: TOLERANCE, end_time: Some(end_time), ..Options::default() };
    match assured(&options, system, |options| integrate(system, fluid, options)) {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn draw(seed: u64) -> Case {
        Case::draw(seed, &UnitPlates::default()).unwrap()
    }

    fn options(case: &Case, tolerance: f64) -> Options {
        Options { tolerance, end_time: Some(case.end_time), ..Options::default() }
    }

    /// Largest difference of a velocity to the solution at the tightest tolerance, over the impact speed.
    fn error(case: &Case, result: &Integration) -> f64 {
        let exact = integrate(&case.system, None, &options(case, 1e-12)).unwrap();
        let apart = |i: usize| (result.velocity[i] - exact.velocity[i]).abs() / case.system.speed;
        apart(0).max(apart(1))
    }

    /// The ninth touch of the light inner body lasts 0.2 % of a contact, between two Gauss points of a step.
    #[test]
    fn a_short_touch_is_not_passed() {
        let case = draw(242_304);
        let result = integrate(&case.system, None, &options(&case, 1e-7)).unwrap();
        assert_eq!(result.contacts[1].contacts, 9);
        assert!(error(&case, &result) < 1e-6, "{:e}", error(&case, &result));
    }

    /// Ten contacts amplify the errors of the steps a thousand times; the estimate sees it, and smaller steps mend it.
    #[test]
    fn amplified_errors_are_estimated_and_mended() {
        let case = draw(236_931);
        let (system, asked) = (&case.system, options(&case, 1e-7));
        let plain = integrate(system, None, &asked).unwrap();
        assert!(error(&case, &plain) > 1e-5 && plain.error_estimate.is_none());
        let sure = assured(&asked, system, |options| integrate(system, None, options)).unwrap();
        let estimate = sure.error_estimate.unwrap();
        assert!(error(&case, &sure) <= estimate && estimate <= 1e-6, "{estimate:e}");
    }

    /// 106 lightly damped modes: of 127 steps none is wrong by much, but together the inner peak is 1.8e-5 off.
    #[test]
    fn defects_of_many_steps_add_up() {
        let case = draw(30_000_004_755);
        let (system, asked) = (&case.system, options(&case, 1e-7));
        let exact = integrate(system, None, &options(&case, 1e-11)).unwrap();
        let apart = |result: &Integration| {
            let peaks = [result, &exact].map(|result| result.contacts.map(|c| c.force_peak));
            crate::dynamics::assured::differences(system, [result.velocity, exact.velocity], peaks)[1]
        };
        assert!(apart(&integrate(system, None, &asked).unwrap()) > 1e-5);
        let sure = assured(&asked, system, |options| integrate(system, None, options)).unwrap();
        assert!(apart(&sure) < 1e-6, "{:e}", apart(&sure));
    }

    /// The inner body has a thousandth of the outer one's mass: an error that the outer one's scale permits is a hundred thousandth of
    /// its force.
    #[test]
    fn the_independent_solution_knows_light_bodies() {
        for (seed, name) in [(9_200_000_494, "force_difference"), (9_100_000_592, "wet_force_difference")] {
            let report = run(1, seed, &|| ()).unwrap();
            assert!(report.worst[name].value < 1e-6, "{seed}: {:?}", report.worst[name]);
        }
    }

    /// 113 damped modes, of which every step makes a little energy.
    #[test]
    fn energy_made_by_many_steps_is_bounded() {
        let case = draw(100_019);
        let result = integrate(&case.system, None, &options(&case, 1e-7)).unwrap();
        assert!(result.energy_gained < 1e-6, "{:e}", result.energy_gained);
    }

    /// The film lies over the waves of a soft plate: with its resistance against the uniform closing speed alone the iteration
    /// settles for steps a thousand times shorter.
    #[test]
    fn a_stiff_film_over_a_soft_plate_costs_few_steps() {
        let case = draw(1_000_823);
        let wet = case.wet.as_ref().unwrap();
        let solve =
            |tolerance| integrate(&wet.system, wet.forces.as_ref(), &options(&case, tolerance)).unwrap();
        let (result, finer) = (solve(1e-7), solve(1e-9));
        assert!(result.steps < 3000, "{} steps", result.steps);
        assert!(result.momentum_residual < 1e-10 && result.energy_gained < 1e-6);
        for i in 0..2 {
            assert!((result.velocity[i] - finer.velocity[i]).abs() < 1e-6 * case.system.speed);
        }
    }

    /// The film's law jumps where the plate overlaps a flat inner body first beside the axis.
    #[test]
    fn a_plate_that_bends_around_the_inner_body_is_refused() {
        let case = draw(4_000_352);
        let wet = case.wet.as_ref().unwrap();
        let solved = integrate(&wet.system, wet.forces.as_ref(), &options(&case, 1e-7));
        assert!(matches!(solved, Err(Error::BeyondModel(_))), "{solved:?}");
        assert_eq!(run(1, 4_000_352, &|| ()).unwrap().beyond_model, [4_000_352]);
    }

    /// Five hundred contacts of a light inner body, each of which makes a little energy; and one whose momentum is a thousandth of
    /// the outer body's.
    #[test]
    fn light_inner_bodies_in_a_fluid_hold() {
        for seed in [4_001_934, 2_000_704] {
            let report = run(1, seed, &|| ()).unwrap();
            assert_eq!((report.failures, report.wet), (vec![], 1), "{seed}");
        }
    }

    /// A peak between two Gauss points, of which the defect of its step is the error; and the rigid motion of a free plate, which takes the
    /// film's momentum.
    #[test]
    fn force_peaks_and_the_momentum_of_films_are_within_their_bounds() {
        for seed in [5_000_054_985, 5_000_062_046] {
            assert_eq!(run(1, seed, &|| ()).unwrap().failures, [], "{seed}");
        }
    }

    /// From a guess in which the inner contact is open the first sweep closes it, far from where it settles.
    #[test]
    fn a_sweep_across_a_touch_does_not_count_as_settled() {
        assert_eq!(run(1, 7_000_019_122, &|| ()).unwrap().failures, []);
    }

    /// While the outer contact opens, the inner force turns long before its approach does.
    #[test]
    fn the_peak_of_a_force_that_the_other_contact_changes_is_found() {
        assert_eq!(run(1, 8_000_000_530, &|| ()).unwrap().failures, []);
    }

    /// Strong damping lets the inner approach follow the outer force's polynomials, whose defect is not the inner one's; steps of
    /// one length at two tolerances would agree on the wrong peak.
    #[test]
    fn two_tolerances_do_not_take_the_same_steps() {
        assert_eq!(run(1, 4_100_005_135, &|| ()).unwrap().failures, []);
    }

    /// The light inner body comes to rest on the plate with forces of which the outer one's rounding is a million times larger.
    #[test]
    fn a_force_far_below_the_others_is_solved_for_itself() {
        assert_eq!(run(1, 770_000_323, &|| ()).unwrap().failures, []);
    }

    /// Vibrations bring the outer body and the plate together once more, between the points of a step.
    #[test]
    fn a_short_touch_in_a_fluid_is_not_passed() {
        let report = run(1, 20_105_727, &|| ()).unwrap();
        assert_eq!((report.failures, report.wet_compared), (vec![], 1));
    }

    /// The film of a soft plate that bends up to the inner body's rim grows to millions of newtons, and the rounding of its work
    /// with it.
    #[test]
    fn a_film_that_closes_at_the_rim_is_refused_and_does_not_stall() {
        let report = run(1, 78_838, &|| ()).unwrap();
        assert_eq!((report.failures, report.beyond_model), (vec![], vec![78_838]));
    }

    /// What never transmits anything has no force peak to be relatively right about.
    #[test]
    fn a_contact_that_transmits_nothing_is_compared() {
        let report = run(1, 770_000_003, &|| ()).unwrap();
        assert_eq!((report.failures, report.wet_compared), (vec![], 1));
    }

    #[test]
    fn dry_and_wet_cases_hold() {
        let report = run(24, 700_000, &|| ()).unwrap();
        assert_eq!(report.failures, []);
        assert!(report.compared > 5 && report.wet > 0, "{} compared, {} wet", report.compared, report.wet);
        assert!(report.worst.contains_key("wet_momentum"));
    }

    /// A plate so light that both forces are nearly one: its peak is off by what the step's polynomials are.
    #[test]
    fn the_peak_under_a_light_plate_is_as_exact_as_any() {
        let report = run(1, 9_800_011_810, &|| ()).unwrap();
        assert!(report.worst["force_difference"].value < 5e-6, "{:?}", report.worst["force_difference"]);
    }
}
