//! `impactcheck gate`: compare, the verdict is the exit status; tolerances and references change with a reason only.

use super::Context;
use super::compare_arguments;
use super::comparison_job::{Job, Results};
use crate::ci::acceptance::{self, Acceptance, AcceptedReference, ToleranceChange};
use crate::ci::{commit, tolerance_edit, tolerance_watch};
use crate::comparison::{GateRules, SceneComparison, Undecided, Verdict};
use crate::error::{Error, ExitStatus, Result};
use crate::file::write_file;
use crate::reference::Resolution;
use crate::report::Report;
use crate::report::github;
use crate::scene::Scene;
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
// clap names a group of arguments after its type, and `compare` has the same
#[group(skip)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) compare: compare_arguments::Arguments,
    /// Write JUnit XML to this file
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Append the checked numbers, with the commit, to this file (JSON lines)
    #[arg(long, value_name = "FILE", conflicts_with = "trends")]
    record: Option<PathBuf>,
    /// What to do with quantities that the reference's uncertainty leaves undecided: fail, warn (pass with a message)
    /// or pass
    #[arg(long, default_value = "warn", value_name = "fail|warn|pass")]
    undecided: Undecided,
    /// Fail if a scene has no tolerances, or if the reference has no value for one
    #[arg(long)]
    require_tolerances: bool,
    /// Edit the scene files so that what fails passes (bias, bounds of residuals), and accept the present references.
    /// The reason is stored next to the scene file
    #[arg(long, requires = "reason")]
    update: bool,
    /// Why the change is correct
    #[arg(long, value_name = "TEXT", requires = "update", value_parser = reason)]
    reason: Option<String>,
}

/// Compares, writes the report and lets the verdict be the exit status.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let job = Job::read(context, &arguments.compare)?;
    job.check_folders(&[arguments.junit.as_ref(), arguments.record.as_ref()])?;
    let at_commit = |file: &PathBuf| Ok((file.clone(), commit(&job, file)?));
    let record = arguments.record.as_ref().map(at_commit).transpose()?;
    let results = job.results(context)?;
    let rules =
        GateRules { undecided: arguments.undecided, require_tolerances: arguments.require_tolerances };
    let outputs = (arguments.junit.as_deref(), record.as_ref());
    let reason = arguments.reason.as_ref().filter(|_| arguments.update);
    let is_updated = reason.map(|reason| update(context, &job, &results, reason)).transpose()?;
    if is_updated == Some(true) {
        // scenes are immutable: those of the new tolerances are read again, and what was solved stays
        return conclude(context, &Job::read(context, &arguments.compare)?, &results, outputs, rules);
    }
    conclude(context, &job, &results, outputs, rules)
}

/// Compares, adds the gated numbers to `record`, writes the report and JUnit XML.
fn conclude(
    context: &Context,
    job: &Job,
    results: &[Results],
    (junit, record): (Option<&Path>, Option<&(PathBuf, commit::Commit)>),
    rules: GateRules,
) -> Result<ExitStatus> {
    let comparisons = job.comparisons(context, results)?;
    let entries = job.trends(&comparisons, record)?;
    let report = Report { rules, ..job.report(context, results, comparisons, &entries)? };
    report_verdicts(job, &report);
    for SceneComparison { scene, changed_tolerances, .. } in report.scenes.iter().map(|s| &s.comparison) {
        for changed in changed_tolerances {
            // not a note: --quiet must not hide that the gate is another one
            super::notify(format_args!("warning: {scene}: {}", changed.sentence()));
        }
    }
    if github::is_running() {
        report_to_github(context, job, &report)?;
    }
    let comparison = job.finish(context, &report, junit)?;
    if comparison.has_no_result() {
        return Ok(ExitStatus::Solver);
    }
    if comparison.verdict.failed() {
        context.note(
            "if this is right after all: the same command with --update --reason \"why\" changes the tolerances and keeps the reason",
        );
    }
    let refused = comparison.scenes.iter().any(|scene| scene.is_refused(rules)) || job.refuses(&comparison);
    Ok(if refused { ExitStatus::ToleranceExceeded } else { ExitStatus::Pass })
}

/// Says on standard error of which scenes nothing is gated, and where the reference is not good enough to tell. Not notes:
/// --quiet must not hide that less was shown than a pass says.
fn report_verdicts(job: &Job, report: &Report) {
    let rules = report.rules;
    for comparison in report.scenes.iter().map(|scene| &scene.comparison) {
        let SceneComparison { scene, verdict, .. } = comparison;
        let is_refused = comparison.is_refused(rules);
        let word = if is_refused { "error" } else { "warning" };
        let without_value = comparison.without_reference();
        match verdict {
            Verdict::NotGated => {
                let file =
                    job.scenes.iter().find(|(_, s)| s.name == *scene).map_or(Path::new(""), |(file, _)| file);
                super::notify(format_args!(
                    "{word}: nothing of scene `{scene}` is gated: {} has no tolerances of the models compared; add for example tolerances.C = {{ efficiency = {{ relative = 0.01 }} }}",
                    file.display()
                ));
            }
            _ if rules.undecided == Undecided::Pass && !is_refused => {}
            _ if !without_value.is_empty() => super::notify(format_args!(
                "{word}: the reference of scene `{scene}` has no value for these tolerances, which stay undecided: {}",
                without_value.join(", ")
            )),
            Verdict::Undecided => super::notify(format_args!(
                "{word}: scene `{scene}` is undecided: the uncertainty of its reference is too large for some tolerances; see the lines above for what decides them"
            )),
            _ => {}
        }
    }
}

