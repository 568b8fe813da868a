//! Axisymmetric vibration of a circular plate with shear and rotary inertia (R. D. Mindlin, J. Appl. Mech. 18, 1951, 31; Mindlin and
//! Deresiewicz, J. Appl. Phys. 25, 1954, 1329), below the frequency at which the thickness shears.
//!
//! Deflection w = J0(k r) + g I0(l r)/I0(l), rotation psi = p J1(k r) + g q I1(l r)/I0(l), in radii of the plate. The wave number k
//! is that of [`Section::lower_wave`], l the one that decays from the rim at the same frequency.

use super::circular_plate::{bessel_i_ratio, bessel_i0, pole, rigidity, softest};
use crate::numerics::root::root_from;
use crate::scene::{Edge, Material};
use std::f64::consts::PI;

/// Frequency over that at which the thickness shears up to which there is one family of modes.
const BELOW_SHEAR: f64 = 0.95;

/// Argument beyond which 1/I0 is nothing beside 1.
const NOTHING: f64 = 30.0;
/// Argument beyond which the asymptote of I1/I0 is right to 1e-9.
const ASYMPTOTIC: f64 = 25.0;

/// A plate per unit of its area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// D in N m.
    bending: f64,
    /// Shear stiffness with the coefficient 5/(6 - nu), N/m.
    shear: f64,
    /// kg/m^2.
    mass: f64,
    /// kg.
    rotary: f64,
}

/// A mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// In 1/m.
    pub wave_number: f64,
    /// Deflection of the centre, mass-normalised, kg^(-1/2).
    pub centre: f64,
    /// l in 1/m.
    pub decay: f64,
    /// Share g/I0(l) of what decays from the rim in the centre, the wave's being 1.
    pub rim: f64,
}

/// What a wave number k comes with, in radii: l, p and q of the module's formulas.
struct Rim {
    decay: f64,
    rotation: [f64; 2],
}

impl Section {
    /// Of `thickness` m.
    pub fn new(thickness: f64, material: &Material) -> Self {
        let mass = material.density * thickness;
        Self {
            bending: rigidity(material.youngs_modulus, material.poisson_ratio, thickness),
            shear: 5.0 / (6.0 - material.poisson_ratio) * material.shear_modulus() * thickness,
            mass,
            rotary: mass * thickness.powi(2) / 12.0,
        }
    }

    /// Frequency in rad/s of the lower wave with the wave number `xi` in 1/m, and the share of its mass that moves across the
    /// plate.
    pub fn lower_wave(&self, xi: f64) -> (f64, f64) {
        let Self { bending, shear, mass, rotary } = *self;
        // deflection and rotation, mass-normalised: [[a, b], [b, c]]
        let (a, c) = (shear * xi * xi / mass, (bending * xi * xi + shear) / rotary);
        let b = shear * xi / (mass * rotary).sqrt();
        let product = bending * shear * xi.powi(4) / (mass * rotary);
        let upper = 0.5 * (a + c + (a + c).mul_add(a + c, -4.0 * product).max(0.0).sqrt());
        let lower = product / upper;
        (lower.sqrt(), 1.0 / (1.0 + ((a - lower) / b).powi(2)))
    }

    /// Frequency in rad/s at which the thickness shears.
    pub fn shear_frequency(&self) -> f64 {
        (self.shear / self.rotary).sqrt()
    }

    fn rim(&self, k: f64, radius: f64) -> Rim {
        let square = self.lower_wave(k / radius).0.powi(2);
        let slow = self.mass * square / self.shear * radius * radius;
        let rest = self.shear - self.rotary * square;
        let decay = (self.mass * square * rest / (self.shear * self.bending)).sqrt() / k * radius * radius;
        Rim { decay, rotation: [k - slow / k, -(decay + slow / decay)] }
    }

    /// The first `count` elastic modes of a plate of `radius` m, or as many as there are below the frequency at which the thickness
    /// shears.
    pub fn modes(&self, edge: Edge, poisson_ratio: f64, radius: f64, count: usize) -> Vec<Mode> {
        let nu1 = 1.0 - poisson_ratio;
        let characteristic = |k: f64| {
            let Rim { decay, rotation: [p, q] } = self.rim(k, radius);
            let (j0, j1, ratio) = (libm::j0(k), libm::j1(k), rising_ratio(decay));
            let bent = [p * (k * j0 - nu1 * j1), q * (decay - nu1 * ratio)];
            match edge {
                Edge::Clamped => q * ratio * j0 - p * j1,
                Edge::SimplySupported => j0 * bent[1] - bent[0],
                Edge::Free => bent[0] * (decay + q) * ratio - bent[1] * (p - k) * j1,
            }
        };
        let below = |k: &f64| self.lower_wave(k / radius).0 < BELOW_SHEAR * self.shear_frequency();
        let first = softest(edge, poisson_ratio).map(|k| [0.3 * k, pole(edge, 1)]);
        let brackets = first.into_iter().chain((1..).map(|n| [pole(edge, n), pole(edge, n + 1)]));
        let mut found: Vec<f64> = Vec::with_capacity(count);
        for bracket in brackets.take(count).take_while(|[_, to]| below(to)) {
            // after the first they are nearly pi apart
            let near = match found[..] {
                [.., before, last] => 2.0 * last - before,
                _ => 0.5 * (bracket[0] + bracket[1]),
            };
            let Some(k) = root_from(characteristic, near.clamp(bracket[0], bracket[1]), bracket) else {
                break;
            };
            found.push(k);
        }
        found.into_iter().map(|k| self.mode(edge, radius, k)).collect()
    }

