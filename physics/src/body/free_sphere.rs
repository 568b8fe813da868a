//! Free elastic sphere pressed at one point: what it yields beyond a half-space, in closed form.
//!
//! Under the pressure sum_n p_n P_n(cos theta) on the surface of a sphere of radius r, free of shear, the surface moves
//! inwards by sum_n r U_n p_n P_n (from the solutions of A. I. Lur'e, Three-Dimensional Problems of the Theory of
//! Elasticity, 1964, chapter 8), with mu the shear modulus
//!
//!   U_n = (2 (1 - nu) n^2 + nu n - 1 + 2 nu) / (2 mu (n - 1) (n^2 + n + 1 + nu (2 n + 1))),  n = 0, 2, 3, ...
//!   U_1 = 3 (1 - 2 nu) / (10 mu (1 + nu)),
//!
//! the latter with the inertia of the rigid acceleration in the sphere and relative to its mean. The unit Hertz pressure over
//! a patch of radius a has p_n = (2 n + 1)/(4 pi r^2) W((n + 1/2) a/r). A half-space has r U = (1 - nu)/(mu xi) with
//! xi = (n + 1/2)/r.
//!
//! A contact's force is along the axis: on the slope of the sphere it has a part along the surface, and so has the
//! displacement in its direction. In a half-space that lifts the centre by (1 - 2 nu)(1 + nu)/(2 pi E r).

use crate::scene::Material;
use std::f64::consts::PI;

/// Terms of the series in radii of the sphere per radius of the patch: what follows is a half-space's.
const TERMS: f64 = 12.0;

/// Hankel transform of the unit Hertz pressure over a patch of radius a, x = xi a: 3 (sin x - x cos x)/x^3.
pub(super) fn patch_transform(x: f64) -> f64 {
    if x < 0.1 {
        let s = x * x;
        return 1.0 - s / 10.0 * (1.0 - s / 28.0 * (1.0 - s / 54.0));
    }
    3.0 * (x.sin() - x * x.cos()) / (x * x * x)
}

/// Residual flexibility in m/N of a free sphere of `radius` m under a contact patch of `patch_radius` m; what
/// [`super::continuum::sphere_residual`] finds by finite elements.
pub fn sphere_residual(radius: f64, material: &Material, patch_radius: f64) -> f64 {
    let nu = material.poisson_ratio;
    let shear = material.youngs_modulus / (2.0 * (1.0 + nu));
    // U_n times 2 mu
    let yielded = |n: f64| match n {
        0.0 => (1.0 - 2.0 * nu) / (1.0 + nu),
        1.0 => 0.6 * (1.0 - 2.0 * nu) / (1.0 + nu),
        _ => {
            (2.0 * (1.0 - nu) * n * n + nu * n - 1.0 + 2.0 * nu)
                / ((n - 1.0) * (n * n + n + 1.0 + nu * (2.0 * n + 1.0)))
        }
    };
    let terms = (TERMS * radius / patch_radius).max(40.0) as u32;
    let term = |n: f64| {
        let weight = patch_transform((n + 0.5) * patch_radius / radius);
        weight * weight * ((2.0 * n + 1.0) * yielded(n) - 4.0 * (1.0 - nu))
    };
    let series = (0..terms).map(|n| term(f64::from(n))).sum::<f64>() / (8.0 * PI * shear * radius);
    let slope = (1.0 - 2.0 * nu) * (1.0 + nu) / (2.0 * PI * material.youngs_modulus * radius);
    series - slope
}
