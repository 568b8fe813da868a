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

use crate::scene::{Inner, Material, Outer, Shape};
use std::f64::consts::PI;

/// Terms of the series in radii of the sphere per radius of the patch: what follows is a half-space's.
const TERMS: f64 = 12.0;

/// Patch over the sphere's radius below which the series is not summed any more.
const SMALL: f64 = 0.03;
/// What the series misses of a patch that is not small, since the sphere is not flat under it: powers of Poisson's ratio along the
/// rows, of patch over radius along the columns. Fitted to finite elements at 0.07 to 0.45, within 0.6 % of the half-space's.
const CURVED: [[f64; 2]; 5] =
    [[0.0089, 0.1086], [0.5334, -0.3882], [-0.1959, -0.3957], [-0.4107, 0.7942], [0.2962, 0.2834]];

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
    let patch = patch_radius.max(SMALL * radius);
    let share = patch_radius / radius;
    // U_n times 2 mu
    let compliance = |n: f64| match n {
        0.0 => (1.0 - 2.0 * nu) / (1.0 + nu),
        1.0 => 0.6 * (1.0 - 2.0 * nu) / (1.0 + nu),
        _ => {
            (2.0 * (1.0 - nu) * n * n + nu * n - 1.0 + 2.0 * nu)
                / ((n - 1.0) * (n * n + n + 1.0 + nu * (2.0 * n + 1.0)))
        }
    };
    let terms = (TERMS * radius / patch).max(40.0) as u32;
    let term = |n: f64| {
        let weight = patch_transform((n + 0.5) * patch / radius);
        weight * weight * ((2.0 * n + 1.0) * compliance(n) - 4.0 * (1.0 - nu))
    };
    let series = (0..terms).map(|n| term(f64::from(n))).sum::<f64>() / (8.0 * PI * shear * radius);
    let unit = 1.0 / (material.youngs_modulus * radius);
    let slope = (1.0 - 2.0 * nu) * (1.0 + nu) / (2.0 * PI) * unit;
    // the terms go as the logarithm of a patch that is small
    let logarithm = (1.0 + nu) * (1.0 - 2.0 * nu).powi(2) / (2.0 * PI) * unit;
    let curved = CURVED.iter().rev().fold(0.0, |sum, [first, second]| sum * nu + first + second * share);
    series - slope - logarithm * (patch_radius / patch).ln() + curved * share * unit
}

/// Residual flexibility in m/N of outer and inner body under patches of the radii `patch` in m: spheres are free, compact bodies and the
/// tips of benders and stacks rigid but for their Hertz contact.
pub fn tip_residuals(outer: &Outer, inner: &Inner, patch: [f64; 2]) -> [f64; 2] {
    let tip = |shape: &Shape, material: &Material, patch: f64| match *shape {
        Shape::Sphere { radius } => sphere_residual(radius, material, patch),
        Shape::Compact { .. } | Shape::Bender(_) | Shape::Stack(_) => 0.0,
    };
    [tip(&outer.shape, &outer.material, patch[0]), tip(&inner.shape, &inner.material, patch[1])]
}
