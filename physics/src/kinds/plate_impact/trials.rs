//! Impacts with plates and spheres in closed form, which truncation errors are estimated with.
//!
//! The plate is Kirchhoff's or an elastic layer ([`crate::body::layer`]), which has shear, rotary inertia and the local
//! flexibility that Kirchhoff's plate on half-spaces has not; the spheres are Lur'e's ([`crate::body::free_sphere`]). Each
//! costs as much as a run of models A and B.

use super::PlateImpact;
use super::assembled::fluid_forces;
use super::errors::largest_error;
use super::predictor::Predictor;
use super::results::{PlateQuantities, quantities};
use crate::analytical::circular_plate::rigidity;
use crate::body::continuum::ContinuumPlate;
use crate::body::layer::Waves;
use crate::body::{ModalBody, free_sphere};
use crate::dynamics::MovingBody;
use crate::dynamics::integrate;
use crate::dynamics::integration::Options;
use crate::dynamics::system::System;
use crate::error::Result;
use crate::fluid::added_mass::{immersed, mass_factor};
use crate::scene::DEFAULT_MODES;
use std::f64::consts::PI;

/// Numbers of modes of the layer that are tried.
pub(super) const RUNGS: [usize; 26] =
    [1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192];
/// Difference of two numbers of modes over the error of the smaller, which is mostly within a tenth of it.
const SAFETY: f64 = 1.15;
/// Part of (contact frequency / lowest frequency left out)^2 that a truncated series of continuum modes may be off by beyond
/// what the layer, which has no longitudinal modes, tells.
const TRUNCATION_SHARE: f64 = 0.1;
/// What half-spaces yield beyond half-spaces: `tips` of models A and B, m/N.
const HALF_SPACES: [f64; 2] = [0.0; 2];

/// What a model lacks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TruncationError {
    /// Estimated relative error.
    pub(super) error: f64,
    /// The quantity that has it, if it is known.
    pub(super) quantity: Option<&'static str>,
}

impl TruncationError {
    /// The largest error of `candidate` against `exact` of the quantities covered; `speed` in m/s is that of the impact.
    pub(super) fn between(candidate: &PlateQuantities, exact: &PlateQuantities, speed: f64) -> Self {
        let (error, name) = largest_error(candidate, exact, speed);
        Self { error, quantity: Some(name) }
    }

    /// So many times as much.
    pub(super) fn times(self, factor: f64) -> Self {
        Self { error: factor * self.error, ..self }
    }

    /// The larger of two; what is not a number is the largest of all.
    pub(super) fn or(self, other: Self) -> Self {
        if self.error >= other.error || self.error.is_nan() { self } else { other }
    }
}

/// The bodies of a scene in closed form.
pub(super) struct Trials<'a> {
    setup: &'a PlateImpact,
    bodies: [MovingBody; 2],
    /// Kirchhoff's plate.
    pub(super) waves: Waves,
    layer: ContinuumPlate,
    pub(super) predictor: Predictor,
    options: Options,
    /// What the spheres yield beyond half-spaces, m/N.
    tips: [f64; 2],
}

impl<'a> Trials<'a> {
    /// For the impact `setup`, with as many modes as leave a truncation error of `resolution`, or as there are; integrated as
    /// `options` says.
    ///
    /// # Errors
    /// As [`super::reduced::Reduced::new`].
    pub(super) fn new(setup: &'a PlateImpact, resolution: f64, options: Options) -> Result<Self> {
        let bodies = MovingBody::both(&setup.outer, &setup.inner)?;
        let few = Waves::new(&setup.plate, DEFAULT_MODES);
        let predictor = Predictor::of(&system(setup, &bodies, few.kirchhoff(DEFAULT_MODES), HALF_SPACES))?;
        let enough = |n: &usize| slowed(setup, &predictor, few.frequency(*n + 1)) <= resolution;
        let most = RUNGS.into_iter().find(enough).unwrap_or(RUNGS[RUNGS.len() - 1]);
        let waves = if most > DEFAULT_MODES { Waves::new(&setup.plate, most) } else { few };
        let layer = waves.layer(predictor.patch_radius);
        Ok(Self {
            setup,
            bodies,
            waves,
            layer,
            predictor,
            options,
            tips: free_sphere::tip_residuals(&setup.outer, &setup.inner, predictor.patch_radius),
        })
    }

