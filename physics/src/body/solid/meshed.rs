//! The mesh of a body as the mesher writes it: quadratic tetrahedra with what is held, and a description of the contacts.

use super::mesh::{MeshFile, TetMesh, unusable};
use super::pressure::SurfacePoint;
use super::struck::{CIRCLES, StruckPoint};
use crate::error::{Error, Result};
use nalgebra::Vector3;
use serde::Deserialize;
use std::path::Path;

/// Largest circle over the thickness of the wall and over the distance to an edge: larger ones see the other side, or leave the face.
const OF_WALL: f64 = 0.5;
const OF_EDGE: f64 = 0.8;

/// A body's mesh.
#[derive(Debug)]
pub struct BodyMesh {
    /// Quadratic tetrahedra, curved where the source is.
    pub mesh: TetMesh,
    /// Which nodes do not move. Shape (nodes).
    pub fixed: Vec<bool>,
    /// Names of the materials; none for a body of one material.
    pub materials: Vec<String>,
    /// Number of each cell's material in that list. Shape (cells), or empty without names.
    pub material_of_cell: Vec<usize>,
}

/// The surface of a body where it is struck.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ContactInfo {
    /// Place on the surface in m.
    pub point: [f64; 3],
    /// Distance in m of the place that the scene names.
    pub distance: f64,
    /// Outward normal of length 1.
    pub normal: [f64; 3],
    /// Principal curvatures in 1/m, positive where the surface is convex.
    pub curvatures: [f64; 2],
    /// Whether these are the CAD's, of a fit to the mesh, or none: the surface is taken as flat.
    pub curvature_source: String,
    /// Size of the elements there in m.
    pub element_size: f64,
    /// Thickness of the wall in m along the normal; infinite if it is not known.
    #[serde(deserialize_with = "or_infinite")]
    pub wall: f64,
    /// Elements through the wall; infinite if that is not known.
    #[serde(deserialize_with = "or_infinite")]
    pub layers: f64,
    /// Distance in m to the nearest edge of the face; infinite where it has none.
    #[serde(deserialize_with = "or_infinite")]
    pub edge_distance: f64,
    /// Name of the material there; `None` for a body of one material.
    pub material: Option<String>,
    /// Distance in m to the nearest other material; infinite where there is none.
    #[serde(default = "infinite", deserialize_with = "or_infinite")]
    pub material_distance: f64,
}

/// What models need of the description of a mesh.
#[derive(Deserialize)]
struct BodyMeshInfo {
    bounding_box: [[f64; 3]; 2],
    /// Size of the elements over those of the body's own mesh.
    size_factor: f64,
    contacts: Contacts,
    materials: Vec<String>,
}

/// Where outer and inner body strike.
#[derive(Deserialize)]
struct Contacts {
    outer: ContactInfo,
    inner: Option<ContactInfo>,
}

fn infinite() -> f64 {
    f64::INFINITY
}

fn or_infinite<'de, D: serde::Deserializer<'de>>(value: D) -> std::result::Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(value)?.unwrap_or_else(infinite))
}

impl BodyMesh {
    /// Reads the mesh in a `.vtu` file.
    ///
    /// # Errors
    /// [`Error::Solver`] if it can't be read or is unusable.
    pub fn read(path: &Path) -> Result<Self> {
        let file = MeshFile::read(path)?;
        let missing = || unusable(path, "has no array `fixed` of its nodes");
        let fixed = file.point_array("fixed").ok_or_else(missing)?.iter().map(|value| *value != 0).collect();
        let materials = description(path)?.materials;
        let numbers = file.cell_array("material").filter(|_| !materials.is_empty());
        let material_of_cell: Vec<usize> = numbers.unwrap_or_default().iter().map(|n| *n as usize).collect();
        let mesh = TetMesh::curved(file.points, file.cells).map_err(|what| unusable(path, &what))?;
        let expected = if materials.is_empty() { 0 } else { mesh.cells().len() };
        if material_of_cell.len() != expected || material_of_cell.iter().any(|own| *own >= materials.len()) {
            return Err(unusable(path, "has cells whose material is not described"));
        }
        Ok(Self { mesh, fixed, materials, material_of_cell })
    }

    /// Size of the elements over those of the body's own mesh, as the description of the mesh file at `path` has it.
    ///
    /// # Errors
    /// [`Error::Solver`] if it can't be read.
    pub fn size_factor(path: &Path) -> Result<f64> {
        Ok(description(path)?.size_factor)
    }

    /// Lengths in m of the box around the body, as the description of the mesh file at `path` has it.
    ///
    /// # Errors
    /// [`Error::Solver`] if it can't be read.
    pub fn lengths(path: &Path) -> Result<[f64; 3]> {
        let [least, most] = description(path)?.bounding_box;
        Ok([0, 1, 2].map(|c| most[c] - least[c]))
    }

    /// The contacts that the description of the mesh file at `path` names: that of the outer body, and of the inner one if it has one.
    ///
    /// # Errors
    /// [`Error::Solver`] if it can't be read.
    pub fn contacts(path: &Path) -> Result<Vec<ContactInfo>> {
        let Contacts { outer, inner } = description(path)?.contacts;
        Ok([Some(outer), inner].into_iter().flatten().collect())
    }
}

/// The description of the mesh file at `path`.
fn description(path: &Path) -> Result<BodyMeshInfo> {
    let path = path.with_extension("json");
    let text = std::fs::read_to_string(&path).map_err(|e| Error::io("reading", &path, e))?;
    serde_json::from_str(&text).map_err(|e| unusable(&path, &format!("is no description of a mesh: {e}")))
}

impl ContactInfo {
    /// The place, and the circles on which the flexibility is found.
    pub fn struck(&self) -> StruckPoint {
        let largest = CIRCLES[2] * self.element_size;
        let bound = (OF_WALL * self.wall.min(self.material_distance)).min(OF_EDGE * self.edge_distance);
        let scale = (bound / largest).min(1.0);
        StruckPoint {
            at: SurfacePoint { point: Vector3::from(self.point), normal: Vector3::from(self.normal) },
            circles: CIRCLES.map(|circle| scale * circle * self.element_size),
            rubs: false,
        }
    }

    /// Largest circle over that which the mesh would resolve well; below 1 the elements are too large for the wall or the face.
    pub fn resolution(&self) -> f64 {
        self.struck().circles[2] / (CIRCLES[2] * self.element_size)
    }
}