/// The commit of the first scene's repository; what this run writes does not count as a change.
fn commit(job: &Job, record: &Path) -> Result<commit::Commit> {
    let file = job.scenes.first().map_or(Path::new("."), |(file, _)| file);
    commit::current(file.parent().unwrap_or(Path::new(".")), &[record, job.out()])
}

/// Annotations on standard error, where they don't disturb results, and the summary of the job.
fn report_to_github(context: &Context, job: &Job, report: &Report) -> Result<()> {
    let place = |name: &str| {
        let found = job.scenes.iter().find(|(_, scene)| scene.name == name);
        found.map_or_else(Default::default, |(file, _)| {
            (github::path_in_repository(file), std::fs::read_to_string(file).unwrap_or_default())
        })
    };
    for command in github::annotations(report, place) {
        // not a note: --quiet must not hide it
        super::notify(command);
    }
    let Some(file) = std::env::var_os("GITHUB_STEP_SUMMARY").filter(|file| !file.is_empty()) else {
        return Ok(());
    };
    let path = PathBuf::from(file);
    let opened = std::fs::OpenOptions::new().append(true).create(true).open(&path);
    let written = opened.and_then(|mut file| file.write_all(github::job_summary(report).as_bytes()));
    if let Err(error) = written {
        context.note(Error::io("writing the job summary to", path, error));
    }
    Ok(())
}

/// Changes what fails in the scene files, and records why. Whether anything was changed.
fn update(context: &Context, job: &Job, results: &[Results], reason: &str) -> Result<bool> {
    let comparisons = job.comparisons(context, results)?;
    let scenes = job.scenes.iter().zip(&comparisons);
    let change = |((file, _), comparison): (&(PathBuf, Scene), &SceneComparison)| {
        SceneUpdate::of(file, comparison, job.resolution(), reason)
    };
    let changes = scenes.map(change).collect::<Result<Vec<_>>>()?;
    for change in &changes {
        change.make(context)?;
    }
    Ok(changes.iter().any(|change| change.entry.is_some()))
}

/// What an update does to one scene.
struct SceneUpdate {
    scene: String,
    file: PathBuf,
    /// The scene file's new text, if it changes.
    text: Option<String>,
    /// What is recorded; `None` if there is nothing to update.
    entry: Option<Acceptance>,
}

impl SceneUpdate {
    /// The change that makes `comparison` pass, checked, not yet made.
    fn of(file: &Path, comparison: &SceneComparison, resolution: Resolution, reason: &str) -> Result<Self> {
        acceptable(comparison)?;
        let old = std::fs::read_to_string(file).map_err(|e| Error::io("reading", file, e))?;
        let (text, tolerances) = tolerance_edit::edited(&old, comparison)?;
        let mut tolerances = tolerances;
        // changed by hand, and now with a reason; of those edited that is said already
        for changed in &comparison.changed_tolerances {
            let is_same = |t: &ToleranceChange| t.model == changed.model && t.quantity == changed.quantity;
            if !tolerances.iter().any(is_same) {
                tolerances.push(ToleranceChange {
                    model: changed.model.clone(),
                    quantity: changed.quantity.clone(),
                    from: changed.accepted.clone(),
                    to: changed.now.clone().unwrap_or_else(|| tolerance_watch::REMOVED.to_owned()),
                });
            }
        }
        let reference = AcceptedReference::of(&comparison.reference, resolution);
        let known = acceptance::read(file)?.iter().any(|a| a.reference == reference);
        // what was written has to be read back as what was meant, before it is written
        Scene::parse(&file.display().to_string(), &text)?;
        let date = acceptance::today();
        let standing = tolerance_watch::standing(&text)?;
        let entry = Acceptance { date, reason: reason.to_owned(), tolerances, reference, standing };
        let nothing = entry.tolerances.is_empty() && known;
        Ok(SceneUpdate {
            scene: comparison.scene.clone(),
            file: file.to_owned(),
            text: (text != old).then_some(text),
            entry: (!nothing).then_some(entry),
        })
    }

    fn make(&self, context: &Context) -> Result<()> {
        let Some(entry) = &self.entry else {
            context.note(format_args!("{}: nothing to update", self.scene));
            return Ok(());
        };
        if let Some(text) = &self.text {
            write_file(&self.file, text.as_bytes())?;
        }
        acceptance::add(&self.file, entry.clone())?;
        let changed = entry.tolerances.len();
        let tolerances = if changed == 1 { "tolerance" } else { "tolerances" };
        for change in &entry.tolerances {
            context.note(format_args!(
                "{}: tolerances.{}.{}: {} -> {}",
                self.scene, change.model, change.quantity, change.from, change.to
            ));
        }
        context.note(format_args!(
            "{}: {changed} {tolerances} changed, reference accepted; the reason is in {}",
            self.scene,
            acceptance::record_of(&self.file).display()
        ));
        Ok(())
    }
}

/// A result that contradicts itself can't be accepted; a reference that is not the accepted one can.
fn acceptable(comparison: &SceneComparison) -> Result<()> {
    let of_reference = comparison.integrity.iter().filter(|c| !c.check.starts_with(acceptance::CHECK));
    let of_models = comparison.models.iter().flat_map(|model| &model.integrity);
    match of_reference.chain(of_models).find(|check| check.verdict.failed()) {
        None => Ok(()),
        Some(check) => Err(Error::Usage(format!(
            "--update: scene `{}` has a result that contradicts itself, which no reason makes right: {}; nothing was changed",
            comparison.scene, check
        ))),
    }
}

/// A reason that says something.
fn reason(text: &str) -> std::result::Result<String, String> {
    let text = text.trim();
    if text.is_empty() { Err("a reason is needed, in words".into()) } else { Ok(text.to_owned()) }
}
