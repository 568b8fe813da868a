//! Section 4.4 with the reduced model: what decides the direction of the sphere's flight out of the flexible seal seat.
//!
//! Around both shipped designs one quantity at a time is varied: aperture angle, tilt, place of impact, notch, membrane.
//! Each geometry is meshed (coarse, the meshes stay in the cache); the paper publishes no dimensions, only what it found.

use crate::body::cache::Cache;
use crate::error::{Error, Result};
use crate::evidence::study::{Axis, Cell, Claim, Note, Only, Panel, Study, of_project};
use crate::kinds::seal_seat::{DEFAULT_TOLERANCE, SeatMesh, SeatModel, SeatQuantities};
use crate::kinds::seal_seat::{Notch, SealSeat};
use crate::reference::{self, Resolution, Store};
use crate::result::{CUT, Summary};
use crate::scene::{Model, Scene};

/// How far the improved design's direction may lie from the intended one, rad.
const INTENDED_WITHIN: f64 = 1.5 * DEGREE;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The scenes of the two designs.
const DESIGNS: [(&str, &str); 2] = [("initial", "seal-seat-initial"), ("improved", "seal-seat-improved")];

/// A design with one thing changed.
struct LaunchCase {
    design: &'static str,
    varied: &'static str,
    /// What is changed, one of [`PARAMETERS`], or [`NOTHING`].
    parameter: &'static str,
    scene: Scene,
}

/// Columns of the table with their units.
const COLUMNS: &str = "design, varied, aperture_angle [rad], tilt [rad], outermost_tip [m], notch_width [m], \
     membrane_thickness [m], sphere_angle [rad], deviation [rad], sphere_speed [m/s], efficiency, \
     sphere_force_peak [N], actuator_force_peak [N], parameter, reference_angle [rad], \
     reference_speed [m/s]";

/// In the place of a parameter: the design itself, a point of every curve.
const NOTHING: &str = "none";
const PARAMETERS: [&str; 5] = ["aperture angle", "tilt", "impact", "notch", "membrane"];

/// Deviation from the intended direction and efficiency over each parameter; shaded: what counts as the intended direction.
pub const PANELS: [Panel; 10] = {
    const APERTURE: (Axis, &[&str]) =
        (Axis::new("aperture_angle", "aperture angle γ, °", IN_DEGREES), &[NOTHING, PARAMETERS[0]]);
    const TILT: (Axis, &[&str]) = (Axis::new("tilt", "tilt α, °", IN_DEGREES), &[NOTHING, PARAMETERS[1]]);
    const IMPACT: (Axis, &[&str]) =
        (Axis::new("outermost_tip", "place of impact, mm from the centre", 1e3), &[NOTHING, PARAMETERS[2]]);
    const NOTCH: (Axis, &[&str]) =
        (Axis::new("notch_width", "width of the notch, mm (0 = none)", 1e3), &[NOTHING, PARAMETERS[3]]);
    const MEMBRANE: (Axis, &[&str]) =
        (Axis::new("membrane_thickness", "thickness of the membrane, mm", 1e3), &[NOTHING, PARAMETERS[4]]);
    [
        direction(APERTURE),
        efficiency(APERTURE),
        direction(TILT),
        efficiency(TILT),
        direction(IMPACT),
        efficiency(IMPACT),
        direction(NOTCH),
        efficiency(NOTCH),
        direction(MEMBRANE),
        efficiency(MEMBRANE),
    ]
};

const IN_DEGREES: f64 = 180.0 / std::f64::consts::PI;

const fn direction((x, texts): (Axis, &'static [&'static str])) -> Panel {
    let y = Axis::new("deviation", "direction − intended, °", IN_DEGREES);
    let band = Some((0.0, IN_DEGREES * INTENDED_WITHIN));
    Panel { only: only(texts), band, ..Panel::of(x, y).by(DESIGN) }
}

const fn efficiency((x, texts): (Axis, &'static [&'static str])) -> Panel {
    let y = Axis::new("efficiency", "efficiency, %", 100.0);
    Panel { only: only(texts), ..Panel::of(x, y).by(DESIGN) }
}

const DESIGN: Axis = Axis::new("design", "", 1.0);

const fn only(texts: &'static [&'static str]) -> Option<Only> {
    Some(Only { column: "parameter", texts })
}

impl LaunchCase {
    fn seat(&self) -> Result<&SealSeat> {
        self.scene.seal_seat()
    }
}

