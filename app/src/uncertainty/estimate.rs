//! Mean, scatter and Sobol indices of a function of uncertain inputs, from its values at the points of a
//! [design](super::design), with their 95 % intervals.

use super::design::REPLICATES;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// The values in one row of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Number of the row, which tells its sequence.
    pub number: usize,
    /// At A and B.
    pub own: [f64; 2],
    /// At A with one factor from B. Shape (factors).
    pub mixed: Vec<f64>,
}

/// An estimate and its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Half width of its interval.
    pub half_width: f64,
}

impl Estimate {
    /// Its interval.
    pub fn interval(self) -> [f64; 2] {
        [self.value - self.half_width, self.value + self.half_width]
    }

    /// `statistic` of all rows and, by the jackknife over independent sequences (each left out once: Efron & Tibshirani, An
    /// Introduction to the Bootstrap, 1993, chapter 11), its interval.
    fn of(rows: &[Row], statistic: impl Fn(&mut dyn Iterator<Item = &Row>) -> f64) -> Self {
        let value = statistic(&mut rows.iter());
        let without =
            |sequence: usize| statistic(&mut rows.iter().filter(|row| row.number % REPLICATES != sequence));
        let count = REPLICATES as f64;
        let left: Vec<f64> = (0..REPLICATES).map(without).collect();
        let mean = left.iter().sum::<f64>() / count;
        let squares: f64 = left.iter().map(|v| (v - mean).powi(2)).sum();
        let quantile = StudentsT::new(0.0, 1.0, count - 1.0).map_or(f64::NAN, |t| t.inverse_cdf(0.975));
        Estimate { value, half_width: quantile * ((count - 1.0) / count * squares).sqrt() }
    }
}

/// Which share of the variance a factor has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indices {
    /// By itself: Var(E(Y|X))/Var(Y).
    pub first: Estimate,
    /// With all its interactions: E(Var(Y|all others))/Var(Y).
    pub total: Estimate,
}

/// Mean, variance and how many values of A and B.
fn moments(rows: &mut dyn Iterator<Item = &Row>) -> (f64, f64, f64) {
    // Welford's recurrence
    let (mut count, mut mean, mut squares) = (0.0, 0.0, 0.0);
    for value in rows.flat_map(|row| row.own) {
        count += 1.0;
        let off = value - mean;
        mean += off / count;
        squares += off * (value - mean);
    }
    (mean, squares / (count - 1.0), count)
}

/// The mean.
pub fn mean(rows: &[Row]) -> Estimate {
    Estimate::of(rows, |rows| moments(rows).0)
}

/// The standard deviation.
pub fn standard_deviation(rows: &[Row]) -> Estimate {
    Estimate::of(rows, |rows| moments(rows).1.sqrt())
}

/// Indices of factor number `factor`: first order by Saltelli et al. (2010, table 2 b), about the mean; total by Jansen (Comput. Phys.
/// Commun. 117, 1999). Not a number where nothing varies.
pub fn indices(rows: &[Row], factor: usize) -> Indices {
    let (middle, variance, _) = moments(&mut rows.iter());
    let ratio = |of: &dyn Fn(&Row) -> f64, rows: &mut dyn Iterator<Item = &Row>| {
        // numerator and variance over the same rows
        let (mut sum, mut squares, mut count) = (0.0, 0.0, 0.0);
        for row in rows {
            sum += of(row);
            squares += row.own.iter().map(|v| 0.5 * (v - middle).powi(2)).sum::<f64>();
            count += 1.0;
        }
        if variance > 0.0 && count > 0.0 { sum / squares } else { f64::NAN }
    };
    let first = |row: &Row| (row.own[1] - middle) * (row.mixed[factor] - row.own[0]);
    let total = |row: &Row| 0.5 * (row.own[0] - row.mixed[factor]).powi(2);
    Indices {
        first: Estimate::of(rows, |rows| ratio(&first, rows)),
        total: Estimate::of(rows, |rows| ratio(&total, rows)),
    }
}

