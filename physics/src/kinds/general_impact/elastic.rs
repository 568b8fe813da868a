//! The struck body's reduced form, from its mesh and from another one that shows what the mesh changes.

use super::body::{Body, MeshRequest, announce, mesh};
use crate::body::ModalBody;
use crate::body::cache::Cache;
use crate::body::memo::MemoList;
use crate::body::solid::{self, BodyMesh, BodyView, CellMaterials, ContactInfo, StruckPoint, StruckSolid};
use crate::contact::{EffectiveSphere, effective_sphere};
use crate::error::{Error, Result};
use crate::material::Material;
use crate::scene::hash::sha256_hex;
use serde_json::json;
use std::path::Path;
use std::sync::LazyLock;

/// Number of the method that reduces bodies, part of every key: raise it when one comes out otherwise.
const REVISION: u32 = 4;
/// Elements of the other mesh over those of the body's own; where the mesher can't tell the error by it, it makes them half as large.
const COARSER: f64 = 2.0;
/// Error of a mesh over the change to one with elements twice as large: 1/(2^p - 1) with the order p = 1.6. On nine meshes of a plate,
/// whose edge is singular, p was 1.8 to 3.3: the error is rather stated too large.
const OF_COARSER: f64 = 0.5;
/// The same of one with elements half as large: 1/(2^-p - 1).
const OF_FINER: f64 = -(1.0 + OF_COARSER);
/// Endings of files that know their unit.
const CAD: [&str; 5] = ["step", "stp", "brep", "iges", "igs"];
/// Area of the circle over that of an ellipse from which on there is a warning.
const ELLIPTIC: f64 = 1.05;
/// Layers of elements through the wall below which frequencies are some tenths of a per cent too high.
const LAYERS: f64 = 2.0;
/// Contact patches that an edge has to be away, at least.
const FROM_EDGE: f64 = 3.0;
/// Largest patch over the thickness of the wall that was compared with models of plates.
const OF_WALL: f64 = 0.5;
/// Largest circle over that which the mesh would resolve well, below which there is a warning.
const RESOLVED: f64 = 0.7;

/// What another mesh of a body gives.
#[derive(Debug, Clone)]
pub struct OnOtherMesh<T> {
    /// What it gives.
    pub found: T,
    /// Error by the body's own mesh over the change to it.
    pub share: f64,
}

impl<T> OnOtherMesh<T> {
    /// What follows from it.
    pub(in crate::kinds) fn map<U>(self, of: impl FnOnce(T) -> U) -> OnOtherMesh<U> {
        OnOtherMesh { found: of(self.found), share: self.share }
    }
}

/// A body reduced on its mesh, and on another one if there is one.
#[derive(Debug, Clone)]
pub(super) struct ElasticBody {
    pub(super) own: StruckSolid,
    pub(super) other: Option<OnOtherMesh<StruckSolid>>,
    /// Where outer and, if there is one, inner body strike.
    pub(super) contacts: Vec<ContactInfo>,
    /// What the user has to know of them.
    pub(super) warnings: Vec<String>,
    /// Whether its modes follow friction too.
    pub(super) rubs: bool,
}

/// What a reduced body depends on: the key of its mesh, its materials without a common factor on Young's moduli and densities, which
/// scales it, and whether friction acts.
type ReducedKey = (String, Vec<[f64; 3]>, bool);

/// Bodies that this process has reduced: a sweep over speeds, masses and moduli needs one.
static REDUCED: LazyLock<MemoList<(ReducedKey, ElasticBody)>> = LazyLock::new(MemoList::default);

fn reduced_key(body: &Body, rubs: bool) -> ReducedKey {
    (body.mesh_request(1.0).key, ratios(body), rubs)
}

/// The meshes that `body` is reduced on: its own, and another one for the error by the mesh.
pub(super) fn mesh_requests(body: &Body) -> Vec<MeshRequest> {
    vec![body.mesh_request(1.0), body.mesh_request(COARSER)]
}

impl ElasticBody {
    /// Of `body`, on which friction acts if it `rubs`.
    ///
    /// # Errors
    /// Those of the mesher, [`Error::Solver`] for a mesh that is of no use.
    pub(super) fn new(body: &Body, rubs: bool) -> Result<Self> {
        let key = reduced_key(body, rubs);
        let found =
            REDUCED.find_or(|(own, _)| *own == key, || Ok((key.clone(), Self::build(body, rubs)?)))?;
        Ok(found.1.clone())
    }

    /// The same if this process has reduced it.
    pub(super) fn known(body: &Body, rubs: bool) -> Option<Self> {
        let key = reduced_key(body, rubs);
        REDUCED.all().iter().find(|entry| entry.0 == key).map(|entry| entry.1.clone())
    }

