//! What the validations of a model say of a scene that lies among them.

use super::{Place, Validation};

/// Factor up to which each of the numbers may differ of scenes that are near by.
pub const NEAR: f64 = 2.0;

/// The validations of one model seen from one scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Vicinity<'a> {
    /// Other scenes near by, the nearest first.
    pub near: Vec<&'a Validation>,
    /// The nearest of all others.
    pub nearest: &'a Validation,
    /// Factor by which it is away.
    pub factor: f64,
    /// Numbers beyond those of all others: place in [`super::MEASURES`], own value, and the nearest one validated.
    pub beyond: Vec<(usize, f64, f64)>,
}

impl<'a> Vicinity<'a> {
    /// Of the scene with `scene_hash` at `place`, for `model`; a scene is no evidence of itself, nor of a film if it has none.
    /// `None` if there are no others.
    pub fn of(validations: &'a [Validation], model: &str, scene_hash: &str, place: &Place) -> Option<Self> {
        let others = validations.iter().filter(|v| v.model == model && v.scene_hash != scene_hash);
        let mut others: Vec<(f64, Place, &Validation)> =
            others.filter_map(|v| v.place.map(|other| (place.factor(&other), other, v))).collect();
        others.retain(|(factor, ..)| factor.is_finite());
        others.sort_by(|a, b| a.0.total_cmp(&b.0));
        let &(factor, _, nearest) = others.first()?;
        let near = others.iter().take_while(|(factor, ..)| *factor <= NEAR).map(|(.., v)| *v).collect();
        let beyond = place.measures().into_iter().enumerate().filter_map(|(k, own)| {
            let known = others.iter().map(|(_, other, _)| other.measures()[k]);
            let (low, high) = known.fold((f64::INFINITY, 0.0), |(l, h), v| (v.min(l), v.max(h)));
            let end = own.clamp(low, high);
            (end != own).then_some((k, own, end))
        });
        Some(Vicinity { near, nearest, factor, beyond: beyond.collect() })
    }
}
