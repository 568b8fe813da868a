//! Runs of the program, and the files they are given.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

pub const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// How a run ended and what it said.
pub struct Ended {
    pub status: i32,
    pub out: String,
    pub error: String,
}

/// The program in the project's folder, without the user's store and without FEniCSx.
pub fn impactcheck(arguments: &[&str]) -> Ended {
    let output = Command::cargo_bin("impactcheck")
        .unwrap()
        .args(arguments)
        .current_dir(ROOT)
        .env_remove("IMPACTCHECK_STORE")
        .env("IMPACTCHECK_PYTHON", "/no/such/python3")
        .output()
        .unwrap();
    Ended {
        status: output.status.code().expect("ended by itself"),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        error: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// Text without the line breaks of a message's frame.
pub fn flat(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace() && *c != '│').collect()
}

/// What the program prints as JSON, with status 0.
pub fn json(arguments: &[&str]) -> Value {
    let ended = impactcheck(arguments);
    assert_eq!(ended.status, 0, "{arguments:?}: {}", ended.error);
    serde_json::from_str(&ended.out).expect("one JSON document")
}

/// A new file with `text` in `folder`.
pub fn file(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

/// A path as an argument.
pub fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Fig. 16's impact.
pub const THIN_PLATE: &str = r#"
name = "thin-plate-r1.5"
kind = "plate-impact"
materials.steel = { youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = "7780 kg/m^3" }
materials.titanium = { youngs_modulus = "115 GPa", poisson_ratio = 0.37, density = "4430 kg/m^3" }
plate = { radius = "5 mm", thickness = "0.3 mm", edge = "clamped", material = "titanium" }
outer = { kind = "sphere", radius = "1.5 mm", material = "steel", speed = "500 mm/s" }
inner = { kind = "sphere", radius = "1.5 mm", material = "steel" }
"#;
