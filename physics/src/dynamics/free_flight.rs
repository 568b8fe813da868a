//! Flight with both contacts open: exact, and ended at the next touch or for good.
//!
//! The gap of a contact is linear in the rigid motions plus free vibration. Its second derivative is bounded
//! by the amplitudes of the modes, so that steps can be chosen that provably pass no touch; near a touch they
//! shrink like Newton's iteration. When the bodies recede and the gap exceeds all the amplitudes together, no
//! further contact is possible.

use super::system::{INNER, System};
use crate::error::{Error, Result};

/// What comes after a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Flight {
    /// A contact touches after this time in s.
    Contact(f64),
    /// No contact can touch any more.
    Over,
}

/// Evaluations after which a flight counts as endless.
const MAX_EVALUATIONS: usize = 1_000_000;
/// Evaluations after which the bounds are drawn anew: damped modes have decayed meanwhile.
const RENEWAL: usize = 500;

/// Time from the state (`q`, `v`), both contacts open, to the next touch. Touches after `limit` s are not looked for:
/// the flight is then over.
///
/// # Errors
/// [`Error::Solver`] if the bodies neither touch nor recede within [`MAX_EVALUATIONS`] evaluations.
pub fn next_contact(system: &System, q: &[f64], v: &[f64], limit: f64) -> Result<Flight> {
    // a run whose end is given is about the bender's later strikes too
    let endless = limit.is_infinite() && system.outer_returns();
    if endless && inner_is_out_of_reach(system, &GapBounds::new(system, system.inner_contact(), q, v), q, v) {
        return Ok(Flight::Over);
    }
    let (mut q, mut v, mut start) = (q.to_vec(), v.to_vec(), 0.0);
    for _ in 0..MAX_EVALUATIONS / RENEWAL {
        match search(system, &q, &v, limit - start) {
            ContactSearch::Found(Flight::Contact(time)) => return Ok(Flight::Contact(start + time)),
            ContactSearch::Found(Flight::Over) => return Ok(Flight::Over),
            ContactSearch::NotYet(time) => {
                advance(system, time, &mut q, &mut v);
                start += time;
            }
        }
    }
    Err(Error::Solver(format!(
        "free flight: no contact and no end found within {start:.3e} s ({MAX_EVALUATIONS} evaluations); set `run.end_time`"
    )))
}

/// What a search came to.
enum ContactSearch {
    Found(Flight),
    /// No touch up to this time in s.
    NotYet(f64),
}

/// Looks for a touch within `limit` s by [`RENEWAL`] evaluations.
fn search(system: &System, q: &[f64], v: &[f64], limit: f64) -> ContactSearch {
    let bounds = [GapBounds::new(system, 0, q, v), GapBounds::new(system, 1, q, v)];
    let mut time = 0.0;
    for _ in 0..RENEWAL {
        let mut step = f64::INFINITY;
        for bound in &bounds {
            let Some(horizon) = bound.horizon(time) else { continue };
            let (gap, rate) = bound.gap(system, q, v, time);
            let scale = bound.elastic.max(bound.rigid_gap.abs());
            if gap <= 1e-14 * scale && rate < 0.0 {
                return ContactSearch::Found(Flight::Contact(time));
            }
            let safe = bound.safe_step(gap.max(0.0), rate).max(bound.out_of_reach(time));
            step = step.min(safe).min(horizon.max(1e-3 * bound.shortest_period));
        }
        if step.is_infinite() || time > limit {
            return ContactSearch::Found(Flight::Over);
        }
        // a step of round-off size: the touch is here
        if time + step == time {
            return ContactSearch::Found(Flight::Contact(time));
        }
        time += step;
    }
    ContactSearch::NotYet(time)
}

/// Whether no contact can touch any more in free flight from the state (`q`, `v`), both contacts open.
pub fn is_over(system: &System, q: &[f64], v: &[f64]) -> bool {
    if system.outer_returns() {
        return inner_is_gone(system, q, v);
    }
    [1, 0].into_iter().all(|contact| GapBounds::new(system, contact, q, v).horizon(0.0).is_none())
}

/// Whether the inner body, which is free, recedes and is out of reach in the state (`q`, `v`), whatever the outer one does to the plate.
pub fn inner_is_gone(system: &System, q: &[f64], v: &[f64]) -> bool {
    inner_is_out_of_reach(system, &GapBounds::new(system, system.inner_contact(), q, v), q, v)
}

/// A time in s within which no contact can touch in free flight from the state (`q`, `v`).
pub fn safe_step(system: &System, q: &[f64], v: &[f64]) -> f64 {
    let safe = |contact: usize| GapBounds::new(system, contact, q, v).safe(system, q, v);
    safe(0).min(safe(1))
}

/// The same, infinite where no contact can touch any more; the outer body has no spring of its own.
pub fn safe_time(system: &System, q: &[f64], v: &[f64]) -> f64 {
    let safe = |contact: usize| {
        let bounds = GapBounds::new(system, contact, q, v);
        bounds.horizon(0.0).map_or(f64::INFINITY, |_| bounds.safe(system, q, v))
    };
    safe(0).min(safe(1))
}

