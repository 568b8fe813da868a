//! Fig. 17 of the paper: efficiency over the tip radius of compact bodies with the mass of the spheres.

use super::parameter::{Runner, impact, logarithmic, monotone, titanium};
use crate::error::Result;
use crate::evidence::study::{Axis, Cell, Claim, Note, Panel, Settings, Study};
use crate::kinds::plate_impact::PlateImpact;
use crate::scene::{Edge, Model, Shape};

/// The paper's optimum of Fig. 16: radius and thickness of the plate, m; radius of the spheres whose mass the bodies
/// keep, m.
const PLATE: (f64, f64, f64) = (5.5e-3, 0.3e-3, 1.5e-3);
const TIPS: (f64, f64, usize) = (0.3e-3, 10e-3, 31);
/// Tip radius in m up to which the efficiency depends on it strongly.
const SATURATION: f64 = 2e-3;

/// How it is drawn.
pub const PANELS: [Panel; 1] = [Panel::of(
    Axis::new("tip_radius", "Tip radius in mm", 1e3),
    Axis::new("efficiency", "Efficiency in %", 100.0),
)];

fn with_tips(tip_radius: f64) -> PlateImpact {
    let (radius, thickness, sphere) = PLATE;
    let mut setup = impact(radius, thickness, Edge::Clamped, titanium(), sphere);
    let shape = Shape::Compact { mass: setup.outer.shape.mass(&setup.outer.material), tip_radius };
    setup.outer.shape = shape.clone();
    setup.inner.shape = shape;
    setup
}

/// How far `values` fall below the highest before them, at most.
fn largest_fall(values: &[f64]) -> f64 {
    let step = |(highest, fall): (f64, f64), value: &f64| (highest.max(*value), fall.max(highest - value));
    values.iter().fold((f64::NEG_INFINITY, 0.0), step).1
}

/// The study.
///
/// # Errors
/// As [`Runner::run`].
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let model = settings.model.unwrap_or(Model::B);
    let tips = logarithmic(TIPS.0, TIPS.1, TIPS.2);
    let setups = tips.iter().map(|tip| with_tips(*tip)).collect();
    let results = Runner::new(model).run_all(setups, note)?;
    let column = |value: fn(&crate::kinds::plate_impact::PlateQuantities) -> f64| {
        results.iter().map(value).collect::<Vec<_>>()
    };
    let rows = tips
        .iter()
        .zip(&results)
        .map(|(tip, result)| {
            let numbers = [
                *tip,
                result.efficiency,
                result.outer_force_peak,
                result.inner_force_peak,
                result.inner_contact_end,
                result.contact_over_half_period(),
            ];
            numbers.map(Cell::Number).into()
        })
        .collect();
    let efficiency = column(|r| r.efficiency);
    let small = tips.iter().take_while(|tip| **tip <= SATURATION).count();
    let claims = vec![
        monotone("tip radius up to 2 mm: efficiency rises".into(), &efficiency[..small], true),
        Claim::new(
            "beyond, where it saturates: largest fall below what was reached".into(),
            "1",
            Some(0.0),
            Some(largest_fall(&efficiency)),
            0.005,
        ),
        monotone(
            "force between the outer body and the plate rises".into(),
            &column(|r| r.outer_force_peak),
            true,
        ),
        monotone("contact of the inner body becomes shorter".into(), &column(|r| r.inner_contact_end), false),
    ];
    Ok(Study::new(
        "fig17",
        format!(
            "Fig. 17 of the paper: efficiency over the tip radius of both bodies, whose mass stays that of steel spheres of \
             radius 1.5 mm; clamped titanium plate of radius 5.5 mm and thickness 0.3 mm, 0.5 m/s, model {model}. The paper \
             states that the efficiency rises, because a higher force shortens the contact. So it does up to 2 mm; beyond, model B \
             wavers by a quarter of a point about a plateau, and model C still rises."
        ),
        "tip_radius [m], efficiency, outer_force_peak [N], inner_force_peak [N], \
         inner_contact_end [s], contact_over_half_period",
        rows,
        claims,
    ))
}
