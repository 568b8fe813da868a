//! Impacts one after another, of any kind of scene: what they share, and a model of each.

use super::of;
use super::seal_seat::SeatMesh;
use crate::error::{Error, Result};
use crate::result::{CUT, History, Outcome, Point, Summary, Table};
use crate::scene::{Model, Scene};
use std::fmt::Debug;

/// What the impacts of a series share.
pub trait Series: Debug + Send + Sync {
    /// Whether an impact takes tenths of a second, for a mesh is factorised, rather than a tenth of a millisecond.
    fn is_expensive(&self) -> bool {
        false
    }

    /// `model` of `scene` with so many `modes`, its own or the scene's number if it is `None`.
    ///
    /// # Errors
    /// Those of the model's set-up.
    fn model(&self, scene: Scene, model: Model, modes: Option<usize>) -> Result<Box<dyn SeriesModel>>;
}

/// A reduced model of one impact, ready to run. `tolerance` bounds the relative error of its time integration.
pub trait SeriesModel: Debug + Send + Sync {
    /// Runs the impact.
    ///
    /// # Errors
    /// [`Error::Solver`] if it can't be integrated.
    fn run_with_history(&self, tolerance: f64) -> Result<Outcome>;

    /// As [`SeriesModel::run_with_history`] without the course over time.
    ///
    /// # Errors
    /// As there.
    fn run(&self, tolerance: f64) -> Result<Summary> {
        Ok(self.run_with_history(tolerance)?.summary)
    }

    /// Results and course alone, without estimates of errors and without warnings, where that is quicker: for a page that follows a
    /// number while it is dragged.
    ///
    /// # Errors
    /// As [`SeriesModel::run`].
    fn course(&self, tolerance: f64) -> Result<(Table, History)> {
        let Outcome { summary, history } = self.run_with_history(tolerance)?;
        Ok((summary.quantities, history))
    }

    /// The results alone, of which every one has to be determined.
    ///
    /// # Errors
    /// As [`SeriesModel::run`]; [`Error::Solver`] if the run is cut during a contact.
    fn point(&self, tolerance: f64) -> Result<Point<Table>> {
        let summary = self.run(tolerance)?;
        if summary.undetermined().next().is_some() {
            return Err(Error::Solver(CUT.into()));
        }
        Ok(Point {
            energy_residual: summary.energy_residual.unwrap_or(f64::NAN),
            momentum_residual: summary.momentum_residual.unwrap_or(f64::NAN),
            steps: summary.steps.unwrap_or_default(),
            converged: true,
            quantities: summary.quantities,
        })
    }
}

/// A series of about so many `impacts` of scenes like `scene` in which the numbers of fields vary within the ranges `varied`; of a kind
/// whose models share a mesh, with the `mesh`.
///
/// # Errors
/// [`Error::Internal`] if a mesh is needed and missing, [`Error::Solver`] if it is unusable.
pub fn series<'a>(
    varied: impl IntoIterator<Item = (&'a str, [f64; 2])>,
    scene: &Scene,
    mesh: Option<&SeatMesh>,
    impacts: usize,
) -> Result<Box<dyn Series>> {
    let varied: Vec<_> = varied.into_iter().collect();
    of(scene).series(&varied, scene, mesh, impacts)
}

/// Impacts that share nothing.
#[derive(Debug)]
pub(super) struct Independent;

impl Series for Independent {
    fn model(&self, scene: Scene, model: Model, modes: Option<usize>) -> Result<Box<dyn SeriesModel>> {
        of(&scene).model(&scene, model, modes)
    }
}
