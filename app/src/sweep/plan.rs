//! What a sweep file asks for, as numbered points.

use super::axis::{Sampling, SweepAxis, Vary};
use super::record::{Outcome, Record, results};
use crate::error::{Error, Result};
use crate::kinds::{self, FollowedMesh, Series, Use};
use crate::reference;
use crate::sampling::latin_hypercube;
use crate::scene::hash::{canonical, drop_inelastic, sha256_hex};
use crate::scene::{self, Field, Model, Scene, Template};
use serde::Deserialize;
use serde_json::{Value, json};
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

/// Relative error that the time integration may have in all results when the file names none.
pub const DEFAULT_TOLERANCE: f64 = 1e-3;
/// Counts changes of the numbers that the same sweep gives.
const METHOD: u32 = 4;
/// Most points of a sweep.
const MOST_POINTS: usize = 100_000_000;

/// The keys of a sweep file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
struct File {
    scene: String,
    model: Option<Models>,
    modes: Option<usize>,
    mesh: Option<PathBuf>,
    tolerance: Option<f64>,
    #[serde(default)]
    sampling: Sampling,
    samples: Option<usize>,
    seed: Option<u64>,
    vary: Vec<Vary>,
}

/// One reduced model, or several at every point.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Models {
    One(String),
    Several(Vec<String>),
}

/// A sweep: numbered points, each an impact.
#[derive(Debug)]
pub struct Plan {
    scene_file: PathBuf,
    template: Template,
    /// The points are run with one after the other.
    models: Vec<Model>,
    modes: Option<usize>,
    tolerance: f64,
    axes: Vec<SweepAxis>,
    points: Points,
    hash: String,
    series: Box<dyn Series>,
    /// Name and unit of the numbers of a result.
    results: Vec<(&'static str, &'static str)>,
}

/// Where the numbers of a point come from.
#[derive(Debug)]
enum Points {
    /// Every combination of the axes' values.
    Grid,
    /// Points of the unit cube of the axes.
    Samples(Vec<Vec<f64>>),
    /// So many draws of fields without axes.
    Draws(Vec<Field>, Box<dyn Draw>, usize),
}

impl Points {
    /// Number of points of one model, whose grid is that of `axes`.
    fn count(&self, axes: &[SweepAxis]) -> usize {
        match self {
            Points::Grid => axes.iter().map(|axis| axis.values.len()).product(),
            Points::Samples(samples) => samples.len(),
            Points::Draws(.., count) => *count,
        }
    }
}

/// Numbers for the fields of a plan that come from elsewhere than its axes. What it prints for debugging tells it from any other.
pub trait Draw: std::fmt::Debug + Send + Sync {
    /// The numbers of point `index`, in SI, one per field; they don't depend on how many points there are.
    fn numbers(&self, index: usize) -> Vec<f64>;
}

