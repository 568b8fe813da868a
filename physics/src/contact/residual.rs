//! The contacts' small nonlinear system when the bodies keep a residual flexibility.
//!
//! Beyond Hertz's half-spaces the bodies yield by R_ij F_j, where R depends on the radii a_i of the patches over which the
//! forces are spread. With p_i = a_i^2/r_i, the approach at which an undeformed tip of radius r_i has this patch, the complementary
//! energy of the contacts under Hertz's pressures is
//!
//!   U = sum_i (0.4 F_i^2/(k_i p_i^(1/2)) + 0.2 F_i p_i) + 1/2 sum_ij F_i F_j R_ij(p_0, p_1).
//!
//! The patches are those that make it stationary: what the bodies yield beyond half-spaces also curves their faces. With
//! the slopes g_ii = R_ii'/2 and g_ij = dR_ij/dp_i the relative curvatures c_i and the forces are
//!
//!   c_i = 1 + 5 sum_j g_ij F_j,   F_i = k_i p_i^(3/2) c_i,
//!
//! and the derivatives of U by the forces are the approaches that rigid motion and modes have to give,
//!
//!   y_i = 0.8 c_i p_i + 0.2 p_i + sum_j R_ij F_j.
//!
//! Forces over given patches are linear in the approaches, so that U has to be convex in the forces: there is then one
//! equilibrium and only one. Where the polynomials of R cease to make it so the patch stays as it is and the contact goes
//! on as a flat punch, F_i growing by its own: convex for certain.

mod alone;
mod state;

pub use self::state::State;
use super::Hertz;
use super::patch_flexibility::{PatchFlexibility, TABULATED, Tabulated};
use wide::f64x4;

/// Newton steps after which the system counts as unsolvable.
const MAX_ITERATIONS: usize = 60;
/// Largest x = (patch radius over that of the table)^2 up to which the table is continued.
const FARTHEST: f64 = 9.0;
/// Places at which the table is tested.
const TESTED: usize = 360;
/// Halvings of the first of them where even there U is not convex.
const HALVINGS: usize = 100;
/// Places from one that is looked at to the next where U is convex by 1, as under half-spaces alone, and less in proportion; between
/// places of which one has less than [`AMPLE`] all are looked at.
const STRIDE: f64 = 60.0;
const AMPLE: f64 = 0.25;

/// Residual flexibility of two contacts in terms of their approaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Coefficients in R_ii, m/N, of x_i^m with x_i = `per_patch[i]` p_i.
    own: [Tabulated; 2],
    /// `mutual[n]`: coefficients in R_01, m/N, of x_0^m x_1^n.
    mutual: [f64x4; TABULATED],
    /// x_i over p_i, 1/m.
    per_patch: [f64; 2],
    /// Largest p_i in m; beyond, the contact is a punch.
    largest: [f64; 2],
}

impl Residual {
    /// The residual `flexibility` of the contacts `laws`, m/N, signed for forces that press. The table is taken as far as the forces
    /// grow with the approaches: of each contact alone, and of both, whichever patch is the wider.
    pub fn new(flexibility: &PatchFlexibility, laws: &[Hertz; 2]) -> Self {
        let mut residual = Self {
            own: flexibility.own,
            mutual: flexibility.mutual.map(f64x4::from),
            per_patch: [0, 1].map(|i| flexibility.per_square[i] * laws[i].tip_radius),
            largest: [f64::INFINITY; 2],
        };
        if residual.per_patch.iter().all(|scale| *scale > 0.0) {
            // how far of the way to the squares `x` the forces grow at each of the `places`
            let reach = |x: [f64; 2], places: &[[f64; 2]]| {
                let margin = |share: f64| {
                    let at =
                        |place: &[f64; 2]| residual.convexity(laws, [0, 1].map(|i| share * place[i] * x[i]));
                    places.iter().map(at).fold(1.0, f64::min)
                };
                let least = 1.0 / TESTED as f64;
                match farthest_positive(TESTED, |n| margin(n as f64 * least)) {
                    // small patches are those of half-spaces, whatever the table says
                    0 => {
                        let halves = std::iter::successors(Some(0.5 * least), |share| Some(0.5 * share));
                        halves.take(HALVINGS).find(|share| margin(*share) > 0.0).unwrap_or(0.0)
                    }
                    farthest => farthest as f64 * least,
                }
            };
            let alone = [[1.0, 0.0], [0.0, 1.0]].map(|one| FARTHEST * reach([FARTHEST; 2], &[one]));
            let together = reach(alone, &[[1.0, 1.0], [1.0, 0.25], [0.25, 1.0]]);
            residual.largest = [0, 1].map(|i| together * alone[i] / residual.per_patch[i]);
        }
        residual
    }

