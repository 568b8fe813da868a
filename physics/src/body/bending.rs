//! Bending modes of a circular plate in closed form: Lamb's wave inside, Mindlin's plate at the rim.
//!
//! Away from the rim a mode is the flexural wave of the elastic layer, exact in three dimensions. How it is reflected by the rim
//! decides which wave numbers fit: Mindlin's plate tells that of free and simply supported edges to 1e-4 of the frequencies. A
//! clamped rim also holds what the thickness would do by Poisson's ratio, as if the plate ended a little earlier; that shift over the
//! thickness depends on Poisson's ratio and the wave number times the thickness alone (`shift`).
//!
//! That holds below the frequency at which the thickness shears. From there on there are several waves that the rim mixes.

use super::free_sphere::patch_transform;
use crate::analytical::lamb_wave::FlexuralWave;
use crate::analytical::mindlin_plate::{Mode, Section};
use crate::scene::{Edge, Plate};

/// Share of the rim in the centre that is nothing.
const UNFELT: f64 = 1e-9;

/// A bending mode as the contacts see it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BendingMode {
    /// In 1/m.
    pub wave_number: f64,
    /// Angular frequency in rad/s.
    pub omega: f64,
    /// Displacement of the faces' centres, mass-normalised, kg^(-1/2).
    pub centre: f64,
    /// What decays from the rim: its wave number in 1/m and its share in the centre, the wave's being 1.
    pub rim: [f64; 2],
}

impl BendingMode {
    /// Displacement under a Hertz pressure of the radius `patch` m at the centre, kg^(-1/2).
    pub fn under(&self, patch: f64) -> f64 {
        self.centre * under_patch(self.wave_number, self.rim, patch)
    }
}

/// What a pressure of the radius `patch` m feels of a mode, over its centre: of the wave number `wave` in 1/m, with what decays from the
/// `rim` (wave number in 1/m, share in the centre, the wave's being 1).
pub(super) fn under_patch(wave: f64, [decay, share]: [f64; 2], patch: f64) -> f64 {
    let waving = patch_transform(wave * patch);
    // most modes' rims are not felt in the centre
    let rim = if share == 0.0 { 0.0 } else { share * rising_transform(decay * patch) };
    (waving + rim) / (1.0 + share)
}

/// Mean of I0(x r) under a Hertz pressure over r < 1, as [`patch_transform`] of J0.
fn rising_transform(x: f64) -> f64 {
    if x < 0.3 {
        return 1.0 + x * x / 10.0 * (1.0 + x * x / 28.0 * (1.0 + x * x / 54.0));
    }
    3.0 * (x * x.cosh() - x.sinh()) / x.powi(3)
}

/// The `count` lowest elastic ones of `plate`, or as many as there are below the frequency at which its thickness shears.
pub fn modes(plate: &Plate, count: usize) -> Vec<BendingMode> {
    let Plate { radius, thickness, edge, ref material, .. } = *plate;
    let nu = material.poisson_ratio;
    let section = Section::new(thickness, material);
    let fitted = section.modes(edge, nu, radius, count);
    let mode = |(n, fit): (usize, Mode)| {
        let (earlier, widened) = match edge {
            Edge::Clamped => shift(nu, fit.wave_number * thickness),
            Edge::SimplySupported | Edge::Free => (0.0, 0.0),
        };
        let wave_number = fit.wave_number * (1.0 + earlier * thickness / radius);
        let wave = FlexuralWave::new(wave_number, thickness, material);
        let across = section.lower_wave(fit.wave_number).1.sqrt();
        let stiffer = if n == 0 && edge == Edge::SimplySupported { resistance(nu) } else { 0.0 };
        BendingMode {
            wave_number,
            omega: wave.omega * (1.0 + 2.0 * stiffer * thickness / radius).sqrt(),
            // the faces of what decays from the rim move as the middle does
            centre: fit.centre / across
                * (1.0 + (wave.face - 1.0) / (1.0 + fit.rim))
                * (1.0 + widened * thickness / radius),
            rim: [fit.decay, if fit.rim.abs() < UNFELT { 0.0 } else { fit.rim }],
        }
    };
    fitted.into_iter().enumerate().map(mode).collect()
}

/// Coefficients of the shift of a clamped rim: powers of nu/(1 - nu) along the rows, of x^2/(2 + x^2) along the columns.
const SHIFT: [[f64; 3]; 4] = [
    [-0.00014, 0.00169, 0.01537],
    [-0.00573, -0.04088, 0.02329],
    [0.07378, -0.04906, 0.00705],
    [-0.01571, -0.01299, 0.00581],
];

/// By how many thicknesses a clamped plate of Poisson's ratio `nu` ends earlier for waves with x = wave number times thickness, and
/// what that adds to the centre's amplitude: c and c + x c'/2, since the density of the wave numbers that fit changes too.
///
/// Fitted to 534 frequencies of finite elements (continuum plates, thickness over radius 0.02 to 0.2), within 5e-4 of the frequencies.
fn shift(nu: f64, x: f64) -> (f64, f64) {
    let (u, y) = (nu / (1.0 - nu), x * x / (2.0 + x * x));
    let (mut value, mut slope) = (0.0, 0.0);
    for [constant, linear, quadratic] in SHIFT.into_iter().rev() {
        value = value * u + constant + y * (linear + y * quadratic);
        slope = slope * u + linear + 2.0 * y * quadratic;
    }
    let by_x = slope * 4.0 * x / (2.0 + x * x).powi(2);
    (value, value + 0.5 * x * by_x)
}

/// What a simply supported rim, held over the whole thickness, adds to half the square of the first frequency, per thickness over
/// radius: matters where nu nears -1, where bending to a paraboloid takes no energy. Fitted to finite elements as [`shift`].
fn resistance(nu: f64) -> f64 {
    if nu < 0.0 { 0.0215 * nu * nu / (1.0 + nu) } else { 0.0 }
}
