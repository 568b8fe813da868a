//! Section 4.2.5 of the paper: what the fluid does to the efficiency, each effect alone and all together.

use super::parameter::{Runner, impact, titanium};
use crate::error::Result;
use crate::evidence::study::{Axis, Cell, Claim, Note, Panel, Settings, Study};
use crate::scene::{Edge, Fluid, Model};

/// Radius of the steel spheres in m (section 4.2.2).
const SPHERE: f64 = 1.5e-3;
/// Radii of the plates in m: a stiff one, of section 4.1, and the best one for a thickness of 0.3 mm.
const RADII: [f64; 2] = [3e-3, 5.5e-3];
/// Thicknesses of the plates in m.
const THICKNESSES: [f64; 10] =
    [0.05e-3, 0.1e-3, 0.15e-3, 0.2e-3, 0.25e-3, 0.3e-3, 0.35e-3, 0.4e-3, 0.45e-3, 0.5e-3];
/// Damping ratios of the dry and the wet plate as measured (section 3.5.3).
const DAMPING: [f64; 2] = [0.001, 0.03];
/// First wet over first dry frequency as measured (section 3.5.3).
const FREQUENCY_RATIO: f64 = 1.0 / 3.0;
/// Resistance coefficient of a sphere at the Reynolds numbers of the impact, some hundreds.
const RESISTANCE: f64 = 0.4;
/// What "up to about 30 %" may be off by.
const ABOUT: f64 = 0.05;
/// What "very small" is, in efficiency.
const VERY_SMALL: f64 = 0.01;

/// An effect and what it changes in a fluid without effects.
type Effect = (&'static str, Option<fn(&mut Fluid)>);

/// Dry, each effect alone, all.
const EFFECTS: [Effect; 6] = [
    ("dry", None),
    ("squeeze film", Some(|fluid| fluid.squeeze_film = true)),
    ("plate damping", Some(|fluid| fluid.plate_damping_ratio = DAMPING[1])),
    ("added mass", Some(|fluid| fluid.added_mass_frequency_ratio = FREQUENCY_RATIO)),
    ("drag", Some(|fluid| fluid.drag_coefficient = RESISTANCE)),
    (
        "all",
        Some(|fluid| EFFECTS[1..5].iter().filter_map(|(_, change)| *change).for_each(|change| change(fluid))),
    ),
];

/// How it is drawn.
pub const PANELS: [Panel; 2] = [
    panel("efficiency_r3", "Efficiency, plate radius 3 mm"),
    panel("efficiency_r5.5", "Efficiency, plate radius 5.5 mm"),
];

const fn panel(column: &'static str, label: &'static str) -> Panel {
    Panel::of(Axis::new("thickness", "Plate thickness in mm", 1e3), Axis::new(column, label, 1.0))
        .by(Axis::new("effect", "", 1.0))
}

/// Water without any effect on plates of the dry damping.
fn water() -> Fluid {
    Fluid {
        viscosity: 1e-3,
        density: 1e3,
        minimum_gap: 0.25e-6,
        squeeze_film: false,
        added_mass_frequency_ratio: 1.0,
        plate_damping_ratio: DAMPING[0],
        drag_coefficient: 0.0,
        shear_thinning: None,
    }
}

/// Efficiencies of one plate radius. Shape (effects, thicknesses).
fn efficiencies(runner: &Runner, radius: f64, note: &mut Note) -> Result<Vec<Vec<f64>>> {
    let mut table = Vec::new();
    for (_, change) in EFFECTS {
        let setup = |thickness: &f64| {
            let mut setup = impact(radius, *thickness, Edge::Clamped, titanium(), SPHERE);
            setup.plate.damping_ratio = DAMPING[0];
            setup.fluid = change.map(|change| {
                let mut fluid = water();
                change(&mut fluid);
                fluid
            });
            setup
        };
        let results = runner.run_all(THICKNESSES.iter().map(setup).collect(), note)?;
        table.push(results.iter().map(|result| result.efficiency).collect());
    }
    Ok(table)
}

/// The study.
///
/// # Errors
/// As [`Runner::run`].
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let model = settings.model.unwrap_or(Model::B);
    let runner = Runner::new(model);
    let [stiff, best] = [efficiencies(&runner, RADII[0], note)?, efficiencies(&runner, RADII[1], note)?];
    let mut rows = Vec::new();
    for (e, (name, _)) in EFFECTS.iter().enumerate() {
        for (t, thickness) in THICKNESSES.iter().enumerate() {
            let mut row = vec![Cell::Text(name), Cell::Number(*thickness)];
            for table in [&stiff, &best] {
                row.push(Cell::Number(table[e][t]));
                row.push(Cell::Number(table[e][t] - table[0][t]));
            }
            rows.push(row);
        }
    }
    Ok(Study::new(
        "fluid",
        format!(
            "Section 4.2.5 of the paper: efficiency in water, each effect alone and all together; titanium plates of two \
             radii between steel spheres of radius 1.5 mm, model {model}. Wet over dry frequency 1/3 and damping \
             0.03 instead of 0.001 as measured in section 3.5.3, viscosity 1 mPa s, minimal gap 0.25 um, c_W 0.4. Losses are \
             in efficiency, not relative to it. That fluids always reduce the efficiency does not hold for plates so stiff \
             that the contact outlasts half the first period: there a lower frequency brings the plate closer to its best."
        ),
        "effect, thickness [m], efficiency_r3, change_r3, efficiency_r5.5, change_r5.5",
        rows,
        claims(&stiff, &best),
    ))
}

