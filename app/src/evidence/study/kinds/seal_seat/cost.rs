//! What the reduced seal seat costs, and the time loop of the finite elements on the same mesh, in one run.

use super::launch::determined;
use crate::body::cache::Cache;
use crate::error::{Error, Result};
use crate::evidence::study::{Cell, Claim, Note, Study, of_project};
use crate::kinds::seal_seat::{DEFAULT_TOLERANCE, SeatMesh, SeatModel};
use crate::reference::{self, Resolution, Store, Stored, Wish};
use crate::scene::Model;

/// Ratio of the run times that is wanted at least.
const RATIO: f64 = 300.0;
/// Runs of the reduced model, of which the fastest counts, as that which others disturbed least.
const REPETITIONS: usize = 7;

/// The study.
///
/// # Errors
/// As [`reference::solve_with`], [`SeatModel::new`].
pub fn run(note: &mut Note) -> Result<Study> {
    let folder = std::env::temp_dir();
    let folder = tempfile::tempdir_in(&folder).map_err(|e| Error::io("writing into", &folder, e))?;
    let store = Store::open(Some(folder.path()));
    let python = reference::python()?;
    let (mut rows, mut claims) = (Vec::new(), Vec::new());
    for name in ["seal-seat-initial", "seal-seat-improved"] {
        let scene = of_project(name)?;
        note(&format!("{name}: finite elements"));
        let wish = Wish::default();
        let stored: Stored =
            reference::solve_with(&python, &scene, Resolution::Coarse, &store, &wish, &mut |_| {})?;
        note(&format!("{name}: reduced model"));
        let mesh = SeatMesh::open(&stored.folder.join("mesh.vtu"))?;
        let model = SeatModel::new(&scene, Model::C, None, &mesh, &Cache::off())?;
        let mut own = f64::INFINITY;
        let mut reduced = model.run(DEFAULT_TOLERANCE)?;
        for _ in 0..REPETITIONS {
            reduced = model.run(DEFAULT_TOLERANCE)?;
            own = own.min(reduced.solve_seconds);
        }
        let summary = &stored.outcome.summary;
        let ratio = summary.solve_seconds / own;
        let (ours, exact) = (determined(&reduced)?, determined(summary)?);
        let off = ours.sphere_angle - exact.sphere_angle;
        let speed = ours.sphere_speed / exact.sphere_speed - 1.0;
        let text = if name == "seal-seat-initial" { "initial" } else { "improved" };
        rows.push(vec![
            Cell::Text(text),
            Cell::Count(model.dofs),
            Cell::Number(summary.solve_seconds),
            Cell::Number(model.setup_seconds),
            Cell::Number(own),
            Cell::Number(ratio),
            Cell::Number(off),
            Cell::Number(speed),
        ]);
        let claim = format!("{text} design: the reduced run is at least {RATIO} times as fast (1 = yes)");
        claims.push(Claim::new(claim, "1", Some(1.0), Some(f64::from(u8::from(ratio >= RATIO))), 0.0));
    }
    Ok(Study::new(
        "seal-seat-cost",
        "Run times of the reduced seal seat (16 modes or the scene's, no cache, its error estimate included) \
             and of the explicit finite elements' time loop on the same mesh, measured one after the other.",
        "design, dofs, reference_seconds [s], setup_seconds [s], reduced_seconds [s], ratio, \
         angle_difference [rad], speed_difference",
        rows,
        claims,
    ))
}
