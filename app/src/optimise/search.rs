//! Global maximum of a function on the unit cube: samples, then the best of them polished.
//!
//! The efficiency has several local optima, and kinks where a contact comes or goes; derivatives are of no use. A sample
//! of the whole cube finds the hills, and from the highest of them Brent's method (one coordinate) or the simplex of
//! Nelder and Mead climbs to the top.

use crate::error::{Error, Result};
use crate::sampling::latin_hypercube;
use argmin::core::{CostFunction, Executor, State};
use argmin::solver::brent::BrentOpt;
use argmin::solver::neldermead::NelderMead;
use rayon::prelude::*;
use std::cmp::Ordering;
use std::sync::{Mutex, PoisonError};

/// A place in the unit cube, and its cost.
type Found = (Vec<f64>, f64);

/// How thoroughly to search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// Samples of the cube.
    pub samples: usize,
    /// Seed of the samples of a cube of several coordinates.
    pub seed: u64,
    /// Samples that are polished.
    pub starts: usize,
    /// Length, relative to the cube's edge, to which the maximum is located.
    pub resolution: f64,
    /// Most iterations of a simplex, per coordinate.
    pub iterations: u64,
    /// How often a simplex is set up, each smaller than the one before.
    pub simplices: usize,
}

impl Search {
    /// Enough for a function with some ten hills along each coordinate.
    pub fn of_dimensions(dimensions: usize) -> Self {
        let samples = [0, 49, 225, 512].get(dimensions).copied().unwrap_or(1024);
        let starts = if dimensions == 1 { 3 } else { 6 };
        Search { samples, seed: 1, starts, resolution: 1e-5, iterations: 60, simplices: 3 }
    }

    /// For a function that takes a second, and has a hill or two.
    pub fn of_expensive(dimensions: usize) -> Self {
        Search {
            samples: 12 * dimensions,
            seed: 1,
            starts: 2,
            resolution: 1e-3,
            iterations: 12,
            simplices: 1,
        }
    }
}

/// The highest point found.
#[derive(Debug, Clone, PartialEq)]
pub struct Maximum {
    /// Place in the unit cube. Shape (dimensions).
    pub at: Vec<f64>,
    /// Value there.
    pub value: f64,
    /// All evaluations of the function: the samples, then climb after climb.
    pub history: Vec<Tried>,
}

/// An evaluation of the function.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// 0 for the samples, then the number of the climb.
    pub climb: usize,
    /// Place in the unit cube. Shape (dimensions).
    pub at: Vec<f64>,
    /// Value there; `None` if there is none.
    pub value: Option<f64>,
}

/// The function, recorded and made safe: places outside the cube are mirrored into it, failures are deep valleys.
struct RecordedObjective<'a, F> {
    function: &'a F,
    penalty: f64,
    climb: usize,
    history: Mutex<Vec<Tried>>,
}

impl<'a, F: Fn(&[f64]) -> Option<f64>> RecordedObjective<'a, F> {
    fn new(function: &'a F, penalty: f64, climb: usize) -> Self {
        Self { function, penalty, climb, history: Mutex::default() }
    }

    fn into_history(self) -> Vec<Tried> {
        self.history.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    fn at(&self, place: &[f64]) -> f64 {
        let at = mirrored(place);
        let value = (self.function)(&at).filter(|value| value.is_finite());
        let tried = Tried { climb: self.climb, at, value };
        self.history.lock().unwrap_or_else(PoisonError::into_inner).push(tried);
        value.map_or(self.penalty, |value| -value)
    }
}

impl<F: Fn(&[f64]) -> Option<f64>> CostFunction for &RecordedObjective<'_, F> {
    type Param = Vec<f64>;
    type Output = f64;
    fn cost(&self, place: &Vec<f64>) -> std::result::Result<f64, argmin::core::Error> {
        Ok(self.at(place))
    }
}

/// The same along one coordinate, which Brent's method takes as a number.
struct CoordinateObjective<'a, 'b, F>(&'a RecordedObjective<'b, F>);

impl<F: Fn(&[f64]) -> Option<f64>> CostFunction for CoordinateObjective<'_, '_, F> {
    type Param = f64;
    type Output = f64;
    fn cost(&self, place: &f64) -> std::result::Result<f64, argmin::core::Error> {
        Ok(self.0.at(&[*place]))
    }
}

/// Every coordinate folded into 0..1 as between two mirrors.
fn mirrored(place: &[f64]) -> Vec<f64> {
    place
        .iter()
        .map(|x| {
            let x = x.rem_euclid(2.0);
            if x > 1.0 { 2.0 - x } else { x }
        })
        .collect()
}

