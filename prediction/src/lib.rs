//! How far a reduced model of a scene without a reference can be trusted: intervals that hold what a converged reference would find.
//!
//! They come from the errors of model C in similar scenes of the validation base. Models A and B are judged by model C of the same
//! scene: what they differ by is known.

#![warn(missing_docs)]

pub mod auto;
mod base;
mod conformal;
pub mod held_out;
mod kinds;
mod similarity;

pub use base::{FinerScene, RefusedScene, SolvedScene, finer, refused, solved};
pub use conformal::{ErrorScale, Place, SeenError};
pub use kinds::stokes_number;
pub use similarity::{MEASURES, Similarity};

use impactcheck_physics::result::Summary;
use impactcheck_physics::scene::{Model, Scene};
use serde::Serialize;
use similarity::FILM_ERROR;
use std::borrow::Borrow;
use std::collections::BTreeMap;

/// Share of intervals that hold the reference's value.
pub const LEVEL: f64 = 0.95;
/// Fewest scenes that intervals come from.
pub const FEWEST: usize = 30;
/// Scenes whose distance at an end of the base's range is that by which a scene may lie beyond it: random numbers never reach their bounds,
/// where a designer's often are.
const NEIGHBOURS: usize = 2;
/// Efficiency, and inner force over the outer one, below which a part of an impact is negligible.
const MINOR: f64 = 0.05;
/// End of the names of velocities.
const VELOCITY: &str = "_velocity_final";
/// Begin of the names of a sphere's velocities, and end of those of directions.
const COMPONENT: &str = "sphere_velocity";
const ANGLE: &str = "_angle";
/// End of the names of what is not predicted: spins follow from the velocities along the surface.
const SPIN: &str = "_spin_final";
/// End of the names of restitutions.
const RESTITUTION: &str = "_restitution";
/// Widest band over the scale with which a reference determines a quantity.
const DETERMINED: f64 = 0.05;
/// Half width of the errors of the base's references at [`LEVEL`], over their stated band: 0.49 against meshes with 1.5 times the elements in
/// every direction (`validation/finer.py`), 0.46 without the error of these. Too small a value makes intervals wider than need be, too
/// large a one too narrow.
const NOISE: f64 = 0.45;
/// A quantity that the omitted modes do not change.
const OF_ALL_MODES: &str = "first_frequency";

/// What a converged reference would find of a quantity on infinitely fine meshes.
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

/// What a reference of `scene` would find, where model C, as it is by default, has the summary `continuum`.
///
/// # Errors
/// A sentence where the scene is unlike those of the base.
pub fn predict(scene: &Scene, continuum: &Summary) -> Prediction {
    let similar = Similar::of(scene)?;
    let (stratum, speed) = (similar.stratum, impact_speed(scene));
    let errors = similar.half_widths(scene, continuum)?;
    let interval = |(name, value): (&'static str, f64)| {
        let &(error, scenes) = errors.get(name)?;
        let half = error * scale(name, |name| value_of(continuum, name), speed)?;
        // velocities and directions have a sign
        let is_signed = name.contains("_velocity_") || name.ends_with(ANGLE);
        let least = if is_signed { f64::NEG_INFINITY } else { 0.0 };
        let (low, high) = ((value - half).max(least), value + half);
        Some((name, Interval { low, high, level: LEVEL, scenes, stratum }))
    };
    Ok(values(continuum).filter_map(interval).collect())
}

