//! `impactcheck gate`: compare, the verdict is the exit status; tolerances and references change with a reason only.

use super::Context;
use super::compare::{self, Job, Outputs, Results};
use crate::ci::acceptance::{self, Acceptance, AcceptedReference};
use crate::ci::{commit, github, tolerance_edit};
use crate::comparison::{SceneComparison, Verdict};
use crate::error::{Error, ExitStatus, Result};
use crate::report::{self, Report};
use crate::scene::Scene;
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    compare: compare::Arguments,
    /// Write the checks as JUnit XML to this file
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Add the gated numbers, with the commit, to this file of results over commits (JSON lines)
    #[arg(long, value_name = "FILE", conflicts_with = "trends")]
    record: Option<PathBuf>,
    /// Change what fails in the scene files (known bias; bound of a residual) so that it passes, and accept the references as
    /// they are; the reason is kept beside the scene file
    #[arg(long, requires = "reason")]
    update: bool,
    /// Why the change is right
    #[arg(long, value_name = "TEXT", requires = "update", value_parser = reason)]
    reason: Option<String>,
}

/// Compares, writes the report and lets the verdict be the exit status.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let job = Job::read(&arguments.compare)?;
    job.check_folders(&[arguments.junit.as_ref(), arguments.record.as_ref()])?;
    let record = match &arguments.record {
        Some(file) => Some((file.clone(), commit(&job, file)?)),
        None => None,
    };
    let results = job.results(context)?;
    let outputs = Outputs { junit: arguments.junit.clone(), record };
    let Some(reason) = arguments.reason.as_ref().filter(|_| arguments.update) else {
        return conclude(context, &job, &results, &outputs);
    };
    if update(context, &job, &results, reason)? {
        // scenes are immutable: those of the new tolerances are read again, and what was solved stays
        return conclude(context, &Job::read(&arguments.compare)?, &results, &outputs);
    }
    conclude(context, &job, &results, &outputs)
}

fn conclude(context: &Context, job: &Job, results: &Results, outputs: &Outputs) -> Result<ExitStatus> {
    let report = job.report(context, results)?;
    if github::is_running() {
        tell_github(context, job, &report)?;
    }
    Ok(match job.finish(context, report, outputs)?.verdict {
        Verdict::Pass => ExitStatus::Pass,
        Verdict::Fail => ExitStatus::ToleranceExceeded,
    })
}

/// The commit of the first scene's repository; what this run writes does not count as a change.
fn commit(job: &Job, record: &Path) -> Result<commit::Commit> {
    let file = job.scenes.first().map_or(Path::new("."), |(file, _)| file);
    commit::current(file.parent().unwrap_or(Path::new(".")), &[record, job.out()])
}

/// Annotations on standard error, where they don't disturb results, and the summary of the job.
fn tell_github(context: &Context, job: &Job, report: &Report) -> Result<()> {
    let files: Vec<String> = job.scenes.iter().map(|(file, _)| github::path_in_repository(file)).collect();
    let text = |k: usize| std::fs::read_to_string(&job.scenes[k].0).unwrap_or_default();
    for command in github::annotations(report, &files, text) {
        // not a note: --quiet must not hide it
        eprintln!("{command}");
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
fn update(context: &Context, job: &Job, results: &Results, reason: &str) -> Result<bool> {
    let report = job.report(context, results)?;
    let mut pending = Vec::new();
    for ((file, _), scene) in job.scenes.iter().zip(&report.scenes) {
        let comparison = &scene.comparison;
        acceptable(comparison)?;
        let text = std::fs::read_to_string(file).map_err(|e| Error::io("reading", file, e))?;
        let (edited, tolerances) = tolerance_edit::edited(&text, comparison)?;
        let reference = AcceptedReference::of(&comparison.reference, job.resolution());
        let last = scene.attachments.acceptances.iter().rev().map(|a| &a.reference);
        let known = last.clone().any(|accepted| *accepted == reference);
        if tolerances.is_empty() && known {
            context.note(format_args!("{}: nothing to update", comparison.scene));
            continue;
        }
        // what was written has to be read back as what was meant, before it is written
        Scene::parse(&file.display().to_string(), &edited)?;
        let changed = tolerances.len();
        let entry =
            Acceptance { date: acceptance::today(), reason: reason.to_owned(), tolerances, reference };
        pending.push((file, text != edited, edited, entry, comparison.scene.clone(), changed));
    }
    let any = !pending.is_empty();
    for (file, differs, edited, entry, scene, changed) in pending {
        if differs {
            report::write_file(file, edited.as_bytes())?;
        }
        acceptance::add(file, entry)?;
        let record = acceptance::record_of(file);
        let tolerances = if changed == 1 { "tolerance" } else { "tolerances" };
        context.note(format_args!(
            "{scene}: {changed} {tolerances} changed, reference accepted; the reason is in {}",
            record.display()
        ));
    }
    Ok(any)
}

/// A result that contradicts itself can't be accepted; a reference that is not the accepted one can.
fn acceptable(comparison: &SceneComparison) -> Result<()> {
    let of_reference = comparison.integrity.iter().filter(|c| !c.check.starts_with(acceptance::CHECK));
    let of_models = comparison.models.iter().flat_map(|model| &model.integrity);
    match of_reference.chain(of_models).find(|check| !check.verdict.passed()) {
        None => Ok(()),
        Some(check) => Err(Error::Usage(format!(
            "--update: scene `{}` has a result that contradicts itself, which no reason makes right: {}; nothing was changed",
            comparison.scene,
            report::check_failure(check)
        ))),
    }
}

/// A reason that says something.
fn reason(text: &str) -> std::result::Result<String, String> {
    let text = text.trim();
    if text.is_empty() { Err("a reason is needed, in words".into()) } else { Ok(text.to_owned()) }
}
