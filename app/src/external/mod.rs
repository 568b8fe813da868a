//! Programs and units of the user's as models: one run with the scene on its standard input, its answer as a result like any other.
//!
//! Whatever a program does, a run of it ends with an [`Outcome`]: one that fails has none of the quantities and says why
//! in [`Summary::failure`], so that nothing else is stopped by it.

mod answer;
mod process;

pub use answer::{assembled, summary};

use crate::error::Error;
use crate::kinds;
use crate::result::{History, Outcome, SCHEMA_VERSION, Source, Summary, Table};
use crate::scene::{Dimension, External, ExternalProgram, Scene, dimension_of};
use process::{MOST_BYTES, Said};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// Lines of a program's standard error that are told.
const REPORTED_LINES: usize = 3;

/// Gives the command that runs a unit, which is described on its standard input.
pub type UnitRunner<'a> = &'a dyn Fn() -> Result<Command, Error>;

/// What `program` makes of `scene`, run in `folder`, a unit by what `unit_runner` gives; samples are requested at the
/// distance of `sample_interval` s.
pub fn run(
    scene: &Scene,
    program: &External,
    folder: &Path,
    unit_runner: UnitRunner,
    sample_interval: f64,
) -> Outcome {
    let start = Instant::now();
    let answered = run_program(scene, program, (folder, unit_runner), sample_interval);
    let seconds = start.elapsed().as_secs_f64();
    match answered {
        Ok((mut summary, history)) => {
            summary.solve_seconds = seconds;
            kinds::of(scene).judge(scene, &mut summary, Some(&history));
            Outcome { summary, history }
        }
        Err(reason) => failed(scene, program, reason, seconds),
    }
}

/// The document on the program's standard input.
///
/// # Errors
/// What can't be written as JSON.
pub fn question(scene: &Scene, sample_interval: f64) -> serde_json::Result<Value> {
    let mut document = serde_json::to_value(scene)?;
    if let Some(fields) = document.as_object_mut() {
        // what other models are and how well this one has to do is none of its business
        ["reduced", "reference", "tolerances", "external"].iter().for_each(|key| drop(fields.remove(*key)));
        fields.insert("scene_hash".into(), scene.hash().into());
    }
    Ok(json!({ "schema_version": SCHEMA_VERSION, "scene": document, "sample_interval": sample_interval }))
}

fn run_program(
    scene: &Scene,
    program: &External,
    (folder, unit_runner): (&Path, UnitRunner),
    sample_interval: f64,
) -> Result<(Summary, History), String> {
    let mut question = question(scene, sample_interval).map_err(|e| format!("the scene as JSON: {e}"))?;
    // no folder in the name of a file means the current one
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let command = match &program.program {
        ExternalProgram::Command { command } => command_in(folder, command),
        ExternalProgram::Unit { fmu, variables, start, interface } => {
            let file = folder.join(fmu);
            if !file.is_file() {
                return Err(format!("there is no unit {}", file.display()));
            }
            let file = std::path::absolute(&file).unwrap_or(file);
            let kind = kinds::of(scene);
            let curves: Vec<_> = kind.curves().iter().map(|curve| curve.name).collect();
            let of_curves = kind.curves().iter().map(|curve| (curve.name, curve.unit));
            let all =
                of_curves.chain(kind.quantities().iter().map(|quantity| (quantity.name, quantity.unit)));
            let bases = |unit| dimension_of(unit).into_iter().flat_map(Dimension::bases);
            let units: BTreeMap<_, _> =
                all.map(|(name, unit)| (name, (unit, bases(unit).collect::<BTreeMap<_, _>>()))).collect();
            question["unit"] = json!({
                "file": file, "variables": variables, "start": start, "curves": curves, "units": units, "interface": interface,
            });
            unit_runner().map_err(|e| e.to_string())?
        }
    };
    let limit = Duration::from_secs_f64(program.timeout);
    let said = process::run(command, format!("{question}\n").into_bytes(), limit);
    let Said { output, log, status } = said.map_err(|error| cannot_run(program, folder, &error))?;
    let whole = output.len() as u64 <= MOST_BYTES;
    match status {
        _ if !whole => Err(format!("it wrote more than {} MiB to standard output", MOST_BYTES >> 20)),
        None => Err(format!("it was not done after {} s (timeout) and was ended", program.timeout)),
        Some(status) if !status.success() => Err(format!("it failed ({status})")),
        Some(_) => answer::read(scene, &program.name, &output)
            .map_err(|why| format!("its answer can't be used: {why}")),
    }
    .map_err(|reason| reason + &last_lines(&log))
}

/// The program and the arguments `words`, to be run in `folder`.
fn command_in(folder: &Path, words: &[String]) -> Command {
    let program = words.first().map_or("", String::as_str);
    // what has a slash is found from the folder it runs in, as in a shell
    let mut command = match program.contains('/') {
        true => Command::new(folder.join(program)),
        false => Command::new(program),
    };
    command.args(words.get(1..).unwrap_or_default()).current_dir(folder);
    command
}

fn cannot_run(program: &External, folder: &Path, error: &std::io::Error) -> String {
    let command = match &program.program {
        ExternalProgram::Command { command } => command.first().map_or("", String::as_str),
        ExternalProgram::Unit { fmu, .. } => fmu,
    };
    match error.kind() {
        ErrorKind::NotFound => {
            format!("there is no program `{command}` on PATH or in {}", folder.display())
        }
        ErrorKind::TimedOut => {
            "its output does not end with it: what it has started in a session of its own holds it open"
                .into()
        }
        _ => format!("`{command}` can't be run: {error}"),
    }
}

/// The end of the program's messages.
fn last_lines(log: &str) -> String {
    let lines: Vec<&str> = log.lines().collect();
    let last = lines[lines.len().saturating_sub(REPORTED_LINES)..].join(" | ");
    if last.is_empty() { last } else { format!("; its last messages: {last}") }
}

fn failed(scene: &Scene, program: &External, reason: String, seconds: f64) -> Outcome {
    let name = program.name.clone();
    let table = Table::new(kinds::of(scene).quantities());
    let summary = Summary::new(scene, (Source::External, Some(name)), table);
    let warnings = vec![format!("no result: {reason}")];
    let summary = Summary { failure: Some(reason), warnings, solve_seconds: seconds, ..summary };
    Outcome { summary, history: History::default() }
}
