//! How far a reduced model of a scene without a reference can be trusted: intervals that hold what a reference would say.
//!
//! They come from the errors of model C in similar scenes of the validation base. Models A and B are judged by model C of the same
//! scene: what they differ by is known.

mod base;
mod conformal;

pub use base::{SolvedScene, solved};
pub use conformal::{ErrorScale, SeenError};

use crate::kinds::{self, Place};
use crate::result::Summary;
use crate::scene::Scene;
use serde::Serialize;
use std::collections::BTreeMap;

/// Share of intervals that hold the reference's value.
pub const LEVEL: f64 = 0.95;
/// Fewest scenes that intervals come from.
pub const FEWEST: usize = 30;
/// Efficiency, and force over that of the other contact, below which a part of an impact is negligible: as the bands of references have it.
const MINOR: f64 = 0.05;
/// Widest band over the scale with which a reference determines a quantity.
const DETERMINED: f64 = 0.05;
/// Quantities with intervals.
pub const QUANTITIES: [&str; 8] = [
    "efficiency",
    "outer_velocity_final",
    "inner_velocity_final",
    "outer_force_peak",
    "inner_force_peak",
    "outer_contact_end",
    "inner_contact_end",
    "first_frequency",
];

/// What a reference would say of a quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Interval {
    /// Least value, SI.
    pub low: f64,
    /// Largest value, SI.
    pub high: f64,
    /// Probability that it holds the reference's value.
    pub level: f64,
    /// Scenes of the base that it comes from.
    pub scenes: usize,
    /// What they have in common.
    pub stratum: &'static str,
}

/// Intervals by quantity, or why there are none.
pub type Prediction = Result<BTreeMap<&'static str, Interval>, String>;

/// What a reference of `scene` would say, where model C has the summary `continuum`.
///
/// # Errors
/// A sentence where the scene is unlike those of the base.
pub fn predict(scene: &Scene, continuum: &Summary) -> Prediction {
    let kind = kinds::of(scene);
    let stratum = kind.stratum(scene)?;
    let place = kind.place(scene, continuum).ok_or("the contact radius is not known")?;
    let others: Vec<&SolvedScene> = solved()
        .iter()
        .filter(|other| other.stratum == stratum && Some(other.hash.as_str()) != Some(&continuum.scene_hash))
        .collect();
    within(&others, &place, &kind.proportions(scene))?;
    let speed = kind.approach(scene).map_err(|error| error.to_string())?.outer_speed;
    let mut found = BTreeMap::new();
    for quantity in QUANTITIES {
        let Some(value) = continuum.value(quantity) else { continue };
        let cases = cases(&others, quantity);
        let Some(calibrated) = ErrorScale::new(&cases, LEVEL).filter(|_| cases.len() >= FEWEST) else {
            continue;
        };
        let scale = scale(quantity, |name| continuum.value(name), speed).unwrap_or(0.0);
        let half = calibrated.half_width(&coordinates(&place)) * scale;
        // what cannot be negative is not
        let least =
            if value >= 0.0 && !quantity.ends_with("_velocity_final") { 0.0 } else { f64::NEG_INFINITY };
        let (low, high, scenes) = ((value - half).max(least), value + half, cases.len());
        found.insert(quantity, Interval { low, high, level: LEVEL, scenes, stratum });
    }
    match found.is_empty() {
        true => Err(format!(
            "the validation base has {} scenes of the group `{stratum}`; {FEWEST} are needed",
            others.len()
        )),
        false => Ok(found),
    }
}

/// Errors of model C in `scenes`, relative to [`scale`]; without those that the reference does not determine.
pub fn cases(scenes: &[&SolvedScene], quantity: &str) -> Vec<SeenError> {
    let case = |scene: &&SolvedScene| {
        let [model, reference] = scene.values(quantity)?;
        let of_model = |name: &str| scene.values(name).map(|[model, _]| model);
        let scale = scale(quantity, of_model, scene.speed)?;
        let band = (*scene.bands.get(quantity)?)? / scale;
        let error = (model - reference).abs() / scale;
        Some(SeenError { place: coordinates(&scene.place?), error }).filter(|_| band <= DETERMINED)
    };
    scenes.iter().filter_map(case).collect()
}

/// Where a scene lies, for neighbours: the logarithms of its numbers.
pub fn coordinates(place: &Place) -> Vec<f64> {
    place.measures().into_iter().chain(place.stokes_number).map(f64::ln).collect()
}

/// What the error of a quantity is relative to, by the values of a result and the `speed` of its impact in m/s: the quantity itself;
/// of a velocity the speed; of an efficiency and a force that are negligible what is not.
pub fn scale(quantity: &str, value: impl Fn(&str) -> Option<f64>, speed: f64) -> Option<f64> {
    let own = value(quantity)?.abs();
    Some(match quantity {
        "efficiency" => own.max(MINOR),
        "inner_force_peak" => own.max(MINOR * value("outer_force_peak")?),
        _ if quantity.ends_with("_velocity_final") => speed,
        _ => own,
    })
}

/// Whether numbers lie within those of `others`.
///
/// # Errors
/// A sentence that names the first one that does not.
fn within(others: &[&SolvedScene], place: &Place, proportions: &[(&'static str, f64)]) -> Result<(), String> {
    let measures = kinds::MEASURES.into_iter().zip(place.measures()).enumerate();
    let of_place = measures.map(|(k, (name, own))| {
        let known = others.iter().filter_map(|other| Some(other.place?.measures()[k]));
        (name, own, known.collect::<Vec<f64>>())
    });
    let of_scene = proportions.iter().map(|(name, own)| {
        let known = others.iter().filter_map(|other| other.proportions.get(*name).copied());
        (*name, *own, known.collect())
    });
    for (name, own, known) in of_place.chain(of_scene) {
        let low = known.iter().copied().fold(f64::INFINITY, f64::min);
        let high = known.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if !known.is_empty() && !(low..=high).contains(&own) {
            return Err(format!(
                "the scene lies beyond the validation base: {name} is {own:.3}, there it is {low:.3} to {high:.3}"
            ));
        }
    }
    Ok(())
}
