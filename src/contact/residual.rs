//! The contacts' small nonlinear system when the bodies keep a residual flexibility.
//!
//! Beyond Hertz's half-spaces the bodies yield by R_ij F_j. R is smooth in the patches over which the forces are
//! spread: R_ij = R0_ij + b_ij a_i^2 + b_ji a_j^2 with Hertz's patch radii a_i^2 = r_i d_i under the Hertz approaches
//! d_i = (F_i/k_i)^(2/3). With g_ij = b_ij r_i the complementary energy of the contacts is
//!
//!   U = sum_i 3/5 F_i d_i + 1/2 sum_ij F_i F_j (R0_ij + g_ij d_i + g_ji d_j),
//!
//! and its derivative by F_i, with dd_i/dF_i = 2/3 d_i/F_i, the approach that rigid motion and modes have to give:
//!
//!   y_i = d_i + sum_j F_j (R0_ij + 5/3 g_ij d_i + g_ji d_j).
//!
//! The energy is stationary in the shape of the pressure, so that Hertz's pressure serves to first order in what
//! the bodies lack of half-spaces. R is symmetric; its diagonal may be negative.

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

impl Residual {
    /// R_ij in m/N at the Hertz approaches `d` in m.
    fn at(&self, d: [f64; 2], i: usize, j: usize) -> f64 {
        self.flexibility[i][j] + self.growth[i][j] * d[i] + self.growth[j][i] * d[j]
    }

    /// Whether there is none.
    pub fn is_zero(&self) -> bool {
        self.flexibility.iter().chain(&self.growth).flatten().all(|r| *r == 0.0)
    }

    /// Complementary energy in J beyond that of Hertz's half-spaces under the forces `f` in N at the Hertz approaches `d` in m.
    pub fn complementary_energy(&self, f: [f64; 2], d: [f64; 2]) -> f64 {
        let pair = |i: usize, j: usize| 0.5 * f[i] * f[j] * self.at(d, i, j);
        pair(0, 0) + pair(0, 1) + pair(1, 0) + pair(1, 1)
    }

    /// Strain energy in J beyond that of Hertz's half-spaces, which the bodies give back: F y less the complementary
    /// energy. That of a constant flexibility equals it; the patch terms, of degree 8/3 in the forces, give 5/3 of it.
    #[inline(always)]
    pub fn strain_energy(&self, f: [f64; 2], d: [f64; 2]) -> f64 {
        let (r, g) = (&self.flexibility, &self.growth);
        let pair = |i: usize, j: usize| {
            0.5 * f[i] * f[j] * (r[i][j] + 5.0 / 3.0 * (g[i][j] * d[i] + g[j][i] * d[j]))
        };
        pair(0, 0) + pair(0, 1) + pair(1, 0) + pair(1, 1)
    }

    /// Approaches in m beyond Hertz's under the forces `f` in N at the Hertz approaches `d` in m.
    #[inline(always)]
    fn yielded(&self, f: [f64; 2], d: [f64; 2]) -> [f64; 2] {
        let (r, g) = (&self.flexibility, &self.growth);
        let own = |i: usize| f[i] * (r[i][i] + 8.0 / 3.0 * g[i][i] * d[i]);
        let other = |i: usize, j: usize| f[j] * (r[i][j] + 5.0 / 3.0 * g[i][j] * d[i] + g[j][i] * d[j]);
        [own(0) + other(0, 1), own(1) + other(1, 0)]
    }

    /// Derivative of the approaches y by the Hertz approaches d.
    #[inline(always)]
    fn jacobian(&self, laws: &[Hertz; 2], f: [f64; 2], d: [f64; 2]) -> [[f64; 2]; 2] {
        let (r, g) = (&self.flexibility, &self.growth);
        let tangent = [laws[0].tangent(d[0]), laws[1].tangent(d[1])];
        let own = |i: usize, j: usize| {
            let hertz = 1.0 + tangent[i] * (r[i][i] + 8.0 / 3.0 * g[i][i] * d[i]);
            hertz + 8.0 / 3.0 * g[i][i] * f[i] + 5.0 / 3.0 * g[i][j] * f[j]
        };
        let other = |i: usize, j: usize| {
            tangent[j] * (r[i][j] + 5.0 / 3.0 * g[i][j] * d[i] + g[j][i] * d[j]) + g[j][i] * f[j]
        };
        [[own(0, 1), other(0, 1)], [other(1, 0), own(1, 0)]]
    }

    /// Forces of both contacts in N where rigid motion and modes approach by `y` in m, or `None` if there is no
    /// equilibrium near `y`.
    #[inline]
    pub fn forces(&self, laws: &[Hertz; 2], y: [f64; 2]) -> Option<[f64; 2]> {
        self.approaches(laws, y, y).map(|d| [laws[0].force(d[0]), laws[1].force(d[1])])
    }

    /// Hertz approaches in m at `y` in m under the forces `f` in N that go with it, negative where a contact is open.
    pub fn local_approach(&self, laws: &[Hertz; 2], y: [f64; 2], f: [f64; 2]) -> [f64; 2] {
        let d = [laws[0].approach(f[0]), laws[1].approach(f[1])];
        let more = self.yielded(f, d);
        [0, 1].map(|i| if f[i] > 0.0 { d[i] } else { y[i] - more[i] })
    }

