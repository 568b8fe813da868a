//! Writing the report: complete or not at all, the same for the same results.

use crate::synthetic_impact::{self, reduced, reference, scene};
use impactcheck::Error;
use impactcheck::ExitStatus;
use impactcheck::comparison::{GateRules, compare_scene};
use impactcheck::report::{Attachments, Report, SceneReport, check_writable, write};
use impactcheck::result::Outcome;
use impactcheck::scene::Scene;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

fn report<'a>(scene: &'a Scene, reference: &'a Outcome, reduced: &'a [Outcome]) -> Report<'a> {
    let comparison = compare_scene(scene, reference, reduced);
    let command = "impactcheck compare synthetic".into();
    let provenance = serde_json::Value::Null;
    let attachments = Attachments::default();
    Report {
        scenes: vec![SceneReport { scene, comparison, reference, reduced, provenance, command, attachments }],
        rules: GateRules::default(),
    }
}

fn contents(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let entry = |e: fs::DirEntry| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap());
    fs::read_dir(dir).unwrap().map(|e| entry(e.unwrap())).collect()
}

#[test]
fn writes_every_file_and_leaves_nothing_else() {
    let (scene, reference, reduced) = (scene(), reference(), [reduced()]);
    let report = report(&scene, &reference, &reduced);
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("new/reports");
    check_writable(&dir).unwrap();
    assert!(!root.path().join("new").exists());
    let written = write(&report, &dir).unwrap();
    let first = contents(&dir);
    assert_eq!(written, first.keys().map(|name| dir.join(name)).collect::<Vec<_>>());
    assert!(first.values().all(|bytes| !bytes.is_empty()));
    // every file that a page links or shows is there
    let mut linked = BTreeSet::new();
    for page in ["index.html", "synthetic.html"] {
        let text = std::str::from_utf8(&first[page]).unwrap();
        let targets = ["href=\"", "src=\""].map(|key| text.split(key).skip(1));
        let targets = targets.into_iter().flatten().map(|rest| rest.split(['"', '#']).next().unwrap());
        linked.extend(targets.filter(|to| !to.is_empty() && !to.contains(':')).map(str::to_owned));
    }
    assert!(linked.contains("synthetic.html") && linked.contains("synthetic.csv"), "{linked:?}");
    assert!(linked.iter().all(|name| first.contains_key(name)), "{linked:?}");
    // Again, over the old files: the same bytes.
    write(&report, &dir).unwrap();
    assert_eq!(contents(&dir), first);
}

/// A run that took another time leaves the files alone; another result writes them all, with its times.
#[test]
fn equal_results_leave_the_files_as_they_are() {
    let (scene, reference, first) = (scene(), reference(), [reduced()]);
    let root = tempfile::tempdir().unwrap();
    write(&report(&scene, &reference, &first), root.path()).unwrap();
    let before = contents(root.path());
    let mut slower = first.clone();
    slower[0].summary.solve_seconds *= 3.0;
    fs::remove_file(root.path().join("synthetic.csv")).unwrap();
    let written = write(&report(&scene, &reference, &slower), root.path()).unwrap();
    assert_eq!(written.len(), before.len());
    assert_eq!(contents(root.path()), before, "what is missing comes back, the rest stays");
    synthetic_impact::alter(&mut slower[0].summary, "efficiency", |e| e * (1.0 + 1e-12));
    write(&report(&scene, &reference, &slower), root.path()).unwrap();
    let after = contents(root.path());
    for name in ["comparison.json", "synthetic.html"] {
        let text = String::from_utf8(after[name].clone()).unwrap();
        assert!(
            text.contains(&format!("\"solve_seconds\": {:?}", slower[0].summary.solve_seconds))
                || text.contains(&format!("\"solve_seconds\":{:?}", slower[0].summary.solve_seconds)),
            "{name}"
        );
    }
}

