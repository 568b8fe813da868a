//! The store gives out a reference only if it is intact and of exactly this scene; otherwise it
//! says which file is damaged or what has changed since.

use crate::sealed::seal;
use crate::store_fixture::*;
use impactcheck::reference::{Lookup, Resolution, Store};
use impactcheck::scene::Scene;
use serde_json::{Value, json};
use std::path::PathBuf;

const PAPER: Resolution = Resolution::Paper;

/// A store with one intact entry of [`scene`]; the folder lives as long as the first value.
fn stored() -> (tempfile::TempDir, Store, PathBuf) {
    let root = tempfile::tempdir().expect("folder");
    let store = Store::open(Some(root.path()));
    let folder = store.folder(&scene(), PAPER);
    write_entry(&folder, &scene(), PAPER);
    (root, store, folder)
}

/// Replaces one file of an entry and makes its checksums right again.
fn replace(folder: &std::path::Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).expect("file");
    seal(folder);
}

#[track_caller]
fn damaged(store: &Store, file: &str, words: &[&str]) {
    match store.find(&scene(), PAPER) {
        Lookup::Damaged { file: found, reason } => {
            assert!(found.ends_with(file), "{}: {reason}", found.display());
            for word in words {
                assert!(reason.contains(word), "`{word}` is not in: {reason}");
            }
        }
        other => panic!("not damaged: {other:?}"),
    }
}

#[track_caller]
fn stale(store: &Store, scene: &Scene, words: &[&str]) {
    match store.find(scene, PAPER) {
        Lookup::Stale { reason } => {
            for word in words {
                assert!(reason.contains(word), "`{word}` is not in: {reason}");
            }
        }
        other => panic!("not stale: {other:?}"),
    }
}

#[test]
fn an_intact_entry_is_found_with_its_values() {
    let (_root, store, folder) = stored();
    assert_eq!(folder, store.root().join("scaled-plate-r10").join("paper"));
    let Lookup::Found(found) = store.find(&scene(), PAPER) else { panic!("not found") };
    let (summary, history) = (&found.outcome.summary, &found.outcome.history);
    assert_eq!(summary.value("efficiency").unwrap(), 0.7);
    assert_eq!(summary.uncertainty["efficiency"], 0.0002);
    assert_eq!((summary.samples, history.len()), (Some(3), 3));
    assert_eq!(history.time, [0.0, 1e-7, 2e-7]);
    assert_eq!(history["outer_displacement"], [0.0, -5.5e-8, -1.1e-7]);
    assert_eq!(history["outer_velocity"], [-0.55, -0.5499, -0.5498]);
    assert_eq!(history["outer_force"], [0.0, 12.5, 25.0]);
    assert_eq!(history["plate_displacement"], [0.0, -1e-9, -2e-9]);
    assert_eq!(history["plate_velocity"], [0.0, -0.01, -0.02]);
    assert_eq!(history["inner_displacement"], [0.0, 0.0, -1e-12]);
    assert_eq!(history["inner_velocity"], [0.0, -1e-5, -2e-5]);
    assert_eq!(history["inner_force"], [0.0, 0.25, 0.5]);
    assert_eq!(found.folder, folder);
    assert_eq!(found.provenance["settings"]["resolution"], "paper");
}

#[test]
fn what_is_not_there_is_missing() {
    let (_root, store, _) = stored();
    assert_eq!(store.find(&scene(), Resolution::Fine), Lookup::Missing);
    assert_eq!(store.find(&scene_with("scaled-plate-r10", "other"), PAPER), Lookup::Missing);
}

#[test]
fn a_summary_that_counts_other_samples_is_unchanged() {
    let (_root, store, folder) = stored();
    replace(&folder, "history.csv", &HISTORY.lines().take(3).map(|l| format!("{l}\n")).collect::<String>());
    let Lookup::Found(found) = store.find(&scene(), PAPER) else { panic!("not found") };
    assert_eq!((found.outcome.summary.samples, found.outcome.history.len()), (Some(3), 2));
}

#[test]
fn one_changed_byte_is_damage_in_every_file() {
    for name in ["summary.json", "history.csv", "mesh.vtu", "provenance.json"] {
        let (_root, store, folder) = stored();
        let mut bytes = std::fs::read(folder.join(name)).expect("file");
        let last = bytes.len() - 2;
        bytes[last] ^= 1;
        std::fs::write(folder.join(name), bytes).expect("file");
        damaged(&store, name, &["SHA-256", "recorded"]);
        std::fs::remove_file(folder.join(name)).expect("removed");
        if name != "mesh.vtu" {
            damaged(&store, name, &["can't be read"]);
        }
    }
}

