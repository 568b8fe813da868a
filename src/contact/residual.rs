//! The contacts' small nonlinear system when the bodies keep a residual flexibility.
//!
//! The approaches delta of both contacts obey delta_i + sum_j R_ij F_j(delta_j) = y_i with y what the
//! rigid motion and the modes give. R is symmetric; its diagonal may be negative, because the
//! half-space part, which Hertz's law has already, is taken out of it.

use super::Hertz;

/// Newton steps after which the system counts as unsolvable.
const MAX_ITERATIONS: usize = 60;

/// Forces of both contacts in N, or `None` if there is no equilibrium near `y`.
///
/// `residual` in m/N, `y` in m, `guess` the approaches of a nearby state in m.
#[inline]
pub fn forces(laws: &[Hertz; 2], residual: &[[f64; 2]; 2], y: [f64; 2], guess: [f64; 2]) -> Option<[f64; 2]> {
    approaches(laws, residual, y, guess).map(|d| [laws[0].force(d[0]), laws[1].force(d[1])])
}

/// Approaches of both contacts in m; see [`forces`].
pub fn approaches(
    laws: &[Hertz; 2],
    residual: &[[f64; 2]; 2],
    y: [f64; 2],
    guess: [f64; 2],
) -> Option<[f64; 2]> {
    if y[0] <= 0.0 && y[1] <= 0.0 {
        return Some(y);
    }
    let defect = |d: [f64; 2]| {
        let f = [laws[0].force(d[0]), laws[1].force(d[1])];
        [
            d[0] + residual[0][0] * f[0] + residual[0][1] * f[1] - y[0],
            d[1] + residual[1][0] * f[0] + residual[1][1] * f[1] - y[1],
        ]
    };
    let size = |e: [f64; 2]| e[0].abs().max(e[1].abs());
    let scale = y[0].abs().max(y[1].abs());
    let mut d = guess;
    let mut error = defect(d);
    for _ in 0..MAX_ITERATIONS {
        if size(error) <= 4.0 * f64::EPSILON * scale {
            return Some(d);
        }
        let tangent = [laws[0].tangent(d[0]), laws[1].tangent(d[1])];
        let a = 1.0 + residual[0][0] * tangent[0];
        let b = residual[0][1] * tangent[1];
        let c = residual[1][0] * tangent[0];
        let e = 1.0 + residual[1][1] * tangent[1];
        let determinant = a * e - b * c;
        if determinant <= 0.0 || !determinant.is_finite() {
            return None;
        }
        let step = [(e * error[0] - b * error[1]) / determinant, (a * error[1] - c * error[0]) / determinant];
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

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const LAWS: [Hertz; 2] =
        [Hertz { stiffness: 1.5e10, tip_radius: 0.01 }, Hertz { stiffness: 0.9e10, tip_radius: 0.005 }];

    #[test]
    fn solution_satisfies_the_system_for_every_sign_of_the_residual() {
        for (r00, r11, r01) in
            [(1e-9, 2e-9, 5e-10), (-2e-10, -3e-10, 1e-10), (3e-9, -2e-10, -4e-10), (0.0, 0.0, 1e-9)]
        {
            let residual = [[r00, r01], [r01, r11]];
            for y in [[8e-6, 5e-6], [8e-6, -1e-6], [-2e-6, 3e-6], [1e-9, 1e-12]] {
                let d = approaches(&LAWS, &residual, y, y).unwrap();
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

    #[test]
    fn open_contacts_need_no_iteration() {
        assert_eq!(forces(&LAWS, &[[1e-9; 2]; 2], [-1e-6, 0.0], [0.0; 2]), Some([0.0, 0.0]));
    }

    #[test]
    fn no_equilibrium_is_said() {
        // delta - |R| k delta^(3/2) has a maximum far below y
        assert_eq!(forces(&LAWS, &[[-1e-6, 0.0], [0.0, 0.0]], [1e-4, -1.0], [1e-6, -1.0]), None);
    }
}