/// A run on one scene neither forgets nor claims the others.
#[test]
fn scenes_of_earlier_runs_stay_in_index_and_document_with_their_date() {
    let root = tempfile::tempdir().unwrap();
    let read = |name: &str| fs::read_to_string(root.path().join(name)).unwrap();
    let write_one = |name: &str, compared: &str, force: f64| {
        let (scene, reference) = (Scene { name: name.into(), ..scene() }, reference());
        let mut reduced = [reduced()];
        synthetic_impact::alter(&mut reduced[0].summary, "first_frequency", |f| f * force);
        let mut report = report(&scene, &reference, &reduced);
        report.scenes[0].attachments.compared = Some(compared.into());
        report.scenes[0].attachments.folder = format!("scenes/{name}-folder");
        write(&report, root.path()).unwrap();
    };
    let names = || -> Vec<String> {
        let document: serde_json::Value = serde_json::from_str(&read("comparison.json")).unwrap();
        let scenes = document["scenes"].as_array().unwrap();
        scenes.iter().map(|scene| scene["scene"].as_str().unwrap().to_owned()).collect()
    };
    write_one("first", "on Monday", 1.0);
    let entry = |name: &str| {
        let document: serde_json::Value = serde_json::from_str(&read("comparison.json")).unwrap();
        document["scenes"].as_array().unwrap().iter().find(|s| s["scene"] == name).cloned().unwrap()
    };
    let first = entry("first");
    write_one("second", "on Tuesday", 1.0);
    assert_eq!(names(), ["first", "second"]);
    assert_eq!(entry("first"), first, "what was not compared again is what it was");
    let index = read("index.html");
    assert!(index.contains("href=\"first.html\"") && index.contains("href=\"second.html\""));
    let (links, rows) = index.split_once("<table").unwrap();
    assert!(
        links.contains("<a href=\"#folder-1\">scenes/second-folder</a> (1) ")
            && rows.contains("id=\"folder-1\"")
    );
    let folders: Vec<usize> = ["scenes/first-folder<", "first.html", "scenes/second-folder<", "second.html"]
        .map(|f| rows.find(f).unwrap())
        .into();
    assert!(folders.is_sorted(), "every scene below its folder");
    assert!(index.contains("on Monday, kept from an earlier run"));
    assert!(index.contains(">on Tuesday<"));
    assert!(read("comparison.md").contains("[its page](first.html)"));

    // compared again it keeps its place, and nothing is said to be kept any more but the other
    write_one("first", "on Wednesday", 1.01);
    assert_eq!(names(), ["first", "second"]);
    assert_ne!(entry("first"), first);
    let index = read("index.html");
    assert!(index.contains(">on Wednesday<") && index.contains("on Tuesday, kept from an earlier run"));

    // a page that is taken away is not missed, a document that is none keeps nothing
    fs::remove_file(root.path().join("first.html")).unwrap();
    write_one("second", "on Thursday", 1.02);
    assert_eq!(names(), ["second"]);
    fs::write(root.path().join("comparison.json"), "{").unwrap();
    write_one("third", "on Friday", 1.0);
    assert_eq!(names(), ["third"]);
}

/// The error names the folder; what was there stays as it was.
#[test]
fn impossible_folders_are_errors_that_name_them() {
    let (scene, reference, reduced) = (scene(), reference(), [reduced()]);
    let report = report(&scene, &reference, &reduced);
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("file");
    fs::write(&file, "kept").unwrap();
    for dir in [file.clone(), file.join("below"), Path::new("/proc/impactcheck").into()] {
        // what the user named wrongly is his to change; where the system refuses, it is not
        let status = if dir.starts_with(root.path()) { ExitStatus::Usage } else { ExitStatus::Internal };
        for error in [check_writable(&dir).unwrap_err(), write(&report, &dir).unwrap_err()] {
            assert_eq!(error.exit_status(), status, "{error}");
            assert!(error.to_string().contains(dir.to_str().unwrap()), "{error}");
        }
    }
    assert_eq!(fs::read_to_string(&file).unwrap(), "kept");
    assert_eq!(contents(root.path()).len(), 1);
}

/// A folder in the place of a file is found before any file is replaced.
#[test]
fn nothing_is_replaced_if_one_file_cannot_be() {
    let (scene, reference, reduced) = (scene(), reference(), [reduced()]);
    let report = report(&scene, &reference, &reduced);
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("index.html"), "old").unwrap();
    fs::create_dir(root.path().join("synthetic.svg")).unwrap();
    let error = write(&report, root.path()).unwrap_err();
    assert!(error.to_string().contains("synthetic.svg"), "{error}");
    assert_eq!(fs::read_to_string(root.path().join("index.html")).unwrap(), "old");
    assert_eq!(fs::read_dir(root.path()).unwrap().count(), 2);
}

#[test]
fn names_that_leave_the_folder_are_refused() {
    let (reference, reduced) = (reference(), [reduced()]);
    for name in ["../outside", "a/b", "", "..", "index"] {
        let scene = Scene { name: name.into(), ..scene() };
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("reports");
        let error = write(&report(&scene, &reference, &reduced), &dir).unwrap_err();
        assert!(matches!(error, Error::Usage(_)), "{name}: {error}");
        assert!(!dir.exists());
    }
}
