//! The house: what the layout of the sources must satisfy, as counts that may only fall.
//!
//! A bound is the count of today. Above it a test fails and prints what was counted; below it the test asks for the lower bound.

mod source;
mod words;

use source::{Language, Source, kinds, sources};
use std::collections::{BTreeMap, BTreeSet};

/// Packages whose rooms (files and folders at their top) are looked at: the folder, and what an import of it starts with.
const PACKAGES: [&str; 3] = ["physics/src", "app/src", "fem_reference"];

/// Fails unless `found` has exactly `bound` entries.
fn ratchet(what: &str, found: &[String], bound: usize) {
    let n = found.len();
    assert!(n <= bound, "{n} {what}, {bound} are allowed:\n  {}", found.join("\n  "));
    assert!(n == bound, "{n} {what}: lower the bound from {bound} to {n}");
}

/// A new kind is one folder a side and a line in a registry: nothing else names it.
#[test]
fn files_outside_the_kinds_folders_that_name_a_kind() {
    let kinds = kinds();
    assert!(kinds.len() > 1, "{kinds:?}");
    let inside = |source: &Source| {
        let mut folders = source.path.split('/').rev().skip(1);
        folders.any(|folder| folder == "kinds" || kinds.iter().any(|kind| kind == folder))
    };
    // `plate_impact`, `plate-impact` and `PlateImpact` are one name
    let plain = |text: &str| text.to_lowercase().replace(['_', '-'], "");
    let names: Vec<String> = kinds.iter().map(|kind| plain(kind)).collect();
    let found: Vec<String> = sources()
        .filter(|source| !inside(source))
        .filter(|source| {
            let text = plain(&source.code);
            names.iter().any(|name| text.contains(name))
        })
        .map(|source| source.path)
        .collect();
    ratchet("files outside the kinds' folders that name a kind", &found, 1);
}

/// Data flows one way: no room imports one that imports it, be it through others.
#[test]
fn rooms_that_import_each_other() {
    let found: Vec<String> = PACKAGES.iter().flat_map(|package| circular(package)).collect();
    ratchet("imports in circles of rooms", &found, 0);
}

/// Drawings take numbers and labels: they know no scene, no result, no report.
#[test]
fn rooms_that_drawings_import() {
    let imports = imports("app/src");
    let found: Vec<&str> =
        imports.keys().filter(|(room, _)| room == "plot").map(|(_, other)| &**other).collect();
    assert_eq!(found, ["format"], "besides numbers in words, `plot` imports nothing");
}

/// Importing room and imported one, with the files that import.
type Imports = BTreeMap<(String, String), BTreeSet<String>>;

/// The imports between rooms of `package`.
fn imports(package: &str) -> Imports {
    let inside = format!("{package}/");
    let sources: Vec<Source> = sources().filter(|source| source.path.starts_with(&inside)).collect();
    let rooms: BTreeSet<&str> = sources.iter().filter_map(|source| source.room(package)).collect();
    let mut imports = Imports::new();
    for source in &sources {
        let Some(room) = source.room(package) else { continue };
        for other in source.imports(package) {
            if other != room && rooms.contains(other.as_str()) {
                let files = imports.entry((room.to_owned(), other)).or_default();
                files.insert(source.path[inside.len()..].to_owned());
            }
        }
    }
    imports
}

/// An import in a line.
fn in_words(((room, other), files): ((String, String), BTreeSet<String>)) -> String {
    format!("{room} -> {other}: {}", files.into_iter().collect::<Vec<_>>().join(" "))
}

/// The imports between rooms of `package` that are part of a circle.
fn circular(package: &str) -> Vec<String> {
    let mut imports = imports(package);
    // rooms that import nothing, or that nothing imports, are in no circle; without them others are such
    loop {
        let [from, to] = [0, 1].map(|side| {
            let names = imports.keys().map(|pair| if side == 0 { &pair.0 } else { &pair.1 });
            names.cloned().collect::<BTreeSet<String>>()
        });
        let before = imports.len();
        imports.retain(|(room, other), _| to.contains(room) && from.contains(other));
        if imports.len() == before {
            break;
        }
    }
    imports.into_iter().map(|import| format!("{package}: {}", in_words(import))).collect()
}

/// What shows that the program is right and fast is no part of it.
#[test]
fn imports_of_evidence_outside_the_command_line() {
    let room = |source: &Source| source.room("app/src").map(str::to_owned);
    let product = |source: &Source| {
        source.path.starts_with("app/src/")
            && !matches!(room(source).as_deref(), Some("cli" | "evidence" | "lib.rs"))
    };
    let found: Vec<String> = sources()
        .filter(product)
        .filter(|source| source.imports("app/src").contains(&"evidence".to_owned()))
        .map(|source| source.path)
        .collect();
    ratchet("files that import evidence", &found, 0);
}

/// A type's name says where to look: it is defined once.
#[test]
fn names_of_types_that_are_defined_more_than_once() {
    let mut defined: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for source in sources().filter(|source| source.language == Language::Rust) {
        for name in source.types() {
            defined.entry(name).or_default().push(source.path.clone());
        }
    }
    assert!(defined.len() > 400, "{} types", defined.len());
    let found: Vec<String> = defined
        .iter()
        .filter(|(_, files)| files.len() > 1)
        .map(|(name, files)| format!("{name}: {}", files.join(" ")))
        .collect();
    ratchet("names of types that are defined more than once", &found, 29);
}

/// A comment in a source file is no reason to compute anything again.
#[test]
fn sources_that_are_part_of_a_key() {
    let found: Vec<String> = sources().flat_map(|source| source.includes_of_sources()).collect();
    ratchet("sources that are included as text", &found, 0);
}
