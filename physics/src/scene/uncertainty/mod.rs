//! How uncertain the numbers of a scene are: distributions by the names of their fields, and correlations.
//!
//! Every distribution is a monotone function of a standard normal score, so that correlated inputs are correlated scores
//! (a Gaussian copula: Nataf, C. R. Acad. Sci. 225, 1962; the coefficient of normal inputs is their own).

mod read;

pub(super) use read::{CORRELATIONS, DISTRIBUTIONS};

use libm::erfc;

/// Standard deviations from the mean, or the same share of a lognormal distribution, up to which a value has to be valid.
/// Beyond them lies one value in two millions on either side.
pub const REACH: f64 = 5.0;
/// Smallest pivot of a matrix of correlations that is taken for one, and not for none.
const PIVOT: f64 = 1e-12;

/// The uncertain inputs of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// The inputs, in the order of their names.
    pub inputs: Vec<UncertainInput>,
    /// Pairs of inputs that are correlated; all others are not.
    pub correlations: Vec<Correlation>,
}

/// A number of a scene that is not known exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct UncertainInput {
    /// Name of its field, as [`super::Field::path`].
    pub field: String,
    /// SI unit; "1" for a pure number.
    pub unit: &'static str,
    /// What the scene file says, in SI.
    pub nominal: f64,
    /// How it scatters.
    pub distribution: Distribution,
}

/// How a number scatters; all in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// Normal about the nominal value, with this standard deviation.
    Normal(Spread),
    /// Lognormal with the nominal value as mean, and this standard deviation.
    Lognormal(Spread),
    /// Anywhere between two bounds with the same probability.
    Uniform {
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
}

/// A standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spread {
    /// In the unit of the number.
    Absolute(f64),
    /// Over the magnitude of the nominal value.
    Relative(f64),
}

/// Two inputs that do not scatter independently.
#[derive(Debug, Clone, PartialEq)]
pub struct Correlation {
    /// Their places in [`Uncertainty::inputs`].
    pub between: [usize; 2],
    /// Coefficient of correlation of their normal scores, -1 to 1.
    pub coefficient: f64,
}

impl Spread {
    fn about(self, nominal: f64) -> f64 {
        match self {
            Spread::Absolute(deviation) => deviation,
            Spread::Relative(share) => share * nominal.abs(),
        }
    }
}

impl UncertainInput {
    /// The value at the standard normal `score`: its distribution's quantile of the score's probability.
    pub fn at(&self, score: f64) -> f64 {
        match self.distribution {
            Distribution::Normal(spread) => self.nominal + spread.about(self.nominal) * score,
            Distribution::Lognormal(spread) => {
                // mean m and deviation s: variance of the logarithm ln(1 + (s/m)^2)
                let variance = (spread.about(self.nominal) / self.nominal).powi(2).ln_1p();
                self.nominal * (variance.sqrt() * score - 0.5 * variance).exp()
            }
            Distribution::Uniform { low, high } => {
                low + (high - low) * 0.5 * erfc(-score * std::f64::consts::FRAC_1_SQRT_2)
            }
        }
    }

    /// Its mean.
    pub fn mean(&self) -> f64 {
        match self.distribution {
            Distribution::Uniform { low, high } => 0.5 * (low + high),
            _ => self.nominal,
        }
    }

    /// Its standard deviation.
    pub fn standard_deviation(&self) -> f64 {
        match self.distribution {
            Distribution::Normal(spread) | Distribution::Lognormal(spread) => spread.about(self.nominal),
            Distribution::Uniform { low, high } => (high - low) / 12.0_f64.sqrt(),
        }
    }

    /// Lowest and highest value that occur, but for one in two millions on either side.
    pub fn range(&self) -> [f64; 2] {
        match self.distribution {
            Distribution::Uniform { low, high } => [low, high],
            _ => [self.at(-REACH), self.at(REACH)],
        }
    }

    /// The same scatter about another `nominal` value: relative deviations stay relative, bounds move along.
    pub fn about(&self, nominal: f64) -> Self {
        let shift = nominal - self.nominal;
        let distribution = match self.distribution {
            Distribution::Uniform { low, high } => {
                Distribution::Uniform { low: low + shift, high: high + shift }
            }
            other => other,
        };
        Self { nominal, distribution, ..self.clone() }
    }
}

impl Uncertainty {
    /// Inputs that are correlated with each other, directly or through others, each group in ascending order; an input without
    /// correlation is a group of its own. The groups are independent of each other.
    pub fn groups(&self) -> Vec<Vec<usize>> {
        let mut of: Vec<usize> = (0..self.inputs.len()).collect();
        for Correlation { between: [a, b], .. } in &self.correlations {
            let (first, merged) = (of[*a].min(of[*b]), of[*a].max(of[*b]));
            of.iter_mut().filter(|group| **group == merged).for_each(|group| *group = first);
        }
        let members = |k: usize| (0..of.len()).filter(|i| of[*i] == k).collect::<Vec<_>>();
        (0..of.len()).map(members).filter(|group| !group.is_empty()).collect()
    }

