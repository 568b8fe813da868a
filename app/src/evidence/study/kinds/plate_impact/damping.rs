//! Section 4.2.4 of the paper: what the damping in a polymer plate takes, and where.
//!
//! The plate is the one best for its spheres; a loss factor that is the same at all frequencies stands for the polymer's damping. Finite
//! elements are those of the validation scenes that are the same impact.

use crate::error::Result;
use crate::evidence::study::{Axis, Cell, Claim, Note, Panel, Study};
use crate::kinds::plate_impact::reduced::Reduced;
use crate::result::Summary;
use crate::scene::{Model, Scene};
use crate::validated;

/// Loss factors; 0 is the elastic plate.
const LOSS_FACTORS: [f64; 9] = [0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.05, 0.07, 0.1];
/// The one that the paper's statement is compared with, usual for stiff polymers.
const USUAL: f64 = 0.02;
/// What the damping takes by the paper, in efficiency, and what "about" may be off by.
const PAPER: (f64, f64) = (0.02, 0.005);
/// How far what it takes in model C may lie from the finite elements.
const CLOSE: f64 = 1e-3;
/// Relative error of the efficiency from the time integration.
const TOLERANCE: f64 = 1e-6;

/// How it is drawn.
pub const PANELS: [Panel; 2] =
    [panel("efficiency", "Efficiency"), panel("lost_in_plate", "Lost in the plate's modes")];

const fn panel(column: &'static str, label: &'static str) -> Panel {
    Panel::of(Axis::new("loss_factor", "Loss factor of the plate", 1.0), Axis::new(column, label, 1.0))
        .by(Axis::new("by", "", 1.0))
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

/// The impact over the loss factors, by one model or by finite elements.
struct LossFactorCurve {
    by: &'static str,
    /// The columns behind `by`, for each loss factor.
    rows: Vec<[Option<f64>; 6]>,
}

impl LossFactorCurve {
    fn by(model: Model, name: &'static str, scenes: &[Scene]) -> Result<Self> {
        let row = |(scene, loss_factor): (&Scene, f64)| {
            let summary = Reduced::new(scene, model, None)?.run(TOLERANCE)?;
            let [plate, outer, inner] = lost(scene, &summary).map(Some);
            Ok([Some(loss_factor), summary.value("efficiency"), None, plate, outer, inner])
        };
        Ok(Self { by: name, rows: scenes.iter().zip(LOSS_FACTORS).map(row).collect::<Result<_>>()? })
    }

    /// What is recorded of the references of the same impacts.
    fn recorded(scenes: &[Scene]) -> Result<Self> {
        let validated = validated::shipped()?;
        let row = |(scene, loss_factor): (&Scene, f64)| {
            let mut same = validated.iter().filter(|v| v.scene_hash == scene.hash()).flat_map(|v| &v.rows);
            let found = same.find(|row| row.quantity == "efficiency")?;
            Some([Some(loss_factor), Some(found.reference), found.band, None, None, None])
        };
        Ok(Self { by: "finite elements", rows: scenes.iter().zip(LOSS_FACTORS).filter_map(row).collect() })
    }

    fn at(&self, loss_factor: f64) -> Option<&[Option<f64>; 6]> {
        self.rows.iter().find(|row| row[0] == Some(loss_factor))
    }

    /// What the usual loss factor takes of the efficiency.
    fn taken(&self) -> Option<f64> {
        Some(self.at(0.0)?[1]? - self.at(USUAL)?[1]?)
    }

    /// Share of the plate's modes in what is lost.
    fn share_of_plate(&self) -> Option<f64> {
        let [.., plate, outer, inner] = *self.at(USUAL)?;
        Some(plate? / (plate? + outer? + inner?))
    }

    fn cells(&self) -> impl Iterator<Item = Vec<Cell>> {
        self.rows.iter().map(|row| [Cell::Text(self.by)].into_iter().chain(row.map(Cell::from)).collect())
    }
}

/// The study.
///
/// # Errors
/// As [`Reduced::new`] and [`Reduced::run`], and if the record of validated scenes can't be read.
pub fn run(note: &mut Note) -> Result<Study> {
    let scenes: Vec<Scene> = LOSS_FACTORS.into_iter().map(scene).collect::<Result<_>>()?;
    note(&format!("{} impacts with models A, B and C", scenes.len()));
    let courses = [
        LossFactorCurve::by(Model::A, "A", &scenes)?,
        LossFactorCurve::by(Model::B, "B", &scenes)?,
        LossFactorCurve::by(Model::C, "C", &scenes)?,
        LossFactorCurve::recorded(&scenes)?,
    ];
    Ok(Study::new(
        "damping",
        "Section 4.2.4 of the paper: efficiency of a polymer plate (radius 5.5 mm, thickness 0.5 mm) between steel spheres of radius \
                      1.5 mm over its loss factor, the same at all frequencies; the modulus is the storage modulus at 10 kHz. Losses are over the \
                      energy of the outer sphere. Finite elements are those recorded of the validation scenes.",
        "by, loss_factor, efficiency, band, lost_in_plate, lost_in_outer_contact, lost_in_inner_contact",
        courses.iter().flat_map(LossFactorCurve::cells).collect(),
        claims(&courses),
    ))
}

fn claims(courses: &[LossFactorCurve; 4]) -> Vec<Claim> {
    let [.., ours, theirs] = courses;
    let two_per_cent = |course: &LossFactorCurve| {
        let claim = format!(
            "a polymer's damping takes about two per cent: efficiency lost at a loss factor of {USUAL}, {}",
            course.by
        );
        Claim::new(claim, "1", Some(PAPER.0), course.taken(), PAPER.1)
    };
    let difference = ours.taken().zip(theirs.taken()).map(|(ours, theirs)| ours - theirs);
    let claim = "model C loses as much as the finite elements: difference in efficiency";
    let most = "most is lost in the contacts: share of the plate's modes in model C, at most 0.5";
    courses
        .iter()
        .map(two_per_cent)
        .chain([
            Claim::new(claim.into(), "1", None, difference, CLOSE),
            Claim::new(most.into(), "1", None, ours.share_of_plate(), 0.5),
        ])
        .collect()
}
