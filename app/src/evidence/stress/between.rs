//! What happens between the ends of a Runge-Kutta step: a touch that it would pass, a force peak, touches and releases.
//!
//! The method knows its state and the rate of it at both ends of a step: of each approach the value and two derivatives,
//! and so Hermite's polynomial of fifth degree, as exact as the step itself.

use crate::dynamics::contact_balance::ContactBalance;
use crate::dynamics::integration::NEGLIGIBLE;
use crate::dynamics::system::{System, dot};
use crate::numerics::explicit_runge_kutta::Step;

/// Places of a step that are looked at.
const PLACES: usize = 12;
/// Impulse of a passed touch, over the lighter body's momentum at the impact speed, that changes nothing.
const NOTHING: f64 = 1e-9;
/// Halvings of the distance of the places, to find a peak or a release between them.
const HALVINGS: usize = 24;
/// Share of the peak so far from which on a step may have a higher one between its places.
const NEARLY: f64 = 0.99;

/// Value and first two derivatives by the place, at the start and the end of a step.
type Ends = [[f64; 3]; 2];

/// What happened at one contact.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ObservedContact {
    /// Largest force, N.
    pub(super) force_peak: f64,
    /// Number of contacts but for those with a negligible impulse.
    pub(super) contacts: u32,
    /// Time of the last release, s.
    pub(super) end: f64,
    closed: bool,
    /// Impulse since the last touch, N s.
    impulse: f64,
}

impl ObservedContact {
    /// Number of contacts that ended: whether a last one began before the run ended can be a matter of rounding.
    pub(super) fn ended(&self) -> u32 {
        self.contacts - u32::from(self.closed)
    }

    /// What is compared of the account that the program keeps.
    pub(super) fn of(account: &ContactBalance) -> Self {
        let &ContactBalance { force_peak, contacts, end, closed, .. } = account;
        Self { force_peak, contacts, end, closed, impulse: 0.0 }
    }
}

/// Looks into every step, and keeps what happened at outer and inner contact.
pub(super) struct ContactWatch<'a> {
    system: &'a System,
    pub(super) contacts: [ObservedContact; 2],
    /// Time at the end of the steps that were accepted, s.
    time: f64,
}

impl<'a> ContactWatch<'a> {
    pub(super) fn new(system: &'a System) -> Self {
        Self { system, contacts: [ObservedContact::default(); 2], time: 0.0 }
    }

    /// Whether `step` passes no touch that matters; if so, its forces are taken into account.
    pub(super) fn accepts(&mut self, step: &Step) -> bool {
        let system = self.system;
        let n = system.size();
        let at = |[y, rate]: [&[f64]; 2]| {
            [0, 1].map(|i| {
                let b = &system.approach[i];
                let place = dot(b, &y[..n]) - system.gap[i];
                [place, dot(b, &y[n..]) * step.h, dot(b, &rate[n..]) * step.h * step.h]
            })
        };
        let (start, end) = (at(step.start), at(step.end));
        let ends: [Ends; 2] = [0, 1].map(|i| [start[i], end[i]]);
        let approach = |u: f64| [0, 1].map(|i| hermite(&ends[i], u));
        let places: [[f64; 2]; PLACES + 1] = std::array::from_fn(|k| approach(k as f64 / PLACES as f64));
        let lightest = system.speed * system.masses[0].min(system.masses[1]);
        for i in 0..2 {
            let depth = places.iter().map(|place| place[i]).fold(0.0, f64::max);
            let passed = ends[i][0][0] <= 0.0 && ends[i][1][0] <= 0.0 && depth > 0.0;
            if passed && system.laws[i].force(depth) * step.h > NOTHING * lightest {
                return false;
            }
        }
        if places.iter().flatten().any(|place| *place > 0.0) {
            for i in 0..2 {
                self.raise(i, &places, approach);
            }
        }
        self.count(&places, approach, step.h);
        self.time += step.h;
        true
    }

