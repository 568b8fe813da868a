//! Section 4.2.4 of the paper: what the damping in a polymer plate takes, and where.
//!
//! The plate is the one best for its spheres; a loss factor that is the same at all frequencies stands for the polymer's damping. Finite
//! elements are those of the validation scenes that are the same impact.

use super::{Axis, Cell, Claim, Note, Panel, SCHEMA_VERSION, Study};
use crate::error::Result;
use crate::kinds::plate_impact::reduced::Reduced;
use crate::result::Summary;
use crate::scene::{Model, Scene};
use crate::validated;

/// Loss factors; 0 is the elastic plate.
const LOSS_FACTORS: [f64; 9] = [0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.05, 0.07, 0.1];
/// The one that the paper's statement is held against, usual for stiff polymers.
const USUAL: f64 = 0.02;
/// What the damping takes by the paper, in efficiency, and what "about" may be off by.
const PAPER: (f64, f64) = (0.02, 0.005);
/// How far what it takes in model C may lie from the finite elements.
const CLOSE: f64 = 1e-3;
const MODELS: [(Model, &str); 3] = [(Model::A, "A"), (Model::B, "B"), (Model::C, "C")];
const REFERENCE: &str = "finite elements";
/// Relative error of the efficiency from the time integration.
const TOLERANCE: f64 = 1e-6;

/// How it is drawn.
pub const PANELS: [Panel; 2] =
    [panel("efficiency", "Efficiency"), panel("lost_in_plate", "Lost in the plate's modes")];

const fn panel(column: &'static str, label: &'static str) -> Panel {
    Panel {
        x: Axis { column: "loss_factor", label: "Loss factor of the plate", factor: 1.0 },
        y: Axis { column, label, factor: 1.0 },
        series: Some(Axis { column: "by", label: "", factor: 1.0 }),
        only: None,
        band: None,
        paper: None,
    }
}

