//! Elastic bodies of revolution as a continuum: modes and residual flexibility of model C.
//!
//! Linear elasticity on structured, graded quadrilateral meshes of the meridian section, with
//! elements of any polynomial order, independent of the finite-element reference. A contact is a Hertz
//! pressure over a patch of radius a: loads and displacements are weighted with it. The flexibility
//! that the kept modes lack stays as a static residual, without the half-space part that
//! Hertz's law already has.

mod along;
mod assembly;
mod basis;
pub mod cached;
mod element;
mod family;
mod grading;
pub(super) mod lanczos;
mod mesh;
pub(super) mod mirror;
mod patch;
mod plate;
mod shared;
mod sphere;
mod unit;

pub use along::ModesAlong;
pub use patch::{half_space_flexibility, half_space_flexibility_along};
pub use plate::{ContinuumPlate, PlateMode, WEIGHTED, eigenfrequencies, face_shapes, plate};
pub use shared::{UnitBodies, Varied};
pub use sphere::sphere_residual;

use crate::error::{Error, Result};

/// How finely a body is meshed; the defaults give Table 1's impacts within 0.02 %.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct MeshOptions {
    /// Polynomial order of the elements in both directions, 1 to 8.
    pub order: usize,
    /// Elements over the (smaller) patch radius.
    pub patch_elements: f64,
    /// Size ratio of adjacent elements away from the patch, above 1, at most 3.
    pub growth: f64,
    /// The same of a plate's elements away from its faces.
    pub depth_growth: f64,
    /// Nodes per wavelength of the highest mode wanted, at least.
    pub nodes_per_wavelength: f64,
    /// Elements over half the plate's thickness, at least.
    pub thickness_elements: f64,
}

impl Default for MeshOptions {
    fn default() -> Self {
        Self {
            order: 3,
            patch_elements: 3.0,
            growth: 1.6,
            depth_growth: 1.6,
            nodes_per_wavelength: 10.0,
            thickness_elements: 1.0,
        }
    }
}

impl MeshOptions {
    /// The same mesh with all elements smaller by `factor`.
    pub fn refined(self, factor: f64) -> Self {
        Self {
            patch_elements: self.patch_elements * factor,
            growth: self.growth.powf(1.0 / factor),
            depth_growth: self.depth_growth.powf(1.0 / factor),
            nodes_per_wavelength: self.nodes_per_wavelength * factor,
            thickness_elements: self.thickness_elements * factor,
            ..self
        }
    }

    fn check(&self) -> Result<()> {
        let bounds = [
            ("order", self.order as f64, 1.0, 8.0),
            ("patch_elements", self.patch_elements, 0.5, 1e3),
            ("growth", self.growth, 1.0 + 1e-3, 3.0),
            ("depth_growth", self.depth_growth, 1.0 + 1e-3, 3.0),
            ("nodes_per_wavelength", self.nodes_per_wavelength, 2.0, 1e3),
            ("thickness_elements", self.thickness_elements, 0.5, 1e3),
        ];
        for (field, value, low, high) in bounds {
            if !(low..=high).contains(&value) {
                return Err(Error::Usage(format!(
                    "mesh option {field} = {value} is outside {low} to {high}"
                )));
            }
        }
        Ok(())
    }
}

fn check_patch(patch_radius: f64, bound: f64, bound_name: &str) -> Result<()> {
    if patch_radius > 0.0 && patch_radius < bound {
        return Ok(());
    }
    Err(Error::Solver(format!(
        "contact patch radius {patch_radius:e} m must be positive and below {bound_name}, {bound:e} m"
    )))
}
