//! A comparison from scenes to the report: what `compare` and `gate` do alike.

use super::compare_arguments::Arguments;
use super::compare_inputs;
use super::external;
use super::live;
use super::propagated::propagate;
use super::requested_model::RequestedModel;
use super::second_program;
use super::stored_references::{look_up, report_reused};
use super::{Context, kinds, validated_scenes};
use crate::ci::commit::Commit;
use crate::ci::{acceptance, trend};
use crate::comparison::{Comparison, ComparisonInput, GateRules, SceneComparison, budget};
use crate::error::{Error, Result};
use crate::file::write_file;
use crate::measured::{self, Measured, Record};
use crate::reference::{Resolution, Stored};
use crate::report::{self, Attachments, Cost, Export, FigureFile, Report, SceneReport, Width};
use crate::result::{Outcome, SCHEMA_VERSION, Summary};
use crate::scene::Scene;
use crate::validated::Validation;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Results over commits, beside the report.
const TRENDS: &str = "trends.jsonl";

/// Scenes to compare, read and checked.
pub(super) struct Job<'a> {
    start: Instant,
    arguments: &'a Arguments,
    /// Scene files, and what they say.
    pub(super) scenes: Vec<(PathBuf, Scene)>,
    records: Vec<Record>,
    figures: Vec<(PathBuf, &'static dyn Export<FigureFile>)>,
}

/// Reference and reduced models of one scene.
pub(super) struct Results {
    stored: Stored,
    reduced: Vec<Outcome>,
    /// What the models have cost, if they share a mesh with the reference.
    cost: Vec<Cost>,
    /// Reference and models on the next coarser mesh, if they share their mesh and the reference is stored.
    coarser: Option<(Stored, Vec<Outcome>)>,
    /// CalculiX's solution.
    other: Option<Stored>,
}

/// The document of `compare --measured` for a scene without a reference.
#[derive(Debug, Serialize)]
pub(super) struct MeasuredAlone {
    schema_version: u32,
    scene: String,
    models: Vec<Summary>,
    pub(super) measured: Measured,
}

/// The results of models with their names.
fn named(reduced: &[Outcome]) -> impl DoubleEndedIterator<Item = (&str, &Outcome)> {
    reduced.iter().map(|outcome| (outcome.summary.model.as_deref().unwrap_or_default(), outcome))
}

impl<'a> Job<'a> {
    pub(super) fn read(context: &Context, arguments: &'a Arguments) -> Result<Self> {
        let mut scenes = compare_inputs::scenes(&arguments.scenes)?;
        // of all shipped scenes those are compared that have one of the models
        if arguments.scenes.is_empty() {
            let (supported, omitted) =
                scenes.into_iter().partition(|(_, scene)| kinds::has_one_of(scene, &arguments.models));
            scenes = supported;
            for (_, scene) in omitted {
                context.note(format_args!("{}", crate::kinds::models_only(&scene)));
            }
        }
        Self::of(context, arguments, scenes)
    }

    /// The comparison of these scenes. What can't be done is refused before anything is computed.
    pub(super) fn of(
        context: &Context,
        arguments: &'a Arguments,
        scenes: Vec<(PathBuf, Scene)>,
    ) -> Result<Self> {
        let start = Instant::now();
        compare_inputs::named_apart(&scenes)?;
        if let (Some(tolerance), false) =
            (arguments.tolerance, arguments.models.contains(&RequestedModel::Auto))
        {
            return Err(Error::Usage(format!(
                "--tolerance {tolerance} is for the model auto, which is not among --models"
            )));
        }
        if let Some(file) = arguments.trends.as_ref().filter(|file| !file.is_file()) {
            return Err(Error::Usage(format!("--trends: there is no file {}", file.display())));
        }
        if let Some((_, scene)) =
            scenes.iter().find(|(_, scene)| !kinds::has_one_of(scene, &arguments.models))
        {
            let names: Vec<String> = arguments.models.iter().map(RequestedModel::to_string).collect();
            return Err(Error::Usage(format!(
                "--models {}: {}",
                names.join(","),
                crate::kinds::models_only(scene)
            )));
        }
        if arguments.models.contains(&RequestedModel::External) {
            arguments.permission.require(&scenes)?;
        }
        let records = compare_inputs::records(context, &arguments.measured, &scenes, &arguments.record_map)?;
        let figures = compare_inputs::figures(arguments.figure.as_ref(), &scenes)?;
        Ok(Job { start, arguments, scenes, records, figures })
    }

    /// The folders of the report and of `files` can be written.
    pub(super) fn check_folders(&self, files: &[Option<&PathBuf>]) -> Result<()> {
        report::check_writable(&self.arguments.out)?;
        let figures = self.figures.iter().map(|(file, _)| file);
        let parents = files.iter().copied().flatten().chain(figures).filter_map(|file| file.parent());
        parents.filter(|folder| !folder.as_os_str().is_empty()).try_for_each(report::check_writable)
    }

