//! From a start to the end of the motion: free flight, touches, rolling, rest.

use super::chamber::ChamberFeature;
use super::contact::Change;
use super::impact::rebound;
use super::landscape::Landscape;
use super::track::Track;
use super::{Launch, Seat, Setup, State, Vector};
use crate::numerics::root::root;

/// Height of a bounce that is none any more, over the radius.
const BOUNCE: f64 = 1e-6;
/// Touches and changes between rolling and sliding after which a motion is given up.
const MOST_EVENTS: u32 = 20_000;
/// Steps after which it is.
const MOST_STEPS: u32 = 400_000;
/// How far from a seat, over the radius, the sphere may rest and be in it.
const IN_SEAT: f64 = 0.01;

/// How a motion ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ending {
    /// It is certain that the sphere comes to rest in this seat, or it is there.
    Seat(Seat),
    /// It comes to rest in a hollow that is no seat, at this x in m.
    Hollow(f64),
    /// Friction holds it at this x in m.
    Stuck(f64),
    /// It still moves at the end time.
    Moves,
    /// It still bounces after more touches than anybody can follow.
    Bounces,
    /// It has passed the saddle, and no more was asked.
    Passed,
}

impl Ending {
    /// The seat.
    pub fn seat(&self) -> Seat {
        if let Ending::Seat(seat) = self { *seat } else { Seat::None }
    }

    /// Why the sphere is in no seat, or may not be, in a sentence.
    pub fn reason(&self) -> Option<String> {
        let mm = |x: f64| format!("{:.3} mm", x * 1e3);
        match self {
            Ending::Seat(_) | Ending::Passed => None,
            Ending::Hollow(x) => {
                Some(format!("the sphere comes to rest outside both seats, at x = {}", mm(*x)))
            }
            Ending::Stuck(x) => Some(format!("friction holds the sphere on its way, at x = {}", mm(*x))),
            Ending::Moves => Some(
                "the sphere still moves at the flight's `end_time`, with energy to leave every seat".into(),
            ),
            Ending::Bounces => Some(format!(
                "the sphere still bounces after {MOST_EVENTS} contacts, with energy to leave every seat: its restitution is too high"
            )),
        }
    }
}

/// The first touch after a launch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightContact {
    /// Time in s.
    pub time: f64,
    /// Centre of the sphere in m.
    pub place: Vector,
}

/// What became of a launch.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// How it ended.
    pub ending: Ending,
    /// Time in s at which that was certain.
    pub time: f64,
    /// The first touch after the launch, if there was one.
    pub first_contact: Option<FlightContact>,
    /// Number of touches.
    pub contacts: u32,
    /// States on the way, if they were asked for: after every step and at every touch.
    pub path: Vec<State>,
}

/// What is asked of a motion.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct MotionRequest {
    /// Whether its path is kept.
    pub(super) path: bool,
    /// Whether it ends as soon as the sphere is beyond this x in m, on the other side than at the start.
    pub(super) beyond: Option<f64>,
}

/// The flight after a `launch` from the first seat; with its `path`, if asked.
pub fn fly(setup: &Setup, landscape: &Landscape, launch: &Launch, path: bool) -> Flight {
    let (sin, cos) = launch.angle.sin_cos();
    let start = State {
        time: 0.0,
        place: setup.chamber.seats()[0],
        velocity: launch.speed * Vector::new(sin, cos),
        spin: launch.spin,
    };
    moved(setup, landscape, start, MotionMode::Free, MotionRequest { path, beyond: None })
}

/// What the sphere is at.
#[derive(Debug, Clone, Copy)]
pub(super) enum MotionMode {
    Free,
    On(Track),
    /// At rest between two surfaces of these normals.
    Wedged([Vector; 2], [ChamberFeature; 2]),
}

