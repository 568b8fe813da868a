//! Free sphere as a continuum: what it gives way beyond its half-space.

use super::assembly::Matrices;
use super::lanczos::ShiftInvert;
use super::mesh;
use super::mirror::{HalfBody, Parity};
use super::patch::{half_space_flexibility, nodal_forces};
use super::{MeshOptions, check_patch};
use crate::error::Result;
use crate::numerics::vectors::dot;
use crate::scene::Material;
use std::rc::Rc;

/// Residual flexibility in m/N of a free sphere of `radius` m under a contact patch of `patch_radius` m.
///
/// Static flexibility under the contact force and the inertia forces of the rigid acceleration, displacement
/// relative to the mean of the sphere, without the half-space part. Negative: a small free sphere is a little stiffer
/// than its half-space. It depends weakly on the patch: the surface stress of Boussinesq's solution acts on the
/// sphere's slope and lifts the centre by (1 - 2 nu)^2 (1 + nu) / (2 pi E radius) per e-fold of the patch radius.
///
/// # Errors
/// [`crate::Error::Solver`] if the patch radius is not below half the sphere's radius or the numerics
/// fail, [`crate::Error::Usage`] for a mesh option out of bounds.
pub fn sphere_residual(
    radius: f64,
    material: &Material,
    patch_radius: f64,
    options: &MeshOptions,
) -> Result<f64> {
    options.check()?;
    check_patch(patch_radius, 0.5 * radius, "half the sphere's radius")?;
    let size = patch_radius / options.patch_elements;
    let largest = 0.5 * radius / options.thickness_elements;
    let mesh = mesh::half_sphere(options.order, radius, patch_radius, size, options.growth, largest);
    let matrices = Rc::new(Matrices::new(&mesh, material)?);
    let forces = nodal_forces(&mesh, patch_radius);
    let mut flexibility = 0.0;
    for parity in [Parity::Bending, Parity::Longitudinal] {
        let half = HalfBody::new(&mesh, &matrices, parity, |_| [false, false], true)?;
        let load = half.axial_load(&forces);
        let mut displacement = load.clone();
        half.solve(&mut displacement);
        flexibility += 0.5 * dot(&load, &displacement);
    }
    Ok(flexibility - half_space_flexibility(material, patch_radius))
}
