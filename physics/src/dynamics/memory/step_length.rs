//! The length of the steps of a contact: what the run asks for, and longer by powers of two while both forces change so evenly that they
//! are resolved as well as Hertz's at that length. What has relaxed can press for a thousand times as long as an impact lasts.

use std::f64::consts::PI;

/// Bend of a force within a step over that of Hertz's at the shortest length: below which so many steps in a row are followed by longer
/// ones, and above which a step is too long.
const EVEN: (f64, u32) = (0.02, 32);
const LOW_ACCURACY: f64 = 0.5;
/// Most doublings.
const LONGEST: usize = 40;

/// The length of the next step.
#[derive(Debug)]
pub(super) struct StepLength {
    /// Shortest length, and the duration of the outer body's impact on a rigid wall, s.
    shortest: f64,
    contact_time: f64,
    level: usize,
    even: u32,
    /// Rates in N/s at which both forces changed in the step before; none at first.
    rate: Option<[f64; 2]>,
}

impl StepLength {
    pub(super) fn new(shortest: f64, contact_time: f64) -> Self {
        Self { shortest, contact_time, level: 0, even: 0, rate: None }
    }

    /// In s after `level` doublings.
    pub(super) fn of(&self, level: usize) -> f64 {
        self.shortest * 2.0_f64.powi(level as i32)
    }

    /// Begins anew.
    pub(super) fn reset(&mut self) {
        *self = Self::new(self.shortest, self.contact_time);
    }

    /// Doublings of the next step, which stays within the `rest` of a run in s.
    pub(super) fn level_within(&mut self, rest: f64) -> usize {
        while self.of(self.level) > rest * (1.0 + 1e-9) && self.shorten() {}
        self.level
    }

    /// The next step is half as long; `false` if there is no shorter one.
    pub(super) fn shorten(&mut self) -> bool {
        self.even = 0;
        let shorter = self.level > 0;
        self.level -= usize::from(shorter);
        shorter
    }

    /// Whether the step from `time` s on with the `forces` in N at its ends can be kept, else it is to be taken again with half the length;
    /// `peaks` are the largest so far.
    pub(super) fn keeps(&mut self, time: f64, [start, end]: [[f64; 2]; 2], peaks: [f64; 2]) -> bool {
        let h = self.of(self.level);
        let hertz = (PI * self.shortest / self.contact_time).powi(2);
        let bend = |rate: [f64; 2]| {
            let of = |i: usize| {
                // a small force matters by its impulse
                let scale = start[i].max(end[i]).max(peaks[i] * self.contact_time / (time + h));
                if scale > 0.0 { (end[i] - start[i] - rate[i] * h).abs() / (hertz * scale) } else { 0.0 }
            };
            of(0).max(of(1))
        };
        let bend = self.rate.filter(|_| start != [0.0; 2]).map_or(f64::INFINITY, bend);
        if bend > LOW_ACCURACY && self.shorten() {
            return false;
        }
        let (even, enough) = EVEN;
        self.even = if bend < even { self.even + 1 } else { 0 };
        self.rate = Some([0, 1].map(|i| (end[i] - start[i]) / h));
        if self.even == enough && self.level < LONGEST {
            (self.level, self.even) = (self.level + 1, 0);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const CONTACT_TIME: f64 = 1e-5;

    /// Steps and impulse, by the trapezoidal rule, of a force in N over time up to `end` s.
    fn driven(force: impl Fn(f64) -> f64, end: f64) -> (usize, f64) {
        let mut length = StepLength::new(CONTACT_TIME / 200.0, CONTACT_TIME);
        let (mut time, mut steps, mut impulse, mut peak) = (0.0, 0, 0.0, 0.0_f64);
        while time < end * (1.0 - 1e-9) {
            let level = length.level_within(end - time);
            let h = length.of(level);
            let forces = [force(time), force(time + h)];
            if length.keeps(time, forces.map(|force| [force, 0.0]), [peak, 0.0]) {
                impulse += 0.5 * h * (forces[0] + forces[1]);
                peak = peak.max(forces[1]);
                (time, steps) = (time + h, steps + 1);
            }
        }
        (steps, impulse)
    }

    #[test]
    fn an_impact_keeps_its_steps() {
        let (steps, _) = driven(|t| (PI * t / CONTACT_TIME).sin(), CONTACT_TIME);
        assert_eq!(steps, 200);
    }

    /// A force that dies away over a hundred contact times, and one that also jumps in its slope on the way.
    #[test]
    fn slow_forces_take_long_steps_and_keep_their_impulse() {
        let (slow, end) = (100.0 * CONTACT_TIME, 1000.0 * CONTACT_TIME);
        let jump = 317.3 * CONTACT_TIME;
        let (steps, impulse) = driven(|t| (-t / slow).exp(), end);
        assert!(steps < 6_000, "{steps}");
        assert_relative_eq!(impulse, slow * (1.0 - (-end / slow).exp()), max_relative = 1e-4);
        let kinked = |t: f64| (-t / slow).exp() + 0.1 * (1.0 - (t - jump).abs() / slow).max(0.0);
        let (_, impulse) = driven(kinked, end);
        assert_relative_eq!(impulse, slow * (1.1 - (-end / slow).exp()), max_relative = 1e-4);
    }
}
