//! An outer body strikes a wall, an elastic body or plate, or another body: reduced model C. With a plate between outer and inner body, see
//! [`super::plate_impact`].

mod between;
mod body;
mod checks;
mod elastic;
mod model;
mod results;
mod scene;
mod soundness;

pub(super) use between::{off_centre_meshes, off_centre_plate};
pub use body::{
    Announcer, Body, BodyMaterials, BodyPlace, Disc, MeshRequest, Mesher, content, set_announcer, set_mesher,
};
pub use elastic::OnOtherMesh;
pub use model::{Neighbours, difference_from_hertz, neighbours};
pub use results::{CURVES, ImpactQuantities};
pub use scene::{GeneralImpact, Struck, Wall};

use super::SeriesModel;
use crate::body::solid::{BodyView, ContactInfo};
use crate::contact::{EffectiveSphere, Hertz};
use crate::error::{Error, Result};
use crate::material::Material;
use crate::result::limit::{self, QUASI_STATIC, SMALL_ROTATION};
use crate::result::{Curve, History, Limit, Outcome, Quantity, Statement, Summary, Table};
use crate::scene::{Inner, Model, Scene, Shape};
use elastic::ElasticBody;
use model::ContactModel;

/// Its name in scene files.
const NAME: &str = "impact";

/// The registry's entry.
pub struct Kind;

impl super::Kind for Kind {
    fn name(&self) -> &'static str {
        NAME
    }

    fn models(&self) -> &'static [Model] {
        &[Model::C]
    }

    fn quantities(&self) -> &'static [Quantity] {
        ImpactQuantities::ALL
    }

    fn curves(&self) -> &'static [Curve] {
        &CURVES
    }

    fn has(&self, scene: &Scene, name: &str) -> bool {
        scene.general_impact().is_ok_and(|setup| setup.has(name))
    }

    fn model(&self, scene: &Scene, model: Model, modes: Option<usize>) -> Result<Box<dyn SeriesModel>> {
        if model != Model::C {
            return Err(Error::Usage(format!(
                "model {model}: `{}` has model C only; A and B need a plate with an inner body behind it",
                scene.name
            )));
        }
        let has_modes = scene.general_impact()?.is_held().is_some();
        if let Some(modes) = modes.filter(|_| !has_modes) {
            return Err(Error::Usage(format!(
                "--modes {modes}: `{}` has neither plate nor body, so that its model has no modes",
                scene.name
            )));
        }
        Ok(Box::new(ContactModel::new(scene, modes)?))
    }

    fn judge(&self, scene: &Scene, summary: &mut Summary, _: Option<&History>) {
        let Ok(setup) = scene.general_impact() else { return };
        summary.set_limits(limits(setup, summary));
    }

    fn shown(&self, scene: &Scene, history: &History) -> Table {
        scene
            .general_impact()
            .map_or_else(|_| Table::new(self.quantities()), |setup| checks::shown(setup, history))
    }

    fn mesh_requests(&self, scene: &Scene) -> Vec<MeshRequest> {
        let body = scene.general_impact().ok().and_then(GeneralImpact::body);
        body.map_or_else(Vec::new, elastic::mesh_requests)
    }

    fn checks(&self, scene: &Scene, outcome: &Outcome) -> Vec<Statement> {
        scene.general_impact().map_or_else(|_| Vec::new(), |setup| checks::checks(setup, outcome))
    }
}

/// The surface of the body of `scene` to look at, and where outer and inner body strike it; `None` without a body from a mesh.
///
/// # Errors
/// Those of the mesh.
pub fn body_view(scene: &Scene) -> Result<Option<(BodyView, Vec<ContactInfo>)>> {
    scene.general_impact().ok().and_then(GeneralImpact::body).map(elastic::view).transpose()
}

/// The elastic contacts: whose, their laws, with the area of an ellipse where there is one, and the materials that meet.
fn contact_laws(setup: &GeneralImpact) -> Vec<(&'static str, Hertz, Vec<&Material>)> {
    let elastic = setup.body().and_then(|body| ElasticBody::known(body, setup.rubs_along()));
    let face = setup.face();
    let faces = setup
        .body()
        .map(|body| elastic.as_ref().map_or([body.materials.named(None); 2], |elastic| elastic.faces(body)));
    let law = |k: usize, tip: f64, material: &Material| {
        let sphere = elastic.as_ref().and_then(|body| body.sphere(k, tip).ok());
        let sphere = sphere.unwrap_or(EffectiveSphere { radius: tip, area: 1.0 });
        let law = Hertz::new(sphere.radius, material, faces.map_or(&*face, |faces| faces[k]));
        Hertz { tip_radius: law.tip_radius / sphere.area, ..law }
    };
    let curvature = setup.struck_inner().map_or(0.0, |inner| 1.0 / inner.shape.tip_radius());
    let outer = 1.0 / (1.0 / setup.outer.shape.tip_radius() + curvature);
    let mut found = vec![("outer", law(0, outer, &setup.outer.material), setup.materials())];
    if let Some(faces) = faces {
        found[0].2 = vec![&setup.outer.material, faces[0]];
        let own = |inner: &Inner| law(1, inner.shape.tip_radius(), &inner.material);
        found.extend(setup.inner.iter().map(|inner| ("inner", own(inner), vec![&inner.material, faces[1]])));
    }
    found
}

/// How near a result comes to the bounds of the theories behind it.
fn limits(setup: &GeneralImpact, summary: &Summary) -> Vec<Limit> {
    let materials = setup.materials();
    let is_elastic = materials.iter().all(|material| material.is_elastic());
    let mut limits = Vec::new();
    for (name, law, pair) in contact_laws(setup) {
        let force = summary.value(&format!("{name}_force_peak")).filter(|_| is_elastic);
        limits.extend(force.into_iter().flat_map(|force| limit::of_contact(name, &law, force, &pair)));
    }
    if let (Shape::Bender(beam), Some(bender)) = (&setup.outer.shape, summary.bender) {
        limits.push(SMALL_ROTATION.at("outer", bender.drive.tip_deflection.abs() / beam.length));
    }
    let slowest = materials.iter().map(|m| m.bar_wave_speed()).fold(f64::INFINITY, f64::min);
    limits.push(QUASI_STATIC.at("outer", setup.closing_speed() / slowest));
    limits
}