    /// Models A and B.
    pub(super) fn kirchhoff(&self, modes: usize) -> Result<PlateQuantities> {
        self.integrate(&self.half_spaces(modes), modes)
    }

    /// [`Self::kirchhoff`] with all modes: what is beyond those there are yields as under a static force, the sum of
    /// (w(0)/omega)^2 over k with w(0)^2 = k/2 and omega = k^2 in the plate's units, pi apart.
    pub(super) fn converged(&self) -> Result<PlateQuantities> {
        let modes = self.waves.modes();
        let plate = &self.setup.plate;
        let bending = rigidity(plate.material.youngs_modulus, plate.material.poisson_ratio, plate.thickness);
        let rest = plate.radius.powi(2) / (4.0 * PI * self.waves.cut().powi(2) * bending);
        let system = self.half_spaces(modes);
        // the inner contact closes when the plate moves down
        self.integrate(&system.softer([rest, -rest, rest]), modes)
    }

    /// Model C with a layer in the place of the continuum.
    pub(super) fn continuum(&self, modes: usize) -> Result<PlateQuantities> {
        self.integrate(&self.layered(modes), modes)
    }

    /// The layer with `modes` bending modes between the spheres.
    fn layered(&self, modes: usize) -> System {
        let plate = self.layer.modal_body(modes, self.predictor.slow());
        system(self.setup, &self.bodies, plate, self.tips)
    }

    /// Kirchhoff's plate with `modes` modes between bodies that are half-spaces to the contacts.
    fn half_spaces(&self, modes: usize) -> System {
        system(self.setup, &self.bodies, self.waves.kirchhoff(modes), HALF_SPACES)
    }

    fn integrate(&self, system: &System, modes: usize) -> Result<PlateQuantities> {
        let shapes = |radii: &[f64]| Ok(self.waves.shapes(modes, radii));
        let fluid = fluid_forces(self.setup, shapes)?;
        quantities(system, &integrate(system, fluid.as_ref(), &self.options)?)
    }

    /// Relative error of a force in model C when the bending modes beyond `modes` follow statically.
    pub(super) fn truncation(&self, modes: usize) -> f64 {
        slowed(self.setup, &self.predictor, self.layer.omega_next(modes))
    }

    /// Largest estimated error of the quantities covered that model C has with `modes` bending modes for want of more, and the
    /// quantity; `converged` is the layer with all its modes.
    pub(super) fn truncated(&self, modes: usize, converged: Option<&PlateQuantities>) -> TruncationError {
        let alone = self.truncation(modes);
        match (converged, self.continuum(modes)) {
            (Some(exact), Ok(ours)) => {
                let truncation = TruncationError::between(&ours, exact, self.setup.outer.speed);
                TruncationError { error: SAFETY * truncation.error + TRUNCATION_SHARE * alone, ..truncation }
            }
            _ => TruncationError { error: alone, quantity: None },
        }
    }
}

/// [`Predictor::truncation_error`] with the modes from `omega_next` rad/s on as slow as the fluid's mass makes them.
fn slowed(setup: &PlateImpact, predictor: &Predictor, omega_next: f64) -> f64 {
    let slower = setup.fluid.as_ref().map_or(1.0, |fluid| mass_factor(fluid.added_mass_frequency_ratio));
    slower * predictor.truncation_error(omega_next)
}

/// Joins plate and bodies.
fn system(setup: &PlateImpact, bodies: &[MovingBody; 2], plate: ModalBody, tips: [f64; 2]) -> System {
    let plate = match &setup.fluid {
        Some(fluid) => immersed(plate, fluid),
        None => plate,
    };
    System::of(bodies, &plate, &setup.plate.material, tips)
}
