//! The project's files for a program that is moved away from them, and the library that it puts into units for co-simulation.
//!
//! A macro of its own, so that only the small binary, not the library and its tests, is built again when a scene or a
//! Python file changes.

use proc_macro::TokenStream;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The models for pages, below the folder of a build.
const LIVE: &str = "wasm32-unknown-unknown/live/impactcheck_live.wasm";
/// What the models for pages are made of.
const SOURCES: [&str; 5] =
    ["physics/src", "prediction/src", "live/src", "validation/base.jsonl", "Cargo.lock"];

/// An expression of type `(&str, &[(&str, &[u8])])`: a word that changes with the files, and their paths, relative to the
/// project, with their contents.
#[proc_macro]
pub fn files(_: TokenStream) -> TokenStream {
    let root = root();
    let mut found = BTreeMap::new();
    for folder in ["scenes", "meshes", "fem_reference"] {
        collect(Path::new(&root), folder, &mut found);
    }
    let shipped = |name: &str| found.contains_key(&format!("scenes/{name}.toml"));
    let selected: Vec<_> = found.iter().filter(|(path, _)| is_selected(path, shipped)).collect();
    let hash = selected.iter().fold(0, |hash, (path, bytes)| fnv(fnv(hash, path.as_bytes()), bytes));
    let entry =
        |path: &str| format!("({path:?}, include_bytes!({:?}).as_slice()),", format!("{root}/{path}"));
    let entries: String = selected.iter().map(|(path, _)| entry(path)).collect();
    format!("({:?}, &[{entries}])", format!("{hash:016x}")).parse().expect("Rust")
}

/// An expression of type `&[u8]`: the dynamic library of the crate `impactcheck-fmu-library`, which cargo builds before everything that depends
/// on it; empty where nothing is built but only checked.
#[proc_macro]
pub fn unit(_: TokenStream) -> TokenStream {
    let name =
        format!("{}impactcheck_fmu_library{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let arguments: Vec<String> = std::env::args().collect();
    // where the compiler is told to look for dependencies
    let folders = arguments.iter().filter_map(|argument| argument.strip_prefix("dependency="));
    let found = folders.map(|folder| Path::new(folder).join(&name)).find(|path| path.is_file());
    match found.and_then(|path| path.canonicalize().ok()) {
        Some(path) => format!("include_bytes!({:?}).as_slice()", path.display().to_string()),
        None => "&[]".to_owned(),
    }
    .parse()
    .expect("Rust")
}

/// An expression of type `&[u8]`: the models for pages, compressed by gzip, as `make live-page` has made them; empty where it has not, or where
/// they are of other [`sources`] than the program's.
#[proc_macro]
pub fn live(_: TokenStream) -> TokenStream {
    let arguments: Vec<String> = std::env::args().collect();
    let folders = arguments.iter().filter_map(|argument| argument.strip_prefix("dependency="));
    // in the folder of the build of this machine, whatever the profile
    let mut places = folders.flat_map(|folder| Path::new(folder).ancestors().map(|place| place.join(LIVE)));
    let found = places.find(|path| path.is_file()).and_then(|path| path.canonicalize().ok());
    let Some(path) = found else { return "&[]".parse().expect("Rust") };
    let mark = mark_of_sources();
    let bytes = fs::read(&path).unwrap_or_default();
    let is_current = bytes.windows(mark.len()).any(|part| part == mark.as_bytes());
    let packed = path.with_extension("wasm.gz");
    let modified = |path: &Path| fs::metadata(path).and_then(|file| file.modified()).ok();
    let is_packed = modified(&packed).is_some_and(|time| Some(time) >= modified(&path));
    let included = |path: &Path| format!("include_bytes!({:?}).as_slice()", path.display().to_string());
    let expression = match is_current && is_packed {
        true => included(&packed),
        // named, so that cargo builds again when it has changed
        false => format!("{{ const _: &[u8] = {}; &[] }}", included(&path)),
    };
    expression.parse().expect("Rust")
}

/// An expression of type `&[u8]`: a mark of the sources that results follow from.
#[proc_macro]
pub fn sources(_: TokenStream) -> TokenStream {
    format!("{:?}.as_bytes()", mark_of_sources()).parse().expect("Rust")
}

fn mark_of_sources() -> String {
    let root = root();
    let mut found = BTreeMap::new();
    for place in SOURCES {
        let path = Path::new(&root).join(place);
        if path.is_dir() {
            collect(Path::new(&root), place, &mut found);
        } else {
            found.insert(place.to_owned(), fs::read(path).expect(place));
        }
    }
    let hash = found.iter().fold(0, |hash, (path, bytes)| fnv(fnv(hash, path.as_bytes()), bytes));
    format!("impactcheck models {hash:016x}")
}

/// Folder of the project.
fn root() -> String {
    let package = std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets the folder of the package");
    let root = Path::new(&package).ancestors().find(|folder| folder.join("scenes").is_dir());
    root.and_then(Path::to_str).expect("a package of the project").to_owned()
}

fn is_selected(path: &str, shipped: impl Fn(&str) -> bool) -> bool {
    match path.strip_prefix("fem_reference/") {
        None => !path.ends_with(".md"),
        Some(rest) => match rest.strip_prefix("solutions/") {
            // what the first command needs, and what is known of all scenes
            Some("validated.jsonl") => true,
            Some(entry) => entry.split_once("/paper/").is_some_and(|(scene, _)| shipped(scene)),
            None => (rest.ends_with(".py") || rest.ends_with(".c")) && !rest.starts_with("tests/"),
        },
    }
}

/// Puts the files below `folder` into `found`.
fn collect(root: &Path, folder: &str, found: &mut BTreeMap<String, Vec<u8>>) {
    for entry in fs::read_dir(root.join(folder)).expect(folder) {
        let entry = entry.expect(folder);
        let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            collect(root, &path, found);
        } else {
            found.insert(path, fs::read(entry.path()).expect("a file of the project"));
        }
    }
}

/// FNV-1a, 64 bit (Fowler, Noll, Vo).
fn fnv(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash ^ 0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
