//! The contacts' small nonlinear system when the bodies keep a residual flexibility.
//!
//! Beyond Hertz's half-spaces the bodies yield by R_ij F_j. R is smooth in the patches over which the forces are
//! spread: R_ij = R0_ij + b_ij a_i^2 + b_ji a_j^2 with the patch radii a_i. Under Hertz's pressures the complementary
//! energy of the contacts of tips of radii r_i and 1/E* the sum of both bodies' (1 - nu^2)/E is
//!
//!   U = sum_i (0.3 F_i^2/(E* a_i) + F_i a_i^2/(5 r_i)) + 1/2 sum_ij F_i F_j R_ij.
//!
//! It is stationary in the patch radii, a_i^3 = 3 F_i r'_i/(4 E*) with 1/r'_i = 1/r_i + 5 sum_j b_ij F_j: what the
//! bodies yield beyond half-spaces also curves their faces. Its derivative by F_i is the approach that rigid motion
//! and modes have to give, y_i = a_i^2/r'_i + sum_j F_j (R0_ij + b_ji a_j^2). With p_i = a_i^2/r_i, the approach at which
//! undeformed faces would have this patch, g_ij = b_ij r_i, and the relative curvature c_i = r_i/r'_i:
//!
//!   c_i = 1 + 5 sum_j g_ij F_j,   F_i = k_i p_i^(3/2) c_i,   y_i = c_i p_i + sum_j F_j (R0_ij + g_ji p_j).
//!
//! R is symmetric; its diagonal may be negative. A face curved until it fits the tip (c_i = 0) has no such patch.

use super::Hertz;

/// Newton steps after which the system counts as unsolvable.
const MAX_ITERATIONS: usize = 60;

/// Residual flexibility of two contacts in terms of their approaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// R0 in m/N, for patches of no extent.
    pub flexibility: [[f64; 2]; 2],
    /// g_ij in 1/N: growth of R_ij per m of the Hertz approach of contact i.
    pub growth: [[f64; 2]; 2],
}

/// State of two contacts with the patches p.
#[derive(Debug, Clone, Copy, Default)]
pub struct State {
    /// p_i in m, not negative.
    p: [f64; 2],
    /// Tangents of Hertz's laws at p, N/m.
    tangent: [f64; 2],
    /// Forces, N.
    pub f: [f64; 2],
    /// Relative curvatures.
    c: [f64; 2],
    /// Inverse of I - 5 diag(k p^(3/2)) g, which gives the forces under k p^(3/2) alone.
    inverse: [[f64; 2]; 2],
}

impl Residual {
    /// Whether there is none.
    pub fn is_zero(&self) -> bool {
        self.flexibility.iter().chain(&self.growth).flatten().all(|r| *r == 0.0)
    }

    /// The same with a further `flexibility` (0,0), (0,1) = (1,0), (1,1) in m/N.
    #[inline(always)]
    pub fn with(&self, [own0, mutual, own1]: [f64; 3]) -> Self {
        let [[a, b], [c, e]] = self.flexibility;
        Self { flexibility: [[a + own0, b + mutual], [c + mutual, e + own1]], growth: self.growth }
    }

    /// Relative curvatures under the forces `f` in N.
    #[inline(always)]
    fn curvature(&self, f: [f64; 2]) -> [f64; 2] {
        let g = &self.growth;
        [1.0 + 5.0 * (g[0][0] * f[0] + g[0][1] * f[1]), 1.0 + 5.0 * (g[1][0] * f[0] + g[1][1] * f[1])]
    }

