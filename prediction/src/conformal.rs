//! Prediction intervals by conformal prediction, scaled by the errors that are to be expected.
//!
//! Papadopoulos, Vovk and Gammerman, Regression conformal prediction with nearest neighbours, J. Artificial Intelligence Research
//! 40 (2011) 815: an error is measured in units of what its neighbours' errors let expect; the quantile of these ratios over all cases,
//! times the error expected of a new case, holds the new error with the stated probability, whatever the errors' distribution. Here a case
//! also states an error itself, which adds to its neighbours'.
//!
//! References have errors of their own. As both are independent, their mean squares add up, and so do the squares of half widths at the same
//! level; exactly if both have a normal distribution. The half width of the reference's error is removed from the errors that calibrate,
//! and added where errors against references are judged.

use crate::LEVEL;

/// Neighbours that an error is compared with.
const NEIGHBOURS: usize = 12;
/// Least expected error, over the median of all errors: some neighbourhoods agree by chance.
const LEAST: f64 = 0.1;

/// What an error is predicted from.
#[derive(Debug, Clone)]
pub struct Place {
    /// Coordinates. Shape (d).
    pub coordinates: Vec<f64>,
    /// Error that the case states itself.
    pub stated: f64,
}

/// An error seen at a place.
#[derive(Debug, Clone)]
pub struct SeenError {
    /// Where the case lies.
    pub place: Place,
    /// Magnitude of the error.
    pub error: f64,
    /// Half width, at [`LEVEL`], of the error of the reference that it was measured with.
    pub noise: f64,
}

impl SeenError {
    /// The part that is more than noise: both are independent, so that their squares add up.
    pub fn excess(&self) -> f64 {
        (self.error.powi(2) - self.noise.powi(2)).max(0.0).sqrt()
    }

    /// Whether an interval of this `half_width` holds it, but for the noise.
    pub fn is_within(&self, half_width: f64) -> bool {
        self.error <= half_width.hypot(self.noise)
    }
}

/// Cases from which errors elsewhere are predicted.
#[derive(Debug)]
pub struct ErrorScale<'a> {
    cases: &'a [SeenError],
    /// Standard deviations of the coordinates. Shape (d).
    spread: Vec<f64>,
    least: f64,
    /// Of the ratios.
    quantile: f64,
}

impl<'a> ErrorScale<'a> {
    /// For intervals that hold the share [`LEVEL`] of all errors; `None` of fewer cases than that needs, and where the errors do not exceed
    /// those of the references.
    pub fn new(cases: &'a [SeenError]) -> Option<Self> {
        let count = cases.len();
        // the new case counts as one
        let rank = (LEVEL * (count + 1) as f64).ceil() as usize;
        if rank > count {
            return None;
        }
        let errors = cases.iter().map(|case| case.error).collect();
        let spread = (0..cases[0].place.coordinates.len()).map(|axis| deviation(cases, axis)).collect();
        let mut found =
            Self { cases, spread, least: (LEAST * median(errors)).max(f64::MIN_POSITIVE), quantile: 0.0 };
        let mut ratios: Vec<f64> = (0..count)
            .map(|own| cases[own].excess() / found.expected(&cases[own].place, Some(own)))
            .collect();
        ratios.sort_by(f64::total_cmp);
        found.quantile = ratios[rank - 1];
        Some(found).filter(|found| found.quantile > 0.0)
    }

    /// Half width of the interval at `place`.
    pub fn half_width(&self, place: &Place) -> f64 {
        self.quantile * self.expected(place, None)
    }

