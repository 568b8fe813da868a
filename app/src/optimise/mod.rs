//! Optimisation: the numbers of a scene, within bounds, with which most energy is transmitted, or another result is largest.

mod confirmation;
mod neighbourhood;
mod objective;
mod robust;
pub mod search;

pub use confirmation::{Confirmation, Rival, confirm};
pub use neighbourhood::{DEAR_POINTS, Neighbourhood, PROFILE_POINTS};
pub use objective::Objective;
pub use robust::{Robust, RobustOptimum};

use crate::error::{Error, Result};
use crate::format::{rounded, words};
use crate::kinds::{self, FollowedMesh, Series as Impacts, SeriesModel};
use crate::plot::{ChartPanel, Series, chart};
use crate::result::{CUT, Outcome, SCHEMA_VERSION, Summary};
use crate::scene::{Field, Model, Scene, Template};
use rayon::prelude::*;
use search::{Search, Tried, maximise};
use serde::Serialize;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Hears what a design is worth; whether the search is to go on.
pub type Watch<'a> = dyn Fn(Option<f64>) -> bool + Sync + 'a;

/// Relative error of the efficiency that the time integration may have: far below what tells two points apart.
const TOLERANCE: f64 = 1e-7;
/// The same where an impact takes tenths of a second.
const EXPENSIVE_TOLERANCE: f64 = 1e-4;
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

/// What to maximise, over what.
#[derive(Debug)]
pub struct Problem {
    template: Template,
    variables: Vec<Variable>,
    objective: Objective,
    model: Model,
    modes: Option<usize>,
    series: Box<dyn Impacts>,
    /// If a quantile of the objective is maximised.
    robust: Option<Robust>,
}

/// What was tried, in order; part of [`Optimum`].
#[derive(Debug, Clone, Serialize)]
pub struct Evaluation {
    /// 0 for the samples, then the number of the hill that was climbed.
    pub climb: usize,
    /// Values of the variables, SI.
    pub values: Vec<f64>,
    /// The objective there, or its quantile; `None` without result.
    pub objective: Option<f64>,
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
    /// Efficiency at the optimum; `None` without an inner body.
    pub efficiency: Option<f64>,
    /// What was maximised.
    pub objective: &'static str,
    /// Its SI unit.
    pub objective_unit: &'static str,
    /// Its value at the optimum.
    pub objective_value: f64,
    /// If a quantile of the efficiency was maximised: which, and how much it is there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robust: Option<RobustOptimum>,
    /// The variables: optimum and neighbourhood.
    pub variables: Vec<Neighbourhood>,
    /// Impacts that were run.
    pub evaluations: usize,
    /// How many of them had no result.
    pub failures: usize,
    /// Everything that was tried on the way.
    pub history: Vec<Evaluation>,
    /// Result of the reduced model at the optimum.
    pub summary: Summary,
}

