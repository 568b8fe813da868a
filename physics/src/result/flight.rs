//! What becomes of the sphere after the impact, and how hard the valve can be shaken.

use crate::flight::{Landing, Launch, Seat};
use serde::{Deserialize, Serialize};

/// The flight after the impact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FlightSummary {
    /// The seat the sphere comes to rest in.
    pub seat: Seat,
    /// Time in s after the launch at which that is certain.
    pub time: f64,
    /// Least relative change of the launch's speed that ends in another seat; `None` if none up to a half does.
    pub margin: Option<f64>,
    /// Share of the launches in the scene's bands that end in the other seat.
    pub share: f64,
    /// The launches whose share that is, and where each ends; not part of the JSON document.
    #[serde(skip)]
    pub landings: Vec<Landing>,
    /// Least speed in m/s that can shift, by the saddle between the seats: sqrt(2 dU / m).
    pub least_speed: f64,
    /// Newton's coefficient of restitution, as given or as computed.
    pub restitution: f64,
    /// The launch, from the impact's own result.
    pub launch: Launch,
    /// Why it is in neither seat, in a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// Least accelerations of the valve in m/s^2: amplitudes of a wave, the largest magnitude of a record that is scaled as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct VibrationSummary {
    /// At which the sphere comes off a side of its seat; `None` if this direction presses it in.
    pub unseats: Option<f64>,
    /// At which it passes the saddle; `None` if none is found.
    pub shifts: Option<f64>,
    /// What the wave needs at least by energy: sqrt(2 dU / m) over the integral of its magnitude.
    pub energy_bound: f64,
}
