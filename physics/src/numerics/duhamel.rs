//! Exact response of a damped oscillator to a force that is a polynomial in time (Duhamel's integral).
//!
//! With s the impulse response of q'' + 2 alpha q' + omega^2 q = f, the moments
//! S_p(t) = integral of s(t - tau) tau^p / p! over 0..t obey, with S_-1 = s and S_-2 = s',
//!     S_(p-2) + 2 alpha S_(p-1) + omega^2 S_p = t^p / p!   and   dS_p/dt = S_(p-1).
//! Upwards in p the recurrence divides by omega^2 and is used when omega t is large; downwards,
//! started by the power series, it is stable when omega t is small, a rigid motion included.

use super::stages::STAGES;

/// Number of moments of one time: s', s, S_0 ... S_(STAGES-1).
pub const MOMENTS: usize = STAGES + 2;

/// 1/n; the series need no more than some thirty terms for their arguments below 2.
const RECIPROCAL: [f64; 64] = {
    let mut table = [0.0; 64];
    let mut n = 1;
    while n < table.len() {
        table[n] = 1.0 / n as f64;
        n += 1;
    }
    table
};

/// t^p / p! for p = 0 ...
fn powers(t: f64) -> [f64; MOMENTS] {
    let mut powers = [1.0; MOMENTS];
    for p in 1..MOMENTS {
        powers[p] = powers[p - 1] * t * RECIPROCAL[p];
    }
    powers
}

/// Damped oscillator; omega = 0 is a rigid motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillator {
    /// Eigenfrequency of the undamped oscillator in rad/s.
    pub omega: f64,
    /// Decay rate alpha = zeta omega in 1/s.
    pub alpha: f64,
}

/// What a force on a tip does to an oscillator besides what its own participation says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feed {
    /// Further participation by which the force acts on the rate, kg^(-1/2).
    pub push: f64,
    /// Participation by which it acts on the coordinate itself, s kg^(-1/2).
    pub slip: f64,
}

impl Oscillator {
    /// The moments [S_-2, S_-1, S_0, ..., S_(STAGES-1)] at time `t` >= 0.
    pub fn moments(&self, t: f64) -> [f64; MOMENTS] {
        if (self.omega + 2.0 * self.alpha) * t < 2.0 {
            self.series(t)
        } else if self.alpha > 1.1 * self.omega {
            self.overdamped(t)
        } else {
            self.closed_form(t)
        }
    }

    /// The first two moments, all that free vibration needs: impulse response and its slope, [S_-2, S_-1].
    pub fn free(&self, t: f64) -> [f64; 2] {
        if self.alpha == 0.0 && self.omega > 0.0 {
            let (sine, cosine) = (self.omega * t).sin_cos();
            return [cosine, sine / self.omega];
        }
        let [slope, impulse, ..] = self.moments(t);
        [slope, impulse]
    }

    /// Coordinate and rate, positive against the force, under forces tau^p / p! through `feed`, from the oscillator's `moments`.
    #[inline]
    pub fn fed(&self, feed: &Feed, moments: &[f64; MOMENTS]) -> [[f64; STAGES]; 2] {
        let Feed { push, slip } = *feed;
        let of = |p: usize| {
            let [rate, displacement] = [moments[p + 1], moments[p + 2]];
            [
                push * displacement + slip * (rate + 2.0 * self.alpha * displacement),
                push * rate - slip * self.omega.powi(2) * displacement,
            ]
        };
        [0, 1].map(|i| std::array::from_fn(|p| of(p)[i]))
    }

    /// Coordinate and rate after `time` s of free motion from `state`.
    pub fn after(&self, time: f64, [q, v]: [f64; 2]) -> [f64; 2] {
        let [slope, impulse] = self.free(time);
        [(slope + 2.0 * self.alpha * impulse) * q + impulse * v, slope * v - self.omega.powi(2) * impulse * q]
    }

