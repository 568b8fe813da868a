//! Parameters of a function from data, by least squares, and what the data can't tell of them.

use crate::error::{Error, Result};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use serde::Serialize;

/// Half the step of the differences from which slopes come, in scales of the parameters: small against what the parameters are
/// uncertain by, large against the rounding of a model's run.
const STEP: f64 = 1e-3;
/// The same along a direction of small slope, where rounding counts.
const LONG_STEP: f64 = 1e-2;
/// Slope over the largest below which a direction is one of small slope.
const SMALL_SLOPE: f64 = 0.1;
/// Part of a small slope that has to be there over the long step too: less is rounding.
const CONFIRMED: f64 = 0.3;
/// Change of a parameter, in its scale, below which it takes no part in a direction whatever its standard deviation is.
const LEAST_PART: f64 = 1e-3;
/// Standard deviation along a direction, in scales of the parameters, from which on the data don't tell it.
const UNIDENTIFIABLE: f64 = 0.5;
/// Smallest singular value over the largest that is more than rounding.
const ROUNDING: f64 = 1e-6;
/// Differences where the model has no result, over the largest at the start.
const FAR: f64 = 1e3;
/// Component from which on a parameter takes part in a direction; a smaller one does if what it adds to the parameter's standard
/// deviation is more than a share of what the other directions leave.
const PART: f64 = 0.1;
const ADDED: f64 = 0.3;

/// The parameters that fit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fitted {
    /// Their values. Shape (parameters).
    pub values: Vec<f64>,
    /// Their standard deviations (1.96 of them are 95 %); `None` of those that the data don't tell. Shape (parameters).
    pub standard_deviations: Vec<Option<f64>>,
    /// Their correlations, along what the data tell. Shape (parameters, parameters).
    pub correlations: Vec<Vec<f64>>,
    /// Standard deviation of the data about the fit.
    pub scatter: f64,
    /// Singular values of the slopes of the data over the parameters in their scales, over that scatter; the largest first. A direction's
    /// standard deviation is the inverse of its value.
    pub singular_values: Vec<f64>,
    /// Parameters that the data cannot identify, alone or together, by their numbers: one entry per unidentifiable direction.
    pub unidentifiable: Vec<Vec<usize>>,
}

/// Differences of a model from data as a function of its parameters in their scales.
struct FitProblem<'a, F> {
    residuals: &'a F,
    scales: &'a [f64],
    at: DVector<f64>,
    /// What stands for differences where there are none: so large that a step there is taken back.
    far_off: DVector<f64>,
}

impl<F: Fn(&[f64]) -> Option<Vec<f64>>> FitProblem<'_, F> {
    fn of(&self, at: &DVector<f64>) -> Option<DVector<f64>> {
        let values: Vec<f64> = at.iter().zip(self.scales).map(|(x, scale)| x * scale).collect();
        (self.residuals)(&values).map(DVector::from_vec)
    }

    /// Whether the data change along `direction` by their `slope` over a long step too, apart from what the orthonormal courses `known`
    /// explain: where inputs act through one number alone, a straight step changes it, too, but only as its own direction does.
    fn is_confirmed(&self, direction: &DVector<f64>, slope: f64, known: &DMatrix<f64>) -> bool {
        let moved = |step: f64| self.of(&(&self.at + direction * step));
        let is_left = |(after, before): (DVector<f64>, DVector<f64>)| {
            let change = (after - before) / (2.0 * LONG_STEP);
            (&change - known * known.tr_mul(&change)).norm() > CONFIRMED * slope
        };
        // where the model has no result the short step is all there is
        moved(LONG_STEP).zip(moved(-LONG_STEP)).is_none_or(is_left)
    }

    /// The differences with parameter `k` changed by `step`.
    fn moved(&self, k: usize, step: f64) -> Option<DVector<f64>> {
        let mut there = self.at.clone();
        there[k] += step;
        self.of(&there)
    }

    fn slopes(&self) -> Option<DMatrix<f64>> {
        let column = |k| Some((self.moved(k, STEP)? - self.moved(k, -STEP)?) / (2.0 * STEP));
        Some(DMatrix::from_columns(&(0..self.at.len()).map(column).collect::<Option<Vec<_>>>()?))
    }

    /// Why there are no slopes; `stated` names a parameter with its value.
    fn at_the_limit(&self, stated: impl Fn(usize, f64) -> String) -> Error {
        let ends = |k: &usize| [STEP, -STEP].into_iter().any(|step| self.moved(*k, step).is_none());
        let Some(k) = (0..self.at.len()).find(ends) else {
            return undefined();
        };
        Error::Solver(format!(
            "the fit comes to {}, and next to it the model has no result: the records do not identify the inputs with this model; take fewer inputs, or another model",
            stated(k, self.at[k] * self.scales[k])
        ))
    }
}

