//! Zener's impact of a sphere on an infinite thin plate (C. Zener, Phys. Rev. 59, 1941, 669).
//!
//! In an infinite Kirchhoff plate the struck point moves with the velocity F / (8 sqrt(rho h D)).
//! With the approach s in units of v T and time in units of T = (m / (k sqrt v))^(2/5):
//! s'' + (1 + lambda d/dtau) s^(3/2) = 0, s(0) = 0, s'(0) = 1, lambda = m / (8 sqrt(rho h D) T).

/// Result of Zener's equation, in physical terms by the scales of the module's head.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zener {
    /// Coefficient of restitution: speed of the sphere after over before the contact.
    pub restitution: f64,
    /// Duration of the contact over T.
    pub duration: f64,
    /// Largest force over m v / T.
    pub force_peak: f64,
}

/// Zener's inelasticity parameter lambda = m / (8 sqrt(rho h D) T).
///
/// Units: `mass` kg, `speed` m/s, `stiffness` N/m^(3/2), `mass_per_area` kg/m^2, `rigidity` D in N m.
pub fn inelasticity(mass: f64, speed: f64, stiffness: f64, mass_per_area: f64, rigidity: f64) -> f64 {
    let time = (mass / (stiffness * speed.sqrt())).powf(0.4);
    mass / (8.0 * (mass_per_area * rigidity).sqrt() * time)
}

/// Solves Zener's equation for `lambda >= 0` with `steps_per_unit` Runge-Kutta steps per T.
///
/// State (s, u) with the sphere's velocity u = s' + lambda s^(3/2), so that u' = -s^(3/2).
pub fn solve(lambda: f64, steps_per_unit: u32) -> Zener {
    let force = |s: f64| s.max(0.0).powf(1.5);
    let rate = |[s, u]: [f64; 2]| [u - lambda * force(s), -force(s)];
    let h = 1.0 / f64::from(steps_per_unit);
    let mut state = [0.0, 1.0];
    let mut steps = 0_u64;
    let mut force_peak: f64 = 0.0;
    loop {
        let next = runge_kutta(rate, state, h);
        if next[0] <= 0.0 {
            // linear in the last step: the force is of order h^(3/2) there
            let fraction = state[0] / (state[0] - next[0]);
            return Zener {
                restitution: -(state[1] + fraction * (next[1] - state[1])),
                duration: (steps as f64 + fraction) * h,
                force_peak,
            };
        }
        state = next;
        steps += 1;
        force_peak = force_peak.max(force(state[0]));
    }
}

/// One classical Runge-Kutta step.
fn runge_kutta(rate: impl Fn([f64; 2]) -> [f64; 2], y: [f64; 2], h: f64) -> [f64; 2] {
    let add = |k: [f64; 2], c: f64| [y[0] + c * k[0], y[1] + c * k[1]];
    let k1 = rate(y);
    let k2 = rate(add(k1, 0.5 * h));
    let k3 = rate(add(k2, 0.5 * h));
    let k4 = rate(add(k3, h));
    let sum = |i: usize| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    [sum(0), sum(1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn restitution_of_zener_1941() {
        let table = [
            (0.05, 0.917772),
            (0.1, 0.843339),
            (0.2, 0.714045),
            (0.5, 0.436895),
            (1.0, 0.184123),
            (2.0, 0.020683),
        ];
        for (lambda, restitution) in table {
            assert_relative_eq!(solve(lambda, 20_000).restitution, restitution, epsilon = 1e-6);
        }
    }

    #[test]
    fn without_loss_it_is_hertz() {
        let zener = solve(0.0, 20_000);
        assert_relative_eq!(zener.restitution, 1.0, max_relative = 1e-7);
        assert_relative_eq!(zener.force_peak, 1.143_263, max_relative = 1e-6);
        // duration 2.943275 delta/v with delta = (5/4)^(2/5) v T
        assert_relative_eq!(zener.duration, 2.943_275 * 1.25_f64.powf(0.4), max_relative = 1e-6);
    }
}
