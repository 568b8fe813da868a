//! The flight of the sphere against MuJoCo, and the rocker's statements of section 5.1.1.
//!
//! MuJoCo's flights and shocks are what `python -m fem_reference flights` has stored; without them the rocker's statements are left. A flight's seat can hang on
//! differences far below any model's error: the map of landings has fractal edges. Only flights whose neighbours all reach the
//! same seat are compared with each other; the others are listed.

use crate::error::{Error, Result};
use crate::evidence::study::{Cell, Claim, Note, Study, of_project};
use crate::flight::{Field, Flight, Landscape, Launch, Seat, Setup, Spring, Vector, Wave, fly, thresholds};
use crate::kinds::seal_seat::SealSeat;
use crate::project::project_root;
use rayon::prelude::*;
use serde::Deserialize;
use std::f64::consts::FRAC_PI_2;

/// The stored flights.
const STORED: &str = "fem_reference/solutions/flights.json";
/// Neighbours of a flight: relative changes of speed, of angle in rad, of restitution.
const SPEED: f64 = 0.01;
const ANGLE: f64 = 0.5 * std::f64::consts::PI / 180.0;
const RESTITUTION: f64 = 0.02;
/// How far first touches may lie apart, in m and s, and amplitudes of shocks, relative.
const FIRST_CONTACT: [f64; 2] = [1e-9, 1e-9];
const AMPLITUDE: f64 = 4e-4;
/// Restitution of the shocks.
const OF_SHOCKS: f64 = 0.5;
/// Height of all chambers in m.
const HEIGHT: f64 = 20e-3;

/// What MuJoCo was asked and said, in mm, ms, g and N.
#[derive(Debug, Deserialize)]
struct MujocoRecord {
    flights: Vec<StoredFlight>,
    shocks: Vec<StoredShock>,
}

#[derive(Debug, Deserialize)]
struct StoredFlight {
    seed: usize,
    seat: StoredSeat,
    mass: f64,
    gravity: f64,
    force: f64,
    stiffness: f64,
    restitution: f64,
    friction: f64,
    speed: f64,
    angle: f64,
    spin: f64,
    found: Found,
}

/// What is not as in the improved design.
#[derive(Debug, Deserialize)]
struct StoredSeat {
    tilt: f64,
    aperture_angle: f64,
    notch_width: f64,
}

#[derive(Debug, Deserialize)]
struct Found {
    seat: Seat,
    first_touch: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize)]
struct StoredShock {
    kind: String,
    length: f64,
    friction: f64,
    amplitude: f64,
    /// With half MuJoCo's time step.
    halved: f64,
}

/// A threshold of both.
struct ComparedShock<'a> {
    stored: &'a StoredShock,
    /// Relative difference.
    off: f64,
    /// What halving MuJoCo's step and a restitution as in a flight's neighbours change of it, relative.
    open: f64,
}

/// A flight of both.
struct ComparedFlight {
    seed: usize,
    ours: Seat,
    theirs: Seat,
    /// Whether all neighbours reach our seat.
    unanimous: bool,
    /// Distance in m and difference in time in s of the first touches.
    first_touch: Option<[f64; 2]>,
}

/// The study.
///
/// # Errors
/// [`Error::Usage`] if a shipped scene is gone.
pub fn run(note: &mut Note) -> Result<Study> {
    // without MuJoCo's flights the rocker's statements are left
    let stored = stored().unwrap_or_else(|error| {
        note(&error.to_string());
        MujocoRecord { flights: Vec::new(), shocks: Vec::new() }
    });
    let improved = of_project("seal-seat-improved")?.seal_seat()?.clone();
    note(&format!("{} flights with 26 neighbours each", stored.flights.len()));
    let compared: Vec<ComparedFlight> =
        stored.flights.par_iter().map(|flight| compare(&improved, flight)).collect::<Result<_>>()?;
    note("shocks");
    let shocks: Vec<ComparedShock> =
        stored.shocks.par_iter().map(|shock| compare_shock(&improved, shock)).collect::<Result<_>>()?;
    let mut claims = if compared.is_empty() { Vec::new() } else { of_flights(&compared) };
    claims.extend(of_shocks(&shocks));
    note("rocker");
    claims.extend(rocker()?);
    Ok(Study::new(
        "flight",
        "Flights of the sphere in the seal seat's chamber, random in seat, spring, walls and launch, by the reduced \
             flight and by MuJoCo (a damped spring in place of an impact, steps of 0.5 us). Unanimous are flights of which all \
             26 neighbours (speed ± 1 %, angle ± 0.5°, restitution ± 0.02) reach the same seat; of the others no verdict is \
             sure. The rocker's statements are those of sections 5.1.1 and 5.1.2, with a spring of our own: the paper gives none.",
        "seed, ours, MuJoCo, unanimous, touch_distance [m], touch_time_difference [s]",
        compared.iter().map(row).collect(),
        claims,
    ))
}

