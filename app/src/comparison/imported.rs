//! Results of other programs as references: only those that contradict neither themselves nor their scene.

use super::contradictions;
use crate::error::{Error, Result};
use crate::reference::{Store, Stored, read_import};
use crate::scene::Scene;
use std::path::Path;

/// Puts the result in `file` into `store` as the imported reference of `scene`; `map` says how it is to be read.
///
/// # Errors
/// [`Error::Io`] if a file can't be read or written, [`Error::Reference`] if it can't be used: the file, line or column at
/// fault, or what the result contradicts: a wrong unit, sign or column.
pub fn import(scene: &Scene, file: &Path, map: Option<&Path>, store: &Store) -> Result<Stored> {
    let imported = read_import(scene, file, map)?;
    let broken = contradictions(scene, &imported.outcome);
    if broken.is_empty() {
        return imported.install(scene, store);
    }
    Err(Error::Reference(format!(
        "{} contradicts the scene or itself, and nothing is stored; check columns, units, signs and offsets\n  {}",
        file.display(),
        broken.join("\n  ")
    )))
}
