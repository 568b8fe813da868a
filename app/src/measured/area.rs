//! How far the distribution of a model lies from that of measurements.

use serde::Serialize;

/// Area between two cumulative distributions, in the unit of the values: how far one would have to be moved on the average to become the
/// other (Ferson, Oberkampf & Ginzburg, Comput. Methods Appl. Mech. Eng. 197, 2008), by itself and with its sides apart (Roy & Oberkampf,
/// Comput. Methods Appl. Mech. Eng. 200, 2011; the sides as Voyles & Roy, AIAA 2015-1360, keep them).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Area {
    /// The whole of it.
    pub area: f64,
    /// The part where the model's values are larger than the measured ones.
    pub above: f64,
    /// The part where they are smaller.
    pub below: f64,
}

impl Area {
    /// Of the values of a `model` and `measured` ones, in any order; `None` without any.
    pub fn between(model: &[f64], measured: &[f64]) -> Option<Self> {
        if model.is_empty() || measured.is_empty() {
            return None;
        }
        // each value with the step that the difference of both distributions makes there
        let step = |values: &[f64], sign: f64| sign / values.len() as f64;
        let of_model = model.iter().map(|value| (*value, step(model, 1.0)));
        let of_measured = measured.iter().map(|value| (*value, step(measured, -1.0)));
        let mut steps: Vec<(f64, f64)> = of_model.chain(of_measured).collect();
        steps.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut difference, mut sides) = (0.0_f64, [0.0; 2]);
        for pair in steps.windows(2) {
            difference += pair[0].1;
            // fewer of the model's values than of the measured ones lie below: the model's are larger
            sides[usize::from(difference > 0.0)] += difference.abs() * (pair[1].0 - pair[0].0);
        }
        let [above, below] = sides;
        Some(Area { area: above + below, above, below })
    }
}

#[cfg(test)]
mod tests {
    use super::Area;

    #[test]
    fn a_shift_is_the_area_on_one_side() {
        let measured: Vec<f64> = (0..7).map(|k| 0.3 * f64::from(k * k)).collect();
        let model: Vec<f64> = measured.iter().rev().map(|v| v + 0.25).collect();
        let found = Area::between(&model, &measured).expect("values");
        assert!((found.area - 0.25).abs() < 1e-12 && (found.above - 0.25).abs() < 1e-12, "{found:?}");
        assert!(Area::between(&measured, &measured).expect("values").area < 1e-15);
        assert_eq!(Area::between(&[], &measured), None);
    }

    /// Uniform on -a..a against a single value 0: a/4 on either side.
    #[test]
    fn a_wider_distribution_has_both_sides() {
        let model: Vec<f64> = (0..20_000).map(|k| 2.0 * ((f64::from(k) + 0.5) / 2e4 - 0.5)).collect();
        let found = Area::between(&model, &[0.0]).expect("values");
        assert!((found.above - 0.25).abs() < 1e-4 && (found.below - 0.25).abs() < 1e-4, "{found:?}");
    }
}
