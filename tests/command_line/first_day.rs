//! What a first day of use tries: file endings, lists of files, names, standard input.

use crate::store_fixture::SCENE;
use assert_cmd::Command;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use std::fs;
use std::path::Path;
use std::process::Output;

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("impactcheck").unwrap();
    command.args(arguments).current_dir(folder).env("IMPACTCHECK_HOME", env!("CARGO_MANIFEST_DIR"));
    command.env_remove("IMPACTCHECK_STORE").env_remove("IMPACTCHECK_PYTHON");
    command
}

/// Runs the program in `folder`; it has to end with `status`.
#[track_caller]
fn run(folder: &Path, arguments: &[&str], status: i32) -> Output {
    let output = command(folder, arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {said}");
    output
}

#[track_caller]
fn says(folder: &Path, arguments: &[&str], status: i32, words: &[&str]) {
    let said = String::from_utf8(run(folder, arguments, status).stderr).unwrap();
    for word in words {
        assert!(said.contains(word), "`{word}` is not in: {said}");
    }
}

#[test]
fn a_history_has_the_format_its_ending_names() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    for name in ["h.csv", "h.parquet"] {
        run(folder.path(), &["reduced", "scaled-plate-r10", "--model", "A", "--history", name], 0);
    }
    let text = fs::read_to_string(file("h.csv")).unwrap();
    let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let reader = SerializedFileReader::new(fs::File::open(file("h.parquet")).unwrap()).unwrap();
    let schema = reader.metadata().file_metadata().schema();
    assert_eq!(schema.get_fields().iter().map(|f| f.name()).collect::<Vec<_>>(), header);
    let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(|row| row.unwrap()).collect();
    assert_eq!(rows.len(), text.lines().count() - 1);
    let line = text.lines().nth(rows.len() / 2).unwrap();
    for (k, number) in line.split(',').enumerate() {
        assert_eq!(
            rows[rows.len() / 2 - 1].get_double(k).unwrap(),
            number.parse::<f64>().unwrap(),
            "{}",
            header[k]
        );
    }
    let units = reader.metadata().file_metadata().key_value_metadata().unwrap();
    assert!(units.iter().any(|u| u.key == "unit:outer_force" && u.value.as_deref() == Some("N")));
    says(
        folder.path(),
        &["reduced", "scaled-plate-r10", "--history", "h.xlsx"],
        2,
        &["--history h.xlsx: the name has to end in .csv or .parquet"],
    );
    assert!(!file("h.xlsx").exists());
}

/// What a scene without a reference can show: the numbers of the summary, the curves, and where the sphere lands.
#[test]
fn a_reduced_model_alone_has_a_page() {
    let folder = tempfile::tempdir().unwrap();
    // without vibration, whose chart takes ten seconds
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/examples/rocker-flight.toml");
    let shipped = fs::read_to_string(shipped).unwrap();
    let (flight, _) = shipped.split_once("[vibration]").unwrap();
    fs::write(folder.path().join("rocker.toml"), flight).unwrap();
    let arguments = ["reduced", "rocker.toml", "--model", "B", "--page", "page.html", "--json"];
    let json = run(folder.path(), &arguments, 0).stdout;
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&json).unwrap();
    let efficiency = summary["efficiency"].as_f64().unwrap();
    const PANELS: [&str; 2] = ["Velocity in mm/s", "Contact force in N"];
    let own = ["rocker-flight: model B", "Landing", "Path of the sphere", &format!("{efficiency:.5}")];
    for stated in own.into_iter().chain(PANELS) {
        assert!(page.contains(stated), "no {stated}");
    }
    run(folder.path(), &["reduced", "scaled-plate-r10", "--model", "B", "--page", "plate.html"], 0);
    let plate = fs::read_to_string(folder.path().join("plate.html")).unwrap();
    assert!(!plate.contains("Landing") && PANELS.iter().all(|panel| plate.contains(panel)));
    says(folder.path(), &["reduced", "scaled-plate-r10", "--page", "p.svg"], 2, &["p.svg", ".html"]);
    assert!(!folder.path().join("p.svg").exists());
}

#[test]
fn missing_results_over_commits_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    let arguments =
        ["compare", "scaled-plate-r6.35", "--models", "A", "--trends", "none.jsonl", "--out", "report"];
    says(folder.path(), &arguments, 2, &["--trends", "none.jsonl"]);
    assert!(!folder.path().join("report").exists());
}

#[test]
fn measured_files_may_be_listed_with_spaces_as_a_shell_does() {
    let folder = tempfile::tempdir().unwrap();
    let record: String = (0..40).map(|k| format!("{k},-550\n")).collect();
    fs::write(folder.path().join("a.csv"), format!("time [us],outer_velocity [mm/s]\n{record}")).unwrap();
    for command in ["compare", "gate"] {
        let arguments = [command, "scaled-plate-r6.35", "--measured", "a.csv", "b.csv", "--out", "report"];
        says(folder.path(), &arguments, 2, &["there is no measured file b.csv"]);
    }
}