/// What is known of a result: its quantities, velocities along the surfaces, spins.
fn values(summary: &Summary) -> impl Iterator<Item = (&'static str, f64)> + use<'_> {
    let quantities = summary.quantities.iter().filter_map(|quantity| Some((quantity.name, quantity.value?)));
    quantities.chain(summary.motion().map(|(name, value, _)| (name, value)))
}

/// The value of that name.
fn value_of(summary: &Summary, name: &str) -> Option<f64> {
    values(summary).find(|(known, _)| *known == name).map(|(_, value)| value)
}

/// What a reference of `scene` would find, of which a model has the `summary`. Model C runs by `run` for it as it is by default, unless the
/// summary `is_continuum`: its own.
///
/// # Errors
/// As [`predict`], and where model C does not run.
pub fn predict_of_any(
    scene: &Scene,
    (summary, is_continuum): (&Summary, bool),
    run: impl FnOnce(&Scene) -> impactcheck_physics::Result<Summary>,
) -> Prediction {
    // before model C costs anything
    Similar::of(scene)?;
    if is_continuum {
        return predict(scene, summary);
    }
    let mut scene = scene.clone();
    scene.reduced.modes = None;
    let continuum = run(&scene).map_err(|error| format!("model C does not run: {error}"))?;
    predict(&scene, &continuum)
}

/// Half widths of the intervals of [`predict`], relative to [`scale`], by quantity.
///
/// # Errors
/// As [`predict`].
pub fn predicted_errors(scene: &Scene, continuum: &Summary) -> Result<BTreeMap<&'static str, f64>, String> {
    let errors = Similar::of(scene)?.half_widths(scene, continuum)?;
    Ok(errors.into_iter().map(|(name, (error, _))| (name, error)).collect())
}

/// Speed of the outer body, m/s; NaN of kinds whose quantities have no scale of it.
pub fn impact_speed(scene: &Scene) -> f64 {
    kinds::of(scene).map_or(f64::NAN, |kind| kind.speed(scene))
}

/// Scenes of the base that are of the same group as another one.
#[derive(Debug)]
pub struct Similar {
    stratum: &'static str,
    scenes: Vec<&'static SolvedScene>,
}

impl Similar {
    /// To `scene`, which is not among them.
    ///
    /// # Errors
    /// A sentence: there are too few, or the scene's own numbers lie beyond theirs.
    pub fn of(scene: &Scene) -> Result<Self, String> {
        let kind = kinds::of(scene)?;
        let (stratum, hash) = (kind.stratum(scene)?, scene.hash());
        let scenes: Vec<&SolvedScene> = solved()
            .iter()
            .filter(|other| other.stratum == stratum && !hash.starts_with(&other.hash))
            .collect();
        if scenes.len() < FEWEST {
            return Err(format!(
                "the validation base has {} scenes of the group `{stratum}`; {FEWEST} are needed",
                scenes.len()
            ));
        }
        let found = Self { stratum, scenes };
        for (name, own) in kind.numbers(scene) {
            found.require_within(name, own, |other| other.numbers.get(name).copied())?;
        }
        Ok(found)
    }

    /// Half widths of intervals by quantity, relative to [`scale`], and how many scenes each comes from.
    fn half_widths(
        &self,
        scene: &Scene,
        continuum: &Summary,
    ) -> Result<BTreeMap<&'static str, (f64, usize)>, String> {
        let own = Similarity::of(scene, continuum)?;
        for (name, value) in &own.results {
            self.require_within(name, *value, |other| other.results.get(*name).copied())?;
        }
        let stated =
            continuum.truncation_error.ok_or("the result does not state the error of the omitted modes")?;
        // independent of the errors of the base, whose results have converged
        let unconverged = continuum.integration_error.unwrap_or(0.0);
        let half_width = |(name, _): (&'static str, f64)| {
            let scale = scale(name, |name| value_of(continuum, name), impact_speed(scene))?;
            let place = place(&own.results, &own.numbers, (name, scale), stated);
            let errors = errors(&self.scenes, name);
            let error = ErrorScale::new(&errors).filter(|_| errors.len() >= FEWEST)?;
            let own = if name == OF_ALL_MODES { 0.0 } else { unconverged };
            Some((name, (error.half_width(&place).hypot(own), errors.len())))
        };
        let found: BTreeMap<_, _> = values(continuum).filter_map(half_width).collect();
        match found.is_empty() {
            true => Err(format!("too few references of the group `{}` determine their values", self.stratum)),
            false => Ok(found),
        }
    }

    /// Refuses a number that lies beyond those of all scenes, by more than the next [`NEIGHBOURS`] at that end lie apart.
    fn require_within(
        &self,
        name: &str,
        own: f64,
        of: impl Fn(&SolvedScene) -> Option<f64>,
    ) -> Result<(), String> {
        let mut known: Vec<f64> = self.scenes.iter().filter_map(|other| of(other)).collect();
        known.sort_by(f64::total_cmp);
        let ends = known.first().zip(known.last());
        let near = known.get(NEIGHBOURS).zip(known.iter().rev().nth(NEIGHBOURS));
        let (Some((low, high)), Some((lower, upper))) = (ends, near) else {
            return Err(format!("too few scenes of the validation base have a {name}"));
        };
        match (2.0 * low - lower..=2.0 * high - upper).contains(&own) {
            true => Ok(()),
            false => Err(format!(
                "the scene lies beyond the validation base: {name} is {own:.3}, there it is {low:.3} to {high:.3}"
            )),
        }
    }
}

