//! Bad input on the command line: a clear sentence, the right exit status, nothing half-written.

use assert_cmd::Command;
use std::fs;
use std::path::{Path, PathBuf};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

struct Ended {
    status: i32,
    out: String,
    error: String,
}

fn impactcheck(arguments: &[&str], environment: &[(&str, &str)]) -> Ended {
    let mut command = Command::cargo_bin("impactcheck").unwrap();
    command
        .args(arguments)
        .current_dir(ROOT)
        .env_remove("IMPACTCHECK_STORE")
        .env_remove("IMPACTCHECK_PYTHON");
    for (name, value) in environment {
        command.env(name, value);
    }
    let output = command.output().unwrap();
    Ended {
        status: output.status.code().expect("ended by itself"),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        error: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// A scene file with one line of the shipped scene replaced.
fn scene_with(folder: &Path, from: &str, to: &str) -> PathBuf {
    let text = fs::read_to_string(Path::new(ROOT).join("scenes/scaled-plate-r10.toml")).unwrap();
    assert!(text.contains(from), "the shipped scene has `{from}`");
    let file = folder.join("scene.toml");
    fs::write(&file, text.replacen(from, to, 1)).unwrap();
    file
}

/// Before anything is computed: a GIF was written by earlier versions.
#[test]
fn figures_in_formats_that_there_are_not_are_refused_with_those_that_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("sweep.toml");
    let text = "scene = \"scaled-plate-r10\"\n[[vary]]\nfield = \"plate.radius\"\nvalues = [0.03, 0.04]\n";
    fs::write(&plan, text).unwrap();
    let [figure, out] = ["impact.gif", "out"].map(|name| folder.path().join(name));
    let (figure, out) = (figure.to_str().unwrap(), out.to_str().unwrap());
    for command in [
        &["compare", "scaled-plate-r6.35", "--models", "A"][..],
        &["study", "sweep", plan.to_str().unwrap()],
        &["uncertainty", "examples/uncertainty/table1-r6.35.toml"],
    ] {
        let arguments = [command, &["--figure", figure, "--out", out]].concat();
        let ended = impactcheck(&arguments, &[]);
        let expected = format!("--figure {figure}: the name has to end in .svg, .pdf or .png");
        assert!(ended.status == 2 && ended.error.contains(&expected), "{arguments:?}: {}", ended.error);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is written");
    }
}

#[test]
fn invalid_scenes_end_with_3_and_name_field_and_line() {
    let cases = [
        ("radius    = \"33 mm\"", "radius = nan", "plate.radius"),
        ("radius    = \"33 mm\"", "radius = \"-33 mm\"", "plate.radius"),
        ("speed    = \"550 mm/s\"", "speed = \"550 mm\"", "outer.speed"),
        ("thickness = \"2 mm\"", "thickness = \"2 mm\"\nthicknes = 1", "thicknes"),
        ("material  = \"steel\"", "material = \"stel\"", "stel"),
        ("poisson_ratio  = 0.3", "poisson_ratio = 0.5", "poisson_ratio"),
    ];
    for (from, to, expected) in cases {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("report");
        let file = scene_with(folder.path(), from, to);
        for command in ["reduced", "reference", "compare", "gate"] {
            let mut arguments = vec![command, file.to_str().unwrap()];
            if matches!(command, "compare" | "gate") {
                arguments.extend(["--out", out.to_str().unwrap()]);
            }
            let ended = impactcheck(&arguments, &[]);
            assert_eq!(ended.status, 3, "{command} with {to}: {}", ended.error);
            assert!(ended.error.contains(expected), "{command} with {to}: {}", ended.error);
            assert!(ended.error.contains("scene.toml:"), "the place: {}", ended.error);
            assert!(ended.out.is_empty(), "{}", ended.out);
            assert!(!out.exists(), "nothing is written");
        }
    }
}

#[test]
fn files_that_are_no_scenes_end_with_3() {
    let folder = tempfile::tempdir().unwrap();
    let empty = folder.path().join("empty.toml");
    fs::write(&empty, "").unwrap();
    let binary = folder.path().join("binary.toml");
    fs::write(&binary, [0_u8, 159, 146, 150, 255]).unwrap();
    let large = folder.path().join("large.toml");
    fs::File::create(&large).unwrap().set_len(100_000_000).unwrap();
    for file in [&empty, &binary, &large] {
        let ended = impactcheck(&["reduced", file.to_str().unwrap()], &[]);
        assert_eq!(ended.status, 3, "{}: {}", file.display(), ended.error);
        assert!(ended.error.contains(file.file_name().unwrap().to_str().unwrap()), "{}", ended.error);
    }
}

#[test]
fn command_lines_that_make_no_sense_end_with_2() {
    for arguments in [
        &["reduced"][..],
        &["reduced", "no-such-scene"],
        &["reduced", "scaled-plate-r10", "--model", "D"],
        &["reduced", "scaled-plate-r10", "--model", "A", "--modes", "2"],
        &["reduced", "scaled-plate-r10", "--modes", "0"],
        &["reduced", "scaled-plate-r10", "--modes", "1000000"],
        &["reduced", "scaled-plate-r10", "--tolerance", "2"],
        &["reference", "scaled-plate-r10", "--resolution", "finest"],
        &["reference", "scaled-plate-r10", "--np", "2"],
        &["reference", "scaled-plate-r10", "--fields", "4294967295"],
        &["reference", "scaled-plate-r10", "--threads", "4294967295"],
        &["compare", "scaled-plate-r10", "scaled-plate-r10"],
        &["frobnicate"],
    ] {
        let ended = impactcheck(arguments, &[]);
        assert_eq!(ended.status, 2, "{arguments:?}: {}", ended.error);
        assert!(!ended.error.is_empty() && ended.out.is_empty(), "{arguments:?}");
    }
}

#[test]
fn output_folder_that_is_a_file_ends_with_2_and_one_that_cannot_be_written_with_1_before_anything_is_computed()
 {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "not a folder").unwrap();
    for (out, status) in [(file.clone(), 2), (file.join("report"), 2), (PathBuf::from("/proc/report"), 1)] {
        let ended = impactcheck(&["compare", "scaled-plate-r10", "--out", out.to_str().unwrap()], &[]);
        assert_eq!(ended.status, status, "{}", ended.error);
        assert!(ended.error.contains(out.to_str().unwrap()), "{}", ended.error);
    }
    assert_eq!(fs::read_to_string(&file).unwrap(), "not a folder");
}

