//! What the impacts of a series share, so that only the first of them pays for its bodies.

use super::PlateImpact;
use super::assembled::{join, kirchhoff_system};
use super::continua::Continua;
use super::predictor::Predictor;
use super::reduced::Reduced;
use crate::body::cache::Cache;
use crate::body::continuum::{MeshOptions, ModesAlong, UnitBodies, Varied, cached};
use crate::body::kirchhoff::UnitPlates;
use crate::body::memo::MemoList;
use crate::error::Result;
use crate::kinds::{Series, SeriesModel};
use crate::scene::DEFAULT_MODES;
use crate::scene::{Model, Plate, Scene};

/// Modes of the plate in a rough first look: it errs by as much with twice as many.
const ROUGH_MODES: usize = 8;

/// Eigenproblems that are not solved again, and, where shapes recur, bodies that are not meshed again.
#[derive(Debug)]
pub struct SharedBodies {
    pub(super) kirchhoff: UnitPlates,
    continuum: Option<UnitBodies>,
    /// Plates that friction moved along their faces.
    along: MemoList<(Plate, ModesAlong)>,
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
    /// For a series of so many `impacts` like `setup` in which the numbers of fields vary within the ranges `varied`: plates and spheres
    /// of model C are scaled from those of their shape (edge, thickness over radius, Poisson's ratio), and where many impacts vary that
    /// too, these lie between the shapes of a few.
    ///
    /// That is as near to the converged bodies as a mesh for every impact is, and within 3e-4 of it in the forces
    /// (guide, scenes).
    pub fn for_varied<'a>(
        varied: impl IntoIterator<Item = (&'a str, [f64; 2])>,
        setup: &PlateImpact,
        impacts: usize,
    ) -> Self {
        let varied: Vec<(&str, [f64; 2])> = varied.into_iter().collect();
        let range = |name: &str| varied.iter().find(|(field, _)| *field == name).map(|(_, range)| *range);
        let Plate { thickness, radius, material, .. } = &setup.plate;
        let ranges = [range("plate.thickness"), range("plate.radius")];
        let [t, r] = [ranges[0].unwrap_or([*thickness; 2]), ranges[1].unwrap_or([*radius; 2])];
        let poisson_ratio = varied.iter().filter_map(|(field, range)| {
            let material = field.strip_prefix("materials.")?.strip_suffix(".poisson_ratio")?;
            Some((material.to_owned(), *range))
        });
        let shapes = Varied {
            thickness: (ranges != [None; 2]).then(|| [t[0] / r[1], t[1] / r[0]]),
            poisson_ratio: poisson_ratio.collect(),
        };
        let continuum = shapes.pays(impacts, material).then(|| UnitBodies::new(shapes));
        Self { continuum, ..Self::default() }
    }

    /// Every continuum on a mesh of its own, through `cache`.
    pub(super) fn meshed(cache: Cache) -> Self {
        let (kirchhoff, along) = (UnitPlates::default(), MemoList::default());
        Self { continuum: None, kirchhoff, along, cache }
    }

    /// A first look at the impact of `setup`; where bodies are scaled it may be a rough one.
    pub(super) fn predictor(&self, setup: &PlateImpact) -> Result<Predictor> {
        if self.continuum.is_none() {
            return Predictor::of(&kirchhoff_system(setup, DEFAULT_MODES, &self.kirchhoff)?);
        }
        let with = |modes| join(setup, self.kirchhoff.initial_modes(&setup.plate, modes)?, [0.0; 2]);
        match Predictor::rough(&with(ROUGH_MODES)?) {
            Some(predictor) => Ok(predictor),
            None => Predictor::of(&with(DEFAULT_MODES)?),
        }
    }

    /// As [`ModesAlong::new`] on the default mesh, for model C.
    pub(super) fn modes_along(&self, plate: &Plate) -> Result<ModesAlong> {
        let make = || cached::modes_along_in(&self.cache, plate, &MeshOptions::default());
        let found = self.along.find_or(|(of, _)| of == plate, || Ok((plate.clone(), make()?)))?;
        Ok(found.1.clone())
    }

    /// The bodies of model C.
    pub(super) fn continua(&self) -> Continua<'_> {
        Continua::new(self.continuum.as_ref(), &self.cache)
    }
}

impl Series for SharedBodies {
    fn model(&self, scene: Scene, model: Model, modes: Option<usize>) -> Result<Box<dyn SeriesModel>> {
        Ok(Box::new(Reduced::in_series(scene, model, modes, self)?))
    }
}
