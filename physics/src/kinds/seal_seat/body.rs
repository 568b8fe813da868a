//! The seat as an elastic body: its mesh, supports, modes and flexibility, through the cache on disk.

use super::SealSeat;
use super::candidates::{Candidate, Zones, candidates};
use crate::body::cache::Cache;
use crate::body::solid::{InterfaceBody, Solid, TetMesh};
use crate::error::{Error, Result};
use crate::scene::hash::{drop_inelastic, sha256_hex};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Number of the method that makes the body, part of every key: raise it when one comes out otherwise.
const REVISION: u32 = 1;
/// How far from the rim, over the membrane's radius, the corners of a face of the rim may lie; the reference's bound.
const ON_RIM: f64 = 1e-6;
/// How far from the plane of symmetry, over the membrane's radius, its nodes may lie.
const ON_PLANE: f64 = 1e-9;

/// Gets what is being done and the share of the whole that is done before it, 0 to 1.
pub type Watch<'a> = dyn FnMut(&'static str, f64) + 'a;

/// How a mesh file says, in an XML comment, which geometry it is one of.
const GEOMETRY: &str = "<!--geometry_hash ";

/// A mesh file of the half seat, read once.
#[derive(Debug, Clone)]
pub struct SeatMesh {
    path: PathBuf,
    content_hash: String,
    geometry_hash: Option<String>,
    /// Its nodes and elements, if they are known without the file, or have been moved.
    nodes: Option<Arc<TetMesh>>,
}

/// Half a seat, seen from its contact candidates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeatBody {
    /// Modes and flexibility.
    pub body: InterfaceBody,
    /// Nodes of the interface.
    pub candidates: Vec<Candidate>,
    /// Nodes of the mesh.
    pub nodes: usize,
    /// Degrees of freedom of the mesh without those that supports hold.
    pub dofs: usize,
}

impl SeatMesh {
    /// The mesh in a `.vtu` file.
    ///
    /// # Errors
    /// [`Error::Io`] if the file can't be read.
    pub fn open(path: &Path) -> Result<Self> {
        let content = std::fs::read(path).map_err(|e| Error::io("reading", path, e))?;
        Ok(Self {
            path: path.to_path_buf(),
            content_hash: sha256_hex(&content),
            geometry_hash: recorded_geometry(&content),
            nodes: None,
        })
    }

    /// The mesh with the `content` of a `.vtu` file, which messages call `name`.
    ///
    /// # Errors
    /// As [`TetMesh::read`].
    pub fn parse(name: &str, content: &[u8]) -> Result<Self> {
        let path = PathBuf::from(name);
        let nodes = TetMesh::parse(&path, content)?;
        Ok(Self {
            path,
            content_hash: sha256_hex(content),
            geometry_hash: recorded_geometry(content),
            nodes: Some(Arc::new(nodes)),
        })
    }

    /// The nodes and elements.
    ///
    /// # Errors
    /// As [`TetMesh::read`].
    pub(super) fn read(&self) -> Result<Arc<TetMesh>> {
        self.nodes.clone().map_or_else(|| TetMesh::read(&self.path).map(Arc::new), Ok)
    }

