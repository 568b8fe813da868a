//! One stored solution: a folder whose files are verified before they are believed.

use super::{CurveBands, Resolution, history_file};
use crate::kinds;
use crate::result::{Curve, Outcome, SCHEMA_VERSION, Source, Summary};
use crate::scene::Scene;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A solution whose files are intact.
///
/// `outcome.summary.samples` may differ from the number of rows of the history: both are kept
/// as found, and the comparison makes a failed check of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Stored {
    /// Summary and history.
    pub outcome: Outcome,
    /// 95 % bands of the history's curves, if the solution has them.
    pub bands: Option<CurveBands>,
    /// What it was made from and with: `provenance.json`.
    pub provenance: Value,
    /// Where it lies.
    pub folder: PathBuf,
    /// Where the solution of another scene of this name, or with other settings, was moved when this one was computed and
    /// took its place.
    pub earlier: Option<PathBuf>,
}

/// A file that is not what it should be.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Damage {
    pub(super) file: PathBuf,
    pub(super) reason: String,
}

const CHECKSUMS: &str = "checksums.sha256";
const SUMMARY: &str = "summary.json";
const HISTORY: &str = "history.csv";
const PROVENANCE: &str = "provenance.json";
const MESH: &str = "mesh.vtu";
const REQUIRED: [&str; 4] = [SUMMARY, HISTORY, MESH, PROVENANCE];
const NO_SERIES: &str =
    "has no `convergence` with the `dofs` of its meshes: its uncertainties do not follow from anything";
/// Bands of curves are written with three digits.
const BAND_ROUNDING: f64 = 0.005;
/// Bytes of a mesh file within which its number of points stands.
const MESH_HEAD: u64 = 4096;

/// Where a solution comes from, and so which files it must have. The files with values on the mesh (`.vtu`) are large, show pictures
/// only, and a computation makes them again: a repository may omit them. What is there must be intact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Origin {
    /// It has just been computed, with all files.
    Computed,
    /// It is stored; mesh files may be missing.
    Stored,
    /// Another program's result, which has no mesh file.
    Imported,
}

impl Origin {
    /// Of a stored entry.
    pub(super) fn of(resolution: Resolution) -> Self {
        if resolution.is_of_another_program() { Origin::Imported } else { Origin::Stored }
    }
}

/// Verifies the folder's checksums and reads it; what the solver can't know, how near the solution comes to the bounds of its
/// theories, is judged by `scene`.
pub(super) fn load(scene: &Scene, folder: &Path, origin: Origin) -> Result<Stored, Damage> {
    let (kind, is_imported) = (kinds::of(scene), origin == Origin::Imported);
    let has_mesh = kind.has_mesh() && !is_imported;
    verify(folder, has_mesh, origin == Origin::Stored)?;
    let damage = |file: &str, reason: String| Damage { file: folder.join(file), reason };
    let mut summary = Summary::read(kind.quantities(), &text(folder, SUMMARY)?)
        .map_err(|e| damage(SUMMARY, format!("is not what is expected: {e}")))?;
    let provenance: Value = read_json(folder, PROVENANCE)?;
    let curves: Vec<Curve> = kind.curves().iter().filter(|c| kind.has(scene, c.name)).cloned().collect();
    let (history, bands) = history_file::read(&curves, &folder.join(HISTORY), is_imported)
        .map_err(|reason| damage(HISTORY, reason))?;
    if summary.schema_version != SCHEMA_VERSION {
        let reason =
            format!("schema_version is {}; this program reads {SCHEMA_VERSION}", summary.schema_version);
        return Err(damage(SUMMARY, reason));
    }
    let (source, word) =
        if is_imported { (Source::External, "external") } else { (Source::Reference, "reference") };
    if summary.source != source {
        return Err(damage(SUMMARY, format!("source is not `{word}`")));
    }
    if provenance["scene_hash"] != summary.scene_hash.as_str() {
        let reason =
            format!("scene_hash is {}, but {} in {SUMMARY}", provenance["scene_hash"], summary.scene_hash);
        return Err(damage(PROVENANCE, reason));
    }
    if has_mesh {
        let dofs = finest_dofs(&summary).ok_or_else(|| damage(SUMMARY, NO_SERIES.to_owned()))?;
        let drawn = summary.mesh.as_ref().and_then(|mesh| mesh["points"].as_u64());
        check_mesh(folder, dofs, drawn).map_err(|reason| damage(MESH, reason))?;
    }
    check_bands(&summary, bands.as_ref()).map_err(|reason| damage(HISTORY, reason))?;
    kind.judge(scene, &mut summary, Some(&history));
    Ok(Stored {
        outcome: Outcome { summary, history },
        bands,
        provenance,
        folder: folder.to_path_buf(),
        earlier: None,
    })
}

/// Displacements of the finest mesh of the series.
fn finest_dofs(summary: &Summary) -> Option<u64> {
    summary.convergence.as_ref()?["meshes"][0]["dofs"].as_u64()
}

