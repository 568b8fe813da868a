//! Newton's coefficient of restitution of a seat: the sphere falls into it along its axis, and its model says what comes back.

use super::SeatModel;
use super::candidates::ContactBody;
use super::integrate::{Options, integrate_from};
use super::system::{State, System};
use crate::error::{Error, Result};

/// Change of the coefficient from one step to half of it at which it is known.
const CERTAIN: f64 = 1e-3;
const HALVINGS: u32 = 10;
/// How far in m the tips are taken away from the seat, which rests and is alone with the sphere.
const AWAY: f64 = 1.0;

impl SeatModel {
    /// Speed after the fall over the `speed` in m/s before it. The other seat is this one's mirror image.
    ///
    /// # Errors
    /// [`Error::Solver`] if it does not converge, or the sphere lands beyond the nodes that the model has for it.
    pub fn restitution(&self, speed: f64) -> Result<f64> {
        let mut system = self.system().clone();
        for tip in &mut system.balls[1..] {
            tip.centre.z -= AWAY;
        }
        let mut step = self.first_step();
        let mut coarse = self.fall(&system, speed, step)?;
        for _ in 0..HALVINGS {
            step *= 0.5;
            let fine = self.fall(&system, speed, step)?;
            if (fine - coarse).abs() < CERTAIN {
                return Ok(fine);
            }
            coarse = fine;
        }
        Err(Error::Solver(format!("the fall on the seat does not converge with steps down to {step:e} s")))
    }

    fn fall(&self, system: &System, speed: f64, step: f64) -> Result<f64> {
        let axis = self.scene().seal_seat()?.ring().axis;
        let start = State {
            sphere_velocity: axis.map(|component| -speed * component),
            actuator_velocity: 0.0,
            ..system.start()
        };
        let result = integrate_from(
            system,
            start,
            &Options { step, end_time: None, history: false, tolerance: CERTAIN },
        )?;
        let of_sphere =
            system.candidates.iter().filter(|candidate| candidate.contact_body == ContactBody::Sphere);
        let zone = of_sphere.map(|candidate| candidate.offset).fold(0.0, f64::max);
        if result.tally.reach[0] >= zone {
            return Err(Error::Solver(format!(
                "a fall with {speed:.3} m/s presses the sphere over more of the seat than the model of its launch has: give `flight.restitution`"
            )));
        }
        let back: f64 = result.state.sphere_velocity.iter().zip(axis).map(|(v, axis)| v * axis).sum();
        Ok((back / speed).clamp(0.0, 1.0))
    }
}