/// Searches the maximum of `function` on the unit cube of `dimensions` coordinates. Where it gives `None` it is not
/// defined.
///
/// # Errors
/// [`Error::Solver`] if it is defined at none of the samples.
pub fn maximise<F>(dimensions: usize, search: &Search, function: F) -> Result<Maximum>
where
    F: Fn(&[f64]) -> Option<f64> + Sync,
{
    let places = if dimensions == 1 {
        (0..search.samples).map(|k| vec![k as f64 / (search.samples - 1).max(1) as f64]).collect()
    } else {
        latin_hypercube(search.samples, dimensions, search.seed)
    };
    let sampled: Vec<(Vec<f64>, f64, Tried)> = places
        .into_par_iter()
        .map(|place| {
            let sampler = RecordedObjective::new(&function, f64::INFINITY, 0);
            let cost = sampler.at(&place);
            (place, cost, sampler.into_history().remove(0))
        })
        .collect();
    let mut history: Vec<Tried> = sampled.iter().map(|(.., tried)| tried.clone()).collect();
    let sampled: Vec<(Vec<f64>, f64)> = sampled.into_iter().map(|(place, cost, _)| (place, cost)).collect();
    let finite = sampled.iter().map(|(_, cost)| *cost).filter(|cost| cost.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), cost| (l.min(cost), h.max(cost)));
    if low > high {
        return Err(Error::Solver(format!(
            "none of the {} samples within the bounds has a result",
            search.samples
        )));
    }
    let cost = |k: usize| RecordedObjective::new(&function, high + (high - low).max(1.0), k + 1);
    let polished: Vec<(Found, Vec<Tried>)> = if dimensions == 1 {
        brackets(&sampled, search.starts)
            .into_par_iter()
            .enumerate()
            .map(|(k, ends)| {
                let cost = cost(k);
                Ok((brent(&cost, ends, search)?, cost.into_history()))
            })
            .collect::<Result<_>>()?
    } else {
        hills(&sampled, search.starts)
            .into_par_iter()
            .enumerate()
            .map(|(k, top)| {
                let cost = cost(k);
                Ok((simplex(&cost, top, search)?, cost.into_history()))
            })
            .collect::<Result<_>>()?
    };
    history.extend(polished.iter().flat_map(|(_, tried)| tried.iter().cloned()));
    let best = sampled
        .into_iter()
        .chain(polished.into_iter().map(|(found, _)| found))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let (at, cost) = best.ok_or_else(|| Error::Internal("no sample".into()))?;
    Ok(Maximum { at: mirrored(&at), value: -cost, history })
}

/// The intervals around the highest local maxima of samples along a line.
fn brackets(sampled: &[(Vec<f64>, f64)], count: usize) -> Vec<(f64, f64)> {
    let last = sampled.len() - 1;
    let cost = |k: usize| sampled[k].1;
    let mut tops: Vec<usize> = (0..=last)
        .filter(|&k| {
            cost(k).is_finite() && (k == 0 || cost(k) <= cost(k - 1)) && (k == last || cost(k) <= cost(k + 1))
        })
        .collect();
    tops.sort_by(|a, b| cost(*a).total_cmp(&cost(*b)));
    tops.truncate(count);
    tops.into_iter().map(|k| (sampled[k.saturating_sub(1)].0[0], sampled[(k + 1).min(last)].0[0])).collect()
}

fn brent<F>(cost: &RecordedObjective<F>, (low, high): (f64, f64), search: &Search) -> Result<(Vec<f64>, f64)>
where
    F: Fn(&[f64]) -> Option<f64>,
{
    let solver = BrentOpt::new(low, high).set_tolerance(1e-8, search.resolution);
    let result = Executor::new(CoordinateObjective(cost), solver)
        .configure(|state| state.max_iters(100))
        .run()
        .map_err(|e| Error::Internal(format!("Brent's method: {e}")))?;
    let state = result.state();
    Ok((state.get_best_param().map(|x| vec![*x]).unwrap_or_else(|| vec![low]), state.get_best_cost()))
}

/// The best samples that are not next to a better one.
fn hills(sampled: &[(Vec<f64>, f64)], count: usize) -> Vec<Vec<f64>> {
    let mut order: Vec<&(Vec<f64>, f64)> = sampled.iter().filter(|(_, cost)| cost.is_finite()).collect();
    order.sort_by(|a, b| a.1.partial_cmp(&b.1).unwrap_or(Ordering::Equal));
    let distance = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let dimensions = sampled[0].0.len() as f64;
    let apart = 1.5 * (sampled.len() as f64).powf(-1.0 / dimensions);
    let mut chosen: Vec<Vec<f64>> = Vec::new();
    for (place, _) in order {
        if chosen.len() < count && chosen.iter().all(|other| distance(place, other) > apart) {
            chosen.push(place.clone());
        }
    }
    chosen
}

