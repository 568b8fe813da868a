//! The lowest flexural wave of a free elastic layer, exact in three dimensions (Rayleigh and Lamb; K. F. Graff, Wave Motion in
//! Elastic Solids, 1975, section 8.1).
//!
//! With the wave number xi, half the thickness h, alpha^2 = xi^2 - omega^2/c_l^2 and beta^2 = xi^2 - omega^2/c_t^2 it solves
//!
//!   (xi^2 + beta^2)^2 tanh(alpha h) = 4 xi^2 alpha beta tanh(beta h)
//!
//! and moves by u_z = alpha cosh(alpha z)/cosh(alpha h) + xi b cosh(beta z)/cosh(beta h) times J0(xi r),
//! u_r = -xi sinh(alpha z)/cosh(alpha h) - beta b sinh(beta z)/cosh(beta h) times J1(xi r), b = -2 xi alpha/(xi^2 + beta^2).

use super::mindlin_plate::Section;
use crate::numerics::root::root_from;
use crate::scene::Material;

/// xi h below which the equation is lost in rounding, and Mindlin's plate exact to 1e-7.
const LONG: f64 = 0.02;

/// The wave of one wave number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlexuralWave {
    /// Angular frequency in rad/s.
    pub omega: f64,
    /// Displacement of the faces over the root mean square of that of the mass, across the thickness.
    pub face: f64,
}

impl FlexuralWave {
    /// With `wave_number` 1/m in a layer of `thickness` m.
    pub fn new(wave_number: f64, thickness: f64, material: &Material) -> Self {
        let x = 0.5 * wave_number * thickness;
        let section = Section::new(thickness, material);
        let omega = section.lower_wave(wave_number).0;
        let shear = (material.shear_modulus() / material.density).sqrt();
        let near = (omega / (shear * wave_number)).powi(2);
        if x < LONG {
            let long = (section.lower_wave(2.0 * LONG / thickness).0 / (shear * 2.0 * LONG / thickness)).powi(2);
            let (_, face) = exact(LONG, long, material.poisson_ratio);
            return Self { omega, face: 1.0 + (face - 1.0) * (x / LONG).powi(2) };
        }
        let (y, face) = exact(x, near, material.poisson_ratio);
        Self { omega: y.sqrt() * shear * wave_number, face }
    }
}

/// Square of the wave's speed over that of shear waves, which is about `near`, and [`FlexuralWave::face`], for x = xi h.
fn exact(x: f64, near: f64, nu: f64) -> (f64, f64) {
    // square of the speed of shear waves over that of longitudinal ones
    let slow = (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu));
    let decay = |y: f64| [(1.0 - slow * y).sqrt(), (1.0 - y).sqrt()];
    let miss = |y: f64| {
        let [a, b] = decay(y);
        ((1.0 + b * b).powi(2) * (a * x).tanh() - 4.0 * a * b * (b * x).tanh()) / y
    };
    let bracket = [0.5 * near, (1.3 * near).min(1.0 - 1e-9)];
    let y = root_from(miss, near.min(bracket[1]), bracket).unwrap_or(near);
    (y, face(x, decay(y)))
}

/// [`FlexuralWave::face`] for x = xi h, alpha/xi and beta/xi.
fn face(x: f64, [a, b]: [f64; 2]) -> f64 {
    let (tanh_a, tanh_b) = ((a * x).tanh(), (b * x).tanh());
    let amplitude = -2.0 * a / (1.0 + b * b);
    // integrals over -1..1 of z/h of products of cosh and of sinh, each over its cosh at the face
    let alone = |k: f64, tanh: f64| {
        let (edge, rest) = (1.0 - tanh * tanh, tanh / (k * x));
        [edge + rest, rest - edge]
    };
    let difference = (a - b) * (a + b) * x;
    let between = [2.0 * (a * tanh_a - b * tanh_b) / difference, 2.0 * (a * tanh_b - b * tanh_a) / difference];
    let [of_a, of_b] = [alone(a, tanh_a), alone(b, tanh_b)];
    let across = a * a * of_a[0] + 2.0 * a * amplitude * between[0] + amplitude.powi(2) * of_b[0];
    let along = of_a[1] + 2.0 * b * amplitude * between[1] + (b * amplitude).powi(2) * of_b[1];
    (a + amplitude).abs() / (0.5 * (across + along)).sqrt()
}
