//! Forces and approaches of two contacts with given patches, and how they change with these.

use super::Residual;
use crate::contact::Hertz;
use crate::contact::patch_flexibility::{Bicubic, Cubic};

/// State of two contacts with the patches p.
#[derive(Debug, Clone, Copy, Default)]
pub struct State {
    /// p_i in m, not negative, at most the largest.
    p: [f64; 2],
    /// 1 where the patch may grow, else 0.
    grows: [f64; 2],
    /// 1 where the contact is a punch, else 0.
    punch: [f64; 2],
    /// Tangents of Hertz's laws at p, N/m.
    tangent: [f64; 2],
    /// 5 k p^(3/2), N.
    bending: [f64; 2],
    /// The half-spaces' 0.8/(k p^(1/2)), m/N; 0 without a patch.
    half_space: [f64; 2],
    /// Forces, N.
    pub f: [f64; 2],
    /// Relative curvatures.
    pub(super) c: [f64; 2],
    /// What 0.8 c_i p_i is, beyond the largest patch included, over 0.8; m.
    lifted: [f64; 2],
    /// R_ij, m/N.
    r: [[f64; 2]; 2],
    /// g_ij, 1/N.
    g: [[f64; 2]; 2],
    /// Derivatives of g_ii by p_i, 1/(N m).
    g_own: [f64; 2],
    /// Second derivatives of R_01 by p_0, p_0 and p_1, p_1, 1/(N m).
    g_mutual: [f64; 3],
    /// Inverse of I - 5 diag(k p^(3/2)) g, which gives the forces under k p^(3/2) alone.
    inverse: [[f64; 2]; 2],
}

/// What a contact's patch coordinate moves: forces, approaches. Shape (contact, coordinate).
pub(super) struct Slopes {
    pub(super) force: [[f64; 2]; 2],
    pub(super) approach: [[f64; 2]; 2],
}

impl Slopes {
    /// As [`State::step`]; `None` where the contacts' system has no unique answer.
    #[inline(always)]
    fn step(&self, error: [f64; 2]) -> Option<[f64; 2]> {
        let [[a, b], [c, e]] = self.approach;
        let determinant = a * e - b * c;
        if determinant.is_nan() || determinant <= 0.0 {
            return None;
        }
        let scale = 1.0 / determinant;
        Some([scale * (e * error[0] - b * error[1]), scale * (a * error[1] - c * error[0])])
    }
}

impl Residual {
    /// The state with the patches `p` in m, negative for an open contact.
    #[inline(always)]
    pub fn state(&self, laws: &[Hertz; 2], coordinate: [f64; 2]) -> State {
        let mut s = State::default();
        let mut pressed = [0.0; 2];
        for i in 0..2 {
            let p = coordinate[i].max(0.0).min(self.largest[i]);
            let beyond = (coordinate[i] - self.largest[i]).max(0.0);
            let per_patch = laws[i].stiffness * p.sqrt();
            let scale = self.per_patch[i];
            let Cubic { value, first, second } = Cubic::at(&self.own[i], scale * p);
            s.p[i] = p;
            s.tangent[i] = 1.5 * per_patch;
            s.half_space[i] = if per_patch > 0.0 { 0.8 / per_patch } else { 0.0 };
            s.grows[i] = f64::from(u8::from(coordinate[i] > 0.0 && beyond == 0.0));
            s.punch[i] = f64::from(u8::from(beyond > 0.0));
            s.lifted[i] = 1.5 * beyond;
            s.r[i][i] = value;
            s.g[i][i] = 0.5 * scale * first;
            s.g_own[i] = 0.5 * scale * scale * second;
            pressed[i] = per_patch * p + s.tangent[i] * beyond;
            s.bending[i] = 5.0 * per_patch * p;
        }
        let [w0, w1] = self.per_patch;
        let surface = Bicubic::at(&self.mutual, [w0 * s.p[0], w1 * s.p[1]]);
        (s.r[0][1], s.r[1][0]) = (surface.value, surface.value);
        (s.g[0][1], s.g[1][0]) = (w0 * surface.first[0], w1 * surface.first[1]);
        s.g_mutual = [w0 * w0 * surface.second[0], w0 * w1 * surface.second[1], w1 * w1 * surface.second[2]];
        let off = [s.bending[0] * s.g[0][1], s.bending[1] * s.g[1][0]];
        let own = [1.0 - s.bending[0] * s.g[0][0], 1.0 - s.bending[1] * s.g[1][1]];
        let scale = 1.0 / (own[0] * own[1] - off[0] * off[1]);
        s.inverse = [[scale * own[1], scale * off[0]], [scale * off[1], scale * own[0]]];
        s.f = [0, 1].map(|i| s.inverse[i][0] * pressed[0] + s.inverse[i][1] * pressed[1]);
        for i in 0..2 {
            s.c[i] = 1.0 + 5.0 * (s.g[i][0] * s.f[0] + s.g[i][1] * s.f[1]);
            s.lifted[i] += s.c[i] * s.p[i];
        }
        s
    }
}