/// The impact with a plate of `loss_factor`.
fn scene(loss_factor: f64) -> Result<Scene> {
    let losses = match loss_factor {
        0.0 => String::new(),
        _ => format!(r#", loss_factor = {loss_factor}, modulus_frequency = "10 kHz""#),
    };
    Scene::parse(
        "damping",
        &format!(
            r#"
            name = "damping"
            kind = "plate-impact"
            plate = {{ radius = "5.5 mm", thickness = "0.5 mm", edge = "clamped", material = "polymer" }}
            outer = {{ kind = "sphere", radius = "1.5 mm", material = "steel", speed = "550 mm/s" }}
            inner = {{ kind = "sphere", radius = "1.5 mm", material = "steel" }}
            [materials]
            steel = {{ youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = "7780 kg/m^3" }}
            polymer = {{ youngs_modulus = "2.6 GPa", poisson_ratio = 0.38, density = "1320 kg/m^3"{losses} }}
            "#
        ),
    )
}

/// What was lost in the plate's modes and what creeps beneath the contacts, in the outer and in the inner contact, over the energy of the
/// outer body.
fn lost(scene: &Scene, summary: &Summary) -> [f64; 3] {
    let energy = scene
        .plate_impact()
        .map_or(f64::NAN, |s| 0.5 * s.outer.shape.mass(&s.outer.material) * s.outer.speed.powi(2));
    let losses = summary.losses.unwrap_or_default();
    let [outer, inner] = losses.contacts.unwrap_or_default();
    [losses.plate_damping, outer, inner].map(|loss| loss / energy)
}

/// The study.
///
/// # Errors
/// As [`Reduced::new`] and [`Reduced::run`], and if the record of validated scenes can't be read.
pub fn run(note: &mut Note) -> Result<Study> {
    let scenes: Vec<Scene> = LOSS_FACTORS.into_iter().map(scene).collect::<Result<_>>()?;
    let mut rows = Vec::new();
    let mut claims = Vec::new();
    let validated = validated::shipped()?;
    let references: Vec<Option<[f64; 2]>> = scenes
        .iter()
        .map(|scene| {
            let rows = validated.iter().filter(|v| v.scene_hash == scene.hash()).flat_map(|v| &v.rows);
            let row = rows.into_iter().find(|row| row.quantity == "efficiency")?;
            Some([row.reference, row.band?])
        })
        .collect();
    let of_usual = |values: &[Option<f64>]| {
        let at = LOSS_FACTORS.iter().position(|loss| *loss == USUAL)?;
        Some(values[0]? - values[at]?)
    };
    let in_elements =
        of_usual(&references.iter().map(|found| found.map(|[value, _]| value)).collect::<Vec<_>>());
    for (model, name) in MODELS {
        note(&format!("{} impacts with model {model}", scenes.len()));
        let mut efficiencies = Vec::new();
        for (scene, loss_factor) in scenes.iter().zip(LOSS_FACTORS) {
            let summary = Reduced::new(scene, model, None)?.run(TOLERANCE)?;
            let efficiency = summary.value("efficiency");
            let [plate, outer, inner] = lost(scene, &summary);
            efficiencies.push(efficiency);
            let numbers = [Some(loss_factor), efficiency, None, Some(plate), Some(outer), Some(inner)];
            rows.push([Cell::Text(name)].into_iter().chain(numbers.map(Cell::from)).collect());
            if model == Model::C && loss_factor == USUAL {
                claims.push(contacts_lose_most(plate, outer + inner));
            }
        }
        let taken = of_usual(&efficiencies);
        claims.extend(claims_of(model, taken, in_elements));
    }
    for (found, loss_factor) in references.iter().zip(LOSS_FACTORS) {
        let Some([value, band]) = found else { continue };
        let numbers = [Some(loss_factor), Some(*value), Some(*band), None, None, None];
        rows.push([Cell::Text(REFERENCE)].into_iter().chain(numbers.map(Cell::from)).collect());
    }
    claims.push(taken_by(REFERENCE, in_elements));
    Ok(Study {
        schema_version: SCHEMA_VERSION,
        study: "damping",
        description: "Section 4.2.4 of the paper: efficiency of a polymer plate (radius 5.5 mm, thickness 0.5 mm) between steel spheres of radius \
                      1.5 mm over its loss factor, the same at all frequencies; the modulus is the storage modulus at 10 kHz. Losses are over the \
                      energy of the outer sphere. Finite elements are those recorded of the validation scenes."
            .into(),
        columns: vec!["by", "loss_factor", "efficiency", "band", "lost_in_plate", "lost_in_outer_contact", "lost_in_inner_contact"],
        units: vec!["1"; 7],
        rows,
        claims,
    })
}

/// Of one model that loses `taken` in efficiency, beside what finite elements lose.
fn claims_of(model: Model, taken: Option<f64>, in_elements: Option<f64>) -> Vec<Claim> {
    let difference = taken.zip(in_elements).map(|(ours, theirs)| ours - theirs);
    let beside = format!("model {model} loses as much as the finite elements: difference in efficiency");
    let mut claims = vec![taken_by(&format!("model {model}"), taken)];
    claims.extend((model == Model::C).then(|| Claim::new(beside, "1", None, difference, CLOSE)));
    claims
}

fn taken_by(by: &str, taken: Option<f64>) -> Claim {
    let claim = format!(
        "a polymer's damping takes about two per cent: efficiency lost at a loss factor of {USUAL}, {by}"
    );
    Claim::new(claim, "1", Some(PAPER.0), taken, PAPER.1)
}

fn contacts_lose_most(plate: f64, contacts: f64) -> Claim {
    let share = plate / (plate + contacts);
    Claim::new(
        "it is lost in the contacts, model C: share of the plate's modes, at most 0.5".into(),
        "1",
        None,
        Some(share),
        0.5,
    )
}