    /// How far U is from not being convex where the patches have the squares `x` in those of the table: 1 as under half-spaces
    /// alone, 0 or less if it is not.
    fn convexity(&self, laws: &[Hertz; 2], x: [f64; 2]) -> f64 {
        let s = self.state(laws, [0, 1].map(|i| x[i] / self.per_patch[i]));
        let [[a, b], [c, e]] = s.slopes([0.0; 3]).approach;
        let pressed = (0..2).all(|i| x[i] == 0.0 || s.f[i] > 0.0 && s.c[i] > 0.0);
        if !(pressed && a > 0.0 && e > 0.0 && a * e > b * c) {
            return 0.0;
        }
        (0..2).filter(|i| x[*i] > 0.0).fold(1.0 - b * c / (a * e), |least, i| least.min(s.c[i]))
    }

    /// Radii in m of the widest patches before the contacts `laws` become punches; infinite without a table.
    pub fn reach(&self, laws: &[Hertz; 2]) -> [f64; 2] {
        [0, 1].map(|i| (laws[i].tip_radius * self.largest[i]).sqrt())
    }

    /// Whether there is none.
    pub fn is_zero(&self) -> bool {
        self.own.iter().flatten().all(|r| *r == 0.0) && self.mutual.iter().all(|r| *r == f64x4::ZERO)
    }

    /// The same with a further flexibility (0,0), (0,1) = (1,0), (1,1) in m/N.
    pub fn with(&self, [own0, mutual, own1]: [f64; 3]) -> Self {
        let mut sum = *self;
        sum.own[0][0] += own0;
        sum.own[1][0] += own1;
        sum.mutual[0] += f64x4::from([mutual, 0.0, 0.0, 0.0]);
        sum
    }

    /// Strain energy in J of the contacts with the patches `p` in m.
    #[inline(always)]
    pub fn energy(&self, laws: &[Hertz; 2], p: [f64; 2]) -> f64 {
        self.state(laws, p).energy()
    }

    /// Forces in N and their rates in N/s with the patches `p` in m, where rigid motion and modes approach at `rate` in
    /// m/s; then the patches' rates in m/s.
    pub fn rates(&self, laws: &[Hertz; 2], p: [f64; 2], rate: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let s = self.state(laws, p);
        let slopes = s.slopes([0.0; 3]);
        let [[a, b], [c, e]] = slopes.approach;
        let determinant = a * e - b * c;
        let p_rate = [(e * rate[0] - b * rate[1]) / determinant, (a * rate[1] - c * rate[0]) / determinant];
        (p_rate, [0, 1].map(|i| slopes.force[i][0] * p_rate[0] + slopes.force[i][1] * p_rate[1]))
    }

    /// What the bodies yield beyond Hertz's half-spaces under the forces `f` in N, in m, from the patches `p` in m of a nearby state
    /// on; then the patches.
    pub fn displacement(&self, laws: &[Hertz; 2], f: [f64; 2], mut p: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        for _ in 0..MAX_ITERATIONS {
            let next = self.patches_under(laws, f, p);
            let change =
                (0..2).map(|i| (next[i] - p[i]).abs() / next[i].max(f64::MIN_POSITIVE)).fold(0.0, f64::max);
            p = next;
            if change <= 1e-13 {
                break;
            }
        }
        let approach = self.state(laws, p).error([0.0; 3], [0.0; 2], p);
        ([0, 1].map(|i| approach[i] - laws[i].approach(f[i])), p)
    }

    /// The patches under the forces `f` if the curvatures were those with the patches `p`.
    fn patches_under(&self, laws: &[Hertz; 2], f: [f64; 2], p: [f64; 2]) -> [f64; 2] {
        let curvature = self.state(laws, p).curvature(f);
        [0, 1].map(|i| {
            let free = (f[i].max(0.0) / (laws[i].stiffness * curvature[i])).powi(2).cbrt();
            if free <= self.largest[i] {
                return free;
            }
            let widest = self.largest[i];
            widest + (f[i] - laws[i].force(widest) * curvature[i]) / laws[i].tangent(widest)
        })
    }

    /// Patches p in m, negative where a contact is open, and forces in N of both contacts at `y` in m; `guess` are the
    /// patches of a nearby state. Where it is not near enough the solution is followed from small approaches on.
    pub fn solve(&self, laws: &[Hertz; 2], y: [f64; 2], guess: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
        if y[0] <= 0.0 && y[1] <= 0.0 {
            return Some((y, [0.0; 2]));
        }
        self.solve_near(laws, y, guess).or_else(|| self.follow(laws, y))
    }

