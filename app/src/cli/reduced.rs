//! `impactcheck reduced`: runs a reduced model of a scene.

use super::predicted::{PredictedSummary, predicted};
use super::requested_model::{self, ModelRequest};
use super::{Context, JsonArgument, kinds, progress};
use crate::error::{ExitStatus, Result};
use crate::file::write_file;
use crate::format::{self, model_name, prefixed, with_unit};
use crate::kinds::SharedBodies;
use crate::prediction::{Interval, Prediction};
use crate::report::{self, history_format};
use crate::result::{ContactPressure, ElasticLimit, Impact, Outcome, Quantity, Summary};
use crate::scene::Scene;
use clap::Args;
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file, name of a shipped scene, or `-` for standard input
    scene: String,
    #[command(flatten)]
    request: ModelRequest,
    /// Write displacements, velocities and forces over time to this file (.csv or .parquet)
    #[arg(long, value_name = "FILE")]
    history: Option<PathBuf>,
    /// Write a page with results, curves and flight to this file (.html)
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgument,
}

/// Runs the model and prints its summary.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    if let Some(file) = &arguments.history {
        // refused before anything is computed
        history_format(file)?;
    }
    arguments.page.as_ref().map(|file| super::html_file("--page", file)).transpose()?;
    let (_, scene) = super::read_scene(&arguments.scene)?;
    if let (None, Some(model)) = (arguments.request.model, scene.reduced.model) {
        context.note(format_args!(
            "model {model} is the scene's choice (`reduced.model`); --model runs another"
        ));
    }
    let outcome = progress::watched(context, &scene.name, || {
        let curves = arguments.history.is_some() || arguments.page.is_some();
        kinds::of(&scene).reduced(context, &scene, &arguments.request, &SharedBodies::default(), curves)
    })?;
    let prediction = predicted(context, &scene, &arguments.request, &outcome.summary);
    if let Err(reason) = &prediction {
        context.note(format_args!("no 95 % intervals: {reason}"));
    }
    if let Some(file) = &arguments.page {
        write_file(file, report::model_page(&scene, &outcome, &prediction).as_bytes())?;
        context.note(format_args!("page in {}", file.display()));
    }
    finish(context, arguments, (&scene, &outcome), &prediction)
}

/// Writes the history, if it is asked for, and prints warnings and summary.
fn finish(
    context: &Context,
    arguments: &Arguments,
    (scene, outcome): (&Scene, &Outcome),
    prediction: &Prediction,
) -> Result<ExitStatus> {
    let Outcome { summary, history } = outcome;
    if let Some(path) = &arguments.history {
        write_file(path, &history_format(path)?.bytes(history)?)?;
        context.note(format_args!("history of {} samples in {}", history.len(), path.display()));
    }
    for warning in &summary.warnings {
        context.note(format_args!("warning: {warning}"));
    }
    let document = PredictedSummary::of(scene, summary, prediction);
    arguments.json.print(&document, |document| {
        let mut lines = vec![table(document.summary, |name| crate::kinds::of(scene).has(scene, name))];
        lines.extend(document.prediction.map(|intervals| predicted_lines(intervals, summary)));
        lines.join("\n")
    })?;
    Ok(ExitStatus::Pass)
}

/// The intervals as lines of name, bounds and unit.
fn predicted_lines(intervals: &BTreeMap<&'static str, Interval>, summary: &Summary) -> String {
    let mut lines = Vec::new();
    let quantities = summary.quantities.iter().map(|quantity| (quantity.name, quantity.unit, 24));
    for (name, unit, width) in quantities.chain(summary.motion().map(|(name, _, unit)| (name, unit, 32))) {
        let Some(interval) = intervals.get(name) else { continue };
        if lines.is_empty() {
            let (level, Interval { scenes, stratum, .. }) = (100.0 * interval.level, interval);
            lines.push(format!(
                "  a converged reference would find ({level:.0} %, from {scenes} solved scenes of the group `{stratum}`)"
            ));
        }
        let [low, high] = format::interval([interval.low, interval.high], unit);
        lines.push(format!("  {name:<width$} {low:>14} to {high}"));
    }
    lines.join("\n")
}

