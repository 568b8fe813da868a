//! Hertz's elastic impact of two bodies, closed form (Goldsmith, Impact, 1960, chapter 4).

/// Duration over delta/v: integral of du / sqrt(1 - u^(5/2)) over 0..1, doubled,
/// `4 sqrt(pi)/5 Gamma(2/5)/Gamma(9/10)`.
const DURATION: f64 = 2.943_275_183_9;

/// Impact of a body of effective mass `mass` on a Hertz contact.
///
/// ```
/// use impactcheck_physics::analytical::hertz::HertzImpact;
///
/// let hit = HertzImpact { mass: 0.0326, speed: 0.55, stiffness: 1.538e10 };
/// // the momentum is turned round within the duration: the mean force is 1/1.84 of the peak
/// assert!((hit.force_peak() * hit.duration() / (2.0 * hit.mass * hit.speed) - 1.84).abs() < 1e-3);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzImpact {
    /// Effective mass m1 m2 / (m1 + m2) in kg.
    pub mass: f64,
    /// Approach speed in m/s.
    pub speed: f64,
    /// Contact stiffness k of F = k delta^(3/2) in N/m^(3/2).
    pub stiffness: f64,
}

impl HertzImpact {
    /// Largest approach in m: (5 m v^2 / (4 k))^(2/5).
    pub fn approach_peak(&self) -> f64 {
        (1.25 * self.mass * self.speed.powi(2) / self.stiffness).powf(0.4)
    }

    /// Largest force in N: k delta^(3/2).
    pub fn force_peak(&self) -> f64 {
        self.stiffness * self.approach_peak().powf(1.5)
    }

    /// Duration of the contact in s: 2.943275 delta / v.
    pub fn duration(&self) -> f64 {
        DURATION * self.approach_peak() / self.speed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn force_peak_equals_the_form_with_zeners_time() {
        // F = 1.143263 m v / T with T = (m / (k sqrt v))^(2/5)
        let hit = HertzImpact { mass: 0.0326, speed: 0.55, stiffness: 1.5e10 };
        let time = (hit.mass / (hit.stiffness * hit.speed.sqrt())).powf(0.4);
        assert_relative_eq!(hit.force_peak(), 1.143_263 * hit.mass * hit.speed / time, max_relative = 1e-6);
    }

    #[test]
    fn duration_equals_the_quadrature_of_the_energy_equation() {
        // dt = d(delta) / (v sqrt(1 - (delta/delta_max)^(5/2))); u = 1 - s^2 removes the end singularity
        let n = 20_000;
        let integrand = |s: f64| {
            let u: f64 = 1.0 - s * s;
            if s == 0.0 { 2.0 / 2.5_f64.sqrt() } else { 2.0 * s / (1.0 - u.powf(2.5)).sqrt() }
        };
        let h = 1.0 / n as f64;
        let simpson: f64 = (0..=n)
            .map(|i| {
                let weight = if i == 0 || i == n {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                weight * integrand(i as f64 * h)
            })
            .sum::<f64>()
            * h
            / 3.0;
        assert_relative_eq!(2.0 * simpson, DURATION, max_relative = 1e-8);
    }
}
