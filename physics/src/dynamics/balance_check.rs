//! Whether a run's ledger balances: a reduced model that makes or loses energy or momentum has no result.

use crate::error::{Error, Result};

/// Residual that rounding errors alone may leave in a long run.
const ROUNDING: f64 = 1e-9;
/// Residual, in tolerances, from which on a result is refused, and the least and the most that this may be.
const REFUSED: f64 = 100.0;
const REFUSED_RANGE: (f64, f64) = (0.01, 0.1);

/// Judges the ledger of a run with the relative error `tolerance` asked of its time integration: residuals of energy and
/// momentum, each over its value at the start. The answer is a warning if one of them exceeds the tolerance.
///
/// # Errors
/// [`Error::Solver`] if one exceeds a hundred tolerances (at least 1 %, at most 10 %) or is not a number.
pub fn balance_check(energy: f64, momentum: f64, tolerance: f64) -> Result<Option<String>> {
    let (least, most) = REFUSED_RANGE;
    let refused = (REFUSED * tolerance).clamp(least, most).max(tolerance);
    let (name, residual) = if momentum > energy { ("momentum", momentum) } else { ("energy", energy) };
    let unbalanced =
        format!("the balance of {name} is not closed: the residual is {residual:.1e} of the initial value");
    // false for a value that is not a number
    let within = |bound: f64| energy <= bound && momentum <= bound;
    if !within(refused) {
        return Err(Error::Solver(format!(
            "reduced model: {unbalanced}, more than {refused:.1e}; take a smaller --tolerance, or another model or number of modes"
        )));
    }
    Ok((!within(tolerance.max(ROUNDING)))
        .then(|| format!("{unbalanced}, more than the tolerance of {tolerance:.0e} of the time integration")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_balance_within_the_tolerance_has_no_warning() {
        assert_eq!(balance_check(9e-8, 2e-15, 1e-7).unwrap(), None);
        assert_eq!(balance_check(5e-10, 5e-10, 1e-12).unwrap(), None);
    }

    #[test]
    fn a_balance_beyond_the_tolerance_has_a_warning_with_its_name() {
        for (energy, momentum, tolerance, name) in
            [(6e-3, 1e-15, 1e-3, "energy"), (1e-8, 3e-6, 1e-7, "momentum"), (2e-9, 0.0, 1e-12, "energy")]
        {
            let warning = balance_check(energy, momentum, tolerance).unwrap().unwrap();
            let worst = format!("{:.1e}", energy.max(momentum));
            assert!(warning.contains(name) && warning.contains(&worst), "{warning}");
        }
    }

    #[test]
    fn a_balance_far_beyond_it_or_without_a_number_is_no_result() {
        for (energy, momentum, tolerance) in [
            (0.2, 0.0, 1e-3),
            (0.011, 0.0, 1e-7),
            (0.0, 0.02, 1e-5),
            (f64::NAN, 0.0, 1e-3),
            (0.0, f64::NAN, 1e-3),
        ] {
            let error = balance_check(energy, momentum, tolerance).unwrap_err();
            assert!(matches!(error, Error::Solver(_)), "{error}");
        }
        // who asks for no more than 50 % gets it
        assert!(balance_check(0.4, 0.0, 0.5).unwrap().is_none());
    }
}
