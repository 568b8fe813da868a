//! `impactcheck diff`: what moved between two comparisons.

use super::JsonArgument;
use crate::comparison::{ComparisonDocument, Moves, moved};
use crate::error::{ExitStatus, Result};
use crate::file::write_file;
use crate::format::{percent, prefixed, with_unit};
use crate::reference::TargetError;
use crate::report;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// JSON document of `compare` or `gate`, or folder of a report
    a: PathBuf,
    /// The other one
    b: PathBuf,
    /// Omit numbers that changed by less than this, such as 0.1%
    #[arg(long, value_name = "SHARE")]
    above: Option<TargetError>,
    /// Write the changes as a page, the largest first
    #[arg(long, value_name = "FILE.html")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgument,
}

/// Tells what moved, as a table in Markdown and, on request, as a page.
pub fn run(arguments: &Arguments) -> Result<ExitStatus> {
    let above = arguments.above.map_or(0.0, TargetError::share);
    let moves =
        moved(&ComparisonDocument::read(&arguments.a)?, &ComparisonDocument::read(&arguments.b)?, above);
    if let Some(file) = &arguments.out {
        let names = [&arguments.a, &arguments.b].map(|path| path.display().to_string());
        write_file(file, report::moves_page([&names[0], &names[1]], &moves, above).as_bytes())?;
    }
    arguments.json.print(&moves, markdown)?;
    Ok(ExitStatus::Pass)
}

fn markdown(moves: &Moves) -> String {
    let mut rows: Vec<[String; 6]> = Vec::new();
    for verdict in &moves.verdicts {
        let [a, b] = [&verdict.a, &verdict.b].map(|v| v.clone().unwrap_or_else(|| "absent".into()));
        rows.push([verdict.scene.clone(), verdict.model.clone(), "verdict".into(), a, b, String::new()]);
    }
    for row in &moves.moved {
        let size = [row.a, row.b].into_iter().flatten().map(f64::abs).fold(0.0, f64::max);
        let value = |value: Option<f64>| {
            value.map_or("absent".into(), |value| with_unit(value, prefixed(&row.unit, size), 6))
        };
        let (a, b) = (value(row.a), value(row.b));
        rows.push([row.scene.clone(), row.model.clone(), row.quantity.clone(), a, b, percent(row.relative)]);
    }
    if rows.is_empty() {
        return "nothing changed".into();
    }
    let heads = ["scene", "model", "quantity", "A", "B", "moved"].map(String::from);
    let widths: [usize; 6] = std::array::from_fn(|k| {
        rows.iter().chain([&heads]).map(|row| row[k].chars().count()).max().unwrap_or(0)
    });
    let line = |row: &[String; 6]| {
        let cells: Vec<String> =
            row.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        format!("| {} |", cells.join(" | "))
    };
    let rule = widths.map(|width| "-".repeat(width));
    [&heads, &rule].into_iter().chain(&rows).map(line).collect::<Vec<_>>().join("\n")
}