/// The state after `time` s of free flight, in place.
pub fn advance(system: &System, time: f64, q: &mut [f64], v: &mut [f64]) {
    for (oscillator, (q, v)) in system.oscillators.iter().zip(q.iter_mut().zip(v)) {
        [*q, *v] = oscillator.after(time, [*q, *v]);
    }
}

/// Whether the inner body recedes and is beyond what the plate can reach with all the energy there is.
///
/// A bender swings back to the plate for ever; what it does to the plate then can't concern the inner body any more. Nor does a stack that
/// is charged so slowly that its tip falls behind the inner body.
fn inner_is_out_of_reach(system: &System, bounds: &GapBounds, q: &[f64], v: &[f64]) -> bool {
    let own = 0.5 * v[INNER].powi(2);
    let plate = system
        .oscillators
        .iter()
        .zip(&system.approach[bounds.contact])
        .enumerate()
        .filter(|(k, _)| *k != INNER);
    // |sum of b q|^2 <= (sum of b^2/omega^2) (sum of omega^2 q^2), infinite for a free plate
    let flexibility: f64 =
        plate.filter(|(_, (_, b))| **b != 0.0).map(|(_, (o, b))| (b / o.omega).powi(2)).sum();
    let gone = |energy: f64, speed: f64| {
        bounds.rigid_rate >= speed && bounds.rigid_gap > (2.0 * (energy - own) * flexibility).sqrt()
    };
    gone(system.energy_left(q, v), 0.0)
        || system.energy_but_charging(q, v).is_some_and(|(energy, speed)| gone(energy, speed))
}

/// Bounds on the gap of one contact during free flight.
struct GapBounds {
    contact: usize,
    /// Rigid part of the gap in m at the start, and its rate in m/s.
    rigid_gap: f64,
    rigid_rate: f64,
    /// Largest elastic displacement in m and acceleration in m/s^2.
    elastic: f64,
    acceleration: f64,
    /// Shortest period of a mode in s.
    shortest_period: f64,
}

impl GapBounds {
    fn new(system: &System, contact: usize, q: &[f64], v: &[f64]) -> Self {
        let b = &system.approach[contact];
        let mut bounds = Self {
            contact,
            rigid_gap: system.gap[contact],
            rigid_rate: 0.0,
            elastic: 0.0,
            acceleration: 0.0,
            shortest_period: f64::INFINITY,
        };
        for (k, oscillator) in system.oscillators.iter().enumerate() {
            if oscillator.omega == 0.0 {
                bounds.rigid_gap -= b[k] * q[k];
                bounds.rigid_rate -= b[k] * v[k];
                continue;
            }
            // energy bound of the amplitude; it only decays when damped
            let omega = oscillator.omega;
            let amplitude = b[k].abs() * q[k].hypot(v[k] / omega);
            bounds.elastic += amplitude;
            bounds.acceleration += amplitude * omega * (omega + 2.0 * oscillator.alpha);
            bounds.shortest_period = bounds.shortest_period.min(2.0 * std::f64::consts::PI / omega);
        }
        bounds
    }

    /// Gap in m and its rate in m/s at `time`.
    fn gap(&self, system: &System, q: &[f64], v: &[f64], time: f64) -> (f64, f64) {
        let b = &system.approach[self.contact];
        let (mut gap, mut rate) = (self.rigid_gap + self.rigid_rate * time, self.rigid_rate);
        for (k, oscillator) in system.oscillators.iter().enumerate() {
            if oscillator.omega > 0.0 {
                let [q, v] = oscillator.after(time, [q[k], v[k]]);
                gap -= b[k] * q;
                rate -= b[k] * v;
            }
        }
        (gap, rate)
    }

    /// Time left from `time` in which a touch is possible; `None` if it is not any more.
    fn horizon(&self, time: f64) -> Option<f64> {
        let gap = self.rigid_gap + self.rigid_rate * time;
        if self.rigid_rate >= 0.0 && gap > self.elastic {
            None
        } else if self.rigid_rate > 0.0 {
            Some((self.elastic - gap) / self.rigid_rate)
        } else {
            Some(f64::INFINITY)
        }
    }

    /// Time in s from `time` on for which the gap of the rigid motions alone exceeds all amplitudes together.
    fn out_of_reach(&self, time: f64) -> f64 {
        let beyond = self.rigid_gap + self.rigid_rate * time - self.elastic;
        if beyond <= 0.0 {
            0.0
        } else if self.rigid_rate < 0.0 {
            beyond / -self.rigid_rate
        } else {
            f64::INFINITY
        }
    }

    /// [`Self::safe_step`] from the start, of which `q` and `v` are the state.
    fn safe(&self, system: &System, q: &[f64], v: &[f64]) -> f64 {
        let (gap, rate) = self.gap(system, q, v, 0.0);
        self.safe_step(gap.max(0.0), rate)
    }

    /// A step in s from a gap and its rate within which the gap cannot close: gap + rate t - acceleration t^2/2 >= 0.
    fn safe_step(&self, gap: f64, rate: f64) -> f64 {
        if self.acceleration == 0.0 {
            return if rate < 0.0 { gap / -rate } else { f64::INFINITY };
        }
        let root = (rate * rate + 2.0 * self.acceleration * gap).sqrt();
        // the form without cancellation for either sign of the rate
        if rate >= 0.0 { (rate + root) / self.acceleration } else { 2.0 * gap / (root - rate) }
    }
}