/// Moves the sphere until its seat is certain, or what is asked has happened.
pub(super) fn moved(
    setup: &Setup,
    landscape: &Landscape,
    start: State,
    mode: MotionMode,
    request: MotionRequest,
) -> Flight {
    let mut running = FlightRun { setup, landscape, state: start, mode, events: 0, contacts: 0, first: None };
    let mut path = if request.path { vec![start] } else { Vec::new() };
    let side = request.beyond.map(|x| (start.place.x - x).signum());
    for _ in 0..MOST_STEPS {
        let passed =
            request.beyond.zip(side).is_some_and(|(x, side)| (running.state.place.x - x) * side < 0.0);
        let ending = if passed { Some(Ending::Passed) } else { running.ending() };
        let ending = ending.or_else(|| running.go());
        if request.path {
            path.push(running.state);
        }
        if let Some(ending) = ending {
            let FlightRun { state, first, contacts, .. } = running;
            return Flight { ending, time: state.time, first_contact: first, contacts, path };
        }
    }
    let FlightRun { state, first, contacts, .. } = running;
    Flight { ending: Ending::Moves, time: state.time, first_contact: first, contacts, path }
}

struct FlightRun<'a> {
    setup: &'a Setup,
    landscape: &'a Landscape,
    state: State,
    mode: MotionMode,
    events: u32,
    contacts: u32,
    first: Option<FlightContact>,
}

