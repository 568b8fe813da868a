//! What lies in a unit's folder of resources.

use impactcheck_physics::kinds::{FollowedMesh, MeshRequest, set_mesher};
use impactcheck_physics::scene::{Model, Template};
use impactcheck_physics::{Error, Result};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::RwLock;

/// The scene file.
pub const SCENE: &str = "scene.toml";
/// The [`UnitSetup`].
pub const SETUP: &str = "unit.json";
/// The mesh of a seal seat.
pub const SEAT_MESH: &str = "seat.vtu";
/// Folder of the meshes of a body from a file, each under its key.
pub const MESHES: &str = "meshes";

/// Which reduced model a unit runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UnitSetup {
    /// What tells the unit from others: it stands in `modelDescription.xml` too.
    pub token: String,
    /// A, B or C.
    pub model: String,
    /// Number of modes; `None` = the scene's or the model's own.
    pub modes: Option<usize>,
    /// Relative error of the time integration.
    pub tolerance: f64,
}

/// A scene with its reduced model.
#[derive(Debug)]
pub struct UnitSource {
    /// The scene file, open to variation.
    pub template: Template,
    /// See [`UnitSetup`].
    pub setup: UnitSetup,
    /// The model of [`UnitSetup::model`].
    pub model: Model,
    /// The mesh of a seal seat.
    pub mesh: Option<FollowedMesh>,
}

impl UnitSource {
    /// What `resources` holds, a unit's folder. From now on bodies find their meshes there.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::Scene`] and [`Error::Internal`] of files that are missing or damaged.
    pub fn read(resources: &Path) -> Result<Self> {
        let read = |name: &str| {
            let path = resources.join(name);
            std::fs::read_to_string(&path).map_err(|e| Error::io("reading", path, e))
        };
        let setup: UnitSetup = serde_json::from_str(&read(SETUP)?)
            .map_err(|e| Error::Internal(format!("{SETUP} of the unit: {e}")))?;
        offer_meshes(resources.join(MESHES));
        let mesh = resources.join(SEAT_MESH);
        let mesh = mesh.is_file().then(|| FollowedMesh::open(&mesh)).transpose()?;
        let scene = resources.join(SCENE);
        let template = Template::parse(&scene.display().to_string(), &read(SCENE)?)?;
        let model = setup.model.parse().map_err(Error::Internal)?;
        Ok(Self { template, setup, model, mesh })
    }
}

/// Folders of meshes of all units in this process.
static OFFERED: RwLock<Vec<PathBuf>> = RwLock::new(Vec::new());

fn offer_meshes(folder: PathBuf) {
    if let Ok(mut offered) = OFFERED.write()
        && folder.is_dir()
        && !offered.contains(&folder)
    {
        offered.push(folder);
    }
    set_mesher(offered_mesh);
}

fn offered_mesh(request: &MeshRequest) -> Result<PathBuf> {
    let name = format!("{}.vtu", request.key);
    let offered = OFFERED.read().map(|folders| folders.clone()).unwrap_or_default();
    offered.iter().map(|folder| folder.join(&name)).find(|path| path.is_file()).ok_or_else(|| {
        Error::Usage(
            "one of the changed parameters changes the mesh of the body, which the unit does not make: write a unit of the changed scene"
                .into(),
        )
    })
}
