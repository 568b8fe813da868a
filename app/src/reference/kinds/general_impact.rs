//! Meshes of bodies whose shape is in a file, in the cache of meshes.

use super::{Refused, mesh_with, run_to_end};
use crate::body::cache::Cache;
use crate::interrupt::Scratch;
use crate::kinds::general_impact::{self, GeneralImpact, MeshRequest, set_mesher};
use crate::reference::python;
use crate::scene::hash::sha256_hex;
use crate::{Error, Result};
use serde::Deserialize;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// From now on models of bodies from files make their meshes, as a program that runs them has to say at its start.
pub fn mesh_bodies() {
    set_mesher(body_mesh);
}

/// Factors on the sizes of elements that the mesher takes.
const SIZE_FACTORS: std::ops::RangeInclusive<f64> = 0.25..=10.0;

/// What a mesh's description says of its file.
#[derive(Deserialize)]
struct Description {
    sha256: String,
}

/// The mesh that `request` wants: the one in the cache, or one that `fem_reference` makes now and that stays there.
///
/// # Errors
/// [`Error::Scene`] if the body or its contacts are at fault, [`Error::Solver`] if meshing fails, [`Error::Io`] if the cache can't be written.
pub fn body_mesh(request: &MeshRequest) -> Result<PathBuf> {
    let folder = Cache::from_environment()
        .folder()
        .map_or_else(|| std::env::temp_dir().join("impactcheck"), Path::to_path_buf);
    let folder = folder.join("meshes");
    let path = folder.join(format!("{}.vtu", request.key));
    if is_intact(&path) {
        return Ok(path);
    }
    let writing = |e| Error::io("writing", &path, e);
    std::fs::create_dir_all(&folder).map_err(writing)?;
    // other processes may make the same mesh at the same time
    let own = Scratch::new_in(&folder, ".making-").map_err(writing)?;
    let made = own.path().join("mesh.vtu");
    mesh_with(&python::mesher()?, &request.document, &[], request.factor, &made).map_err(Refused::error)?;
    if !is_intact(&made) {
        return Err(Error::Solver("the mesher wrote no mesh with its description".into()));
    }
    if let Some((file, content)) = &request.file
        && general_impact::content(file).ok().as_ref() != Some(content)
    {
        return Err(Error::Scene(miette::miette!(
            "`body.file` changed while {} was meshed: run again",
            file.display()
        )));
    }
    for extension in ["json", "vtu"] {
        std::fs::rename(made.with_extension(extension), path.with_extension(extension)).map_err(writing)?;
    }
    Ok(path)
}

/// Meshes the body of `setup` into `out`; its description.
pub(super) fn make_body_mesh(setup: &GeneralImpact, size_factor: f64, out: &Path) -> Result<Value> {
    let body = setup.body().ok_or_else(|| {
        Error::Usage("the scene has no [body]: a mesh is made of a body from a file alone".into())
    })?;
    if !SIZE_FACTORS.contains(&size_factor) {
        let [least, most] = [SIZE_FACTORS.start(), SIZE_FACTORS.end()];
        return Err(Error::Usage(format!(
            "--size-factor {size_factor} of a body has to lie between {least} and {most}"
        )));
    }
    let request = body.mesh_request(size_factor);
    mesh_with(&python::mesher()?, &request.document, &[], size_factor, out).map_err(Refused::error)?;
    let text =
        std::fs::read_to_string(out.with_extension("json")).map_err(|e| Error::io("reading", out, e))?;
    serde_json::from_str(&text).map_err(|e| Error::Internal(format!("the mesh's description: {e}")))
}

/// The groups, sets and faces of a file with its bounding box, as `fem_reference` lists them; `unit` is its unit of length.
///
/// # Errors
/// As [`body_mesh`].
pub fn body_groups(file: &Path, unit: Option<&str>) -> Result<Value> {
    let python = python::mesher()?;
    let mut command = python::fem_reference(&python)?;
    // it runs in the project's folder
    command.arg("groups").arg(std::path::absolute(file).map_err(|e| Error::io("finding", file, e))?);
    command.args(unit.into_iter().flat_map(|unit| ["--unit", unit]));
    let folder = std::env::temp_dir();
    let folder =
        Scratch::new_in(&folder, "impactcheck-").map_err(|e| Error::io("writing into", &folder, e))?;
    let list = folder.path().join("groups.json");
    run_to_end(command.arg("--out").arg(&list), &python)?;
    let text = std::fs::read_to_string(&list).map_err(|e| Error::io("reading", &list, e))?;
    serde_json::from_str(&text).map_err(|e| Error::Internal(format!("the list of groups: {e}")))
}

/// Whether the mesh file at `path` and its description are there and belong together.
fn is_intact(path: &Path) -> bool {
    let described = std::fs::read_to_string(path.with_extension("json")).ok();
    let described = described.and_then(|text| serde_json::from_str::<Description>(&text).ok());
    let found = std::fs::read(path).ok().map(|bytes| sha256_hex(&bytes));
    described.zip(found).is_some_and(|(described, found)| described.sha256 == found)
}