    /// Small omega t: power series for the two highest moments, recurrence downwards.
    fn series(&self, t: f64) -> [f64; MOMENTS] {
        let (w2, a2) = (self.omega * self.omega, 2.0 * self.alpha);
        let rate = (self.omega + a2) * t;
        let powers = powers(t);
        // s = sum of s_n t^n/n! (s_1 = 1), integrated p + 1 times: sum of s_n t^(n+p+1)/(n+p+1)!
        let mut moments = [0.0; MOMENTS];
        let (mut earlier, mut coefficient) = (0.0, 1.0);
        let (mut power, mut envelope) = (powers[STAGES], 1.0);
        for n in 1.. {
            moments[MOMENTS - 2] += coefficient * power;
            power *= t * RECIPROCAL[n + STAGES];
            moments[MOMENTS - 1] += coefficient * power;
            envelope *= rate * RECIPROCAL[n + STAGES];
            if envelope < 1e-18 {
                break;
            }
            (earlier, coefficient) = (coefficient, -a2 * coefficient - w2 * earlier);
        }
        for p in (0..STAGES).rev() {
            moments[p] = powers[p] - a2 * moments[p + 1] - w2 * moments[p + 2];
        }
        moments
    }

    /// Large omega t: impulse response in closed form, recurrence upwards.
    fn closed_form(&self, t: f64) -> [f64; MOMENTS] {
        let (w2, a2) = (self.omega * self.omega, 2.0 * self.alpha);
        let [slope, value] = self.impulse_response(t);
        let mut moments = [0.0; MOMENTS];
        moments[0] = slope;
        moments[1] = value;
        let mut power = 1.0;
        for p in 0..STAGES {
            if p > 0 {
                power *= t / p as f64;
            }
            moments[p + 2] = (power - a2 * moments[p + 1] - moments[p]) / w2;
        }
        moments
    }

    /// Strong damping: difference of two decays, each with its own moments.
    fn overdamped(&self, t: f64) -> [f64; MOMENTS] {
        let spread = (self.alpha * self.alpha - self.omega * self.omega).sqrt();
        let fast = -(self.alpha + spread);
        let slow = self.omega * self.omega / fast;
        let (fast, slow) = (decay_moments(fast, t), decay_moments(slow, t));
        std::array::from_fn(|i| (slow[i] - fast[i]) / (2.0 * spread))
    }

    /// s'(t) and s(t) for omega > 0, weak to slightly more than critical damping.
    fn impulse_response(&self, t: f64) -> [f64; 2] {
        // z = (damped frequency times t)^2, negative beyond critical damping
        let z = (self.omega - self.alpha) * (self.omega + self.alpha) * t * t;
        let root = z.abs().sqrt();
        let decay = (-self.alpha * t).exp();
        // both with the decay
        let (sine_ratio, cosine) = if z.abs() < 1e-3 {
            (
                decay * (1.0 - z / 6.0 * (1.0 - z / 20.0 * (1.0 - z / 42.0 * (1.0 - z / 72.0)))),
                decay * (1.0 - z / 2.0 * (1.0 - z / 12.0 * (1.0 - z / 30.0 * (1.0 - z / 56.0)))),
            )
        } else if z > 0.0 {
            (decay * root.sin() / root, decay * root.cos())
        } else {
            // the hyperbolic functions alone overflow
            let (slow, fast) = ((root - self.alpha * t).exp(), (-root - self.alpha * t).exp());
            (0.5 * (slow - fast) / root, 0.5 * (slow + fast))
        };
        let value = t * sine_ratio;
        [cosine - self.alpha * value, value]
    }
}

