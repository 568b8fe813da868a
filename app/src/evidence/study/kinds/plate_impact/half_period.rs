//! Section 4.1 of the paper: the efficiency is best when the contact lasts about half the first period of the plate.

use super::fig16::{APPROXIMATELY, RADII, best_radius, plate_impact};
use super::parameter::{Runner, linear};
use crate::error::Result;
use crate::evidence::study::{Axis, Cell, Claim, Note, Panel, Settings, Study};
use crate::scene::Model;

/// Thicknesses in m for which the radius of the plate has a clear optimum.
const THICKNESSES: [f64; 5] = [0.2e-3, 0.25e-3, 0.3e-3, 0.4e-3, 0.5e-3];
/// Radii that are drawn.
const POINTS: usize = 65;

/// How it is drawn.
pub const PANELS: [Panel; 1] = [Panel {
    paper: Some((1.0, "paper: best at about half the first period")),
    ..Panel::of(
        Axis::new("contact_over_half_period", "Contact over half the first period", 1.0),
        Axis::new("efficiency_over_best", "Efficiency over its best", 1.0),
    )
    .by(Axis::new("thickness", "mm", 1e3))
}];

/// The study.
///
/// # Errors
/// As [`Runner::run`].
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let model = settings.model.unwrap_or(Model::B);
    let runner = Runner::new(model);
    let radii = linear(*RADII.start(), *RADII.end(), POINTS);
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    let mut claims = Vec::new();
    for thickness in THICKNESSES {
        let (radius, best) = best_radius(&runner, thickness)?;
        let setups = radii.iter().map(|radius| plate_impact(*radius, thickness)).collect();
        for (radius, result) in radii.iter().zip(runner.run_all(setups, note)?) {
            let numbers = [
                thickness,
                *radius,
                result.contact_over_half_period(),
                result.efficiency,
                result.efficiency / best.efficiency,
            ];
            rows.push(numbers.map(Cell::Number).into());
        }
        claims.push(Claim::new(
            format!(
                "t = {:.2} mm, best radius ({:.2} mm): contact of the inner sphere over half the first period",
                thickness * 1e3,
                radius * 1e3
            ),
            "1",
            Some(1.0),
            Some(best.contact_over_half_period()),
            APPROXIMATELY,
        ));
    }
    Ok(Study::new(
        "half-period",
        format!(
            "Section 4.1 of the paper: the efficiency is optimal if the contact lasts approximately half the first period of the \
             plate. Plates and spheres of Fig. 16, model {model}; the contact is that of the inner sphere, through which the energy \
             passes, and \"approximately\" is taken as within 30 %. Ours are all on the short side: the contact has to be over \
             a little before the plate swings back."
        ),
        "thickness [m], plate_radius [m], contact_over_half_period, efficiency, efficiency_over_best",
        rows,
        claims,
    ))
}
