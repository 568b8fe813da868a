//! Messages for GitHub Actions: annotations at the tolerance that is exceeded, and the summary of the job.

use super::Report;
use super::format::{model_name, percent, significant, words};
use crate::ci::tolerance_edit::line_of;
use crate::comparison::{ChangedTolerance, Check, Discrepancy, ModelComparison, SceneComparison};
use crate::result::Quantities;
use std::path::Path;

/// GitHub shows this many errors of a step.
const SHOWN: usize = 10;

/// Whether this process is run by GitHub Actions.
pub fn is_running() -> bool {
    std::env::var("GITHUB_ACTIONS").is_ok_and(|value| value == "true")
}

/// A workflow command per failed row and check, the row farthest beyond its bound first. `place` gives the file of the
/// scene of that name, as seen from the repository, and its text.
pub fn annotations(report: &Report, place: impl Fn(&str) -> (String, String)) -> Vec<String> {
    let mut found: Vec<(f64, String)> = Vec::new();
    for scene in &report.scenes {
        found.extend(annotations_of(&scene.comparison, &place));
    }
    for seat in &report.seats {
        found.extend(annotations_of(&seat.comparison, &place));
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let more = found.len().saturating_sub(SHOWN);
    let plates = report.scenes.iter().flat_map(|s| warnings(&s.comparison, &place));
    let seats = report.seats.iter().flat_map(|s| warnings(&s.comparison, &place));
    let changed: Vec<String> = plates.chain(seats).collect();
    let mut commands: Vec<String> = found.into_iter().take(SHOWN).map(|(_, command)| command).collect();
    if more > 0 {
        commands.push(format!(
            "::notice title=impactcheck::{more} more failures are in the job summary and in the report"
        ));
    }
    commands.extend(changed);
    commands
}

/// A workflow command per tolerance that was changed since it was accepted.
fn warnings<Q: Quantities>(
    comparison: &SceneComparison<Q>,
    place: impl Fn(&str) -> (String, String),
) -> Vec<String> {
    let command = |changed: &ChangedTolerance| {
        let (file, text) = place(&comparison.scene);
        let line = line_of(&text, &changed.model, &changed.quantity);
        let line = line.map_or(String::new(), |line| format!(",line={line}"));
        let title = property(&format!("{}, tolerance changed", comparison.scene));
        format!("::warning file={}{line},title={title}::{}", property(&file), data(&changed.sentence()))
    };
    comparison.changed_tolerances.iter().map(command).collect()
}

/// How far beyond its bound, and the command.
fn annotations_of<Q: Quantities>(
    comparison: &SceneComparison<Q>,
    place: impl Fn(&str) -> (String, String),
) -> Vec<(f64, String)> {
    let (file, text) = place(&comparison.scene);
    let command = |failure: Failure| {
        let line = failure.row.and_then(|row| line_of(&text, failure.model?, &row.quantity));
        let line = line.map_or(String::new(), |line| format!(",line={line}"));
        let title = property(&format!("{}, {}", comparison.scene, failure.of));
        let size =
            failure.row.and_then(Discrepancy::used).filter(|used| !used.is_nan()).unwrap_or(f64::INFINITY);
        (size, format!("::error file={}{line},title={title}::{}", property(&file), data(&failure.message)))
    };
    failures(comparison).into_iter().map(command).collect()
}

/// Something of a scene that fails.
struct Failure<'a> {
    /// What it belongs to, in words.
    of: String,
    message: String,
    /// The model and the row, if it is one.
    model: Option<&'a str>,
    row: Option<&'a Discrepancy>,
}

/// All that fails in a scene.
fn failures<Q: Quantities>(comparison: &SceneComparison<Q>) -> Vec<Failure<'_>> {
    let broken = |of: &str, checks: &'_ [Check]| -> Vec<Failure<'_>> {
        let failed = checks.iter().filter(|c| !c.verdict.passed());
        let failure = |check| {
            let message = super::check_failure(check);
            Failure { of: of.to_owned(), message, model: None, row: None }
        };
        failed.map(failure).collect()
    };
    let mut found = broken("reference", &comparison.integrity);
    for model in &comparison.models {
        let name = format!("model {}", model.model);
        found.extend(broken(&name, &model.integrity));
        for row in model.discrepancies.iter().filter(|d| !d.verdict.passed()) {
            found.push(Failure {
                of: format!("{name}, {}", words(&row.quantity)),
                message: super::row_failure(row),
                model: Some(&model.model),
                row: Some(row),
            });
        }
    }
    found
}

/// Markdown for the summary of the job: verdict per scene and model, and what failed.
pub fn job_summary(report: &Report) -> String {
    let mut text = format!("## impactcheck: {}\n\n", report.comparison().verdict);
    text += "| scene | model | verdict | largest discrepancy | nearest to its bound | tolerance used |\n|---|---|---|---|---|--:|\n";
    let mut failed = String::new();
    for scene in &report.scenes {
        text += &summary_rows(&scene.comparison);
        failed += &failure_list(&scene.comparison);
    }
    for seat in &report.seats {
        text += &summary_rows(&seat.comparison);
        failed += &failure_list(&seat.comparison);
    }
    if failed.is_empty() { text } else { format!("{text}\n### What failed\n\n{failed}") }
}

fn summary_rows<Q: Quantities>(comparison: &SceneComparison<Q>) -> String {
    let row = |model: &ModelComparison<Q>| {
        let largest = model
            .largest()
            .map_or("–".into(), |d| format!("{} {}", words(&d.quantity), percent(d.relative)));
        let tightest = model.tightest();
        let used = tightest.and_then(Discrepancy::used);
        format!(
            "| {} | {} | {} | {largest} | {} | {} |\n",
            escaped(&comparison.scene),
            escaped(&model_name(&model.model, model.summary.modes)),
            model.verdict,
            tightest.map_or("–".into(), |d| words(&d.quantity)),
            used.map_or("–".into(), |used| format!("{} %", significant(100.0 * used, 2))),
        )
    };
    comparison.models.iter().map(row).collect()
}

fn failure_list<Q: Quantities>(comparison: &SceneComparison<Q>) -> String {
    let line = |failure: Failure| {
        // the row's message begins with its quantity
        let of = failure.model.map_or(failure.of, |model| format!("model {model}"));
        format!("- {}, {of}: {}\n", escaped(&comparison.scene), escaped(&failure.message))
    };
    failures(comparison).into_iter().map(line).collect()
}

/// Text of a table's cell or a list.
fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('|', "\\|").replace('<', "&lt;").replace(['\n', '\r'], " ")
}

/// A message as workflow commands need it.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// The value of a property of a workflow command.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

/// `file` as seen from the repository's folder, which is where GitHub looks for it.
pub fn path_in_repository(file: &Path) -> String {
    let workspace = std::env::var_os("GITHUB_WORKSPACE").map(std::path::PathBuf::from);
    let root = workspace.or_else(|| std::env::current_dir().ok()).and_then(|root| root.canonicalize().ok());
    let full = file.canonicalize().ok();
    let inside = full.zip(root).and_then(|(full, root)| full.strip_prefix(root).map(Path::to_path_buf).ok());
    inside.unwrap_or_else(|| file.to_path_buf()).display().to_string()
}