/// Moments of the decay e^(lambda t), lambda <= 0: [lambda e^(lambda t), e^(lambda t), E_0, E_1, ...] with
/// E_p the integral of e^(lambda (t - tau)) tau^p / p! over 0..t and E_(p-1) = lambda E_p + t^p / p!.
fn decay_moments(lambda: f64, t: f64) -> [f64; MOMENTS] {
    let powers = powers(t);
    let mut moments = [0.0; MOMENTS];
    if lambda * t > -2.0 {
        let mut term = powers[STAGES];
        for n in STAGES + 1.. {
            moments[MOMENTS - 1] += term;
            term *= lambda * t * RECIPROCAL[n];
            if term.abs() < 1e-18 * moments[MOMENTS - 1] {
                break;
            }
        }
        for p in (0..STAGES).rev() {
            moments[p + 1] = lambda * moments[p + 2] + powers[p];
        }
    } else {
        moments[1] = (lambda * t).exp();
        for p in 0..STAGES {
            moments[p + 2] = (moments[p + 1] - powers[p]) / lambda;
        }
    }
    moments[0] = lambda * moments[1];
    moments
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::quadrature::gauss_legendre;
    use approx::assert_relative_eq;

    /// s(t) in closed form, written apart from the code under test.
    fn impulse(omega: f64, zeta: f64, t: f64) -> f64 {
        if omega == 0.0 {
            t
        } else if zeta < 1.0 {
            let d = omega * (1.0 - zeta * zeta).sqrt();
            (-zeta * omega * t).exp() * (d * t).sin() / d
        } else {
            let d = omega * (zeta * zeta - 1.0).sqrt();
            (-zeta * omega * t).exp() * (d * t).sinh() / d
        }
    }

    #[test]
    fn moments_equal_the_quadrature_of_duhamels_integral() {
        let (points, weights) = gauss_legendre(150);
        for omega in [0.0, 1e-6, 0.3, 1.0, 1.9, 2.1, 7.0, 40.0] {
            for zeta in [0.0, 0.02, 0.7, 1.05, 1.3, 4.0] {
                let t = 1.0;
                let moments = Oscillator { omega, alpha: zeta * omega }.moments(t);
                assert_relative_eq!(
                    moments[1],
                    impulse(omega, zeta, t),
                    epsilon = 1e-12,
                    max_relative = 1e-10
                );
                let mut factorial = 1.0;
                for p in 0..STAGES {
                    factorial *= (p.max(1)) as f64;
                    let integral: f64 = points
                        .iter()
                        .zip(&weights)
                        .map(|(x, w)| {
                            let tau = 0.5 * (x + 1.0) * t;
                            0.5 * t * w * impulse(omega, zeta, t - tau) * tau.powi(p as i32) / factorial
                        })
                        .sum();
                    assert_relative_eq!(moments[p + 2], integral, epsilon = 1e-13, max_relative = 1e-9);
                }
            }
        }
    }

    #[test]
    fn free_vibration_is_the_first_two_moments() {
        for omega in [0.0, 1e-6, 0.3, 1.9, 2.1, 40.0] {
            for zeta in [0.0, 0.02, 1.3] {
                let oscillator = Oscillator { omega, alpha: zeta * omega };
                let [slope, impulse, ..] = oscillator.moments(1.0);
                let free = oscillator.free(1.0);
                assert_relative_eq!(free[0], slope, epsilon = 1e-14);
                assert_relative_eq!(free[1], impulse, epsilon = 1e-14);
            }
        }
    }

    #[test]
    fn slightly_overdamped_for_long_is_finite() {
        for zeta in [1.0, 1.0 + 1e-9, 1.001, 1.05, 1.0999, 1.1001, 2.0] {
            for t in [1e2, 1e4, 1e6] {
                let moments = Oscillator { omega: 1.0, alpha: zeta }.moments(t);
                assert!(moments.iter().all(|m| m.is_finite()), "zeta {zeta}, t {t}: {moments:?}");
                // at rest under a constant force of 1: the displacement is the flexibility
                let slowest = zeta - (zeta * zeta - 1.0).sqrt();
                assert_relative_eq!(moments[2], 1.0, epsilon = 1e-12 + 3.0 * t * (-slowest * t).exp());
            }
        }
    }

    #[test]
    fn critical_damping_is_exact() {
        let critical = Oscillator { omega: 3.0, alpha: 3.0 }.moments(1.0);
        let response = (-3.0_f64).exp();
        assert_relative_eq!(critical[1], response, max_relative = 1e-13);
        assert_relative_eq!(critical[0], response * (1.0 - 3.0), max_relative = 1e-13);
    }
}
