//! `impactcheck compare`: the main job, scene to verdict.

use super::compare_arguments::Arguments;
use super::comparison_job::Job;
use super::{Context, compare_inputs, kinds, stored_references};
use crate::error::{Error, ExitStatus, Result};
use crate::report;
use clap::Args;

/// What `compare` takes and `gate` does not.
#[derive(Debug, Args)]
pub struct OwnArguments {
    #[command(flatten)]
    shared: Arguments,
    /// Compare again whenever a scene file or measured file changes. An invalid file is reported and read again when
    /// it changes. If a plate has no reference yet, only the models run. Ctrl-C ends with the status of the last
    /// comparison
    #[arg(long, conflicts_with = "json")]
    watch: bool,
}

/// Compares, once or whenever a file changes.
pub fn run(context: &Context, OwnArguments { shared, watch }: OwnArguments) -> Result<ExitStatus> {
    let mut arguments = shared.with_tables_measured();
    if arguments.resolution.is_none() && !arguments.compute {
        arguments.resolution = stored_references::only_stored(context, &arguments.scenes)?;
    }
    let arguments = &arguments;
    let compared = || {
        once(context, arguments).inspect_err(|error| {
            if error.exit_status() == ExitStatus::Reference && !arguments.json.json {
                print_without_reference(context, arguments);
            }
        })
    };
    if !watch {
        return compared();
    }
    let files = compare_inputs::files(&arguments.scenes)?.into_iter().chain(arguments.measured.clone());
    super::watch::watch(&files.collect::<Vec<_>>(), compared)
}

/// What the reduced models say without a reference, as far as they do.
fn print_without_reference(context: &Context, arguments: &Arguments) {
    for (_, scene) in compare_inputs::scenes(&arguments.scenes).unwrap_or_default() {
        let printed = kinds::of(&scene).alone(&scene, (&arguments.models[..], arguments.tolerance));
        let printed = printed.and_then(|outcomes| super::print(&report::alone(&scene, &outcomes)));
        if let Err(error) = printed {
            context.note(super::describe(&error));
        }
    }
}

/// Compares models with the measurement, which needs no reference.
fn measured_alone(
    context: &Context,
    job: &Job,
    arguments: &Arguments,
    missing: &Error,
) -> Result<ExitStatus> {
    context.note(super::describe(missing));
    let (found, outcomes) = job.measured_alone(context)?;
    arguments.json.print(&found, |found| report::measured_alone(&found.measured))?;
    let page = report::write_measured(&job.scenes[0].1, &outcomes, &found.measured, job.out())?;
    context.note(format_args!("models are compared with the measurement alone; page: {}", page.display()));
    Ok(ExitStatus::Pass)
}

/// Compares and writes the report. The verdict is shown; the exit status tells only whether the job was done.
fn once(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let job = Job::read(context, arguments)?;
    job.check_folders(&[])?;
    let results = match job.results(context) {
        Err(error) if error.exit_status() == ExitStatus::Reference && !arguments.measured.is_empty() => {
            return measured_alone(context, &job, arguments, &error);
        }
        results => results?,
    };
    let comparisons = job.comparisons(context, &results)?;
    let entries = job.trends(&comparisons, None)?;
    let report = job.report(context, &results, comparisons, &entries)?;
    let comparison = job.finish(context, &report, None)?;
    Ok(match comparison.has_no_result() {
        true => ExitStatus::Solver,
        false if job.refuses(&comparison) => ExitStatus::ToleranceExceeded,
        false => ExitStatus::Pass,
    })
}
