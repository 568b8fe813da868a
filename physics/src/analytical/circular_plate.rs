//! Axisymmetric vibration of a thin circular plate, closed form
//! (A. Leissa, Vibration of Plates, NASA SP-160, 1969, chapter 2).
//!
//! w = A J0(k r/a) + B I0(k r/a), omega = k^2/a^2 sqrt(D / (rho h)).

use crate::numerics::root::root;
use crate::scene::Edge;
use std::f64::consts::PI;

/// Frequency parameter below which differences of Bessel functions say less about a mode than that it is a paraboloid.
const PARABOLOID: f64 = 0.01;

/// Bending stiffness D = E h^3 / (12 (1 - nu^2)) in N m.
pub fn rigidity(youngs_modulus: f64, poisson_ratio: f64, thickness: f64) -> f64 {
    youngs_modulus * thickness.powi(3) / (12.0 * (1.0 - poisson_ratio.powi(2)))
}

/// The first `count` frequency parameters k (without the rigid motion of a free plate).
///
/// `poisson_ratio` matters for simply supported and free edges only. With j the zeros of J0 they solve, clamped and simply
/// supported, sum 4 j^2/(j^4 - k^4) = 0 and = 2/(1 - nu), with j those of J1, free, sum 2 k^4/(j^4 - k^4) = 1 + nu (J1/J0,
/// I1/I0, J0/J1 and I0/I1 in partial fractions). The sums rise from pole to pole: there is one root between any two
/// neighbours, and for simply supported and free edges one below the first.
pub fn frequency_parameters(edge: Edge, poisson_ratio: f64, count: usize) -> Vec<f64> {
    let characteristic = |k: f64| {
        let (j0, j1, r) = (libm::j0(k), libm::j1(k), bessel_i_ratio(k));
        let nu1 = 1.0 - poisson_ratio;
        match edge {
            Edge::Clamped => j0 * r + j1,
            Edge::SimplySupported => nu1 * (j1 + j0 * r) - 2.0 * k * j0,
            Edge::Free => k * (j0 * r + j1) - 2.0 * nu1 * j1 * r,
        }
    };
    let between = |low: f64, high: f64| root(characteristic, [low, high], [low, high].map(characteristic));
    let first = softest(edge, poisson_ratio);
    let first = first.map(|k| if k < PARABOLOID { k } else { between(0.5 * k, pole(edge, 1)) });
    first.into_iter().chain((1..).map(|n| between(pole(edge, n), pole(edge, n + 1)))).take(count).collect()
}

/// The first frequency parameter where Poisson's ratio nears -1 and bending to a paraboloid takes no energy any more, up to
/// terms in k^4; at most twice the true one elsewhere. None for a clamped plate.
pub(super) fn softest(edge: Edge, poisson_ratio: f64) -> Option<f64> {
    let fourth_power = match edge {
        Edge::Clamped => return None,
        Edge::SimplySupported => 48.0 * (1.0 + poisson_ratio) / (1.0 - poisson_ratio),
        Edge::Free => 96.0 * (1.0 + poisson_ratio),
    };
    Some(fourth_power.powf(0.25))
}

/// Zero number `n` of J1 for a free edge, else of J0, to 0.005 (McMahon's expansion; Watson, Bessel Functions, 1944, 15.53).
pub(super) fn pole(edge: Edge, n: usize) -> f64 {
    let asymptote = |shift: f64| (n as f64 + shift) * PI;
    match edge {
        Edge::Free => asymptote(0.25) - 0.375 / asymptote(0.25),
        Edge::Clamped | Edge::SimplySupported => asymptote(-0.25) + 0.125 / asymptote(-0.25),
    }
}

/// Eigenfrequencies in Hz of a plate of `radius` m, `rigidity` N m, `mass_per_area` kg/m^2.
pub fn frequencies(
    edge: Edge,
    poisson_ratio: f64,
    radius: f64,
    rigidity: f64,
    mass_per_area: f64,
    count: usize,
) -> Vec<f64> {
    frequency_parameters(edge, poisson_ratio, count)
        .into_iter()
        .map(|k| (k / radius).powi(2) * (rigidity / mass_per_area).sqrt() / (2.0 * PI))
        .collect()
}

/// Deflection of the centre in the mass-normalised mode with parameter `k`, for unit radius and mass per area:
/// w(0) with the integral of w^2 2 pi r dr over 0..1 equal to one.
pub fn centre_deflection(edge: Edge, k: f64) -> f64 {
    deflection(edge, k, &[0.0])[0]
}

/// As [`centre_deflection`] at the `radii` in 0..=1, of the sign that makes the centre's positive; `k` up to 700.
pub fn deflection(edge: Edge, k: f64, radii: &[f64]) -> Vec<f64> {
    if k < PARABOLOID {
        let square = if edge == Edge::Free { 2.0 } else { 1.0 };
        return radii.iter().map(|r| (3.0 / PI).sqrt() * (1.0 - square * r * r)).collect();
    }
    let (j0, j1, ratio) = (libm::j0(k), libm::j1(k), bessel_i_ratio(k));
    // w = J0(k r) + g I0(k r)/I0(k); w(0) > 0
    let g = at_rim(edge, k);
    let norm = 0.5 * (j0 * j0 + j1 * j1) + g / k * (j1 + j0 * ratio) + 0.5 * g * g * (1.0 - ratio * ratio);
    let (scale, rim) = (1.0 / (2.0 * PI * norm).sqrt(), bessel_i0(k));
    radii.iter().map(|r| scale * (libm::j0(k * r) + g * bessel_i0(k * r) / rim)).collect()
}