    fn mode(&self, edge: Edge, radius: f64, k: f64) -> Mode {
        let Rim { decay: l, rotation: [p, q] } = self.rim(k, radius);
        let (j0, j1, i) = (libm::j0(k), libm::j1(k), rising_ratio(l));
        let g = if edge == Edge::Free { -l / k * j1 / i } else { -j0 };
        let squares = k * k + l * l;
        let deflection = 0.5 * (j0 * j0 + j1 * j1)
            + 2.0 * g * (k * j1 + l * j0 * i) / squares
            + 0.5 * g * g * (1.0 - i * i);
        let rotation = 0.5 * p * p * (j0 * j0 + j1 * j1 - 2.0 * j0 * j1 / k)
            + 2.0 * g * p * q * (l * j1 - k * j0 * i) / squares
            + 0.5 * (g * q).powi(2) * (i * i - 1.0 + 2.0 * i / l);
        let mass = 2.0 * PI * (self.mass * radius * radius * deflection + self.rotary * rotation);
        let rim = if l < NOTHING { g / bessel_i0(l) } else { 0.0 };
        Mode { wave_number: k / radius, centre: (1.0 + rim).abs() / mass.sqrt(), decay: l / radius, rim }
    }
}

/// I1(x)/I0(x).
fn rising_ratio(x: f64) -> f64 {
    if x < ASYMPTOTIC {
        return bessel_i_ratio(x);
    }
    let terms = [0.5, 0.125, 0.125, 25.0 / 128.0, 13.0 / 32.0, 1073.0 / 1024.0];
    1.0 - terms.into_iter().rev().fold(0.0, |sum, term| (sum + term) / x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analytical::circular_plate::{centre_deflection, frequency_parameters};
    use approx::assert_relative_eq;

    const EDGES: [Edge; 3] = [Edge::Clamped, Edge::SimplySupported, Edge::Free];

    #[test]
    fn a_thin_plate_is_kirchhoffs() {
        for (edge, nu) in EDGES.into_iter().flat_map(|edge| [-0.9, 0.3].map(|nu| (edge, nu))) {
            let material = Material::elastic("m", 1.0, nu, 1.0);
            let section = Section::new(1e-4, &material);
            let exact = frequency_parameters(edge, nu, 12);
            let modes = section.modes(edge, nu, 1.0, 12);
            assert_eq!(modes.len(), 12);
            for (mode, k) in modes.iter().zip(exact) {
                assert_relative_eq!(mode.wave_number, k, max_relative = 1e-5);
                let centre = centre_deflection(edge, k) / section.mass.sqrt();
                assert_relative_eq!(mode.centre, centre, max_relative = 1e-5);
            }
        }
    }

    /// T. Irie, G. Yamada, K. Takagi, J. Appl. Mech. 47, 1980, 652: omega a^2 sqrt(rho h/D) at thickness over radius 0.1, nu 0.3, whose
    /// shear coefficient pi^2/12 is a sixteenth smaller.
    #[test]
    fn a_plate_of_a_tenth_is_that_of_irie_yamada_and_takagi() {
        let material = Material::elastic("m", 1.0, 0.3, 1.0);
        let section = Section::new(0.1, &material);
        for (edge, parameters) in
            EDGES.into_iter().zip([[9.941, 36.479, 75.664], [4.894, 28.240, 65.942], [8.868, 36.041, 76.676]])
        {
            for (mode, parameter) in section.modes(edge, 0.3, 1.0, 3).iter().zip(parameters) {
                let omega = section.lower_wave(mode.wave_number).0;
                let ours = omega * (section.mass / section.bending).sqrt();
                assert_relative_eq!(ours, parameter, max_relative = 0.011);
                assert!(ours > parameter);
            }
        }
    }

    /// Mass of the mode from its shape, by Simpson's rule.
    #[test]
    fn modes_are_mass_normalised() {
        let material = Material::elastic("m", 1.0, 0.3, 1.0);
        let section = Section::new(0.15, &material);
        for edge in EDGES {
            for mode in section.modes(edge, 0.3, 1.0, 4) {
                let (k, l) = (mode.wave_number, mode.decay);
                let rotation = section.rim(k, 1.0).rotation;
                let amplitude = mode.centre / (1.0 + mode.rim);
                let density = |r: f64| {
                    let i1 = if r == 0.0 { 0.0 } else { bessel_i_ratio(l * r) * bessel_i0(l * r) };
                    let w = libm::j0(k * r) + mode.rim * bessel_i0(l * r);
                    let psi = rotation[0] * libm::j1(k * r) + mode.rim * rotation[1] * i1;
                    2.0 * PI * r * (section.mass * w * w + section.rotary * psi * psi)
                };
                let count = 2000;
                let weight = |n: usize| if n == 0 || n == count { 1.0 } else { [2.0, 4.0][n % 2] };
                let sum: f64 = (0..=count).map(|n| weight(n) * density(n as f64 / count as f64)).sum();
                assert_relative_eq!(amplitude.powi(2) * sum / (3.0 * count as f64), 1.0, max_relative = 1e-7);
            }
        }
    }
}
