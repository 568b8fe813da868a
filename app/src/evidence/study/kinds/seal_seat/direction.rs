//! The direction of the sphere out of the flexible seal seat with a narrow band: the reduced model as a control variate.
//!
//! An unstructured mesh moves reference and reduced model alike, by more than it moves their difference. So the difference
//! comes from the meshes of the stored references, and what the mesh does from the reduced model on many others.

use super::launch::determined;
use crate::body::cache::Cache;
use crate::comparison::{ORDER, STANDARD_ERRORS, difference_band};
use crate::error::{Error, Result};
use crate::evidence::study::{Axis, Cell, Claim, Note, Panel, Settings, Study, of_project};
use crate::kinds::seal_seat::{DEFAULT_TOLERANCE, SeatMesh, SeatModel, SeatQuantities};
use crate::numerics::least_squares::fit;
use crate::reference::{self, COARSER, Resolution, Store, make_seat_mesh};
use crate::scene::{Model, Scene};
use std::path::Path;

/// Meshes of each design, their elements over those of the paper's resolution: geometric from `SIZES[0]` to `SIZES[1]`.
const MESHES: usize = 16;
const SIZES: [f64; 2] = [0.63, 1.6];

/// Designs: text, scene, and the half-width of the band that is wanted, rad.
const DESIGNS: [(&str, &str, f64); 2] =
    [("initial", "seal-seat-initial", 0.5 * DEGREE), ("improved", "seal-seat-improved", 0.25 * DEGREE)];
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Direction over the size of the elements.
pub const PANELS: [Panel; 1] = [Panel::of(
    Axis::new("element_size", "element size over that of the paper's resolution", 1.0),
    Axis::new("sphere_angle", "direction, °", 1.0 / DEGREE),
)
.by(Axis::new("design", "", 1.0))];

/// A direction with its band, rad.
struct Direction {
    angle: f64,
    band: f64,
}

/// The study.
///
/// # Errors
/// [`Error::Reference`] if a reference is not stored, [`Error::Solver`] if a seat can't be meshed or solved.
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let store = Store::open(settings.store.as_deref());
    let (mut rows, mut claims, mut sentences) = (Vec::new(), Vec::new(), Vec::new());
    for (design, name, expected) in DESIGNS {
        let scene = of_project(name)?;
        let [coarse, paper] = [Resolution::Coarse, Resolution::Paper].map(|resolution| {
            note(&format!("{name}: the stored reference's own mesh, {resolution}"));
            offset(&scene, &store, resolution)
        });
        let ((coarse, _), (offset, stored)) = (coarse?, paper?);
        let meshes = on_many_meshes(&scene, design, note, &mut rows)?;
        let offset_band = difference_band(coarse, offset, COARSER);
        let angle = meshes.angle + offset;
        let band = meshes.band.hypot(offset_band);
        sentences.push(format!(
            "{design} design {:+.2}° ± {:.2}° (meshes ± {:.2}°, reference − reduced {:+.3}° ± {:.3}°)",
            angle / DEGREE,
            band / DEGREE,
            meshes.band / DEGREE,
            offset / DEGREE,
            offset_band / DEGREE
        ));
        let half = |what: &str| format!("{design} design: {what}");
        claims.push(Claim::new(half("half-width of the band"), "rad", None, Some(band), expected));
        claims.push(Claim::new(
            half("the stored reference's direction, within its own band"),
            "rad",
            Some(angle),
            Some(stored.angle),
            stored.band.hypot(band),
        ));
    }
    Ok(Study::new(
        "seal-seat-direction",
        format!(
            "Direction of the sphere out of the flexible seal seat: model C on {MESHES} meshes, extrapolated to elements of no \
             size, plus what the finite elements differ by on the mesh of the stored reference: {}. Bands of 95 %.",
            sentences.join("; ")
        ),
        "design, element_size, dofs, sphere_angle [rad], sphere_speed [m/s], efficiency",
        rows,
        claims,
    ))
}

/// Direction of the stored reference minus that of the reduced model on its mesh, rad, and the reference's own.
fn offset(scene: &Scene, store: &Store, resolution: Resolution) -> Result<(f64, Direction)> {
    let Some(stored) = store.find(scene, resolution).found() else {
        return Err(Error::Reference(format!(
            "no reference of `{0}` is stored; `impactcheck reference {0} --resolution {resolution}` computes it",
            scene.name
        )));
    };
    let summary = &stored.outcome.summary;
    let (reduced, _) = on_mesh(scene, &stored.folder.join("mesh.vtu"))?;
    let exact = determined(summary)?.sphere_angle;
    let band = summary.band("sphere_angle").unwrap_or(f64::INFINITY);
    Ok((exact - reduced.sphere_angle, Direction { angle: exact, band }))
}

/// The reduced model's direction for elements of no size; a row per mesh.
fn on_many_meshes(
    scene: &Scene,
    design: &'static str,
    note: &mut Note,
    rows: &mut Vec<Vec<Cell>>,
) -> Result<Direction> {
    let folder = tempfile::tempdir().map_err(|e| Error::io("writing into", std::env::temp_dir(), e))?;
    let python = reference::python()?;
    let mut points = Vec::new();
    for k in 0..MESHES {
        note(&format!("{}: mesh {} of {MESHES}", scene.name, k + 1));
        let size = SIZES[0] * (SIZES[1] / SIZES[0]).powf(k as f64 / (MESHES - 1) as f64);
        let path = folder.path().join("seat.vtu");
        make_seat_mesh(&python, scene, Resolution::Paper, size, &path)?;
        let (result, dofs) = on_mesh(scene, &path)?;
        points.push(([1.0, size.powf(ORDER)], result.sphere_angle));
        rows.push(vec![
            Cell::Text(design),
            Cell::Number(size),
            Cell::Count(dofs),
            Cell::Number(result.sphere_angle),
            Cell::Number(result.sphere_speed),
            Cell::Number(result.efficiency),
        ]);
    }
    let line = fit(&points).ok_or_else(|| Error::Internal("directions on meshes of one size".into()))?;
    Ok(Direction { angle: line.coefficients[0], band: STANDARD_ERRORS * line.errors[0] })
}

fn on_mesh(scene: &Scene, path: &Path) -> Result<(SeatQuantities, usize)> {
    let model = SeatModel::new(scene, Model::C, None, &SeatMesh::open(path)?, &Cache::off())?;
    Ok((determined(&model.run(DEFAULT_TOLERANCE)?)?, model.dofs))
}