impl FlightRun<'_> {
    /// The end, if it is certain by now.
    fn ending(&self) -> Option<Ending> {
        if self.setup.is_still(self.state.time)
            && let Some(hollow) = self.landscape.hollow(self.state.place.x)
            && self.setup.energy(&self.state) < hollow.certain_below
        {
            return Some(match hollow.seat {
                Seat::None => Ending::Hollow(hollow.x),
                seat => Ending::Seat(seat),
            });
        }
        if self.events > MOST_EVENTS {
            return Some(Ending::Bounces);
        }
        (self.state.time >= self.setup.end_time).then_some(Ending::Moves)
    }

    /// One step, or until something changes; the end if that is one.
    fn go(&mut self) -> Option<Ending> {
        match self.mode {
            MotionMode::Free => {
                let (state, met) = self.setup.fly_on(&self.state);
                self.state = state;
                if let Some(wall) = met {
                    self.record_contact(wall);
                }
                None
            }
            MotionMode::On(track) => {
                let (state, change) = self.setup.roll_on(&track, &self.state);
                self.events += u32::from(change != Change::Goes || state.time == self.state.time);
                self.state = state;
                match change {
                    Change::Goes => {}
                    Change::Leaves => self.mode = MotionMode::Free,
                    Change::Passes(feature) => {
                        self.mode = MotionMode::On(Track::of(&self.setup.chamber, feature))
                    }
                    Change::Meets(wall) => self.record_contact(wall),
                    Change::Rests => return Some(self.at_rest()),
                }
                None
            }
            MotionMode::Wedged(normals, features) => self.wait(normals, features),
        }
    }

    /// Touches `wall`, and finds out what follows.
    fn record_contact(&mut self, wall: usize) {
        let nearest = self.setup.chamber.nearest(wall, self.state.place);
        let normal = (self.state.place - nearest.point).normalize();
        if self.state.time > 0.0 && self.first.is_none() {
            self.first = Some(FlightContact { time: self.state.time, place: self.state.place });
        }
        (self.state.velocity, self.state.spin) = rebound(self.setup, &self.state, normal);
        self.contacts += 1;
        self.events += 1;
        self.come_to_rest();
    }

    /// Decides whether the sphere flies, stays on a surface or rests between two.
    fn come_to_rest(&mut self) {
        let (setup, state) = (self.setup, self.state);
        let pull = setup.field.acceleration(setup.mass, state.time, state.place);
        let bounce = BOUNCE * setup.radius;
        let mut pressing: Vec<(Track, f64)> = Vec::new();
        for wall in 0..setup.chamber.walls() {
            let feature = setup.chamber.nearest(wall, state.place).feature;
            if setup.chamber.gap(wall, state.place) > bounce
                || pressing.iter().any(|(t, _)| t.feature == feature)
            {
                continue;
            }
            let track = Track::of(&setup.chamber, feature);
            let normal = track.normal(track.along(state.place));
            let [away, along] = [normal, super::track::tangent(normal)].map(|n| state.velocity.dot(&n));
            let pressed = -pull.dot(&normal) - along * along * track.curvature();
            if pressed > 0.0 && away * away < 2.0 * pressed * bounce {
                pressing.push((track, pressed));
            }
        }
        pressing.sort_by(|a, b| b.1.total_cmp(&a.1));
        self.mode = match pressing[..] {
            [] => MotionMode::Free,
            [(a, _), (b, _), ..] if state.velocity.norm_squared() < 2.0 * pull.norm() * bounce => {
                let normals = [a, b].map(|track| track.normal(track.along(state.place)));
                if self.presses(state.time, normals).into_iter().all(|force| force > 0.0) {
                    (self.state.velocity, self.state.spin) = (Vector::zeros(), 0.0);
                    MotionMode::Wedged(normals, [a.feature, b.feature])
                } else {
                    self.lay_on(&a)
                }
            }
            [(track, _), ..] => self.lay_on(&track),
        };
    }

    /// Takes away what moves the sphere off the `track`.
    fn lay_on(&mut self, track: &Track) -> MotionMode {
        let q = track.along(self.state.place);
        let tangent = track.tangent(q);
        self.state.place = track.place(q);
        self.state.velocity = self.state.velocity.dot(&tangent) * tangent;
        MotionMode::On(*track)
    }

    /// Forces, per unit of mass, with which a sphere at rest presses on surfaces of these `normals`.
    fn presses(&self, time: f64, [a, b]: [Vector; 2]) -> [f64; 2] {
        let pull = self.setup.field.acceleration(self.setup.mass, time, self.state.place);
        let area = a.perp(&b);
        [-pull.perp(&b) / area, pull.perp(&a) / area]
    }

    /// Rests between two surfaces until the valve's motion takes it off one of them.
    fn wait(&mut self, normals: [Vector; 2], features: [ChamberFeature; 2]) -> Option<Ending> {
        if self.setup.is_still(self.state.time) {
            return Some(self.at_rest());
        }
        let (time, h) = (self.state.time, self.setup.step_length(&self.state));
        let least = |t: f64| self.presses(time + t, normals).into_iter().fold(f64::INFINITY, f64::min);
        let values = [least(0.0), least(h)];
        if values[1] >= 0.0 {
            self.state.time += h;
            return None;
        }
        self.state.time += if values[0] > 0.0 { root(least, [0.0, h], values) } else { 0.0 };
        self.events += 1;
        let presses = self.presses(self.state.time, normals);
        let stays = usize::from(presses[1] > presses[0]);
        self.mode = if presses[stays] > 0.0 {
            MotionMode::On(Track::of(&self.setup.chamber, features[stays]))
        } else {
            MotionMode::Free
        };
        None
    }

    fn at_rest(&self) -> Ending {
        let place = self.state.place;
        let near = |seat: Vector| (place - seat).norm() < IN_SEAT * self.setup.radius;
        match (self.setup.chamber.seats().map(near), self.mode) {
            ([true, _], _) => Ending::Seat(Seat::Same),
            ([_, true], _) => Ending::Seat(Seat::Other),
            (_, MotionMode::Wedged(..)) => Ending::Hollow(place.x),
            _ => Ending::Stuck(place.x),
        }
    }
}

impl Setup {
    /// How a sphere at rest in its seat is held there: the mode to start from.
    pub(super) fn seated(&self, landscape: &Landscape) -> (State, MotionMode) {
        let place = self.chamber.seats()[0];
        let state = State { time: 0.0, place, velocity: Vector::zeros(), spin: 0.0 };
        let mut running = FlightRun {
            setup: self,
            landscape,
            state,
            mode: MotionMode::Free,
            events: 0,
            contacts: 0,
            first: None,
        };
        running.come_to_rest();
        (running.state, running.mode)
    }
}