/// The study.
///
/// # Errors
/// [`Error::Usage`] if a shipped scene is gone, [`Error::Solver`] if a seat can't
/// be meshed or solved.
pub fn run(note: &mut Note) -> Result<Study> {
    let [initial, improved] = [of_project(DESIGNS[0].1)?, of_project(DESIGNS[1].1)?];
    let cases = cases(&initial, &improved)?;
    let cache = Cache::from_environment();
    let mut results = Vec::new();
    for (k, case) in cases.iter().enumerate() {
        note(&format!("{} of {}: {} design, {}", k + 1, cases.len(), case.design, case.varied));
        // a geometry that can't be meshed at one size perhaps can at another; if at none, its row stays empty
        let solved = solve(&case.scene, Resolution::Coarse, &cache);
        let solved = solved.or_else(|_| solve(&case.scene, Resolution::Paper, &cache));
        if let Err(error) = &solved {
            note(&format!("{} design, {}: {error}", case.design, case.varied));
        }
        results.push(solved.ok());
    }
    let corners = CORNERS.map(|corner| corner.reference(note));
    let reference = |case: &LaunchCase| {
        let corner = CORNERS.iter().position(|c| (c.design, c.varied) == (case.design, case.varied));
        corner.and_then(|k| corners[k].as_ref())
    };
    let rows = cases.iter().zip(&results);
    let rows = rows.map(|(case, result)| row(case, result.as_ref(), reference(case)));
    let rows = rows.collect::<Result<_>>()?;
    let intended = improved.seal_seat()?.intended_angle;
    let angle = |design: &str, varied: &str| {
        let case = cases.iter().position(|c| c.design == design && c.varied == varied);
        results[case?].as_ref().map(|q| q.sphere_angle)
    };
    Ok(Study::new(
        "seal-seat",
        "Section 4.4 of the paper: direction and speed of the sphere out of the flexible seal seat, model C on coarse \
             meshes, each design with one quantity changed. The paper publishes no dimensions; it finds that the \
             initial design, hit at its centre, throws the sphere to the wrong side, and that notch and hits on both \
             sides together bring the intended direction. "
            .to_owned()
            + &notch_and_impact(&angle, &corners),
        COLUMNS,
        rows,
        claims(intended, &angle),
    ))
}

/// A corner of the table of notch and impact, and the scene whose reference is asked for its verdict.
struct Corner {
    design: &'static str,
    varied: &'static str,
    scene: &'static str,
}

/// Without notch and with it, hit at the centre and on both sides.
const CORNERS: [Corner; 4] = [
    Corner { design: "initial", varied: "nothing", scene: "seal-seat-initial" },
    Corner { design: "improved", varied: "no notch", scene: "validation/seal-seat-no-notch" },
    Corner { design: "improved", varied: "hit at the centre", scene: "validation/seal-seat-notch-centre" },
    Corner { design: "improved", varied: "nothing", scene: "seal-seat-improved" },
];

impl Corner {
    /// What the stored reference says; without one it is told how to get it.
    fn reference(&self, note: &mut Note) -> Option<SeatQuantities> {
        let scene = of_project(self.scene).ok()?;
        let Some(stored) = Store::open(None).find(&scene, Resolution::Paper).found() else {
            note(&format!(
                "{} design, {}: no reference stored; `impactcheck reference scenes/{}.toml` computes it",
                self.design, self.varied, self.scene
            ));
            return None;
        };
        SeatQuantities::of_table(&stored.outcome.summary.quantities)
    }
}

/// The directions at the corners in words, and what the references say.
fn notch_and_impact(
    angle: &dyn Fn(&str, &str) -> Option<f64>,
    references: &[Option<SeatQuantities>; 4],
) -> String {
    let degrees =
        |angle: Option<f64>| angle.map_or("none stored".into(), |a| format!("{:+.1}°", a.to_degrees()));
    let corner = |k: usize| {
        let own = degrees(angle(CORNERS[k].design, CORNERS[k].varied));
        format!("{own} (reference {})", degrees(references[k].as_ref().map(|q| q.sphere_angle)))
    };
    let [centre, sides, notch_centre, notch_sides] = [0, 1, 2, 3].map(corner);
    format!(
        "Directions by notch and place of impact: no notch, at the centre {centre}; no notch, on both sides {sides}; \
         notch, at the centre {notch_centre}; notch, on both sides {notch_sides}."
    )
}

