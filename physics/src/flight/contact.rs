//! Motion of a sphere that stays on a wall or an edge: rolling, sliding, held.

use super::chamber::ChamberFeature;
use super::friction::{Bond, Regime, SurfaceLoads};
use super::step::step;
use super::track::Track;
use super::{Setup, State};
use crate::numerics::root::root;

/// Speed in m/s below which a slip is none.
const NO_SPEED: f64 = 1e-11;
/// Penetration in m below which another wall counts as not touched.
const CONTACT_GAP: f64 = 1e-13;

/// How far ahead of a step, over its length, it is asked what sticks.
const SOON: f64 = 1e-6;

/// Why a step on a wall or an edge ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Change {
    /// It was as long as it could be, or slipping and rolling alternate.
    Goes,
    /// The sphere lifts off.
    Leaves,
    /// Another wall is touched.
    Meets(usize),
    /// The surface goes on with this.
    Passes(ChamberFeature),
    /// The sphere rests, and nothing will move it.
    Rests,
}

/// What holds in a step.
#[derive(Debug, Clone, Copy)]
enum Condition {
    Pressed,
    Begin,
    End,
    Surface,
    Turn,
    Clear(usize),
}

/// Place along the track, speed along it, spin.
type Course = [f64; 3];

struct Rolling<'a> {
    setup: &'a Setup,
    track: &'a Track,
    regime: Regime,
}

impl Setup {
    /// Normal force in N and the loads at a place of the track.
    pub(super) fn loads(&self, track: &Track, time: f64, [q, v, _]: Course) -> (f64, SurfaceLoads) {
        let (place, tangent) = (track.place(q), track.tangent(q));
        let pull = self.field.acceleration(self.mass, time, place) + self.field.drag(self.mass, v * tangent);
        let pressed = -self.mass * (pull.dot(&track.normal(q)) + v * v * track.curvature());
        let loads = SurfaceLoads {
            along: self.mass * pull.dot(&tangent),
            grip: self.friction * pressed.max(0.0),
            resistance: self.field.resisting_moment(self.radius, place),
            mass: self.mass,
            inertia: self.inertia(),
            radius: self.radius,
        };
        (pressed, loads)
    }

    /// Moves on the `track` by one step at most, or until something changes.
    pub(super) fn roll_on(&self, track: &Track, from: &State) -> (State, Change) {
        let q = track.along(from.place);
        let mut start: Course = [q, from.velocity.dot(&track.tangent(q)), from.spin];
        if (self.radius * start[2]).abs() < NO_SPEED {
            start[2] = 0.0;
        }
        let mut slip = start[1] + self.radius * start[2];
        if slip.abs() < NO_SPEED {
            slip = 0.0;
        }
        let (pressed, loads) = self.loads(track, from.time, start);
        if pressed < 0.0 {
            // too fast for the bend that it came to
            return (*from, Change::Leaves);
        }
        let h = self.step_length(from);
        // where shaking has just overcome what held the sphere, rounding hides which way: a moment later it shows
        let soon = from.time + SOON * h;
        let regime = Regime::at(&self.loads(track, soon, start).1, slip, start[2]);
        if regime.surface == Bond::Stick {
            start[2] = -start[1] / self.radius;
        }
        let rolling = Rolling { setup: self, track, regime };
        if self.is_still(from.time) && rolling.is_at_rest(&loads, start) {
            return (rolling.state(from.time, start), Change::Rests);
        }
        let end = rolling.course(from.time, start, h);
        let (time, condition) = rolling.first_broken(from.time, start, end, h);
        let Some(condition) = condition else { return (rolling.state(from.time + h, end), Change::Goes) };
        let state = rolling.state(from.time + time, rolling.course(from.time, start, time));
        match condition {
            Condition::Pressed => (state, Change::Leaves),
            Condition::Begin => (state, Change::Passes(track.next(&self.chamber, true))),
            Condition::End => (state, Change::Passes(track.next(&self.chamber, false))),
            Condition::Clear(wall) => (state, Change::Meets(wall)),
            Condition::Surface | Condition::Turn => (rolling.switched(state, condition), Change::Goes),
        }
    }

    /// Whether nothing shakes the valve from `time` on.
    pub(super) fn is_still(&self, time: f64) -> bool {
        self.field.shaken.as_ref().is_none_or(|shaken| time >= shaken.wave.end())
    }
}

