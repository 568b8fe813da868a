//! Impacts one after another, of any kind of scene: what they share, and a model of each.

use super::plate_impact::reduced::Reduced;
use super::plate_impact::shared::SharedBodies;
use super::seal_seat::{SeatMesh, SeatModel, SeatSeries};
use crate::error::{Error, Result};
use crate::result::{Outcome, Point, Summary, Table};
use crate::scene::{Model, Scene};

/// What the impacts of a series share.
#[derive(Debug)]
pub enum Series {
    /// Impacts through plates.
    Plates(Box<SharedBodies>),
    /// Launches from seats, on one mesh that follows their dimensions.
    Seats(Box<SeatSeries>),
}

/// A reduced model of one impact of a series.
#[derive(Debug)]
pub enum SeriesModel {
    /// Of an impact through a plate.
    Plate(Box<Reduced>),
    /// Of a launch from a seat.
    Seat(Box<SeatModel>),
}

impl Series {
    /// Of about so many `impacts` of scenes like `scene` in which the numbers of fields vary within the ranges `varied`; a seal seat has a
    /// `mesh`.
    ///
    /// # Errors
    /// [`Error::Internal`] if a seal seat has none, [`Error::Solver`] if it is unusable.
    pub fn new<'a>(
        varied: impl IntoIterator<Item = (&'a str, [f64; 2])>,
        scene: &Scene,
        mesh: Option<&SeatMesh>,
        impacts: usize,
    ) -> Result<Self> {
        if let Ok(setup) = scene.plate_impact() {
            return Ok(Self::Plates(Box::new(SharedBodies::for_varied(varied, setup, impacts))));
        }
        let mesh = mesh.ok_or_else(|| Error::Internal("a series of seal seats has a mesh".into()))?;
        Ok(Self::Seats(Box::new(SeatSeries::new(scene, mesh)?)))
    }

    /// Whether an impact takes tenths of a second, for a mesh is factorised, rather than a tenth of a millisecond.
    pub fn is_dear(&self) -> bool {
        matches!(self, Self::Seats(_))
    }

    /// `model` of `scene` with so many `modes`, its own or the scene's number if it is `None`.
    ///
    /// # Errors
    /// As [`Reduced::new`] and [`SeatSeries::model`]; [`Error::Usage`] for a model that seal seats have not.
    pub fn model(&self, scene: Scene, model: Model, modes: Option<usize>) -> Result<SeriesModel> {
        match self {
            Self::Plates(bodies) => {
                Ok(SeriesModel::Plate(Box::new(Reduced::in_series(scene, model, modes, bodies)?)))
            }
            Self::Seats(series) => Ok(SeriesModel::Seat(Box::new(series.model(&scene, model, modes)?))),
        }
    }
}

impl SeriesModel {
    /// The results alone; `tolerance` bounds the error of the time integration in all of them.
    ///
    /// # Errors
    /// As [`Reduced::all_within`] and [`SeatModel::point`].
    pub fn point(&self, tolerance: f64) -> Result<Point<Table>> {
        match self {
            Self::Plate(model) => model.all_within(tolerance).map(|point| point.map(|found| found.table())),
            Self::Seat(model) => model.point(tolerance).map(|point| point.map(|found| found.table())),
        }
    }

    /// As [`SeriesModel::point`], judged.
    ///
    /// # Errors
    /// As [`Reduced::run`] and [`SeatModel::run`].
    pub fn run(&self, tolerance: f64) -> Result<Summary> {
        match self {
            Self::Plate(model) => model.run(tolerance),
            Self::Seat(model) => model.run(tolerance),
        }
    }

    /// As [`SeriesModel::run`] with the history.
    ///
    /// # Errors
    /// As [`SeriesModel::run`].
    pub fn run_with_history(&self, tolerance: f64) -> Result<Outcome> {
        match self {
            Self::Plate(model) => model.run_with_history(tolerance),
            Self::Seat(model) => model.run_with_history(tolerance),
        }
    }
}
