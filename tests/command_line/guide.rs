//! Every command of the guide runs: blocks of `console`; those of `console live` need FEniCSx and run where
//! `IMPACTCHECK_LIVE` is set, as `make test` does.

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

#[test]
fn every_command_runs() {
    let live = std::env::var_os("IMPACTCHECK_LIVE").is_some();
    let folder = tempfile::tempdir().unwrap();
    for scene in fs::read_dir(Path::new(ROOT).join("scenes/examples")).unwrap() {
        let scene = scene.unwrap();
        fs::copy(scene.path(), folder.path().join(scene.file_name())).unwrap();
    }
    for part in ["external", "import", "uncertainty"] {
        let there = folder.path().join("examples").join(part);
        fs::create_dir_all(&there).unwrap();
        for file in fs::read_dir(Path::new(ROOT).join("examples").join(part)).unwrap() {
            let file = file.unwrap();
            fs::copy(file.path(), there.join(file.file_name())).unwrap();
        }
    }
    // the python3 of `make setup` or of the system has SciPy
    let path = format!("{ROOT}/target/python-tools/bin:/usr/bin:{}", std::env::var("PATH").unwrap());
    let mut commands = 0;
    for chapter in chapters() {
        let text = fs::read_to_string(Path::new(ROOT).join("guide/src").join(&chapter)).unwrap();
        if let Some(sweep) = blocks(&text, "toml").into_iter().find(|block| block.contains("[[vary]]")) {
            fs::write(folder.path().join("my-sweep.toml"), sweep).unwrap();
        }
        let mut consoles = blocks(&text, "console");
        if live {
            consoles.extend(blocks(&text, "console live"));
        }
        for line in consoles.iter().flat_map(|block| block.lines()) {
            let command = line.strip_prefix("$ impactcheck ").unwrap_or_else(|| panic!("{chapter}: {line}"));
            let mut run = Command::new(env!("CARGO_BIN_EXE_impactcheck"));
            run.args(command.split_whitespace()).current_dir(folder.path()).env("PATH", &path);
            // what a live command solves stays out of the project's own store
            run.env("IMPACTCHECK_STORE", folder.path().join("store")).env_remove("GITHUB_ACTIONS");
            let output = run.output().unwrap();
            // without FEniCSx the doctor says so by its status, and is right
            let status = output.status.code().unwrap();
            let ill = command == "doctor" && status == 12;
            assert!(status == 0 || ill, "{chapter}: {line}\n{}", String::from_utf8_lossy(&output.stderr));
            commands += 1;
        }
    }
    assert!(commands > 20, "{commands} commands found");
}
