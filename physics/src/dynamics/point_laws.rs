//! What the contacts answer at one Gauss point of a step, with the newest forces at the others.
//!
//! The point's own forces act back on its approaches at once; a visit is one Newton step for both together.

use super::step_table::StepTable;
use crate::contact::{Hertz, Residual, State};
use crate::numerics::stages::{STAGES, Stages};
use wide::f64x4;

/// What is known of a Gauss point from the visit before.
#[derive(Clone, Copy)]
pub(super) struct Visit {
    /// Which Gauss point.
    pub(super) point: usize,
    /// Approaches in m under the newest forces.
    pub(super) approach: [f64; 2],
    /// Patches in m.
    pub(super) local: [f64; 2],
    /// Forces in N.
    pub(super) force: [f64; 2],
}

/// Patches in m and forces in N of both contacts.
pub(super) type Answer = ([f64; 2], [f64; 2]);

/// A way to bring patches and forces of a point closer to equilibrium.
pub(super) trait PointLaw {
    /// Before the first sweep: the forces in N at `point` with the patches `local` in m.
    fn begin(&mut self, point: usize, local: [f64; 2]) -> [f64; 2];
    /// Before each sweep: the patches at all points.
    fn prepare(&mut self, local: &[Stages; 2]);
    /// `None` if there is no equilibrium near.
    fn visit(&mut self, visit: Visit) -> Option<Answer>;
}

/// Hertz's contacts: Newton steps, with the tangents of the sweep before at all points at once.
pub(super) struct HertzPoints<'a> {
    laws: &'a [Hertz; 2],
    /// Approach lost per force of the same point in m/N: contacts (0,0), (0,1) = (1,0), (1,1).
    coupling: [f64x4; 3],
    /// Inverse of 1 + coupling tangent, row by row.
    inverse: [[f64; STAGES]; 4],
}

/// Each point's coupling with itself.
fn own(table: &StepTable) -> [f64x4; 3] {
    table.coupling.map(|columns| f64x4::from(std::array::from_fn(|j| columns[j].as_array()[j])))
}

impl<'a> HertzPoints<'a> {
    pub(super) fn new(laws: &'a [Hertz; 2], table: &StepTable) -> Self {
        Self { laws, coupling: own(table), inverse: [[0.0; STAGES]; 4] }
    }
}

impl PointLaw for HertzPoints<'_> {
    #[inline(always)]
    fn begin(&mut self, _: usize, local: [f64; 2]) -> [f64; 2] {
        [self.laws[0].force(local[0]), self.laws[1].force(local[1])]
    }

    #[inline(always)]
    fn prepare(&mut self, local: &[Stages; 2]) {
        let tangent = |i: usize| {
            f64x4::from(local[i]).fast_max(f64x4::ZERO).sqrt() * f64x4::splat(1.5 * self.laws[i].stiffness)
        };
        let [first, second] = [tangent(0), tangent(1)];
        let [own0, mutual, own1] = self.coupling;
        let (a, b) = (f64x4::ONE + own0 * first, mutual * second);
        let (c, e) = (mutual * first, f64x4::ONE + own1 * second);
        let scale = f64x4::ONE / (a * e - b * c);
        self.inverse = [e * scale, -b * scale, -c * scale, a * scale].map(f64x4::to_array);
    }

    #[inline(always)]
    fn visit(&mut self, visit: Visit) -> Option<Answer> {
        let j = visit.point;
        let error = [visit.local[0] - visit.approach[0], visit.local[1] - visit.approach[1]];
        let [a, b, c, e] = &self.inverse;
        let p = [
            visit.local[0] - (a[j] * error[0] + b[j] * error[1]),
            visit.local[1] - (c[j] * error[0] + e[j] * error[1]),
        ];
        Some((p, [self.laws[0].force(p[0]), self.laws[1].force(p[1])]))
    }
}

/// Contacts with a residual flexibility.
pub(super) struct ResidualPoints<'a> {
    laws: &'a [Hertz; 2],
    residual: Residual,
    /// As in [`HertzPoints`].
    coupling: [f64x4; 3],
    /// Whether every visit solves the point fully, from its approaches; else it takes a Newton step.
    full: bool,
    /// The contacts at every point as the latest visit left them.
    states: [State; STAGES],
}

impl<'a> ResidualPoints<'a> {
    pub(super) fn new(laws: &'a [Hertz; 2], residual: Residual, table: &StepTable, full: bool) -> Self {
        Self { laws, residual, coupling: own(table), full, states: [State::default(); STAGES] }
    }
}

impl PointLaw for ResidualPoints<'_> {
    #[inline(always)]
    fn begin(&mut self, point: usize, local: [f64; 2]) -> [f64; 2] {
        self.states[point] = self.residual.state(self.laws, local);
        self.states[point].f
    }

    fn prepare(&mut self, _: &[Stages; 2]) {}

    #[inline(always)]
    fn visit(&mut self, visit: Visit) -> Option<Answer> {
        // the motion of the bodies within the step yields like a further flexibility
        let further = self.coupling.map(|c| c.as_array()[visit.point]);
        let ([own0, mutual, own1], [f0, f1]) = (further, visit.force);
        // the approaches if the forces of this point did not act
        let y = [visit.approach[0] + own0 * f0 + mutual * f1, visit.approach[1] + mutual * f0 + own1 * f1];
        if self.full {
            return self.residual.with(further).solve(self.laws, y, y);
        }
        let p = self.states[visit.point].newton(further, y, visit.local)?;
        Some((p, self.begin(visit.point, p)))
    }
}
