//! `impactcheck new`: a valid scene to start from.

use super::Context;
use super::schema::FILE;
use crate::error::{Error, ExitStatus, Result};
use crate::file::write_file;
use crate::kinds::{self, KINDS, Starter};
use crate::reference;
use crate::scene::Scene;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Name of the scene; the file is NAME.toml
    name: PathBuf,
    /// Kind of the scene
    #[arg(long, default_value = KINDS[0].name(), value_parser = starters())]
    kind: Starter,
    /// CAD or mesh file of a body that is struck: writes a scene with the groups and faces found in it
    #[arg(long, value_name = "FILE", conflicts_with = "kind")]
    from: Option<PathBuf>,
    /// Unit of length of that file: m, mm, um, cm, in [default: STEP's own, else m]
    #[arg(long, requires = "from")]
    unit: Option<String>,
    /// File to write [default: NAME.toml]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Takes the name of a kind.
fn starters() -> impl TypedValueParser<Value = Starter> {
    let names = KINDS.iter().map(|kind| PossibleValue::new(kind.name()).help(kind.starter().about));
    let named = |name: String| KINDS.iter().find(|kind| kind.name() == name);
    PossibleValuesParser::new(names).map(move |name| named(name).expect("a possible value").starter())
}

/// Writes a valid scene file and, beside it, the schema that its first line names; a scene that exists stays as it is.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let named = arguments.name.to_string_lossy();
    let named = named.strip_suffix(".toml").unwrap_or(&named);
    let file = arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{named}.toml")));
    let name = named.rsplit(std::path::is_separator).next().unwrap_or(named);
    if file.exists() {
        let message = format!("{} exists and is not overwritten", file.display());
        let hint = "choose another name, or another file with --out";
        return Err(Error::Usage(message).hint([hint.into()]));
    }
    let text = match &arguments.from {
        Some(body) => {
            let groups = reference::body_groups(body, arguments.unit.as_deref())?;
            kinds::scene_of_body(&file, body, arguments.unit.as_deref(), &groups)
        }
        None => arguments.kind.text.to_owned(),
    };
    let text = format!("#:schema ./{FILE}\n{}", text.replacen("NAME", name, 1));
    // a name that can't be one is refused as it would be in a file
    Scene::parse(&file.display().to_string(), &text)?;
    write_file(&file.with_file_name(FILE), crate::kinds::schema().to_string().as_bytes())?;
    write_file(&file, text.as_bytes())?;
    let file = file.display();
    context.note(format_args!("wrote {file}; edit it, then: impactcheck reduced {file}"));
    context.note(format_args!("with FEniCSx also: impactcheck compare {file} --compute --out my-report"));
    Ok(ExitStatus::Pass)
}
