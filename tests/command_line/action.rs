//! The GitHub Action's steps, with programs in the place of the built one and of `gh` that write down their arguments.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

/// The script of a step of `action.yml`.
fn script(step: &str) -> String {
    let text = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/action.yml")).unwrap();
    let (_, step) = text.split_once(&format!("- name: {step}\n")).unwrap();
    let (_, run) = step.split_once("      run: |\n").unwrap();
    let lines = run.lines().take_while(|line| line.is_empty() || line.starts_with("        "));
    lines.map(|line| line.trim_start().to_owned() + "\n").collect()
}

/// The arguments that a step gives to `program`, one a line, then its standard input.
fn received(step: &str, program: &str, folder: &Path, environment: &[(&str, &str)]) -> String {
    let file = folder.join(program);
    fs::write(&file, "#!/bin/sh\nprintf '%s\\n' \"$@\" > received\ncat >> received\n").unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).unwrap();
    let mut command = Command::new("bash");
    // as GitHub runs it
    command.args(["--noprofile", "--norc", "-eo", "pipefail", "-c", &script(step)]).current_dir(folder);
    command.env("PATH", format!("{}:{}", folder.display(), std::env::var("PATH").unwrap()));
    command.env("PROGRAM", &file).env("REPORT", "report").env("GITHUB_OUTPUT", "output");
    command.envs(environment.iter().copied()).stdin(std::process::Stdio::null());
    assert!(command.status().unwrap().success(), "{step}");
    fs::read_to_string(folder.join("received")).unwrap()
}

#[test]
fn scenes_may_be_a_line_each() {
    let folder = tempfile::tempdir().unwrap();
    let gate = |scenes: &str, arguments: &str, store: &str| {
        let environment = [("SCENES", scenes), ("ARGUMENTS", arguments), ("STORE", store)];
        received("Gate", "impactcheck", folder.path(), &environment).replace('\n', " ")
    };
    let out = "--out report --junit report/gate.xml ";
    assert_eq!(gate("a.toml b.toml", "", ""), format!("gate a.toml b.toml {out}"));
    assert_eq!(
        gate("a.toml\nb.toml\n", "--resolution coarse\n--undecided fail\n", "my references"),
        format!("--store my references gate a.toml b.toml --resolution coarse --undecided fail {out}")
    );
    assert_eq!(gate("", "", ""), format!("gate {out}"));
}

#[test]
fn the_comment_is_the_summary_with_a_link_to_the_report() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("report")).unwrap();
    fs::write(folder.path().join("report/comparison.md"), "# impactcheck: pass\n").unwrap();
    let environment =
        [("ARTIFACT", "https://host/artifact/7"), ("GITHUB_REPOSITORY", "me/mine"), ("PULL_REQUEST", "3")];
    let received = received("Comment", "gh", folder.path(), &environment);
    assert!(received.contains("--body-file\n-\n# impactcheck: pass\n"), "{received}");
    assert!(received.ends_with("(https://host/artifact/7)\n"), "{received}");
}