impl Problem {
    /// The problem of the scene in `template`; a seal seat needs a `mesh` of it. With `robust` a quantile of the objective is maximised,
    /// under the scatter of what is made.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no variable, or a field is in two of them, or the kind of scene has no such model.
    pub fn new(
        template: Template,
        variables: Vec<Variable>,
        objective: Objective,
        (model, modes): (Model, Option<usize>),
        mesh: Option<&FollowedMesh>,
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
        let perturbed = robust.as_ref().map_or_else(Vec::new, |robust| robust.ranges(&variables));
        let impacts = if robust.is_some() { IMPACTS * robust::SAMPLES } else { IMPACTS };
        // the first that names a field is believed
        let ranges = perturbed.into_iter().chain(varied);
        let scene = template.scene();
        if !kinds::of(scene).models().contains(&model) {
            return Err(Error::Usage(format!("--model {model}: {}", kinds::models_only(scene))));
        }
        let series = kinds::series(ranges, scene, mesh, impacts)?;
        Ok(Problem { template, variables, objective, model, modes, series, robust })
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

    /// The objective of the scene with these `numbers`; `None` where there is no result.
    fn value(&self, numbers: &[(&Field, f64)]) -> Option<f64> {
        let scene = self.template.with(numbers).ok()?;
        let model = self.series.model(scene.clone(), self.model, self.modes).ok()?;
        let point = model.point(self.tolerance()).ok()?;
        self.objective.value(&scene, |name| point.quantities.value(name))
    }

    /// Relative error that the time integration may have.
    fn tolerance(&self) -> f64 {
        if self.series.is_expensive() { EXPENSIVE_TOLERANCE } else { TOLERANCE }
    }

    fn model(&self, values: &[f64]) -> Result<Box<dyn SeriesModel>> {
        self.series.model(self.scene(values)?, self.model, self.modes)
    }

    /// What is maximised, with `values` for the variables: the objective or its quantile; `None` where there is no result.
    fn worth(&self, values: &[f64]) -> Option<f64> {
        let numbers = self.numbers(values);
        let value = |numbers: &[(&Field, f64)]| self.value(numbers);
        self.robust.as_ref().map_or_else(|| value(&numbers), |robust| robust.quantile(&numbers, value))
    }

    /// The efficiency by `model`, with as many modes as it takes by itself.
    ///
    /// # Errors
    /// Those of the model.
    fn efficiency_of(&self, model: Model, values: &[f64]) -> Result<f64> {
        let scene = self.scene(values)?;
        let alone = kinds::series([], &scene, None, 1)?;
        let summary = alone.model(scene, model, None)?.run(TOLERANCE)?;
        summary.value("efficiency").ok_or_else(|| Error::Solver(CUT.into()))
    }

    /// The impact with `values` for the variables, with its history.
    ///
    /// # Errors
    /// As [`SeriesModel::run_with_history`].
    pub fn outcome(&self, values: &[f64]) -> Result<Outcome> {
        self.model(values)?.run_with_history(self.tolerance())
    }

    /// Searches the optimum; `seed` chooses the samples of a search over several variables, whose number is `samples` if given. `watch`
    /// hears what every design tried is worth, `None` without result; from when it says no, nothing has a result any more.
    ///
    /// # Errors
    /// [`Error::Solver`] if no scene within the bounds has a result.
    pub fn solve(&self, seed: u64, samples: Option<usize>, watch: &Watch) -> Result<Optimum> {
        let dimensions = self.variables.len();
        let search = match self.series.is_expensive() {
            false => Search { resolution: RESOLUTION, ..Search::of_dimensions(dimensions) },
            true => Search::of_expensive(dimensions),
        };
        let search = Search { seed, samples: samples.unwrap_or(search.samples), ..search };
        let place = |s: &[f64]| -> Vec<f64> {
            self.variables.iter().zip(s).map(|(variable, s)| variable.between(*s)).collect()
        };
        let goes_on = AtomicBool::new(true);
        let worth = |values: &[f64]| {
            let worth = if goes_on.load(Relaxed) { self.worth(values) } else { None };
            goes_on.fetch_and(watch(worth), Relaxed);
            worth
        };
        let maximum = maximise(dimensions, &search, |s| worth(&place(s)))?;
        let exact = place(&maximum.at);
        let evaluation = |tried: &Tried| Evaluation {
            climb: tried.climb,
            values: place(&tried.at),
            objective: tried.value,
        };
        let values: Vec<f64> = self
            .variables
            .iter()
            .zip(&exact)
            .map(|(v, x)| rounded(*x, DIGITS).clamp(v.low, v.high))
            .collect();
        let summary = self.model(&values)?.run(self.tolerance())?;
        let cut = || Error::Solver(CUT.into());
        let efficiency = summary.value("efficiency");
        let nominal =
            self.objective.value(&self.scene(&values)?, |name| summary.value(name)).ok_or_else(cut)?;
        let robust = match &self.robust {
            Some(robust) => {
                let quantile = self
                    .worth(&values)
                    .ok_or_else(|| Error::Solver("a sample of the optimum has no result".into()))?;
                Some(robust.found(quantile))
            }
            None => None,
        };
        let best = robust.map_or(nominal, |robust| robust.quantile);
        let at = |k: usize, x: f64| {
            let mut there = values.clone();
            there[k] = x;
            worth(&there)
        };
        let points = if self.series.is_expensive() { DEAR_POINTS } else { PROFILE_POINTS };
        let variables = (0..dimensions)
            .into_par_iter()
            .map(|k| Neighbourhood::of(&self.variables[k], values[k], best, points, |x| at(k, x)))
            .collect();
        Ok(Optimum {
            schema_version: SCHEMA_VERSION,
            scene: self.template.scene().name.clone(),
            model: self.model.to_string(),
            efficiency,
            objective: self.objective.name(),
            objective_unit: self.objective.unit(),
            objective_value: nominal,
            robust,
            variables,
            evaluations: maximum.history.len(),
            failures: maximum.history.iter().filter(|tried| tried.value.is_none()).count(),
            history: maximum.history.iter().map(evaluation).collect(),
            summary,
        })
    }
}

impl Optimum {
    /// The values of the variables, SI.
    pub fn values(&self) -> Vec<f64> {
        self.variables.iter().map(|variable| variable.optimum).collect()
    }

