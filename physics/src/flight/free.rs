//! Free flight, and the first touch in a step of it.

use super::step::step;
use super::{Setup, State, Vector};
use crate::numerics::root::root;

/// Longest way in a step over the radius: within it a gap has one lowest or highest value at most.
const WAY: f64 = 0.1;
/// Gap in m below which a wall counts as touched already, and depth at which it is touched again.
const CLOSED: f64 = 1e-12;
const CONTACT_GAP: f64 = 1e-13;

/// Most halvings of a step at the end of a wall.
const HALVINGS: u32 = 4;

impl Setup {
    /// The state after `h` s of free flight.
    pub(super) fn flown(&self, from: &State, h: f64) -> State {
        let rate = |time: f64, y: &[f64; 5]| {
            let (place, velocity) = (Vector::new(y[0], y[1]), Vector::new(y[2], y[3]));
            let acceleration =
                self.field.acceleration(self.mass, time, place) + self.field.drag(self.mass, velocity);
            let slowing = self.field.resisting_moment(self.radius, place) / self.inertia();
            [y[2], y[3], acceleration.x, acceleration.y, slowing]
        };
        let y = [from.place.x, from.place.y, from.velocity.x, from.velocity.y, 0.0];
        let [x, z, vx, vz, slowed] = step(rate, from.time, &y, h);
        State {
            time: from.time + h,
            place: Vector::new(x, z),
            velocity: Vector::new(vx, vz),
            // the spring stops a turn and does not turn it back
            spin: from.spin.signum() * (from.spin.abs() - slowed).max(0.0),
        }
    }

    /// Length in s of a step from `state` on.
    pub(super) fn step_length(&self, state: &State) -> f64 {
        let speed = state.velocity.norm();
        let pull = self.field.acceleration(self.mass, state.time, state.place).norm();
        let way = WAY * self.radius;
        let by_way = (way / speed).min((2.0 * way / pull).sqrt());
        by_way.min(self.field.longest_step(self.mass, state.time, speed)).min(self.end_time)
    }

    /// Flies one step, or until the first touch in it; then with the wall.
    pub(super) fn fly_on(&self, from: &State) -> (State, Option<usize>) {
        let h = self.step_length(from);
        let to = self.flown(from, h);
        let mut first: Option<(f64, usize)> = None;
        for wall in 0..self.chamber.walls() {
            let within = first.map_or(h, |(earlier, _)| earlier);
            if let Some(time) =
                self.contact_time(wall, [from, &to], h, HALVINGS).filter(|time| *time < within)
            {
                first = Some((time, wall));
            }
        }
        first.map_or((to, None), |(time, wall)| (self.flown(from, time), Some(wall)))
    }

    /// Time in s at which the sphere touches `wall` in a step of `h` s. A step in which the wall's edge comes nearest, or no longer is,
    /// is halved so many times: up and down again may be followed by a way around the edge.
    fn contact_time(&self, wall: usize, [from, to]: [&State; 2], h: f64, halvings: u32) -> Option<f64> {
        let nearest = [from, to].map(|state| self.chamber.nearest(wall, state.place));
        let gaps = [0, 1].map(|k| ([from, to][k].place - nearest[k].point).norm() - self.radius);
        let way = (from.velocity.norm() + to.velocity.norm()) * h;
        if gaps[0].min(gaps[1]) > way + WAY * self.radius {
            return None;
        }
        if halvings > 0 && nearest[0].feature != nearest[1].feature {
            let middle = self.flown(from, 0.5 * h);
            let first = self.contact_time(wall, [from, &middle], 0.5 * h, halvings - 1);
            let second = || Some(0.5 * h + self.contact_time(wall, [&middle, to], 0.5 * h, halvings - 1)?);
            return first.or_else(second);
        }
        let gap = |t: f64| self.chamber.gap(wall, self.flown(from, t).place);
        let closing = |t: f64| self.separation(wall, &self.flown(from, t));
        let rates = [from, to].map(|state| self.separation(wall, state));
        if gaps[0] > CLOSED && gaps[1] < 0.0 {
            return Some(root(gap, [0.0, h], gaps));
        }
        if gaps[0] > CLOSED && rates[0] < 0.0 && rates[1] > 0.0 {
            let nearest = root(closing, [0.0, h], rates);
            let lowest = gap(nearest);
            return (lowest < 0.0).then(|| root(gap, [0.0, nearest], [gaps[0], lowest]));
        }
        if gaps[1] >= -CONTACT_GAP {
            return None;
        }
        if rates[0] > 0.0 && rates[1] < 0.0 {
            // up from the surface and down again
            let top = root(closing, [0.0, h], rates);
            let highest = gap(top);
            return Some(if highest > 0.0 { root(gap, [top, h], [highest, gaps[1]]) } else { 0.0 });
        }
        Some(if rates[0] <= 0.0 { 0.0 } else { h })
    }

    /// Rate in m/s at which the gap to `wall` grows.
    pub(super) fn separation(&self, wall: usize, state: &State) -> f64 {
        let arm = state.place - self.chamber.nearest(wall, state.place).point;
        arm.dot(&state.velocity) / arm.norm()
    }
}