/// What the paper says of the directions, and what follows from the table of notch and impact.
fn claims(intended: f64, angle: &dyn Fn(&str, &str) -> Option<f64>) -> Vec<Claim> {
    let reached = |ours: Option<bool>| ours.map(|reached| f64::from(u8::from(reached)));
    let missed = |varied: &str, design: &str| {
        reached(angle(design, varied).map(|a| (a - intended).abs() > INTENDED_WITHIN))
    };
    vec![
        Claim::new(
            "initial design: the sphere leaves to the wrong side (1 = yes)".into(),
            "1",
            Some(1.0),
            reached(angle("initial", "nothing").map(|a| a < 0.0)),
            0.0,
        ),
        Claim::new(
            "improved design: the sphere leaves in the intended direction".into(),
            "rad",
            Some(intended),
            angle("improved", "nothing"),
            INTENDED_WITHIN,
        ),
        Claim::new(
            "notch alone, hit at the centre: misses the intended direction (1 = yes)".into(),
            "1",
            Some(1.0),
            missed("hit at the centre", "improved"),
            0.0,
        ),
        Claim::new(
            "hits on both sides alone, no notch: misses the intended direction (1 = yes)".into(),
            "1",
            Some(1.0),
            missed("no notch", "improved"),
            0.0,
        ),
    ]
}

fn cases(initial: &Scene, improved: &Scene) -> Result<Vec<LaunchCase>> {
    let mut cases = Vec::new();
    let notch = improved.seal_seat()?.seat.notch;
    for ((design, _), base) in DESIGNS.into_iter().zip([initial, improved]) {
        let bodies = base.seal_seat()?;
        let mut add = |parameter: &'static str, varied: &'static str, change: &dyn Fn(&mut SealSeat)| {
            let mut seat = bodies.clone();
            change(&mut seat);
            // without a notch its floor is no membrane: a thicker membrane than that is one of the notched design only
            if let Some(notch) = &mut seat.seat.notch {
                notch.floor = notch.floor.max(seat.seat.membrane_thickness);
            }
            let scene = Scene { setup: seat.into(), ..base.clone() };
            cases.push(LaunchCase { design, varied, parameter, scene });
        };
        let [aperture, tilt, impact, slot, membrane] = PARAMETERS;
        add(NOTHING, "nothing", &|_| {});
        add(aperture, "aperture angle -10°", &|s| s.seat.aperture_angle -= 10.0 * DEGREE);
        add(aperture, "aperture angle -5°", &|s| s.seat.aperture_angle -= 5.0 * DEGREE);
        add(aperture, "aperture angle +5°", &|s| s.seat.aperture_angle += 5.0 * DEGREE);
        add(aperture, "aperture angle +10°", &|s| s.seat.aperture_angle += 10.0 * DEGREE);
        add(tilt, "tilt -5°", &|s| s.seat.tilt -= 5.0 * DEGREE);
        add(tilt, "tilt -2.5°", &|s| s.seat.tilt -= 2.5 * DEGREE);
        add(tilt, "tilt +2.5°", &|s| s.seat.tilt += 2.5 * DEGREE);
        add(tilt, "tilt +5°", &|s| s.seat.tilt += 5.0 * DEGREE);
        add(membrane, "membrane -20 %", &|s| s.seat.membrane_thickness *= 0.8);
        add(membrane, "membrane +20 %", &|s| s.seat.membrane_thickness *= 1.2);
        if design == "initial" {
            add(impact, "hit at half the island", &|s| at(s, 0.25));
            add(impact, "hit on both sides", &|s| at(s, 0.45));
            add(slot, "notch", &|s| s.seat.notch = notch);
        } else {
            add(impact, "hit at the centre", &|s| s.actuator.tip_positions = vec![0.0]);
            add(impact, "hit at half the island", &|s| at(s, 0.25));
            add(slot, "no notch", &|s| s.seat.notch = None);
            add(slot, "notch half as wide", &|s| widen(s, 0.5));
            add(slot, "notch half as wide again", &|s| widen(s, 1.5));
        }
    }
    Ok(cases)
}

/// Two tips at this share of the island's length to either side of its centre.
fn at(scene: &mut SealSeat, share: f64) {
    let x = share * scene.seat.island_length;
    scene.actuator.tip_positions = vec![-x, x];
}