    /// The objective along every variable through the optimum, and on the way there, as a stand-alone SVG.
    pub fn figure(&self) -> String {
        let (label, factor) = match (self.objective, self.objective_unit) {
            ("efficiency", _) => ("Efficiency in %".to_owned(), 100.0),
            (name, "1") => (words(name), 1.0),
            (name, unit) => (format!("{} in {unit}", words(name)), 1.0),
        };
        let label = self
            .robust
            .map_or(label.clone(), |robust| format!("{} % quantile: {label}", 100.0 * robust.probability));
        let best = self.robust.map_or(self.objective_value, |robust| robust.quantile);
        let name = words(self.objective).to_lowercase();
        let panel = |variable: &Neighbourhood| ChartPanel {
            x_label: match variable.unit {
                "1" => variable.field.clone(),
                unit => format!("{} in {unit}", variable.field),
            },
            y_label: label.clone(),
            series: vec![
                Series {
                    name: format!("{name}, other variables at the optimum"),
                    points: variable.profile.iter().map(|[x, e]| (*x, factor * e)).collect(),
                    ..Series::default()
                },
                Series {
                    name: "optimum".into(),
                    points: vec![(variable.optimum, factor * best)],
                    marks: true,
                    ..Series::default()
                },
            ],
            ..ChartPanel::default()
        };
        let mut highest = f64::NEG_INFINITY;
        let so_far = self.history.iter().enumerate().filter_map(|(k, tried)| {
            highest = highest.max(tried.objective?);
            Some((k as f64 + 1.0, factor * highest))
        });
        let way = ChartPanel {
            x_label: "Impacts tried".into(),
            y_label: label.clone(),
            series: vec![Series {
                name: "best so far".into(),
                points: so_far.collect(),
                ..Series::default()
            }],
            ..ChartPanel::default()
        };
        let panels: Vec<ChartPanel> = self.variables.iter().map(panel).chain([way]).collect();
        chart(&format!("{}: optimum", self.scene), &panels)
    }

    /// What was tried as a table: its number, the climb, the variables with their units, the objective, empty without result.
    ///
    /// # Errors
    /// None but a defect of this program.
    pub fn history_csv(&self) -> Result<Vec<u8>> {
        let failed = |e: csv::Error| Error::Internal(format!("writing CSV: {e}"));
        let heading = |name: &str, unit: &str| match unit {
            "1" => name.to_owned(),
            unit => format!("{name} [{unit}]"),
        };
        let mut writer = csv::Writer::from_writer(Vec::new());
        let columns = self.variables.iter().map(|variable| heading(&variable.field, variable.unit));
        let objective = heading(self.objective, self.objective_unit);
        let first = ["number".to_owned(), "climb".to_owned()];
        writer.write_record(first.into_iter().chain(columns).chain([objective])).map_err(failed)?;
        for (k, tried) in self.history.iter().enumerate() {
            let values = tried.values.iter().map(f64::to_string);
            let objective = tried.objective.map_or(String::new(), |value| value.to_string());
            let first = [(k + 1).to_string(), tried.climb.to_string()];
            writer.write_record(first.into_iter().chain(values).chain([objective])).map_err(failed)?;
        }
        writer.into_inner().map_err(|e| Error::Internal(format!("writing CSV: {e}")))
    }
}