/// Errors of model C in `scenes`, relative to [`scale`]; without those that the reference does not determine.
pub fn errors(scenes: &[&SolvedScene], quantity: &str) -> Vec<SeenError> {
    scenes.iter().filter_map(|scene| error(scene, Model::C, quantity)).map(|(_, error)| error).collect()
}

/// Signed error of `model` in a solved scene and its magnitude, relative to [`scale`]; `None` where the reference does not determine it.
pub fn error(scene: &SolvedScene, model: Model, quantity: &str) -> Option<(f64, SeenError)> {
    let values = scene.values.get(quantity)?;
    let scale = scale(quantity, |name| scene.of_model(Model::C, name), scene.speed).filter(|s| *s > 0.0)?;
    let band = values.band? / scale;
    let signed = (scene.of_model(model, quantity)? - values.reference?) / scale;
    let place = place(&scene.results, &scene.numbers, (quantity, scale), scene.truncation);
    let is_known = !place.coordinates.is_empty() && scene.unsound.is_empty();
    let seen = SeenError { place, error: signed.abs(), noise: NOISE * band };
    (is_known && band <= DETERMINED).then_some((signed, seen))
}

/// Where a scene lies: the logarithms of the numbers of its result, or its own numbers if the result has none; with the errors that the
/// result states of a `quantity` with its [`scale`]: of the omitted modes and of the film.
fn place<Name: Ord + Borrow<str>>(
    results: &BTreeMap<Name, f64>,
    numbers: &BTreeMap<Name, f64>,
    (quantity, scale): (&str, f64),
    truncation: f64,
) -> Place {
    let mut coordinates: Vec<f64> = results.values().map(|value| value.ln()).collect();
    if coordinates.is_empty() {
        coordinates = numbers.values().copied().collect();
    }
    let film = results.get(FILM_ERROR).copied().unwrap_or(0.0);
    let stated = match quantity {
        OF_ALL_MODES => 0.0,
        "efficiency" => truncation + film / scale,
        _ => truncation + film,
    };
    Place { coordinates, stated }
}

/// What the error of a quantity is relative to, by the values of a result and the `speed` of its impact in m/s: the quantity itself;
/// of a velocity the speed, of a direction 1 rad, of a restitution 1; of a negligible efficiency what is not negligible. `None` of a
/// negligible inner force and of spins: nothing is predicted of them.
pub fn scale(quantity: &str, value: impl Fn(&str) -> Option<f64>, speed: f64) -> Option<f64> {
    let own = value(quantity)?.abs();
    if quantity.ends_with(SPIN) {
        return None;
    }
    Some(match quantity {
        "efficiency" => own.max(MINOR),
        "inner_force_peak" => {
            Some(own).filter(|own| *own >= MINOR * value("outer_force_peak").unwrap_or(0.0))?
        }
        _ if quantity.ends_with(VELOCITY) => Some(speed).filter(|speed| speed.is_finite())?,
        _ if quantity.ends_with(RESTITUTION) => 1.0,
        _ if quantity.starts_with(COMPONENT) => value("sphere_speed")?,
        _ if quantity.ends_with(ANGLE) => 1.0,
        _ => own,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_lies_as_far_beyond_the_base_as_the_next_scenes_are_apart() {
        let dry = || solved().iter().filter(|scene| scene.stratum == "dry");
        let found = Similar { stratum: "dry", scenes: dry().collect() };
        let mut speeds: Vec<f64> = dry().map(|scene| scene.speed).collect();
        speeds.sort_by(f64::total_cmp);
        let within = |speed: f64| found.require_within("speed", speed, |scene| Some(scene.speed)).is_ok();
        let (low, apart) = (speeds[0], speeds[NEIGHBOURS] - speeds[0]);
        assert!(within(low) && within(low - 0.9 * apart) && !within(low - 1.1 * apart));
    }
}