fn widen(scene: &mut SealSeat, factor: f64) {
    scene.seat.notch = scene.seat.notch.map(|notch| Notch { width: factor * notch.width, ..notch });
}

fn solve(scene: &Scene, resolution: Resolution, cache: &Cache) -> Result<SeatQuantities> {
    let mesh = SeatMesh::open(&reference::seat_mesh(scene, resolution, cache)?)?;
    let model = SeatModel::new(scene, Model::C, None, &mesh, cache)?;
    determined(&model.run(DEFAULT_TOLERANCE)?)
}

/// The results of a run.
///
/// # Errors
/// [`Error::Solver`] if it was cut during a contact.
pub(super) fn determined(summary: &Summary) -> Result<SeatQuantities> {
    SeatQuantities::of_table(&summary.quantities)
        .ok_or_else(|| Error::Solver(format!("{}: {CUT}", summary.scene)))
}

fn row(
    case: &LaunchCase,
    result: Option<&SeatQuantities>,
    reference: Option<&SeatQuantities>,
) -> Result<Vec<Cell>> {
    let scene = case.seat()?;
    let outermost = scene.actuator.tip_positions.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let geometry = [
        scene.seat.aperture_angle,
        scene.seat.tilt,
        outermost,
        scene.seat.notch.map_or(0.0, |notch| notch.width),
        scene.seat.membrane_thickness,
    ];
    let found: [fn(&SeatQuantities) -> f64; 5] = [
        |q| q.sphere_angle,
        |q| q.sphere_speed,
        |q| q.efficiency,
        |q| q.sphere_force_peak,
        |q| q.actuator_force_peak,
    ];
    let mut row = vec![Cell::Text(case.design), Cell::Text(case.varied)];
    row.extend(geometry.map(Cell::Number));
    row.extend(found.map(|value| Cell::from(result.map(value))));
    row.insert(8, result.map(|q| q.sphere_angle - scene.intended_angle).into());
    row.push(Cell::Text(case.parameter));
    row.push(reference.map(|q| q.sphere_angle).into());
    row.push(reference.map(|q| q.sphere_speed).into());
    Ok(row)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::study::figure;

    /// The study's table as [`run`] makes it, without solving anything.
    fn unsolved() -> Study {
        let [initial, improved] = DESIGNS.map(|(_, name)| of_project(name).expect("scene"));
        let cases = cases(&initial, &improved).expect("cases");
        let found = SeatQuantities {
            efficiency: 0.1,
            sphere_velocity_x: 0.0,
            sphere_velocity_z: 1.0,
            sphere_speed: 1.0,
            sphere_angle: 0.2,
            sphere_force_peak: 5.0,
            actuator_force_peak: 20.0,
            actuator_velocity_final: -0.5,
            sphere_contact_end: 1e-4,
            actuator_contact_end: 2e-4,
            left_flank_impulse: 1e-4,
            right_flank_impulse: 1e-4,
            first_frequency: 4e3,
        };
        let rows = cases.iter().map(|case| row(case, Some(&found), None).expect("row")).collect();
        Study::new("seal-seat", "", COLUMNS, rows, Vec::new())
    }

    #[test]
    fn every_case_is_a_scene_of_its_own_that_could_be_written() {
        let study = unsolved();
        assert!(study.rows.iter().all(|row| row.len() == study.columns.len()));
        for (k, row) in study.rows.iter().enumerate() {
            assert!(study.rows[..k].iter().all(|other| other[..2] != row[..2]), "{:?}", &row[..2]);
        }
        for corner in &CORNERS {
            let there = |row: &&Vec<Cell>| row[..2] == [Cell::Text(corner.design), Cell::Text(corner.varied)];
            assert_eq!(study.rows.iter().filter(there).count(), 1, "{}", corner.varied);
        }
    }

    #[test]
    fn each_parameter_is_drawn_around_both_designs() {
        let study = unsolved();
        let svg = figure(&study, &PANELS).expect("figure");
        let labels = PANELS.iter().flat_map(|panel| [panel.x.label, panel.y.label]);
        let named: Vec<_> = labels.chain(DESIGNS.map(|(design, _)| design)).collect();
        assert!(named.iter().all(|name| svg.contains(name)), "{named:?}");
        for parameter in PARAMETERS {
            let varied = study.rows.iter().filter(|row| row[13] == Cell::Text(parameter)).count();
            assert!(varied >= 3, "{parameter}: {varied}");
        }
    }
}
