//! Messages for GitHub Actions: annotations at the tolerance that is exceeded, and the summary of the job.

use crate::ci::tolerance_edit::line_of;
use crate::comparison::{
    AMONG, ChangedTolerance, Check, Discrepancy, GateRules, ModelComparison, SceneComparison, Undecided,
    Verdict,
};
use crate::format::{model_name, percent, significant, words};
use crate::report::{Report, SceneReport, row_in_words};
use std::path::Path;

/// GitHub shows this many errors of a step, and as many warnings.
const SHOWN: usize = 10;

/// Whether this process is run by GitHub Actions.
pub fn is_running() -> bool {
    std::env::var("GITHUB_ACTIONS").is_ok_and(|value| value == "true")
}

/// A workflow command per row and check that stops at the gate (an error) or is undecided and to be told (a warning), the row
/// farthest beyond its bound first. `place` gives the file of the scene of that name, as seen from the repository, and its text.
pub fn annotations(report: &Report, place: impl Fn(&str) -> (String, String)) -> Vec<String> {
    let rules = report.rules;
    let of_scene = |s: &SceneReport| annotations_of(&s.comparison, rules, &place);
    let mut found: Vec<Annotation> = report.scenes.iter().flat_map(of_scene).collect();
    found.sort_by(|a, b| b.size.total_cmp(&a.size));
    let mut commands = Vec::new();
    for (level, what) in [("error", "failures"), ("warning", "undecided rows")] {
        let own: Vec<_> = found.iter().filter(|annotation| annotation.level == level).collect();
        commands.extend(own.iter().take(SHOWN).map(|annotation| annotation.command.clone()));
        if let Some(more) = own.len().checked_sub(SHOWN).filter(|more| *more > 0) {
            commands.push(format!(
                "::notice title=impactcheck::{more} more {what} are in the job summary and in the report"
            ));
        }
    }
    commands.extend(report.scenes.iter().flat_map(|s| warnings(&s.comparison, &place)));
    commands
}

/// A workflow command per tolerance that was changed since it was accepted.
fn warnings(comparison: &SceneComparison, place: impl Fn(&str) -> (String, String)) -> Vec<String> {
    let command = |changed: &ChangedTolerance| {
        let (file, text) = place(&comparison.scene);
        let line = line_of(&text, &changed.model, &changed.quantity);
        let line = line.map_or(String::new(), |line| format!(",line={line}"));
        let title = property(&format!("{}, tolerance changed", comparison.scene));
        format!("::warning file={}{line},title={title}::{}", property(&file), data(&changed.sentence()))
    };
    comparison.changed_tolerances.iter().map(command).collect()
}

/// A workflow command.
struct Annotation {
    level: &'static str,
    /// How far beyond its bound.
    size: f64,
    command: String,
}

fn annotations_of(
    comparison: &SceneComparison,
    rules: GateRules,
    place: impl Fn(&str) -> (String, String),
) -> Vec<Annotation> {
    let (file, text) = place(&comparison.scene);
    let annotation = |finding: GateFinding| {
        let is_refused =
            finding.row.map_or_else(|| rules.refuse(finding.verdict), |row| row.is_refused(rules));
        let level = match finding.verdict {
            _ if is_refused => "error",
            _ if rules.undecided == Undecided::Pass => return None,
            _ => "warning",
        };
        let line = finding.row.and_then(|row| line_of(&text, finding.model?, &row.quantity));
        let line = line.map_or(String::new(), |line| format!(",line={line}"));
        let title = property(&format!("{}, {}", comparison.scene, finding.of));
        let size = finding.row.and_then(Discrepancy::used).filter(|used| !used.is_nan());
        Some(Annotation {
            level,
            size: size.unwrap_or(f64::INFINITY),
            command: format!(
                "::{level} file={}{line},title={title}::{}",
                property(&file),
                data(&finding.message)
            ),
        })
    };
    findings(comparison, rules).into_iter().filter_map(annotation).collect()
}