/// That the mesh, if it is there, has nodes for the `dofs` of the finest one of the series, two or three each, or as many as are `drawn`
/// where a rigid part has several.
fn check_mesh(folder: &Path, dofs: u64, drawn: Option<u64>) -> Result<(), String> {
    let Ok(file) = std::fs::File::open(folder.join(MESH)) else { return Ok(()) };
    let mut head = Vec::new();
    std::io::Read::read_to_end(&mut std::io::Read::take(file, MESH_HEAD), &mut head)
        .map_err(|e| format!("can't be read: {e}"))?;
    let head = String::from_utf8_lossy(&head);
    let nodes = head.split_once("NumberOfPoints=\"").and_then(|(_, rest)| rest.split_once('"'));
    let nodes: Option<u64> = nodes.and_then(|(number, _)| number.parse().ok());
    match nodes {
        Some(nodes) if drawn == Some(nodes) => Ok(()),
        Some(nodes) if drawn.is_none() && [2, 3].map(|d| nodes.checked_mul(d)).contains(&Some(dofs)) => {
            Ok(())
        }
        Some(nodes) => Err(format!("has {nodes} nodes; the solution is of a mesh with {dofs} displacements")),
        None => Err("has no number of nodes".to_owned()),
    }
}

/// That the bands of the curves are as wide as the summary says of them, where it does.
fn check_bands(summary: &Summary, bands: Option<&CurveBands>) -> Result<(), String> {
    for (curve, widest) in bands.into_iter().flat_map(CurveBands::widest) {
        let stated = summary.band(&format!("{curve}_max")).unwrap_or(widest);
        if (widest - stated).abs() > BAND_ROUNDING * stated.abs() {
            return Err(format!(
                "the uncertainty of {curve} is at most {widest:e}, but {SUMMARY} states {stated:e}"
            ));
        }
    }
    Ok(())
}

/// Text of the checksum file; what tells one version of an entry from the next.
pub(super) fn fingerprint(folder: &Path) -> Option<String> {
    std::fs::read_to_string(folder.join(CHECKSUMS)).ok()
}

/// Hashes of the scene and the settings of the entry in `folder`, if it says what they are; nothing is verified.
pub(super) fn hashes(folder: &Path) -> Option<(String, String)> {
    let provenance: Value = read_json(folder, PROVENANCE).ok()?;
    let hash = |key: &str| {
        let text = provenance[key].as_str()?;
        (text.len() >= 8 && text.bytes().all(|b| b.is_ascii_hexdigit())).then(|| text.to_owned())
    };
    hash("scene_hash").zip(hash("settings_hash"))
}

fn read_json<T: serde::de::DeserializeOwned>(folder: &Path, name: &str) -> Result<T, Damage> {
    serde_json::from_str(&text(folder, name)?)
        .map_err(|e| Damage { file: folder.join(name), reason: format!("is not what is expected: {e}") })
}

fn text(folder: &Path, name: &str) -> Result<String, Damage> {
    let file = folder.join(name);
    std::fs::read_to_string(&file).map_err(|e| Damage { file, reason: format!("can't be read: {e}") })
}

/// That all files that the folder lists are intact, and all that it must have are listed; with `may_lack_fields` files with values on the
/// mesh may be missing.
fn verify(folder: &Path, has_mesh: bool, may_lack_fields: bool) -> Result<(), Damage> {
    let damage = |file: &str, reason: String| Damage { file: folder.join(file), reason };
    let text = std::fs::read_to_string(folder.join(CHECKSUMS))
        .map_err(|e| damage(CHECKSUMS, format!("can't be read: {e}")))?;
    let listed = parse_checksums(&text).map_err(|reason| damage(CHECKSUMS, reason))?;
    let needed = |name: &&&str| has_mesh || **name != MESH;
    if let Some(name) = REQUIRED.iter().filter(needed).find(|name| !listed.contains_key(**name)) {
        return Err(damage(CHECKSUMS, format!("does not list {name}")));
    }
    let is_omitted = |name: &str| may_lack_fields && name.ends_with(".vtu") && !folder.join(name).exists();
    for (name, expected) in listed.into_iter().filter(|(name, _)| !is_omitted(name)) {
        let found =
            sha256_file(&folder.join(name)).map_err(|e| damage(name, format!("can't be read: {e}")))?;
        if !found.eq_ignore_ascii_case(expected) {
            return Err(damage(name, format!("its SHA-256 is {found}, recorded is {expected}")));
        }
    }
    Ok(())
}

/// File names and their checksums from the text of `sha256sum`.
fn parse_checksums(text: &str) -> Result<BTreeMap<&str, &str>, String> {
    let mut listed = BTreeMap::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let malformed = || format!("line {}: `{line}` is not a checksum and a file name", index + 1);
        let (sum, name) = line.split_once(' ').ok_or_else(malformed)?;
        // After one space stands the mode: a space for text, an asterisk for binary.
        let name = name.strip_prefix([' ', '*']).ok_or_else(malformed)?;
        let is_hash = sum.len() == 64 && sum.bytes().all(|b| b.is_ascii_hexdigit());
        // A name that leads elsewhere would make this verify a file of someone else.
        if !is_hash || name.is_empty() || name.starts_with('.') || name.contains(['/', '\\']) {
            return Err(malformed());
        }
        listed.insert(name, sum);
    }
    Ok(listed)
}

fn sha256_file(path: &Path) -> std::io::Result<String> {
    let mut hasher = Sha256::new();
    let mut file = std::fs::File::open(path)?;
    let mut buffer = vec![0; 1 << 16];
    loop {
        let count = std::io::Read::read(&mut file, &mut buffer)?;
        if count == 0 {
            break;
        }
        hasher.update(&buffer[..count]);
    }
    Ok(hasher.finalize().iter().fold(String::new(), |mut text, byte| {
        // Writing into a string can't fail.
        let _ = write!(text, "{byte:02x}");
        text
    }))
}
