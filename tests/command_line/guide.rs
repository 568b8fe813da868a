//! Every command of the guide runs. Blocks of `console` need no FEniCSx and no stored solution but the shipped ones; those
//! of `console live` (with FEniCSx) and `console slow` (minutes, with FEniCSx) run where `IMPACTCHECK_GUIDE` is `live` or `slow`, as `make test`
//! and `make evidence` do.

use std::fs;
use std::path::Path;
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The chapters, in the order of the book.
fn chapters() -> Vec<String> {
    let summary = fs::read_to_string(Path::new(ROOT).join("guide/src/SUMMARY.md")).unwrap();
    let links =
        summary.lines().filter_map(|line| Some(line.split_once("](")?.1.split_once(')')?.0.to_owned()));
    links.collect()
}

/// Blocks of `text` in the language `language`.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    text.split(&fence).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn every_chapter_is_in_the_summary() {
    let listed = chapters();
    for entry in fs::read_dir(Path::new(ROOT).join("guide/src")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(name == "SUMMARY.md" || listed.contains(&name), "{name}");
    }
}

/// A copy of the folder `from`.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let there = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &there);
        } else {
            fs::copy(entry.path(), there).unwrap();
        }
    }
}

/// A reader's folder is a checkout: what is there has the same places; the shipped solutions are in a store of its own.
fn folder() -> tempfile::TempDir {
    let (folder, project) = (tempfile::tempdir().unwrap(), Path::new(ROOT));
    for part in ["scenes/examples", "examples/external", "examples/import", "examples/uncertainty"] {
        copy(&project.join(part), &folder.path().join(part));
    }
    copy(&project.join("fem_reference/solutions"), &folder.path().join("store"));
    folder
}

#[test]
fn every_command_runs() {
    let chosen = std::env::var("IMPACTCHECK_GUIDE").ok();
    let language = chosen.as_ref().map_or("console".to_owned(), |kind| format!("console {kind}"));
    let folder = folder();
    // the python3 of `make setup` or of the system has SciPy
    let path = format!("{ROOT}/target/python-tools/bin:/usr/bin:{}", std::env::var("PATH").unwrap());
    let mut commands = 0;
    for chapter in chapters() {
        let text = fs::read_to_string(Path::new(ROOT).join("guide/src").join(&chapter)).unwrap();
        if let Some(sweep) = blocks(&text, "toml").into_iter().find(|block| block.contains("[[vary]]")) {
            fs::write(folder.path().join("my-sweep.toml"), sweep).unwrap();
        }
        let lines = |language| blocks(&text, language).into_iter().flat_map(str::lines);
        // other blocks need the scenes that these make
        let new = lines("console").filter(|line| chosen.is_some() && line.starts_with("$ impactcheck new "));
        for line in new.chain(lines(&language)) {
            let command = line.strip_prefix("$ impactcheck ").unwrap_or_else(|| panic!("{chapter}: {line}"));
            let mut run = Command::new(env!("CARGO_BIN_EXE_impactcheck"));
            run.args(command.split_whitespace()).current_dir(folder.path()).env("PATH", &path);
            run.env("IMPACTCHECK_STORE", folder.path().join("store")).env_remove("GITHUB_ACTIONS");
            if chosen.is_none() {
                run.env("IMPACTCHECK_PYTHON", "/no/such/python3");
            }
            let output = run.output().unwrap();
            // without FEniCSx the doctor says so by its status, and is right
            let status = output.status.code().unwrap();
            let ill = command == "doctor" && status == 12;
            assert!(status == 0 || ill, "{chapter}: {line}\n{}", String::from_utf8_lossy(&output.stderr));
            commands += usize::from(chosen.is_none() || !line.starts_with("$ impactcheck new "));
        }
    }
    assert!(commands >= if chosen.is_some() { 2 } else { 40 }, "{commands} commands found");
}
