//! What the launches of a series share: one mesh that follows the seat's dimensions, and the bodies made of it.

use super::SealSeat;
use super::body::{SeatBody, SeatMesh};
use super::candidates::Zones;
use super::model::SeatModel;
use super::shape;
use crate::body::cache::Cache;
use crate::body::memo::MemoList;
use crate::body::solid::TetMesh;
use crate::error::Result;
use crate::kinds::{Series, SeriesModel};
use crate::scene::{Material, Model, Scene};
use std::sync::Arc;

/// Bodies of the seats near a first one, on its mesh. A launch at another speed, or with other masses, finds its body made.
#[derive(Debug)]
pub struct SeatSeries {
    first: SealSeat,
    mesh: SeatMesh,
    nodes: Arc<TetMesh>,
    made: MemoList<Made>,
}

/// A seat's body.
#[derive(Debug)]
struct Made {
    /// [`SealSeat::geometry_hash`].
    geometry: String,
    material: Material,
    zones: Zones,
    modes: usize,
    mesh: SeatMesh,
    body: Arc<SeatBody>,
}

impl SeatSeries {
    /// Of seats like that of `scene`, of which `mesh` is one.
    ///
    /// # Errors
    /// [`crate::Error::Scene`] for another kind of scene, [`crate::Error::Solver`] if the mesh is unusable.
    pub fn new(scene: &Scene, mesh: &SeatMesh) -> Result<Self> {
        let first = scene.seal_seat()?.clone();
        Ok(Self { nodes: mesh.read()?, first, mesh: mesh.clone(), made: MemoList::default() })
    }

    /// `model` of `scene` on the mesh as it follows its dimensions.
    ///
    /// # Errors
    /// As [`SeatModel::new`], and if the mesh can't follow so far.
    pub fn model(&self, scene: &Scene, model: Model, modes: Option<usize>) -> Result<SeatModel> {
        let setup = scene.seal_seat()?;
        let mesh = self.mesh_of(setup)?;
        let zones = Zones::expected(setup).of_series();
        let build = &mut |zones: &Zones, modes: usize| self.body(setup, &mesh, &zones.of_series(), modes);
        SeatModel::in_zones(scene, (model, modes), &mesh, zones, build)
    }

    /// The mesh of the seat of `setup`.
    fn mesh_of(&self, setup: &SealSeat) -> Result<SeatMesh> {
        let geometry = setup.geometry_hash();
        if geometry == self.first.geometry_hash() {
            return Ok(self.mesh.clone());
        }
        if let Some(made) = self.made.all().iter().find(|made| made.geometry == geometry) {
            return Ok(made.mesh.clone());
        }
        Ok(self.mesh.moved_to(shape::moved(&self.nodes, &self.first, setup)?, setup))
    }

    fn body(&self, setup: &SealSeat, mesh: &SeatMesh, zones: &Zones, modes: usize) -> Result<Arc<SeatBody>> {
        let (geometry, material) = (setup.geometry_hash(), setup.seat.material.clone());
        let fits = |made: &Made| {
            (made.zones, made.modes) == (*zones, modes)
                && (&made.material, &made.geometry) == (&material, &geometry)
        };
        let make = || {
            let body = Arc::new(mesh.body(setup, zones, modes, &Cache::off())?);
            let (geometry, material) = (geometry.clone(), material.clone());
            Ok(Made { geometry, material, zones: *zones, modes, mesh: mesh.clone(), body })
        };
        Ok(Arc::clone(&self.made.find_or(fits, make)?.body))
    }
}

impl Series for SeatSeries {
    fn is_expensive(&self) -> bool {
        true
    }

    fn model(&self, scene: Scene, model: Model, modes: Option<usize>) -> Result<Box<dyn SeriesModel>> {
        Ok(Box::new(SeatSeries::model(self, &scene, model, modes)?))
    }
}