    /// The same with its nodes at those of `mesh`, which is one of the seat of `scene`.
    pub(super) fn moved_to(&self, mesh: TetMesh, scene: &SealSeat) -> Self {
        let geometry = scene.geometry_hash();
        Self {
            path: self.path.clone(),
            content_hash: sha256_hex(format!("{}{geometry}", self.content_hash).as_bytes()),
            geometry_hash: Some(geometry),
            nodes: Some(Arc::new(mesh)),
        }
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// SHA-256 of the file and of where its nodes have been moved to.
    pub fn content_hash(&self) -> &str {
        &self.content_hash
    }

    /// [`SealSeat::geometry_hash`] of the scene it was made for, if the file says so: files from elsewhere do not.
    pub fn geometry_hash(&self) -> Option<&str> {
        self.geometry_hash.as_deref()
    }

    /// The seat of `scene` with `modes` modes and the contact candidates in `zones`, from `cache` or computed.
    ///
    /// # Errors
    /// [`Error::Solver`] if the mesh is unusable or not one of this scene, or the modes do not converge.
    pub fn body(&self, scene: &SealSeat, zones: &Zones, modes: usize, cache: &Cache) -> Result<SeatBody> {
        self.body_with(scene, zones, modes, cache, &mut |_, _| {})
    }

    /// As [`SeatMesh::body`], telling how far it is.
    ///
    /// # Errors
    /// As [`SeatMesh::body`].
    pub fn body_with(
        &self,
        scene: &SealSeat,
        zones: &Zones,
        modes: usize,
        cache: &Cache,
        watch: &mut Watch,
    ) -> Result<SeatBody> {
        if self.geometry_hash().is_some_and(|hash| hash != scene.geometry_hash()) {
            return Err(self.of_another("it was made for another geometry of seat, sphere or tips"));
        }
        let mut inputs = json!({
            "body": "seal seat", "revision": REVISION, "mesh": self.content_hash, "zones": zones, "modes": modes,
            "seat": scene.seat, "ring": [scene.sphere.radius], "tips": scene.actuator.tip_positions,
        });
        drop_inelastic(&mut inputs);
        cache.get_or_build(&inputs, || self.build(scene, zones, modes, watch))
    }

    fn of_another(&self, why: &str) -> Error {
        Error::Solver(format!("mesh {} is not one of this seat: {why}", self.path.display()))
    }

    /// Shares of the time before each part are those of a mesh with 30 000 degrees of freedom.
    fn build(&self, scene: &SealSeat, zones: &Zones, modes: usize, watch: &mut Watch) -> Result<SeatBody> {
        watch("reading the mesh", 0.0);
        let mesh = self.read()?;
        let fixed = supports(scene, &mesh);
        if !fixed.contains(&[true; 3]) {
            return Err(self.of_another("it has no face on the rim of the membrane"));
        }
        let candidates = candidates(scene, &mesh, zones);
        if !candidates.iter().any(|c| c.contact_body == super::ContactBody::Sphere) {
            return Err(self.of_another("it has no node on the contact ring"));
        }
        for (tip, x) in scene.actuator.tip_positions.iter().enumerate() {
            if !candidates.iter().any(|c| c.contact_body == super::ContactBody::Tip(tip)) {
                return Err(self.of_another(&format!("it has no node under the tip at x = {x} m")));
            }
        }
        let interface: Vec<usize> = candidates.iter().map(|c| c.node).collect();
        watch("assembly and factorisation", 0.05);
        let solid = Solid::new(&mesh, &scene.seat.material, &fixed, &interface)?;
        watch("modes and flexibility", 0.6);
        Ok(SeatBody {
            body: solid.at_interface(modes)?,
            candidates,
            nodes: mesh.points.len(),
            dofs: solid.size(),
        })
    }
}

/// What the comment in a mesh file says.
fn recorded_geometry(content: &[u8]) -> Option<String> {
    let at = content.windows(GEOMETRY.len()).position(|part| part == GEOMETRY.as_bytes())?;
    let hash = content[at + GEOMETRY.len()..].split(|byte| *byte == b'-').next()?;
    Some(String::from_utf8_lossy(hash).into_owned())
}

/// Which of (u_x, u_y, u_z) of each node are held: all on the membrane's rim, u_y in the plane of symmetry y = 0.
pub fn supports(scene: &SealSeat, mesh: &TetMesh) -> Vec<[bool; 3]> {
    let radius = scene.seat.membrane_radius;
    let in_plane = |p: &Vector3<f64>| p.y.abs() <= ON_PLANE * radius;
    let mut fixed: Vec<[bool; 3]> = mesh.points.iter().map(|p| [false, in_plane(p), false]).collect();
    for face in mesh.outer_faces() {
        let on_rim = |&node: &usize| {
            let p = mesh.points[node];
            (p.x.hypot(p.y) - radius).abs() < ON_RIM * radius
        };
        if face[..3].iter().all(on_rim) {
            face.iter().for_each(|&node| fixed[node] = [true; 3]);
        }
    }
    fixed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Of a seat of [`REVISION`] 1: candidates, mass in kg, three eigenfrequencies in rad/s, flexibilities of the interface in m/N.
    const BODY: [f64; 7] = [
        89.0,
        0.0003952800889852828,
        28234.638148838465,
        73561.94137107157,
        87603.3064687895,
        1.2810002752283442e-5,
        0.06964103400591362,
    ];

    #[test]
    fn a_seat_that_comes_out_otherwise_has_a_new_revision() {
        let fixture = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures").join(name);
        let scene = Scene::read(fixture("seal-seat.toml")).unwrap();
        let setup = scene.seal_seat().unwrap();
        let mesh = SeatMesh::open(&fixture("seal-seat-improved-coarse.vtu")).unwrap();
        let SeatBody { body, candidates, .. } =
            mesh.body(setup, &Zones::expected(setup), 3, &Cache::off()).unwrap();
        let all: f64 = body.flexibility.iter().map(|value| value.abs()).sum();
        let mut found = vec![candidates.len() as f64, body.mass];
        found.extend(&body.omega[..3]);
        found.extend([body.flexibility[0], all]);
        let same = |(found, known): (&f64, &f64)| (found / known - 1.0).abs() < 1e-6;
        assert!(
            found.iter().zip(&BODY).all(same),
            "raise REVISION, and put here what its body comes to: {found:?}"
        );
    }
}
