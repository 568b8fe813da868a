//! Finds scene files: a path, or the name of a scene the project ships.

use super::project_root;
use crate::{Error, Result};
use impactcheck_physics::scene::unknown_name;
use std::path::{Path, PathBuf};

/// The scene file a command line names: a path, or the name of a shipped scene with or
/// without `.toml`. A path wins over a name.
///
/// # Errors
/// [`Error::Usage`] if there is neither; it lists the shipped scenes. As [`project_root`] if they are needed.
pub fn resolve(argument: &str) -> Result<PathBuf> {
    let (path, file) = (PathBuf::from(argument), PathBuf::from(format!("{argument}.toml")));
    if path.is_file() {
        return Ok(path);
    }
    match project_root() {
        Err(_) if file.is_file() => Ok(file),
        root => resolve_in(&root?.join("scenes"), argument, path, file),
    }
}

/// The scene files the project ships, sorted by name.
///
/// # Errors
/// As [`project_root`]; [`Error::Io`] if the folder `scenes/` can't be read.
pub fn shipped() -> Result<Vec<PathBuf>> {
    scenes_in(&project_root()?.join("scenes"))
}

/// All scene files of the project, those of the folders in `scenes/` too.
///
/// # Errors
/// As [`shipped`].
pub fn every() -> Result<Vec<PathBuf>> {
    let folder = project_root()?.join("scenes");
    let entries = std::fs::read_dir(&folder).map_err(|e| Error::io("reading", &folder, e))?;
    let mut folders: Vec<PathBuf> = entries.flatten().map(|e| e.path()).filter(|p| p.is_dir()).collect();
    folders.sort();
    let mut scenes = scenes_in(&folder)?;
    for folder in folders {
        scenes.extend(scenes_in(&folder)?);
    }
    Ok(scenes)
}

fn resolve_in(folder: &Path, argument: &str, path: PathBuf, file: PathBuf) -> Result<PathBuf> {
    let is_name = !argument.is_empty() && !argument.contains(['/', '\\']);
    for candidate in [format!("{argument}.toml"), argument.to_owned()] {
        let shipped = folder.join(candidate);
        if is_name && shipped.is_file() {
            return Ok(shipped);
        }
    }
    if path.exists() {
        // A folder, a pipe: what it is worth shows when it is read.
        return Ok(path);
    }
    if file.is_file() {
        return Ok(file);
    }
    let shipped = scenes_in(folder).unwrap_or_default();
    let names: Vec<&str> = shipped.iter().filter_map(|p| p.file_stem()?.to_str()).collect();
    let message =
        format!("there is no scene `{argument}`: neither a file nor a name in {}", folder.display());
    Err(unknown_name(message, argument.trim_end_matches(".toml"), &names))
}

fn scenes_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).map_err(|e| Error::io("reading", folder, e))?;
    let mut scenes = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| Error::io("reading", folder, e))?.path();
        if path.extension().is_some_and(|e| e == "toml") && path.is_file() {
            scenes.push(path);
        }
    }
    scenes.sort();
    Ok(scenes)
}
