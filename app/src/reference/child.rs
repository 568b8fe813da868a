//! A running `fem_reference`: its progress, what it says when it fails, and its end.

use crate::interrupt::Running;
use crate::process_output::{SHOWN, next_line, tail};
use serde::Deserialize;
use std::io::BufReader;
use std::process::{ChildStdout, Command, ExitStatus, Stdio};
use std::thread::JoinHandle;

/// How far a solver is.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Progress {
    /// What it does: mesh, assembly, stepping, writing; `note`: nothing, the message is to be kept.
    pub phase: String,
    /// Share of the phase that is done, 0 to 1.
    pub done: f64,
    /// For people.
    pub message: String,
    /// Share of all meshes together that is done, 0 to 1, where there are several.
    #[serde(default)]
    pub series: Option<f64>,
}

/// One line a solver writes to its standard output.
#[derive(Deserialize)]
#[serde(untagged)]
enum SolverLine {
    Progress(Progress),
    Error { phase: ErrorPhase, message: String },
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum ErrorPhase {
    Error,
}

/// How a solver ended.
#[derive(Debug)]
pub(super) struct SolverExit {
    pub(super) status: ExitStatus,
    /// The message of its error line.
    pub(super) error: Option<String>,
    /// The first line that was neither progress nor error.
    pub(super) stray: Option<String>,
    /// The last lines of its standard error.
    pub(super) log: String,
}

/// Runs `command` to its end, handing on its progress.
///
/// # Errors
/// What the system says if the program can't be started or waited for.
pub(super) fn run(command: &mut Command, progress: &mut dyn FnMut(&Progress)) -> std::io::Result<SolverExit> {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = Running::start(command)?;
    let log = child.child().stderr.take().map(|stderr| std::thread::spawn(move || tail(stderr)));
    let (error, stray) = match child.child().stdout.take() {
        Some(stdout) => listen(stdout, progress)?,
        None => (None, None),
    };
    let status = child.wait()?;
    let log = log.and_then(|thread: JoinHandle<String>| thread.join().ok()).unwrap_or_default();
    Ok(SolverExit { status, error, stray, log })
}

fn listen(
    stdout: ChildStdout,
    progress: &mut dyn FnMut(&Progress),
) -> std::io::Result<(Option<String>, Option<String>)> {
    let mut reader = BufReader::new(stdout);
    let (mut error, mut stray) = (None, None);
    while let Some(text) = next_line(&mut reader)? {
        match serde_json::from_str(&text) {
            Ok(SolverLine::Progress(step)) => progress(&step),
            Ok(SolverLine::Error { phase: ErrorPhase::Error, message }) => error = Some(message),
            Err(_) if text.is_empty() || stray.is_some() => {}
            Err(_) => stray = Some(text.chars().take(SHOWN).collect()),
        }
    }
    Ok((error, stray))
}
