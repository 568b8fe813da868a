//! `impactcheck fmu`: writes a scene as a Functional Mock-up Unit.

use super::requested_model::{ModelRequest, RequestedModel};
use super::{Context, JsonArgument, kinds, progress};
use crate::error::{Error, ExitStatus, Result};
use crate::file::write_file;
use crate::fmu::{UnitParts, launchable, packed};
use crate::kinds::SharedBodies;
use crate::scene::{Template, resolve};
use clap::Args;
use clap::builder::PossibleValue;
use impactcheck_fmu::Version;
use serde_json::json;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file, or name of a shipped scene
    scene: String,
    /// File of the unit (.fmu) [default: the scene's name]
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Version of the standard: 3 (FMI 3.0) or 2 (FMI 2.0)
    #[arg(long, value_name = "VERSION", default_value = "3")]
    fmi: Fmi,
    #[command(flatten)]
    request: ModelRequest,
    #[command(flatten)]
    json: JsonArgument,
}

/// A version of the standard, as the command line names it.
#[derive(Debug, Clone, Copy)]
struct Fmi(Version);

impl clap::ValueEnum for Fmi {
    fn value_variants<'a>() -> &'a [Self] {
        &[Fmi(Version::Three), Fmi(Version::Two)]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(match self.0 {
            Version::Two => PossibleValue::new("2").alias("2.0"),
            Version::Three => PossibleValue::new("3").alias("3.0"),
        })
    }
}

/// Runs the model once, so that a unit which can't compute is not written, and writes the unit.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let template = launchable(&Template::read(resolve(&arguments.scene)?)?)?;
    let (scene, request) = (template.scene(), &arguments.request);
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.fmu", scene.name)));
    if out.extension().is_none_or(|kind| !kind.eq_ignore_ascii_case("fmu")) {
        let out = out.display();
        return Err(Error::Usage(format!("-o {out}: a Functional Mock-up Unit is a file that ends in .fmu")));
    }
    let models = kinds::of(scene);
    let outcome = progress::watched(context, &scene.name, || {
        models.reduced(context, scene, request, &SharedBodies::default(), true)
    })?;
    let summary = &outcome.summary;
    for warning in &summary.warnings {
        context.note(format_args!("warning: {warning}"));
    }
    // the number of modes that `auto` has chosen stays
    let is_chosen = matches!(request.model, Some(RequestedModel::Auto));
    let unit = packed(&UnitParts {
        template: &template,
        outcome: &outcome,
        modes: request.modes.or(summary.modes.filter(|_| is_chosen)),
        tolerance: models.tolerance(request)?,
        files: &models.files(context, scene, request)?,
        version: arguments.fmi.0,
    })?;
    write_file(&out, &unit.bytes)?;
    let (bytes, variables) = (unit.bytes.len(), unit.variables.len());
    let model = summary.model.as_deref().unwrap_or_default();
    let fmi = arguments.fmi.0.number();
    let document = json!({
        "file": out, "fmi": fmi, "model": model, "modes": summary.modes, "variables": variables, "bytes": bytes,
    });
    arguments.json.print(&document, |_| {
        let megabytes = bytes.div_ceil(1_000_000);
        format!("{}: FMI {fmi}, model {model}, {variables} variables, {megabytes} MB", out.display())
    })?;
    Ok(ExitStatus::Pass)
}