    pub(super) fn resolution(&self) -> Resolution {
        self.arguments.resolution()
    }

    pub(super) fn out(&self) -> &Path {
        &self.arguments.out
    }

    /// The measured records of the scene compared with its models alone, without a reference, and the models' results.
    ///
    /// # Errors
    /// Those of models and records; [`Error::Usage`] if no model runs without a reference.
    pub(super) fn measured_alone(&self, context: &Context) -> Result<(MeasuredAlone, Vec<Outcome>)> {
        let [(file, scene)] = &self.scenes[..] else {
            return Err(Error::Internal("records of several scenes".into()));
        };
        let reduced =
            kinds::of(scene).alone(scene, (&self.arguments.models[..], self.arguments.tolerance))?;
        // the finest model stands for the reference
        let comparators: Vec<_> = named(&reduced).rev().collect();
        let propagations = propagate(context, file, scene, &reduced)?;
        let how = (self.arguments.bandwidth, self.arguments.speed);
        let measured = measured::compare(scene, &self.records, &comparators, how, &propagations)?;
        let summaries = reduced.iter().map(|outcome| outcome.summary.clone()).collect();
        let name = scene.name.clone();
        Ok((
            MeasuredAlone { schema_version: SCHEMA_VERSION, scene: name, models: summaries, measured },
            reduced,
        ))
    }

    /// References from the store (or computed), and the reduced models' runs, of every scene.
    pub(super) fn results(&self, context: &Context) -> Result<Vec<Results>> {
        let references = look_up(context, self.resolution(), self.arguments.compute, &self.scenes)?;
        for stored in &references {
            report_reused(context, stored);
        }
        let result = |((file, scene), stored): (&(PathBuf, Scene), Stored)| {
            let request = (&self.arguments.models[..], self.arguments.tolerance);
            let models = kinds::of(scene);
            let (mut reduced, cost) = models.with_reference(context, scene, &stored, request)?;
            if self.arguments.models.contains(&RequestedModel::External) {
                reduced.extend(external::results(
                    context,
                    file,
                    scene,
                    stored.outcome.summary.sample_interval,
                ));
            }
            let coarser = self.coarser(context, file, scene).map(|stored| -> Result<_> {
                let (reduced, _) = models.with_reference(context, scene, &stored, request)?;
                Ok((stored, reduced))
            });
            let other = second_program::independent(context, file, scene, self.arguments)?;
            Ok(Results { stored, reduced, cost, coarser: coarser.transpose()?, other })
        };
        self.scenes.iter().zip(references).map(result).collect()
    }

    /// Whether the references had to agree with CalculiX's solutions and do not.
    pub(super) fn refuses(&self, comparison: &Comparison) -> bool {
        self.arguments.reference_check && comparison.references_disagree()
    }

    /// The reference on the next coarser mesh, if it is stored and the models solve on the reference's mesh.
    fn coarser(&self, context: &Context, file: &Path, scene: &Scene) -> Option<Stored> {
        let resolution = self.resolution().coarser().filter(|_| kinds::of(scene).shares_mesh())?;
        context.store().for_scene_in(file).find_here_or_shipped(scene, resolution).found()
    }

    /// The finished comparisons of all scenes.
    pub(super) fn comparisons(&self, context: &Context, results: &[Results]) -> Result<Vec<SceneComparison>> {
        self.scenes
            .iter()
            .zip(results)
            .map(|(scene, results)| self.compared(context, scene, results))
            .collect()
    }

    fn compared(
        &self,
        context: &Context,
        (file, scene): &(PathBuf, Scene),
        Results { stored, reduced, coarser, other, .. }: &Results,
    ) -> Result<SceneComparison> {
        let reference = &stored.outcome;
        let acceptances = acceptance::read(file)?;
        let budget = budget::of_results(scene, &reference.summary, reduced).unwrap_or_else(|error| {
            context.note(format_args!("scene `{}` has no discrepancy budget: {error}", scene.name));
            Vec::new()
        });
        let propagations = propagate(context, file, scene, reduced).unwrap_or_else(|error| {
            context.note(format_args!(
                "scene `{}` is compared as if its inputs were certain: {error}",
                scene.name
            ));
            BTreeMap::new()
        });
        let how = (self.arguments.bandwidth, self.arguments.speed);
        let measured = (!self.records.is_empty()).then(|| {
            let reference = std::iter::once((measured::REFERENCE, reference));
            let comparators: Vec<_> = reference.chain(named(reduced)).collect();
            measured::compare(scene, &self.records, &comparators, how, &propagations)
        });
        let input = ComparisonInput {
            coarser: coarser.as_ref().map(|(stored, reduced)| (&stored.outcome, &reduced[..])),
            other: other.as_ref().map(|other| &other.outcome),
            measured: measured.transpose()?,
            propagations,
            accepted: acceptance::checks(&acceptances, &reference.summary, self.resolution()),
            changed_tolerances: compare_inputs::changed_tolerances(file, &acceptances)?,
            budget,
            ..ComparisonInput::new(scene, reference, reduced)
        };
        Ok(input.compare())
    }

