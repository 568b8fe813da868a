//! Fig. 15 of the paper: efficiency over the thickness of the plate, clamped and free.

use super::parameter::{Runner, impact, linear, monotone, titanium};
use crate::error::Result;
use crate::evidence::study::{Axis, Cell, Claim, Note, Panel, Settings, Study};
use crate::scene::{Edge, Model};

/// Radius of the plate in m; the paper's text names none for this figure, its typical plates have 3 mm.
const RADIUS: f64 = 3e-3;
/// Radius of the spheres, m.
const SPHERE: f64 = 1.5e-3;
const THICKNESSES: (f64, f64, usize) = (0.05e-3, 1e-3, 39);
const EDGES: [(&str, Edge); 2] = [("clamped", Edge::Clamped), ("free", Edge::Free)];

/// How it is drawn.
pub const PANELS: [Panel; 1] = [Panel::of(
    Axis::new("thickness", "Thickness of the plate in mm", 1e3),
    Axis::new("efficiency", "Efficiency in %", 100.0),
)
.by(Axis::new("edge", "", 1.0))];

/// The study.
///
/// # Errors
/// As [`Runner::run`].
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let model = settings.model.unwrap_or(Model::B);
    let thicknesses = linear(THICKNESSES.0, THICKNESSES.1, THICKNESSES.2);
    let cases: Vec<((&'static str, Edge), f64)> =
        EDGES.into_iter().flat_map(|edge| thicknesses.iter().map(move |t| (edge, *t))).collect();
    let setups = cases.iter().map(|((_, edge), t)| impact(RADIUS, *t, *edge, titanium(), SPHERE)).collect();
    let results = Runner::new(model).run_all(setups, note)?;
    let rows = cases
        .iter()
        .zip(&results)
        .map(|(((edge, _), thickness), result)| {
            let numbers = [*thickness, result.efficiency, result.inner_contact_end, result.first_frequency];
            std::iter::once(Cell::Text(edge)).chain(numbers.map(Cell::Number)).collect()
        })
        .collect();
    let efficiency: Vec<f64> = results.iter().map(|result| result.efficiency).collect();
    let (clamped, free) = efficiency.split_at(thicknesses.len());
    let thickest = |values: &[f64]| values.last().copied();
    let claims = vec![
        monotone("clamped: efficiency falls with thickness".into(), clamped, false),
        Claim::new(
            "clamped, t = 1 mm: next to nothing passes (below 5 %)".into(),
            "1",
            Some(0.0),
            thickest(clamped),
            0.05,
        ),
        Claim::new(
            "free, t = 1 mm: still transmits (more than half)".into(),
            "1",
            Some(1.0),
            thickest(free),
            0.5,
        ),
    ];
    Ok(Study::new(
        "fig15",
        format!(
            "Fig. 15 of the paper: efficiency over the thickness of a titanium plate of radius 3 mm, clamped and free, \
             steel spheres of radius 1.5 mm at 0.5 m/s, model {model}. The paper states the trends: falling when \
             clamped; a free plate also transmits when it is thick, more like a point mass."
        ),
        "edge, thickness [m], efficiency, inner_contact_end [s], first_frequency [Hz]",
        rows,
        claims,
    ))
}
