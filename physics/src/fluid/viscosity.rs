//! Viscosity of the film: Newtonian or shear-thinning.
//!
//! In a gap of width h a pressure gradient G drives the flow Q = h^3 G/(12 mu) per width. For a generalised
//! Newtonian fluid mu is an effective viscosity that depends on the shear stress at the wall, tau = G h/2, alone:
//! integrating the profile, Q = h^2/(2 tau^2) * integral of s rate(s) ds over 0..tau, hence
//! mu = tau^3/(3 * integral of s rate(s) ds) (Rabinowitsch; Chu et al. in the paper write it as a fluidity). As the
//! film knows its flow, mu is tabulated over the apparent rate 6 Q/h^2 = tau/mu.

use crate::numerics::quadrature::gauss_legendre;
use crate::scene::{Fluid, ShearThinning};

/// Points of the table; the viscosity changes by at most 2.3 % between two.
const POINTS: usize = 1200;
/// Range of relaxation time times wall shear rate in the table: Newtonian to 1e-7 below and a power law cut off
/// by the lower viscosity, or simply held, above.
const RANGE: [f64; 2] = [1e-4, 1e8];

/// Effective viscosity as a function of the apparent shear rate.
#[derive(Debug, Clone, PartialEq)]
pub enum Viscosity {
    /// The same at every rate, Pa s.
    Newtonian(f64),
    /// Logarithms of apparent rate and of viscosity, both over equal steps of the logarithm of the wall's rate.
    ShearThinning {
        /// ln(rate s). Shape (n).
        rate: Vec<f64>,
        /// ln(mu/(Pa s)). Shape (n).
        viscosity: Vec<f64>,
    },
}

impl Viscosity {
    /// The law of `fluid`.
    pub fn new(fluid: &Fluid) -> Self {
        match &fluid.shear_thinning {
            None => Viscosity::Newtonian(fluid.viscosity),
            Some(law) => carreau(fluid.viscosity, law),
        }
    }

    /// Effective viscosity in Pa s at the apparent shear rate `rate` >= 0 in 1/s.
    pub fn at(&self, rate: f64) -> f64 {
        self.with_slope(rate).0
    }

    /// Effective viscosity in Pa s at the apparent shear rate `rate` >= 0 in 1/s, and d ln(viscosity)/d ln(rate).
    pub fn with_slope(&self, rate: f64) -> (f64, f64) {
        match self {
            Viscosity::Newtonian(viscosity) => (*viscosity, 0.0),
            Viscosity::ShearThinning { rate: rates, viscosity } => {
                let x = rate.max(f64::MIN_POSITIVE).ln().clamp(rates[0], rates[rates.len() - 1]);
                let after = rates.partition_point(|r| *r < x).clamp(1, rates.len() - 1);
                let slope = (viscosity[after] - viscosity[after - 1]) / (rates[after] - rates[after - 1]);
                ((viscosity[after - 1] + slope * (x - rates[after - 1])).exp(), slope)
            }
        }
    }
}

/// Carreau's viscosity in Pa s at the true shear `rate` in 1/s.
fn true_viscosity(at_rest: f64, law: &ShearThinning, rate: f64) -> f64 {
    let fall = (1.0 + (law.relaxation_time * rate).powi(2)).powf(0.5 * (law.power_index - 1.0));
    law.infinite_shear_viscosity + (at_rest - law.infinite_shear_viscosity) * fall
}

fn carreau(at_rest: f64, law: &ShearThinning) -> Viscosity {
    let (points, weights) = gauss_legendre(8);
    let stress = |rate: f64| true_viscosity(at_rest, law, rate) * rate;
    // integral of s rate(s) ds = stress^2 rate/2 - integral of stress^2/2 d(rate)
    let mut squares = 0.0;
    let mut below = 0.0;
    let (mut rates, mut viscosities) = (Vec::new(), Vec::new());
    for point in 0..POINTS {
        let share = point as f64 / (POINTS - 1) as f64;
        let rate = RANGE[0] * (RANGE[1] / RANGE[0]).powf(share) / law.relaxation_time;
        let half = 0.5 * (rate - below);
        squares += points
            .iter()
            .zip(&weights)
            .map(|(x, w)| half * w * 0.5 * stress(below + half * (x + 1.0)).powi(2))
            .sum::<f64>();
        let wall = stress(rate);
        let viscosity = wall.powi(3) / (3.0 * (0.5 * wall * wall * rate - squares));
        rates.push((wall / viscosity).ln());
        viscosities.push(viscosity.ln());
        below = rate;
    }
    Viscosity::ShearThinning { rate: rates, viscosity: viscosities }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn law(power_index: f64) -> ShearThinning {
        ShearThinning { infinite_shear_viscosity: 1e-9, relaxation_time: 2e-3, power_index }
    }

    #[test]
    fn newtonian_at_low_rates_and_at_index_one() {
        assert_relative_eq!(carreau(0.05, &law(0.4)).at(1e-2), 0.05, max_relative = 1e-6);
        for rate in [0.0, 1.0, 1e3, 1e9, 1e30] {
            assert_relative_eq!(carreau(0.05, &law(1.0)).at(rate), 0.05, max_relative = 1e-8);
        }
    }

    #[test]
    fn power_law_between_the_bounds() {
        for n in [0.3, 0.6, 0.9] {
            let law = law(n);
            let viscosity = carreau(0.05, &law);
            let consistency = 0.05 * law.relaxation_time.powf(n - 1.0);
            for rate in [1e6, 1e7] {
                // slit flow of a power-law fluid: tau = K ((2 n + 1)/(3 n) * 6 Q/h^2)^n
                let wall = consistency * ((2.0 * n + 1.0) / (3.0 * n) * rate).powf(n);
                assert_relative_eq!(viscosity.at(rate), wall / rate, max_relative = 2e-3);
            }
        }
    }

    #[test]
    fn ends_at_the_lower_bound() {
        let law = ShearThinning { infinite_shear_viscosity: 1e-3, ..law(0.2) };
        assert_relative_eq!(carreau(0.05, &law).at(1e12), 1e-3, max_relative = 1e-2);
    }
}