fn stored() -> Result<MujocoRecord> {
    let path = project_root()?.join(STORED);
    let missing = |why: String| {
        Error::Reference(format!(
            "{}: {why}; `make setup` and `target/python-tools/bin/python -m fem_reference flights --out {STORED}` bring it",
            path.display()
        ))
    };
    let text = std::fs::read_to_string(&path).map_err(|error| missing(error.to_string()))?;
    serde_json::from_str(&text).map_err(|error| missing(error.to_string()))
}

fn row(compared: &ComparedFlight) -> Vec<Cell> {
    let [distance, time] = [0, 1].map(|k| Cell::from(compared.first_touch.map(|off| off[k])));
    let unanimous = if compared.unanimous { "yes" } else { "no" };
    let texts = [compared.ours.name(), compared.theirs.name(), unanimous].map(Cell::Text);
    let [ours, theirs, unanimous] = texts;
    vec![Cell::Count(compared.seed), ours, theirs, unanimous, distance, time]
}

fn of_flights(compared: &[ComparedFlight]) -> Vec<Claim> {
    let unanimous = compared.iter().filter(|flight| flight.unanimous);
    let differ = unanimous.clone().filter(|flight| flight.ours != flight.theirs).count();
    let equal = compared.iter().filter(|flight| flight.ours == flight.theirs).count();
    let share = equal as f64 / compared.len() as f64;
    let largest =
        |k: usize| compared.iter().filter_map(|f| f.first_touch).map(|off| off[k].abs()).fold(0.0, f64::max);
    let with_contact = compared.iter().filter(|flight| flight.first_touch.is_some()).count();
    vec![
        Claim::new(
            format!(
                "of {} unanimous flights of {}: another seat than MuJoCo",
                unanimous.count(),
                compared.len()
            ),
            "1",
            None,
            Some(differ as f64),
            0.0,
        ),
        Claim::new("share of all flights with another seat".into(), "1", None, Some(1.0 - share), 0.1),
        Claim::new(
            format!("first contacts of {with_contact} flights: largest distance"),
            "m",
            None,
            Some(largest(0)),
            FIRST_CONTACT[0],
        ),
        Claim::new(
            format!("first contacts of {with_contact} flights: largest difference in time"),
            "s",
            None,
            Some(largest(1)),
            FIRST_CONTACT[1],
        ),
    ]
}

/// The thresholds that are sharp against each other; of the others what they are open by.
fn of_shocks(shocks: &[ComparedShock]) -> Vec<Claim> {
    let is_sure = |shock: &&ComparedShock| shock.open <= AMPLITUDE;
    let largest = |values: Vec<f64>| values.iter().copied().reduce(f64::max);
    let claim_of = |(kind, name): (&str, &str)| {
        let of_kind = shocks.iter().filter(is_sure).filter(|shock| shock.stored.kind == kind);
        let off: Vec<f64> = of_kind.map(|shock| shock.off).collect();
        let claim = format!(
            "{} {name}: least amplitude that shifts, largest relative difference from MuJoCo",
            off.len()
        );
        Some(Claim::new(claim, "1", None, Some(largest(off)?), AMPLITUDE))
    };
    let open: Vec<f64> =
        shocks.iter().filter(|shock| !is_sure(shock)).map(|shock| shock.off / shock.open).collect();
    let claim = format!(
        "{} shocks whose amplitude half MuJoCo's step or a restitution ± {RESTITUTION} changes by more than {AMPLITUDE}: largest difference over that change",
        open.len()
    );
    let of_open = largest(open).map(|open| Claim::new(claim, "1", None, Some(open), 1.0));
    let kinds = [("half-sine", "half-sine shocks"), ("sine", "sines of three periods")];
    kinds.into_iter().filter_map(claim_of).chain(of_open).collect()
}

