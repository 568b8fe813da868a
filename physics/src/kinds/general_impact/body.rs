//! An elastic body from a mesh or a CAD file, as a scene describes it.

use crate::error::{Error, Result};
use crate::material::Material;
use crate::scene::hash::{canonical, sha256_hex};
use crate::scene::material::material;
use crate::scene::values::{Checked, Node, PLACE, Values};
use crate::scene::{Edge, Plate};
use serde::Serialize;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// Number of the method that makes meshes, part of their keys: raise it when one comes out otherwise.
const MESH_REVISION: u32 = 4;
/// Largest file in bytes.
const MAX_BYTES: u64 = 2_000_000_000;
/// Key under which the checked values keep the content's hash.
const CONTENT: &str = "content";

/// A place on the surface of a body.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum BodyPlace {
    /// Name of a point, set, group or face in the file.
    Name(String),
    /// Coordinates in m.
    Point([f64; 3]),
}

/// What a body consists of.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum BodyMaterials {
    /// The same material everywhere.
    Material(Material),
    /// The material of each group of elements, by the group's name in the file.
    Materials(BTreeMap<String, Material>),
}

impl BodyMaterials {
    /// Reads `material` or `materials` of the checked table `body`.
    fn read(body: &Node, materials: &Node) -> Result<Self> {
        let Some(groups) = body.optional_table("materials")? else {
            return Ok(Self::Material(material(materials, body.text("material")?)?));
        };
        let of = |group: &String| Ok((group.clone(), material(materials, groups.text(group)?)?));
        groups.values.keys().map(of).collect::<Result<_>>().map(Self::Materials)
    }

    /// Each material once, whatever its names, ordered by the names of the groups.
    pub fn all(&self) -> Vec<&Material> {
        let mut found: Vec<&Material> = Vec::new();
        let groups = match self {
            Self::Material(material) => return vec![material],
            Self::Materials(groups) => groups,
        };
        for material in groups.values() {
            if !found.iter().any(|other| is_same(other, material)) {
                found.push(material);
            }
        }
        found
    }

    /// The material called `name` in the mesh; a body of one material has no names there.
    pub fn named(&self, name: Option<&str>) -> &Material {
        let all = self.all();
        all.iter().find(|material| Some(&*material.name) == name).unwrap_or(&all[0])
    }

    /// Whether it may differ from place to place.
    pub fn is_by_group(&self) -> bool {
        matches!(self, Self::Materials(_))
    }

    /// Names by group as the mesher reads them, one for each of [`Self::all`]; null for one material.
    fn names(&self) -> Value {
        let all = self.all();
        let name = |own: &Material| json!(all.iter().find(|other| is_same(other, own)).map(|m| &m.name));
        match self {
            Self::Material(_) => Value::Null,
            Self::Materials(groups) => groups.iter().map(|(group, m)| (group.clone(), name(m))).collect(),
        }
    }
}

/// Whether two materials differ in their names alone.
fn is_same(a: &Material, b: &Material) -> bool {
    *a == Material { name: a.name.clone(), ..b.clone() }
}

/// An elastic body whose shape is in a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Body {
    /// The file, a mesh or CAD.
    #[serde(skip)]
    pub file: PathBuf,
    /// SHA-256 (hexadecimal) of its content.
    pub content: String,
    /// Size in m of the file's unit of length; `None` = the file knows its own, or m.
    pub unit: Option<f64>,
    /// Its material, or its materials by group.
    #[serde(flatten)]
    pub materials: BodyMaterials,
    /// What does not move; nothing = the body is free.
    pub fixed: Vec<BodyPlace>,
    /// Size of elements away from the contacts in m, of CAD; `None` = by the thickness of walls.
    pub element_size: Option<f64>,
    /// Modal damping ratio (Lehr), the same for every mode; 0 = undamped.
    pub damping_ratio: f64,
    /// Where outer and inner body strike; `None` for an inner body that is not there.
    pub at: [Option<BodyPlace>; 2],
    /// The mesher makes this circular plate itself, and there is no file.
    #[serde(skip)]
    pub disc: Option<Disc>,
}

/// A circular plate about the z axis, from z = 0 to its thickness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Disc {
    /// In m.
    pub radius: f64,
    /// In m.
    pub thickness: f64,
}

impl Body {
    /// The body that the checked table `body` describes, struck at the places `at`.
    pub(super) fn read(body: &Node, materials: &Node, at: [Option<BodyPlace>; 2]) -> Result<Self> {
        let unit = body.has("unit").then(|| body.text("unit")).transpose()?;
        let unit = unit.map(|unit| UNITS.iter().find(|(name, _)| *name == unit).map_or(1.0, |u| u.1));
        let fixed =
            body.tables("fixed")?.iter().map(|entry| place(entry, PLACE)).collect::<Result<Vec<_>>>()?;
        Ok(Self {
            file: body.text("file")?.into(),
            content: body.text(CONTENT)?.to_owned(),
            unit,
            materials: BodyMaterials::read(body, materials)?,
            fixed: fixed.into_iter().flatten().collect(),
            element_size: body.optional_number("element_size")?,
            damping_ratio: body.number("damping_ratio")?,
            at,
            disc: None,
        })
    }

    /// The circular `plate`, struck from above at `offset` m from its axis and from below at its centre.
    pub(super) fn of_plate(plate: &Plate, offset: f64) -> Self {
        let Plate { radius, thickness, edge, ref material, damping_ratio } = *plate;
        let rim = BodyPlace::Point([radius, 0.0, 0.5 * thickness]);
        Self {
            file: PathBuf::new(),
            content: String::new(),
            unit: Some(1.0),
            materials: BodyMaterials::Material(material.clone()),
            fixed: if edge == Edge::Free { Vec::new() } else { vec![rim] },
            element_size: None,
            damping_ratio,
            at: [[offset, 0.0, thickness], [0.0; 3]].map(|at| Some(BodyPlace::Point(at))),
            disc: Some(Disc { radius, thickness }),
        }
    }

