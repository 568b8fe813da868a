//! How far a reduced model of a scene without a reference can be trusted: intervals that hold what a reference would find.
//!
//! They come from the errors of model C in similar scenes of the validation base. Models A and B are judged by model C of the same
//! scene: what they differ by is known.

mod base;
mod conformal;

pub use base::{SolvedScene, solved};
pub use conformal::{ErrorScale, SeenError};

use crate::format::{prefixed, with_unit};
use crate::kinds::{self, Place};
use crate::result::{Quantity, Summary};
use crate::scene::Scene;
use serde::Serialize;
use std::collections::BTreeMap;

/// Share of intervals that hold the reference's value.
pub const LEVEL: f64 = 0.95;
/// Fewest scenes that intervals come from.
pub const FEWEST: usize = 30;
/// Efficiency, and force over that of the other contact, below which a part of an impact is negligible: as the bands of references have it.
const MINOR: f64 = 0.05;
/// End of the names of velocities.
const VELOCITY: &str = "_velocity_final";
/// Digits shown of an interval.
const DIGITS: usize = 4;
/// Widest band over the scale with which a reference determines a quantity.
const DETERMINED: f64 = 0.05;
/// What a reference would find of a quantity.
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

impl Interval {
    /// Both values with the same prefix of `unit`.
    pub fn shown(&self, unit: &str) -> [String; 2] {
        let to = prefixed(unit, self.low.abs().max(self.high.abs()));
        [self.low, self.high].map(|value| with_unit(value, to, DIGITS))
    }
}

/// Intervals by quantity, or why there are none.
pub type Prediction = Result<BTreeMap<&'static str, Interval>, String>;

/// What a reference of `scene` would find, where model C, as it is by default, has the summary `continuum`.
///
/// # Errors
/// A sentence where the scene is unlike those of the base.
pub fn predict(scene: &Scene, continuum: &Summary) -> Prediction {
    let similar = Similar::of(scene)?;
    let kind = kinds::of(scene);
    let place = kind.place(scene, continuum).ok_or("the contact radius is not known")?;
    for (k, (name, own)) in kinds::MEASURES.into_iter().zip(place.measures()).enumerate() {
        similar.require_within(name, own, |other| Some(other.place?.measures()[k]))?;
    }
    let speed = kind.approach(scene).map_err(|error| error.to_string())?.outer_speed;
    let interval = |quantity: &Quantity| {
        let value = quantity.value?;
        let errors = errors(&similar.scenes, quantity.name);
        let scenes = errors.len();
        let error = ErrorScale::new(&errors, LEVEL).filter(|_| scenes >= FEWEST)?;
        let scale = scale(quantity.name, |name| continuum.value(name), speed)?;
        let half = error.half_width(&coordinates(&place)) * scale;
        // a velocity may change its sign
        let least = if quantity.name.ends_with(VELOCITY) { f64::NEG_INFINITY } else { 0.0 };
        let (low, high) = ((value - half).max(least), value + half);
        Some((quantity.name, Interval { low, high, level: LEVEL, scenes, stratum: similar.stratum }))
    };
    Ok(continuum.quantities.iter().filter_map(interval).collect())
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
        let kind = kinds::of(scene);
        let (stratum, hash) = (kind.stratum(scene)?, scene.hash());
        let scenes: Vec<&SolvedScene> =
            solved().iter().filter(|other| other.stratum == stratum && other.hash != hash).collect();
        if scenes.len() < FEWEST {
            return Err(format!(
                "the validation base has {} scenes of the group `{stratum}`; {FEWEST} are needed",
                scenes.len()
            ));
        }
        let found = Self { stratum, scenes };
        for (name, own) in kind.proportions(scene) {
            found.require_within(name, own, |other| other.proportions.get(name).copied())?;
        }
        Ok(found)
    }

    /// Refuses a number that lies beyond those of all scenes.
    fn require_within(
        &self,
        name: &str,
        own: f64,
        of: impl Fn(&SolvedScene) -> Option<f64>,
    ) -> Result<(), String> {
        let known = self.scenes.iter().filter_map(|other| of(other));
        let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (v.min(l), v.max(h)));
        match (low..=high).contains(&own) {
            true => Ok(()),
            false => Err(format!(
                "the scene lies beyond the validation base: {name} is {own:.3}, there it is {low:.3} to {high:.3}"
            )),
        }
    }
}

/// Errors of model C in `scenes`, relative to [`scale`]; without those that the reference does not determine.
pub fn errors(scenes: &[&SolvedScene], quantity: &str) -> Vec<SeenError> {
    let error = |scene: &&SolvedScene| {
        let [model, reference] = scene.values(quantity)?;
        let of_model = |name: &str| scene.values(name).map(|[model, _]| model);
        let scale = scale(quantity, of_model, scene.speed)?;
        let band = (*scene.bands.get(quantity)?)? / scale;
        let error = (model - reference).abs() / scale;
        Some(SeenError { place: coordinates(&scene.place?), error }).filter(|_| band <= DETERMINED)
    };
    scenes.iter().filter_map(error).collect()
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
        _ if quantity.ends_with(VELOCITY) => speed,
        _ => own,
    })
}