    fn build(body: &Body, rubs: bool) -> Result<Self> {
        let path = mesh(&body.mesh_request(1.0))?;
        let contacts = BodyMesh::contacts(&path)?;
        let own = reduced(body, &path, &contacts, rubs)?;
        let mut warnings = Vec::new();
        let is_cad = body.file.extension().is_some_and(|e| CAD.iter().any(|cad| e.eq_ignore_ascii_case(cad)));
        if body.unit.is_none() && !is_cad {
            let [x, y, z] = BodyMesh::lengths(&path)?;
            warnings.push(format!(
                "`body.unit` is not stated: the numbers of the mesh file are taken as m, so that the body measures {x:.4} x {y:.4} x {z:.4} m"
            ));
        }
        let other = mesh(&body.mesh_request(COARSER))
            .and_then(|path| {
                let share = if BodyMesh::size_factor(&path)? > 1.0 { OF_COARSER } else { OF_FINER };
                Ok(OnOtherMesh { found: reduced(body, &path, &BodyMesh::contacts(&path)?, rubs)?, share })
            })
            .map_err(|why| {
                warnings.push(format!(
                    "the error by the mesh is not known, because no other mesh of the body can be made: {why}"
                ));
            })
            .ok();
        for (name, contact) in ["outer", "inner"].into_iter().zip(&contacts) {
            if contact.resolution() < RESOLVED {
                warnings.push(format!(
                    "{name} contact: elements of {:.3} mm are too large for a wall of {:.3} mm and an edge {:.3} mm away; refine the mesh there",
                    1e3 * contact.element_size,
                    1e3 * contact.wall,
                    1e3 * contact.edge_distance
                ));
            }
            if contact.layers < LAYERS {
                warnings.push(format!(
                    "{name} contact: the wall, {:.3} mm, has one layer of elements; two are needed for efficiencies within 0.2 %",
                    1e3 * contact.wall
                ));
            }
            if contact.curvature_source == "flat" {
                warnings.push(format!(
                    "{name} contact: the curvature of the surface is not known; it is taken as flat"
                ));
            }
        }
        Ok(Self { own, other, contacts, warnings, rubs })
    }

    /// The sphere that stands for a body with the tip radius `tip` in m at contact `k`.
    ///
    /// # Errors
    /// [`Error::Solver`] if the tip does not fit into the surface.
    pub(super) fn sphere(&self, k: usize, tip: f64) -> Result<EffectiveSphere> {
        let curvatures = self.contacts[k].curvatures;
        effective_sphere(curvatures.map(|own| own + 1.0 / tip)).ok_or_else(|| {
            let narrow = curvatures[0].min(curvatures[1]);
            Error::Solver(format!(
                "{} contact: the surface is hollow with a radius of {:.4} mm, in which a tip of {:.4} mm does not fit; \
                 use a smaller tip or another place",
                ["outer", "inner"][k],
                -1e3 / narrow,
                1e3 * tip
            ))
        })
    }

    /// The materials of `body` at outer and inner contact; of a contact that is not there the first.
    pub(super) fn faces<'a>(&self, body: &'a Body) -> [&'a Material; 2] {
        let name = |k: usize| self.contacts.get(k).and_then(|contact| contact.material.as_deref());
        [0, 1].map(|k| body.materials.named(name(k)))
    }

    /// A sentence for each contact with a tip of the radius `tips` in m that is an ellipse.
    ///
    /// # Errors
    /// As [`Self::sphere`].
    pub(super) fn ellipses(&self, tips: [Option<f64>; 2]) -> Result<Vec<String>> {
        let mut found = Vec::new();
        for (k, name) in ["outer", "inner"].into_iter().enumerate() {
            let Some(tip) = tips[k] else { continue };
            let area = self.sphere(k, tip)?.area;
            if area > ELLIPTIC {
                found.push(format!(
                    "{name} contact: it is an ellipse, whose pressure is {:.0} % higher than that of the circle that the law of plastic contacts and the elastic speed assume",
                    100.0 * (area - 1.0)
                ));
            }
        }
        Ok(found)
    }

    /// The body's modes and residual flexibility for contact patches of the radii `patch` in m; and the same of the other mesh.
    pub(super) fn modal(&self, body: &Body, patch: [f64; 2]) -> (ModalBody, Option<OnOtherMesh<ModalBody>>) {
        let (reference, faces) = (body.materials.named(None), self.faces(body));
        let of = |solid: &StruckSolid| solid.modal_body(reference, faces, patch, body.damping_ratio);
        (
            of(&self.own),
            self.other.as_ref().map(|other| OnOtherMesh { found: of(&other.found), share: other.share }),
        )
    }

    /// What the user has to know of contact patches of the radii `patch` in m.
    pub(super) fn patch_warnings(&self, patch: [f64; 2]) -> Vec<String> {
        let mut found = Vec::new();
        for ((name, contact), patch) in ["outer", "inner"].into_iter().zip(&self.contacts).zip(patch) {
            if contact.edge_distance < FROM_EDGE * patch {
                found.push(format!(
                    "{name} contact: an edge of the face is {:.3} mm away, less than {FROM_EDGE} radii of the contact ({:.3} mm): Hertz's law assumes a face without edges",
                    1e3 * contact.edge_distance,
                    1e3 * patch
                ));
            }
            if contact.material_distance < FROM_EDGE * patch {
                found.push(format!(
                    "{name} contact: another material is {:.3} mm away, less than {FROM_EDGE} radii of the contact ({:.3} mm): Hertz's law assumes one material",
                    1e3 * contact.material_distance,
                    1e3 * patch
                ));
            }
            if patch > OF_WALL * contact.wall {
                found.push(format!(
                    "{name} contact: its radius, {:.3} mm, is more than half of the wall, {:.3} mm: Hertz's distribution of the pressure is not accurate there",
                    1e3 * patch,
                    1e3 * contact.wall
                ));
            }
        }
        found
    }
}