/// The statements of sections 3.5.1 and 4.2.5.
fn claims(stiff: &[Vec<f64>], best: &[Vec<f64>]) -> Vec<Claim> {
    let losses = |table: &[Vec<f64>], effect: usize| -> Vec<f64> {
        table[0].iter().zip(&table[effect]).map(|(dry, wet)| dry - wet).collect()
    };
    let both = |effect: usize| losses(stiff, effect).into_iter().chain(losses(best, effect));
    let largest = |effect: usize| both(effect).fold(f64::NEG_INFINITY, f64::max);
    let share = |values: &[f64]| values.iter().filter(|v| **v > 0.0).count() as f64 / values.len() as f64;
    let always: Vec<f64> = (1..EFFECTS.len()).flat_map(both).collect();
    let below_best: Vec<f64> = (1..EFFECTS.len()).flat_map(|effect| losses(best, effect)).collect();
    let relative: Vec<f64> = losses(best, 3).iter().zip(&best[0]).map(|(loss, dry)| loss / dry).collect();
    let steps = |values: &[f64]| -> Vec<f64> { values.windows(2).map(|pair| pair[1] - pair[0]).collect() };
    vec![
        Claim::new(
            "plate damping reduces the efficiency by up to 3 %: largest reduction, at most 0.03".into(),
            "1",
            None,
            Some(largest(2)),
            0.03,
        ),
        Claim::new(
            "reduced frequencies: up to about 30 %: largest reduction".into(),
            "1",
            Some(0.3),
            Some(largest(3)),
            ABOUT,
        ),
        Claim::new(
            "typically more with high flexural rigidity, R = 5.5 mm: share of steps in thickness at which the reduction, \
             relative to the dry efficiency, grows"
                .into(),
            "1",
            Some(1.0),
            Some(share(&steps(&relative))),
            0.0,
        ),
        Claim::new(
            "typically more with high flexural rigidity, R = 5.5 mm: share of steps in thickness at which the reduction \
             itself grows"
                .into(),
            "1",
            Some(1.0),
            Some(share(&steps(&losses(best, 3)))),
            0.0,
        ),
        Claim::new("drag is very small (section 3.5.1): largest reduction".into(), "1", None, Some(largest(4)), VERY_SMALL),
        Claim::new("fluids always reduce the efficiency, R = 5.5 mm: share of effects and plates".into(), "1", Some(1.0), Some(share(&below_best)), 0.0),
        Claim::new("fluids always reduce the efficiency, both radii: share of effects and plates".into(), "1", Some(1.0), Some(share(&always)), 0.0),
    ]
}
