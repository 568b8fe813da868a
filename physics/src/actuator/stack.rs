//! Piezo stack (section 2.2.1): a rod that is fixed at its base and drives its free end by the voltage on it.
//!
//! Longitudinal modes of the rod with Love's correction for lateral inertia (A. Love, A Treatise on the Mathematical Theory of
//! Elasticity, 1927, article 278): kappa_k = (2 k - 1) pi/(2 L), omega_k = kappa_k c/sqrt(1 + nu^2 kappa_k^2 r^2) with the polar radius
//! of gyration r of the section, here a circle's. The layers push on every mode as a force alpha V at the tip does:
//! q'' + omega^2 q = phi (alpha V - F), the extension is x = sum phi q. Held at its length the stack presses with alpha V, free it grows
//! by alpha V/k, k = E A/L.

use super::circuit::Account;
use serde::Serialize;
use std::f64::consts::{FRAC_PI_2, PI};

/// Modes of the rod that move by themselves.
pub const MODES: usize = 20;
/// Time constant of the charging of the held stack, in radians of the rod's quickest mode, below which it changes nothing: velocities
/// differ from the limit by about 1e-7, and by 4e-6 if 99 % of the free stack's capacitance is coupled. A third of it would leave nothing
/// of the damping by the resistor but rounding.
const AT_ONCE: f64 = 1e-6;

/// What supplies a stack: a charged buffer behind a resistor (Fig. 2), switched on at once.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Supply {
    /// Resistance between buffer and stack in Ohm.
    pub resistance: f64,
    /// Capacitance of the buffer in F; `None` = so large that its voltage stays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub buffer_capacitance: Option<f64>,
}

impl Supply {
    /// 1/C of the buffer in 1/F.
    pub fn elastance(&self) -> f64 {
        self.buffer_capacitance.map_or(0.0, f64::recip)
    }
}

/// Piezo stack, at rest and without charge until it is switched on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Stack {
    /// Length L in m.
    pub length: f64,
    /// Area of the section in m^2.
    pub area: f64,
    /// Growth of the free stack at `voltage` in m.
    pub stroke: f64,
    /// Force of the held stack at `voltage` in N.
    pub blocked_force: f64,
    /// Voltage that is switched on (of the buffer before) in V.
    pub voltage: f64,
    /// Capacitance of the free stack in F.
    pub capacitance: f64,
    /// Mass density in kg/m^3.
    pub density: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
    /// Radius of curvature at the contact in m.
    pub tip_radius: f64,
    /// Distance of its tip from the plate before it is switched on, in m.
    pub gap: f64,
    /// What supplies it; `None` = a source that holds `voltage` whatever it takes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drive: Option<Supply>,
}

/// A longitudinal mode of the stack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RodMode {
    /// Eigenfrequency without charge or with the voltage held, rad/s.
    pub omega: f64,
    /// Extension of the tip in the mass-normalised mode, kg^(-1/2).
    pub tip: f64,
}

impl Stack {
    /// Force per voltage alpha in N/V, which is charge per extension in C/m.
    pub fn force_per_voltage(&self) -> f64 {
        self.blocked_force / self.voltage
    }

    /// Stiffness k at constant voltage in N/m.
    pub fn stiffness(&self) -> f64 {
        self.blocked_force / self.stroke
    }

    /// Capacitance in F of the stack held at its length.
    pub fn clamped_capacitance(&self) -> f64 {
        self.capacitance - self.force_per_voltage().powi(2) / self.stiffness()
    }

    /// Time in s in which the free stack charges per resistance of its supply, the capacitance of stack and buffer in series, F.
    pub fn charging_time_per_resistance(&self) -> f64 {
        self.capacitance / (1.0 + self.capacitance * self.drive.map_or(0.0, |supply| supply.elastance()))
    }

    /// Supply with a resistance that matters: `None` where the stack charges so quickly that the source is as good as ideal. A buffer of
    /// finite capacitance is none; behind a smaller resistance it does what it does behind the least one that matters.
    pub fn resistive_drive(&self) -> Option<Supply> {
        let drive = self.drive?;
        let clamped = self.clamped_capacitance();
        let in_series = clamped / (1.0 + clamped * drive.elastance());
        let least = AT_ONCE / (self.mode(MODES).omega * in_series);
        let resistance = drive.resistance.max(least);
        (drive.resistance >= least || drive.buffer_capacitance.is_some())
            .then_some(Supply { resistance, ..drive })
    }

    /// Mass in kg.
    pub fn mass(&self) -> f64 {
        self.density * self.area * self.length
    }

    /// Speed c = sqrt(E/rho) of long waves in m/s.
    pub fn wave_speed(&self) -> f64 {
        (self.stiffness() * self.length / (self.area * self.density)).sqrt()
    }