/// The `count` lowest eigenfrequencies of `body` in Hz, whether or not the contacts excite them.
///
/// # Errors
/// As [`ElasticBody::new`].
pub(super) fn frequencies(body: &Body, count: usize) -> Result<Vec<f64>> {
    let path = mesh(&body.mesh_request(1.0))?;
    let of = json!({ "frequencies": count, "body": body.materials });
    cached(&path, of, || {
        let (BodyMesh { mesh, fixed, .. }, materials) = read(body, &path)?;
        solid::frequencies(&mesh, &materials, &fixed, count)
    })
}

/// The surface of `body` to look at, and where it is struck.
///
/// # Errors
/// As [`ElasticBody::new`].
pub(super) fn view(body: &Body) -> Result<(BodyView, Vec<ContactInfo>)> {
    let path = mesh(&body.mesh_request(1.0))?;
    let contacts = BodyMesh::contacts(&path)?;
    let points: Vec<_> = contacts.iter().map(ContactInfo::struck).collect();
    let of = json!({ "view": body.materials, "points": places(&points) });
    let view = cached(&path, of, || {
        let (BodyMesh { mesh, fixed, .. }, materials) = read(body, &path)?;
        BodyView::new(&mesh, &materials, &fixed, &points)
    })?;
    Ok((view, contacts))
}

/// The body on the mesh at `path`, from the cache or computed.
fn reduced(body: &Body, path: &Path, contacts: &[ContactInfo], rubs: bool) -> Result<StruckSolid> {
    let struck = |contact: &ContactInfo| StruckPoint { rubs, ..contact.struck() };
    let points: Vec<_> = contacts.iter().map(struck).collect();
    let of = json!({ "struck": places(&points), "materials": ratios(body) });
    cached(path, of, || {
        let (BodyMesh { mesh, fixed, .. }, materials) = read(body, path)?;
        announce(3 * fixed.iter().filter(|fixed| !**fixed).count())?;
        StruckSolid::new(&mesh, &materials, &fixed, &points)
    })
}

/// The mesh at `path`, and the materials of `body` by its cells.
fn read(body: &Body, path: &Path) -> Result<(BodyMesh, CellMaterials)> {
    let mesh = BodyMesh::read(path)?;
    let materials = body.materials.all();
    let number = |name: &String| materials.iter().position(|material| material.name == *name).unwrap_or(0);
    let numbers: Vec<usize> = mesh.materials.iter().map(number).collect();
    let of_cell = match &numbers[..] {
        [] => Vec::new(),
        numbers => mesh.material_of_cell.iter().map(|own| numbers[*own]).collect(),
    };
    Ok((mesh, CellMaterials { materials: materials.into_iter().cloned().collect(), of_cell }))
}

/// Young's modulus and density of each material over those of the first, and Poisson's ratio.
fn ratios(body: &Body) -> Vec<[f64; 3]> {
    let first = body.materials.named(None);
    let of =
        |m: &Material| [m.youngs_modulus / first.youngs_modulus, m.density / first.density, m.poisson_ratio];
    body.materials.all().into_iter().map(of).collect()
}

fn places(points: &[StruckPoint]) -> Vec<serde_json::Value> {
    let place = |point: &StruckPoint| {
        let [place, normal] = [point.at.point, point.at.normal].map(<[f64; 3]>::from);
        match point.rubs {
            true => json!([place, normal, point.circles, "rubs"]),
            false => json!([place, normal, point.circles]),
        }
    };
    points.iter().map(place).collect()
}

/// What `build` makes of the mesh at `path`, from the cache or computed; `of` is what else it depends on.
fn cached<T>(path: &Path, of: serde_json::Value, build: impl FnOnce() -> Result<T>) -> Result<T>
where
    T: serde::Serialize + serde::de::DeserializeOwned,
{
    let content = std::fs::read(path).map_err(|e| Error::io("reading", path, e))?;
    let inputs = json!({ "body": "meshed", "revision": REVISION, "mesh": sha256_hex(&content), "of": of });
    Cache::from_environment().get_or_build(&inputs, build)
}
