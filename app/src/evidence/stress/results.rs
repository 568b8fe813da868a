//! The result of every case bit for bit.

use super::kinds::{StressCase, StressImpact, UnitPlateModes};
use super::{integrated, options};
use crate::error::Result;
use crate::result::SCHEMA_VERSION;
use rayon::prelude::*;
use serde::Serialize;

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
    /// With other bodies, if the case has such.
    pub moving: Option<CaseMotion>,
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

/// Runs the cases as [`super::run`] does, without comparing them with an independent solution.
///
/// # Errors
/// If the modes of a plate can't be computed.
pub fn results(cases: u64, seed: u64, progress: &(dyn Fn() + Sync)) -> Result<StressResults> {
    let plates = UnitPlateModes::default();
    let result = |i: u64| {
        let case = StressCase::draw(seed.wrapping_add(i), &plates)?;
        let of = |impact: &Option<StressImpact>| impact.as_ref().map(CaseMotion::of);
        progress();
        Ok(CaseResult {
            seed: case.seed,
            dry: CaseMotion::of(&case.dry),
            wet: of(&case.wet),
            moving: of(&case.moving),
        })
    };
    let results: Result<_> = (0..cases).into_par_iter().map(result).collect();
    Ok(StressResults { schema_version: SCHEMA_VERSION, cases, seed, results: results? })
}

impl CaseMotion {
    fn of(impact: &StressImpact) -> Self {
        match integrated(impact, &options(impact)) {
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