    /// One Newton step for the Hertz approaches in m at `y` in m, from `d`; `None` if there is no equilibrium near.
    #[inline(always)]
    pub fn newton(&self, laws: &[Hertz; 2], y: [f64; 2], d: [f64; 2]) -> Option<[f64; 2]> {
        let (closed, forces) = ([d[0].max(0.0), d[1].max(0.0)], [laws[0].force(d[0]), laws[1].force(d[1])]);
        let more = self.yielded(forces, closed);
        let error = [d[0] + more[0] - y[0], d[1] + more[1] - y[1]];
        let [[a, b], [c, e]] = self.jacobian(laws, forces, closed);
        let determinant = a * e - b * c;
        if determinant.is_nan() || determinant <= 0.0 {
            return None;
        }
        let scale = 1.0 / determinant;
        Some([d[0] - scale * (e * error[0] - b * error[1]), d[1] - scale * (a * error[1] - c * error[0])])
    }

    /// Hertz approaches of both contacts in m, negative where a contact is open; `guess` is that of a nearby state.
    pub fn approaches(&self, laws: &[Hertz; 2], y: [f64; 2], guess: [f64; 2]) -> Option<[f64; 2]> {
        if y[0] <= 0.0 && y[1] <= 0.0 {
            return Some(y);
        }
        // an open contact bears no force and has no patch: the patch terms hold for the closed part alone
        let closed = |d: [f64; 2]| [d[0].max(0.0), d[1].max(0.0)];
        let forces = |d: [f64; 2]| [laws[0].force(d[0]), laws[1].force(d[1])];
        let defect = |d: [f64; 2]| {
            let more = self.yielded(forces(d), closed(d));
            [d[0] + more[0] - y[0], d[1] + more[1] - y[1]]
        };
        let size = |e: [f64; 2]| e[0].abs().max(e[1].abs());
        let scale = y[0].abs().max(y[1].abs());
        let mut d = guess;
        let mut error = defect(d);
        for _ in 0..MAX_ITERATIONS {
            if size(error) <= 4.0 * f64::EPSILON * scale {
                return Some(d);
            }
            let [[a, b], [c, e]] = self.jacobian(laws, forces(d), closed(d));
            let determinant = a * e - b * c;
            if determinant <= 0.0 || !determinant.is_finite() {
                return None;
            }
            let step =
                [(e * error[0] - b * error[1]) / determinant, (a * error[1] - c * error[0]) / determinant];
            let mut fraction = 1.0;
            loop {
                let trial = [d[0] - fraction * step[0], d[1] - fraction * step[1]];
                let trial_error = defect(trial);
                if size(trial_error) < size(error) {
                    (d, error) = (trial, trial_error);
                    break;
                }
                fraction *= 0.5;
                if fraction < 1e-6 {
                    // no descent left: round-off, or no equilibrium
                    return (size(error) <= 1e-12 * scale).then_some(d);
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
                let d = constant(residual).approaches(&LAWS, y, y).unwrap();
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
        let energy = |f: [f64; 2]| {
            let d = [LAWS[0].approach(f[0]), LAWS[1].approach(f[1])];
            0.6 * (f[0] * d[0] + f[1] * d[1]) + residual.complementary_energy(f, d)
        };
        for y in [[8e-6, 5e-6], [8e-6, -1e-6], [-1e-6, 3e-6]] {
            let f = residual.forces(&LAWS, y).unwrap();
            let local = residual.local_approach(&LAWS, y, f);
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
                    assert_relative_eq!(local[i], LAWS[i].approach(f[i]), max_relative = 1e-12);
                }
            }
        }
    }

    /// The work of the forces along a path of approaches is what the contacts store.
    #[test]
    fn strain_energy_is_the_work_of_the_forces() {
        let residual = Residual {
            flexibility: [[2e-9, -6e-10], [-6e-10, 1e-9]],
            growth: [[-3e-5, 4e-5], [-2e-5, 6e-5]],
        };
        let (end, steps) = ([8e-6, 5e-6], 2000);
        let at = |s: f64| {
            let f = residual.forces(&LAWS, [s * end[0], s * s * end[1]]).unwrap();
            f[0] * end[0] + f[1] * 2.0 * s * end[1]
        };
        // Simpson's rule
        let h = 1.0 / steps as f64;
        let weight = |k: usize| if k == 0 || k == steps { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
        let work: f64 = (0..=steps).map(|k| h / 3.0 * weight(k) * at(k as f64 * h)).sum();
        let f = residual.forces(&LAWS, end).unwrap();
        let d = [LAWS[0].approach(f[0]), LAWS[1].approach(f[1])];
        let stored = 0.4 * (f[0] * d[0] + f[1] * d[1]) + residual.strain_energy(f, d);
        assert_relative_eq!(work, stored, max_relative = 1e-7);
    }

    #[test]
    fn open_contacts_need_no_iteration() {
        assert_eq!(constant([[1e-9; 2]; 2]).forces(&LAWS, [-1e-6, 0.0]), Some([0.0, 0.0]));
    }

    #[test]
    fn no_equilibrium_is_said() {
        // delta - |R| k delta^(3/2) has a maximum far below y
        let residual = constant([[-1e-6, 0.0], [0.0, 0.0]]);
        assert_eq!(residual.approaches(&LAWS, [1e-4, -1.0], [1e-6, -1.0]), None);
    }
}