    /// Counts touches and releases in a step of `h` s.
    fn count(&mut self, places: &[[f64; 2]; PLACES + 1], approach: impl Fn(f64) -> [f64; 2], h: f64) {
        let system = self.system;
        // bodies far apart touch nowhere
        let contact = |place: [f64; 2]| match place {
            [outer, inner] if outer <= 0.0 && inner <= 0.0 => (place, [0.0; 2]),
            place => system.contact(place, place).unwrap_or(([f64::NAN; 2], [f64::NAN; 2])),
        };
        let mut before = contact(places[0]).1;
        for (k, place) in places.iter().enumerate().skip(1) {
            let (local, force) = contact(*place);
            for i in 0..2 {
                let account = &mut self.contacts[i];
                if local[i] > 0.0 && !account.closed {
                    account.contacts += 1;
                    account.impulse = 0.0;
                }
                account.impulse += 0.5 * h / PLACES as f64 * (before[i] + force[i]);
                if local[i] <= 0.0 && account.closed {
                    if account.impulse <= NEGLIGIBLE * system.masses[0] * system.speed {
                        account.contacts -= 1;
                    } else {
                        let open = |u: f64| contact(approach(u)).0[i] <= 0.0;
                        account.end =
                            self.time + h * first(open, [k - 1, k].map(|k| k as f64 / PLACES as f64));
                    }
                }
                account.closed = local[i] > 0.0;
            }
            before = force;
        }
    }

    /// Raises the peak of contact `i` to the largest force of a step, given its `approach` and that at the `places`.
    fn raise(&mut self, i: usize, places: &[[f64; 2]; PLACES + 1], approach: impl Fn(f64) -> [f64; 2]) {
        let force = |approach: [f64; 2]| {
            self.system.contact(approach, approach).map_or(f64::NAN, |(_, forces)| forces[i])
        };
        let (mut highest, mut largest) = (0, 0.0);
        for (k, place) in places.iter().enumerate() {
            let force = force(*place);
            if force > largest {
                (highest, largest) = (k, force);
            }
        }
        let peak = &mut self.contacts[i].force_peak;
        if largest > NEARLY * *peak {
            let (mut place, mut distance) = (highest as f64 / PLACES as f64, 0.5 / PLACES as f64);
            for _ in 0..HALVINGS {
                for next in [place - distance, place + distance] {
                    let found = force(approach(next.clamp(0.0, 1.0)));
                    if found > largest {
                        (place, largest) = (next.clamp(0.0, 1.0), found);
                    }
                }
                distance *= 0.5;
            }
        }
        *peak = peak.max(largest);
    }
}

/// Place within the two `ends` at which `holds` begins to be true.
fn first(holds: impl Fn(f64) -> bool, [mut before, mut after]: [f64; 2]) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (before + after);
        if holds(middle) { after = middle } else { before = middle }
    }
    after
}

/// Hermite's polynomial of fifth degree at the place `u`, 0..1.
fn hermite(&[[y0, v0, a0], [y1, v1, a1]]: &Ends, u: f64) -> f64 {
    // Taylor's polynomial from the start, and what it misses at the end
    let missing = [y1 - y0 - v0 - 0.5 * a0, v1 - v0 - a0, a1 - a0];
    let [p, q, r] = missing;
    let cubic = 10.0 * p - 4.0 * q + 0.5 * r;
    let quartic = -15.0 * p + 7.0 * q - r;
    let quintic = 6.0 * p - 3.0 * q + 0.5 * r;
    y0 + u * (v0 + u * (0.5 * a0 + u * (cubic + u * (quartic + u * quintic))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_polynomial_of_fifth_degree_is_its_own() {
        let value = |u: f64| 2.0 - u + 3.0 * u.powi(2) - 4.0 * u.powi(3) + 0.5 * u.powi(4) + 7.0 * u.powi(5);
        let rate = |u: f64| -1.0 + 6.0 * u - 12.0 * u.powi(2) + 2.0 * u.powi(3) + 35.0 * u.powi(4);
        let bend = |u: f64| 6.0 - 24.0 * u + 6.0 * u.powi(2) + 140.0 * u.powi(3);
        let ends = [0.0, 1.0].map(|u| [value(u), rate(u), bend(u)]);
        for u in [0.0, 0.2, 0.7, 1.0] {
            assert_relative_eq!(hermite(&ends, u), value(u), epsilon = 1e-12);
        }
    }
}