    /// The state with the patches `p` in m, negative for an open contact.
    #[inline(always)]
    pub fn state(&self, laws: &[Hertz; 2], p: [f64; 2]) -> State {
        let g = &self.growth;
        let p = [p[0].max(0.0), p[1].max(0.0)];
        let per_patch = [laws[0].stiffness * p[0].sqrt(), laws[1].stiffness * p[1].sqrt()];
        let alone = [per_patch[0] * p[0], per_patch[1] * p[1]];
        let off = [5.0 * alone[0] * g[0][1], 5.0 * alone[1] * g[1][0]];
        let own = [1.0 - 5.0 * alone[0] * g[0][0], 1.0 - 5.0 * alone[1] * g[1][1]];
        let scale = 1.0 / (own[0] * own[1] - off[0] * off[1]);
        let inverse = [[scale * own[1], scale * off[0]], [scale * off[1], scale * own[0]]];
        let f = [0, 1].map(|i| inverse[i][0] * alone[0] + inverse[i][1] * alone[1]);
        State { p, tangent: per_patch.map(|k| 1.5 * k), f, c: self.curvature(f), inverse }
    }

    /// What contact `i` yields beyond c_i p_i, in m.
    #[inline(always)]
    fn yielded(&self, p: [f64; 2], f: [f64; 2], i: usize) -> f64 {
        let (r, g) = (&self.flexibility, &self.growth);
        f[0] * (r[i][0] + g[0][i] * p[0]) + f[1] * (r[i][1] + g[1][i] * p[1])
    }

    /// Derivative of the approaches y by the patches p; an open contact has y_i = p_i + what it yields.
    #[inline(always)]
    fn jacobian(&self, s: &State) -> [[f64; 2]; 2] {
        let (r, g) = (&self.flexibility, &self.growth);
        let growing = [s.c[0] * s.tangent[0], s.c[1] * s.tangent[1]];
        let entry = |i: usize, m: usize| {
            let per_force = |j: usize| 5.0 * s.p[i] * g[i][j] + r[i][j] + g[j][i] * s.p[j];
            (per_force(0) * s.inverse[0][m] + per_force(1) * s.inverse[1][m]) * growing[m] + s.f[m] * g[m][i]
        };
        let own = |i: usize| if s.p[i] > 0.0 { s.c[i] } else { 1.0 };
        [[own(0) + entry(0, 0), entry(0, 1)], [entry(1, 0), own(1) + entry(1, 1)]]
    }

    /// Strain energy in J of the contacts under the forces `f` in N with the patches `p` in m that go with them.
    #[inline(always)]
    pub fn energy(&self, f: [f64; 2], p: [f64; 2]) -> f64 {
        let c = self.curvature(f);
        let work = |i: usize| f[i] * (c[i] * p[i] + self.yielded(p, f, i));
        work(0) + work(1) - self.complementary_energy(f, p)
    }

    /// U in J, see the module.
    #[inline(always)]
    fn complementary_energy(&self, f: [f64; 2], p: [f64; 2]) -> f64 {
        let c = self.curvature(f);
        let own = |i: usize| 0.6 * f[i] * c[i] * p[i];
        let pair = |i: usize, j: usize| 0.5 * f[i] * f[j] * self.flexibility[i][j];
        own(0) + own(1) + pair(0, 0) + pair(0, 1) + pair(1, 0) + pair(1, 1)
    }

    /// Patches p in m and relative curvatures under the forces `f` in N.
    fn patches(&self, laws: &[Hertz; 2], f: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let c = self.curvature(f);
        ([0, 1].map(|i| laws[i].approach(f[i] / c[i])), c)
    }

    /// Patches p in m at `y` in m under the forces `f` in N that go with it; the distance, negative, of an open contact.
    pub fn local_approach(&self, laws: &[Hertz; 2], y: [f64; 2], f: [f64; 2]) -> [f64; 2] {
        let (p, _) = self.patches(laws, f);
        [0, 1].map(|i| if f[i] > 0.0 { p[i] } else { y[i] - self.yielded(p, f, i) })
    }

