//! Fig. 14 of the paper: efficiency over Young's modulus of plate, outer and inner sphere, one varied at a time.

use super::parameter::{Runner, impact, logarithmic, monotone, steel};
use crate::error::Result;
use crate::evidence::study::{Axis, Cell, Note, Panel, Settings, Study};
use crate::kinds::plate_impact::PlateImpact;
use crate::scene::{Edge, Model};

/// Radius and thickness of the plate, radius of the spheres, m (section 4.2.1).
const PLATE: (f64, f64, f64) = (3e-3, 0.3e-3, 2.5e-3);
/// Moduli from polymer-like to hard metal, Pa; the paper's range is not in its text.
const MODULI: (f64, f64, usize) = (20e9, 400e9, 25);
const BODIES: [&str; 3] = ["plate", "outer", "inner"];

/// How it is drawn.
pub const PANELS: [Panel; 1] = [Panel::of(
    Axis::new("youngs_modulus", "Young's modulus in GPa", 1e-9),
    Axis::new("efficiency", "Efficiency in %", 100.0),
)
.by(Axis::new("body", "", 1.0))];

fn with_modulus(body: &str, modulus: f64) -> PlateImpact {
    let (radius, thickness, sphere) = PLATE;
    let mut setup = impact(radius, thickness, Edge::Clamped, steel(), sphere);
    let material = match body {
        "plate" => &mut setup.plate.material,
        "outer" => &mut setup.outer.material,
        _ => &mut setup.inner.material,
    };
    material.youngs_modulus = modulus;
    setup
}

/// The study.
///
/// # Errors
/// As [`Runner::run`].
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let model = settings.model.unwrap_or(Model::B);
    let moduli = logarithmic(MODULI.0, MODULI.1, MODULI.2);
    let cases: Vec<(&'static str, f64)> =
        BODIES.into_iter().flat_map(|body| moduli.iter().map(move |modulus| (body, *modulus))).collect();
    let setups = cases.iter().map(|(body, modulus)| with_modulus(body, *modulus)).collect();
    let results = Runner::new(model).run_all(setups, note)?;
    let rows = cases
        .iter()
        .zip(&results)
        .map(|((body, modulus), result)| {
            let numbers = [
                *modulus,
                result.efficiency,
                result.outer_contact_end,
                result.inner_contact_end,
                result.first_frequency,
            ];
            std::iter::once(Cell::Text(body)).chain(numbers.map(Cell::Number)).collect()
        })
        .collect();
    let efficiency: Vec<f64> = results.iter().map(|result| result.efficiency).collect();
    let claims = BODIES
        .iter()
        .zip(efficiency.chunks(moduli.len()))
        .map(|(body, values)| match *body {
            "plate" => monotone("efficiency falls with Young's modulus of the plate".into(), values, false),
            body => {
                monotone(format!("efficiency rises with Young's modulus of the {body} sphere"), values, true)
            }
        })
        .collect();
    Ok(Study::new(
        "fig14",
        format!(
            "Fig. 14 of the paper: efficiency over Young's modulus of one body at a time, the others steel; clamped plate \
             of radius 3 mm and thickness 0.3 mm, spheres of radius 2.5 mm, model {model}. The paper states the \
             trends; its sentence that a plate with a higher and spheres with a lower modulus are better \
             contradicts them and its own reasons, and is taken for a slip."
        ),
        "body, youngs_modulus [Pa], efficiency, outer_contact_end [s], inner_contact_end [s], \
         first_frequency [Hz]",
        rows,
        claims,
    ))
}