/// The improved design's chamber under a spring that presses down.
fn valve(seat: &SealSeat, flight: &StoredFlight) -> Result<Setup> {
    let chamber = seat.chamber(HEIGHT).map_err(|error| Error::Internal(error.0))?;
    let spring = Spring {
        force: flight.force,
        stiffness: 1e3 * flight.stiffness,
        direction: Vector::new(0.0, -1.0),
        anchor: None,
        friction: 0.0,
        seat: chamber.seats()[0],
    };
    Ok(Setup {
        mass: 1e-3 * flight.mass,
        radius: seat.sphere.radius,
        chamber,
        field: Field {
            gravity: Vector::new(0.0, -1e3 * flight.gravity),
            spring: Some(spring),
            ..Field::default()
        },
        restitution: flight.restitution,
        friction: flight.friction,
        end_time: 1.0,
    })
}

fn compare(improved: &SealSeat, stored: &StoredFlight) -> Result<ComparedFlight> {
    let mut seat = improved.clone();
    seat.seat.tilt = stored.seat.tilt;
    seat.seat.aperture_angle = stored.seat.aperture_angle;
    if let Some(notch) = &mut seat.seat.notch {
        notch.width = 1e-3 * stored.seat.notch_width;
    }
    let setup = valve(&seat, stored)?;
    let landscape = landscape(&setup)?;
    let launch = Launch { speed: stored.speed, angle: stored.angle, spin: 1e3 * stored.spin };
    let flown = |changes: [f64; 3]| -> Flight {
        let launch = Launch {
            speed: launch.speed * (1.0 + SPEED * changes[0]),
            angle: launch.angle + ANGLE * changes[1],
            ..launch
        };
        let setup = Setup { restitution: setup.restitution + RESTITUTION * changes[2], ..setup.clone() };
        fly(&setup, &landscape, &launch, false)
    };
    let own = flown([0.0; 3]);
    let ours = own.ending.seat();
    let sides = [-1.0, 0.0, 1.0];
    let unanimous = sides
        .iter()
        .all(|s| sides.iter().all(|a| sides.iter().all(|e| flown([*s, *a, *e]).ending.seat() == ours)));
    let first_touch = own.first_contact.zip(stored.found.first_touch).map(|(own, [time, x, z])| {
        let distance = (own.place - 1e-3 * Vector::new(x, z)).norm();
        [distance, own.time - 1e-3 * time]
    });
    Ok(ComparedFlight { seed: stored.seed, ours, theirs: stored.found.seat, unanimous, first_touch })
}

fn landscape(setup: &Setup) -> Result<Landscape> {
    Landscape::new(setup).map_err(Error::Internal)
}

fn compare_shock<'a>(improved: &SealSeat, stored: &'a StoredShock) -> Result<ComparedShock<'a>> {
    let like = StoredFlight {
        seed: 0,
        seat: StoredSeat { tilt: 0.0, aperture_angle: 0.0, notch_width: 0.0 },
        mass: 1e3 * improved.sphere.mass,
        gravity: 9.80665e-3,
        force: 0.037,
        stiffness: 0.0,
        restitution: OF_SHOCKS,
        friction: stored.friction,
        speed: 0.0,
        angle: 0.0,
        spin: 0.0,
        found: Found { seat: Seat::None, first_touch: None },
    };
    let setup = valve(improved, &like)?;
    let landscape = landscape(&setup)?;
    let length = 1e-3 * stored.length;
    let wave = match &*stored.kind {
        "sine" => Wave::Sine { frequency: 1.0 / length, periods: 3.0 },
        _ => Wave::HalfSine { duration: length },
    };
    let shifts = |change: f64| {
        let setup = Setup { restitution: OF_SHOCKS + change, ..setup.clone() };
        let found = thresholds(&setup, &landscape, &wave, Vector::new(-1.0, 0.0));
        found.shifts.unwrap_or(f64::INFINITY)
    };
    let own = shifts(0.0);
    let neighbours = [-RESTITUTION, RESTITUTION].map(|change| (shifts(change) / own - 1.0).abs());
    let halved = (stored.halved / stored.amplitude - 1.0).abs();
    let off = (own / stored.amplitude - 1.0).abs();
    Ok(ComparedShock { stored, off, open: halved + neighbours[0].max(neighbours[1]) })
}