/// The values at A and B in ascending order. Shape (2 rows).
pub fn sorted(rows: &[Row]) -> Vec<f64> {
    let mut values: Vec<f64> = rows.iter().flat_map(|row| row.own).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The quantile of `probability` of values in ascending order, each of which stands for the middle of its share (Hazen's; Hyndman & Fan, Am.
/// Stat. 50, 1996, definition 5), linear between them.
pub fn quantile(sorted: &[f64], probability: f64) -> f64 {
    let last = sorted.len().saturating_sub(1) as f64;
    let place = (probability * sorted.len() as f64 - 0.5).clamp(0.0, last);
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    match (sorted.get(below), sorted.get(above)) {
        (Some(low), Some(high)) => low + (high - low) * place.fract(),
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::super::design::Design;
    use super::*;
    use std::f64::consts::PI;

    fn rows(design: &Design, count: usize, function: impl Fn(&[f64]) -> f64) -> Vec<Row> {
        let row = |number| {
            let value = |k: usize| function(&design.at(number, Design::point(k)));
            Row { number, own: [value(0), value(1)], mixed: (2..design.points()).map(value).collect() }
        };
        (0..count).map(row).collect()
    }

    fn of_single(inputs: usize, seed: u32) -> Design {
        Design { factors: (0..inputs).map(|k| vec![k]).collect(), seed }
    }

    fn ishigami(x: &[f64]) -> f64 {
        let angle = |k: usize| PI * (2.0 * x[k] - 1.0);
        angle(0).sin() + 7.0 * angle(1).sin().powi(2) + 0.1 * angle(2).powi(4) * angle(0).sin()
    }

    /// Mean, deviation, first and total indices of Ishigami and Homma's function (1990): in closed form.
    fn exact_ishigami() -> Vec<f64> {
        let (a, b) = (7.0, 0.1);
        let one = 0.5 * (1.0_f64 + b * PI.powi(4) / 5.0).powi(2);
        let two = a * a / 8.0;
        let both = b * b * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
        let variance = one + two + both;
        let mut exact = vec![a / 2.0, variance.sqrt()];
        exact.extend([one, two, 0.0, one + both, two, both].map(|part| part / variance));
        exact
    }

    fn all(rows: &[Row], factors: usize) -> Vec<Estimate> {
        let of: Vec<Indices> = (0..factors).map(|k| indices(rows, k)).collect();
        let indices = of.iter().map(|i| i.first).chain(of.iter().map(|i| i.total));
        [mean(rows), standard_deviation(rows)].into_iter().chain(indices).collect()
    }

    #[test]
    fn ishigami_s_function_is_met() {
        let found = all(&rows(&of_single(3, 1), 1 << 14, ishigami), 3);
        for (k, (found, exact)) in found.iter().zip(exact_ishigami()).enumerate() {
            assert!((found.value - exact).abs() < 5e-3 * exact.max(1.0), "{k}: {found:?}, exact {exact}");
            assert!(found.half_width < 0.01, "{k}: {found:?}");
        }
    }

    /// The stated 95 % intervals of 200 studies contain the truth in 95 % of them, each estimate by itself.
    #[test]
    fn intervals_cover_the_truth_as_often_as_they_say() {
        const STUDIES: u32 = 200;
        // an additive function with interaction: x y + 2 z on normal scores would have no closed quantile, this one is closed
        let product = |x: &[f64]| (x[0] - 0.5) * (x[1] - 0.5) * 12.0 + (x[2] - 0.5) * 12.0_f64.sqrt();
        let of_product = vec![0.0, 2.0_f64.sqrt(), 0.0, 0.0, 0.5, 0.5, 0.5, 0.5];
        for (function, exact, rows_of) in
            [(&ishigami as &dyn Fn(&[f64]) -> f64, exact_ishigami(), 1024), (&product, of_product, 512)]
        {
            let mut covered = vec![0; exact.len()];
            for seed in 0..STUDIES {
                let found = all(&rows(&of_single(3, 1000 + seed), rows_of, function), 3);
                for ((covered, found), exact) in covered.iter_mut().zip(found).zip(&exact) {
                    let [low, high] = found.interval();
                    *covered += u32::from((low..=high).contains(exact));
                }
            }
            // of 200 studies with 95 % each, fewer than 180 or more than 199 are one case in a thousand
            assert!(covered.iter().all(|count| (180..=199).contains(count)), "{covered:?} of {STUDIES}");
        }
    }

    #[test]
    fn a_linear_function_shares_its_variance_by_squared_slopes() {
        let slopes = [3.0, -2.0, 1.0, 0.0];
        let linear = |x: &[f64]| 5.0 + slopes.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
        let found = rows(&of_single(4, 2), 4096, linear);
        let squares: f64 = slopes.iter().map(|a| a * a).sum();
        assert!((mean(&found).value - 6.0).abs() < 1e-3);
        assert!((standard_deviation(&found).value / (squares / 12.0).sqrt() - 1.0).abs() < 1e-3);
        for (k, slope) in slopes.iter().enumerate() {
            let Indices { first, total } = indices(&found, k);
            for index in [first, total] {
                assert!((index.value - slope * slope / squares).abs() < 3e-3, "{k}: {index:?}");
            }
        }
        // what changes nothing has a total index of exactly nothing
        assert_eq!(indices(&found, 3).total.value, 0.0);
    }

    #[test]
    fn inputs_that_go_together_are_one_factor() {
        // x0 and x1 act through their product alone
        let product = |x: &[f64]| (x[0] - 0.5) * (x[1] - 0.5) * 12.0 + (x[2] - 0.5) * 12.0_f64.sqrt();
        let design = Design { factors: vec![vec![0, 1], vec![2]], seed: 5 };
        let found = rows(&design, 4096, product);
        for k in 0..2 {
            let Indices { first, total } = indices(&found, k);
            assert!(
                (first.value - 0.5).abs() < 0.02 && (total.value - 0.5).abs() < 0.02,
                "{first:?} {total:?}"
            );
        }
    }

    #[test]
    fn quantiles_lie_between_the_values() {
        let values = [1.0, 2.0, 4.0, 8.0];
        assert_eq!([0.0, 0.5, 1.0].map(|p| quantile(&values, p)), [1.0, 3.0, 8.0]);
        assert!(quantile(&[], 0.5).is_nan());
        assert!(indices(&rows(&of_single(1, 1), 64, |_| 7.0), 0).first.value.is_nan());
    }
}