    /// Forces in N and their rates in N/s with the patches `p` in m, where rigid motion and modes approach at `rate` in
    /// m/s; then the patches' rates in m/s.
    pub fn rates(&self, laws: &[Hertz; 2], p: [f64; 2], rate: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let s = self.state(laws, p);
        let [[a, b], [c, e]] = self.jacobian(&s);
        let determinant = a * e - b * c;
        let p_rate = [(e * rate[0] - b * rate[1]) / determinant, (a * rate[1] - c * rate[0]) / determinant];
        let growing = [0, 1].map(|m| s.c[m] * s.tangent[m] * p_rate[m]);
        let f_rate = [0, 1].map(|i| s.inverse[i][0] * growing[0] + s.inverse[i][1] * growing[1]);
        (p_rate, f_rate)
    }

    /// One Newton step for the patches in m at `y` in m, from `p`, whose [`Self::state`] is `s`; `None` if there is no
    /// equilibrium near.
    #[inline(always)]
    pub fn newton(&self, s: &State, y: [f64; 2], p: [f64; 2]) -> Option<[f64; 2]> {
        let error = self.error(s, y, p);
        let [[a, b], [c, e]] = self.jacobian(s);
        let determinant = a * e - b * c;
        if determinant.is_nan() || determinant <= 0.0 {
            return None;
        }
        let scale = 1.0 / determinant;
        Some([p[0] - scale * (e * error[0] - b * error[1]), p[1] - scale * (a * error[1] - c * error[0])])
    }

    /// What the state with the patches `p` misses of the approaches `y`, m.
    #[inline(always)]
    fn error(&self, s: &State, y: [f64; 2], p: [f64; 2]) -> [f64; 2] {
        let own = |i: usize| if p[i] > 0.0 { s.c[i] * p[i] } else { p[i] };
        [own(0) + self.yielded(s.p, s.f, 0) - y[0], own(1) + self.yielded(s.p, s.f, 1) - y[1]]
    }

