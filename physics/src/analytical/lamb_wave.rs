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
/// xi h below which integrals in closed form cancel.
const CANCELLING: f64 = 0.3;
/// Gauss's places and weights for even functions on -1..1, exact to the tenth power.
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691_04),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_36),
];

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
        let omega = Section::new(thickness, material).lower_wave(wave_number).0;
        let shear = (material.shear_modulus() / material.density).sqrt();
        let near = (omega / (shear * wave_number)).powi(2);
        if x < LONG {
            let nu = material.poisson_ratio;
            return Self { omega, face: 1.0 - x * x * (1.0 + nu) / (6.0 * (1.0 - nu)) };
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
    let amplitude = -2.0 * a / (1.0 + b * b);
    let mean =
        if x < CANCELLING { by_quadrature(x, [a, b], amplitude) } else { integrated(x, [a, b], amplitude) };
    (a + amplitude).abs() / mean.sqrt()
}

/// Mean of u_z^2 + u_r^2 across the thickness, in closed form.
fn integrated(x: f64, [a, b]: [f64; 2], amplitude: f64) -> f64 {
    let (tanh_a, tanh_b) = ((a * x).tanh(), (b * x).tanh());
    // integrals over -1..1 of z/h of products of cosh and of sinh, each over its cosh at the face
    let alone = |k: f64, tanh: f64| {
        let (edge, rest) = (1.0 - tanh * tanh, tanh / (k * x));
        [edge + rest, rest - edge]
    };
    let difference = (a - b) * (a + b) * x;
    let between =
        [2.0 * (a * tanh_a - b * tanh_b) / difference, 2.0 * (a * tanh_b - b * tanh_a) / difference];
    let [of_a, of_b] = [alone(a, tanh_a), alone(b, tanh_b)];
    let across = a * a * of_a[0] + 2.0 * a * amplitude * between[0] + amplitude.powi(2) * of_b[0];
    let along = of_a[1] + 2.0 * b * amplitude * between[1] + (b * amplitude).powi(2) * of_b[1];
    0.5 * (across + along)
}

/// The same by Gauss's rule, where the integrals of a long wave are lost in their differences.
fn by_quadrature(x: f64, [a, b]: [f64; 2], amplitude: f64) -> f64 {
    let (cosh_a, cosh_b) = ((a * x).cosh(), (b * x).cosh());
    let square = |z: f64| {
        let across = a * (a * z).cosh() / cosh_a + amplitude * (b * z).cosh() / cosh_b;
        let along = (a * z).sinh() / cosh_a + b * amplitude * (b * z).sinh() / cosh_b;
        across * across + along * along
    };
    GAUSS.into_iter().map(|(place, weight)| weight * square(place * x)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analytical::circular_plate::rigidity;
    use approx::assert_relative_eq;

    /// Rayleigh's wave: its speed over that of shear waves solves c^6 - 8 c^4 + (24 - 16 s) c^2 - 16 (1 - s) = 0 with s that of shear
    /// over longitudinal waves, squared; 0.919402 for nu = 1/4.
    #[test]
    fn a_short_wave_is_rayleighs() {
        for (nu, speed) in [(0.25, 0.919402), (0.0, 0.874032), (-0.9, f64::NAN), (0.49, f64::NAN)] {
            let material = Material::elastic("m", 2e11, nu, 7800.0);
            let wave = FlexuralWave::new(120.0, 1.0, &material);
            let shear = (material.shear_modulus() / material.density).sqrt();
            let c = wave.omega / (120.0 * shear);
            let s = (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu));
            let rayleigh = c.powi(6) - 8.0 * c.powi(4) + (24.0 - 16.0 * s) * c * c - 16.0 * (1.0 - s);
            assert!(rayleigh.abs() < 1e-6, "{nu}: {rayleigh:e}");
            if speed.is_finite() {
                assert_relative_eq!(c, speed, max_relative = 1e-6);
            }
        }
    }

    #[test]
    fn the_mean_square_is_the_same_by_quadrature() {
        for decay in [[0.99, 0.95], [0.9, 0.8]] {
            let amplitude = -2.0 * decay[0] / (1.0 + decay[1] * decay[1]);
            let [closed, gauss] = [integrated, by_quadrature].map(|mean| mean(CANCELLING, decay, amplitude));
            assert_relative_eq!(closed, gauss, max_relative = 1e-8);
        }
    }

    #[test]
    fn a_long_wave_is_kirchhoffs_and_nothing_jumps_where_the_equation_takes_over() {
        for nu in [-0.95, -0.3, 0.3, 0.499] {
            let material = Material::elastic("m", 2e11, nu, 7800.0);
            let at = |x: f64| FlexuralWave::new(2.0 * x, 1.0, &material);
            let bending = (rigidity(2e11, nu, 1.0) / 7800.0).sqrt();
            assert_relative_eq!(at(1e-4).omega, bending * 4e-8, max_relative = 1e-6);
            let [below, above] = [0.9999, 1.0001].map(|share| at(share * LONG));
            assert_relative_eq!(above.omega / below.omega, 1.0004, max_relative = 2e-6);
            assert_relative_eq!(above.face, below.face, max_relative = 1e-6);
        }
    }
}
