//! Residual flexibility of a free elastic sphere.
//!
//! Goal: what a free sphere gives way under a Hertz patch beyond its half-space.
//! Check: exact solution by solid harmonics (Love, Mathematical Theory of Elasticity, sections 172-173;
//! degree 1 with the inertia forces of the rigid acceleration), summed to degree 2500.

use crate::continuum_support::material;
use approx::assert_relative_eq;
use impactcheck::body::continuum::{MeshOptions, half_space_flexibility, sphere_residual};
use std::f64::consts::{FRAC_PI_2, PI};

/// Residual flexibility of the sphere of radius 1 m and modulus 1 Pa, by series.
///
/// Displacement and traction of degree n: (U P_n, V dP_n/dtheta) and (T P_n, S dP_n/dtheta).
fn exact_residual(nu: f64, patch: f64) -> f64 {
    let mu = 0.5 / (1.0 + nu);
    let lambda = nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    const DEGREES: usize = 2500;
    let (mut traction_r, mut traction_t) = (vec![0.0; DEGREES], vec![0.0; DEGREES]);
    // Unit Hertz force along the axis: dF = 3 sin(s) cos(s)^2 ds at the radius a sin(s); midpoint rule, which is
    // of high order here because the integrand is smooth and even at both ends.
    let points = 2500;
    for i in 0..points {
        let s = (i as f64 + 0.5) / points as f64 * FRAC_PI_2;
        let force = 3.0 * s.sin() * s.cos().powi(2) * FRAC_PI_2 / points as f64;
        let sine = patch * s.sin();
        let cosine = (1.0 - sine * sine).sqrt();
        let (mut p_before, mut p) = (0.0, 1.0);
        for n in 0..DEGREES {
            let nf = n as f64;
            // dP_n/dtheta = n (cos P_n - P_(n-1)) / sin
            let dp = nf * (cosine * p - p_before) / sine;
            let density = force / (2.0 * PI) * (2.0 * nf + 1.0) / 2.0;
            traction_r[n] += density * cosine * p;
            if n > 0 {
                traction_t[n] -= density * sine * dp / (nf * (nf + 1.0));
            }
            (p_before, p) = (p, ((2.0 * nf + 1.0) * cosine * p - nf * p_before) / (nf + 1.0));
        }
    }
    let mut flexibility = 0.0;
    for n in 0..DEGREES {
        let nf = n as f64;
        let (t, s) = (traction_r[n], traction_t[n]);
        let (u, v) = match n {
            0 => (t / (3.0 * lambda + 2.0 * mu), 0.0),
            1 => {
                // u = beta r^2 e_z + gamma x z balances the body force -3/(4 pi) e_z and the shear traction.
                // lambda, mu: (l + m)(2b + 4g) + m (6b + 2g) = 3/(4 pi), m (2b + g) = s.
                let (a11, a12) = (2.0 * (lambda + mu) + 6.0 * mu, 4.0 * (lambda + mu) + 2.0 * mu);
                let rhs = [3.0 / (4.0 * PI), s / mu];
                let gamma = (rhs[0] - a11 * 0.5 * rhs[1]) / (a12 - 0.5 * a11);
                let beta = 0.5 * (rhs[1] - gamma);
                // The normal traction then follows from equilibrium: a check of the solution.
                let normal = lambda * (2.0 * beta + 4.0 * gamma) + 4.0 * mu * (beta + gamma);
                assert_relative_eq!(normal, t, max_relative = 1e-6);
                let mean = (3.0 * beta + gamma) / 5.0;
                (beta + gamma - mean, beta - mean)
            }
            _ => {
                let alpha =
                    -2.0 * (nf * lambda + (3.0 * nf + 1.0) * mu) / ((nf + 3.0) * lambda + (nf + 5.0) * mu);
                // u = c grad(r^n P_n) + d (r^2 grad(r^n P_n) + alpha x r^n P_n)
                let normal = [
                    2.0 * mu * nf * (nf - 1.0),
                    lambda * (2.0 * nf + alpha * (nf + 3.0)) + 2.0 * mu * (nf + alpha) * (nf + 1.0),
                ];
                let shear = [2.0 * mu * (nf - 1.0), mu * (2.0 * nf + alpha)];
                let determinant = normal[0] * shear[1] - normal[1] * shear[0];
                let c = (t * shear[1] - normal[1] * s) / determinant;
                let d = (normal[0] * s - t * shear[0]) / determinant;
                (c * nf + d * (nf + alpha), c + d)
            }
        };
        flexibility += 4.0 * PI / (2.0 * nf + 1.0) * (t * u + nf * (nf + 1.0) * s * v);
    }
    flexibility - half_space_flexibility(&material(1.0, nu, 1.0), patch)
}

#[test]
fn free_sphere_agrees_with_the_exact_series_of_love() {
    for nu in [0.0, 0.3, 0.45] {
        for patch in [0.03, 0.06, 0.12] {
            let (radius, modulus) = (6.35e-3, 210e9);
            let sphere = material(modulus, nu, 7780.0);
            let half_space = 0.6 * (1.0 - nu * nu) / patch;
            let exact = exact_residual(nu, patch);
            let fine = MeshOptions { order: 4, ..MeshOptions::default().refined(1.5) };
            // Bounds relative to the half-space's flexibility, which is what Hertz's law adds.
            for (options, bound) in [(MeshOptions::default(), 5e-4), (fine, 5e-5)] {
                let residual =
                    sphere_residual(radius, &sphere, patch * radius, &options).unwrap() * (modulus * radius);
                let error = (residual - exact) / half_space;
                println!("nu {nu} a/r {patch}: {residual:.5}, exact {exact:.5}, error {error:.1e}");
                assert!(error.abs() < bound, "nu {nu} a/r {patch}: {residual} {exact}");
            }
        }
    }
}

#[test]
fn a_steel_sphere_is_stiffer_than_its_half_space_by_0_4_over_e_r() {
    let residual = sphere_residual(1.0, &material(1.0, 0.3, 1.0), 0.06, &MeshOptions::default()).unwrap();
    assert_relative_eq!(residual, -0.40, max_relative = 0.02);
}

#[test]
fn the_residual_falls_with_the_logarithm_of_the_patch_radius() {
    // Boussinesq's surface stress (1 - 2 nu) F / (2 pi r^2) on the sphere's slope r / radius is a shear traction,
    // which lifts the centre by (1 - 2 nu)^2 (1 + nu) / (2 pi E radius) per e-fold of the patch radius.
    let fine = MeshOptions { order: 4, ..MeshOptions::default().refined(1.5) };
    for nu in [0.1, 0.3] {
        let sphere = material(1.0, nu, 1.0);
        let residual = |patch| sphere_residual(1.0, &sphere, patch, &fine).unwrap();
        let slope = (residual(0.01) - residual(0.0025)) / 4.0f64.ln();
        let expected = -(1.0 - 2.0 * nu).powi(2) * (1.0 + nu) / (2.0 * PI);
        println!("nu {nu}: {slope} {expected}");
        assert_relative_eq!(slope, expected, max_relative = 0.05);
    }
}

#[test]
fn a_patch_as_large_as_the_sphere_is_refused() {
    let error = sphere_residual(1.0, &material(1.0, 0.3, 1.0), 0.6, &MeshOptions::default());
    assert!(error.unwrap_err().to_string().contains("6e-1 m"));
}
