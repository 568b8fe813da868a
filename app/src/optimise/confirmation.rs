//! Whether the model that is right about the continuum finds the same optimum.

use super::{Neighbourhood, Optimum, Problem};
use crate::error::Result;
use crate::scene::Model;
use rayon::prelude::*;
use serde::Serialize;

/// Points with less than this share of the best efficiency are no rivals of the optimum.
const RIVAL: f64 = 0.9;
/// Relative loss of efficiency at the optimum, against a rival, up to which the optimum stands.
const LOSS: f64 = 0.01;

/// The optimum and its rivals (bounds and other peaks of the profiles) by model C.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Confirmation {
    /// Efficiency by model C where the searching model has its optimum.
    pub efficiency: f64,
    /// The best rival by model C; `None` if there is none.
    pub rival: Option<Rival>,
    /// Whether no rival is better by more than 1 %.
    pub confirmed: bool,
}

/// A point besides the optimum, of one variable, the others being at theirs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rival {
    /// Name of the field or fields.
    pub field: String,
    /// SI unit.
    pub unit: &'static str,
    /// Value.
    pub value: f64,
    /// Efficiency by the searching model.
    pub searched: f64,
    /// Efficiency by model C.
    pub efficiency: f64,
}

/// Runs model C at the optimum and its rivals; `None` if C itself was searching, or for a quantile, which takes too many meshes.
///
/// # Errors
/// If model C has no result at the optimum.
pub fn confirm(problem: &Problem, optimum: &Optimum) -> Result<Option<Confirmation>> {
    let Some(best) = optimum.efficiency.filter(|_| problem.model != Model::C && problem.robust.is_none())
    else {
        return Ok(None);
    };
    let values = optimum.values();
    let efficiency = problem.efficiency_of(Model::C, &values)?;
    let candidates: Vec<(usize, [f64; 2])> = optimum
        .variables
        .iter()
        .enumerate()
        .flat_map(|(k, variable)| rivals(variable, best).into_iter().map(move |at| (k, at)))
        .collect();
    let by_c = |(k, [value, searched]): (usize, [f64; 2])| {
        let mut there = values.clone();
        there[k] = value;
        let efficiency = problem.efficiency_of(Model::C, &there).ok()?;
        let Neighbourhood { field, unit, .. } = &optimum.variables[k];
        Some(Rival { field: field.clone(), unit, value, searched, efficiency })
    };
    let rival =
        candidates.into_par_iter().filter_map(by_c).max_by(|a, b| a.efficiency.total_cmp(&b.efficiency));
    let confirmed = rival.as_ref().is_none_or(|rival| efficiency >= (1.0 - LOSS) * rival.efficiency);
    Ok(Some(Confirmation { efficiency, rival, confirmed }))
}

/// Value and efficiency of both ends and of every peak of the profile that come near the `best`, except the optimum's own.
fn rivals(variable: &Neighbourhood, best: f64) -> Vec<[f64; 2]> {
    let profile = &variable.profile;
    let height = |k: usize| profile[k][1];
    let peak = |&k: &usize| {
        (k == 0 || height(k) >= height(k - 1)) && (k + 1 == profile.len() || height(k) >= height(k + 1))
    };
    let width = (variable.bounds[1] - variable.bounds[0]) / profile.len().max(2) as f64;
    let [low, high] = variable.range_within_1_percent;
    let last = profile.len().saturating_sub(1);
    (0..profile.len())
        .filter(|k| *k == 0 || *k == last || peak(k))
        .map(|k| profile[k])
        // the optimum's own hill is no rival
        .filter(|[x, _]| !(low - width..=high + width).contains(x))
        .filter(|[_, efficiency]| *efficiency >= RIVAL * best)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::rivals;
    use crate::optimise::Neighbourhood;

    #[test]
    fn rivals_are_the_ends_and_the_other_peaks_that_come_near() {
        let heights = [0.96, 0.5, 0.7, 0.95, 0.6, 0.98, 1.0, 0.98, 0.3, 0.91];
        let profile: Vec<[f64; 2]> = heights.iter().enumerate().map(|(k, e)| [k as f64, *e]).collect();
        let variable = Neighbourhood {
            field: "x".into(),
            unit: "m",
            bounds: [0.0, 9.0],
            optimum: 6.0,
            on_bound: false,
            extreme: None,
            range_within_1_percent: [5.5, 6.5],
            curvature: None,
            profile,
        };
        assert_eq!(rivals(&variable, 1.0), [[0.0, 0.96], [3.0, 0.95], [9.0, 0.91]]);
        assert_eq!(rivals(&variable, 1.04), [[0.0, 0.96], [3.0, 0.95]]);
    }
}
