//! Optimisation: the numbers of a scene, within bounds, with which most energy is transmitted.

mod confirmation;
mod neighbourhood;
mod robust;
pub mod search;

pub use confirmation::{Confirmation, Rival, confirm};
pub use neighbourhood::{Neighbourhood, PROFILE_POINTS};
pub use robust::{Robust, RobustOptimum};

use crate::error::{Error, Result};
use crate::kinds::plate_impact::reduced::Reduced;
use crate::kinds::plate_impact::shared::SharedBodies;
use crate::report::{ChartPanel, Series, chart};
use crate::result::{CUT, Outcome, SCHEMA_VERSION, Summary};
use crate::scene::{Field, Model, Scene, Template};
use rayon::prelude::*;
use search::{Search, maximise};
use serde::Serialize;

/// Relative error of the efficiency that the time integration may have: far below what tells two points apart.
const TOLERANCE: f64 = 1e-7;
/// Impacts that a search may be expected to take.
const IMPACTS: usize = 100;
/// Significant digits of the optimum: more are lost in how flat it is, and fewer make a scene one can name.
const DIGITS: usize = 4;
/// Length, relative to the bounds' distance, to which the optimum is located.
const RESOLUTION: f64 = 1e-5;

/// A number that is free within bounds; several fields may take the same.
#[derive(Debug, Clone)]
pub struct Variable {
    /// The fields that take it.
    pub fields: Vec<Field>,
    /// Lowest value, SI.
    pub low: f64,
    /// Highest value, SI.
    pub high: f64,
}

impl Variable {
    /// Reads `outer.radius=2mm..8mm` or, for fields with the same value, `outer.radius,inner.radius=2mm..8mm`.
    ///
    /// # Errors
    /// [`Error::Usage`] for what is not of this form, a field that the scene has not, and bounds that are not valid.
    pub fn parse(text: &str, template: &Template) -> Result<Self> {
        let form = || {
            Error::Usage(format!("--over {text}: write FIELD=LOW..HIGH, for example outer.radius=2mm..8mm"))
        };
        let (names, range) = text.split_once('=').ok_or_else(form)?;
        let (low, high) = range.split_once("..").ok_or_else(form)?;
        let fields: Vec<Field> =
            names.split(',').map(|name| template.field(name.trim())).collect::<Result<_>>()?;
        let lead = &fields[0];
        if let Some(field) = fields.iter().find(|field| field.unit() != lead.unit()) {
            return Err(Error::Usage(format!(
                "--over {text}: `{}` and `{}` have different units, {} and {}",
                lead.path(),
                field.path(),
                lead.unit(),
                field.unit()
            )));
        }
        if let Some(field) = fields.iter().find(|field| field.is_count()) {
            return Err(Error::Usage(format!(
                "--over {text}: `{}` takes whole numbers, which are not optimised; a sweep varies them",
                field.path()
            )));
        }
        let (low, high) = (lead.parse(low)?, lead.parse(high)?);
        if low >= high {
            return Err(Error::Usage(format!(
                "--over {text}: the low end, {low}, is not below the high end, {high}"
            )));
        }
        for field in &fields {
            for end in [low, high] {
                field.check(end).map_err(|rejected| Error::Usage(format!("--over {text}: {rejected}")))?;
            }
        }
        Ok(Variable { fields, low, high })
    }

    /// The name of its fields.
    pub fn name(&self) -> String {
        self.fields.iter().map(Field::path).collect::<Vec<_>>().join(",")
    }

    /// The value at `s` in 0..=1 between the bounds.
    fn between(&self, s: f64) -> f64 {
        self.low + (self.high - self.low) * s
    }
}

/// What to maximise the efficiency of, over what.
#[derive(Debug)]
pub struct Problem {
    template: Template,
    variables: Vec<Variable>,
    model: Model,
    modes: Option<usize>,
    bodies: SharedBodies,
    /// If a quantile of the efficiency is maximised.
    robust: Option<Robust>,
}

