//! A body beside the plate as oscillators, in the state in which the impact begins.

use super::duhamel::Oscillator;
use crate::actuator::beam::Release;
use crate::actuator::cantilever;
use crate::error::Result;
use crate::result::Drive;
use crate::scene::{Material, Outer, PlateImpact, Shape};

/// Outer or inner body: mass-normalised coordinates that move its contact point, and their state at t = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingBody {
    /// The oscillators. Shape (n).
    pub oscillators: Vec<Oscillator>,
    /// Displacement of the contact point along +z per unit of each coordinate, kg^(-1/2). Shape (n).
    pub tip: Vec<f64>,
    /// Coordinates at t = 0. Shape (n).
    pub displacement: Vec<f64>,
    /// Their rates at t = 0. Shape (n).
    pub velocity: Vec<f64>,
    /// Mass in kg that has the body's kinetic energy at the speed of its contact point.
    pub mass: f64,
    /// How it was driven, if it is a bender.
    pub drive: Option<Drive>,
}

impl MovingBody {
    /// The outer and the inner body of a scene.
    ///
    /// # Errors
    /// As [`MovingBody::outer`].
    pub fn both(setup: &PlateImpact) -> Result<[Self; 2]> {
        Ok([Self::outer(&setup.outer)?, Self::rigid_inner(setup)])
    }

    /// Both as rigid bodies; a bender is none.
    pub(super) fn both_rigid(setup: &PlateImpact) -> [Self; 2] {
        debug_assert!(!matches!(setup.outer.shape, Shape::Bender(_)), "a bender is no rigid body");
        [Self::rigid_outer(&setup.outer), Self::rigid_inner(setup)]
    }

    /// The outer body of a scene: rigid, or a bender with the modes of its beam.
    ///
    /// # Errors
    /// As [`Release::new`].
    pub fn outer(outer: &Outer) -> Result<Self> {
        let Shape::Bender(bender) = &outer.shape else {
            return Ok(Self::rigid_outer(outer));
        };
        let release = Release::new(bender)?;
        let torque = outer.speed / release.speed_per_moment;
        let scaled = |values: &[f64]| values.iter().map(|value| value * torque).collect::<Vec<f64>>();
        let velocity = scaled(&release.velocity);
        let kinetic_energy = 0.5 * velocity.iter().map(|v| v * v).sum::<f64>();
        let (length, stiffness) = (bender.length, bender.bending_stiffness);
        Ok(Self {
            oscillators: release.beam.omega.iter().map(|&omega| Oscillator { omega, alpha: 0.0 }).collect(),
            tip: release.beam.tip.clone(),
            displacement: scaled(&release.displacement),
            velocity,
            mass: 2.0 * kinetic_energy / outer.speed.powi(2),
            drive: Some(Drive {
                torque,
                tip_deflection: torque / cantilever::moment_for_deflection(length, stiffness, 1.0),
                strain_energy: cantilever::moment_energy(length, stiffness, torque),
                kinetic_energy,
                strike_delay: release.time,
            }),
        })
    }

    fn rigid_outer(outer: &Outer) -> Self {
        Self::rigid(&outer.shape, &outer.material, -outer.speed)
    }

    fn rigid_inner(setup: &PlateImpact) -> Self {
        Self::rigid(&setup.inner.shape, &setup.inner.material, setup.inner.speed)
    }

    /// A rigid body that begins with `velocity` m/s along z.
    fn rigid(shape: &Shape, material: &Material, velocity: f64) -> Self {
        let mass = shape.mass(material);
        Self {
            oscillators: vec![Oscillator { omega: 0.0, alpha: 0.0 }],
            tip: vec![1.0 / mass.sqrt()],
            displacement: vec![0.0],
            velocity: vec![velocity * mass.sqrt()],
            mass,
            drive: None,
        }
    }
}
