//! The files that validations are kept in: one beside the solutions of each store.

use super::{PROGRAM, SAME_SINCE, Validation};
use crate::ci::json_lines;
use crate::error::Result;
use crate::reference::Store;
use std::path::PathBuf;

const FILE: &str = "validated.jsonl";

/// The validations that the project brings along, of its own scenes. What is in the file is compared with scenes, models and
/// stored references by the project's tests.
///
/// # Errors
/// If there is no project, or its file can't be read.
pub fn shipped() -> Result<Vec<Validation>> {
    json_lines::read(&file(&Store::shipped()?))
}

/// Keeps `new` among the validations that the project brings along.
///
/// # Errors
/// If there is no project, or its file can't be read or written.
pub fn record(new: &[Validation]) -> Result<()> {
    let mut known = shipped()?;
    merge(&mut known, new);
    json_lines::write(&file(&Store::shipped()?), &known)
}

/// The validations kept in `store` by this version of the program with a method of the reference that gives the same.
///
/// # Errors
/// If the file can't be read.
pub fn of_store(store: &Store) -> Result<Vec<Validation>> {
    let mut current: Vec<Validation> = json_lines::read(&file(store))?;
    current.retain(|v| v.program == PROGRAM && v.revision >= SAME_SINCE);
    Ok(current)
}

/// Keeps `new` in `store`.
///
/// # Errors
/// If the file can't be read or written.
pub fn update(store: &Store, new: &[Validation]) -> Result<()> {
    let before = of_store(store)?;
    let mut after = before.clone();
    merge(&mut after, new);
    if before == after { Ok(()) } else { json_lines::write(&file(store), &after) }
}

/// Puts `new` in the places of what is known of the same scenes and models, unless that is of the same scene on a finer mesh.
pub fn merge(known: &mut Vec<Validation>, new: &[Validation]) {
    for validation in new {
        match known.iter_mut().find(|other| other.is_of_same(validation)) {
            Some(old) if old.scene_hash == validation.scene_hash && old.dofs > validation.dofs => {}
            Some(old) => *old = validation.clone(),
            None => known.push(validation.clone()),
        }
    }
    known.sort_by(|a, b| (&a.scene, &a.model).cmp(&(&b.scene, &b.model)));
}

fn file(store: &Store) -> PathBuf {
    store.root().join(FILE)
}