impl Plan {
    /// Reads the sweep file at `path` and the scene it names: a path relative to it, or a shipped scene's name.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no such file, scene or field, [`Error::Scene`] if the file makes no sense or its
    /// scene is not valid.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|e| match e.kind() {
            std::io::ErrorKind::NotFound => {
                Error::Usage(format!("there is no sweep file {}", path.display()))
            }
            std::io::ErrorKind::InvalidData => invalid(path, "is not a text in UTF-8"),
            _ => Error::io("reading", path, e),
        })?;
        let file: File =
            toml::from_str(&text).map_err(|e| invalid(path, &format!("is no sweep file: {e}")))?;
        let near_plan = path.parent().unwrap_or(Path::new("")).join(&file.scene);
        let scene = if near_plan.is_file() { near_plan } else { scene::resolve(&file.scene)? };
        Self::new(path, file, scene.clone(), Template::read(&scene)?)
    }

    fn new(path: &Path, file: File, scene_file: PathBuf, template: Template) -> Result<Self> {
        let fault = |message: String| invalid(path, &message);
        let models = models(&file, template.scene(), &fault)?;
        if file.modes == Some(0) || (models.contains(&Model::A) && file.modes.is_some_and(|modes| modes != 1))
        {
            return Err(fault(format!(
                "modes is {:?}: model A has one mode, others at least one",
                file.modes
            )));
        }
        let tolerance = file.tolerance.unwrap_or(DEFAULT_TOLERANCE);
        if !(1e-12..=1e-2).contains(&tolerance) {
            return Err(fault(format!("tolerance is {tolerance}, but it must be within 1e-12 to 1e-2")));
        }
        if file.vary.is_empty() {
            return Err(fault("varies nothing: add a table [[vary]]".into()));
        }
        let axes = file.vary.iter().enumerate();
        let axes: Vec<SweepAxis> = axes
            .map(|(k, vary)| {
                SweepAxis::new(vary, file.sampling, &template, &|m| {
                    fault(format!("[[vary]] number {}: {m}", k + 1))
                })
            })
            .collect::<Result<_>>()?;
        let mut taken: Vec<&str> = axes.iter().flat_map(|a| &a.fields).map(Field::path).collect();
        taken.sort_unstable();
        if let Some(twice) = taken.windows(2).find(|w| w[0] == w[1]) {
            return Err(fault(format!("`{}` is varied twice", twice[0])));
        }
        let samples = samples(&file, axes.len(), &fault)?;
        let count = axes.iter().try_fold(models.len(), |n, a| n.checked_mul(a.values.len()));
        if samples.is_none() && count.is_none_or(|n| n > MOST_POINTS) {
            return Err(fault(format!("the grid has more than {MOST_POINTS} points")));
        }
        let mesh = file.mesh.as_ref().map(|mesh| path.parent().unwrap_or(Path::new("")).join(mesh));
        let mesh = reference::mesh_to_follow(template.scene(), mesh.as_deref())?;
        let varied = axes.iter().flat_map(|axis| {
            let (from, to) = axis.values.range().into_inner();
            axis.fields.iter().map(move |field| (field.path(), [from, to]))
        });
        let points = samples.map_or(Points::Grid, Points::Samples);
        let impacts = models.len() * points.count(&axes);
        let series = kinds::series(varied, template.scene(), mesh.as_ref(), impacts)?;
        let mut plan = Plan {
            results: results(kinds::of(template.scene())),
            scene_file,
            template,
            models,
            modes: file.modes,
            tolerance,
            axes,
            points,
            hash: String::new(),
            series,
        };
        plan.hash = plan.identity(&file, mesh.as_ref());
        Ok(plan)
    }

    /// Impacts of the scene in `template`, read from `scene_file`, whose `fields`, each with the range it varies in, take what `draw` says;
    /// about so many `impacts` will be run, none as yet.
    ///
    /// # Errors
    /// [`Error::Scene`] if scenes of this kind are not sampled.
    pub fn drawn(
        (scene_file, template): (PathBuf, Template),
        (model, modes, tolerance): (Model, Option<usize>, f64),
        fields: Vec<(Field, [f64; 2])>,
        draw: Box<dyn Draw>,
        impacts: usize,
    ) -> Result<Self> {
        let ranges = fields.iter().map(|(field, range)| (field.path(), *range));
        kinds::serving(template.scene(), Use::Samples)?;
        let series = kinds::series(ranges, template.scene(), None, impacts)?;
        let fields: Vec<Field> = fields.into_iter().map(|(field, _)| field).collect();
        let mut plan = Plan {
            results: results(kinds::of(template.scene())),
            scene_file,
            template,
            models: vec![model],
            modes,
            tolerance,
            axes: Vec::new(),
            points: Points::Draws(fields, draw, 0),
            hash: String::new(),
            series,
        };
        plan.hash = plan.identified(&json!({ "draws": format!("{:?}", plan.points) }));
        Ok(plan)
    }

    /// Has `count` points from now on, the first of which are those it had; only of a plan that is [drawn](Self::drawn).
    pub fn grow(&mut self, count: usize) {
        if let Points::Draws(.., points) = &mut self.points {
            *points = count;
        }
    }

    /// SHA-256 over everything the results depend on.
    fn identity(&self, file: &File, mesh: Option<&FollowedMesh>) -> String {
        let axis = |a: &SweepAxis| {
            let fields: Vec<&str> = a.fields.iter().map(Field::path).collect();
            json!([fields, format!("{:?}", a.values)])
        };
        let axes: Vec<_> = self.axes.iter().map(axis).collect();
        let mut points = json!({ "samples": file.samples, "seed": file.seed, "axes": axes });
        if let Some(mesh) = mesh {
            points["mesh"] = json!(mesh.content_hash());
        }
        self.identified(&points)
    }

    /// SHA-256 over the scene, the models and what the table `points` says of the points.
    fn identified(&self, points: &Value) -> String {
        let mut identity = json!({
            "version": env!("CARGO_PKG_VERSION"), "method": METHOD, "setup": self.template.scene().setup,
            "run": self.template.scene().run, "reduced": self.template.scene().reduced,
            "model": if let [one] = self.models[..] { json!(one) } else { json!(self.models) }, "modes": self.modes, "tolerance": self.tolerance,
        });
        for (key, value) in points.as_object().into_iter().flatten() {
            identity[key] = value.clone();
        }
        drop_inelastic(&mut identity);
        sha256_hex(canonical(&identity).as_bytes())
    }

    /// Number of points, each model's counted by itself.
    pub fn len(&self) -> usize {
        self.places() * self.models.len()
    }

    /// Number of points of one model.
    fn places(&self) -> usize {
        self.points.count(&self.axes)
    }

    /// Whether there is no point; never so for a plan that was read.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// SHA-256 (hexadecimal) of everything the results depend on.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Name of the scene that is varied.
    pub fn scene(&self) -> &str {
        &self.template.scene().name
    }

    /// The file of the scene that is varied.
    pub fn scene_file(&self) -> &Path {
        &self.scene_file
    }

    /// The scene that is varied.
    pub fn template(&self) -> &Template {
        &self.template
    }

    /// The reduced models that run.
    pub fn models(&self) -> &[Model] {
        &self.models
    }

    /// The model of point `index`.
    pub fn model(&self, index: usize) -> Model {
        self.models[index / self.places()]
    }

    /// What is varied by itself, with more than one value: the numbers of its fields among [`Plan::numbers`], and whether its
    /// values are evenly spread over their logarithm.
    pub fn parameters(&self) -> Vec<(Range<usize>, bool)> {
        let mut first = 0;
        let placed = self.axes.iter().map(|axis| {
            let fields = first..first + axis.fields.len();
            first = fields.end;
            (axis, fields)
        });
        let varied = placed.filter(|(axis, _)| self.is_varied(axis));
        varied.map(|(axis, fields)| (fields, axis.values.is_logarithmic())).collect()
    }

    /// Whether an axis has more than one value.
    fn is_varied(&self, axis: &SweepAxis) -> bool {
        axis.values.len() > 1 || !self.is_grid()
    }

    /// Lowest and highest value of each of the [`Plan::parameters`], SI.
    pub fn ranges(&self) -> Vec<RangeInclusive<f64>> {
        self.axes.iter().filter(|axis| self.is_varied(axis)).map(|axis| axis.values.range()).collect()
    }

    /// Whether the points are all of a grid.
    pub fn is_grid(&self) -> bool {
        matches!(self.points, Points::Grid)
    }

    /// The fields that are varied, in the order of [`Plan::numbers`].
    pub fn fields(&self) -> impl Iterator<Item = &Field> {
        let drawn = if let Points::Draws(fields, ..) = &self.points { &fields[..] } else { &[] };
        self.axes.iter().flat_map(|axis| &axis.fields).chain(drawn)
    }

    /// The numbers of point `index` in SI, one per field. The last axis of a grid changes fastest.
    pub fn numbers(&self, index: usize) -> Vec<f64> {
        let mut values = vec![0.0; self.axes.len()];
        let index = index % self.places();
        match &self.points {
            Points::Draws(_, draw, _) => return draw.numbers(index),
            Points::Samples(samples) => {
                for ((value, axis), s) in values.iter_mut().zip(&self.axes).zip(&samples[index]) {
                    *value = axis.values.of_sample(*s);
                }
            }
            Points::Grid => {
                let mut rest = index;
                for (value, axis) in values.iter_mut().zip(&self.axes).rev() {
                    *value = axis.values.of_grid(rest % axis.values.len());
                    rest /= axis.values.len();
                }
            }
        }
        let counts = self.axes.iter().map(|axis| axis.fields.len());
        values.iter().zip(counts).flat_map(|(value, count)| std::iter::repeat_n(*value, count)).collect()
    }

    /// Name and unit of the numbers of a result, in their order.
    pub fn results(&self) -> &[(&'static str, &'static str)] {
        &self.results
    }

    /// The number called `name` of the result of `record`; `None` if it has none.
    pub fn value(&self, record: &Record, name: &str) -> Option<f64> {
        let place = self.results.iter().position(|(known, _)| *known == name)?;
        record.outcome.numbers().map(|numbers| numbers[place])
    }

    /// Whether every point takes tenths of a second.
    pub(super) fn is_expensive(&self) -> bool {
        self.series.is_expensive()
    }

    /// Runs point `index`. A scene that is not valid and a solver that fails are results too.
    pub fn evaluate(&self, index: usize) -> Record {
        let numbers: Vec<(&Field, f64)> = self.fields().zip(self.numbers(index)).collect();
        let outcome = match self.template.with(&numbers) {
            Err(rejected) => Outcome::Invalid(rejected.to_string()),
            Ok(scene) => {
                let model = self.series.model(scene, self.model(index), self.modes);
                let run = model.and_then(|model| model.point(self.tolerance));
                run.map_or_else(|error| Outcome::Failed(error.to_string()), Outcome::from)
            }
        };
        Record { index, outcome }
    }
}

