//! The choices of `auto` on the validation base: predicted against true errors. One half of each group of scenes predicts the other one.

use crate::error::Result;
use crate::evidence::study::{Cell, Claim, Note, Study};
use crate::prediction::auto::{COVERED, Judge};
use crate::prediction::held_out::{HeldOut, expected, held_out};
use crate::prediction::{error, scale};
use crate::scene::Model;
use std::collections::BTreeMap;

/// Tolerances of the study.
pub const TOLERANCES: [f64; 3] = [0.01, 0.03, 0.1];
const COLUMNS: &str = "scene, group, tolerance, model, predicted_error, true_error, met, within";
/// A reference decides where its error (95 %) is at most this share of the tolerance.
const DECISIVE: f64 = 0.5;

/// The study.
///
/// # Errors
/// None.
pub fn run(_: &mut Note) -> Result<Study> {
    let held = held_out();
    let rows: Vec<Vec<Cell>> =
        TOLERANCES.iter().flat_map(|tolerance| held.iter().map(|held| row(held, *tolerance))).collect();
    let claims = TOLERANCES.iter().map(|tolerance| claim(*tolerance, &rows)).collect();
    let description = format!(
        "The model that auto chooses of A, B (16 modes) and C on {} random scenes of the validation base, from the errors in other scenes \
         of their group. met = 1: the predicted error is within the tolerance. true_error: the largest of {} against the finite-element reference, \
         beyond the error of the reference itself; none where that is too large to decide.",
        held.len(),
        COVERED.join(", ")
    );
    Ok(Study::new("auto", description, COLUMNS, rows, claims))
}

fn row(held: &HeldOut, tolerance: f64) -> Vec<Cell> {
    let scene = held.scene;
    let exact = |name: &str| scene.of_model(Model::C, name);
    let own: BTreeMap<&'static str, f64> =
        held.quantities.iter().map(|(name, judged)| (*name, judged.half_width)).collect();
    let judge = Judge { continuum: &exact, own: &own, speed: scene.speed };
    let predicted = |model: Model| judge.largest(|name| scene.of_model(model, name)).map(|(error, _)| error);
    let meets = |model: &Model| predicted(*model).is_some_and(|error| error <= tolerance);
    let model = [Model::A, Model::B].into_iter().find(meets).unwrap_or(Model::C);
    let met = meets(&model);
    let decisive = |name: &&str| {
        error(scene, model, name).map(|(_, seen)| seen).filter(|seen| seen.noise <= DECISIVE * tolerance)
    };
    // as auto has it: nothing is relative to what is negligible
    let seen = COVERED.iter().filter(|name| scale(name, exact, scene.speed).is_some()).map(decisive);
    let off: Option<f64> =
        seen.map(|seen| Some(seen?.excess())).try_fold(0.0, |largest, error| Some(f64::max(largest, error?)));
    let within = off.filter(|_| met).map(|off| usize::from(off <= tolerance));
    vec![
        Cell::Text(&scene.scene),
        Cell::Text(&scene.stratum),
        tolerance.into(),
        Cell::Text(match model {
            Model::A => "A",
            Model::B => "B",
            Model::C => "C",
        }),
        predicted(model).into(),
        off.into(),
        usize::from(met).into(),
        within.into(),
    ]
}

fn claim(tolerance: f64, rows: &[Vec<Cell>]) -> Claim {
    let own: Vec<&Vec<Cell>> = rows.iter().filter(|row| row[2] == Cell::Number(tolerance)).collect();
    let of = |cell: usize, value: usize| own.iter().filter(|row| row[cell] == Cell::Count(value)).count();
    let simpler = own.iter().filter(|row| row[6] == Cell::Count(1) && row[3] != Cell::Text("C")).count();
    let (exceeding, decided) = (of(7, 0), of(7, 0) + of(7, 1));
    let text = format!(
        "{} %: share of choices that are not within the tolerance, of {decided} that are predicted to be and decided ({simpler} are models A or B; {} scenes)",
        100.0 * tolerance,
        own.len()
    );
    let share = |count: usize| count as f64 / decided as f64;
    let bound = if decided > 0 { share(decided - expected(decided)[0]) } else { 0.0 };
    Claim::new(text, "1", None, (decided > 0).then(|| share(exceeding)), bound)
}
