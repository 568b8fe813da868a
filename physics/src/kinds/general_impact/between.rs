//! An elastic body between the contacts of outer and inner body.

use super::Body;
use super::elastic::ElasticBody;
use super::scene::sphere_radius;
use crate::analytical::hertz::HertzImpact;
use crate::body::ModalBody;
use crate::body::free_sphere::sphere_residual;
use crate::contact::Hertz;
use crate::dynamics::MovingBody;
use crate::dynamics::system::System;
use crate::error::Result;
use crate::scene::{Inner, Material, Outer, Shape};
use nalgebra::Vector3;

/// The elastic body between the contacts.
#[derive(Debug)]
pub(super) struct Between {
    pub(super) body: ElasticBody,
    /// The same impact on the body's coarser mesh.
    pub(super) coarse: Option<System>,
    /// Cosine of the angle between the direction of the outer contact and the inner one's, both along z: 1 on parallel faces.
    alignment: f64,
    /// Mass in kg; `None` if the body is held.
    free_mass: Option<f64>,
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
        let outer = MovingBody { tip_radius: elastic.tip_radius(0, outer.tip_radius)?, ..outer };
        let moving = inner.map(|inner| {
            let moving = MovingBody::inner(inner);
            Ok(MovingBody { tip_radius: elastic.tip_radius(1, moving.tip_radius)?, ..moving })
        });
        let moving = moving.transpose()?;
        // contact patches under the force of the outer body on a half-space
        let law = |moving: &MovingBody| Hertz::new(moving.tip_radius, &moving.material, &body.material);
        let hit = HertzImpact { mass: outer.mass, speed: outer.speed, stiffness: law(&outer).stiffness };
        let patch = [Some(&outer), moving.as_ref()]
            .map(|moving| moving.map_or(1.0, |moving| law(moving).contact_radius(hit.force_peak())));
        let tip = |shape: &Shape, material: &Material, patch: f64| {
            sphere_radius(shape).map_or(0.0, |radius| sphere_residual(radius, material, patch))
        };
        let tips = [
            tip(&given.shape, &given.material, patch[0]),
            inner.map_or(0.0, |inner| tip(&inner.shape, &inner.material, patch[1])),
        ];
        let join = |modal: ModalBody| match &moving {
            Some(inner) => System::of(&[outer.clone(), inner.clone()], &modal, &body.material, tips),
            None => System::on_body(outer.clone(), &modal, &body.material, tips[0]),
        };
        let (fine, coarse) = elastic.modal(body, patch);
        let system = join(fine);
        let normals: Vec<Vector3<f64>> = elastic.contacts.iter().map(|c| Vector3::from(c.normal)).collect();
        let mut warnings = elastic.warnings.clone();
        warnings.extend(elastic.patch_warnings(patch));
        let between = Self {
            coarse: coarse.map(join),
            alignment: normals.get(1).map_or(0.0, |inner| -normals[0].dot(inner)),
            free_mass: (!elastic.fine.rigid.is_empty()).then(|| body.material.density * elastic.fine.volume),
            body: elastic,
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

    /// Modes that the static solutions of all contacts, and so each further block of Ritz vectors, have.
    pub(super) fn block(&self) -> usize {
        2 * self.body.contacts.len()
    }
}
