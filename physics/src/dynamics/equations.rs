//! The equations of motion as a rate of the state: what the reduced model would be integrated with by anybody else.
//!
//! A method that knows nothing of modes or contacts solves the same equations independently (`stress`), and is the compiled
//! peer of the benchmark.

use super::system::System;

/// The equations of `system` as a rate of the state [q, q'].
pub struct Equations<'a> {
    system: &'a System,
    damping: Vec<f64>,
    stiffness: Vec<f64>,
}

impl<'a> Equations<'a> {
    /// Of `system`.
    pub fn new(system: &'a System) -> Self {
        Self {
            damping: system.oscillators.iter().map(|o| 2.0 * o.alpha).collect(),
            stiffness: system.oscillators.iter().map(|o| o.omega * o.omega).collect(),
            system,
        }
    }

    /// State at t = 0 and the typical size of its entries: what the outer body does in a Hertz contact of `duration` s.
    pub fn start(&self, duration: f64) -> (Vec<f64>, Vec<f64>) {
        let (q, v) = self.system.initial_state();
        let rate = v.iter().fold(0.0_f64, |largest, v| largest.max(v.abs()));
        let scale = std::iter::repeat_n(rate * duration, q.len()).chain(std::iter::repeat_n(rate, q.len()));
        (q.iter().chain(&v).copied().collect(), scale.collect())
    }

    /// Writes the rate of the state `y`; NaN where the contacts have no equilibrium.
    pub fn rate(&self, y: &[f64], rate: &mut [f64]) {
        let n = self.system.size();
        let (q, v) = y.split_at(n);
        let (dq, dv) = rate.split_at_mut(n);
        let (dq, dv, v) = (&mut dq[..n], &mut dv[..n], &v[..n]);
        let y = self.system.modal_approach(q);
        let [f0, f1] = self.system.contact(y, y).map_or([f64::NAN; 2], |(_, forces)| forces);
        let (b0, b1) = (&self.system.approach[0][..n], &self.system.approach[1][..n]);
        let (damping, stiffness) = (&self.damping[..n], &self.stiffness[..n]);
        for k in 0..n {
            dq[k] = v[k];
            dv[k] = -damping[k] * v[k] - stiffness[k] * q[k] - b0[k] * f0 - b1[k] * f1;
        }
    }

    /// Velocities of outer and inner body in m/s in the state `y`.
    pub fn velocity(&self, y: &[f64]) -> [f64; 2] {
        self.system.of_bodies(&y[self.system.size()..])
    }
}