    /// [`Self::solve`] by solutions at growing parts of `y`.
    #[cold]
    fn follow(&self, laws: &[Hertz; 2], y: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
        let part = |share: f64| y.map(|y| share * y);
        let (mut share, mut ratio) = (1e-6, 2.0);
        let mut p = self.solve_near(laws, part(share), part(share))?.0;
        while ratio > 1.0 + 1e-6 {
            let next = (share * ratio).min(1.0);
            match self.solve_near(laws, part(next), p.map(|p| p * next / share)) {
                Some(solution) if next == 1.0 => return Some(solution),
                Some((reached, _)) => (share, p) = (next, reached),
                None => ratio = ratio.sqrt(),
            }
        }
        None
    }

    /// [`Self::solve`] by Newton's method from `guess`.
    fn solve_near(&self, laws: &[Hertz; 2], y: [f64; 2], guess: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
        let size = |e: [f64; 2]| e[0].abs().max(e[1].abs());
        let scale = y[0].abs().max(y[1].abs());
        let mut p = guess;
        let mut state = self.state(laws, p);
        let mut error = state.error([0.0; 3], y, p);
        for _ in 0..MAX_ITERATIONS {
            if size(error) <= 4.0 * f64::EPSILON * scale {
                return Some((p, state.f));
            }
            let step = state.step([0.0; 3], error)?;
            let mut fraction = 1.0;
            loop {
                let trial = [p[0] - fraction * step[0], p[1] - fraction * step[1]];
                let trial_state = self.state(laws, trial);
                let trial_error = trial_state.error([0.0; 3], y, trial);
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

/// How many numbers from 1 to `most` come before the first that has no positive `margin`; between two that have much of it,
/// as far apart as [`STRIDE`] has it, all do.
fn farthest_positive(most: usize, margin: impl Fn(usize) -> f64) -> usize {
    let mut known = 0;
    let mut before = 1.0;
    while known < most {
        let stride = (STRIDE * f64::max(before, AMPLE)) as usize;
        let next = (known + stride).min(most);
        let after = margin(next);
        if before.min(after) < AMPLE
            && let Some(first) = (known + 1..next).find(|n| margin(*n) <= 0.0)
        {
            return first - 1;
        }
        if after <= 0.0 {
            return next - 1;
        }
        (known, before) = (next, after);
    }
    most
}

#[cfg(test)]
mod tests {
    use super::super::PatchTable;
    use super::super::RADII;
    use super::*;
    use approx::assert_relative_eq;

    pub(super) const LAWS: [Hertz; 2] =
        [Hertz { stiffness: 1.5e10, tip_radius: 0.01 }, Hertz { stiffness: 0.9e10, tip_radius: 0.005 }];

    fn constant(flexibility: [[f64; 2]; 2]) -> Residual {
        Residual::new(&PatchFlexibility::constant(flexibility), &LAWS)
    }

    /// A residual that changes with the patches and whose table reaches to approaches of `depth` m.
    pub(super) fn varying(depth: f64) -> Residual {
        let own = |i: usize, x: f64| [2e-9, 1e-9][i] / (1.0 + [0.3, 0.5][i] * x) - 0.4e-9;
        let mutual = |x: f64, y: f64| 6e-10 / (1.0 + 0.2 * x + 0.4 * y);
        let square = RADII.map(|r| r * r);
        let table = PatchTable {
            own: [0, 1].map(|i| square.map(|x| own(i, x))),
            mutual: square.map(|x| square.map(|y| mutual(x, y))),
        };
        let patch = LAWS.map(|law| (law.tip_radius * depth).sqrt());
        Residual::new(&PatchFlexibility::through(&table, patch), &LAWS)
    }

    const APPROACHES: [[f64; 2]; 5] =
        [[8e-6, 5e-6], [8e-6, -1e-6], [-2e-6, 3e-6], [4e-5, 6e-5], [1e-9, 1e-12]];

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

    /// The forces are the derivatives of the strain energy by the approaches, within the table and as punches beyond it.
    #[test]
    fn work_of_the_forces_is_the_change_of_the_energy() {
        for depth in [4e-5, 1e-6] {
            let residual = varying(depth);
            for y in APPROACHES {
                let (p, f) = residual.solve(&LAWS, y, y).unwrap();
                let beyond = (0..2).any(|i| p[i] > residual.largest[i]);
                if y[0].max(y[1]) > 1e-5 {
                    assert_eq!(beyond, depth == 1e-6, "{y:?} {p:?}");
                }
                for i in (0..2).filter(|i| f[*i] > 0.0) {
                    let at = |step: f64| {
                        let mut y = y;
                        y[i] += step;
                        residual.energy(&LAWS, residual.solve(&LAWS, y, y).unwrap().0)
                    };
                    let step = 1e-4 * y[i];
                    let per_approach = (at(step) - at(-step)) / (2.0 * step);
                    assert_relative_eq!(
                        per_approach,
                        f[i],
                        epsilon = 1e-11 + 1e-9 * (f[0] + f[1]),
                        max_relative = 1e-6
                    );
                }
            }
        }
    }

    #[test]
    fn rates_are_the_differences_of_neighbouring_states() {
        for depth in [1e-5, 1e-6] {
            let residual = varying(depth);
            for y in [[8e-6, 5e-6], [8e-6, -1e-6], [6e-5, 5e-5]] {
                let rate = [0.3, -0.2];
                let at = |t: f64| {
                    let y = [y[0] + t * rate[0], y[1] + t * rate[1]];
                    residual.solve(&LAWS, y, y).unwrap()
                };
                let (p_rate, f_rate) = residual.rates(&LAWS, at(0.0).0, rate);
                let t = 1e-10;
                let ((p_after, f_after), (p_before, f_before)) = (at(t), at(-t));
                for i in 0..2 {
                    assert_relative_eq!(
                        (p_after[i] - p_before[i]) / (2.0 * t),
                        p_rate[i],
                        max_relative = 1e-5
                    );
                    let by_difference = (f_after[i] - f_before[i]) / (2.0 * t);
                    assert_relative_eq!(by_difference, f_rate[i], epsilon = 1.0, max_relative = 1e-5);
                }
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

    /// A contact whose table reaches far does not become a punch where that of the other ends.
    #[test]
    fn each_contact_goes_as_far_as_its_own_table() {
        let residual = |shrinking: [f64; 2]| {
            let own = shrinking.map(|s| RADII.map(|r| -s * 1e-10 * (1.0 + r * r)));
            let table = PatchTable { own, ..PatchTable::default() };
            let patch = LAWS.map(|law| (law.tip_radius * 1e-5).sqrt());
            Residual::new(&PatchFlexibility::through(&table, patch), &LAWS)
        };
        let (both, one) = (residual([0.0; 2]), residual([0.0, 100.0]));
        assert_eq!(one.largest[0], both.largest[0]);
        assert!(one.largest[1] < 0.1 * both.largest[1], "{:?}", one.largest);
    }

    /// Of a thin soft plate the table may hold for no patch of its own size: an outer face that moves more with the inner one than by itself.
    #[test]
    fn a_table_that_holds_for_tiny_patches_alone_has_an_equilibrium_all_the_same() {
        let table = PatchTable { own: [[0.2; 4], [0.38; 4]], mutual: [[0.3; 4]; 4] };
        let laws =
            [Hertz { stiffness: 1.17e6, tip_radius: 5e-4 }, Hertz { stiffness: 2.28e6, tip_radius: 2e-3 }];
        let residual = Residual::new(&PatchFlexibility::through(&table, [3.6e-5, 5.8e-5]), &laws);
        for y in [[5.1e-8, -7.4e-8], [5e-8, 3e-8], [-2e-8, 4e-8], [1e-6, 1e-6]] {
            let (p, f) = residual.solve(&laws, y, y).expect("an equilibrium");
            let error = residual.state(&laws, p).error([0.0; 3], y, p);
            assert!(error.iter().all(|e| e.abs() < 1e-12 * y[0].abs().max(y[1].abs())), "{y:?} {error:?}");
            assert!(f.iter().all(|f| *f >= 0.0), "{f:?}");
        }
    }

    /// With a table there is an equilibrium, and one only, whatever the table says.
    #[test]
    fn forces_grow_with_the_approaches_without_end_whatever_the_table() {
        for shrinking in [0.0, 1.0, 10.0, 100.0] {
            let square = RADII.map(|r| r * r);
            let own = square.map(|x| -shrinking * 1e-10 * (1.0 + x));
            let table = PatchTable { own: [own; 2], mutual: square.map(|_| square.map(|x| 1e-10 * x)) };
            let patch = LAWS.map(|law| (law.tip_radius * 1e-5).sqrt());
            let residual = Residual::new(&PatchFlexibility::through(&table, patch), &LAWS);
            let mut before = [0.0; 2];
            for n in 1..400 {
                let y = 1e-6 * f64::from(n);
                let (_, f) = residual.solve(&LAWS, [y; 2], [y; 2]).unwrap();
                assert!(f[0] > before[0] && f[1] > before[1], "{shrinking} {y} {f:?}");
                before = f;
            }
        }
    }
}
