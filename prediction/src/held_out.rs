//! How true the intervals are: scenes of the base are predicted by others of their group. In a large group one half predicts the other
//! one, both ways; in a small one each scene is predicted by all others.

use super::base::{SolvedScene, finer, solved};
use super::conformal::{ErrorScale, SeenError};
use super::{FEWEST, LEVEL, error, errors};
use impactcheck_physics::scene::Model;
use std::collections::{BTreeMap, BTreeSet};

/// Fewest scenes of a group that is halved: a prediction needs [`FEWEST`] values, which not every reference determines.
pub const HALVED: usize = 4 * FEWEST;

/// A quantity of a solved scene, with the interval that other scenes of its group give it.
#[derive(Debug, Clone)]
pub struct JudgedValue {
    /// Half width of the interval of model C, relative as [`super::scale`] has it.
    pub half_width: f64,
    /// Signed error of model C.
    pub signed: f64,
    /// Its magnitude.
    pub seen: SeenError,
}

impl JudgedValue {
    /// Whether the interval holds the reference's value, the error of that added.
    pub fn is_within(&self) -> bool {
        self.seen.is_within(self.half_width)
    }
}

/// A solved scene with its quantities that other scenes of its group predict.
#[derive(Debug)]
pub struct HeldOut {
    /// The scene.
    pub scene: &'static SolvedScene,
    /// By name.
    pub quantities: BTreeMap<&'static str, JudgedValue>,
}

impl HeldOut {
    /// The same intervals, judged by the reference on finer meshes; `None` of a scene that was not drawn for it.
    pub fn on_finer_meshes(&self) -> Option<Self> {
        let finer = self.scene.with_finer(finer().iter().find(|finer| finer.hash == self.scene.hash)?);
        let judged = |(name, known): (&&'static str, &JudgedValue)| {
            let (signed, seen) = error(&finer, Model::C, name)?;
            Some((*name, JudgedValue { signed, seen, ..*known }))
        };
        Some(Self { scene: self.scene, quantities: self.quantities.iter().filter_map(judged).collect() })
    }
}

/// The groups of the base with solved scenes.
pub fn strata() -> BTreeSet<&'static str> {
    solved().iter().map(|scene| scene.stratum.as_str()).collect()
}

/// The scenes of all groups that are large enough for predictions.
pub fn held_out() -> Vec<HeldOut> {
    strata().into_iter().flat_map(of_stratum).collect()
}

fn of_stratum(stratum: &str) -> Vec<HeldOut> {
    let mut all: Vec<&'static SolvedScene> =
        solved().iter().filter(|scene| scene.stratum == stratum).collect();
    // the order of the drawn scenes would part their edges
    all.sort_by(|a, b| a.hash.cmp(&b.hash));
    let parts = match all.len() {
        count if count < FEWEST => return Vec::new(),
        count if count < HALVED => count,
        _ => 2,
    };
    (0..parts).flat_map(|part| predicted_by_others(&all, parts, part)).collect()
}

/// Every `parts`th scene from number `part` on, predicted by the others.
fn predicted_by_others(all: &[&'static SolvedScene], parts: usize, part: usize) -> Vec<HeldOut> {
    let others = all.iter().enumerate().filter(|(number, _)| number % parts != part);
    let others: Vec<&SolvedScene> = others.map(|(_, scene)| *scene).collect();
    let own = all.iter().skip(part).step_by(parts);
    let mut found: Vec<HeldOut> = own.map(|scene| HeldOut { scene, quantities: BTreeMap::new() }).collect();
    for quantity in quantities(all) {
        let known = errors(&others, quantity);
        let Some(calibrated) = ErrorScale::new(&known) else { continue };
        for held in &mut found {
            let Some((signed, seen)) = error(held.scene, Model::C, quantity) else { continue };
            let half_width = calibrated.half_width(&seen.place);
            held.quantities.insert(quantity, JudgedValue { half_width, signed, seen });
        }
    }
    found
}

/// Names of the quantities of `scenes`.
pub fn quantities(scenes: &[&'static SolvedScene]) -> BTreeSet<&'static str> {
    scenes.iter().flat_map(|scene| scene.values.keys().map(String::as_str)).collect()
}

/// Smallest and largest number of values within their interval out of `count`, in 95 of 100 cases at the stated level.
pub fn expected(count: usize) -> [usize; 2] {
    let chances = binomial(count, LEVEL);
    let mut tail = 0.0;
    let low = chances.iter().position(|chance| {
        tail += chance;
        tail > 0.025
    });
    let mut tail = 0.0;
    let high = chances.iter().rposition(|chance| {
        tail += chance;
        tail > 0.025
    });
    [low.unwrap_or(0), high.unwrap_or(count)]
}

/// Probability of each number of successes. Shape (count + 1).
fn binomial(count: usize, probability: f64) -> Vec<f64> {
    let mut chances = vec![1.0];
    for _ in 0..count {
        let mut next = vec![0.0; chances.len() + 1];
        for (k, chance) in chances.iter().enumerate() {
            next[k] += chance * (1.0 - probability);
            next[k + 1] += chance * probability;
        }
        chances = next;
    }
    chances
}

#[cfg(test)]
mod tests {
    use super::expected;

    /// Tables of the binomial distribution: P(X <= 17 of 20) = 0.0755, P(X <= 16) = 0.0159; P(20) = 0.358.
    #[test]
    fn counts_are_those_of_the_binomial_distribution() {
        assert_eq!(expected(20), [17, 20]);
        // mean 95, standard deviation 2.18
        assert_eq!(expected(100), [90, 99]);
    }
}