fn simplex<F>(cost: &RecordedObjective<F>, top: Vec<f64>, search: &Search) -> Result<(Vec<f64>, f64)>
where
    F: Fn(&[f64]) -> Option<f64>,
{
    let edge = 0.5 * (search.samples as f64).powf(-1.0 / top.len() as f64);
    let mut best = (top, f64::INFINITY);
    // a simplex that has collapsed on a ridge is set up again, smaller, where it stopped
    for shrink in [1.0, 0.2, 0.04].into_iter().take(search.simplices) {
        let mut corners = vec![best.0.clone()];
        for axis in 0..best.0.len() {
            let mut corner = best.0.clone();
            corner[axis] += edge * shrink * if corner[axis] > 0.5 { -1.0 } else { 1.0 };
            corners.push(corner);
        }
        let solver = NelderMead::new(corners)
            .with_sd_tolerance(1e-10)
            .map_err(|e| Error::Internal(format!("simplex: {e}")))?;
        let result = Executor::new(cost, solver)
            .configure(|state| state.max_iters(search.iterations * best.0.len() as u64))
            .run()
            .map_err(|e| Error::Internal(format!("simplex: {e}")))?;
        let state = result.state();
        if let Some(place) = state.get_best_param().filter(|_| state.get_best_cost() < best.1) {
            best = (place.clone(), state.get_best_cost());
        }
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_highest_of_ten_hills_along_a_line() {
        // hills of sin^2 under a parabola whose top lies at 0.37: the highest hill is near 0.35
        let f = |x: f64| (10.0 * PI * x).sin().powi(2) - 2.0 * (x - 0.37).powi(2);
        let found = maximise(1, &Search::of_dimensions(1), |x| Some(f(x[0]))).expect("maximum");
        // f' = 10 pi sin(20 pi x) - 4 (x - 0.37) vanishes there
        let x = found.at[0];
        let slope = 10.0 * PI * (20.0 * PI * x).sin() - 4.0 * (x - 0.37);
        assert!((x - 0.35).abs() < 1e-3 && slope.abs() < 0.05, "{found:?}, slope {slope}");
        assert!((found.value - f(x)).abs() < 1e-15);
    }

    #[test]
    fn maxima_at_the_ends_and_corners_are_found() {
        let found = maximise(1, &Search::of_dimensions(1), |x| Some(x[0])).expect("maximum");
        assert!((found.at[0] - 1.0).abs() < 1e-5, "{found:?}");
        let found = maximise(2, &Search::of_dimensions(2), |x| Some(-x[0] - 2.0 * x[1])).expect("maximum");
        assert!(found.at.iter().all(|x| *x < 1e-4), "{found:?}");
    }

    #[test]
    fn rosenbrocks_valley_and_rastrigins_hills() {
        // Rosenbrock, Comput. J. 3 (1960): minimum 0 at (1, 1), here in -2..2
        let rosenbrock = |x: &[f64]| {
            let (a, b) = (4.0 * x[0] - 2.0, 4.0 * x[1] - 2.0);
            Some(-(1.0 - a).powi(2) - 100.0 * (b - a * a).powi(2))
        };
        let found = maximise(2, &Search::of_dimensions(2), rosenbrock).expect("maximum");
        assert!(found.at.iter().all(|x| (4.0 * x - 3.0).abs() < 1e-3), "{found:?}");
        // Rastrigin: minimum 0 at (0.3, 0.3) after a shift, local ones all around it
        let rastrigin = |x: &[f64]| {
            let term = |x: f64| {
                let y = 4.0 * (x - 0.3);
                y * y - (2.0 * PI * y).cos()
            };
            Some(-x.iter().map(|x| term(*x)).sum::<f64>())
        };
        let found = maximise(2, &Search::of_dimensions(2), rastrigin).expect("maximum");
        assert!(found.at.iter().all(|x| (x - 0.3).abs() < 1e-4), "{found:?}");
    }

    #[test]
    fn places_without_a_value_are_avoided_and_counted() {
        let found =
            maximise(1, &Search::of_dimensions(1), |x| (x[0] < 0.61).then_some(x[0])).expect("maximum");
        let failures = found.history.iter().filter(|tried| tried.value.is_none()).count();
        assert!((0.6..0.61).contains(&found.at[0]) && failures > 10, "{found:?}");
        assert!(maximise(1, &Search::of_dimensions(1), |_| None).is_err());
    }
}
