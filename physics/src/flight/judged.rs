//! The verdict on a launch, with its margin and its share over the scatter of the launch.

use super::landscape::Landscape;
use super::run::{Flight, fly};
use super::{Launch, Seat, Setup};

/// Launches over whose seats the share is taken.
const LAUNCHES: u32 = 256;
/// Relative changes of the speed up to which a margin is looked for, the first of them, and the ratio of one to the next.
const WIDEST: f64 = 0.5;
const FIRST: f64 = 1e-3;
const RATIO: f64 = 1.1;
/// Halvings of the change at which the seat changes.
const HALVINGS: u32 = 12;

/// Half widths of the bands in which a launch and the walls lie, all values in them as likely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaunchDeviation {
    /// Of the speed, relative.
    pub speed: f64,
    /// Of the angle in rad.
    pub angle: f64,
    /// Of the restitution.
    pub restitution: f64,
}

/// A launch, and the seat it ends in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landing {
    /// The launch.
    pub launch: Launch,
    /// Its seat.
    pub seat: Seat,
}

/// A verdict, and how sure it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The flight of the launch itself, with its path.
    pub flight: Flight,
    /// Least relative change of the launch's speed with another seat; `None` if there is none up to a half.
    pub margin: Option<f64>,
    /// Launches that fill the bands of the scatter evenly, and where each ends.
    pub landings: Vec<Landing>,
    /// Least speed in m/s to shift by the landscape: sqrt(2 dU / m).
    pub least_speed: f64,
}

/// Flies the `launch`, those around it for the margin, and those of the `deviation` for the share.
pub fn judge(setup: &Setup, landscape: &Landscape, launch: &Launch, deviation: &LaunchDeviation) -> Judged {
    Judged {
        flight: fly(setup, landscape, launch, true),
        margin: margin(setup, landscape, launch),
        landings: landings(setup, landscape, launch, deviation),
        least_speed: landscape.least_speed(setup.mass),
    }
}

impl Judged {
    /// Share of the launches in the scatter that end in the other seat.
    pub fn share(&self) -> f64 {
        let shifts = self.landings.iter().filter(|landing| landing.seat == Seat::Other);
        shifts.count() as f64 / self.landings.len() as f64
    }
}

/// Where launches of all `speeds` in m/s and `angles` in rad against z end, speeds first; but not those into a wall beside the seat.
pub fn map_of_landings(
    setup: &Setup,
    landscape: &Landscape,
    [speeds, angles]: [&[f64]; 2],
    spin: f64,
) -> Vec<Landing> {
    let open = |angle: &&f64| !setup.chamber.is_next_to_wall(**angle);
    let launches = angles
        .iter()
        .filter(open)
        .flat_map(|angle| speeds.iter().map(|speed| Launch { speed: *speed, angle: *angle, spin }));
    launches.map(|launch| Landing { launch, seat: seat(setup, landscape, &launch) }).collect()
}

fn seat(setup: &Setup, landscape: &Landscape, launch: &Launch) -> Seat {
    fly(setup, landscape, launch, false).ending.seat()
}

fn margin(setup: &Setup, landscape: &Landscape, launch: &Launch) -> Option<f64> {
    let own = seat(setup, landscape, launch);
    let keeps = |change: f64| {
        [-1.0, 1.0].into_iter().all(|side| {
            let speed = launch.speed * (1.0 + side * change);
            seat(setup, landscape, &Launch { speed, ..*launch }) == own
        })
    };
    let (mut inside, mut change) = (0.0, FIRST);
    while keeps(change) {
        if change >= WIDEST {
            return None;
        }
        (inside, change) = (change, (change * RATIO).min(WIDEST));
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + change);
        if keeps(middle) { inside = middle } else { change = middle }
    }
    Some(change)
}

/// Launches at points that fill the box of the scatter evenly: multiples of the powers of the root of x^4 = x + 1 (Roberts 2018).
fn landings(
    setup: &Setup,
    landscape: &Landscape,
    launch: &Launch,
    deviation: &LaunchDeviation,
) -> Vec<Landing> {
    const ROOT: f64 = 1.220_744_084_605_759_5;
    let landing = |k: u32| {
        let [speed, angle, restitution] =
            [1, 2, 3].map(|power| 2.0 * ((0.5 + f64::from(k) * ROOT.powi(-power)) % 1.0) - 1.0);
        let launch = Launch {
            speed: launch.speed * (1.0 + deviation.speed * speed),
            angle: launch.angle + deviation.angle * angle,
            ..*launch
        };
        let restitution = (setup.restitution + deviation.restitution * restitution).clamp(0.0, 1.0);
        let setup = Setup { restitution, ..setup.clone() };
        Landing { launch, seat: seat(&setup, landscape, &launch) }
    };
    (0..LAUNCHES).map(landing).collect()
}