impl<F: Fn(&[f64]) -> Option<Vec<f64>>> LeastSquaresProblem<f64, Dyn, Dyn> for FitProblem<'_, F> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, at: &DVector<f64>) {
        self.at.copy_from(at);
    }

    fn params(&self) -> DVector<f64> {
        self.at.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        self.of(&self.at).or_else(|| Some(self.far_off.clone()))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        self.slopes()
    }
}

fn undefined() -> Error {
    Error::Solver("the model has no result at the inputs that the fit tries".into())
}

/// Minimises the sum of the squares of `residuals` from `start` on (Levenberg and Marquardt, as in MINPACK); `scales` are the sizes of
/// the parameters: a direction in which they are uncertain by half of these is unidentifiable. `covariance` gives that of the data from
/// what the fit leaves and its slopes, block by block along the data (see [`independent`]). Messages show a parameter and its
/// value as `stated`.
///
/// # Errors
/// [`Error::Solver`] if the residuals are not defined at the start, are too few for the parameters, or no minimum is found.
pub fn fit(
    start: &[f64],
    scales: &[f64],
    residuals: impl Fn(&[f64]) -> Option<Vec<f64>>,
    covariance: impl Fn(&DVector<f64>, &DMatrix<f64>) -> Option<Vec<DMatrix<f64>>>,
    stated: impl Fn(usize, f64) -> String,
) -> Result<Fitted> {
    let first = residuals(start).ok_or_else(undefined)?;
    let largest = first.iter().fold(1.0_f64, |most, r| most.max(r.abs()));
    let far_off = DVector::from_element(first.len(), FAR * largest);
    let at = DVector::from_iterator(start.len(), start.iter().zip(scales).map(|(x, scale)| x / scale));
    let problem = FitProblem { residuals: &residuals, scales, at, far_off };
    let (problem, report) =
        LevenbergMarquardt::new().with_ftol(1e-12).with_xtol(1e-10).with_gtol(1e-12).minimize(problem);
    match report.termination {
        TerminationReason::ResidualsZero
        | TerminationReason::Orthogonal
        | TerminationReason::Converged { .. }
        | TerminationReason::NoImprovementPossible(_) => {}
        TerminationReason::User(_) => return Err(problem.at_the_limit(stated)),
        TerminationReason::LostPatience => {
            return Err(Error::Solver(format!(
                "the fit finds no minimum in {} trials: take fewer inputs, or values in the scene that are nearer to the records",
                report.number_of_evaluations
            )));
        }
        other => return Err(Error::Solver(format!("the fit finds no minimum: {other:?}"))),
    }
    let (left, slopes) =
        problem.of(&problem.at).zip(problem.slopes()).ok_or_else(|| problem.at_the_limit(stated))?;
    let (count, unknowns) = (left.len(), start.len());
    if count <= unknowns {
        return Err(Error::Solver(format!("{count} data don't determine {unknowns} inputs")));
    }
    let scatter = (left.norm_squared() / (count - unknowns) as f64).sqrt();
    let blocks = covariance(&left, &slopes).ok_or_else(|| {
        Error::Solver(format!(
            "{count} data are too few for the standard deviations of {unknowns} parameters"
        ))
    })?;
    Ok(fit_statistics(&problem, scatter, slopes, &blocks))
}

/// Covariance of `left` if all of it is independent and scatters alike.
pub fn independent(left: &DVector<f64>, slopes: &DMatrix<f64>) -> Option<Vec<DMatrix<f64>>> {
    let freedom = slopes.nrows().checked_sub(slopes.ncols()).filter(|freedom| *freedom > 0)?;
    let variance = left.norm_squared() / freedom as f64;
    Some(vec![DMatrix::from_diagonal_element(1, 1, variance); left.len()])
}

/// `directions' C directions` of the covariance C that consists of `blocks`.
fn along(directions: &DMatrix<f64>, blocks: &[DMatrix<f64>]) -> DMatrix<f64> {
    let mut start = 0;
    let mut total = DMatrix::zeros(directions.ncols(), directions.ncols());
    for block in blocks {
        let part = directions.rows(start, block.nrows());
        total += part.tr_mul(&(block * part));
        start += block.nrows();
    }
    total
}

