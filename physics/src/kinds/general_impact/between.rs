//! An elastic body or a plate that the outer body strikes, and the inner body behind it if there is one.

use super::elastic::{self, ElasticBody, OnOtherMesh};
use super::scene::sphere_radius;
use super::{Body, MeshRequest};
use crate::analytical::hertz::HertzImpact;
use crate::body::ModalBody;
use crate::body::continuum::{MeshOptions, cached};
use crate::body::free_sphere::sphere_residual;
use crate::contact::Hertz;
use crate::dynamics::MovingBody;
use crate::dynamics::surface_modes::SurfaceMode;
use crate::dynamics::system::{PLATE, System};
use crate::error::Result;
use crate::kinds::plate_impact;
use crate::kinds::rubbing::{rubs_along, surface_modes};
use crate::result::limit::SMALL_DEFLECTION;
use crate::scene::{DEFAULT_MODES, Edge, Inner, Material, Outer, Plate, Shape};
use nalgebra::Vector3;

/// Blocks of Ritz vectors that are left out to see what modes change.
const DROPPED: usize = 1;
/// What the outer body strikes, if that is elastic.
#[derive(Debug)]
pub(super) struct Between {
    /// The same impact on another mesh of the body.
    pub(super) other: Option<OnOtherMesh<System>>,
    /// Cosine of the angle between the direction of the outer contact and the inner one's, both along z: 1 on parallel faces.
    alignment: f64,
    /// By how many modes less the error for want of modes is found.
    pub(super) fewer: usize,
    /// Mass in kg; `None` if the body is held.
    free_mass: Option<f64>,
    /// Its rigid motions, those along the surfaces too; none of a plate, which is struck at its centre.
    pub(super) rigid: Vec<SurfaceMode>,
    /// Its motions at a right angle to these along the surfaces.
    pub(super) aside: Vec<SurfaceMode>,
    pub(super) warnings: Vec<String>,
}

impl Between {
    /// The system of `outer`, as the scene has it `given`, that strikes `body`, with the `inner` body behind.
    ///
    /// # Errors
    /// [`Error::Solver`] for a tip that does not fit into the surface.
    pub(super) fn joined(
        elastic: ElasticBody,
        body: &Body,
        outer: MovingBody,
        given: &Outer,
        inner: Option<&Inner>,
    ) -> Result<(System, Self)> {
        let outer = MovingBody { tip_radius: elastic.sphere(0, outer.tip_radius)?.radius, ..outer };
        let moving = inner.map(|inner| {
            let moving = MovingBody::inner(inner);
            Ok(MovingBody { tip_radius: elastic.sphere(1, moving.tip_radius)?.radius, ..moving })
        });
        let moving = moving.transpose()?;
        // contact patches under the force of the outer body on a half-space
        let faces = elastic.faces(body);
        let law =
            |moving: &MovingBody, face: &Material| Hertz::new(moving.tip_radius, &moving.material, face);
        let stiffness = law(&outer, faces[0]).stiffness;
        let hit = HertzImpact { mass: outer.mass, speed: outer.speed, stiffness };
        // or that of the inner one, if that is the heavier blow
        let own = moving.as_ref().map_or(0.0, |inner| {
            let speed = inner.speed.max(0.0);
            HertzImpact { mass: inner.mass, speed, stiffness: law(inner, faces[1]).stiffness }.force_peak()
        });
        let force = hit.force_peak().max(own);
        let radius = |moving: &MovingBody, face| law(moving, face).contact_radius(force);
        let patch = [radius(&outer, faces[0]), moving.as_ref().map_or(1.0, |inner| radius(inner, faces[1]))];
        let tip = |shape: &Shape, material: &Material, patch: f64| {
            sphere_radius(shape).map_or(0.0, |radius| sphere_residual(radius, material, patch))
        };
        let tips = [
            tip(&given.shape, &given.material, patch[0]),
            inner.map_or(0.0, |inner| tip(&inner.shape, &inner.material, patch[1])),
        ];
        let first_frequency = elastic.own.first_frequency(body.materials.named(None));
        let join = |modal: ModalBody| {
            let system = match &moving {
                Some(inner) => System::between(&[outer.clone(), inner.clone()], &modal, faces, tips),
                None => System::on_body(outer.clone(), &modal, faces[0], tips[0]),
            };
            System { first_frequency, ..system }
        };
        let (own, other) = elastic.modal(body, patch);
        let solid = elastic.own.of_material(body.materials.named(None));
        let rigid = |along: usize| {
            let motions = solid.rigid_motions.iter();
            motions.map(move |motion| SurfaceMode::rigid(motion[0], motion[along])).collect::<Vec<_>>()
        };
        let (rigid, rigid_aside) = (rigid(1), rigid(2));
        let system = System { along: solid.along_beyond_half_spaces(faces), ..join(own) };
        let aside = surface_modes(rigid_aside, &solid.aside, &system);
        let normals: Vec<Vector3<f64>> = elastic.contacts.iter().map(|c| Vector3::from(c.normal)).collect();
        let mut warnings = elastic.warnings.clone();
        warnings.extend(elastic.patch_warnings(patch));
        warnings.extend(plate_impact::punches(&system, patch));
        let radii = [Some(given.shape.tip_radius()), inner.map(|inner| inner.shape.tip_radius())];
        if faces.iter().any(|face| face.yield_strength.is_some()) {
            warnings.extend(elastic.ellipses(radii)?);
        }
        let between = Self {
            other: other.map(|other| other.map(join)),
            alignment: normals.get(1).map_or(0.0, |inner| -normals[0].dot(inner)),
            free_mass: (!elastic.own.rigid.is_empty()).then_some(solid.mass),
            rigid,
            aside,
            fewer: 2 * DROPPED * elastic.contacts.len() * if elastic.rubs { 2 } else { 1 },
            warnings,
        };
        Ok((system, between))
    }