    /// What is shown of `comparisons`; `entries` are the results over commits.
    pub(super) fn report<'b>(
        &'b self,
        context: &Context,
        results: &'b [Results],
        comparisons: Vec<SceneComparison>,
        entries: &[trend::Entry],
    ) -> Result<Report<'b>> {
        let of_scenes = || self.scenes.iter().zip(results);
        let found: Vec<_> = of_scenes()
            .zip(&comparisons)
            .map(|(((_, scene), results), comparison)| (&results.stored, Validation::of(scene, comparison)))
            .collect();
        let validated: Arc<[Validation]> = validated_scenes::known(context, &found).into();
        let coverage = validated_scenes::coverage(context, &validated).map(Arc::new);
        let compared = Some(chrono::Utc::now().format("%Y-%m-%d %H:%M:%S UTC").to_string());
        let mut scenes = Vec::new();
        for (((file, scene), results), comparison) in of_scenes().zip(comparisons) {
            let Results { stored, reduced, cost, .. } = results;
            let attachments = Attachments {
                cost: cost.clone(),
                folder: compare_inputs::folder(file),
                compared: compared.clone(),
                trends: trend::trends(entries, &comparison),
                acceptances: acceptance::read(file)?,
                validated: Arc::clone(&validated),
                coverage: coverage.clone(),
                live: live::of_report(context, file, scene, stored),
                ..Attachments::of(scene, stored)
            };
            scenes.push(SceneReport {
                scene,
                comparison,
                reference: &stored.outcome,
                reduced,
                provenance: stored.provenance.clone(),
                command: self.command(scene),
                attachments,
            });
        }
        Ok(Report { scenes, rules: GateRules::default() })
    }

    /// The command line that compares `scene` in the same way.
    fn command(&self, scene: &Scene) -> String {
        let Arguments { scenes, models, .. } = self.arguments;
        let place = self.scenes.iter().position(|(_, other)| other.name == scene.name);
        let named = place.and_then(|k| scenes.get(k)).unwrap_or(&scene.name);
        let mut command = format!("impactcheck compare {named}");
        let models: Vec<String> = models.iter().map(RequestedModel::to_string).collect();
        if models != ["A", "B", "C", "external"] {
            command += &format!(" --models {}", models.join(","));
        }
        if let Some(tolerance) = self.arguments.tolerance {
            command += &format!(" --tolerance {tolerance}");
        }
        if self.arguments.reference_check {
            command += " --reference-check";
        }
        if self.resolution() != Resolution::Paper {
            command += &format!(" --resolution {}", self.resolution().argument());
        }
        let measured = self.arguments.measured.iter().map(|file| format!(" --measured {}", file.display()));
        command + &measured.collect::<String>()
    }

    /// Results over commits; those of these comparisons are added to the file of `record`, at its commit.
    pub(super) fn trends(
        &self,
        comparisons: &[SceneComparison],
        record: Option<&(PathBuf, Commit)>,
    ) -> Result<Vec<trend::Entry>> {
        match record {
            Some((file, commit)) => trend::record(file, comparisons, commit),
            None => trend::read(self.arguments.trends.as_ref().unwrap_or(&self.arguments.out.join(TRENDS))),
        }
    }

    /// Writes the report, its figures and the checks as JUnit XML to `junit`, and prints the result.
    pub(super) fn finish(
        &self,
        context: &Context,
        report: &Report,
        junit: Option<&Path>,
    ) -> Result<Comparison> {
        self.write(report)?;
        if let Some(file) = junit {
            write_file(file, report::junit(report)?.as_bytes())?;
        }
        let comparison = report.comparison();
        let width = if self.arguments.wide { Width::Wide } else { Width::Narrow };
        self.arguments.json.print(&comparison, |_| report::terminal(report, width))?;
        context.note(format_args!(
            "{} scene{} compared in {:.2} s; report: {}",
            self.scenes.len(),
            if self.scenes.len() == 1 { "" } else { "s" },
            self.start.elapsed().as_secs_f64(),
            self.arguments.out.join("index.html").display()
        ));
        Ok(comparison)
    }

    /// Writes the report and its figures.
    pub(super) fn write(&self, report: &Report) -> Result<()> {
        report::write(report, &self.arguments.out)?;
        for (scene, (file, format)) in report.scenes.iter().zip(&self.figures) {
            let svg = report::printed_figure(scene, self.arguments.figure_width);
            write_file(file, &format.bytes(&FigureFile { title: scene.scene.name.clone(), svg })?)?;
        }
        Ok(())
    }
}