/// What the `slopes` at the solution tell, the data having the covariance of `blocks`.
fn fit_statistics<F: Fn(&[f64]) -> Option<Vec<f64>>>(
    problem: &FitProblem<F>,
    scatter: f64,
    slopes: DMatrix<f64>,
    blocks: &[DMatrix<f64>],
) -> Fitted {
    let (at, scales) = (&problem.at, problem.scales);
    let unknowns = at.len();
    let parts = slopes.svd(true, true);
    let singular = parts.singular_values;
    let largest = singular.max();
    let mut order: Vec<usize> = (0..unknowns).collect();
    order.sort_by(|a, b| singular[*b].total_cmp(&singular[*a]));
    let directions = parts.v_t.unwrap_or_else(|| DMatrix::zeros(unknowns, unknowns));
    let courses = parts.u.unwrap_or_else(|| DMatrix::zeros(at.len(), unknowns));
    let of_data = along(&courses, blocks);
    let deviation = |k: usize| of_data[(k, k)].max(0.0).sqrt() / singular[k];
    let is_identifiable = |k: usize, known: &[usize]| {
        let slope = singular[k];
        let is_confirmed = || {
            let explained = courses.select_columns(known);
            problem.is_confirmed(&directions.row(k).transpose(), slope, &explained)
        };
        slope > ROUNDING * largest
            && deviation(k) < UNIDENTIFIABLE
            && (slope > SMALL_SLOPE * largest || is_confirmed())
    };
    let (mut known, mut unknown) = (Vec::new(), Vec::new());
    for k in order.iter().copied() {
        let side = if is_identifiable(k, &known) { &mut known } else { &mut unknown };
        side.push(k);
    }
    let scaled =
        DMatrix::from_fn(unknowns, known.len(), |i, k| directions[(known[k], i)] / singular[known[k]]);
    let inner = DMatrix::from_fn(known.len(), known.len(), |i, j| of_data[(known[i], known[j])]);
    let covariance = &scaled * inner * scaled.transpose();
    let deviation = |j: usize| covariance[(j, j)].max(0.0).sqrt();
    let takes_part = |k: usize, j: usize| {
        let part = directions[(k, j)].abs();
        part > PART || UNIDENTIFIABLE * part > LEAST_PART.max(ADDED * deviation(j))
    };
    let unidentifiable: Vec<Vec<usize>> =
        unknown.iter().map(|k| (0..unknowns).filter(|j| takes_part(*k, *j)).collect()).collect();
    let is_identifiable = |j: &usize| !unidentifiable.iter().any(|direction| direction.contains(j));
    let correlation =
        |i: usize, j: usize| covariance[(i, j)] / (deviation(i) * deviation(j)).max(f64::MIN_POSITIVE);
    Fitted {
        values: at.iter().zip(scales).map(|(x, scale)| x * scale).collect(),
        standard_deviations: (0..unknowns)
            .map(|j| is_identifiable(&j).then(|| deviation(j) * scales[j]))
            .collect(),
        correlations: (0..unknowns).map(|i| (0..unknowns).map(|j| correlation(i, j)).collect()).collect(),
        scatter,
        singular_values: order.iter().map(|k| singular[*k] / scatter.max(f64::MIN_POSITIVE)).collect(),
        unidentifiable,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRUTH: [f64; 3] = [2.0, 30.0, 0.4];

    /// A decaying oscillation with noise of a standard deviation of 0.05.
    fn noisy(seed: u64) -> Vec<(f64, f64)> {
        let mut random = fastrand::Rng::with_seed(seed);
        // sum of twelve (Irwin and Hall): normal enough for standard deviations
        let mut noise = || 0.05 * ((0..12).map(|_| random.f64()).sum::<f64>() - 6.0);
        (0..200).map(|k| 0.01 * f64::from(k)).map(|t| (t, model(&TRUTH, t) + noise())).collect()
    }

    fn number(k: usize, value: f64) -> String {
        format!("input {k} = {value:.2}")
    }

    fn model(p: &[f64], t: f64) -> f64 {
        p[0] * (-t * p[2]).exp() * (p[1] * t).sin()
    }

    #[test]
    fn inputs_come_back_within_what_is_stated() {
        let mut inside = [0; 3];
        for seed in 0..200 {
            let data = noisy(seed);
            let residuals = |p: &[f64]| Some(data.iter().map(|(t, y)| model(p, *t) - y).collect());
            let found =
                fit(&[1.8, 29.8, 0.5], &[2.0, 30.0, 0.5], residuals, independent, number).expect("a minimum");
            assert!(found.unidentifiable.is_empty(), "{found:?}");
            assert!((found.scatter / 0.05 - 1.0).abs() < 0.25, "{found:?}");
            for (k, inside) in inside.iter_mut().enumerate() {
                let deviation = found.standard_deviations[k].expect("told");
                *inside += u32::from((found.values[k] - TRUTH[k]).abs() <= 1.972 * deviation);
            }
        }
        // 95 % of 200
        assert!(inside.iter().all(|count| (178..=199).contains(count)), "{inside:?}");
    }

    #[test]
    fn inputs_that_act_through_their_product_are_not_identifiable() {
        let data = noisy(7);
        let product = |p: &[f64], t: f64| model(&[p[0] * p[3], p[1], p[2]], t);
        let residuals = |p: &[f64]| Some(data.iter().map(|(t, y)| product(p, *t) - y).collect());
        let found = fit(&[1.8, 29.8, 0.5, 1.1], &[2.0, 30.0, 0.5, 1.0], residuals, independent, number)
            .expect("a minimum");
        assert_eq!(found.unidentifiable, [[0, 3]], "{found:?}");
        assert_eq!(
            found.standard_deviations.iter().map(Option::is_some).collect::<Vec<_>>(),
            [false, true, true, false]
        );
        assert!((found.values[0] * found.values[3] - 2.0).abs() < 0.1, "{found:?}");
        // what does not act at all is not told either
        let residuals = |p: &[f64]| Some(data.iter().map(|(t, y)| model(p, *t) - y).collect());
        let found = fit(&[1.8, 29.8, 0.5, 1.0], &[2.0, 30.0, 0.5, 1.0], residuals, independent, number)
            .expect("a minimum");
        assert_eq!(found.unidentifiable, [[3]], "{found:?}");
    }

    /// Data without noise show the slopes' own error: of inputs that act through one number alone it is a slope where there is none.
    #[test]
    fn the_error_of_slopes_is_no_slope() {
        let angle = |p: &[f64], t: f64| (p[0] / p[1].powi(2) * t).sin();
        let times = || (0..200).map(|k| 0.01 * f64::from(k));
        let residuals = |p: &[f64]| Some(times().map(|t| angle(p, t) - angle(&[1.4, 1.05], t)).collect());
        let found = fit(&[1.5, 1.0], &[1.5, 1.0], residuals, independent, number).expect("a minimum");
        assert_eq!(found.unidentifiable, [[0, 1]], "{found:?}");
    }

    /// A small part of an unidentifiable direction counts where it is more than the deviation, and where louder data make both as large:
    /// the second input acts through the first times (1 + 0.05 times it).
    #[test]
    fn a_small_part_of_a_direction_counts_where_it_is_no_less_than_the_deviation() {
        for loud in [1.0, 12.0] {
            let louder = |(t, y)| (t, model(&TRUTH, t) + loud * (y - model(&TRUTH, t)));
            let data: Vec<(f64, f64)> = noisy(7).into_iter().map(louder).collect();
            let product = |p: &[f64], t: f64| model(&[p[0] * (0.95 + 0.05 * p[3]), p[1], p[2]], t);
            let residuals = |p: &[f64]| Some(data.iter().map(|(t, y)| product(p, *t) - y).collect());
            let found = fit(&[1.8, 29.8, 0.5, 1.1], &[2.0, 30.0, 0.5, 1.0], residuals, independent, number)
                .expect("a minimum");
            assert_eq!(found.unidentifiable, [[0, 3]], "{loud}: {found:?}");
        }
    }

    /// A model's rounding looks like a small slope of an input that does nothing.
    #[test]
    fn rounding_is_no_slope() {
        let data = noisy(7);
        let rounding = |p: f64, t: f64| 2e-4 * (1e7 * p + 1e3 * t).sin();
        let residuals =
            |p: &[f64]| Some(data.iter().map(|(t, y)| model(p, *t) + rounding(p[3], *t) - y).collect());
        let found = fit(&[1.8, 29.8, 0.5, 1.0], &[2.0, 30.0, 0.5, 1.0], residuals, independent, number)
            .expect("a minimum");
        assert_eq!(found.unidentifiable, [[3]], "{found:?}");
    }

    /// As Poisson's ratio at 0.5: the records want more than the model takes.
    #[test]
    fn a_fit_that_leaves_the_model_names_the_input() {
        let data = noisy(7);
        let residuals =
            |p: &[f64]| (p[0] < 1.9).then(|| data.iter().map(|(t, y)| model(p, *t) - y).collect());
        let error = fit(&[1.8, 29.8, 0.5], &[2.0, 30.0, 0.5], residuals, independent, number).unwrap_err();
        let said = error.to_string();
        assert!(said.contains("comes to input 0 = 1.90"), "{said}");
    }

    #[test]
    fn too_few_data_are_an_error() {
        let few = |p: &[f64]| Some(vec![p[0] - 1.0]);
        assert!(matches!(fit(&[2.0, 1.0], &[1.0, 1.0], few, independent, number), Err(Error::Solver(_))));
    }
}
