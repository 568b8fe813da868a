//! What a run of the reduced seal seat gives.

use super::contact::Work;
use super::system::State;
use crate::dynamics::StopReason;

/// What is known at the end of a step; of whole bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// s.
    pub time: f64,
    /// m, x and z.
    pub sphere: [f64; 2],
    /// m/s, x and z.
    pub sphere_velocity: [f64; 2],
    /// Force on the sphere in N, x and z.
    pub sphere_force: [f64; 2],
    /// m.
    pub actuator: f64,
    /// m/s.
    pub actuator_velocity: f64,
    /// N, positive in compression.
    pub actuator_force: f64,
}

/// What a run adds up; of whole bodies.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tally {
    /// Largest forces in N of sphere (magnitude) and actuator.
    pub force_peak: [f64; 2],
    /// Times in s of the last release of sphere and actuator.
    pub contact_end: [f64; 2],
    /// Impulses of the normal forces on the flanks at the -x and the +x side of the seat's axis in N s.
    pub flank_impulse: [f64; 2],
    /// Largest distance in m of loaded candidates from where sphere and tips touch first.
    pub reach: [f64; 2],
    /// Time steps.
    pub steps: u64,
    /// Impulse along z on the seat in N s, from the nodal forces.
    pub(super) seat_impulse: f64,
    /// Energy in J that the half seat's modes have lost.
    pub(super) modal_loss: f64,
    /// Magnitudes of the forces of sphere and actuator at the last sample and the one before.
    pub(super) before: [[f64; 2]; 2],
}

/// Result of a run; of whole bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct Integration {
    /// Why the run ended.
    pub stop: StopReason,
    /// State at the end.
    pub state: State,
    /// What was added up.
    pub tally: Tally,
    /// |energy at the end - energy at the start| over the energy at the start.
    pub energy_residual: f64,
    /// Momentum of sphere and actuator that the impulse on the seat does not account for, over that at the start.
    pub momentum_residual: f64,
    /// Energy in J that the seat has lost to relaxation.
    pub relaxed: f64,
    /// Energy in J that friction has dissipated.
    pub rubbed: f64,
    /// End of the run in s.
    pub time: f64,
    /// Samples, if asked for.
    pub samples: Vec<Sample>,
    /// What the contact forces have cost.
    pub work: Work,
}