/// The summary as lines of name, value and unit; of the quantities those that the scene has.
pub fn table(summary: &Summary, has: impl Fn(&str) -> bool) -> String {
    let who = match &summary.model {
        Some(model) if summary.modes.is_some() => format!("model {}", model_name(model, summary.modes)),
        _ => "reference".to_owned(),
    };
    let mut lines = vec![format!("{} ({who})", summary.scene)];
    for &Quantity { name, unit, value, .. } in summary.quantities.iter().filter(|quantity| has(quantity.name))
    {
        let Some(value) = value else {
            lines.push(format!("  {name:<24} {:>14}", "not determined"));
            continue;
        };
        let to = prefixed(unit, value);
        let band = summary.band(name).map_or_else(String::new, |u| format!(" ± {}", with_unit(u, to, 2)));
        lines.push(format!("  {name:<24} {:>14}{band}", with_unit(value, to, 6)));
    }
    let friction = summary.friction_work.map(|work| ("friction_work", work, "J"));
    for (name, value, unit) in summary.motion().chain(friction) {
        let to = prefixed(unit, value);
        let band = summary.band(name).map_or_else(String::new, |u| format!(" ± {}", with_unit(u, to, 2)));
        lines.push(format!("  {name:<32} {:>14}{band}", with_unit(value, to, 6)));
    }
    let bender = summary.bender.iter().flat_map(|bender| {
        let drive = &bender.drive;
        let efficiency = bender.strain_energy_efficiency;
        let efficiency = efficiency.map(|efficiency| ("strain_energy_efficiency", efficiency, "1"));
        efficiency.into_iter().chain([
            ("torque", drive.torque, "N*m"),
            ("tip_deflection", drive.tip_deflection, "m"),
            ("strain_energy", drive.strain_energy, "J"),
            ("kinetic_energy", drive.kinetic_energy, "J"),
            ("strike_delay", drive.strike_delay, "s"),
        ])
    });
    let stack = summary.stack.iter().flat_map(|stack| {
        let share = stack.share.map(|share| ("share of electrical energy", share, "1"));
        [
            ("electrical_energy", stack.electrical_energy, "J"),
            ("mechanical_energy", stack.mechanical_energy, "J"),
        ]
        .into_iter()
        .chain(share)
    });
    let [striker, struck, middle] = match summary.quantities.get("actuator_force_peak") {
        Some(_) => ["lost in actuator contact", "lost in sphere contact", "lost in seat"],
        None => ["lost in outer contact", "lost in inner contact", "lost in plate"],
    };
    let losses = summary.losses.iter().flat_map(|losses| {
        [
            ("lost to plate damping", losses.plate_damping, "J"),
            ("lost in squeeze film", losses.squeeze_film, "J"),
            ("lost to drag", losses.drag, "J"),
            (striker, losses.contacts.map_or(0.0, |loss| loss[0]), "J"),
            (struck, losses.contacts.map_or(0.0, |loss| loss[1]), "J"),
            ("lost in outer body", losses.bodies.map_or(0.0, |loss| loss[0]), "J"),
            (middle, losses.bodies.map_or(0.0, |loss| loss[1]), "J"),
            ("lost in inner body", losses.bodies.map_or(0.0, |loss| loss[2]), "J"),
        ]
        .into_iter()
        .filter(|(_, loss, _)| *loss != 0.0)
    });
    let patches = summary.contact_pressure.iter().flat_map(ContactPressure::rows);
    let speeds = summary.elastic_limit.iter().flat_map(ElasticLimit::rows);
    let speeds = speeds.map(|(name, speed)| (name, speed, "m/s"));
    for (name, value, unit) in patches.chain(speeds).chain(bender).chain(stack).chain(losses) {
        lines.push(format!("  {name:<24} {:>14}", with_unit(value, prefixed(unit, value), 6)));
    }
    let frequencies = summary.frequencies.iter().enumerate();
    lines.extend(frequencies.map(|(k, hertz)| {
        format!(
            "  {:<24} {:>14}",
            format!("frequency {}", k + 1),
            with_unit(*hertz, prefixed("Hz", *hertz), 6)
        )
    }));
    lines.extend(series(&summary.impacts));
    lines.extend(after_the_impact(summary));
    let errors = [
        ("energy_residual", summary.energy_residual),
        ("momentum_residual", summary.momentum_residual),
        ("truncation_error", summary.truncation_error),
        ("mesh_error", summary.mesh_error),
    ];
    lines
        .extend(errors.iter().filter_map(|(name, error)| Some(format!("  {name:<24} {:>14.1e}", (*error)?))));
    let seconds = with_unit(summary.solve_seconds, prefixed("s", summary.solve_seconds), 3);
    lines.extend(summary.steps.map(|steps| format!("  {steps} steps in {seconds}, excluding set-up")));
    lines.extend(summary.choice.as_ref().map(requested_model::choice_in_words));
    lines.join("\n")
}

/// Flight and vibration, a line for each value.
fn after_the_impact(summary: &Summary) -> Vec<String> {
    let row = |name: &str, value: Option<f64>, unit| {
        let text =
            value.map_or_else(|| "none".to_owned(), |value| with_unit(value, prefixed(unit, value), 4));
        format!("  {name:<24} {text:>14}")
    };
    let mut lines = Vec::new();
    if let Some(flight) = &summary.flight {
        lines.push(format!("  {:<24} {:>14}", "seat", flight.seat.to_string()));
        lines.extend(flight.reason.iter().map(|reason| format!("    {reason}")));
        lines.extend([
            row("certain after", Some(flight.time), "s"),
            row("margin of speed", flight.margin, "1"),
            row("share in other seat", Some(flight.share), "1"),
            row("least speed to shift", Some(flight.least_speed), "m/s"),
            row("restitution", Some(flight.restitution), "1"),
        ]);
    }
    if let Some(vibration) = &summary.vibration {
        lines.push(row("unseats at", vibration.unseats, "m/s^2"));
        lines.push(row("shifts at", vibration.shifts, "m/s^2"));
    }
    lines
}

/// The impacts of a series, one line each.
fn series(impacts: &[Impact]) -> Vec<String> {
    if impacts.is_empty() {
        return Vec::new();
    }
    let mut lines = vec![format!(
        "  {:<8}{:>12}{:>14}{:>14}{:>14}",
        "impact", "efficiency", "outer peak", "inner peak", "lost"
    )];
    for impact in impacts {
        let shown = |value: Option<f64>, unit| {
            value.map_or_else(|| "-".to_owned(), |value| with_unit(value, prefixed(unit, value), 4))
        };
        let of = |name: &str, unit| shown(impact.quantities.value(name), unit);
        let [outer, inner] = ["outer_force_peak", "inner_force_peak"].map(|name| of(name, "N"));
        let (efficiency, lost) = (of("efficiency", "1"), shown(impact.plastic_work, "J"));
        lines.push(format!("  {:<8}{efficiency:>12}{outer:>14}{inner:>14}{lost:>14}", impact.number));
    }
    lines
}
