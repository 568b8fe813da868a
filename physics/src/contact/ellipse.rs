//! Hertz contact of surfaces with two different curvatures: the contact area is an ellipse.
//!
//! Source: Johnson, Contact Mechanics, 1985, section 4.2, eqs. 4.24 to 4.28. Force and approach go together as for a sphere of an effective
//! radius; the circle that belongs to it stands for the ellipse wherever only the size of the contact matters.

use crate::numerics::root::root_from;
use std::f64::consts::FRAC_PI_2;

/// Difference of the curvatures, relative, up to which the contact counts as circular: what that changes is of its square.
const CIRCULAR: f64 = 1e-5;
/// Between which the ratio of the ellipse's axes is looked for.
const SLIMMEST: f64 = 1e-6;
const ROUNDEST: f64 = 1.0 - 1e-6;

/// Complete elliptic integrals of the first and second kind, K and E, of the modulus k with k^2 = 1 - `complementary`^2, by the
/// arithmetic-geometric mean (Abramowitz and Stegun, section 17.6).
fn elliptic(complementary: f64) -> [f64; 2] {
    let (mut a, mut b) = (1.0, complementary);
    let mut sum = 0.5 * (1.0 - complementary * complementary);
    let mut power = 0.5;
    while (a - b).abs() > 1e-15 * a {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        power *= 2.0;
        sum += power * c * c;
    }
    let first = FRAC_PI_2 / a;
    [first, first * (1.0 - sum)]
}

/// A sphere on a half-space in place of two surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffectiveSphere {
    /// Its radius in m: force and approach go together as for the surfaces.
    pub radius: f64,
    /// Area of its contact circle over that of the ellipse; the ellipse's pressure is as many times higher.
    pub area: f64,
}

/// The sphere that a half-space meets with the same force at the same approach as surfaces with the principal `curvatures` of their gap
/// (1/m, the sums of those of both bodies); `None` where they are not both positive: the surfaces meet elsewhere or all over.
pub fn effective_sphere(curvatures: [f64; 2]) -> Option<EffectiveSphere> {
    if !curvatures.iter().all(|curvature| *curvature > 0.0 && curvature.is_finite()) {
        return None;
    }
    let [low, high] = [curvatures[0].min(curvatures[1]), curvatures[0].max(curvatures[1])];
    let mean = 1.0 / (low * high).sqrt();
    if high < low * (1.0 + CIRCULAR) {
        return Some(EffectiveSphere { radius: mean, area: 1.0 });
    }
    // eq. 4.25: the ratio of curvatures by that of the axes, b/a
    let excess = |logarithm: f64| {
        let axes = logarithm.exp();
        let [first, second] = elliptic(axes);
        ((second / (axes * axes) - first) / (first - second)).ln() - (high / low).ln()
    };
    let near = (low / high).ln() * 2.0 / 3.0;
    let axes = root_from(excess, near, [SLIMMEST.ln(), ROUNDEST.ln()])?.exp();
    let [first, second] = elliptic(axes);
    let long = second / (axes * axes) - first;
    // eqs. 4.26 to 4.28; F1^3 = 4/(pi e^2) (b/a)^(3/2) ((a/b)^2 E - K)^(1/2) (K - E)^(1/2)
    let cube = 4.0 / (std::f64::consts::PI * (1.0 - axes * axes))
        * axes.powf(1.5)
        * (long * (first - second)).sqrt();
    let approach = first / FRAC_PI_2 * axes.sqrt() / cube.cbrt();
    Some(EffectiveSphere { radius: mean / approach.powi(3), area: (cube.cbrt() * approach).powi(-2) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Displacement at (x, y) in units of 1/E* under the pressure sqrt(1 - x^2/a^2 - y^2/b^2), by polar coordinates about the point
    /// (Boussinesq, Johnson eq. 3.16).
    fn displacement([a, b]: [f64; 2], [x, y]: [f64; 2]) -> f64 {
        let turns = 720;
        let sum: f64 = (0..turns)
            .map(|k| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(turns)).sin_cos();
                // 1 - (x + s cos)^2/a^2 - (y + s sin)^2/b^2 = c - 2 m s - n s^2, from s = 0 to its root
                let n = (cos / a).powi(2) + (sin / b).powi(2);
                let m = x * cos / (a * a) + y * sin / (b * b);
                let c = 1.0 - (x / a).powi(2) - (y / b).powi(2);
                let width = (m * m + n * c) / n;
                // integral of sqrt(width - n t^2) with t = s + m/n
                let from = m / n.sqrt() / width.sqrt();
                0.5 * width / n.sqrt()
                    * (FRAC_PI_2 - from.asin() - from * (1.0 - from * from).max(0.0).sqrt())
            })
            .sum();
        sum * 2.0 / f64::from(turns)
    }

    /// The surfaces touch inside: an ellipsoidal pressure moves them by delta - A x^2 - B y^2, with which the effective radius agrees.
    #[test]
    fn force_and_approach_are_those_of_boussinesqs_integrals() {
        for axes in [[1.0, 1.0], [1.0, 0.8], [1.0, 0.4], [1.0, 0.15]] {
            let centre = displacement(axes, [0.0; 2]);
            let curvature =
                |at: [f64; 2], distance: f64| 2.0 * (centre - displacement(axes, at)) / distance.powi(2);
            let [x, y] = [0.5 * axes[0], 0.5 * axes[1]];
            let curvatures = [curvature([x, 0.0], x), curvature([0.0, y], y)];
            let force = 2.0 / 3.0 * std::f64::consts::PI * axes[0] * axes[1];
            // F = 4/3 E* R^(1/2) delta^(3/2)
            let expected = (0.75 * force).powi(2) / centre.powi(3);
            let sphere = effective_sphere(curvatures).unwrap();
            assert_relative_eq!(sphere.radius, expected, max_relative = 2e-5);
            assert_relative_eq!(sphere.area, expected * centre / (axes[0] * axes[1]), max_relative = 2e-5);
        }
    }

    #[test]
    fn a_sphere_in_a_narrower_groove_has_no_contact() {
        assert_eq!(effective_sphere([-10.0, 200.0]), None);
        assert_eq!(effective_sphere([0.0, 200.0]), None);
        assert_eq!(effective_sphere([f64::NAN, 200.0]), None);
        assert_relative_eq!(effective_sphere([200.0, 200.0]).unwrap().radius, 5e-3, max_relative = 1e-12);
    }
}
