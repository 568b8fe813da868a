//! Models as the command line names them: A, B, C, `auto`, or `external`; and what is asked of one.

use crate::error::{Error, Result};
use crate::format::model_name;
use crate::kinds;
use crate::result::Choice;
use crate::scene::{Model, Scene};
use clap::Args;
use std::path::PathBuf;
use std::str::FromStr;

/// A reduced model, the program's choice, or the programs that the scene names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RequestedModel {
    /// This one.
    Named(Model),
    /// The cheapest that is good enough.
    Auto,
    /// The programs that the scene names.
    External,
}

impl FromStr for RequestedModel {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let unknown = |_| {
            format!(
                "`{text}` is not a model; there are A, B and C, auto, and external for the scene's programs"
            )
        };
        match text {
            "auto" => Ok(RequestedModel::Auto),
            "external" => Ok(RequestedModel::External),
            _ => text.parse().map(RequestedModel::Named).map_err(unknown),
        }
    }
}

impl std::fmt::Display for RequestedModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            RequestedModel::Named(model) => model.fmt(f),
            RequestedModel::Auto => f.write_str("auto"),
            RequestedModel::External => f.write_str("external"),
        }
    }
}

/// That the scene's programs run where they are compared with something.
pub(super) fn needs_a_reference() -> Error {
    Error::Usage("--model external: the scene's programs run in `compare` and `gate`".into())
}

/// Parses a relative error, as a number or in percent.
pub(super) fn tolerance(text: &str) -> std::result::Result<f64, String> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(number) => (number.trim_end(), 0.01),
        None => (text, 1.0),
    };
    number.parse::<f64>().map_err(|e| e.to_string()).and_then(|value| within_bounds(value * unit, text))
}

/// A relative error that models can be asked for, `text` to whoever asked.
pub(super) fn within_bounds(error: f64, text: &str) -> std::result::Result<f64, String> {
    match (1e-12..=0.3).contains(&error) {
        true => Ok(error),
        false => Err(format!("{text} is not within 1e-12 to 0.3 (30 %)")),
    }
}

/// What was chosen, from what, and why, in lines.
pub(super) fn choice_in_words(choice: &Choice) -> String {
    let percent = |error: Option<f64>| error.map_or("unknown".to_owned(), |e| format!("{:.2} %", 100.0 * e));
    let mut lines = vec![format!(
        "auto, tolerance {:.4} % of {}: predicted error {}",
        100.0 * choice.tolerance,
        choice.covers.join(", "),
        choice.estimated_error.map_or("unknown".to_owned(), |e| format!(
            "{:.2} % ({:.0} %)",
            100.0 * e,
            100.0 * choice.coverage
        ))
    )];
    for tried in &choice.tried {
        let name = format!("model {}", model_name(&tried.model.to_string(), Some(tried.modes)));
        let quantity = tried.quantity.as_ref().map_or(String::new(), |q| format!(" ({q})"));
        let mark = if tried.chosen { "  <- chosen" } else { "" };
        lines.push(format!("  {name:<26} {:>10}{quantity}{mark}", percent(tried.estimated_error)));
    }
    lines.push(format!("  {}", choice.reason));
    lines.join("\n")
}

/// The model that is asked for; what is left out is the scene's or the program's choice.
#[derive(Debug, Clone, Default, Args)]
pub struct ModelRequest {
    /// Reduced model: A (one mode), B (Kirchhoff plate modes), C (3D elastic modes, residual flexibility), or auto
    /// (the simplest one that is predicted to be within the tolerance) [default: the scene's, or C]
    #[arg(long)]
    pub model: Option<RequestedModel>,
    /// Number of modes [default: the scene's, or 16 for B, 32 for C of a seal seat, and as many as needed for C of others]
    #[arg(long, value_name = "N")]
    pub modes: Option<usize>,
    /// Relative error of the time integration [default: 1e-7; seal seat 1e-3]. With --model auto: relative error of
    /// the model in efficiency, final velocity of the outer body and both peak forces [default: 1%]
    #[arg(long, value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// Mesh of the seat (.vtu, tetrahedra), seal-seat scenes only [default: from meshes/ or the cache, or a new one]
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
}

/// Largest tolerance of a time integration.
const LARGEST_INTEGRATION: f64 = 1e-2;

impl ModelRequest {
    /// The model of `scene` that is asked for, of a kind among whose models the program does not choose: the scene's, or the kind's
    /// last one, if none is.
    ///
    /// # Errors
    /// [`Error::Usage`] of what is no model of such a kind.
    pub(super) fn named(&self, scene: &Scene) -> Result<Model> {
        match self.model {
            Some(RequestedModel::Named(model)) => Ok(model),
            Some(RequestedModel::Auto) => {
                Err(Error::Usage(format!("--model auto: {}", kinds::models_only(scene))))
            }
            Some(RequestedModel::External) => Err(needs_a_reference()),
            None => {
                let last = kinds::of(scene).models().last().copied();
                let found = scene.reduced.model.or(last);
                found.ok_or_else(|| Error::Internal(format!("`{}` has no models", scene.name)))
            }
        }
    }

    /// The tolerance of the time integration of a model that is named, `default` if the user names none.
    ///
    /// # Errors
    /// [`Error::Usage`] if it is too large for that.
    pub(super) fn integration_tolerance(&self, default: f64) -> Result<f64> {
        match self.tolerance {
            Some(tolerance) if tolerance > LARGEST_INTEGRATION => Err(Error::Usage(format!(
                "--tolerance {tolerance} is more than {LARGEST_INTEGRATION}: with a model that is named it is the error of the time integration; --model auto takes larger ones"
            ))),
            tolerance => Ok(tolerance.unwrap_or(default)),
        }
    }
}