#[test]
fn a_mesh_that_a_repository_leaves_out_is_no_damage() {
    let (_root, store, folder) = stored();
    std::fs::remove_file(folder.join("mesh.vtu")).expect("removed");
    let Lookup::Found(found) = store.find(&scene(), PAPER) else { panic!("not found") };
    found.mesh().expect_err("no mesh to draw");
    assert_eq!(found.stress_near(0.0), Ok(None));
}

#[test]
fn checksums_are_read_strictly() {
    let (_root, store, folder) = stored();
    let file = folder.join("checksums.sha256");
    let sound = std::fs::read_to_string(&file).expect("checksums");
    for (text, words) in [
        (String::new(), ["does not list", "summary.json"]),
        (sound.replacen("mesh.vtu", "mesh.vtk", 1), ["does not list", "mesh.vtu"]),
        (sound.replacen("mesh.vtu", "../mesh.vtu", 1), ["line 2", "not a checksum"]),
        (sound.replacen("  ", " ", 1), ["line 1", "not a checksum"]),
        (format!("{sound}nonsense\n"), ["line 5", "not a checksum"]),
    ] {
        std::fs::write(&file, text).expect("checksums");
        damaged(&store, "checksums.sha256", &words);
    }
    std::fs::write(&file, sound.replace("  ", " *")).expect("checksums");
    assert!(matches!(store.find(&scene(), PAPER), Lookup::Found(_)), "binary mode of sha256sum");
    std::fs::remove_file(&file).expect("removed");
    damaged(&store, "checksums.sha256", &["can't be read"]);
}

#[test]
fn a_history_is_read_strictly() {
    let (_root, store, folder) = stored();
    let header = HISTORY.lines().next().expect("header");
    for (text, words) in [
        (HISTORY.replace("12.5", "NaN"), ["line 3", "outer_force is `NaN`"]),
        (HISTORY.replace("12.5", "inf"), ["line 3", "outer_force is `inf`"]),
        (HISTORY.replace("12.5", ""), ["line 3", "outer_force is ``"]),
        (HISTORY.replace("12.5", "12.5 N"), ["line 3", "12.5 N"]),
        (HISTORY.replace(",12.5", ""), ["line 3", "8 fields"]),
        (HISTORY.replace(",12.5", ",12.5,1"), ["line 3", "10 fields"]),
        (HISTORY.replace("2e-07", "1e-07"), ["line 4", "time is 0.0000001 s"]),
        (HISTORY.replace("outer_force", "force"), ["line 1", "columns"]),
        (HISTORY.replace("time,outer_displacement", "outer_displacement,time"), ["line 1", "columns"]),
        (header.to_owned(), ["no sample", ""]),
        (String::new(), ["no sample", ""]),
    ] {
        replace(&folder, "history.csv", &text);
        damaged(&store, "history.csv", &words);
    }
}

#[test]
fn documents_are_read_strictly() {
    let (_root, store, folder) = stored();
    let original = summary(&scene());
    let with = |key: &str, value: Value| {
        let mut changed = original.clone();
        changed[key] = value;
        changed.to_string()
    };
    for (text, words) in [
        (with("schema_version", json!(2)), "schema_version is 2"),
        (with("source", json!("reduced")), "not `reference`"),
        (with("efficiency", json!("0.7")), "invalid value of `efficiency`"),
        (with("outer_contacts", json!(0.5)), "invalid value of `outer_contacts`"),
        (with("steps", json!(-1)), "invalid value"),
        (original.to_string().replace("\"efficiency\":0.7,", ""), "missing field `efficiency`"),
        (original.to_string().replace("0.7", "1e999"), "out of range"),
        (with("convergence", Value::Null), "no `convergence`"),
        (with("convergence", json!({ "meshes": [] })), "no `convergence`"),
        ("{".to_owned(), "EOF"),
    ] {
        replace(&folder, "summary.json", &text);
        damaged(&store, "summary.json", &[words]);
    }
    replace(&folder, "summary.json", &with("scene_hash", json!("0")));
    damaged(&store, "provenance.json", &["scene_hash"]);
}

