//! The way of a run through time, whatever takes the steps: in a dry impact, in a film, with memory, or at a seal seat.

use crate::error::{Error, Result};

/// What takes the steps of a run.
pub(crate) trait Stepper {
    /// Steps after which a run counts as endless.
    const MOST_STEPS: u64;

    /// Present time in s.
    fn time(&self) -> f64;

    /// Time in s from which on the run is over; infinite if it ends when no further contact is possible.
    fn end(&self) -> f64;

    /// Steps so far.
    fn steps(&self) -> u64;

    /// Goes on by a step, a few of them or a flight; `false` if no further contact is possible.
    ///
    /// # Errors
    /// If no step meets the tolerance, or the model does not hold.
    fn advance(&mut self) -> Result<bool>;

    /// That there is no end after [`Stepper::MOST_STEPS`].
    fn endless(&self) -> Error {
        Error::Solver(format!(
            "reduced model: no end after {} steps, at t = {:.6e} s; set `run.end_time`",
            Self::MOST_STEPS,
            self.time()
        ))
    }
}

/// Takes steps until the end time, or until no further contact is possible.
///
/// # Errors
/// Those of the steps; [`Stepper::endless`].
pub(crate) fn run(stepper: &mut impl Stepper) -> Result<()> {
    fn goes_on<S: Stepper>(stepper: &mut S) -> Result<bool> {
        if stepper.steps() > S::MOST_STEPS {
            return Err(stepper.endless());
        }
        Ok(stepper.time() < stepper.end() && stepper.advance()?)
    }
    while goes_on(stepper)? {}
    Ok(())
}

/// Why a run is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopReason {
    /// The bodies have parted: no further contact is possible, or none was when the run's end time came.
    Parted,
    /// The end time came while bodies touched: what the impact comes to is open.
    Cut,
    /// All that goes on is a stack that presses on the plate, which the inner body has left for good.
    Pressed,
}

impl StopReason {
    /// Of a run that ends with `in_contact` bodies.
    pub(crate) fn of(in_contact: bool) -> Self {
        if in_contact { Self::Cut } else { Self::Parted }
    }
}
