//! `impactcheck calibrate`: inputs from measured histories.

use super::record_map::RecordMap;
use super::{Context, JsonArgument, compare_inputs};
use crate::calibration::{Calibration, calibrate};
use crate::error::{Error, ExitStatus, Result};
use crate::format::{percent, prefixed, with_unit};
use crate::kinds::{self, Use};
use crate::measured::Speed;
use crate::scene::{self, Model, Template};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file, or name of a shipped scene
    scene: String,
    /// Fields to identify
    #[arg(long, value_delimiter = ',', required = true, value_name = "FIELD,…")]
    over: Vec<String>,
    /// Measured histories, as in `compare --measured`
    #[arg(long, value_delimiter = ',', required = true, value_name = "FILE,…")]
    measured: Vec<PathBuf>,
    #[command(flatten)]
    record_map: RecordMap,
    /// Reduced model [default: C]
    #[arg(long, default_value = "C", hide_default_value = true)]
    model: Model,
    /// Bandwidth of the instrument; the model's curves are filtered to it
    #[arg(long, default_value = "100 kHz", value_name = "FREQUENCY", value_parser = compare_inputs::bandwidth)]
    bandwidth: f64,
    /// Source of the outer body's speed: scene (the signal may have an offset) or measured (it has none)
    #[arg(long, default_value = "scene", value_name = "SOURCE")]
    speed: Speed,
    #[command(flatten)]
    json: JsonArgument,
}

/// Fits, and prints what the records tell.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let template = Template::read(scene::resolve(&arguments.scene)?)?;
    kinds::serving(template.scene(), Use::Records)?;
    let mut names = arguments.over.clone();
    names.sort();
    if let Some(twice) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(Error::Usage(format!("--over names `{}` twice", twice[0])));
    }
    let records = arguments.record_map.records(context, &arguments.measured)?;
    let how = (arguments.bandwidth, arguments.speed);
    let found = calibrate(&template, &arguments.over, &records, arguments.model, how)?;
    for record in &found.records {
        for finding in &record.findings {
            context.note(format_args!("warning: {}: {}", record.file.display(), finding.effect));
        }
    }
    for sentence in &found.untold {
        context.note(format_args!("note: {sentence}"));
    }
    arguments.json.print(&found, table)?;
    Ok(ExitStatus::Pass)
}

fn table(found: &Calibration) -> String {
    let mut lines = vec![format!(
        "{} (model {}): {} samples, misfit {:.2} % of their span, {:.2} % before; ± is one standard deviation",
        found.scene,
        found.model,
        found.samples,
        100.0 * found.misfit[1],
        100.0 * found.misfit[0]
    )];
    for input in &found.inputs {
        let to = prefixed(input.unit, input.value);
        let deviation = input
            .standard_deviation
            .map_or(" (not identifiable)".to_owned(), |u| format!(" ± {}", with_unit(u, to, 2)));
        let off = percent(Some(input.value / input.nominal - 1.0));
        lines.push(format!(
            "  {:<36} {:>16}{deviation}  ({off} of the scene's)",
            input.field,
            with_unit(input.value, to, 6)
        ));
    }
    lines.join("\n")
}