#[test]
fn an_entry_that_is_no_folder_is_damage() {
    let (_root, store, folder) = stored();
    std::fs::remove_dir_all(&folder).expect("removed");
    std::fs::write(&folder, "").expect("file");
    damaged(&store, "paper", &["not a folder"]);
}

#[test]
fn a_changed_scene_is_stale_and_the_change_is_named() {
    let (_root, store, _) = stored();
    let changed = scene_with("550 mm/s", "600 mm/s");
    stale(
        &store,
        &changed,
        &["the scene has changed", "outer.speed: 0.55 -> 0.6 m/s", &changed.hash()[..12]],
    );
    let gap = "gap = \"1 um\"\n[fluid]\nviscosity = 1e-3\ndensity = 1e3\nminimum_gap = 1e-6\n[reduced]";
    stale(&store, &scene_with("[reduced]", gap), &["inner.gap: 0.0 -> 1e-6 m", "fluid: none -> {"]);
    stale(&store, &scene_with("clamped", "free"), &["plate.edge: clamped -> free ("]);
    let dense = scene_with("7780 kg/m^3", "7800 kg/m^3");
    stale(&store, &dense, &["plate.material.density: 7780.0 -> 7800.0 kg/m^3", "outer.material.density"]);
    stale(
        &store,
        &scene_with("[reduced]", "[run]\nend_time = 1\n[reduced]"),
        &["run.end_time: none -> 1.0 s"],
    );
}

#[test]
fn changed_settings_are_stale_and_the_change_is_named() {
    let (_root, store, folder) = stored();
    let fewer = scene_with("radius = 12", "radius = 10");
    stale(
        &store,
        &fewer,
        &["the settings have changed", "reference.elements_per_contact_radius: 12.0 -> 10.0 ("],
    );

    let mut older = provenance(&scene(), PAPER);
    older["settings_hash"] = json!("0123456789abcdef");
    replace(&folder, "provenance.json", &older.to_string());
    stale(&store, &scene(), &["method of the reference", "settings_hash 0123456789ab -> "]);

    let coarse = provenance(&scene(), Resolution::Coarse);
    replace(&folder, "provenance.json", &coarse.to_string());
    stale(&store, &scene(), &["resolution: coarse -> paper"]);
}

#[test]
fn what_is_not_physics_leaves_the_entry_valid() {
    let (_root, store, _) = stored();
    for (from, to) in [("modes = 16", "modes = 8"), ("Scaled plate", "The plate"), ("\"33 mm\"", "0.033")] {
        assert!(matches!(store.find(&scene_with(from, to), PAPER), Lookup::Found(_)), "{to}");
    }
    let renamed = Scene::parse("scene.toml", &SCENE.replace("steel", "iron")).expect("valid");
    assert!(matches!(store.find(&renamed, PAPER), Lookup::Found(_)));
}

#[test]
fn the_projects_own_store_is_read_where_ones_own_has_nothing() {
    let root = tempfile::tempdir().expect("folder");
    let (store, shipped) = (Store::open(Some(root.path())), Store::shipped().expect("a checkout"));
    let find = || store.find_here_or_shipped(&scene(), PAPER);
    let folder_of = |lookup| match lookup {
        Lookup::Found(stored) => stored.folder,
        other => panic!("not found: {other:?}"),
    };
    assert_eq!(folder_of(find()), shipped.folder(&scene(), PAPER));
    assert_eq!(store.find(&scene(), PAPER), Lookup::Missing, "only this way of looking");
    // Of another scene of the name: no better than nothing.
    write_entry(&store.folder(&scene(), PAPER), &scene_with("550 mm/s", "600 mm/s"), PAPER);
    assert_eq!(folder_of(find()), shipped.folder(&scene(), PAPER));
    // One's own comes first, and a damaged one is not passed over in silence.
    write_entry(&store.folder(&scene(), PAPER), &scene(), PAPER);
    assert_eq!(folder_of(find()), store.folder(&scene(), PAPER));
    std::fs::write(store.folder(&scene(), PAPER).join("history.csv"), "").expect("file");
    assert!(matches!(find(), Lookup::Damaged { .. }));
    // What is nowhere is as it is here.
    let other = scene_with("550 mm/s", "610 mm/s");
    let other = store.find_here_or_shipped(&other, PAPER);
    assert!(matches!(other, Lookup::Damaged { .. }));
}