    /// What its mesh depends on, with elements `factor` times as large as by default.
    pub fn mesh_request(&self, factor: f64) -> MeshRequest {
        let contact = |at: &Option<BodyPlace>| at.as_ref().map(|at| json!({ "at": at }));
        let mut document = json!({
            "kind": super::NAME,
            "body": {
                "unit": self.unit, "fixed": self.fixed, "element_size": self.element_size,
                "materials": self.materials.names(),
            },
            "outer": contact(&self.at[0]),
            "inner": contact(&self.at[1]),
        });
        if let Some(disc) = self.disc {
            document["body"]["disc"] = json!(disc);
        }
        let key = json!({ "document": document, "content": self.content, "factor": factor, "revision": MESH_REVISION });
        let key = sha256_hex(canonical(&key).as_bytes());
        document["body"]["path"] = json!(self.file);
        let file = self.disc.is_none().then(|| (self.file.clone(), self.content.clone()));
        MeshRequest { document, factor, key, file }
    }
}

/// Units of length that a file may be in.
pub(super) const UNITS: [(&str, f64); 5] =
    [("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("cm", 1e-2), ("in", 0.0254)];

/// A mesh of a body that is wanted.
#[derive(Debug, Clone)]
pub struct MeshRequest {
    /// The body and its contacts, as the mesher reads them.
    pub document: Value,
    /// Size of the elements over that by default.
    pub factor: f64,
    /// SHA-256 of all that the mesh depends on.
    pub key: String,
    /// The file, if there is one, and the SHA-256 of its content when the scene was read.
    pub file: Option<(PathBuf, String)>,
}

/// Makes a mesh, or finds the one that is there: a `.vtu` file with its description in the `.json` file of the same name.
pub type Mesher = fn(&MeshRequest) -> Result<PathBuf>;

static MESHER: OnceLock<Mesher> = OnceLock::new();

/// Announces that a body of so many unknowns is set up now, or refuses it for want of memory.
pub type Announcer = Box<dyn Fn(usize) -> Result<()> + Send + Sync>;

static ANNOUNCER: OnceLock<Announcer> = OnceLock::new();

/// Says who announces set-ups of bodies; without, nobody does. The first call counts.
pub fn set_announcer(announcer: Announcer) {
    let _ = ANNOUNCER.set(announcer);
}

/// Announces a set-up.
///
/// # Errors
/// Those of the announcer.
pub(super) fn announce(unknowns: usize) -> Result<()> {
    ANNOUNCER.get().map_or(Ok(()), |announcer| announcer(unknowns))
}

/// Says how meshes of bodies are made: this crate reads them only. The first call counts.
pub fn set_mesher(mesher: Mesher) {
    let _ = MESHER.set(mesher);
}

/// The mesh that is wanted.
///
/// # Errors
/// Those of the mesher; [`Error::Internal`] if none was set.
pub(super) fn mesh(request: &MeshRequest) -> Result<PathBuf> {
    let mesher = MESHER.get().ok_or_else(|| {
        Error::Internal("meshes of bodies are made by the program: call `set_mesher` first".into())
    })?;
    mesher(request)
}

/// The place under `key`, if it is there.
pub(super) fn place(node: &Node, key: &str) -> Result<Option<BodyPlace>> {
    Ok(match node.values.get(key) {
        Some(Checked::Text(name)) => Some(BodyPlace::Name(name.clone())),
        Some(Checked::Numbers(at)) => {
            let at =
                <[f64; 3]>::try_from(&at[..]).map_err(|_| Error::Internal(format!("`{key}` is no place")))?;
            Some(BodyPlace::Point(at))
        }
        _ => None,
    })
}

/// Finds the file that `body.file` names, relative to the scene file `source_name`, and what is in it.
///
/// # Errors
/// A sentence about the file.
pub(super) fn find_file(values: &mut Values, source_name: &str) -> std::result::Result<(), String> {
    let Some(Checked::Table(body)) = values.get_mut("body") else { return Ok(()) };
    let body = Arc::make_mut(body);
    let Some(Checked::Text(name)) = body.get("file") else { return Ok(()) };
    let path = Path::new(source_name).parent().unwrap_or(Path::new("")).join(name);
    let content = content(&path).map_err(|why| format!("`body.file` is \"{name}\", {why}"))?;
    let path = std::path::absolute(&path).unwrap_or(path);
    body.insert("file".into(), Checked::Text(path.to_string_lossy().into_owned()));
    body.insert(CONTENT.into(), Checked::Text(content));
    Ok(())
}

/// SHA-256 (hexadecimal) of a file.
///
/// # Errors
/// A clause that says why it can't be read.
pub fn content(path: &Path) -> std::result::Result<String, String> {
    let refused = |error: std::io::Error| format!("but \"{}\" can't be read: {error}", path.display());
    // before it is opened, for which a pipe would wait
    let metadata = std::fs::metadata(path).map_err(refused)?;
    if !metadata.is_file() {
        return Err(format!("but \"{}\" is no file", path.display()));
    }
    if metadata.len() > MAX_BYTES {
        return Err(format!("which has {} bytes; a body's file has at most {MAX_BYTES}", metadata.len()));
    }
    let mut file = File::open(path).map_err(refused)?;
    let (mut hash, mut part) = (Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut part).map_err(refused)? {
            0 => return Ok(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()),
            read => hash.update(&part[..read]),
        }
    }
}
