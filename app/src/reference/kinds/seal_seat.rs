//! Meshes of seal seats: files made by `fem_reference`, each with a description that says what it is a mesh of.

use super::{mesh_with, replaceable};
use crate::body::cache::Cache;
use crate::interrupt::Scratch;
use crate::kinds::seal_seat::SeatMesh;
use crate::project::project_root;
use crate::reference::{Progress, Resolution, identity, python};
use crate::scene::Scene;
use crate::scene::hash::sha256_hex;
use crate::{Error, Result};
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::path::{Path, PathBuf};

/// What stands beside a mesh file, under its name with the ending `.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeatMeshInfo {
    /// [`SealSeat::geometry_hash`](crate::kinds::seal_seat::SealSeat::geometry_hash) of the scene it was made for.
    pub geometry_hash: String,
    /// SHA-256 (hexadecimal) of the mesh file.
    pub sha256: String,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of degrees of freedom, supports included.
    pub dofs: usize,
    /// Number of tetrahedra.
    pub elements: usize,
    /// 1 linear, 2 quadratic.
    pub element_order: usize,
    /// Least quality of an element (mean ratio; 1 = regular).
    pub min_quality: f64,
    /// Mean quality of the elements.
    pub mean_quality: f64,
}

/// The mesh files (`.vtu`) in `folder` that are intact and made for the geometry of `scene`, by name.
///
/// # Errors
/// [`Error::Scene`] if it is no seal seat, [`Error::Io`] if the folder can't be read.
pub fn seat_meshes(folder: &Path, scene: &Scene) -> Result<Vec<(PathBuf, SeatMeshInfo)>> {
    let hash = scene.seal_seat()?.geometry_hash();
    let entries = std::fs::read_dir(folder).map_err(|e| Error::io("reading", folder, e))?;
    let mut found = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| Error::io("reading", folder, e))?.path();
        // What has no description, or another one's, is not a mesh of this scene.
        if path.extension().is_some_and(|e| e == "vtu")
            && let Some(info) = intact(&path)
            && info.geometry_hash == hash
        {
            found.push((path, info));
        }
    }
    found.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(found)
}

/// A mesh for the seat of `scene`: at `paper` resolution `meshes/<name>.vtu` or another one in `meshes/` that is made for
/// its geometry, else one in `cache`, else one that `fem_reference` makes now and that stays in `cache`.
///
/// # Errors
/// [`Error::Scene`] if it is no seal seat, [`Error::Solver`] if there is none and none can be made.
pub fn seat_mesh(scene: &Scene, resolution: Resolution, cache: &Cache) -> Result<PathBuf> {
    seat_mesh_with(scene, resolution, cache, &mut |_| {})
}

/// As [`seat_mesh`], telling when a mesh has to be made.
///
/// # Errors
/// As [`seat_mesh`].
pub fn seat_mesh_with(
    scene: &Scene,
    resolution: Resolution,
    cache: &Cache,
    progress: &mut dyn FnMut(&Progress),
) -> Result<PathBuf> {
    let shipped = project_root().map(|root| root.join("meshes"));
    let found = match shipped {
        Ok(shipped) if resolution == Resolution::Paper && shipped.is_dir() => seat_meshes(&shipped, scene)?,
        _ => Vec::new(),
    };
    let of_that_name = |path: &Path| path.file_stem().is_some_and(|stem| *stem == *scene.name);
    let best = found.iter().find(|(path, _)| of_that_name(path)).or(found.first());
    if let Some((path, _)) = best {
        return Ok(path.clone());
    }
    let settings = &scene.reference;
    let fineness = json!([resolution, settings.elements_per_ring_radius, settings.element_order]).to_string();
    let name = sha256_hex(format!("{}{fineness}", scene.seal_seat()?.geometry_hash()).as_bytes());
    let folder = cache.folder().map_or_else(|| std::env::temp_dir().join("impactcheck"), Path::to_path_buf);
    let folder = folder.join("meshes");
    let path = folder.join(format!("{name}.vtu"));
    if intact(&path).is_none() {
        let writing = |e| Error::io("writing", &path, e);
        std::fs::create_dir_all(&folder).map_err(writing)?;
        // other processes may make the same mesh at the same time
        let own = Scratch::new_in(&folder, ".making-").map_err(writing)?;
        let made = own.path().join("mesh.vtu");
        progress(&Progress { phase: "mesh".into(), done: 0.0, message: "gmsh".into(), series: None });
        make_seat_mesh(&python::python()?, scene, resolution, 1.0, &made)?;
        for extension in ["json", "vtu"] {
            std::fs::rename(made.with_extension(extension), path.with_extension(extension))
                .map_err(writing)?;
        }
    }
    Ok(path)
}

/// The mesh of the seal seat of `scene` that is to follow its dimensions in a series of launches: the file at `path`, else a coarse one
/// as by [`seat_mesh`], or, where none can be made, the one there is. None of other scenes.
///
/// # Errors
/// [`Error::Usage`] for the mesh of a scene that is no seal seat, else as [`seat_mesh`] and [`SeatMesh::open`].
pub fn mesh_to_follow(scene: &Scene, path: Option<&Path>) -> Result<Option<SeatMesh>> {
    if scene.seal_seat().is_err() {
        return match path {
            Some(path) => Err(Error::Usage(format!(
                "mesh {}: scene `{}` is no seal seat; the models of plates make their own meshes",
                path.display(),
                scene.name
            ))),
            None => Ok(None),
        };
    }
    let cache = Cache::from_environment();
    let of = |resolution| seat_mesh(scene, resolution, &cache);
    let made = || of(Resolution::Coarse).or_else(|_| of(Resolution::Paper));
    let path = path.map_or_else(made, |path| Ok(path.to_path_buf()))?;
    SeatMesh::open(&path).map(Some)
}

/// What the file beside the mesh file at `path` describes, if it is a description.
fn described(path: &Path) -> Option<SeatMeshInfo> {
    let text = std::fs::read_to_string(path.with_extension("json")).ok()?;
    serde_json::from_str(&text).ok()
}

/// The description of the mesh file at `path`, if both are there and belong together.
fn intact(path: &Path) -> Option<SeatMeshInfo> {
    let info = described(path)?;
    let bytes = std::fs::read(path).ok()?;
    (sha256_hex(&bytes) == info.sha256).then_some(info)
}

/// Meshes the seat of `scene` and writes `out` (`.vtu`) and its description; `size_factor` enlarges all elements.
/// `python` is the interpreter, see [`crate::reference::python`].
///
/// # Errors
/// [`Error::Scene`] if it is no seal seat, [`Error::Usage`] if `out` is no `.vtu` file or a file of the user's would be
/// replaced, [`Error::Solver`] if meshing fails, [`Error::Io`] if no temporary file can be written.
pub fn make_seat_mesh(
    python: &Path,
    scene: &Scene,
    resolution: Resolution,
    size_factor: f64,
    out: &Path,
) -> Result<SeatMeshInfo> {
    scene.seal_seat()?;
    let out = replaceable(out)?;
    let document = identity::solver_document(scene, resolution)?;
    let options = ["--resolution", resolution.first()];
    let failed = |why: &str| Error::Solver(format!("meshing the seat of `{}`: {why}", scene.name));
    mesh_with(python, &document, &options, size_factor, &out).map_err(|why| failed(&why.message))?;
    intact(&out).ok_or_else(|| failed("it wrote no mesh with its description"))
}