    /// Patches p in m, negative where a contact is open, and forces in N of both contacts at `y` in m; `guess` are the
    /// patches of a nearby state.
    pub fn solve(&self, laws: &[Hertz; 2], y: [f64; 2], guess: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
        if y[0] <= 0.0 && y[1] <= 0.0 {
            return Some((y, [0.0; 2]));
        }
        let size = |e: [f64; 2]| e[0].abs().max(e[1].abs());
        let scale = y[0].abs().max(y[1].abs());
        let mut p = guess;
        let mut state = self.state(laws, p);
        let mut error = self.error(&state, y, p);
        for _ in 0..MAX_ITERATIONS {
            if size(error) <= 4.0 * f64::EPSILON * scale {
                return Some((p, state.f));
            }
            let [[a, b], [c, e]] = self.jacobian(&state);
            let determinant = a * e - b * c;
            if determinant <= 0.0 || !determinant.is_finite() {
                return None;
            }
            let step =
                [(e * error[0] - b * error[1]) / determinant, (a * error[1] - c * error[0]) / determinant];
            let mut fraction = 1.0;
            loop {
                let trial = [p[0] - fraction * step[0], p[1] - fraction * step[1]];
                let trial_state = self.state(laws, trial);
                let trial_error = self.error(&trial_state, y, trial);
                if size(trial_error) < size(error) {
                    (p, state, error) = (trial, trial_state, trial_error);
                    break;
                }
                fraction *= 0.5;
                if fraction < 1e-6 {
                    // no descent left: round-off, or no equilibrium
                    return (size(error) <= 1e-12 * scale).then_some((p, state.f));
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const LAWS: [Hertz; 2] =
        [Hertz { stiffness: 1.5e10, tip_radius: 0.01 }, Hertz { stiffness: 0.9e10, tip_radius: 0.005 }];

    fn constant(flexibility: [[f64; 2]; 2]) -> Residual {
        Residual { flexibility, growth: [[0.0; 2]; 2] }
    }

    #[test]
    fn solution_satisfies_the_system_for_every_sign_of_the_residual() {
        for (r00, r11, r01) in
            [(1e-9, 2e-9, 5e-10), (-2e-10, -3e-10, 1e-10), (3e-9, -2e-10, -4e-10), (0.0, 0.0, 1e-9)]
        {
            let residual = [[r00, r01], [r01, r11]];
            for y in [[8e-6, 5e-6], [8e-6, -1e-6], [-2e-6, 3e-6], [1e-9, 1e-12]] {
                let d = constant(residual).solve(&LAWS, y, y).unwrap().0;
                let f = [LAWS[0].force(d[0]), LAWS[1].force(d[1])];
                for i in 0..2 {
                    assert_relative_eq!(
                        d[i] + residual[i][0] * f[0] + residual[i][1] * f[1],
                        y[i],
                        epsilon = 1e-19,
                        max_relative = 1e-11
                    );
                }
            }
        }
    }

    /// Work along any path of forces is the energy's change: the approaches derive from a potential.
    #[test]
    fn approaches_are_the_energys_derivatives_by_the_forces_whatever_grows_with_the_patch() {
        let residual = Residual {
            flexibility: [[2e-9, -6e-10], [-6e-10, 1e-9]],
            growth: [[-3e-5, 4e-5], [-2e-5, 6e-5]],
        };
        let energy = |f: [f64; 2]| residual.complementary_energy(f, residual.patches(&LAWS, f).0);
        for y in [[8e-6, 5e-6], [8e-6, -1e-6], [-1e-6, 3e-6]] {
            let (p, f) = residual.solve(&LAWS, y, y).unwrap();
            let local = residual.local_approach(&LAWS, y, f);
            let work = f[0] * y[0].max(0.0) + f[1] * y[1].max(0.0);
            assert_relative_eq!(
                residual.energy(f, residual.patches(&LAWS, f).0) + energy(f),
                work,
                max_relative = 1e-9
            );
            for i in 0..2 {
                assert_eq!(f[i] > 0.0, local[i] > 0.0);
                if f[i] > 0.0 {
                    let step = 1e-5 * f[i];
                    let by = |s: f64| {
                        let mut g = f;
                        g[i] += s;
                        energy(g)
                    };
                    assert_relative_eq!((by(step) - by(-step)) / (2.0 * step), y[i], max_relative = 1e-8);
                    assert_relative_eq!(local[i], p[i], max_relative = 1e-12);
                }
            }
        }
    }

    #[test]
    fn rates_are_the_differences_of_neighbouring_states() {
        let residual = Residual {
            flexibility: [[2e-9, -6e-10], [-6e-10, 1e-9]],
            growth: [[-3e-5, 4e-5], [-2e-5, 6e-5]],
        };
        for y in [[8e-6, 5e-6], [8e-6, -1e-6]] {
            let rate = [0.3, -0.2];
            let at = |t: f64| {
                let y = [y[0] + t * rate[0], y[1] + t * rate[1]];
                residual.solve(&LAWS, y, y).unwrap()
            };
            let (p_rate, f_rate) = residual.rates(&LAWS, at(0.0).0, rate);
            let t = 1e-10;
            let ((p_after, f_after), (p_before, f_before)) = (at(t), at(-t));
            for i in 0..2 {
                assert_relative_eq!((p_after[i] - p_before[i]) / (2.0 * t), p_rate[i], max_relative = 1e-5);
                let by_difference = (f_after[i] - f_before[i]) / (2.0 * t);
                assert_relative_eq!(by_difference, f_rate[i], epsilon = 1.0, max_relative = 1e-5);
            }
        }
    }

    #[test]
    fn open_contacts_need_no_iteration() {
        assert_eq!(
            constant([[1e-9; 2]; 2]).solve(&LAWS, [-1e-6, 0.0], [0.0; 2]),
            Some(([-1e-6, 0.0], [0.0, 0.0]))
        );
    }

    #[test]
    fn no_equilibrium_is_said() {
        // delta - |R| k delta^(3/2) has a maximum far below y
        let residual = constant([[-1e-6, 0.0], [0.0, 0.0]]);
        assert_eq!(residual.solve(&LAWS, [1e-4, -1.0], [1e-6, -1.0]), None);
    }
}
