//! What the impacts of a series share, so that only the first of them pays for its bodies.

use super::predictor::Predictor;
use crate::body::cache::Cache;
use crate::body::continuum::{ContinuumPlate, MeshOptions, UnitBodies, cached};
use crate::body::kirchhoff::UnitPlates;
use crate::dynamics::system::System;
use crate::error::Result;
use crate::scene::{Material, Plate};

/// Eigenproblems that are not solved again, and, where shapes recur, bodies that are not meshed again.
#[derive(Debug)]
pub struct SharedBodies {
    pub(super) kirchhoff: UnitPlates,
    continuum: Option<UnitBodies>,
    /// Of bodies that are not shared.
    cache: Cache,
}

impl Default for SharedBodies {
    /// For an impact alone.
    fn default() -> Self {
        Self::meshed(Cache::from_environment())
    }
}

impl SharedBodies {
    /// For a series in which the numbers of `fields` vary: plates and spheres of model C are scaled from those of their shape (edge,
    /// thickness over radius, Poisson's ratio), unless it varies.
    ///
    /// That is as near to the converged bodies as a mesh for every impact is, and within 3e-4 of it in the forces
    /// (guide, scenes).
    pub fn for_varied<'a>(mut fields: impl Iterator<Item = &'a str>) -> Self {
        let shape = |field: &str| {
            ["plate.radius", "plate.thickness"].contains(&field) || field.ends_with(".poisson_ratio")
        };
        Self { continuum: (!fields.any(shape)).then(UnitBodies::default), ..Self::default() }
    }

    /// Every continuum on a mesh of its own, through `cache`.
    pub(super) fn meshed(cache: Cache) -> Self {
        Self { continuum: None, kirchhoff: UnitPlates::default(), cache }
    }

    /// A first look at the impact of `system`; where bodies are scaled it may be a rough one.
    pub(super) fn predictor(&self, system: &System) -> Result<Predictor> {
        if self.continuum.is_some() { Predictor::rough(system) } else { Predictor::of(system) }
    }

    /// The bodies of model C.
    pub(super) fn continua(&self) -> Continua<'_> {
        Continua { shared: self.continuum.as_ref(), cache: &self.cache }
    }
}

/// Where the bodies of model C come from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Continua<'a> {
    shared: Option<&'a UnitBodies>,
    cache: &'a Cache,
}

impl<'a> Continua<'a> {
    /// Each on a mesh of its own, through `cache`.
    pub(super) fn meshed(cache: &'a Cache) -> Self {
        Self { shared: None, cache }
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