/// Something of a scene that fails, is undecided, or lacks what is required.
struct GateFinding<'a> {
    verdict: Verdict,
    /// What it belongs to, in words.
    of: String,
    message: String,
    /// The model and the row, if it is one.
    model: Option<&'a str>,
    row: Option<&'a Discrepancy>,
}

/// All that is to be told of a scene.
fn findings(comparison: &SceneComparison, rules: GateRules) -> Vec<GateFinding<'_>> {
    let broken = |of: &str, checks: &'_ [Check]| -> Vec<GateFinding<'_>> {
        let failed = checks.iter().filter(|c| c.verdict.failed());
        let finding = |check: &Check| {
            let message = check.to_string();
            GateFinding { verdict: check.verdict, of: of.to_owned(), message, model: None, row: None }
        };
        failed.map(finding).collect()
    };
    let mut found = broken("reference", &comparison.integrity);
    if comparison.verdict == Verdict::NotGated && rules.refuse(comparison.verdict) {
        let message = "nothing is gated, and tolerances are required".to_owned();
        found.push(GateFinding {
            verdict: comparison.verdict,
            of: "gate".to_owned(),
            message,
            model: None,
            row: None,
        });
    }
    for model in &comparison.models {
        let name = format!("model {}", model.model);
        found.extend(broken(&name, &model.integrity));
        for row in model.discrepancies.iter().filter(|d| d.is_reported()) {
            found.push(GateFinding {
                verdict: row.verdict,
                of: format!("{name}, {}", words(&row.quantity)),
                message: row_in_words(row),
                model: Some(&model.model),
                row: Some(row),
            });
        }
    }
    found
}

/// Markdown for the summary of the job: verdict per scene and model, what failed and what is undecided.
pub fn job_summary(report: &Report) -> String {
    let mut text = format!("## impactcheck: {}\n\n", report.comparison().verdict);
    text += "| scene | model | verdict | largest discrepancy of the summary | nearest to its bound | tolerance used |\n|---|---|---|---|---|--:|\n";
    let mut listed = Vec::new();
    for scene in &report.scenes {
        text += &summary_rows(&scene.comparison);
        listed.extend(list(&scene.comparison, report.rules));
    }
    text += &format!("\n{AMONG}\n");
    for (heading, undecided) in [("What failed", false), ("What is undecided", true)] {
        let own: String =
            listed.iter().filter(|l| (l.0 == Verdict::Undecided) == undecided).map(|l| &*l.1).collect();
        if !own.is_empty() {
            text += &format!("\n### {heading}\n\n{own}");
        }
    }
    text
}

fn summary_rows(comparison: &SceneComparison) -> String {
    let row = |model: &ModelComparison| {
        let largest = model
            .largest()
            .map_or("–".into(), |d| format!("{} {}", words(&d.quantity), percent(d.relative)));
        let tightest = model.tightest();
        let used = tightest.and_then(Discrepancy::used);
        format!(
            "| {} | {} | {} | {largest} | {} | {} |\n",
            escaped(&comparison.scene),
            escaped(&model_name(&model.model, model.summary.modes)),
            model.verdict_in_words(),
            tightest.map_or("–".into(), |d| words(&d.quantity)),
            used.map_or("–".into(), |used| format!("{} %", significant(100.0 * used, 2))),
        )
    };
    comparison.models.iter().map(row).collect()
}

/// Verdict and line of every finding.
fn list(comparison: &SceneComparison, rules: GateRules) -> Vec<(Verdict, String)> {
    let line = |finding: GateFinding| {
        // the row's message begins with its quantity
        let of = finding.model.map_or(finding.of, |model| format!("model {model}"));
        let line = format!("- {}, {of}: {}\n", escaped(&comparison.scene), escaped(&finding.message));
        (finding.verdict, line)
    };
    findings(comparison, rules).into_iter().map(line).collect()
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
