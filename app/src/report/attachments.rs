//! What a report shows besides the comparison, where there is any of it.

use crate::ci::acceptance::Acceptance;
use crate::ci::trend::Trend;
use crate::coverage::Coverage;
use crate::project::project_root;
use crate::reference::{CurveBands, Dents, FieldMesh, MeshSection, SolidStress, Stored};
use crate::report::{LiveScene, kinds};
use crate::result::History;
use crate::scene::Scene;
use crate::validated::Validation;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Nothing of this changes a verdict; all of it may be missing.
#[derive(Debug, Clone, Default)]
pub struct Attachments {
    /// 95 % bands of the reference's curves.
    pub bands: Option<CurveBands>,
    /// Mesh of an axisymmetric reference.
    pub mesh: Option<FieldMesh>,
    /// Its stress at the instant (s) kept that is nearest to the largest force.
    pub stress: Option<(f64, FieldMesh)>,
    /// The surfaces that its impacts left, of bodies that yield.
    pub dents: Vec<Dents>,
    /// Section of a solid reference's mesh in the plane of symmetry.
    pub section: Option<MeshSection>,
    /// Its stress at the instant (s) kept that is nearest to the largest force.
    pub section_stress: Option<(f64, MeshSection)>,
    /// Stress in the struck body of a solid reference at the instant (s) kept that is nearest to the largest force.
    pub solid_stress: Option<(f64, SolidStress)>,
    /// The reference's series of fields, which ParaView plays.
    pub fields: Option<PathBuf>,
    /// What the reduced models have cost, in their order; of models that share a mesh with the reference.
    pub cost: Vec<Cost>,
    /// Folder of the scene's file, for people; empty = not known.
    pub folder: String,
    /// When the scene was compared (UTC).
    pub compared: Option<String>,
    /// The gated numbers over the commits recorded.
    pub trends: Vec<Trend>,
    /// Changes of tolerances and reference accepted so far, oldest first.
    pub acceptances: Vec<Acceptance>,
    /// Scenes in which models were compared with references, this one among them.
    pub validated: Arc<[Validation]>,
    /// Which features of scenes are compared with what.
    pub coverage: Option<Arc<Coverage>>,
    /// The scene for the live page, if there is one.
    pub live: Option<LiveScene>,
}

/// What a reduced model has cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Mesh to modes and flexibility, or from the cache, s.
    pub setup_seconds: f64,
    /// Degrees of freedom of the mesh without those that supports hold.
    pub dofs: usize,
}

impl Attachments {
    /// What the store has beside the numbers of a solution of `scene`. Meshes and fields that can't be drawn are omitted.
    pub fn of(scene: &Scene, stored: &Stored) -> Self {
        let drawn = kinds::of(scene).attachments(stored);
        // the same on every machine, so that equal results give equal reports
        let root = project_root().unwrap_or_default();
        let in_project = |file: PathBuf| file.strip_prefix(&root).map(Path::to_owned).unwrap_or(file);
        Attachments {
            bands: stored.bands.clone(),
            fields: stored.fields_over_time().map(in_project),
            ..drawn
        }
    }
}

/// When the curve called `name` is largest, s.
pub(crate) fn instant_of_peak(history: &History, name: &str) -> f64 {
    let values = history.time.iter().zip(history.curve(name).unwrap_or_default());
    values.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0.0, |(time, _)| *time)
}