impl Rolling<'_> {
    fn course(&self, time: f64, start: Course, h: f64) -> Course {
        let rate = |time: f64, y: &Course| {
            let answer = self.regime.answer(&self.setup.loads(self.track, time, *y).1);
            [y[1], answer.acceleration, answer.spin_rate]
        };
        if self.regime.rests() { start } else { step(rate, time, &start, h) }
    }

    fn state(&self, time: f64, [q, v, spin]: Course) -> State {
        State { time, place: self.track.place(q), velocity: v * self.track.tangent(q), spin }
    }

    /// Whether the sphere neither moves nor begins to.
    fn is_at_rest(&self, loads: &SurfaceLoads, [_, v, spin]: Course) -> bool {
        let slow = v.abs() < NO_SPEED && (self.setup.radius * spin).abs() < NO_SPEED;
        let answer = self.regime.answer(loads);
        let pull = loads.grip + loads.along.abs() + loads.mass;
        slow && (self.regime.rests() || answer.acceleration.abs() * loads.mass < 1e-12 * pull)
    }

    /// Positive while the condition holds.
    fn holds(&self, condition: Condition, time: f64, course: Course) -> f64 {
        let [q, v, spin] = course;
        match condition {
            Condition::Pressed => self.setup.loads(self.track, time, course).0,
            Condition::Begin => q,
            Condition::End => self.track.length - q,
            Condition::Clear(wall) => self.setup.chamber.gap(wall, self.track.place(q)) + CONTACT_GAP,
            Condition::Surface => match self.regime.surface {
                Bond::Slip(sign) => f64::from(sign) * (v + self.setup.radius * spin),
                Bond::Stick => {
                    let loads = self.setup.loads(self.track, time, course).1;
                    loads.grip - self.regime.answer(&loads).friction.abs()
                }
            },
            Condition::Turn => match self.regime.turn {
                Bond::Slip(sign) => f64::from(sign) * spin,
                Bond::Stick => {
                    let loads = self.setup.loads(self.track, time, course).1;
                    loads.resistance - self.regime.answer(&loads).moment.abs()
                }
            },
        }
    }

    /// The condition that breaks first in a step of `h` s, and when.
    fn first_broken(&self, time: f64, start: Course, end: Course, h: f64) -> (f64, Option<Condition>) {
        let chamber = &self.setup.chamber;
        // friction first: at equal times it decides how the sphere goes on
        let mut conditions = vec![Condition::Surface];
        if self.setup.field.spring.as_ref().is_some_and(|spring| spring.friction > 0.0) {
            conditions.push(Condition::Turn);
        }
        conditions.extend([Condition::Pressed, Condition::Begin, Condition::End]);
        let clear = |wall: &usize| !chamber.belongs(*wall, self.track.feature) && !self.is_beyond_edge(*wall);
        conditions.extend((0..chamber.walls()).filter(clear).map(Condition::Clear));
        let mut first = (h, None);
        for condition in conditions {
            let [before, after] = [(time, start), (time + h, end)].map(|(t, y)| self.holds(condition, t, y));
            if after >= 0.0 {
                continue;
            }
            let at = |t: f64| self.holds(condition, time + t, self.course(time, start, t));
            let broken = if before > 0.0 { root(at, [0.0, h], [before, after]) } else { 0.0 };
            if broken < first.0 {
                first = (broken, Some(condition));
            }
        }
        first
    }

    /// Whether `wall` begins where the track's wall ends, turning away from it.
    fn is_beyond_edge(&self, wall: usize) -> bool {
        let ChamberFeature::Wall(own) = self.track.feature else { return false };
        let chamber = &self.setup.chamber;
        let after = (own + 1) % chamber.walls();
        (wall == after && chamber.jut(after) >= 0.0)
            || (wall == chamber.before(own) && chamber.jut(own) >= 0.0)
    }

    /// With exactly no slip, or no spin, where it went through zero.
    fn switched(&self, state: State, condition: Condition) -> State {
        let speed = state.velocity.dot(&self.track.tangent(self.track.along(state.place)));
        let slips = |bond: Bond| matches!(bond, Bond::Slip(_));
        match condition {
            Condition::Surface if slips(self.regime.surface) => {
                State { spin: -speed / self.setup.radius, ..state }
            }
            Condition::Turn if slips(self.regime.turn) => {
                let velocity =
                    if self.regime.surface == Bond::Stick { 0.0 * state.velocity } else { state.velocity };
                State { spin: 0.0, velocity, ..state }
            }
            _ => state,
        }
    }
}
