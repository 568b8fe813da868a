//! The continuum bodies of model C: shared by the impacts of a series, from the cache, or meshed.

use crate::body::cache::Cache;
use crate::body::continuum::{ContinuumPlate, MeshOptions, UnitBodies, cached};
use crate::error::Result;
use crate::scene::{Material, Plate};

/// Where the bodies of model C come from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Continua<'a> {
    shared: Option<&'a UnitBodies>,
    cache: &'a Cache,
}

impl<'a> Continua<'a> {
    /// From `shared` as far as it has them, else each on a mesh of its own, through `cache`.
    pub(super) fn new(shared: Option<&'a UnitBodies>, cache: &'a Cache) -> Self {
        Self { shared, cache }
    }

    /// As [`ContinuumPlate::new`] on the default mesh.
    pub(super) fn plate(&self, plate: &Plate, patches: [f64; 2], modes: usize) -> Result<ContinuumPlate> {
        let shared = self.shared.map(|bodies| bodies.plate(plate, patches, modes)).transpose()?;
        let meshed = || cached::plate_in(self.cache, plate, patches, modes, &MeshOptions::default());
        shared.flatten().map_or_else(meshed, Ok)
    }

    /// As [`crate::body::continuum::sphere_residual`] on the default mesh.
    pub(super) fn sphere_residual(&self, radius: f64, material: &Material, patch: f64) -> Result<f64> {
        let shared = self.shared.map(|bodies| bodies.sphere_residual(radius, material, patch)).transpose()?;
        let mesh = MeshOptions::default();
        let meshed = || cached::sphere_residual_in(self.cache, radius, material, patch, &mesh);
        shared.flatten().map_or_else(meshed, Ok)
    }
}