    /// The system of `outer`, as the scene has it `given`, that strikes the centre of `plate`, model C's.
    ///
    /// # Errors
    /// [`crate::Error::Solver`] if the plate's modes do not converge.
    pub(super) fn of_plate(plate: &Plate, outer: MovingBody, given: &Outer) -> Result<(System, Self)> {
        let law = Hertz::new(outer.tip_radius, &outer.material, &plate.material);
        let hit = HertzImpact { mass: outer.mass, speed: outer.speed, stiffness: law.stiffness };
        let patch = law
            .contact_radius(hit.force_peak())
            .max(plate_impact::SMALLEST_PATCH * plate.thickness.min(plate.radius));
        let body = cached::plate(plate, [patch; 2], DEFAULT_MODES, &MeshOptions::default())?;
        let tip =
            sphere_radius(&given.shape).map_or(0.0, |radius| sphere_residual(radius, &given.material, patch));
        let slow = std::f64::consts::PI / hit.duration();
        let system = System::on_body(outer, &body.modal_body(DEFAULT_MODES, slow), &plate.material, tip);
        let mut warnings = plate_impact::warnings(plate.thickness, [patch; 2], &system);
        let yielding: f64 =
            system.elastic().map(|k| (system.approach[0][k] / system.oscillators[k].omega).powi(2)).sum();
        let deflection = (2.0 * system.initial_energy() * yielding).sqrt() / plate.thickness;
        let bound = SMALL_DEFLECTION.bound;
        if deflection > bound {
            warnings.push(format!(
                "the plate may deflect by up to {deflection:.2} of its thickness, as its energy allows: linear plate theory omits above {bound} that the plate stretches"
            ));
        }
        let between = Self {
            other: None,
            alignment: 0.0,
            fewer: system.modes / 2,
            free_mass: (plate.edge == Edge::Free).then(|| plate.mass()),
            rigid: Vec::new(),
            aside: Vec::new(),
            warnings,
        };
        Ok((system, between))
    }

    /// Velocities in m/s along z that a free body's centre of mass gets by these impulses in N s, in the directions of outer and inner
    /// contact; zero of a body that is held.
    pub(super) fn velocities(&self, outer: f64, inner: f64) -> [f64; 2] {
        let Some(mass) = self.free_mass else { return [0.0; 2] };
        [(inner * self.alignment - outer) / mass, (inner - outer * self.alignment) / mass]
    }
}

/// The system of `outer` that strikes `plate` off-centre, behind which `inner` lies, on a mesh and on another one if there is one; and
/// what the user has to know of them.
///
/// # Errors
/// As [`ElasticBody::new`].
pub(in crate::kinds) fn off_centre_plate(
    plate: &Plate,
    outer: &Outer,
    inner: &Inner,
) -> Result<(System, Option<OnOtherMesh<System>>, Vec<String>)> {
    let body = Body::of_plate(plate, outer.offset);
    let elastic = ElasticBody::new(&body, rubs_along(outer, Some(inner)))?;
    let (mut system, between) =
        Between::joined(elastic, &body, MovingBody::outer(outer)?, outer, Some(inner))?;
    // the plate is observed at its centre, under the inner body
    let inner: Vec<f64> = system.approach[1][PLATE..].iter().map(|approach| -approach).collect();
    system.centre[PLATE..].copy_from_slice(&inner);
    system.local_centre = system.local_centre.off_centre();
    // as of every plate, whether or not the contacts excite it
    let omega = system.elastic().map(|k| system.oscillators[k].omega).fold(f64::INFINITY, f64::min);
    system.first_frequency = omega / (2.0 * std::f64::consts::PI);
    Ok((system, between.other, between.warnings))
}

/// The meshes of a `plate` that `outer` strikes off its centre.
pub(in crate::kinds) fn off_centre_meshes(plate: &Plate, outer: &Outer) -> Vec<MeshRequest> {
    elastic::mesh_requests(&Body::of_plate(plate, outer.offset))
}

#[cfg(test)]
mod tests;
