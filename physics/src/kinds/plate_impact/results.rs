//! What the results of an impact through a plate are called, and the views of them that the kind itself works with.

use crate::dynamics::StopReason;
use crate::dynamics::integration::Integration;
pub use crate::dynamics::recorder::CURVES;
use crate::dynamics::system::System;
use crate::error::{Error, Result};
use crate::result::{CUT, History, quantities};

quantities! {
    /// Results of an impact through a plate (scene kind `plate-impact`), all determined.
    PlateQuantities {
        /// Eq. (1): kinetic energy of the inner body after the last contact over that of the outer before the first.
        efficiency: f64, "1";
        /// Velocity of the outer body after the last contact, m/s, signed along z.
        outer_velocity_final: f64, "m/s", of outer_velocity;
        /// Velocity of the inner body after the last contact, m/s, signed along z.
        inner_velocity_final: f64, "m/s", of inner_velocity;
        /// Largest force between outer body and plate, N.
        outer_force_peak: f64, "N", of outer_force;
        /// Largest force between plate and inner body, N.
        inner_force_peak: f64, "N", of inner_force;
        /// Time of the last release of the outer body, s.
        outer_contact_end: f64, "s";
        /// Time of the last release of the inner body, s.
        inner_contact_end: f64, "s";
        /// Number of separate contacts of the outer body.
        outer_contacts: u32, "1";
        /// Number of separate contacts of the inner body.
        inner_contacts: u32, "1";
        /// First eigenfrequency of the plate that is not a rigid motion, Hz.
        first_frequency: f64, "Hz";
    }
}

impl PlateQuantities {
    /// Length of the inner contact, through which the energy passes, over half the first period of the plate
    /// (section 4.1). The outer sphere may touch again later; that does not reach the inner one any more.
    pub fn contact_over_half_period(&self) -> f64 {
        self.inner_contact_end * 2.0 * self.first_frequency
    }
}

/// Motion of one body along z. Shapes (samples).
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    /// Displacement in m since t = 0, signed along z.
    pub displacement: &'a [f64],
    /// Velocity in m/s, signed along z.
    pub velocity: &'a [f64],
}

/// The curves of an impact through a plate.
#[derive(Debug, Clone, Copy)]
pub struct PlateCurves<'a> {
    /// Time in s since the first touch. Shape (samples).
    pub time: &'a [f64],
    /// Outer body (mass average).
    pub outer: Motion<'a>,
    /// Centre of the plate (mean of both faces).
    pub plate: Motion<'a>,
    /// Inner body (mass average).
    pub inner: Motion<'a>,
    /// Force between outer body and plate in N, positive in compression. Shape (samples).
    pub outer_force: &'a [f64],
    /// Force between plate and inner body in N, positive in compression. Shape (samples).
    pub inner_force: &'a [f64],
}

impl<'a> PlateCurves<'a> {
    /// The typed view of `history`; `None` if a curve is not there.
    pub fn of(history: &'a History) -> Option<Self> {
        let motion = |displacement: &str, velocity: &str| {
            Some(Motion { displacement: history.curve(displacement)?, velocity: history.curve(velocity)? })
        };
        Some(PlateCurves {
            time: &history.time,
            outer: motion("outer_displacement", "outer_velocity")?,
            plate: motion("plate_displacement", "plate_velocity")?,
            inner: motion("inner_displacement", "inner_velocity")?,
            outer_force: history.curve("outer_force")?,
            inner_force: history.curve("inner_force")?,
        })
    }
}

/// The physical results of an integration of `system`.
///
/// # Errors
/// [`Error::Solver`] if the run was cut during a contact.
pub(super) fn quantities(system: &System, result: &Integration) -> Result<PlateQuantities> {
    if result.stop == StopReason::Cut {
        Err(Error::Solver(format!("reduced model: {CUT}")))
    } else {
        Ok(values(system, result))
    }
}

/// The values at the end of an integration of `system`, wherever that is.
pub(super) fn values(system: &System, result: &Integration) -> PlateQuantities {
    let energy = |i: usize| 0.5 * system.masses[i] * result.velocity[i].powi(2);
    PlateQuantities {
        efficiency: energy(1) / system.initial_energy(),
        outer_velocity_final: result.velocity[0],
        inner_velocity_final: result.velocity[1],
        outer_force_peak: result.contacts[0].force_peak,
        inner_force_peak: result.contacts[1].force_peak,
        outer_contact_end: result.contacts[0].end,
        inner_contact_end: result.contacts[1].end,
        outer_contacts: result.contacts[0].contacts,
        inner_contacts: result.contacts[1].contacts,
        first_frequency: system.first_frequency,
    }
}
