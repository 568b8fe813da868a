//! Fig. 16 of the paper: efficiency over the radius of plates of several thicknesses, and the best radius.

use super::parameter::{Runner, impact, linear, titanium};
use crate::error::Result;
use crate::evidence::study::{Axis, Cell, Claim, Note, Panel, Settings, Study};
use crate::kinds::plate_impact::PlateImpact;
use crate::kinds::plate_impact::PlateQuantities;
use crate::optimise::search::{Search, maximise};
use crate::scene::{Edge, Model};
use std::ops::RangeInclusive;

/// Radius of the spheres, m (section 4.2.2).
const SPHERE: f64 = 1.5e-3;
/// Thicknesses in m; the paper names 0.3 mm, and 0.1 to 0.5 mm as typical.
pub const THICKNESSES: [f64; 5] = [0.1e-3, 0.2e-3, 0.3e-3, 0.4e-3, 0.5e-3];
/// Radii of the plate, m.
pub const RADII: RangeInclusive<f64> = 2e-3..=10e-3;
/// Radii that are drawn.
const POINTS: usize = 65;
/// The thickness of the paper's optimum, its radius, and how far ours may lie from it, m.
const PAPER: (f64, f64, f64) = (0.3e-3, 5.5e-3, 0.25e-3);
/// The paper says "approximately" half the first period: within this part of it.
pub const APPROXIMATELY: f64 = 0.3;

/// How it is drawn.
pub const PANELS: [Panel; 2] = [
    Panel {
        paper: Some((PAPER.1 * 1e3, "paper: best radius for 0.3 mm")),
        ..Panel::of(
            Axis::new("plate_radius", "Radius of the plate in mm", 1e3),
            Axis::new("efficiency", "Efficiency in %", 100.0),
        )
        .by(Axis::new("thickness", "mm", 1e3))
    },
    Panel {
        band: Some((1.0, APPROXIMATELY)),
        paper: Some((PAPER.1 * 1e3, "paper: best radius for 0.3 mm")),
        ..Panel::of(
            Axis::new("plate_radius", "Radius of the plate in mm", 1e3),
            Axis::new("contact_over_half_period", "Contact over half period", 1.0),
        )
        .by(Axis::new("thickness", "mm", 1e3))
    },
];

/// The impact on a plate of `radius` and `thickness` m.
pub fn plate_impact(radius: f64, thickness: f64) -> PlateImpact {
    impact(radius, thickness, Edge::Clamped, titanium(), SPHERE)
}

/// The radius in m of the plate of `thickness` m that transmits most, and what it gives.
///
/// # Errors
/// As [`Runner::run`].
pub fn best_radius(runner: &Runner, thickness: f64) -> Result<(f64, PlateQuantities)> {
    let (low, high) = RADII.into_inner();
    let radius = |x: f64| low + (high - low) * x;
    let search = Search { resolution: 1e-4, ..Search::of_dimensions(1) };
    let best =
        maximise(1, &search, |x| Some(runner.run(plate_impact(radius(x[0]), thickness)).ok()?.efficiency))?;
    let radius = radius(best.at[0]);
    Ok((radius, runner.run(plate_impact(radius, thickness))?))
}

/// The study.
///
/// # Errors
/// As [`Runner::run`].
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let model = settings.model.unwrap_or(Model::B);
    let runner = Runner::new(model);
    let radii = linear(*RADII.start(), *RADII.end(), POINTS);
    let cases: Vec<(f64, f64)> =
        THICKNESSES.iter().flat_map(|t| radii.iter().map(move |r| (*t, *r))).collect();
    let results = runner.run_all(cases.iter().map(|(t, r)| plate_impact(*r, *t)).collect(), note)?;
    let rows = cases
        .iter()
        .zip(&results)
        .map(|((thickness, radius), result)| {
            let numbers = [
                *thickness,
                *radius,
                result.efficiency,
                result.inner_contact_end,
                result.first_frequency,
                result.contact_over_half_period(),
            ];
            numbers.map(Cell::Number).into()
        })
        .collect();
    let (thickness, paper, bound) = PAPER;
    let (radius, at_best) = best_radius(&runner, thickness)?;
    let at = format!("t = {:.1} mm", thickness * 1e3);
    let curves: Vec<&[PlateQuantities]> = results.chunks(radii.len()).collect();
    let claims = vec![
        Claim::new(format!("{at}: best radius"), "m", Some(paper), Some(radius), bound),
        Claim::new(
            format!("{at}, best radius: contact of the inner sphere over half the first period"),
            "1",
            Some(1.0),
            Some(at_best.contact_over_half_period()),
            APPROXIMATELY,
        ),
        thinner_is_better(&curves),
        Claim::new(
            "t = 0.1 mm, radius above 3 mm: spread of the efficiency is small".into(),
            "1",
            Some(0.0),
            Some(spread(&radii, curves[0])),
            0.05,
        ),
        drop_below(&runner, radius, thickness, at_best.efficiency)?,
    ];
    Ok(Study::new(
        "fig16",
        format!(
            "Fig. 16 of the paper: efficiency over the radius of a clamped titanium plate for thicknesses of 0.1 to 0.5 mm, \
             steel spheres of radius 1.5 mm at 0.5 m/s, model {model}. The paper names 5.5 mm as the best radius for \
             0.3 mm, where the contact lasts about half the first period of the plate; thin plates hardly depend on the radius."
        ),
        "thickness [m], plate_radius [m], efficiency, inner_contact_end [s], first_frequency [Hz], \
         contact_over_half_period",
        rows,
        claims,
    ))
}

/// Each thickness against the next, at its best radius.
fn thinner_is_better(curves: &[&[PlateQuantities]]) -> Claim {
    let best: Vec<f64> =
        curves.iter().map(|curve| curve.iter().map(|r| r.efficiency).fold(0.0, f64::max)).collect();
    super::parameter::monotone("best efficiency falls with thickness".into(), &best, false)
}

/// Relative spread of the efficiency over radii of at least 3 mm.
fn spread(radii: &[f64], curve: &[PlateQuantities]) -> f64 {
    let wide = radii.iter().zip(curve).filter(|(radius, _)| **radius >= 3e-3).map(|(_, r)| r.efficiency);
    let (low, high) = wide.fold((f64::INFINITY, 0.0_f64), |(l, h), e| (l.min(e), h.max(e)));
    (high - low) / high
}

/// What is left of the efficiency at half the best radius.
fn drop_below(runner: &Runner, radius: f64, thickness: f64, best: f64) -> Result<Claim> {
    let half = runner.run(plate_impact(0.5 * radius, thickness))?.efficiency;
    let claim = "t = 0.3 mm: efficiency at half the best radius over the best (drops rapidly: below 0.75)";
    Ok(Claim::new(claim.into(), "1", Some(0.0), Some(half / best), 0.75))
}
