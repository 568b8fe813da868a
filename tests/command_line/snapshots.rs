//! What a person sees: every command's help, and an error of every exit status, as snapshots.
//!
//! After a change that is meant: `INSTA_UPDATE=always cargo test --release --test command_line snapshots`, and read the diff.

use assert_cmd::Command;
use insta::{assert_snapshot, with_settings};
use std::fs;
use std::path::Path;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const COMMANDS: [&str; 21] = [
    "reduced",
    "reference",
    "compare",
    "gate",
    "coverage",
    "diff",
    "mesh",
    "study",
    "uncertainty",
    "calibrate",
    "optimise",
    "bench",
    "stress",
    "doctor",
    "fmu",
    "live",
    "schema",
    "new",
    "completions",
    "man",
    "help",
];

/// Standard output or, if there is none, standard error, and the exit status.
fn seen(arguments: &[&str], store: Option<&Path>) -> String {
    let mut command = Command::cargo_bin("impactcheck").unwrap();
    command.args(arguments).current_dir(ROOT).env("COLUMNS", "100").env("NO_COLOR", "1");
    for name in ["IMPACTCHECK_STORE", "IMPACTCHECK_PYTHON", "GITHUB_ACTIONS"] {
        command.env_remove(name);
    }
    if let Some(store) = store {
        command.env("IMPACTCHECK_STORE", store);
    }
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim_end().to_owned();
    let (out, error) = (text(&output.stdout), text(&output.stderr));
    format!("{out}{error}\n[exit status {}]", output.status.code().expect("ended by itself"))
}

/// Compares with the snapshot; what depends on machine and moment is masked.
fn check(name: &str, seen: &str, folder: &Path) {
    let folder = folder.display().to_string();
    let seen = seen.replace(&folder, "[FOLDER]").replace(ROOT, "[PROJECT]");
    with_settings!({ prepend_module_to_snapshot => false, omit_expression => true, filters => [
        (r"\d+\.\d+ s\b", "[TIME]"),
        (r"[0-9a-f]{64}", "[HASH]"),
        (r"\.partial-\w+", ".partial-[RANDOM]"),
    ] }, { assert_snapshot!(name, seen); });
}

#[test]
fn help_of_the_program_and_of_every_command() {
    let nowhere = Path::new("/nonexistent");
    check("help", &seen(&["--help"], None), nowhere);
    for command in COMMANDS.iter().filter(|c| **c != "help") {
        let help = seen(&[command, "--help"], None);
        assert!(help.contains("Example"), "{command}: no example");
        check(&format!("help-{command}"), &help, nowhere);
    }
}

#[test]
fn the_list_of_commands_is_complete() {
    let help = seen(&["--help"], None);
    let listed = help.lines().take_while(|l| *l != "Options:");
    let names: Vec<&str> = listed
        .filter(|l| l.starts_with("  ") && !l.starts_with("   "))
        .filter_map(|l| l.split_whitespace().next())
        .collect();
    let mut expected = COMMANDS.to_vec();
    expected.sort_unstable();
    let mut found = names.clone();
    found.sort_unstable();
    assert_eq!(found, expected);
}

#[test]
fn an_error_of_every_exit_status() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let shipped = fs::read_to_string(Path::new(ROOT).join("scenes/scaled-plate-r10.toml")).unwrap();
    let write = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).unwrap();
        path(name)
    };
    let case = |name: &str, arguments: &[&str]| check(name, &seen(arguments, None), folder.path());

    // 1: a report that can't be written
    case("error-1-report-folder-is-none", &["compare", "scaled-plate-r10", "--out", "/proc/report"]);
    // 2: usage
    let file = write("file", "");
    case("error-2-report-folder-is-a-file", &["compare", "scaled-plate-r10", "--out", &file]);
    case("error-2-unknown-scene", &["reduced", "scaled-plate-r11"]);
    case("error-2-unknown-command", &["compair"]);
    case("error-2-tolerance", &["reduced", "scaled-plate-r10", "--tolerance", "2"]);
    case("error-2-new-exists", &["new", "x", "--out", &file]);
    // 3: the scene
    let unit = write("unit.toml", &shipped.replacen("\"33 mm\"", "\"33 mn\"", 1));
    case("error-3-unit", &["reduced", &unit]);
    let key = write("key.toml", &shipped.replacen("thickness =", "thicknes =", 1));
    case("error-3-key", &["reduced", &key]);
    // 10: a tolerance
    let strict = shipped
        .split_once("[tolerances.A]")
        .map(|(scene, _)| format!("{scene}[tolerances.A]\nefficiency = {{ absolute = 0.001 }}\n"))
        .unwrap();
    let strict = write("strict.toml", &strict);
    let out = path("report");
    case("error-10-tolerance-exceeded", &["gate", &strict, "--models", "A", "--out", &out]);
    // 11: the reference
    let store = folder.path().join("empty-store");
    let unsolved = write("unsolved.toml", &shipped.replacen("scaled-plate-r10", "unsolved", 1));
    let missing = seen(&["compare", &unsolved, "--out", &out], Some(&store));
    check("error-11-reference-missing", &missing, folder.path());
    // 12: a solver
    let mut command = Command::cargo_bin("impactcheck").unwrap();
    command.args(["reference", "scaled-plate-r10", "--fresh", "--store", &path("store")]);
    let output =
        command.current_dir(ROOT).env("IMPACTCHECK_PYTHON", "/nonexistent/python3").output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr).trim_end().to_owned();
    check(
        "error-12-no-python",
        &format!("{text}\n[exit status {}]", output.status.code().unwrap()),
        folder.path(),
    );
}

#[test]
fn a_new_scene_is_valid_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml").display().to_string();
    let first = seen(&["new", "mine", "--out", &file, "--quiet"], None);
    assert_eq!(first, "\n[exit status 0]");
    let run = seen(&["reduced", &file, "--model", "B"], None);
    assert!(run.starts_with("mine (model B, 16 modes)") && run.ends_with("[exit status 0]"), "{run}");
    let seat = folder.path().join("seat.toml").display().to_string();
    assert_eq!(
        seen(&["new", "seat", "--kind", "seal-seat", "--out", &seat, "--quiet"], None),
        "\n[exit status 0]"
    );
    assert!(fs::read_to_string(&seat).unwrap().contains("name        = \"seat\""));
}

#[test]
fn completions_and_manual_pages_know_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let completions = seen(&["completions", "bash"], None);
    assert_eq!(seen(&["man", "--out", &folder.path().display().to_string()], None), "\n[exit status 0]");
    for command in COMMANDS {
        assert!(
            completions.contains(&format!("impactcheck__subcmd__{command}"))
                || completions.contains(&format!("impactcheck,{command}")),
            "{command}"
        );
        assert!(
            command == "help" || folder.path().join(format!("impactcheck-{command}.1")).is_file(),
            "{command}"
        );
    }
    assert!(seen(&["man"], None).contains(".TH impactcheck"));
}

#[test]
fn colours_are_off_where_nobody_sees_them() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("report").display().to_string();
    let compare = |variables: &[(&str, &str)]| {
        let mut command = Command::cargo_bin("impactcheck").unwrap();
        command.args(["compare", "scaled-plate-r6.35", "--models", "B", "--out", &out]).current_dir(ROOT);
        command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE").envs(variables.iter().copied());
        String::from_utf8_lossy(&command.output().unwrap().stdout).into_owned()
    };
    assert!(!compare(&[]).contains('\u{1b}'));
    assert!(compare(&[("CLICOLOR_FORCE", "1")]).contains('\u{1b}'));
}
