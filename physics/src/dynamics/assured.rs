//! Impacts of many contacts: solved again with a smaller tolerance until the result stands.
//!
//! Every touch and release amplifies what was wrong before it: when it comes a little later, or grazes where it would have
//! missed, everything after it is another. A bound on the error of single steps can't know that. Two solutions with
//! tolerances apart can: their difference is the error of the less exact of the two.

use super::integrator::{Integration, Options};
use crate::error::Result;

/// Touches of both contacts from which on a result is checked. Of random impacts with fewer, one in a thousand is off by
/// more than ten times the tolerance, none by more than a hundred times.
const MANY_TOUCHES: u32 = 4;
/// Factor between the tolerances of two solutions.
const TIGHTER: f64 = 0.1;
/// Tightest tolerance that is tried.
const TIGHTEST: f64 = 1e-12;
/// Tolerances above this ask for a rough answer.
const ROUGH: f64 = 1e-4;
/// Difference of the velocities that is in order, in tolerances.
pub const ENOUGH: f64 = 10.0;

/// Integrates by `run` with smaller and smaller tolerances until the velocities after an impact at `speed` m/s differ by
/// at most ten times the tolerance of `options`, if there are many touches. The last one is the result, its
/// [`Integration::error_estimate`] the difference to the one before.
///
/// # Errors
/// Those of `run` at the tolerance asked for.
pub fn assured(
    options: &Options,
    speed: f64,
    run: impl Fn(&Options) -> Result<Integration>,
) -> Result<Integration> {
    let mut best = run(options)?;
    if options.tolerance > ROUGH || touches(&best) < MANY_TOUCHES {
        return Ok(best);
    }
    let mut options = *options;
    let enough = ENOUGH * options.tolerance;
    while options.tolerance * TIGHTER >= TIGHTEST {
        options.tolerance *= TIGHTER;
        let Ok(next) = run(&options) else { break };
        let change = difference(&best, &next) / speed;
        best = Integration { error_estimate: Some(change), ..next };
        if change <= enough {
            break;
        }
    }
    Ok(best)
}

fn touches(result: &Integration) -> u32 {
    result.contacts.iter().map(|c| c.contacts).sum()
}

/// Largest difference of a velocity in m/s.
fn difference(a: &Integration, b: &Integration) -> f64 {
    (0..2).map(|i| (a.velocity[i] - b.velocity[i]).abs()).fold(0.0, f64::max)
}
