//! Accepted changes of tolerances and references, with the reason: JSON lines beside the scene file.
//!
//! A reference that was accepted once is what a new one is compared with: if the new one differs by more than the 95 %
//! bands of both, the gate fails until somebody says why.

use super::json_lines;
use crate::comparison::{Check, Verdict};
use crate::error::Result;
use crate::reference::Resolution;
use crate::result::{Quantity, Summary};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What the names of these checks begin with.
pub const CHECK: &str = "accepted_reference";
/// Relative difference that a quantity without a band may have.
const WITHOUT_BAND: f64 = 1e-3;

/// Tolerances as TOML, by model and quantity.
pub type Standing = BTreeMap<String, BTreeMap<String, String>>;

/// One accepted change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Acceptance {
    /// Day (UTC), ISO 8601.
    pub date: String,
    /// Why.
    pub reason: String,
    /// Tolerances that were changed.
    #[serde(default)]
    pub tolerances: Vec<ToleranceChange>,
    /// The reference at that time.
    pub reference: AcceptedReference,
    /// All tolerances after the change; empty in records of earlier versions.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub standing: Standing,
}

/// One tolerance, as it stands in the scene file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ToleranceChange {
    /// Name of the reduced model.
    pub model: String,
    /// Name of the quantity.
    pub quantity: String,
    /// TOML before.
    pub from: String,
    /// TOML after.
    pub to: String,
}

/// What identifies a reference and tells whether another one says the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AcceptedReference {
    /// Hash of the scene it solves.
    pub scene_hash: String,
    /// Its resolution.
    pub resolution: String,
    /// Values in SI units, and half widths of their 95 % bands where they are known.
    pub quantities: BTreeMap<String, (f64, Option<f64>)>,
}

impl AcceptedReference {
    /// Of this reference.
    pub fn of(reference: &Summary, resolution: Resolution) -> Self {
        let entry = |&Quantity { name, value, .. }: &Quantity| {
            Some((name.to_owned(), (value.filter(|v| v.is_finite())?, reference.band(name))))
        };
        AcceptedReference {
            scene_hash: reference.scene_hash.clone(),
            resolution: resolution.to_string(),
            quantities: reference.quantities.iter().filter_map(entry).collect(),
        }
    }
}

/// The file with the accepted changes of the scene in `scene_file`.
pub fn record_of(scene_file: &Path) -> PathBuf {
    scene_file.with_extension("accepted.jsonl")
}

/// The accepted changes of a scene, oldest first.
///
/// # Errors
/// If the record can't be read; names the line.
pub fn read(scene_file: &Path) -> Result<Vec<Acceptance>> {
    json_lines::read(&record_of(scene_file))
}

/// Adds `acceptance` to the record of a scene.
///
/// # Errors
/// If the record can't be read or written.
pub fn add(scene_file: &Path, acceptance: Acceptance) -> Result<()> {
    let mut record = read(scene_file)?;
    record.push(acceptance);
    json_lines::write(&record_of(scene_file), &record)
}

/// Today (UTC), ISO 8601.
pub fn today() -> String {
    chrono::Utc::now().format("%Y-%m-%d").to_string()
}

/// Whether `reference` says what the one accepted last for the same scene and resolution says, quantity by quantity;
/// no check if none was accepted.
pub fn checks(record: &[Acceptance], reference: &Summary, resolution: Resolution) -> Vec<Check> {
    let now = AcceptedReference::of(reference, resolution);
    let same = |a: &&AcceptedReference| a.scene_hash == now.scene_hash && a.resolution == now.resolution;
    let Some(accepted) = record.iter().rev().map(|a| &a.reference).find(same) else { return Vec::new() };
    let check = |(name, (expected, old)): (&String, &(f64, Option<f64>))| {
        let (found, new) = now.quantities.get(name).copied().unwrap_or((f64::NAN, None));
        let bound = match (old, new) {
            (Some(old), Some(new)) => old.hypot(new),
            _ => WITHOUT_BAND * expected.abs(),
        };
        let unit = reference.quantities.get(name).map_or("1", |quantity| quantity.unit);
        Check {
            check: format!("{CHECK}_{name}"),
            unit: unit.to_owned(),
            found,
            expected: *expected,
            bound,
            verdict: Verdict::of((found - expected).abs() <= bound),
        }
    };
    accepted.quantities.iter().map(check).collect()
}
