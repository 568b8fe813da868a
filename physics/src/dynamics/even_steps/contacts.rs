//! The forces at the end of a step: those that both contacts answer to the approaches under these forces.

use super::course::ContactCourse;
use crate::contact::{Hertz, Residual};
use crate::dynamics::system::System;

/// Newton's steps at most.
const MOST_STEPS: usize = 20;
/// Change of an approach, relative, below which a further Newton step would change nothing that matters: Hertz's forces follow it by a
/// parabola, those of patches by a line.
const SMALL: f64 = 0.03;
const SMALL_OF_PATCHES: f64 = 1e-3;

/// Both contacts at the end of a step.
pub(super) struct Answered {
    /// Modal approaches, m.
    pub(super) approach: [f64; 2],
    /// Patches (see [`System::contact`]), m.
    pub(super) local: [f64; 2],
    /// Forces, N.
    pub(super) force: [f64; 2],
}

/// Two contacts and the flexibility in m/N with which the bodies answer within a step: (0,0), (0,1) = (1,0), (1,1).
pub(super) struct EvenContacts<'a> {
    laws: &'a [Hertz; 2],
    residual: Option<&'a Residual>,
    flexibility: [f64; 3],
}

/// Whether a Newton step from `from` to `to` is a `small` one.
#[inline(always)]
fn is_found(from: [f64; 2], to: [f64; 2], small: f64) -> bool {
    (0..2).all(|i| (to[i] - from[i]).abs() <= small * to[i].abs())
}

impl<'a> EvenContacts<'a> {
    pub(super) fn new(system: &'a System, flexibility: [f64; 3]) -> Self {
        Self { laws: &system.laws, residual: system.residual.as_ref(), flexibility }
    }

    /// The answer to the approaches `free` that there would be without forces at this step, after the `courses` up to the step before; `None`
    /// if there is none near.
    #[inline(always)]
    pub(super) fn answer(&self, free: [f64; 2], courses: &[ContactCourse; 2]) -> Option<Answered> {
        if free[0] <= 0.0 && free[1] <= 0.0 {
            return Some(Answered { approach: free, local: free, force: [0.0; 2] });
        }
        let expected = [0, 1].map(|i| courses[i].expected());
        let (local, force) = match self.residual {
            None => self.hertz(free, expected),
            Some(residual) => self.with_residual(residual, free, expected),
        }?;
        Some(Answered { approach: self.yielded(free, force), local, force })
    }

    /// The approaches `free` less what the bodies yield at once under `force`.
    #[inline(always)]
    fn yielded(&self, free: [f64; 2], force: [f64; 2]) -> [f64; 2] {
        let [outer, mutual, inner] = self.flexibility;
        [free[0] - outer * force[0] - mutual * force[1], free[1] - mutual * force[0] - inner * force[1]]
    }

    /// Approaches and forces of Hertz's contacts.
    #[inline(always)]
    fn hertz(&self, free: [f64; 2], mut local: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
        let [outer, mutual, inner] = self.flexibility;
        for _ in 0..MOST_STEPS {
            let root = [0, 1].map(|i| self.laws[i].stiffness * local[i].max(0.0).sqrt());
            let force = [root[0] * local[0], root[1] * local[1]];
            let tangent = root.map(|root| 1.5 * root);
            let yielded = self.yielded(free, force);
            let error = [local[0] - yielded[0], local[1] - yielded[1]];
            let (a, b) = (1.0 + outer * tangent[0], mutual * tangent[1]);
            let (c, e) = (mutual * tangent[0], 1.0 + inner * tangent[1]);
            let scale = 1.0 / (a * e - b * c);
            let step = [scale * (b * error[1] - e * error[0]), scale * (c * error[0] - a * error[1])];
            let before = local;
            local = [local[0] + step[0], local[1] + step[1]];
            if is_found(before, local, SMALL) {
                let follow = |i: usize| tangent[i] * step[i] * (1.0 + 0.25 * step[i] / before[i]);
                return Some((
                    local,
                    [0, 1].map(|i| if local[i] > 0.0 { force[i] + follow(i) } else { 0.0 }),
                ));
            }
        }
        None
    }

    /// Patches and forces of contacts with a residual flexibility.
    #[inline(always)]
    fn with_residual(
        &self,
        residual: &Residual,
        free: [f64; 2],
        mut local: [f64; 2],
    ) -> Option<([f64; 2], [f64; 2])> {
        for _ in 0..MOST_STEPS {
            let (next, force) = residual.newton(self.laws, self.flexibility, free, local)?;
            let before = std::mem::replace(&mut local, next);
            if is_found(before, local, SMALL_OF_PATCHES) {
                return Some((local, force));
            }
        }
        None
    }
}
