//! Every command of the guide runs and prints what the guide shows. Blocks of `console` need no FEniCSx and no stored solution but the shipped ones; those
//! of `console live` (with FEniCSx) and `console slow` (minutes, with FEniCSx) run where `IMPACTCHECK_GUIDE` is `live` or `slow`, as `make test`
//! and `make evidence` do.

use regex::Regex;
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
    let pages = |folder: &Path| {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        entries.collect::<Vec<_>>()
    };
    let root = Path::new(ROOT).join("guide/src");
    let deep = pages(&root).into_iter().filter(|path| path.is_dir()).flat_map(|folder| pages(&folder));
    for path in
        pages(&root).into_iter().chain(deep).filter(|path| path.extension().is_some_and(|e| e == "md"))
    {
        let name = path.strip_prefix(&root).unwrap().to_str().unwrap().to_owned();
        assert!(name == "SUMMARY.md" || listed.contains(&name), "{name}");
    }
}

/// A page in parts: commands of the blocks in one language, and the lines around them.
enum Part<'a> {
    Line(&'a str),
    /// The line of a command, and what the page shows of its output.
    Command(&'a str, Vec<&'a str>),
}

fn parts<'a>(text: &'a str, language: &str) -> Vec<Part<'a>> {
    let fence = format!("```{language}");
    let (mut parts, mut inside) = (Vec::new(), false);
    for line in text.lines() {
        if line.starts_with("```") {
            inside = !inside && line == fence;
            parts.push(Part::Line(line));
        } else if inside && line.starts_with("$ ") {
            parts.push(Part::Command(line, Vec::new()));
        } else if let (true, Some(Part::Command(_, shown))) = (inside, parts.last_mut()) {
            shown.push(line);
        } else {
            parts.push(Part::Line(line));
        }
    }
    parts
}

/// Lines of an output that a page shows at most; of more the first ones and `MORE`.
const SHOWN: usize = 34;
const MORE: &str = "[...]";

/// What a page shows of an output in the `folder` of a reader.
fn shown(output: &std::process::Output, folder: &Path) -> Vec<String> {
    let text = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    let text = text.concat().replace(&format!("{}/", folder.display()), "").replace(&format!("{ROOT}/"), "");
    // a busy machine is slow enough for a word on it
    let lines = text.trim_end().lines().filter(|line| !line.contains(": still at work; "));
    let lines: Vec<String> = lines.map(|line| line.trim_end().to_owned()).collect();
    if lines.len() <= SHOWN {
        return lines;
    }
    lines.into_iter().take(SHOWN - 4).chain([MORE.to_owned()]).collect()
}

/// Relative difference of numbers on another machine, whose last bits differ.
const NUMBERS: f64 = 0.01;

/// Whether two lines of output are the same but for run times, rounding errors, times of day and the last digits of numbers.
fn is_same(found: &str, expected: &str) -> bool {
    let clock = Regex::new(r"\bin [0-9.]+ (s|ms|µs)\b|[0-9.]+ per second|\d\d:\d\d(:\d\d)?|\d{4}-\d\d-\d\d")
        .expect("expression");
    if found.contains("residual") {
        return found.split_whitespace().next() == expected.split_whitespace().next();
    }
    let number = Regex::new(r"[−-]?\d+(\.\d+)?(e[−-]?\d+)?").expect("expression");
    let lines = [found, expected].map(|line| clock.replace_all(line, "TIME").into_owned());
    let [words, other] =
        [0, 1].map(|k| number.replace_all(&lines[k], "N").split_whitespace().collect::<Vec<_>>().join(" "));
    let [numbers, others] = [0, 1].map(|k| {
        let found = number.find_iter(&lines[k]).map(|found| found.as_str().replace('−', "-"));
        found.map(|text| text.parse::<f64>().expect("a number")).collect::<Vec<_>>()
    });
    // what is near zero may be anything
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= (NUMBERS * b.abs()).max(0.011);
    words == other && numbers.iter().zip(&others).all(near)
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
    for part in
        ["scenes/examples", "examples/external", "examples/import", "examples/uncertainty", "examples/bodies"]
    {
        copy(&project.join(part), &folder.path().join(part));
    }
    copy(&project.join("fem_reference/solutions"), &folder.path().join("store"));
    folder
}

#[test]
fn every_command_runs_and_prints_what_the_guide_shows() {
    let chosen = std::env::var("IMPACTCHECK_GUIDE").ok();
    let writes = chosen.as_deref() == Some("write");
    let chosen = chosen.filter(|_| !writes);
    let language = chosen.as_ref().map_or("console".to_owned(), |kind| format!("console {kind}"));
    let folder = folder();
    // the python3 of `make setup` or of the system has SciPy
    let path = format!("{ROOT}/target/python-tools/bin:/usr/bin:{}", std::env::var("PATH").unwrap());
    let (mut commands, mut wrong) = (0, Vec::new());
    for chapter in chapters() {
        let file = Path::new(ROOT).join("guide/src").join(&chapter);
        let text = fs::read_to_string(&file).unwrap();
        if let Some(sweep) = blocks(&text, "toml").into_iter().find(|block| block.contains("[[vary]]")) {
            fs::write(folder.path().join("my-sweep.toml"), sweep).unwrap();
        }
        let run = |line: &str| {
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
            output
        };
        if chosen.is_some() {
            // other blocks need the scenes that these make
            for part in parts(&text, "console") {
                if let Part::Command(line, _) = part
                    && line.starts_with("$ impactcheck new ")
                {
                    run(line);
                }
            }
        }
        let mut written = Vec::new();
        for part in parts(&text, &language) {
            let Part::Command(line, expected) = part else {
                if let Part::Line(line) = part {
                    written.push(line.to_owned())
                }
                continue;
            };
            let output = run(line);
            commands += 1;
            written.push(line.to_owned());
            // what is installed differs from machine to machine, and so may meshes
            let is_slow = chosen.as_deref() == Some("slow") && !expected.is_empty();
            if chosen.is_some() && !is_slow || line == "$ impactcheck doctor" {
                written.extend(expected.into_iter().map(str::to_owned));
                continue;
            }
            let found = shown(&output, folder.path());
            let same = found.len() == expected.len()
                && found.iter().zip(&expected).all(|(found, expected)| is_same(found, expected));
            if !same {
                wrong.push(format!("{chapter}: {line}\n{}", found.join("\n")));
            }
            written.extend(if same { expected.into_iter().map(str::to_owned).collect() } else { found });
        }
        if writes {
            fs::write(&file, written.join("\n") + "\n").unwrap();
        }
    }
    assert!(commands >= if chosen.is_some() { 2 } else { 40 }, "{commands} commands found");
    assert!(
        writes || wrong.is_empty(),
        "the guide shows another output (IMPACTCHECK_GUIDE=write writes this one):\n{}",
        wrong.join("\n\n")
    );
}

/// Tables that the guide copies from the reports are theirs: between `<!-- from FILE -->` and `<!-- end -->`.
#[test]
fn copied_tables_are_those_of_the_reports() {
    let mut copies = 0;
    for chapter in chapters() {
        let text = fs::read_to_string(Path::new(ROOT).join("guide/src").join(&chapter)).unwrap();
        for part in text.split("<!-- from ").skip(1) {
            let (file, rest) = part.split_once(" -->").expect("a file");
            let (copied, _) = rest.split_once("<!-- end -->").expect("an end");
            let report = fs::read_to_string(Path::new(ROOT).join(file)).unwrap();
            assert!(report.contains(copied.trim()), "{chapter}: the table of {file} has changed");
            copies += 1;
        }
    }
    assert!(copies > 0);
}