/// The optimum; part of the document of `optimise --json`.
#[derive(Debug, Clone, Serialize)]
pub struct Optimum {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Name of the scene that was varied.
    pub scene: String,
    /// Name of the reduced model.
    pub model: String,
    /// Efficiency at the optimum.
    pub efficiency: f64,
    /// If a quantile of the efficiency was maximised: which, and how much it is there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robust: Option<RobustOptimum>,
    /// The variables: optimum and neighbourhood.
    pub variables: Vec<Neighbourhood>,
    /// Impacts that were run.
    pub evaluations: usize,
    /// How many of them had no result.
    pub failures: usize,
    /// Result of the reduced model at the optimum.
    pub summary: Summary,
}

impl Problem {
    /// The problem of the scene in `template`; with `robust` a quantile of the efficiency is maximised, under the scatter of what is made.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no variable, or a field is in two of them.
    pub fn new(
        template: Template,
        variables: Vec<Variable>,
        model: Model,
        modes: Option<usize>,
        robust: Option<Robust>,
    ) -> Result<Self> {
        let mut names: Vec<&str> = variables.iter().flat_map(|v| &v.fields).map(Field::path).collect();
        names.sort_unstable();
        if names.is_empty() {
            return Err(Error::Usage(
                "there is nothing to optimise over: give --over FIELD=LOW..HIGH".into(),
            ));
        }
        if let Some(twice) = names.windows(2).find(|w| w[0] == w[1]) {
            return Err(Error::Usage(format!("--over names `{}` twice", twice[0])));
        }
        let varied = variables.iter().flat_map(|variable| {
            variable.fields.iter().map(|field| (field.path(), [variable.low, variable.high]))
        });
        let scattered = robust.as_ref().map_or_else(Vec::new, |robust| robust.ranges(&variables));
        let impacts = if robust.is_some() { IMPACTS * robust::SAMPLES } else { IMPACTS };
        // the first that names a field is believed
        let ranges = scattered.into_iter().chain(varied);
        let bodies = SharedBodies::for_varied(ranges, template.scene().plate_impact()?, impacts);
        Ok(Problem { template, variables, model, modes, bodies, robust })
    }