    /// Median of the nearest cases' errors, without the case `own`, and the error stated at `place`.
    fn expected(&self, place: &Place, own: Option<usize>) -> f64 {
        let others = self.cases.iter().enumerate().filter(|(k, _)| Some(*k) != own);
        let mut near: Vec<(f64, f64)> =
            others.map(|(_, case)| (self.distance(place, &case.place), case.error)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let errors = near.iter().take(NEIGHBOURS).map(|(_, error)| *error).collect();
        median(errors).max(self.least) + place.stated
    }

    /// Square of the distance, coordinates in standard deviations.
    fn distance(&self, a: &Place, b: &Place) -> f64 {
        let (a, b) = (&a.coordinates, &b.coordinates);
        a.iter().zip(b).zip(&self.spread).map(|((a, b), spread)| ((a - b) / spread).powi(2)).sum()
    }
}

fn deviation(cases: &[SeenError], axis: usize) -> f64 {
    let count = cases.len() as f64;
    let values = || cases.iter().map(|case| case.place.coordinates[axis]);
    let mean = values().sum::<f64>() / count;
    let square = values().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    // all the same: no difference there
    if square > 0.0 { square.sqrt() } else { f64::INFINITY }
}

/// 0 of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn at(coordinates: Vec<f64>) -> Place {
        Place { coordinates, stated: 0.0 }
    }

    /// Errors whose size grows a hundredfold along the first coordinate, with long tails.
    fn cases(count: usize, seed: u64) -> Vec<SeenError> {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut draw = || {
            let place = at(vec![random.f64(), random.f64()]);
            let size = 10.0_f64.powf(2.0 * place.coordinates[0] - 4.0);
            let error = size * (-random.f64().ln()).powf(1.3);
            SeenError { place, error, noise: 0.0 }
        };
        (0..count).map(|_| draw()).collect()
    }

    /// Over 40 calibrations of 100 cases, 200 new ones each.
    #[test]
    fn the_stated_share_of_new_errors_lies_within() {
        let (mut within, mut all) = (0, 0);
        for seed in 0..40 {
            let known = cases(100, seed);
            let calibrated = ErrorScale::new(&known).unwrap();
            for case in cases(200, 1000 + seed) {
                within += usize::from(case.is_within(calibrated.half_width(&case.place)));
                all += 1;
            }
        }
        let share = within as f64 / all as f64;
        assert!((0.94..0.965).contains(&share), "{share}");
    }

    /// Errors of normal distribution, measured with as much noise: intervals hold the stated share of the errors alone, and are narrower
    /// than with the noise.
    #[test]
    fn noise_is_taken_out() {
        let (mut within, mut all, mut narrower) = (0, 0, 0);
        for seed in 0..100 {
            let mut random = fastrand::Rng::with_seed(seed);
            let mut normal = || (-2.0 * random.f64().ln()).sqrt() * (TAU * random.f64()).cos();
            let mut case = || {
                let (own, noise) = (normal(), normal());
                (SeenError { place: at(vec![0.0]), error: (own + noise).abs(), noise: 1.96 }, own.abs())
            };
            let known: Vec<SeenError> = (0..100).map(|_| case().0).collect();
            let half = ErrorScale::new(&known).unwrap().half_width(&at(vec![0.0]));
            let loud: Vec<SeenError> =
                known.iter().map(|case| SeenError { noise: 0.0, ..case.clone() }).collect();
            let with_noise = ErrorScale::new(&loud).unwrap().half_width(&at(vec![0.0]));
            narrower += usize::from(half < with_noise);
            within += (0..100).filter(|_| case().1 <= half).count();
            all += 100;
        }
        let share = within as f64 / all as f64;
        assert!((0.935..0.97).contains(&share), "{share}");
        assert_eq!(narrower, 100);
    }

    #[test]
    fn intervals_are_narrow_where_errors_are_small() {
        let known = cases(200, 7);
        let calibrated = ErrorScale::new(&known).unwrap();
        let [small, large] = [0.1, 0.9].map(|x| calibrated.half_width(&at(vec![x, 0.5])));
        assert!(large > 10.0 * small, "{small} {large}");
    }

    /// Cases that state their errors, which their places do not show.
    #[test]
    fn intervals_are_wide_where_a_case_states_an_error() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut case = |stated: f64| {
            let place = Place { coordinates: vec![random.f64()], stated };
            SeenError { place, error: (0.01 + stated) * random.f64(), noise: 0.0 }
        };
        let known: Vec<SeenError> = (0..200).map(|k| case(if k % 10 == 0 { 1.0 } else { 0.0 })).collect();
        let calibrated = ErrorScale::new(&known).unwrap();
        let [small, large] =
            [0.0, 1.0].map(|stated| calibrated.half_width(&Place { stated, ..at(vec![0.5]) }));
        assert!(large > 20.0 * small && large > 0.9, "{small} {large}");
    }

    /// 19 cases are the fewest that show what one in twenty exceeds.
    #[test]
    fn too_few_cases_give_no_interval() {
        assert!(ErrorScale::new(&cases(18, 1)).is_none());
        assert!(ErrorScale::new(&cases(19, 1)).is_some());
    }

    /// An interval without a width would be a promise.
    #[test]
    fn errors_below_those_of_the_references_give_no_interval() {
        let known: Vec<SeenError> =
            cases(100, 1).into_iter().map(|case| SeenError { noise: 1.0, ..case }).collect();
        assert!(ErrorScale::new(&known).is_none());
    }
}
