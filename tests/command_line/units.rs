//! `impactcheck fmu`; what units do in a simulation is tested with FMPy (`fem_reference/tests/test_units.py`).

use crate::program::{impactcheck, json};

#[test]
fn the_same_scene_gives_the_same_unit() {
    let folder = tempfile::tempdir().expect("folder");
    let write = |name: &str| {
        let file = folder.path().join(name);
        let path = file.to_str().expect("UTF-8");
        let document = json(&["fmu", "scaled-plate-r10", "--model", "A", "--json", "-o", path]);
        assert_eq!((&document["model"], &document["fmi"]), (&"A".into(), &"3.0".into()));
        let bytes = std::fs::read(&file).expect("a unit");
        assert_eq!(document["bytes"], bytes.len());
        bytes
    };
    let [first, second] = ["one.fmu", "two.fmu"].map(write);
    assert!(first.starts_with(b"PK") && first == second);
}

#[test]
fn what_is_no_unit_is_refused() {
    for (arguments, part) in [
        (["-o", "plate.zip"], "a file that ends in .fmu"),
        (["--fmi", "4"], "possible values: 3, 2"),
        (["--model", "external"], "--model external"),
        (["--mesh", "plate.vtu"], "--mesh plate.vtu"),
    ] {
        let run = impactcheck(&[&["fmu", "scaled-plate-r10"], &arguments[..]].concat());
        assert!(run.status == 2 && run.error.contains(part), "{}", run.error);
    }
}
