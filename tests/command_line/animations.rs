//! `compare --figure impact.gif`: what it writes, what it says where fields are missing, what it refuses.

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use std::process::Output;

fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::cargo_bin("impactcheck").unwrap();
    command.args(arguments).current_dir(folder).env("IMPACTCHECK_HOME", env!("CARGO_MANIFEST_DIR"));
    let Output { status, stderr, .. } = command.env_remove("IMPACTCHECK_STORE").output().unwrap();
    (status.code(), String::from_utf8_lossy(&stderr).into_owned())
}

/// The store that comes with the project has no fields over time: forty frames of the reduced model, and a sentence.
#[test]
fn without_fields_the_model_moves_alone_and_the_command_that_makes_them_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let arguments =
        ["compare", "scaled-plate-r6.35", "--models", "A,B", "--figure", "impact.gif", "--out", "report"];
    let (status, told) = run(folder.path(), &arguments);
    assert_eq!(status, Some(0), "{told}");
    assert!(told.contains("`impactcheck reference scaled-plate-r6.35 --fields 40`"), "{told}");
    let bytes = fs::read(folder.path().join("impact.gif")).unwrap();
    assert!(bytes.len() < 2_000_000, "{}", bytes.len());
    assert_eq!(fs::read(folder.path().join("report/scaled-plate-r6.35-impact.gif")).unwrap(), bytes);
    let page = fs::read_to_string(folder.path().join("report/scaled-plate-r6.35.html")).unwrap();
    assert!(page.contains("src=\"scaled-plate-r6.35-impact.gif\" loading=\"lazy\""));
    let mut decoder = gif::DecodeOptions::new().read_info(&bytes[..]).unwrap();
    let (mut frames, mut changed) = (0, 0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        frames += 1;
        changed += usize::from(frame.buffer.iter().any(|index| Some(*index) != frame.transparent));
    }
    assert_eq!((frames, changed), (40, 40), "every frame moves something");
}

#[test]
fn what_does_not_move_is_refused_before_anything_is_computed() {
    let folder = tempfile::tempdir().unwrap();
    let seat = ["compare", "seal-seat-improved", "--figure", "impact.gif", "--out", "report"];
    let (status, told) = run(folder.path(), &seat);
    assert!(status == Some(2) && told.contains("no plate impact"), "{told}");
    let sweep = "scene = \"scaled-plate-r10\"\n[[vary]]\nfield = \"plate.radius\"\nvalues = [0.03, 0.04]\n";
    fs::write(folder.path().join("sweep.toml"), sweep).unwrap();
    let (status, told) = run(folder.path(), &["study", "sweep", "sweep.toml", "--figure", "sweep.gif"]);
    assert!(status == Some(2) && told.contains(".svg, .pdf or .png"), "{told}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is written");
}