/// The models that `file` names, else that of `scene`, else B or the only one there is.
fn models(file: &File, scene: &Scene, fault: &dyn Fn(String) -> Error) -> Result<Vec<Model>> {
    let own = kinds::of(scene).models();
    let names = match &file.model {
        Some(Models::One(name)) => std::slice::from_ref(name),
        Some(Models::Several(names)) => names,
        None => {
            let usual = if own.contains(&Model::B) { Model::B } else { own[0] };
            return Ok(vec![scene.reduced.model.unwrap_or(usual)]);
        }
    };
    let parsed = names.iter().map(|name| name.parse().map_err(|e| fault(format!("model: {e}"))));
    let models: Vec<Model> = parsed.collect::<Result<_>>()?;
    if models.is_empty() || (1..models.len()).any(|k| models[..k].contains(&models[k])) {
        return Err(fault(format!("model is {names:?}: name each model once, at least one")));
    }
    if let Some(foreign) = models.iter().find(|model| !own.contains(model)) {
        return Err(fault(format!("model is {foreign}, but {}", kinds::models_only(scene))));
    }
    Ok(models)
}

/// The points of the unit cube that `file` asks for; `None` of a grid.
fn samples(file: &File, axes: usize, fault: &dyn Fn(String) -> Error) -> Result<Option<Vec<Vec<f64>>>> {
    const MOST: usize = MOST_POINTS / 10;
    match (file.sampling, file.samples) {
        (Sampling::Grid, None) if file.seed.is_none() => Ok(None),
        (Sampling::Grid, _) => Err(fault("samples and seed belong to sampling = \"latin-hypercube\"".into())),
        (Sampling::LatinHypercube, Some(samples)) if (1..=MOST).contains(&samples) => {
            Ok(Some(latin_hypercube(samples, axes, file.seed.unwrap_or(1))))
        }
        (Sampling::LatinHypercube, samples) => {
            let found = samples.map_or("missing".into(), |n| n.to_string());
            Err(fault(format!("samples is {found}: a Latin hypercube needs 1 to {MOST}")))
        }
    }
}

fn invalid(path: &Path, message: &str) -> Error {
    Error::Scene(miette::miette!(
        help = "`impactcheck study sweep --help` shows a sweep file",
        "{}: {message}",
        path.display()
    ))
}