    fn numbers<'a>(&'a self, values: &[f64]) -> Vec<(&'a Field, f64)> {
        let of = |(variable, value): (&'a Variable, &f64)| {
            let value = *value;
            variable.fields.iter().map(move |field| (field, value))
        };
        self.variables.iter().zip(values).flat_map(of).collect()
    }

    /// The scene with `values` for the variables.
    ///
    /// # Errors
    /// [`Error::Usage`] if they are out of bounds.
    pub fn scene(&self, values: &[f64]) -> Result<Scene> {
        let scene = self.template.with(&self.numbers(values)).map_err(|e| Error::Usage(e.to_string()))?;
        let name: String = scene.name.chars().take(90).collect();
        Ok(Scene { name: format!("{name}-optimum"), ..scene })
    }

    /// The scene file with `values` for the variables.
    ///
    /// # Errors
    /// As [`Template::text_with`].
    pub fn scene_text(&self, values: &[f64]) -> Result<String> {
        let scene = self.scene(values)?;
        self.template.text_with(&scene.name, &self.numbers(values))
    }

    /// The reduced model with `values` for the variables.
    fn reduced(&self, values: &[f64]) -> Result<Reduced> {
        Reduced::in_series(self.scene(values)?, self.model, self.modes, &self.bodies)
    }

    /// What is maximised, with `values` for the variables: the efficiency or its quantile; `None` where there is no result.
    fn worth(&self, values: &[f64]) -> Option<f64> {
        let numbers = self.numbers(values);
        let efficiency = |numbers: &[(&Field, f64)]| {
            let scene = self.template.with(numbers).ok()?;
            let reduced = Reduced::in_series(scene, self.model, self.modes, &self.bodies).ok()?;
            Some(reduced.point(TOLERANCE).ok()?.quantities.efficiency)
        };
        self.robust
            .as_ref()
            .map_or_else(|| efficiency(&numbers), |robust| robust.quantile(&numbers, efficiency))
    }

    /// The efficiency by `model`, with as many modes as it takes by itself.
    ///
    /// # Errors
    /// Those of the model.
    fn efficiency_of(&self, model: Model, values: &[f64]) -> Result<f64> {
        let reduced = Reduced::new(&self.scene(values)?, model, None)?;
        Ok(reduced.point(TOLERANCE)?.quantities.efficiency)
    }

    /// The impact with `values` for the variables, with its history.
    ///
    /// # Errors
    /// As [`Reduced::run_with_history`].
    pub fn outcome(&self, values: &[f64]) -> Result<Outcome> {
        self.reduced(values)?.run_with_history(TOLERANCE)
    }

    /// Searches the optimum; `seed` chooses the samples of a search over several variables.
    ///
    /// # Errors
    /// [`Error::Solver`] if no scene within the bounds has a result.
    pub fn solve(&self, seed: u64) -> Result<Optimum> {
        let dimensions = self.variables.len();
        let search = Search { seed, resolution: RESOLUTION, ..Search::of_dimensions(dimensions) };
        let place = |s: &[f64]| -> Vec<f64> {
            self.variables.iter().zip(s).map(|(variable, s)| variable.between(*s)).collect()
        };
        let maximum = maximise(dimensions, &search, |s| self.worth(&place(s)))?;
        let exact = place(&maximum.at);
        let values: Vec<f64> =
            self.variables.iter().zip(&exact).map(|(v, x)| rounded(*x).clamp(v.low, v.high)).collect();
        let summary = self.reduced(&values)?.run(TOLERANCE)?;
        let efficiency = summary.value("efficiency").ok_or_else(|| Error::Solver(CUT.into()))?;
        let robust = match &self.robust {
            Some(robust) => {
                let quantile = self
                    .worth(&values)
                    .ok_or_else(|| Error::Solver("a sample of the optimum has no result".into()))?;
                Some(robust.found(quantile))
            }
            None => None,
        };
        let best = robust.map_or(efficiency, |robust| robust.quantile);
        let at = |k: usize, x: f64| {
            let mut there = values.clone();
            there[k] = x;
            self.worth(&there)
        };
        let variables = (0..dimensions)
            .into_par_iter()
            .map(|k| Neighbourhood::of(&self.variables[k], values[k], best, |x| at(k, x)))
            .collect();
        Ok(Optimum {
            schema_version: SCHEMA_VERSION,
            scene: self.template.scene().name.clone(),
            model: self.model.to_string(),
            efficiency,
            robust,
            variables,
            evaluations: maximum.evaluations,
            failures: maximum.failures,
            summary,
        })
    }
}

impl Optimum {
    /// The values of the variables, SI.
    pub fn values(&self) -> Vec<f64> {
        self.variables.iter().map(|variable| variable.optimum).collect()
    }

    /// Efficiency along every variable through the optimum, as a stand-alone SVG.
    pub fn figure(&self) -> String {
        let best = self.robust.map_or(self.efficiency, |robust| robust.quantile);
        let of = self.robust.map_or("Efficiency in %".to_owned(), |robust| {
            format!("{} % quantile of the efficiency in %", 100.0 * robust.probability)
        });
        let panel = |variable: &Neighbourhood| ChartPanel {
            x_label: match variable.unit {
                "1" => variable.field.clone(),
                unit => format!("{} in {unit}", variable.field),
            },
            y_label: of.clone(),
            series: vec![
                Series {
                    name: "efficiency, other variables at the optimum".into(),
                    points: variable.profile.iter().map(|[x, e]| (*x, 100.0 * e)).collect(),
                    ..Series::default()
                },
                Series {
                    name: "optimum".into(),
                    points: vec![(variable.optimum, 100.0 * best)],
                    marks: true,
                    ..Series::default()
                },
            ],
            ..ChartPanel::default()
        };
        chart(&format!("{}: optimum", self.scene), &self.variables.iter().map(panel).collect::<Vec<_>>())
    }
}

/// `value` with [`DIGITS`] significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}