#[test]
fn a_missing_reference_ends_with_11_and_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("store");
    let out = folder.path().join("report");
    let file = scene_with(folder.path(), "scaled-plate-r10", "another-plate");
    let arguments =
        ["gate", file.to_str().unwrap(), "--store", store.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let ended = impactcheck(&arguments, &[]);
    assert_eq!(ended.status, 11, "{}", ended.error);
    let command = format!("impactcheck --store {} reference {}", store.display(), file.display());
    assert!(ended.error.contains(&command), "{}", ended.error);
    assert!(!out.join("index.html").exists());
}

#[test]
fn changed_scene_makes_its_reference_stale() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("report");
    let file = scene_with(folder.path(), "550 mm/s", "600 mm/s");
    let ended = impactcheck(&["gate", file.to_str().unwrap(), "--out", out.to_str().unwrap()], &[]);
    assert_eq!(ended.status, 11, "{}", ended.error);
    assert!(ended.error.contains("stale") && ended.error.contains("speed"), "{}", ended.error);
    assert!(!out.join("index.html").exists());
}

#[test]
fn without_a_usable_python_a_reference_ends_with_12_and_names_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let bare = folder.path().join("python3");
    fs::write(&bare, "#!/bin/sh\nexit 1\n").unwrap();
    fs::set_permissions(&bare, std::os::unix::fs::PermissionsExt::from_mode(0o755)).unwrap();
    let store = folder.path().join("store");
    for python in ["/no/such/python3", bare.to_str().unwrap()] {
        let arguments = ["reference", "scaled-plate-r10", "--store", store.to_str().unwrap()];
        let ended = impactcheck(&arguments, &[("IMPACTCHECK_PYTHON", python)]);
        assert_eq!(ended.status, 12, "{}", ended.error);
        assert!(ended.error.contains(python), "{}", ended.error);
        assert!(!store.join("scaled-plate-r10").exists());
    }
}

#[test]
fn json_is_the_only_thing_on_standard_output() {
    // that of the doctor is read in `elsewhere.rs`
    for arguments in [&["reduced", "scaled-plate-r10", "--json"][..], &["schema"]] {
        let ended = impactcheck(arguments, &[]);
        assert_eq!(ended.status, 0, "{arguments:?}: {}", ended.error);
        serde_json::from_str::<serde_json::Value>(&ended.out).unwrap();
    }
}

/// `impactcheck ... 2>&1 | head -1`: what is said for people goes nowhere, the status stays.
#[test]
fn a_reader_of_standard_error_that_has_gone_away_changes_no_status() {
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().join("report");
    for (arguments, status) in [
        (&["compare", "scaled-plate-r10", "--models", "A", "--out", report.to_str().unwrap()][..], 0),
        (&["reduced", "no-such-scene"], 2),
        (&["reduced"], 2),
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_impactcheck"));
        let ended = program.args(arguments).current_dir(ROOT).stderr(writer).output().unwrap();
        assert_eq!(ended.status.code(), Some(status), "{arguments:?}");
    }
}
