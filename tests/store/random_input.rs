//! Random scene files and random damage to stored solutions: an answer or an error, never a panic.
//!
//! `PROPTEST_CASES=200000 cargo test --release --test random_input` fuzzes for longer.

use crate::sealed::seal;
use crate::store_fixture::{scene, write_entry};
use impactcheck::reference::{Lookup, Resolution, Store};
use impactcheck::scene::Scene;
use proptest::prelude::*;
use std::fs;

const SHIPPED: [&str; 4] = [
    include_str!("../../scenes/scaled-plate-r6.35.toml"),
    include_str!("../../scenes/seal-seat-improved.toml"),
    include_str!("../../scenes/examples/wet-valve-plate.toml"),
    include_str!("../../scenes/examples/rocker-bender.toml"),
];

/// What is put into a scene: pieces of TOML, numbers at the edge, units, and anything.
fn piece() -> impl Strategy<Value = String> {
    prop_oneof![
        prop::sample::select(
            &[
                "nan",
                "inf",
                "-1",
                "0",
                "1e400",
                "1e-320",
                "-0.0",
                "true",
                "[]",
                "{}",
                "\"\"",
                "\"mm\"",
                "\"1 kg\"",
                "\"1 mm\"",
                "\"-2 deg\"",
                "\n",
                "[plate]\n",
                "[[plate]]\n",
                "=",
                "#",
                "\"",
                "\u{feff}",
                "µ",
                "plate.",
                "\"1e309 m\"",
                "99999999999999999999",
                "radius",
                "[tolerances.B]\n",
                "\r\n",
                "\0",
            ][..]
        )
        .prop_map(str::to_owned),
        any::<f64>().prop_map(|x| format!("{x:e}")),
        any::<i64>().prop_map(|x| x.to_string()),
        ".{0,12}",
    ]
}

/// `text` with pieces put in place of slices.
fn damaged(text: &str, edits: &[(prop::sample::Index, usize, String)]) -> String {
    let mut characters: Vec<char> = text.chars().collect();
    for (at, length, with) in edits {
        let start = at.index(characters.len() + 1);
        let end = (start + length).min(characters.len());
        characters.splice(start..end, with.chars());
    }
    characters.into_iter().collect()
}

fn edits(
    text: impl Strategy<Value = String>,
) -> impl Strategy<Value = Vec<(prop::sample::Index, usize, String)>> {
    prop::collection::vec((any::<prop::sample::Index>(), 0_usize..12, text), 1..4)
}

/// The values of a scene file, each with its place in the text.
fn values(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        if let Some((key, value)) = line.split_once('=') {
            let value = value.split('#').next().unwrap_or_default().trim_end();
            found.push(start + key.len() + 1..start + key.len() + 1 + value.len());
        }
        start += line.len();
    }
    found
}

proptest! {
    #[test]
    fn a_damaged_scene_is_read_or_refused(shipped in prop::sample::select(&SHIPPED[..]), edits in edits(piece())) {
        let text = damaged(shipped, &edits);
        if let Ok(scene) = Scene::parse("scene.toml", &text) {
            // what was read can be identified and handed on
            prop_assert_eq!(scene.hash().len(), 64);
            let json = serde_json::to_string(&scene).expect("JSON");
            prop_assert!(!json.contains("null,\"youngs"), "{}", json);
        }
    }

    #[test]
    fn a_scene_with_other_values_is_read_or_refused(
        shipped in prop::sample::select(&SHIPPED[..]),
        at in any::<prop::sample::Index>(),
        value in piece(),
    ) {
        let mut text = shipped.to_owned();
        text.replace_range(at.get(&values(shipped)).clone(), &value);
        if let Ok(scene) = Scene::parse("scene.toml", &text) {
            prop_assert_eq!(scene.hash().len(), 64);
        }
    }

    #[test]
    fn a_damaged_solution_is_found_out(
        file in prop::sample::select(&["summary.json", "history.csv", "provenance.json", "mesh.vtu", "checksums.sha256"][..]),
        edits in edits(prop_oneof![piece(), Just(String::new())]),
        sealed in any::<bool>(),
    ) {
        let scene = scene();
        let folder = tempfile::tempdir().expect("folder");
        let entry = folder.path().join(&scene.name).join("paper");
        write_entry(&entry, &scene, Resolution::Paper);
        let intact = fs::read_to_string(entry.join(file)).expect("file");
        let broken = damaged(&intact, &edits);
        fs::write(entry.join(file), &broken).expect("file");
        if sealed {
            // damage before the checksums were made: the content has to be seen through
            seal(&entry);
        }
        let found = Store::open(Some(folder.path())).find(&scene, Resolution::Paper);
        if broken != intact && !sealed && file != "checksums.sha256" {
            prop_assert!(matches!(found, Lookup::Damaged { .. }), "{:?}", found);
        }
        if let Lookup::Found(stored) = found {
            prop_assert!(stored.outcome.history.time.windows(2).all(|t| t[0] < t[1]));
        }
    }
}
