//! The impacts of a study, by number: nominal inputs, one input after the other moved by its standard deviation, then the
//! rows of the [design](super::design).

use super::design::Design;
use crate::scene::Uncertainty;
use crate::sweep::Draw;
use statrs::distribution::{ContinuousCDF, Normal};

/// What impact number 0 has.
pub(super) const NOMINAL: usize = 0;

/// Numbers for the uncertain fields of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Inputs {
    pub(super) uncertainty: Uncertainty,
    /// Lower triangular factor of their correlations. Shape (inputs, inputs).
    factor: Vec<Vec<f64>>,
    pub(super) design: Design,
}

impl Inputs {
    /// Samples of `uncertainty`; `None` if its correlations contradict each other.
    pub fn new(uncertainty: &Uncertainty, seed: u32) -> Option<Self> {
        let design = Design { factors: uncertainty.groups(), seed };
        Some(Self { factor: uncertainty.factor()?, uncertainty: uncertainty.clone(), design })
    }

    /// What the scene says of them.
    pub fn uncertainty(&self) -> &Uncertainty {
        &self.uncertainty
    }

    /// Where they are sampled.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// The same scatter about other nominal values: `designed` gives that of a field by its name, where it is another one.
    pub fn about(&self, designed: impl Fn(&str) -> Option<f64>) -> Self {
        let mut moved = self.clone();
        for input in &mut moved.uncertainty.inputs {
            if let Some(value) = designed(&input.field) {
                *input = input.about(value);
            }
        }
        moved
    }

    /// Number of the impact with input number `input` lowered (0) or raised (1).
    pub(super) fn moved(input: usize, side: usize) -> usize {
        1 + 2 * input + side
    }

    /// Number of the impact at point `k` of row `row`.
    pub(super) fn sampled(&self, row: usize, k: usize) -> usize {
        1 + 2 * self.uncertainty.inputs.len() + row * self.design.points() + k
    }

    /// The inputs where the unit cube has the point `at`. Shapes (inputs).
    pub fn place(&self, at: &[f64]) -> Vec<f64> {
        let normal = Normal::standard();
        let scores: Vec<f64> = at.iter().map(|u| normal.inverse_cdf(*u)).collect();
        let correlated = |row: &Vec<f64>| row.iter().zip(&scores).map(|(l, z)| l * z).sum::<f64>();
        self.uncertainty
            .inputs
            .iter()
            .zip(&self.factor)
            .map(|(input, row)| input.at(correlated(row)))
            .collect()
    }

    /// Input number `input` lowered or raised by its standard deviation, within its bounds.
    pub(super) fn shifted(&self, input: usize, side: usize) -> f64 {
        let of = &self.uncertainty.inputs[input];
        let [low, high] = of.range();
        (of.nominal + [-1.0, 1.0][side] * of.standard_deviation()).clamp(low, high)
    }
}

impl Draw for Inputs {
    fn numbers(&self, index: usize) -> Vec<f64> {
        let inputs = &self.uncertainty.inputs;
        let first = self.sampled(0, 0);
        if index >= first {
            let (row, k) = ((index - first) / self.design.points(), (index - first) % self.design.points());
            return self.place(&self.design.at(row, Design::point(k)));
        }
        let mut numbers: Vec<f64> = inputs.iter().map(|input| input.nominal).collect();
        if index != NOMINAL {
            let (input, side) = ((index - 1) / 2, (index - 1) % 2);
            numbers[input] = self.shifted(input, side);
        }
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Correlation, Distribution, Spread, UncertainInput};

    fn inputs() -> Inputs {
        let input =
            |nominal, distribution| UncertainInput { field: "x".into(), unit: "m", nominal, distribution };
        let uncertainty = Uncertainty {
            inputs: vec![
                input(2.0, Distribution::Normal(Spread::Relative(0.1))),
                input(5.0, Distribution::Uniform { low: 4.0, high: 5.2 }),
                input(3.0, Distribution::Normal(Spread::Absolute(0.3))),
            ],
            correlations: vec![Correlation { between: [0, 2], coefficient: -0.6 }],
        };
        Inputs::new(&uncertainty, 1).expect("consistent")
    }

    #[test]
    fn impacts_are_distinguished_by_their_number() {
        let inputs = inputs();
        assert_eq!(inputs.numbers(NOMINAL), [2.0, 5.0, 3.0]);
        assert_eq!(inputs.numbers(Inputs::moved(0, 0)), [1.8, 5.0, 3.0]);
        // a bound is not left
        assert_eq!(inputs.numbers(Inputs::moved(1, 1)), [2.0, 5.2, 3.0]);
        assert_eq!(inputs.design.factors, [vec![0, 2], vec![1]]);
        let [a, b, first, second] = [0, 1, 2, 3].map(|k| inputs.numbers(inputs.sampled(9, k)));
        assert_eq!((first[1], [second[0], second[2]]), (a[1], [a[0], a[2]]));
        // the correlated inputs are exchanged together
        assert_eq!(([first[0], first[2]], second[1]), ([b[0], b[2]], b[1]));
    }

    #[test]
    fn samples_have_the_deviations_and_correlations_stated() {
        let inputs = inputs();
        let points: Vec<Vec<f64>> = (0..4096).map(|row| inputs.numbers(inputs.sampled(row, 0))).collect();
        let mean =
            |of: &dyn Fn(&[f64]) -> f64| points.iter().map(|p| of(p)).sum::<f64>() / points.len() as f64;
        let middle = [0, 1, 2].map(|k| mean(&|p| p[k]));
        let covariance = |i: usize, j: usize| mean(&|p| (p[i] - middle[i]) * (p[j] - middle[j]));
        for (k, (expected, deviation)) in
            [(2.0, 0.2), (4.6, 1.2 / 12.0_f64.sqrt()), (3.0, 0.3)].into_iter().enumerate()
        {
            assert!((middle[k] - expected).abs() < 3e-3 * deviation, "{k}: {}", middle[k]);
            assert!((covariance(k, k).sqrt() / deviation - 1.0).abs() < 5e-3, "{k}: {}", covariance(k, k));
        }
        assert!((covariance(0, 2) / (0.2 * 0.3) + 0.6).abs() < 5e-3);
        assert!(covariance(0, 1).abs() < 5e-3 * 0.2 * 0.35);
    }
}