impl State {
    /// Relative curvatures under the forces `f` in N.
    pub(super) fn curvature(&self, f: [f64; 2]) -> [f64; 2] {
        self.g.map(|[g0, g1]| 1.0 + 5.0 * (g0 * f[0] + g1 * f[1]))
    }

    /// Flexibilities beyond the half-spaces in m/N. Shape (2, 2).
    pub fn beyond_half_spaces(&self) -> [[f64; 2]; 2] {
        self.r
    }

    /// Strain energy of the contacts in J.
    #[inline(always)]
    pub(super) fn energy(&self) -> f64 {
        let of = |i: usize| {
            self.f[i] * (0.4 * self.lifted[i] + 0.5 * (self.r[i][0] * self.f[0] + self.r[i][1] * self.f[1]))
        };
        of(0) + of(1)
    }

    /// One Newton step for the patches in m at `y` in m, from `p`, that of this state, with a `further` flexibility
    /// (0,0), (0,1) = (1,0), (1,1) in m/N; `None` if there is no equilibrium near.
    #[inline(always)]
    pub fn newton(&self, further: [f64; 3], y: [f64; 2], p: [f64; 2]) -> Option<[f64; 2]> {
        let step = self.step(further, self.error(further, y, p))?;
        Some([p[0] - step[0], p[1] - step[1]])
    }

    /// [`Self::newton`]'s patches in m, and the forces in N with them as they grow from this state on.
    #[inline(always)]
    pub fn newton_with_forces(
        &self,
        further: [f64; 3],
        y: [f64; 2],
        p: [f64; 2],
    ) -> Option<([f64; 2], [f64; 2])> {
        let slopes = self.slopes(further);
        let step = slopes.step(self.error(further, y, p))?;
        let force = |i: usize| self.f[i] - slopes.force[i][0] * step[0] - slopes.force[i][1] * step[1];
        Some(([p[0] - step[0], p[1] - step[1]], [force(0), force(1)]))
    }

    /// R_ij with a `further` flexibility.
    #[inline(always)]
    fn flexibility(&self, [own0, mutual, own1]: [f64; 3]) -> [[f64; 2]; 2] {
        let [[a, b], [c, e]] = self.r;
        [[a + own0, b + mutual], [c + mutual, e + own1]]
    }

    /// What this state with the patches `p` misses of the approaches `y`, m.
    #[inline(always)]
    pub(super) fn error(&self, further: [f64; 3], y: [f64; 2], p: [f64; 2]) -> [f64; 2] {
        let r = self.flexibility(further);
        [0, 1].map(|i| {
            let own = if p[i] > 0.0 { 0.8 * self.lifted[i] + 0.2 * self.p[i] } else { p[i] };
            own + r[i][0] * self.f[0] + r[i][1] * self.f[1] - y[i]
        })
    }

    /// Newton's step in the patches, m, to be taken off, that answers `error` in m.
    #[inline(always)]
    pub(super) fn step(&self, further: [f64; 3], error: [f64; 2]) -> Option<[f64; 2]> {
        self.slopes(further).step(error)
    }

    /// Derivatives by the patches; an open contact has y_i = p_i + what it yields. With U stationary in the patches,
    /// dy_i = sum_j (d^2 U/dF_i dF_j dF_j + d^2 U/dF_i dp_j dp_j).
    #[inline(always)]
    pub(super) fn slopes(&self, further: [f64; 3]) -> Slopes {
        let ([[r00, r01], [r10, r11]], [[g00, g01], [g10, g11]]) = (self.flexibility(further), self.g);
        let ([f0, f1], [twice0, both, twice1]) = (self.f, self.g_mutual);
        let flexibility = [[r00 + self.half_space[0], r01], [r10, r11 + self.half_space[1]]];
        // sum_j dg_ij/dp_m F_j and d^2 U/dF_i dp_m
        let bent =
            [[self.g_own[0] * f0 + twice0 * f1, both * f1], [both * f0, self.g_own[1] * f1 + twice1 * f0]];
        let [c0, c1] = self.c;
        let moved = [
            [2.0 * g00 * f0 + g01 * f1 - 0.4 * c0 + 0.2, g10 * f1],
            [g01 * f0, 2.0 * g11 * f1 + g10 * f0 - 0.4 * c1 + 0.2],
        ];
        let mut slopes = Slopes { force: [[0.0; 2]; 2], approach: [[0.0; 2]; 2] };
        for m in 0..2 {
            let grows = self.grows[m];
            let mut pressed = [0, 1].map(|i| self.bending[i] * bent[i][m] * grows);
            pressed[m] += self.tangent[m] * (grows * self.c[m] + self.punch[m]);
            let force = [0, 1].map(|i| self.inverse[i][0] * pressed[0] + self.inverse[i][1] * pressed[1]);
            for i in 0..2 {
                slopes.force[i][m] = force[i];
                slopes.approach[i][m] =
                    flexibility[i][0] * force[0] + flexibility[i][1] * force[1] + moved[i][m] * grows;
            }
            slopes.approach[m][m] += 1.0 - grows - self.punch[m];
        }
        slopes
    }
}
