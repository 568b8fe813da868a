//! The gate in continuous integration: results over commits, changes that need a reason, messages for GitHub.

use crate::sealed::{change_summary, copy_shipped};
use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

const SCENE: &str = "scaled-plate-r6.35";

/// A repository with one scene and its reference.
struct Repository {
    folder: tempfile::TempDir,
}

impl Repository {
    fn new() -> Self {
        let repository = Repository { folder: tempfile::tempdir().unwrap() };
        let project = Path::new(env!("CARGO_MANIFEST_DIR"));
        fs::copy(project.join(format!("scenes/{SCENE}.toml")), repository.scene()).unwrap();
        copy_shipped(&format!("{SCENE}/coarse"), &repository.solution());
        repository.git(&["init", "-q"]);
        repository.commit("first");
        repository
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn scene(&self) -> PathBuf {
        self.path("scene.toml")
    }

    fn solution(&self) -> PathBuf {
        self.path("store").join(SCENE).join("coarse")
    }

    fn git(&self, arguments: &[&str]) -> String {
        let identity = ["-c", "user.name=test", "-c", "user.email=test@example.org"];
        let output = std::process::Command::new("git")
            .arg("-C")
            .arg(self.folder.path())
            .args(identity)
            .args(arguments)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    }

    fn commit(&self, message: &str) -> String {
        self.git(&["add", "scene.toml", "store"]);
        self.git(&["commit", "-q", "--allow-empty", "-m", message]);
        self.git(&["rev-parse", "HEAD"])
    }

    fn replace(&self, from: &str, to: &str) {
        let text = fs::read_to_string(self.scene()).unwrap();
        assert!(text.contains(from), "{from}");
        fs::write(self.scene(), text.replacen(from, to, 1)).unwrap();
    }

    /// As [`Repository::replace`], among the tolerances of model B.
    fn replace_of_b(&self, from: &str, to: &str) {
        let text = fs::read_to_string(self.scene()).unwrap();
        let (before, after) = text.split_once("[tolerances.B]").unwrap();
        assert!(after.contains(from), "{from}");
        fs::write(self.scene(), format!("{before}[tolerances.B]{}", after.replacen(from, to, 1))).unwrap();
    }

    fn gate_in(&self, environment: &[(&str, &str)], arguments: &[&str]) -> Output {
        Command::cargo_bin("impactcheck")
            .unwrap()
            .args(["gate", "scene.toml", "--models", "B,C", "--resolution", "coarse", "--store", "store"])
            .args(arguments)
            .current_dir(self.folder.path())
            .env_remove("GITHUB_ACTIONS")
            .env_remove("GITHUB_STEP_SUMMARY")
            .env_remove("GITHUB_WORKSPACE")
            .envs(environment.iter().copied())
            .output()
            .unwrap()
    }

    /// Exit status and what is said on standard error.
    fn gate(&self, arguments: &[&str]) -> (i32, String) {
        let output = self.gate_in(&[], arguments);
        (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
    }

    /// Changes numbers of the stored summary and seals it again.
    fn change_reference(&self, change: impl FnOnce(&mut Value)) {
        change_summary(&self.solution(), change);
    }

    fn accepted(&self) -> Vec<Value> {
        let text = fs::read_to_string(self.path("scene.accepted.jsonl")).unwrap_or_default();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }
}

#[test]
fn a_tolerance_changes_with_a_reason_only_and_comments_stay() {
    let repository = Repository::new();
    assert_eq!(repository.gate(&[]).0, 0);
    // model B's known discrepancies were others before somebody mended it
    repository.replace_of_b(
        "inner_force_peak     = { relative = 0.01, bias =",
        "inner_force_peak     = { relative = 0.01, bias = 0.2 } # mind the gap\n#",
    );
    repository.replace_of_b(
        "outer_contact_end    = { absolute = \"0.5 us\", bias =",
        "outer_contact_end    = { absolute = \"0.5 us\", bias = \"40 us\" }\n#",
    );
    let before = fs::read_to_string(repository.scene()).unwrap();
    assert_eq!(repository.gate(&[]).0, 10);
    for arguments in [&["--update"][..], &["--update", "--reason", "  "], &["--reason", "why"]] {
        assert_eq!(repository.gate(arguments).0, 2, "{arguments:?}");
    }
    assert_eq!(fs::read_to_string(repository.scene()).unwrap(), before, "nothing changed without a reason");
    assert!(repository.accepted().is_empty());

    let (status, said) = repository.gate(&["--update", "--reason", "contact law of 2026"]);
    assert_eq!(status, 0, "{said}");
    let after = fs::read_to_string(repository.scene()).unwrap();
    assert!(after.contains("# mind the gap"), "{after}");
    let changed: Vec<_> = before.lines().zip(after.lines()).filter(|(a, b)| a != b).collect();
    let record = repository.accepted();
    assert_eq!((record.len(), record[0]["reason"].as_str()), (1, Some("contact law of 2026")));
    let tolerances = record[0]["tolerances"].as_array().unwrap();
    assert_eq!(tolerances.len(), changed.len(), "what was not failing is not touched: {changed:?}");
    for tolerance in tolerances {
        let (from, to) = (tolerance["from"].as_str().unwrap(), tolerance["to"].as_str().unwrap());
        assert!(before.contains(from) && after.contains(to) && from != to, "{tolerance}");
    }
    assert_eq!(repository.gate(&[]).0, 0);
    let page = fs::read_to_string(repository.path(&format!("reports/{SCENE}.html"))).unwrap();
    assert!(page.contains("contact law of 2026"));
    // once more there is nothing to do
    let (status, said) = repository.gate(&["--update", "--reason", "again"]);
    assert!(status == 0 && said.contains("nothing to update"), "{said}");
    assert_eq!(repository.accepted().len(), 1);
}

#[test]
fn a_loosened_tolerance_has_a_warning_until_there_is_a_reason() {
    let repository = Repository::new();
    assert!(!repository.gate(&[]).1.contains("without a reason"), "nothing was accepted yet");
    assert_eq!(repository.gate(&["--update", "--reason", "first reference"]).0, 0);
    assert!(!repository.gate(&[]).1.contains("without a reason"));
    let text = fs::read_to_string(repository.scene()).unwrap();
    let line = 2 + text[..text.find("[tolerances.C]").unwrap()].matches('\n').count();
    repository.replace(
        "[tolerances.C]\nefficiency           = { absolute = 0.002 }",
        "[tolerances.C]\nefficiency           = { absolute = 0.02 }",
    );
    let output =
        repository.gate_in(&[("GITHUB_ACTIONS", "true")], &["--json", "--quiet", "--junit", "gate.xml"]);
    assert_eq!(output.status.code(), Some(0), "a warning, no failure");
    let sentence =
        "tolerances.C.efficiency was accepted as { absolute = 0.002 } and is now { absolute = 0.02 }";
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains(&format!("warning: {SCENE}: {sentence}")), "{said}");
    assert!(said.contains(&format!("::warning file=scene.toml,line={line},")), "{line}: {said}");
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    let changed = &json["scenes"][0]["changed_tolerances"];
    assert_eq!(changed.as_array().unwrap().len(), 1, "{changed}");
    assert_eq!(changed[0]["model"], "C");
    assert_eq!(changed[0]["quantity"], "efficiency");
    assert_eq!(changed[0]["accepted"], "{ absolute = 0.002 }");
    assert_eq!(changed[0]["now"], "{ absolute = 0.02 }");
    let junit = fs::read_to_string(repository.path("gate.xml")).unwrap();
    let property = "name=\"changed_tolerance.C.efficiency\" value=\"accepted { absolute = 0.002 }, now";
    assert!(junit.contains(property), "{junit}");
    let page = fs::read_to_string(repository.path(&format!("reports/{SCENE}.html"))).unwrap();
    assert!(page.contains("changed since, without a reason"));
    // with a reason it is one of the accepted changes
    let (status, said) = repository.gate(&["--update", "--reason", "model C without its residual"]);
    assert_eq!(status, 0, "{said}");
    let record = repository.accepted();
    assert_eq!(record.len(), 2);
    assert_eq!(record[1]["tolerances"][0]["from"], "{ absolute = 0.002 }");
    assert_eq!(record[1]["tolerances"][0]["to"], "{ absolute = 0.02 }");
    assert!(!repository.gate(&[]).1.contains("without a reason"));
    // a gate that was taken away is missed as well
    repository.replace("efficiency           = { absolute = 0.02 }\n", "");
    let said = repository.gate(&[]).1;
    assert!(
        said.contains(
            "tolerances.C.efficiency was accepted as { absolute = 0.02 } and is not there any more"
        ),
        "{said}"
    );
}

/// A residual has no bias: its bound is raised above what was found.
#[test]
fn a_residuals_bound_is_raised() {
    let repository = Repository::new();
    let text = fs::read_to_string(repository.scene()).unwrap();
    let strict = text.replace("energy_residual      = { absolute = 1e-5 }", "energy_residual      = 1e-9");
    assert_ne!(strict, text);
    fs::write(repository.scene(), strict).unwrap();
    assert_eq!(repository.gate(&[]).0, 10);
    assert_eq!(repository.gate(&["--update", "--reason", "coarse mesh"]).0, 0);
    let after = fs::read_to_string(repository.scene()).unwrap();
    let bound = |line: &str| line.strip_prefix("energy_residual      = ")?.parse::<f64>().ok();
    let bounds: Vec<f64> = after.lines().filter_map(bound).collect();
    let summary = fs::read_to_string(repository.solution().join("summary.json")).unwrap();
    let residual = serde_json::from_str::<Value>(&summary).unwrap()["energy_residual"].as_f64().unwrap();
    // model A is not compared, its bound is as it was
    assert_eq!(bounds.iter().filter(|b| **b == 1e-9).count(), 1);
    let raised = bounds.iter().filter(|b| **b >= 2.0 * residual && **b <= 2.2 * residual).count();
    assert_eq!(raised, 2, "{bounds:?} for {residual}");
}

#[test]
fn a_reference_that_moved_beyond_its_band_fails_until_it_is_accepted() {
    let repository = Repository::new();
    assert_eq!(repository.gate(&["--update", "--reason", "first reference"]).0, 0);
    let moved = |by: f64| {
        let first = repository.accepted()[0]["reference"]["quantities"]["first_frequency"].clone();
        let (value, width) = (first[0].as_f64().unwrap(), first[1].as_f64().unwrap());
        repository.change_reference(|summary| {
            let shift = value + by * width - summary["first_frequency"].as_f64().unwrap();
            summary["first_frequency"] = (value + by * width).into();
            // on all meshes, so that the band is as it was
            let series = &mut summary["convergence"]["quantities"]["first_frequency"]["values"];
            for on_a_mesh in series.as_array_mut().unwrap() {
                *on_a_mesh = (on_a_mesh.as_f64().unwrap() + shift).into();
            }
            series[0] = (value + by * width).into();
        });
        repository.gate(&["--json", "--junit", "gate.xml"])
    };
    // bands of both: sqrt(2) of one
    assert_eq!(moved(1.3).0, 0, "within the uncertainties");
    let (status, said) = moved(1.6);
    assert_eq!(status, 10, "{said}");
    let junit = fs::read_to_string(repository.path("gate.xml")).unwrap();
    assert!(junit.contains("integrity.accepted_reference_first_frequency"));
    assert_eq!(repository.gate(&["--update", "--reason", "finer mesh"]).0, 0);
    assert_eq!(repository.accepted().len(), 2);
    assert_eq!(repository.gate(&[]).0, 0);
}

#[test]
fn what_contradicts_itself_cannot_be_accepted() {
    let repository = Repository::new();
    repository.change_reference(|summary| summary["efficiency"] = 0.5.into());
    let before = fs::read_to_string(repository.scene()).unwrap();
    let (status, said) = repository.gate(&["--update", "--reason", "it must pass"]);
    assert!(status == 2 && said.contains("contradicts itself"), "{status}: {said}");
    assert_eq!(fs::read_to_string(repository.scene()).unwrap(), before);
    assert!(repository.accepted().is_empty());
}

#[test]
fn results_are_recorded_once_per_commit_and_their_drift_is_shown() {
    let repository = Repository::new();
    let file = repository.path("trends.jsonl");
    let entries = || -> Vec<Value> {
        let text = fs::read_to_string(&file).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    };
    let record = || assert_eq!(repository.gate(&["--record", "trends.jsonl"]).0, 0);
    let first = repository.git(&["rev-parse", "HEAD"]);
    record();
    let once = fs::read_to_string(&file).unwrap();
    record();
    assert_eq!(fs::read_to_string(&file).unwrap(), once, "the same commit is replaced");
    assert_eq!(entries().len(), 3, "B, C and the reference");
    assert!(entries().iter().all(|e| e["commit"] == first.as_str()));

    // numbers are those of the JSON document
    let json: Value = serde_json::from_slice(&repository.gate_in(&[], &["--json"]).stdout).unwrap();
    for entry in entries() {
        let models = json["scenes"][0]["models"].as_array().unwrap();
        let model = models.iter().find(|m| m["model"] == entry["model"]);
        let summary = model.map_or(&json["scenes"][0]["reference"], |m| &m["summary"]);
        assert_eq!(entry["quantities"]["outer_force_peak"], summary["outer_force_peak"]);
    }

    // a change that is not committed is marked, and goes when it is
    repository.replace("name ", "# a comment\nname ");
    record();
    assert_eq!(entries().iter().filter(|e| e["commit"] == format!("{first}-dirty")).count(), 3);
    let second = repository.commit("second");
    record();
    assert_eq!(
        entries().iter().map(|e| e["commit"].as_str().unwrap().to_owned()).collect::<Vec<_>>(),
        [[&first; 3], [&second; 3]].concat().into_iter().cloned().collect::<Vec<_>>()
    );

    // the first value was another one: the page says since when it is not
    let text = fs::read_to_string(&file).unwrap();
    let peak = entries()[0]["quantities"]["outer_force_peak"].as_f64().unwrap();
    fs::write(&file, text.replacen(&peak.to_string(), &(1.004 * peak).to_string(), 1)).unwrap();
    fs::create_dir_all(repository.path("reports")).unwrap();
    fs::copy(&file, repository.path("reports/trends.jsonl")).unwrap();
    assert_eq!(repository.gate(&[]).0, 0);
    let page = fs::read_to_string(repository.path(&format!("reports/{SCENE}.html"))).unwrap();
    let row = page
        .split("<tr ")
        .find(|row| {
            row.contains("class=\"spark\"")
                && row.starts_with("data-model=\"B\" data-quantity=\"outer_force_peak\"")
        })
        .unwrap();
    assert!(row.contains(&format!("<code title=\"{second}\">")), "{row}");
    assert_eq!(page.matches("<code title=").count(), 1, "nothing else drifts");

    fs::write(&file, format!("{text}{{\"commit\": 1}}\n")).unwrap();
    let (status, said) = repository.gate(&["--record", "trends.jsonl"]);
    assert!(status == 2 && said.contains("trends.jsonl, line 7"), "{said}");
}

#[test]
fn without_a_repository_recording_is_refused_before_anything_is_done() {
    let repository = Repository::new();
    fs::remove_dir_all(repository.path(".git")).unwrap();
    let output = Command::cargo_bin("impactcheck")
        .unwrap()
        .args(["gate", "scene.toml", "--store", "store", "--record", "trends.jsonl"])
        .current_dir(repository.folder.path())
        .env("GIT_CEILING_DIRECTORIES", repository.folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(!repository.path("trends.jsonl").exists() && !repository.path("reports").exists());
}

#[test]
fn github_gets_annotations_at_the_tolerances_and_a_summary() {
    let repository = Repository::new();
    repository.replace_of_b(
        "outer_force_peak     = { relative = 0.01, bias =",
        "outer_force_peak     = { relative = 0.01, bias = 0.5 } #",
    );
    repository.replace(
        "[tolerances.C]\nefficiency           = { absolute = 0.002 }",
        "[tolerances.C]\nefficiency           = { absolute = 1e-9 }",
    );
    let text = fs::read_to_string(repository.scene()).unwrap();
    let line = |of: &str| 1 + text[..text.find(of).unwrap()].matches('\n').count();
    let environment = [("GITHUB_ACTIONS", "true"), ("GITHUB_STEP_SUMMARY", "summary.md")];
    fs::write(repository.path("summary.md"), "what was there\n").unwrap();
    let output = repository.gate_in(&environment, &["--json", "--quiet"]);
    assert_eq!(output.status.code(), Some(10));
    serde_json::from_slice::<Value>(&output.stdout).expect("standard output is the document alone");
    let said = String::from_utf8(output.stderr).unwrap();
    // no reference decides a tolerance of 1e-9
    let undecided = format!(
        ",line={},title={SCENE}%2C model C%2C efficiency::efficiency: model 0.38",
        line("efficiency           = { absolute = 1e-9")
    );
    let failed = format!(
        "::error file=scene.toml,line={},title={SCENE}%2C model B%2C outer force%2C peak::outer_force_peak: model",
        line("outer_force_peak     = { relative = 0.01, bias = 0.5 }")
    );
    let has = |said: &str, command: &str| said.lines().any(|line| line.starts_with(command));
    assert!(has(&said, &failed), "{failed}\n{said}");
    assert!(has(&said, &format!("::warning file=scene.toml{undecided}")), "{undecided}\n{said}");
    for (rule, level) in [("fail", Some("error")), ("pass", None)] {
        let output = repository.gate_in(&environment[..1], &["--quiet", "--undecided", rule]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(has(&said, &failed), "{said}");
        assert_eq!(said.contains(&undecided), level.is_some(), "{rule}: {said}");
        let command = level.map_or(String::new(), |level| format!("::{level} file=scene.toml{undecided}"));
        assert!(has(&said, &command), "{command}\n{said}");
    }
    let summary = fs::read_to_string(repository.path("summary.md")).unwrap();
    assert!(summary.starts_with("what was there\n## impactcheck: fail"), "{summary}");
    let (failed, undecided) = summary.split_once("### What is undecided").unwrap();
    assert!(
        failed.contains(&format!("### What failed\n\n- {SCENE}, model B: outer_force_peak: model")),
        "{summary}"
    );
    assert!(undecided.contains(&format!("- {SCENE}, model C: efficiency: model")), "{summary}");
    assert!(!repository.gate(&[]).1.contains("::error"), "only where GitHub runs it");
}
