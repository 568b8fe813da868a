//! One contact over the latest steps, and what is read from it between them.

use crate::dynamics::collocation::{crossing, derivative, horner};
use crate::dynamics::contact_balance::{ContactBalance, EvenStep};

/// Steps that are kept: two on either side of the one whose work and peak are booked.
const KEPT: usize = 5;
const MIDDLE: usize = 2;

/// The latest steps of a contact, the last one last.
pub(super) struct ContactCourse {
    /// Modal approaches, m.
    approach: [f64; KEPT],
    /// Patches, negative of an open contact, m.
    local: [f64; KEPT],
    /// Forces, N.
    force: [f64; KEPT],
}

impl ContactCourse {
    /// Of a contact that has been open, now at the modal approach `approach` m.
    pub(super) fn open(approach: f64) -> Self {
        Self { approach: [approach; KEPT], local: [approach; KEPT], force: [0.0; KEPT] }
    }

    /// Force in N so many steps before the latest.
    #[inline(always)]
    pub(super) fn force_before(&self, steps: usize) -> f64 {
        self.force[KEPT - 1 - steps]
    }

    /// Whether the contact is open and no force acts on from the latest steps.
    #[inline(always)]
    pub(super) fn is_at_rest(&self) -> bool {
        self.force[MIDDLE..] == [0.0; KEPT - MIDDLE]
    }

    /// Patch in m to be expected at the next step: by a cubic polynomial while the contact stays closed or open, else by a line.
    #[inline(always)]
    pub(super) fn expected(&self) -> f64 {
        let [_, a, b, c, d] = self.local;
        let next = 4.0 * (d + b) - 6.0 * c - a;
        if (a > 0.0) == (next > 0.0) { next } else { 2.0 * d - c }
    }

    /// Adds a step.
    #[inline(always)]
    pub(super) fn go_on(&mut self, approach: f64, local: f64, force: f64) {
        for (values, value) in
            [&mut self.approach, &mut self.local, &mut self.force].into_iter().zip([approach, local, force])
        {
            values.copy_within(1.., 0);
            values[KEPT - 1] = value;
        }
    }

    /// Books the latest step, of `h` s from `time` s on.
    #[inline(always)]
    pub(super) fn book(&self, balance: &mut ContactBalance, time: f64, h: f64) {
        let [a, b, _, c, d] = self.approach;
        let change = (8.0 * (c - b) - (d - a)) / 12.0;
        let step = EvenStep {
            h,
            // a sum over all steps has no error but that of the first and the last
            mean: self.force_before(0),
            peak: self.peak(),
            local_approach: [self.local[KEPT - 2], self.local[KEPT - 1]],
            work: self.force[MIDDLE] * change,
        };
        balance.add_even(&step, || self.release(time, h));
    }

    /// Largest force around the middle step in N, by a polynomial of fourth degree while the contact is closed, else by a parabola.
    #[inline(always)]
    fn peak(&self) -> f64 {
        let [a, b, top, c, d] = self.force;
        if top <= 0.0 || top < b || top < c {
            return 0.0;
        }
        let (mut slope, mut bend) = (0.5 * (c - b), b + c - 2.0 * top);
        if a > 0.0 && d > 0.0 {
            slope = (8.0 * (c - b) - (d - a)) / 12.0;
            bend = (16.0 * (b + c) - (a + d) - 30.0 * top) / 12.0;
        }
        if bend < 0.0 { top - 0.5 * slope * slope / bend } else { top }
    }

    /// When the contact opens in the latest step, s, and how quickly, m/s, by a cubic polynomial.
    fn release(&self, time: f64, h: f64) -> (f64, f64) {
        let [_, a, b, c, d] = self.local;
        let polynomial =
            [c, a / 6.0 - b + 0.5 * c + d / 3.0, 0.5 * (b + d) - c, (d - a) / 6.0 + 0.5 * (b - c)];
        let place = crossing(&polynomial, [0.0, 1.0], [c, d]);
        (time + h * place, horner(&derivative(&polynomial), place) / h)
    }
}