/// Share of I0(k r) in the centre of the mode with parameter `k`, that of J0(k r) being one.
pub fn share_of_rim(edge: Edge, k: f64) -> f64 {
    at_rim(edge, k) / bessel_i0(k)
}

/// Share of I0(k r)/I0(k) in the mode with parameter `k`, that of J0(k r) being one.
fn at_rim(edge: Edge, k: f64) -> f64 {
    match edge {
        Edge::Free => -libm::j1(k) / bessel_i_ratio(k),
        Edge::Clamped | Edge::SimplySupported => -libm::j0(k),
    }
}

/// I0(x) by its power series.
pub(super) fn bessel_i0(x: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 1.0);
    for n in 1.. {
        term *= (0.5 * x / f64::from(n)).powi(2);
        sum += term;
        if term < 1e-17 * sum {
            break;
        }
    }
    sum
}

/// I1(x) / I0(x) by its continued fraction (Gauss), x > 0. Every level n reduces what the levels beyond it lack by the square of
/// I_n/I_(n-1), about exp(-2 n/x) for n below x: 7 sqrt(x) levels are enough for the last bit.
pub(super) fn bessel_i_ratio(x: f64) -> f64 {
    let terms = 30 + (7.0 * x.sqrt()) as usize;
    (1..=terms).rev().fold(0.0, |tail, n| 1.0 / (2.0 * n as f64 / x + tail))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn squares_of_the_frequency_parameters_of_leissa_1969() {
        let table: [(Edge, &[f64]); 3] = [
            (Edge::Clamped, &[10.2158, 39.7711, 89.1041, 158.1842]),
            (Edge::SimplySupported, &[4.9351, 29.7200, 74.1561]),
            (Edge::Free, &[9.0031, 38.4432, 87.7502]),
        ];
        for (edge, squares) in table {
            for (k, square) in frequency_parameters(edge, 0.3, squares.len()).iter().zip(squares) {
                assert_relative_eq!(k * k, square, max_relative = 1e-5);
            }
        }
    }

    /// Where elements lose the energy of a paraboloid in rounding: Rayleigh's quotient of 1 - r^2 and 1 - 2 r^2, whose
    /// bending energy is 2 pi (1 + nu) times 4 and 16, is exact.
    #[test]
    fn towards_poisson_ratio_minus_one_the_first_mode_is_a_paraboloid() {
        for rest in [1e-5, 1e-8, 1e-11, 1e-15] {
            let poisson_ratio = -1.0 + rest;
            for (edge, quotient) in [(Edge::SimplySupported, 24.0), (Edge::Free, 96.0)] {
                let k = frequency_parameters(edge, poisson_ratio, 2);
                assert_relative_eq!(k[0].powi(4), quotient * (1.0 + poisson_ratio), max_relative = 1e-5);
                assert_relative_eq!(centre_deflection(edge, k[0]), (3.0 / PI).sqrt(), max_relative = 1e-5);
                assert!(k[1] > 5.0);
            }
        }
    }

    #[test]
    fn waves_and_rim_are_the_deflection_down_to_a_paraboloid() {
        for edge in [Edge::Clamped, Edge::SimplySupported, Edge::Free] {
            let few = frequency_parameters(edge, 0.3, 3);
            // clamped plates never bend so
            let low = [5e-4, 0.009, 0.011, 1.3].into_iter().filter(|_| edge != Edge::Clamped);
            for k in few.into_iter().chain(low) {
                let c = share_of_rim(edge, k);
                for r in [0.1, 0.5, 0.9] {
                    let mode = (libm::j0(k * r) + c * bessel_i0(k * r)) / (1.0 + c);
                    let exact = deflection(edge, k, &[r])[0] / centre_deflection(edge, k);
                    assert_relative_eq!(mode, exact, max_relative = 1e-5, epsilon = 1e-8);
                }
            }
        }
    }

    #[test]
    fn ratio_of_bessel_functions_is_the_series_at_small_and_the_asymptote_at_large_arguments() {
        // I1 = I0'
        for x in [0.5, 5.0, 40.0, 300.0] {
            let step = 1e-5 * x;
            let slope = (bessel_i0(x + step) - bessel_i0(x - step)) / (2.0 * step);
            assert_relative_eq!(bessel_i_ratio(x), slope / bessel_i0(x), max_relative = 1e-4);
        }
        for x in [100.0_f64, 1000.0, 5000.0] {
            let asymptote = 1.0 - 0.5 / x - 0.125 / x.powi(2) - 0.125 / x.powi(3) - 25.0 / 128.0 / x.powi(4);
            assert_relative_eq!(bessel_i_ratio(x), asymptote, max_relative = 1e-10);
        }
    }
}