    /// Lower triangular factor of the matrix of correlations, L L^T; `None` if the coefficients contradict each other, so that there
    /// are no such inputs. Shape (inputs, inputs).
    pub fn factor(&self) -> Option<Vec<Vec<f64>>> {
        let count = self.inputs.len();
        let mut matrix: Vec<Vec<f64>> =
            (0..count).map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect()).collect();
        for Correlation { between: [a, b], coefficient } in &self.correlations {
            (matrix[*a][*b], matrix[*b][*a]) = (*coefficient, *coefficient);
        }
        let mut factor = vec![vec![0.0; count]; count];
        for i in 0..count {
            for j in 0..=i {
                let rest: f64 = matrix[i][j] - (0..j).map(|k| factor[i][k] * factor[j][k]).sum::<f64>();
                factor[i][j] = match (i == j, factor[j][j]) {
                    (true, _) if rest < -PIVOT => return None,
                    (true, _) => {
                        if rest < PIVOT {
                            0.0
                        } else {
                            rest.sqrt()
                        }
                    }
                    // an input that those before it fix already has nothing of its own
                    (false, 0.0) if rest.abs() > PIVOT.sqrt() => return None,
                    (false, 0.0) => 0.0,
                    (false, pivot) => rest / pivot,
                };
            }
        }
        Some(factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(nominal: f64, distribution: Distribution) -> UncertainInput {
        UncertainInput { field: "x".into(), unit: "m", nominal, distribution }
    }

    /// Mean and standard deviation over scores, by the trapezoidal rule.
    fn moments(input: &UncertainInput) -> [f64; 2] {
        let step = 1e-3;
        let mean = |of: &dyn Fn(f64) -> f64| -> f64 {
            let weight = |z: f64| (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt();
            (-9000..=9000).map(|k| step * f64::from(k)).map(|z| step * weight(z) * of(input.at(z))).sum()
        };
        let first = mean(&|x| x);
        [first, mean(&|x| (x - first).powi(2)).sqrt()]
    }

    #[test]
    fn distributions_have_the_mean_and_the_deviation_they_state() {
        for of in [
            input(2e-3, Distribution::Normal(Spread::Relative(0.01))),
            input(-0.4, Distribution::Normal(Spread::Absolute(0.03))),
            input(210e9, Distribution::Lognormal(Spread::Relative(0.3))),
            input(5.0, Distribution::Lognormal(Spread::Absolute(1.0))),
            input(2.0, Distribution::Uniform { low: 1.8, high: 2.1 }),
        ] {
            let [mean, deviation] = moments(&of);
            assert!((mean / of.mean() - 1.0).abs() < 1e-6, "{of:?}: {mean}");
            assert!((deviation / of.standard_deviation() - 1.0).abs() < 1e-5, "{of:?}: {deviation}");
            let [low, high] = of.range();
            assert!(low < of.mean() && of.mean() < high);
            assert_eq!(of.about(of.nominal), of);
        }
    }

    #[test]
    fn distributions_move_with_the_nominal_value() {
        let relative = input(2.0, Distribution::Normal(Spread::Relative(0.01))).about(4.0);
        assert_eq!(relative.standard_deviation(), 0.04);
        let bounds = input(2.0, Distribution::Uniform { low: 1.5, high: 2.25 }).about(4.0);
        assert_eq!(bounds.range(), [3.5, 4.25]);
    }

    fn of_three(correlations: &[(usize, usize, f64)]) -> Uncertainty {
        let one = input(1.0, Distribution::Normal(Spread::Relative(0.1)));
        let correlation = |(a, b, coefficient): &(usize, usize, f64)| Correlation {
            between: [*a, *b],
            coefficient: *coefficient,
        };
        Uncertainty { inputs: vec![one; 3], correlations: correlations.iter().map(correlation).collect() }
    }

    #[test]
    fn the_factor_gives_the_correlations_back() {
        for given in
            [&[(0, 2, 0.5), (1, 2, -0.7)][..], &[(0, 1, 1.0), (1, 2, 0.3), (0, 2, 0.3)], &[(0, 1, -1.0)]]
        {
            let of = of_three(given);
            let factor = of.factor().expect("consistent");
            let product = |i: usize, j: usize| (0..3).map(|k| factor[i][k] * factor[j][k]).sum::<f64>();
            for (a, b, coefficient) in given {
                assert!((product(*a, *b) - coefficient).abs() < 1e-12, "{given:?}");
            }
            for i in 0..3 {
                assert!((product(i, i) - 1.0).abs() < 1e-12, "{given:?}");
            }
        }
        // two that are the same can't go differently with a third; nor can three exclude each other
        assert_eq!(of_three(&[(0, 1, 1.0), (0, 2, 0.5), (1, 2, -0.5)]).factor(), None);
        assert_eq!(of_three(&[(0, 1, -0.9), (0, 2, -0.9), (1, 2, -0.9)]).factor(), None);
    }

    #[test]
    fn groups_are_what_correlations_join() {
        assert_eq!(of_three(&[]).groups(), [[0], [1], [2]]);
        assert_eq!(of_three(&[(0, 2, 0.5)]).groups(), [vec![0, 2], vec![1]]);
        assert_eq!(of_three(&[(1, 2, 0.5), (0, 2, 0.1)]).groups(), [vec![0, 1, 2]]);
    }
}
