//! Where the plate bends around the inner body, which the model does not compute: contact is on the axis only.

use super::WetStepper;
use crate::dynamics::wet::FluidLoad;
use crate::error::{Error, Result};
use crate::fluid::film::Overlap;

/// Width of the film over that farther in, from which on it is closed there: what is inside has nowhere to flow.
const CLOSED: f64 = 0.1;

impl WetStepper<'_> {
    /// Why no step longer than `h` s meets the tolerance.
    pub(super) fn stalled(&self, h: f64) -> Error {
        // the film's law jumps where an overlap begins, however small
        let beyond = self.check_overlap(0.0, |_| true).and_then(|()| self.check_neck());
        beyond.err().unwrap_or_else(|| {
            Error::Solver(format!(
                "reduced model: the time step fell below {h:.1e} s at t = {:.6e} s without meeting the tolerance",
                self.time
            ))
        })
    }

    /// Looks whether the film encloses fluid.
    ///
    /// # Errors
    /// [`Error::BeyondModel`] if it does.
    pub(super) fn check_neck(&self) -> Result<()> {
        let closed = self.load.neck().filter(|neck| neck.width < CLOSED * neck.width_inside);
        let Some(neck) = closed else { return Ok(()) };
        Err(beyond_model(
            self.time,
            &format!(
                "at r = {:.2e} m the film between them is {:.1e} m wide, farther in {:.1e} m, and encloses fluid",
                neck.radius, neck.width, neck.width_inside
            ),
        ))
    }

    /// Looks whether the plate overlaps the inner body beside the axis, by what is `too_deep`, in the step of `h` s just tried.
    ///
    /// # Errors
    /// [`Error::BeyondModel`] if it does.
    pub(super) fn check_overlap(&self, h: f64, too_deep: impl Fn(&Overlap) -> bool) -> Result<()> {
        let mut overlaps = self.trial.loads.iter().filter_map(FluidLoad::overlap);
        let Some(overlap) = overlaps.find(too_deep) else { return Ok(()) };
        Err(beyond_model(
            self.time + h,
            &format!(
                "at r = {:.2e} m they overlap by {:.2e} m outside the contact on the axis",
                overlap.radius, overlap.depth
            ),
        ))
    }
}

/// At the `time` in s, since `what` is so.
fn beyond_model(time: f64, what: &str) -> Error {
    Error::BeyondModel(format!(
        "reduced model: at t = {time:.6e} s the plate bends around the inner body: {what}; the model assumes contact on the axis only: take a smaller tip radius, a stiffer plate, or remove `squeeze_film`"
    ))
}