/// Sections 5.1.1 and 5.1.2: back when the blow is too weak, stopped in the middle by the friction of spring and rocker together, cured by
/// a point.
fn rocker() -> Result<Vec<Claim>> {
    let scene = of_project("examples/rocker-flight")?;
    let flight = scene.flight.as_ref().ok_or_else(|| Error::Internal("the rocker's scene flies".into()))?;
    let restitution = flight.restitution.unwrap_or_default();
    let seats = |spring_friction: f64, gravity: Option<Vector>, force: f64| -> Result<Vec<Seat>> {
        let mut flight = flight.clone();
        if let Some(spring) = &mut flight.spring {
            spring.friction = spring_friction;
            spring.force *= force;
        }
        flight.gravity = gravity.unwrap_or(flight.gravity);
        let setup = flight.setup(&scene, restitution).map_err(Error::Internal)?;
        let landscape = landscape(&setup)?;
        let at = |k: u32| Launch { speed: 0.3 + 1e-3 * f64::from(k), angle: FRAC_PI_2, spin: 0.0 };
        Ok((0..700).map(|k| fly(&setup, &landscape, &at(k), false).ending.seat()).collect())
    };
    let share = |seats: &[Seat], seat: Seat| {
        seats.iter().filter(|found| **found == seat).count() as f64 / seats.len() as f64
    };
    let yes = |holds: bool| Some(f64::from(u8::from(holds)));
    let friction = flight.spring.map_or(0.0, |spring| spring.friction);
    let [blocked, cured] = [seats(friction, None, 1.0)?, seats(0.0, None, 1.0)?];
    // gravity against the shift, as where the lower actuator lifts the sphere
    let against = Vector::new(-flight.gravity.norm(), 0.0);
    let least = |seats: &[Seat]| seats.iter().position(|seat| *seat == Seat::Other);
    let (upwards, weaker) = (seats(0.0, Some(against), 1.0)?, seats(0.0, Some(against), 0.5)?);
    Ok(vec![
        Claim::new(
            "5.1.1, gravity against the shift: after too weak an impact the sphere falls back (1 = yes)"
                .into(),
            "1",
            Some(1.0),
            yes(upwards[0] == Seat::Same && least(&upwards) > least(&cured)),
            0.0,
        ),
        Claim::new(
            "5.1.1: less pre-tension of the spring shifts at a lower speed (1 = yes)".into(),
            "1",
            Some(1.0),
            yes(least(&weaker).is_some() && least(&weaker) < least(&upwards)),
            0.0,
        ),
        Claim::new(
            format!(
                "5.1.2, friction of spring and rocker: the sphere stops in the middle, in {:.0} % of the launches of 0.3 to 1 m/s (1 = yes)",
                100.0 * share(&blocked, Seat::None)
            ),
            "1",
            Some(1.0),
            yes(share(&blocked, Seat::None) > 0.0),
            0.0,
        ),
        Claim::new(
            "5.1.2, the spring pushes through a point: share of launches that stop in the middle".into(),
            "1",
            Some(0.0),
            Some(share(&cured, Seat::None)),
            0.0,
        ),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::study::Verdict;

    /// The rocker's statements hold, MuJoCo's flights reach the same seat wherever that is sure, first touches and sharp thresholds are
    /// the same.
    #[test]
    fn every_claim_holds() {
        let study = run(&mut |_| {}).expect("shipped scenes");
        assert_eq!(study.claims.len(), 11, "{:?}", study.claims);
        for claim in &study.claims {
            assert_eq!(claim.verdict, Verdict::Pass, "{claim:?}");
        }
    }
}
