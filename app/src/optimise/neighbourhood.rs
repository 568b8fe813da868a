//! How sharp an optimum is: what an error of manufacture costs.

use super::Variable;
use serde::Serialize;

/// Points of the profile along a variable.
pub const PROFILE_POINTS: usize = 61;
/// The same where every point takes a mesh to be factorised.
pub const DEAR_POINTS: usize = 13;
/// Loss of the objective, relative, that bounds the range.
const LOSS: f64 = 0.01;
/// How far beyond a bound a value is tried, relative to the bounds' distance.
const BEYOND: f64 = 1e-6;
/// Half the base of the parabola whose curvature is given, relative to the bounds' distance.
const BASE: f64 = 0.01;

/// The optimum along one variable, the others being at theirs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Neighbourhood {
    /// Name of the field or fields.
    pub field: String,
    /// SI unit.
    pub unit: &'static str,
    /// Bounds.
    pub bounds: [f64; 2],
    /// Value at the optimum.
    pub optimum: f64,
    /// Whether the optimum lies on a bound: a better value may lie outside.
    pub on_bound: bool,
    /// "smallest" or "largest" if the fields permit no value beyond that bound.
    #[serde(skip)]
    pub extreme: Option<&'static str>,
    /// Range around the optimum within which the objective stays within 1 % of the best, cut at the bounds.
    pub range_within_1_percent: [f64; 2],
    /// Second derivative of the objective by the unit; `None` at a bound or where there is no result.
    pub curvature: Option<f64>,
    /// Value and objective from bound to bound, where there is a result. Shape (n, 2).
    pub profile: Vec<[f64; 2]>,
}

impl Neighbourhood {
    /// Explores the `objective` along `variable` around the optimum `at`, where it is `best`, at some `points` from bound to bound.
    pub(super) fn of(
        variable: &Variable,
        at: f64,
        best: f64,
        points: usize,
        objective: impl Fn(f64) -> Option<f64>,
    ) -> Self {
        let (low, high) = (variable.low, variable.high);
        let width = high - low;
        let finest = if points < PROFILE_POINTS { 1e-2 } else { 1e-4 };
        let good = |x: f64| objective(x).is_some_and(|value| value >= best - LOSS * best.abs());
        let end = |bound: f64| {
            let steps = points;
            let x = |k: usize| at + (bound - at) * k as f64 / steps as f64;
            let Some(out) = (1..=steps).find(|k| !good(x(*k))) else { return bound };
            let (mut inside, mut outside) = (x(out - 1), x(out));
            while (outside - inside).abs() > finest * width {
                let middle = 0.5 * (inside + outside);
                if good(middle) { inside = middle } else { outside = middle }
            }
            inside
        };
        let step = BASE * width;
        let inside = at - step >= low && at + step <= high;
        let sides = inside.then(|| Some((objective(at - step)?, objective(at + step)?))).flatten();
        let on_bound = (at - low).min(high - at) <= 1e-3 * width;
        let (beyond, extreme) = if at - low < high - at {
            (low - BEYOND * width, "smallest")
        } else {
            (high + BEYOND * width, "largest")
        };
        let is_permitted = variable.fields.iter().all(|field| field.check(beyond).is_ok());
        let place = |k: usize| low + width * k as f64 / (points - 1) as f64;
        Neighbourhood {
            field: variable.name(),
            unit: variable.fields[0].unit(),
            bounds: [low, high],
            optimum: at,
            on_bound,
            extreme: (on_bound && !is_permitted).then_some(extreme),
            range_within_1_percent: [end(low), end(high)],
            curvature: sides.map(|(left, right)| (left - 2.0 * best + right) / (step * step)),
            profile: (0..points).filter_map(|k| Some([place(k), objective(place(k))?])).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Template;

    #[test]
    fn range_and_curvature_of_a_parabola() {
        let template =
            Template::parse("base", include_str!("../../../scenes/scaled-plate-r10.toml")).expect("scene");
        let variable = Variable::parse("plate.radius=20mm..60mm", &template).expect("variable");
        // 0.8 (1 - ((x - 40 mm)/100 mm)^2): 1 % is lost at 10 mm, the second derivative is -160/m^2
        let parabola = |x: f64| Some(0.8 * (1.0 - ((x - 0.04) / 0.1).powi(2)));
        let found = Neighbourhood::of(&variable, 0.04, 0.8, PROFILE_POINTS, parabola);
        let [low, high] = found.range_within_1_percent;
        assert!((low - 0.03).abs() < 1e-5 && (high - 0.05).abs() < 1e-5, "{found:?}");
        assert!((found.curvature.expect("inside") + 160.0).abs() < 1e-6 && !found.on_bound);
        let found = Neighbourhood::of(&variable, 0.06, 0.8, PROFILE_POINTS, |x| Some(0.8 * x / 0.06));
        assert!(found.on_bound && found.curvature.is_none(), "{found:?}");
        assert!((found.range_within_1_percent[0] - 0.0594).abs() < 1e-5, "{found:?}");
        assert_eq!(found.extreme, None);
        // no gap is negative
        let variable = Variable::parse("inner.gap=0um..20um", &template).expect("variable");
        let found = Neighbourhood::of(&variable, 0.0, 0.8, PROFILE_POINTS, |x| Some(0.8 - x));
        assert_eq!(found.extreme, Some("smallest"));
    }
}
