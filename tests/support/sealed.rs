//! Stored solutions that a test copies, changes and seals again.
#![allow(dead_code)] // each test file uses its part

use impactcheck::scene::hash::sha256_hex;
use serde_json::Value;
use std::fs;
use std::path::Path;

const SUMS: &str = "checksums.sha256";

/// Copies the shipped solution `entry`, such as `scaled-plate-r10/paper`, into the folder `to`.
pub fn copy_shipped(entry: &str, to: &Path) {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("fem_reference/solutions").join(entry);
    fs::create_dir_all(to).expect("folder");
    for file in fs::read_dir(from).expect("solution").flatten() {
        fs::copy(file.path(), to.join(file.file_name())).expect("copy");
    }
}

/// Changes the summary of the solution in `folder`, and seals it again.
pub fn change_summary(folder: &Path, change: impl FnOnce(&mut Value)) {
    let file = folder.join("summary.json");
    let mut summary = serde_json::from_slice(&fs::read(&file).expect("summary")).expect("JSON");
    change(&mut summary);
    fs::write(file, summary.to_string()).expect("summary");
    seal(folder);
}

/// Writes the checksums of what is in `folder`.
pub fn seal(folder: &Path) {
    let files = fs::read_dir(folder).expect("folder").flatten();
    let mut names: Vec<String> = files
        .map(|file| file.file_name().into_string().expect("UTF-8"))
        .filter(|name| name != SUMS)
        .collect();
    names.sort();
    let line = |name: &String| {
        let sum = sha256_hex(&fs::read(folder.join(name)).expect("file"));
        format!("{sum}  {name}\n")
    };
    fs::write(folder.join(SUMS), names.iter().map(line).collect::<String>()).expect("checksums");
}
