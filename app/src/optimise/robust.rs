//! An optimum under scatter: not the objective of a design is maximised but a quantile of it, over what is made of the design.

use super::Variable;
use crate::error::{Error, Result};
use crate::scene::{Field, Template};
use crate::uncertainty::design::{Point, REPLICATES};
use crate::uncertainty::estimate::quantile;
use crate::uncertainty::{Inputs, uncertainty_of};
use serde::Serialize;

/// Samples of every design; the same points of the unit cube for all, so that designs differ by themselves and not by their samples.
pub(super) const SAMPLES: usize = 128;

/// The scatter of every design.
#[derive(Debug)]
pub struct Robust {
    probability: f64,
    inputs: Inputs,
    /// Of the inputs, in their order.
    fields: Vec<Field>,
}

/// What a robust search found; part of [`super::Optimum`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RobustOptimum {
    /// Probability of the quantile.
    pub probability: f64,
    /// The quantile of the objective at the optimum.
    pub quantile: f64,
    /// Samples of every design.
    pub samples: usize,
}

impl Robust {
    /// The quantile of `probability` under what the scene in `template` says of its inputs.
    ///
    /// # Errors
    /// As [`uncertainty_of`].
    pub fn new(template: &Template, probability: f64, seed: u64) -> Result<Self> {
        let uncertainty = uncertainty_of(template.scene())?;
        let inputs = Inputs::new(uncertainty, seed as u32)
            .ok_or_else(|| Error::Internal("correlations that were checked contradict each other".into()))?;
        let fields =
            uncertainty.inputs.iter().map(|input| template.field(&input.field)).collect::<Result<_>>()?;
        Ok(Robust { probability, inputs, fields })
    }

    /// The fields that scatter, and between what if the design lies within `variables`.
    pub(super) fn ranges(&self, variables: &[Variable]) -> Vec<(&str, [f64; 2])> {
        let range = |(field, input): (&'_ Field, &crate::scene::UncertainInput)| {
            let is_of = |variable: &&Variable| variable.fields.iter().any(|own| own.path() == field.path());
            match variables.iter().find(is_of) {
                Some(variable) => {
                    [input.about(variable.low).range()[0], input.about(variable.high).range()[1]]
                }
                None => input.range(),
            }
        };
        let inputs = self.fields.iter().zip(&self.inputs.uncertainty().inputs);
        inputs.map(|(field, input)| (field.path(), range((field, input)))).collect()
    }

    /// The quantile of `objective` over the samples of the design with these `numbers`; `None` if one of them has no result.
    pub(super) fn quantile<'a>(
        &'a self,
        numbers: &[(&'a Field, f64)],
        objective: impl Fn(&[(&'a Field, f64)]) -> Option<f64>,
    ) -> Option<f64> {
        let designed =
            |name: &str| numbers.iter().find(|(field, _)| field.path() == name).map(|(_, value)| *value);
        let inputs = self.inputs.about(designed);
        let sample = |k: usize| {
            // one sequence, which is more even than parts of several
            let perturbed = inputs.place(&inputs.design().at(k * REPLICATES, Point::A));
            let all: Vec<(&Field, f64)> =
                numbers.iter().copied().chain(self.fields.iter().zip(perturbed)).collect();
            objective(&all)
        };
        let mut values = (0..SAMPLES).map(sample).collect::<Option<Vec<f64>>>()?;
        values.sort_by(f64::total_cmp);
        Some(quantile(&values, self.probability))
    }

    /// What was found with this `quantile` at the optimum.
    pub(super) fn found(&self, quantile: f64) -> RobustOptimum {
        RobustOptimum { probability: self.probability, quantile, samples: SAMPLES }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = include_str!("../../../scenes/scaled-plate-r10.toml");

    /// A normal thickness of 1 % of the design: the 5 % quantile of the thickness itself lies 1.645 % below.
    #[test]
    fn the_input_uncertainty_moves_with_the_design() {
        let text = format!("{SCENE}\n[uncertainty]\n\"plate.thickness\" = \"1 %\"\n");
        let template = Template::parse("scene", &text).unwrap();
        let robust = Robust::new(&template, 0.05, 1).unwrap();
        let thickness = template.field("plate.thickness").unwrap();
        for design in [1e-3, 3e-3] {
            let last = |numbers: &[(&Field, f64)]| numbers.last().map(|(_, value)| *value);
            let found = robust.quantile(&[(&thickness, design)], last).unwrap();
            assert!((found / design - 1.0 + 0.01645).abs() < 3e-4, "{found:e}");
        }
        assert_eq!(robust.quantile(&[(&thickness, 1e-3)], |_| None), None);
        let variable = Variable::parse("plate.thickness=1mm..3mm", &template).unwrap();
        let ranges = robust.ranges(&[variable]);
        assert!(
            (ranges[0].1[0] - 0.95e-3).abs() < 1e-9 && (ranges[0].1[1] - 3.15e-3).abs() < 1e-9,
            "{ranges:?}"
        );
    }
}
