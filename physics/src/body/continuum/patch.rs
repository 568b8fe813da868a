//! Contact patch: loads and displacements weighted by Hertz's pressure.
//!
//! The unit pressure over a patch of radius a is 3/(2 pi a^2) sqrt(1 - (r/a)^2) (Johnson, Contact
//! Mechanics, 1985, section 3.4), here along z.

use super::basis::{Basis, gauss_legendre};
use super::mesh::Mesh;
use crate::scene::Material;
use std::f64::consts::FRAC_PI_2;

/// Flexibility in m/N of a half-space under the unit Hertz pressure over `patch_radius` in m, weighted by it.
///
/// The surface sinks by (1 - nu^2)/E 3/(8 a^3) (2 a^2 - r^2); the mean of r^2 under the pressure is 2/5 a^2.
pub fn half_space_flexibility(material: &Material, patch_radius: f64) -> f64 {
    0.6 / (material.plane_strain_modulus() * patch_radius)
}

/// The same along the surface, by a unit force along it that is spread as the Hertz pressure.
///
/// The surface moves by 3/(64 G a^3) (4 (2 - nu) a^2 - (4 - 3 nu) x^2 - (4 - nu) y^2) (Johnson, Contact Mechanics, 1985, eq. 3.91a).
pub fn half_space_flexibility_along(material: &Material, patch_radius: f64) -> f64 {
    0.15 * (2.0 - material.poisson_ratio) / (material.shear_modulus() * patch_radius)
}

/// Consistent nodal axial forces (node, N) of a unit force, +z, spread over a patch on the mesh's surface.
pub(super) fn nodal_forces(mesh: &Mesh, patch_radius: f64) -> Vec<(usize, f64)> {
    let basis = Basis::new(mesh.order);
    let rule = gauss_legendre(mesh.order + 8);
    let mut forces = Vec::new();
    for edge in &mesh.surface {
        let radii: Vec<f64> = edge.iter().map(|&node| mesh.nodes[node][0]).collect();
        let inner = radii[0];
        let outer = radii[mesh.order].min(patch_radius);
        if inner >= outer {
            break;
        }
        let mut nodal = vec![0.0; edge.len()];
        // With r = a sin(s) the integrand 3 N sin(s) cos(s)^2 is smooth up to the patch's edge.
        let (from, to) = ((inner / patch_radius).asin(), (outer / patch_radius).min(1.0).asin());
        debug_assert!(to <= FRAC_PI_2);
        for &(x, weight) in &rule {
            let s = 0.5 * ((1.0 - x) * from + (1.0 + x) * to);
            let value = 3.0 * s.sin() * s.cos().powi(2) * 0.5 * (to - from) * weight;
            let local = local_coordinate(&basis, &radii, patch_radius * s.sin());
            for (force, shape) in nodal.iter_mut().zip(basis.values(local)) {
                *force += value * shape;
            }
        }
        forces.extend(edge.iter().copied().zip(nodal));
    }
    forces
}

/// Nodal weights (node, weight) of the displacement of the mesh's surface at radius `r`.
pub(super) fn point(mesh: &Mesh, r: f64) -> Vec<(usize, f64)> {
    let basis = Basis::new(mesh.order);
    let reaches = |edge: &&Vec<usize>| mesh.nodes[edge[mesh.order]][0] >= r;
    let Some(edge) = mesh.surface.iter().find(reaches).or(mesh.surface.last()) else { return Vec::new() };
    let radii: Vec<f64> = edge.iter().map(|&node| mesh.nodes[node][0]).collect();
    let values = basis.values(local_coordinate(&basis, &radii, r));
    edge.iter().copied().zip(values).collect()
}

/// Local coordinate in [-1, 1] of the point at radius `r` on an element edge with the node radii `radii`.
fn local_coordinate(basis: &Basis, radii: &[f64], r: f64) -> f64 {
    let dot = |weights: Vec<f64>| weights.iter().zip(radii).map(|(w, r)| w * r).sum::<f64>();
    let (first, last) = (radii[0], radii[radii.len() - 1]);
    let mut x = 2.0 * (r - first) / (last - first) - 1.0;
    for _ in 0..20 {
        let step = (dot(basis.values(x)) - r) / dot(basis.derivatives(x));
        x -= step;
        if step.abs() < 1e-14 {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::super::mesh;
    use super::*;
    use approx::assert_relative_eq;

    /// Moments of the pressure: total 1, mean of r^2 = 2/5 a^2 (nodal values of r^2 are exact for order >= 2).
    fn check(mesh: &Mesh, patch_radius: f64, tolerance: f64) {
        let forces = nodal_forces(mesh, patch_radius);
        let total: f64 = forces.iter().map(|(_, f)| f).sum();
        let moment: f64 = forces.iter().map(|(node, f)| f * mesh.nodes[*node][0].powi(2)).sum();
        assert_relative_eq!(total, 1.0, max_relative = 1e-12);
        assert_relative_eq!(moment, 0.4 * patch_radius.powi(2), max_relative = tolerance);
    }

    #[test]
    fn unit_force_and_second_moment_also_when_the_patch_ends_inside_an_element() {
        let plate = mesh::plate(2, &[0.0, 0.3, 0.55, 1.0, 3.0], &[0.0, 0.4, 1.0]);
        for patch_radius in [0.1, 0.3, 0.7, 1.0, 2.9] {
            check(&plate, patch_radius, 1e-12);
        }
        let sphere = mesh::half_sphere(3, 2.0, 0.3, 0.05, 1.3, 0.5);
        check(&sphere, 0.3, 1e-6);
    }
}
