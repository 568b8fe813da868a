//! Messages for GitHub Actions: annotations at the tolerance that is exceeded, and the summary of the job.

use super::tolerance_edit::line_of;
use crate::report::Report;
use crate::report::format::{model_name, percent, significant, words};
use std::path::Path;

/// GitHub shows this many errors of a step.
const SHOWN: usize = 10;

/// Whether this process is run by GitHub Actions.
pub fn is_running() -> bool {
    std::env::var("GITHUB_ACTIONS").is_ok_and(|value| value == "true")
}

/// A workflow command per failed row and check, the row farthest beyond its bound first. `text_of` gives the text of
/// scene number `k`, whose path in the repository is `files[k]`.
pub fn annotations(report: &Report, files: &[String], text_of: impl Fn(usize) -> String) -> Vec<String> {
    let mut found: Vec<(f64, String)> = Vec::new();
    for (k, scene) in report.scenes.iter().enumerate() {
        let comparison = &scene.comparison;
        let text = text_of(k);
        let mut add = |size: f64, line: Option<usize>, what: String, message: String| {
            let line = line.map_or(String::new(), |line| format!(",line={line}"));
            let title = property(&format!("{}, {what}", comparison.scene));
            let file = property(&files[k]);
            found.push((size, format!("::error file={file}{line},title={title}::{}", data(&message))));
        };
        for check in comparison.integrity.iter().filter(|c| !c.verdict.passed()) {
            add(f64::INFINITY, None, "reference".into(), crate::report::check_failure(check));
        }
        for model in &comparison.models {
            let name = format!("model {}", model.model);
            for check in model.integrity.iter().filter(|c| !c.verdict.passed()) {
                add(f64::INFINITY, None, name.clone(), crate::report::check_failure(check));
            }
            for row in model.discrepancies.iter().filter(|d| !d.verdict.passed()) {
                let line = line_of(&text, &model.model, &row.quantity);
                let used = row.used().filter(|used| !used.is_nan()).unwrap_or(f64::INFINITY);
                add(used, line, format!("{name}, {}", words(&row.quantity)), crate::report::row_failure(row));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let more = found.len().saturating_sub(SHOWN);
    let mut commands: Vec<String> = found.into_iter().take(SHOWN).map(|(_, command)| command).collect();
    if more > 0 {
        commands.push(format!(
            "::notice title=impactcheck::{more} more failures are in the job summary and in the report"
        ));
    }
    commands
}

/// Markdown for the summary of the job: verdict per scene and model, and what failed.
pub fn job_summary(report: &Report) -> String {
    let mut text = format!("## impactcheck: {}\n\n", report.comparison().verdict);
    text += "| scene | model | verdict | largest discrepancy | nearest to its bound | tolerance used |\n|---|---|---|---|---|--:|\n";
    for scene in &report.scenes {
        for model in &scene.comparison.models {
            let largest = model
                .largest()
                .map_or("–".into(), |d| format!("{} {}", words(&d.quantity), percent(d.relative)));
            let tightest = model.tightest();
            text += &format!(
                "| {} | {} | {} | {largest} | {} | {} |\n",
                escaped(&scene.comparison.scene),
                escaped(&model_name(&model.model, model.summary.modes)),
                model.verdict,
                tightest.map_or("–".into(), |d| words(&d.quantity)),
                tightest
                    .and_then(|d| d.used())
                    .map_or("–".into(), |used| format!("{} %", significant(100.0 * used, 2))),
            );
        }
    }
    let mut failures = String::new();
    for scene in &report.scenes {
        let comparison = &scene.comparison;
        let mut add = |of: &str, what: String| {
            failures += &format!("- {}, {of}: {}\n", escaped(&comparison.scene), escaped(&what));
        };
        for check in comparison.integrity.iter().filter(|c| !c.verdict.passed()) {
            add("reference", crate::report::check_failure(check));
        }
        for model in &comparison.models {
            let name = format!("model {}", model.model);
            for check in model.integrity.iter().filter(|c| !c.verdict.passed()) {
                add(&name, crate::report::check_failure(check));
            }
            for row in model.discrepancies.iter().filter(|d| !d.verdict.passed()) {
                add(&name, crate::report::row_failure(row));
            }
        }
    }
    if failures.is_empty() { text } else { format!("{text}\n### What failed\n\n{failures}") }
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
