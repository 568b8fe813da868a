//! Reduced models between B and C: one simplification of model B is given up after the other.
//!
//! The plate is loaded by the force f_0 on its outer and f_1 on its inner face, both along +z, at points
//! that move by u_0 and u_1. Sum and difference of the faces part two motions:
//!
//! - net force f_0 + f_1 and mean displacement (u_0 + u_1)/2: the plate as plate theory sees it;
//! - squeezing force (f_0 - f_1)/2 and change of thickness u_0 - u_1: local, no plate theory knows it.
//!
//! Their work adds up to that of the faces. With P = 1/2 [[1, 1], [1, 1]], the projection on the mean, a
//! body u = sum_k phi_k q_k + R f seen through its mean alone has the participation P phi_k and the residual
//! flexibility P R P. R is already without Hertz's half-spaces diag(h_0, h_1); the mean is therefore
//! P (C - diag(h_0, h_1)) P - sum_k (P phi_k)(P phi_k)^T / omega_k^2 with C the flexibility of the faces: what a net
//! force does beyond sinking into a half-space on either side. That is bending, shear and rotary inertia, and it has
//! a limit for small patches, whereas Mindlin's deflection under a point force has none: shear spreads over
//! the thickness, not over the patch. What the mean leaves out, R - P R P and the modes that change the
//! thickness, is the error of taking a plate squeezed from both sides for two half-spaces.
//!
//! Border: under a patch wider than the plate is thick (a membrane under large spheres) the half-spaces yield more
//! than the plate does, the mean's residual turns strongly negative and the contacts may have no equilibrium.
//! [`Variants::run`] then fails; there is no plate theory with half-space contact to speak of.

use super::PlateImpact;
use super::assembled::tip_residuals;
use super::predictor::Predictor;
use super::results::PlateQuantities;
use super::results::quantities;
use crate::body::continuum::{ContinuumPlate, MeshOptions, cached};
use crate::body::{ModalBody, kirchhoff};
use crate::contact::PatchFlexibility;
use crate::dynamics::integration::Options;
use crate::dynamics::integrator::integrate;
use crate::dynamics::system::System;
use crate::error::{Error, Result};
use crate::scene::Scene;

/// How the bodies of a scene are simplified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Simplification {
    /// Kirchhoff plate, half-spaces in contact, rigid tips: model B.
    KirchhoffPlate,
    /// Continuum plate seen through the mean of its faces, half-spaces in contact, rigid tips.
    MeanOfFaces,
    /// Continuum plate with its full residual flexibility, rigid tips.
    RigidTips,
    /// Continuum plate and elastic spheres: model C.
    None,
}

/// How the continuum bodies are set up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContinuumSetup {
    /// Contact patches relative to those of model C.
    pub patch_factor: f64,
    /// Meshes.
    pub mesh: MeshOptions,
}

impl Default for ContinuumSetup {
    /// That of model C.
    fn default() -> Self {
        Self { patch_factor: 1.0, mesh: MeshOptions::default() }
    }
}

/// The bodies of a scene, set up once for every simplification.
#[derive(Debug, Clone)]
pub struct Variants<'a> {
    setup: &'a PlateImpact,
    end_time: Option<f64>,
    kirchhoff: ModalBody,
    plate: ContinuumPlate,
    predictor: Predictor,
    tips: [f64; 2],
}

impl<'a> Variants<'a> {
    /// Sets the bodies of `scene` up for at most `modes` elastic modes of the Kirchhoff and of the continuum plate.
    /// The contact patches are those of model C with `patch_modes` modes, times the factor of `continuum`.
    ///
    /// # Errors
    /// As [`super::reduced::Reduced::new`].
    pub fn new(
        scene: &'a Scene,
        modes: [usize; 2],
        patch_modes: usize,
        continuum: &ContinuumSetup,
    ) -> Result<Self> {
        let setup = scene.plate_impact()?;
        if !setup.outer.is_centred() || setup.spins() {
            return Err(Error::Usage(
                "an off-centre or oblique impact, or one with spin, has no budget of the differences".into(),
            ));
        }
        let kirchhoff = kirchhoff::modes(&setup.plate, modes[0].max(patch_modes))?;
        let few = lowest(&kirchhoff, patch_modes);
        let mut predictor = Predictor::of(&setup.rigid_system(&few, [0.0; 2]))?;
        let patch = predictor.patch_radius.map(|a| a * continuum.patch_factor);
        predictor.patch_radius = patch;
        Ok(Self {
            setup,
            end_time: scene.run.end_time,
            plate: cached::plate(
                &setup.plate,
                predictor.meshed_patches(&setup.plate),
                modes[1],
                &continuum.mesh,
            )?,
            tips: tip_residuals(setup, patch, |r, m, a| cached::sphere_residual(r, m, a, &continuum.mesh))?,
            kirchhoff,
            predictor,
        })
    }

    /// Thickness of the plate in m.
    pub fn thickness(&self) -> f64 {
        self.setup.plate.thickness
    }

    /// The scene under `simplification` with `modes` elastic modes of the plate.
    pub fn system(&self, simplification: Simplification, modes: usize) -> System {
        let rigid = [0.0; 2];
        let continuum = || self.plate.modal_body(modes, self.predictor.slow());
        let (plate, tips) = match simplification {
            Simplification::KirchhoffPlate => (lowest(&self.kirchhoff, modes), rigid),
            Simplification::MeanOfFaces => (mean_of_faces(&continuum()), rigid),
            Simplification::RigidTips => (continuum(), rigid),
            Simplification::None => (continuum(), self.tips),
        };
        self.setup.rigid_system(&plate, tips)
    }

    /// Runs the scene under `simplification`; `tolerance` bounds the efficiency's relative error from the time
    /// integration.
    ///
    /// # Errors
    /// As [`integrate`].
    pub fn run(
        &self,
        simplification: Simplification,
        modes: usize,
        tolerance: f64,
    ) -> Result<PlateQuantities> {
        let system = self.system(simplification, modes);
        let options = Options { tolerance, end_time: self.end_time, ..Options::default() };
        quantities(&system, &integrate(&system, &options)?)
    }
}

/// `body` with its rigid motion and the `modes` lowest elastic modes, without a residual for the others.
fn lowest(body: &ModalBody, modes: usize) -> ModalBody {
    let rigid = body.omega.iter().filter(|w| **w == 0.0).count();
    let mut body = body.clone();
    body.omega.truncate(rigid + modes);
    body.damping_ratio.truncate(rigid + modes);
    body.participation.truncate(rigid + modes);
    body
}

/// `body` seen through the mean of its two contact points: participation P phi_k, residual P R P with
/// P = 1/2 [[1, 1], [1, 1]], R for patches of no extent.
pub fn mean_of_faces(body: &ModalBody) -> ModalBody {
    let mean = |r: PatchFlexibility| {
        let [own0, mutual, own1] = r.at([0.0; 2]);
        PatchFlexibility::constant([[0.25 * (own0 + 2.0 * mutual + own1); 2]; 2])
    };
    ModalBody {
        participation: body.participation.iter().map(|phi| [0.5 * (phi[0] + phi[1]); 2]).collect(),
        residual: body.residual.map(mean),
        ..body.clone()
    }
}