#[test]
fn numbers_beyond_all_measure_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (from, to, word) in [
        ("\"2 mm\"", "\"1e300 mm\"", "plate.thickness"),
        ("\"2 mm\"", "\"100 m\"", "plate.thickness"),
        ("\"2 mm\"", "\"1e-300 mm\"", "plate.thickness"),
        ("\"550 mm/s\"", "\"1e200 mm/s\"", "outer.speed"),
        ("\"7780 kg/m^3\"", "1e-200", "materials.steel.density"),
        ("\"210 GPa\"", "\"1e200 GPa\"", "materials.steel.youngs_modulus"),
    ] {
        assert!(SCENE.contains(from), "{from}");
        fs::write(folder.path().join("scene.toml"), SCENE.replacen(from, to, 1)).unwrap();
        says(folder.path(), &["reduced", "scene.toml"], 3, &[word, "scene.toml:"]);
    }
}

#[test]
fn a_new_scene_may_be_named_by_its_file() {
    let folder = tempfile::tempdir().unwrap();
    for (name, file, scene) in [
        ("foo.toml", "foo.toml", "foo"),
        ("r6.35", "r6.35.toml", "r6.35"),
        ("sub/bar", "sub/bar.toml", "bar"),
    ] {
        run(folder.path(), &["new", name], 0);
        let text = fs::read_to_string(folder.path().join(file)).unwrap();
        assert!(text.contains(&format!("= \"{scene}\"")), "{text}");
        run(folder.path(), &["reduced", file, "--model", "A"], 0);
    }
}

#[test]
fn a_new_scene_names_the_schema_in_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    for (name, kind) in [("sub/plate", "plate-impact"), ("sub/seat", "seal-seat"), ("sub/wall", "impact")] {
        run(folder.path(), &["new", name, "--kind", kind], 0);
        let text = fs::read_to_string(folder.path().join(format!("{name}.toml"))).unwrap();
        let schema = text.lines().next().unwrap().strip_prefix("#:schema ").expect("at the head");
        let schema = fs::read(folder.path().join("sub").join(schema)).expect("where the line says");
        let schema: serde_json::Value = serde_json::from_slice(&schema).unwrap();
        let printed: serde_json::Value =
            serde_json::from_slice(&run(folder.path(), &["schema"], 0).stdout).unwrap();
        assert_eq!(schema, printed);
    }
    // a name that can't be one leaves nothing behind
    run(folder.path(), &["new", "other/what ever"], 3);
    assert!(!folder.path().join("other").exists());
}

#[test]
fn a_scene_may_come_from_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    let reduced = |text: &str| {
        command(folder.path(), &["reduced", "-", "--model", "A", "--json"])
            .write_stdin(text)
            .output()
            .unwrap()
    };
    let output = reduced(SCENE);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["scene"], "scaled-plate-r10");
    let output = reduced(&SCENE.replacen("\"33 mm\"", "\"-33 mm\"", 1));
    assert_eq!(output.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&output.stderr).contains("standard input:"));
    assert_eq!(reduced("").status.code(), Some(3));
}

#[test]
#[cfg(unix)]
fn a_mesh_is_called_after_its_scene() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let python = folder.path().join("python");
    let script =
        "#!/bin/sh\n[ $3 = versions ] && { echo '{\"python\": \"3\"}'; exit; }\necho \"$@\" > \"$SEEN\"\n";
    fs::write(&python, script).unwrap();
    fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).unwrap();
    let seen = folder.path().join("seen");
    let mut command = command(folder.path(), &["mesh", "seal-seat-initial"]);
    command.env("IMPACTCHECK_PYTHON", &python).env("SEEN", &seen).output().unwrap();
    let out = folder.path().canonicalize().unwrap().join("seal-seat-initial.vtu");
    let arguments = fs::read_to_string(seen).unwrap();
    assert!(arguments.contains(&format!("--out {}", out.display())), "{arguments}");
}

#[test]
fn a_pure_number_has_no_unit() {
    let folder = tempfile::tempdir().unwrap();
    let scene = SCENE.replacen("= 0.3\n", "= \"0.3 mm\"\n", 1);
    assert_ne!(scene, SCENE);
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    says(folder.path(), &["reduced", "scene.toml"], 3, &["`mm`", "none is needed"]);
    let over = ["optimise", "scaled-plate-r10", "--over", "plate.damping_ratio=0..3mm"];
    says(folder.path(), &over, 2, &["`mm` is not the unit of a pure number;"]);
    let schema = String::from_utf8(run(folder.path(), &["schema"], 0).stdout).unwrap();
    assert!(schema.contains("\"in m, ") && !schema.contains("\"in 1, "));
}

#[test]
fn a_model_that_has_no_form_for_a_scene_is_omitted_from_its_comparison() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/validation/off-centre.toml");
    let scene = scene.to_str().unwrap();
    says(
        folder.path(),
        &["compare", scene, "--out", "report"],
        0,
        &["makes a mesh of the plate", "request it alone"],
    );
    let document = fs::read_to_string(folder.path().join("report/comparison.json")).unwrap();
    assert!(document.contains(r#""model": "B""#) && !document.contains(r#""model": "C""#));
}
