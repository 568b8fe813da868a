//! `compare --watch`: reacts to a change, survives a broken file, ends with the status of the last comparison.

use crate::store_fixture::SCENE;
use crate::waiting::wait_until;
use assert_cmd::cargo::cargo_bin;
use rustix::process::{Pid, Signal, kill_process};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// A comparison that is watched, its standard output and error in files.
struct Watched<'a> {
    here: &'a Path,
    program: Child,
}

impl<'a> Watched<'a> {
    fn start(here: &'a Path, scene: &str) -> Self {
        fs::write(here.join("mine.toml"), scene).expect("scene");
        let file = |name| Stdio::from(fs::File::create(here.join(name)).expect("file"));
        let program = Command::new(cargo_bin("impactcheck"))
            .args(["compare", "mine.toml", "--models", "B", "--watch", "--out", "report"])
            .current_dir(here)
            .env("IMPACTCHECK_HOME", env!("CARGO_MANIFEST_DIR"))
            .env_remove("IMPACTCHECK_STORE")
            .stdout(file("out"))
            .stderr(file("error"))
            .spawn()
            .expect("runs");
        Watched { here, program }
    }

    /// What it has said so far.
    fn said(&self) -> String {
        ["out", "error"].map(|name| fs::read_to_string(self.here.join(name)).expect("text")).concat()
    }

    /// Until `words` are said for the `count`th time.
    #[track_caller]
    fn waits_for(&self, words: &str, count: usize) {
        wait_until(
            || self.said().matches(words).count() >= count,
            || format!("not {count} times `{words}` in: {}", self.said()),
        );
    }

    fn writes(&self, scene: &str) {
        fs::write(self.here.join("mine.toml"), scene).expect("scene");
    }

    /// Exit status after Ctrl-C.
    fn interrupted(mut self) -> Option<i32> {
        kill_process(Pid::from_child(&self.program), Signal::INT).expect("runs");
        self.program.wait().expect("ends").code()
    }
}

impl Drop for Watched<'_> {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

#[test]
fn a_change_is_compared_again_and_a_broken_file_is_waited_for() {
    let folder = tempfile::tempdir().expect("folder");
    let watched = Watched::start(folder.path(), SCENE);
    watched.waits_for("watching mine.toml", 1);
    assert!(!watched.said().contains('\u{1b}'), "no codes where no terminal is: {}", watched.said());
    // three looks at an unchanged file
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert_eq!(watched.said().matches("1 scene compared").count(), 1, "nothing has changed");
    watched.writes(&SCENE.replacen("\"33 mm\"", "\"33 mn\"", 1));
    watched.waits_for("33 mn", 1);
    let (scene, _) = SCENE.split_once("[tolerances").expect("has some");
    let strict = format!("{scene}[tolerances.B]\nefficiency = {{ absolute = 1e-6 }}\n");
    watched.writes(&strict);
    watched.waits_for("1 scene compared", 2);
    watched.waits_for("scaled-plate-r10: fail", 1);
    watched.waits_for("watching mine.toml", 3);
    assert_eq!(watched.interrupted(), Some(0), "of the last comparison, which was done");
    let report = fs::read_dir(folder.path().join("report")).expect("report").flatten();
    assert!(report.map(|e| e.file_name()).all(|name| !name.to_string_lossy().starts_with('.')));
}

#[test]
fn a_scene_without_reference_has_its_models_run_alone_and_ends_with_that_status() {
    let folder = tempfile::tempdir().expect("folder");
    let watched = Watched::start(folder.path(), SCENE);
    watched.waits_for("watching mine.toml", 1);
    watched.writes(&SCENE.replacen("\"33 mm\"", "\"30 mm\"", 1));
    watched.waits_for("reduced models without a reference", 1);
    watched.waits_for("the paper reference of `scaled-plate-r10` is", 1);
    watched.waits_for("watching mine.toml", 2);
    assert_eq!(watched.interrupted(), Some(11));
}

#[test]
fn what_no_file_can_mend_ends_at_once() {
    let folder = tempfile::tempdir().expect("folder");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(cargo_bin("impactcheck"));
        let output =
            command.arg("compare").args(arguments).current_dir(folder.path()).output().expect("ends");
        output.status.code()
    };
    assert_eq!(run(&["none.toml", "--watch"]), Some(2));
    assert_eq!(run(&["scaled-plate-r10", "--watch", "--figure", "figure.doc"]), Some(2));
    assert_eq!(run(&["scaled-plate-r10", "--watch", "--json"]), Some(2));
}