    /// Speed of the tip in m/s after the voltage was put on at once: stroke c/L. When the wave has passed once the whole stack has it.
    pub fn step_speed(&self) -> f64 {
        self.stroke * self.wave_speed() / self.length
    }

    /// (nu kappa r)^2 of mode `k` = 0, 1, ...: what Love adds to its mass.
    fn lateral(length: f64, area: f64, poisson_ratio: f64, k: usize) -> f64 {
        let kappa = (2 * k + 1) as f64 * FRAC_PI_2 / length;
        (poisson_ratio * kappa).powi(2) * area / (2.0 * PI)
    }

    /// Density in kg/m^3 of the stack that has `first_frequency` Hz, fixed at its base, all else being as here.
    pub fn density_for(&self, first_frequency: f64) -> f64 {
        let love = 1.0 + Self::lateral(self.length, self.area, self.poisson_ratio, 0);
        let wave_speed = 4.0 * self.length * first_frequency * love.sqrt();
        self.stiffness() * self.length / (self.area * wave_speed.powi(2))
    }

    fn mode(&self, k: usize) -> RodMode {
        let kappa = (2 * k + 1) as f64 * FRAC_PI_2 / self.length;
        let love = 1.0 + Self::lateral(self.length, self.area, self.poisson_ratio, k);
        RodMode { omega: kappa * self.wave_speed() / love.sqrt(), tip: (2.0 / (self.mass() * love)).sqrt() }
    }

    /// The lowest `modes` modes, and as one more all others: with the flexibility that they have together, at the frequency of the first
    /// of them. So the stroke is the whole one, and nothing jumps when the voltage does.
    pub fn modes(&self, modes: usize) -> Vec<RodMode> {
        let mut all: Vec<RodMode> = (0..modes).map(|k| self.mode(k)).collect();
        let flexibility: f64 = all.iter().map(|mode| (mode.tip / mode.omega).powi(2)).sum();
        let omega = self.mode(modes).omega;
        let rest = 1.0 / self.stiffness() - flexibility;
        all.push(RodMode { omega, tip: omega * rest.sqrt() });
        all
    }
}

impl Stack {
    /// Energies in J at a source that holds the voltage, in the state (`q`, `v`) of [`Stack::modes`] about their rest.
    pub fn account(&self, q: &[f64], v: &[f64]) -> Account {
        let modes = self.modes(MODES);
        let (mut extension, mut own, mut about_rest) = (0.0, 0.0, 0.0);
        for ((mode, q), v) in modes.iter().zip(q).zip(v) {
            let whole = q + self.blocked_force * mode.tip / mode.omega.powi(2);
            extension += mode.tip * whole;
            own += 0.5 * (v * v + (mode.omega * whole).powi(2));
            about_rest += 0.5 * (v * v + (mode.omega * q).powi(2));
        }
        // charged at once, the held stack costs as much heat as it keeps
        let charging = 0.5 * self.clamped_capacitance() * self.voltage.powi(2);
        Account {
            taken: 2.0 * charging + self.blocked_force * extension,
            held: charging + own,
            available: about_rest,
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Of the class of TOKIN's AE0505D16DF (data sheet).
    pub(in crate::actuator) fn tokin() -> Stack {
        Stack {
            length: 18e-3,
            area: 25e-6,
            stroke: 17.4e-6,
            blocked_force: 850.0,
            voltage: 150.0,
            capacitance: 1.4e-6,
            density: 8000.0,
            poisson_ratio: 0.3,
            tip_radius: 5e-3,
            gap: 0.0,
            drive: None,
        }
    }

    #[test]
    fn all_modes_together_have_the_stiffness_of_the_rod() {
        let stack = tokin();
        for modes in [1, 4, MODES] {
            let flexibility: f64 = stack.modes(modes).iter().map(|m| (m.tip / m.omega).powi(2)).sum();
            assert_relative_eq!(flexibility, 1.0 / stack.stiffness(), max_relative = 1e-13);
        }
        // without the others twenty lose a percent
        let few: f64 = stack.modes(MODES)[..MODES].iter().map(|m| (m.tip / m.omega).powi(2)).sum();
        assert_relative_eq!(1.0 - few * stack.stiffness(), 0.0101, max_relative = 0.01);
    }

    #[test]
    fn density_and_first_frequency_say_the_same() {
        let stack = tokin();
        let frequency = stack.modes(MODES)[0].omega / (2.0 * PI);
        assert_relative_eq!(stack.density_for(frequency), stack.density, max_relative = 1e-13);
        // a thin rod: c/(4 L)
        let thin = Stack { poisson_ratio: 0.0, ..stack };
        assert_relative_eq!(
            thin.modes(3)[2].omega / (2.0 * PI),
            5.0 * thin.wave_speed() / (4.0 * thin.length),
            max_relative = 1e-14
        );
    }
}
