//! The programs that scenes name as models: they run only if the user allows it.

use super::Context;
use crate::error::{Error, Result};
use crate::external;
use crate::reference;
use crate::result::{Outcome, Summary};
use crate::scene::Scene;
use clap::Args;
use std::path::{Path, PathBuf};

/// Environment variable that allows what `--allow-external` does, if it is 1.
const ALLOW_VARIABLE: &str = "IMPACTCHECK_ALLOW_EXTERNAL";
/// Distance of samples in s that a program is asked for if the reference has none.
const SAMPLE_INTERVAL: f64 = 1e-7;

/// The user's leave.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct Permission {
    /// Run the programs and units under [[external]] of the scenes (or set IMPACTCHECK_ALLOW_EXTERNAL=1). Caution: a scene can
    /// name any program
    #[arg(long)]
    pub(super) allow_external: bool,
}

impl Permission {
    /// Whether the user has given leave.
    pub(super) fn is_given(self) -> bool {
        self.allow_external || std::env::var_os(ALLOW_VARIABLE).is_some_and(|value| value == "1")
    }

    /// Refuses scenes that name programs, unless the user has given leave.
    ///
    /// # Errors
    /// [`Error::Usage`] with the first program.
    pub(super) fn require(self, scenes: &[(PathBuf, Scene)]) -> Result<()> {
        if self.is_given() {
            return Ok(());
        }
        let mut programs =
            scenes.iter().flat_map(|(file, scene)| scene.external.iter().map(move |program| (file, program)));
        match programs.next() {
            None => Ok(()),
            Some((file, program)) => Err(Error::Usage(format!(
                "{} wants to run the {} as model `{}`; a scene file can name any program or unit, so nothing was run: if you trust this one, add --allow-external (or set {ALLOW_VARIABLE}=1), or leave such models out with --models A,B,C",
                file.display(),
                program.program.in_words(),
                program.name
            ))),
        }
    }
}

/// The results of all programs that `scene` in `file` names, one after the other, asked for samples at the distance that the
/// reference has, in s.
pub(super) fn results(
    context: &Context,
    file: &Path,
    scene: &Scene,
    sample_interval: Option<f64>,
) -> Vec<Outcome> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let interval = sample_interval.unwrap_or(SAMPLE_INTERVAL);
    let run = |program| {
        let outcome = external::run(scene, program, folder, &reference::unit_runner, interval);
        let Summary { failure, warnings, solve_seconds, .. } = &outcome.summary;
        context.detail(format_args!("{}: {} answered in {solve_seconds:.2} s", scene.name, program.name));
        match failure {
            // not a note: --quiet must not hide that a model is missing
            Some(why) => super::notify(format_args!(
                "error: {}: model `{}` has no result: {why}",
                scene.name, program.name
            )),
            None => warnings.iter().for_each(|warning| {
                context.note(format_args!("{}: {}: {warning}", scene.name, program.name));
            }),
        }
        outcome
    };
    scene.external.iter().map(run).collect()
}
