//! A striking or struck body as oscillators, in the state in which the impact begins.

use super::system::dot;
use crate::actuator::beam::Release;
use crate::actuator::cantilever;
use crate::actuator::circuit::{self, Circuit};
use crate::actuator::stack::{MODES, RodMode, Stack};
use crate::error::{Error, Result};
use crate::numerics::duhamel::{Feed, Oscillator};
use crate::numerics::root::first_fall;
use crate::result::Drive;
use crate::scene::{Inner, Material, Outer, Shape};
use std::cell::Cell;

/// Time in radians of the slowest mode after which a stack that has not touched never will.
const PATIENCE: f64 = 60.0;

/// Outer or inner body: mass-normalised coordinates that move its contact point, and their state at t = 0.
#[derive(Debug, Clone)]
pub struct MovingBody {
    /// The oscillators. Shape (n).
    pub oscillators: Vec<Oscillator>,
    /// Displacement of the contact point along +z per unit of each coordinate, kg^(-1/2). Shape (n).
    pub tip: Vec<f64>,
    /// Coordinates at t = 0. Shape (n).
    pub displacement: Vec<f64>,
    /// Their rates at t = 0. Shape (n).
    pub velocity: Vec<f64>,
    /// Radius of curvature at the contact point, m.
    pub tip_radius: f64,
    /// Material at the contact point.
    pub material: Material,
    /// Coulomb's coefficient there.
    pub friction: f64,
    /// Speed towards the plate in m/s at t = 0; of a stack that of its tip after a step of the voltage.
    pub speed: f64,
    /// Mass in kg that has the body's kinetic energy at the speed of its contact point.
    pub mass: f64,
    /// How it was driven, if it is a bender.
    pub drive: Option<Drive>,
    /// Distance in m to the plate with all coordinates at zero; negative where they are displaced at the touch.
    pub clearance: f64,
    /// The stack that it is, which may press on the plate for ever.
    pub stack: Option<Stack>,
    /// What supplies it while it strikes, if it is a stack behind a resistor: what the force does to each coordinate. Shape (n).
    pub supply: Option<(Circuit, Vec<Feed>)>,
}

impl MovingBody {
    /// The outer and the inner body of an impact.
    ///
    /// # Errors
    /// As [`MovingBody::outer`].
    pub fn both(outer: &Outer, inner: &Inner) -> Result<[Self; 2]> {
        Ok([Self::outer(outer)?, Self::inner(inner)])
    }

    /// Both as rigid bodies; a bender is none.
    pub fn both_rigid(outer: &Outer, inner: &Inner) -> [Self; 2] {
        debug_assert!(!outer.shape.is_mounted(), "a bender or a stack is no rigid body");
        [Self::rigid_outer(outer), Self::inner(inner)]
    }

    /// The outer body: rigid, a bender with the modes of its beam, or a stack with those of its rod.
    ///
    /// # Errors
    /// As [`Release::new`]; [`Error::Solver`] for a stack that does not reach the plate, and as [`Circuit::new`].
    pub fn outer(outer: &Outer) -> Result<Self> {
        let bender = match &outer.shape {
            Shape::Bender(bender) => bender,
            Shape::Stack(stack) => {
                let friction = outer.turning.friction;
                return Ok(Self { friction, ..Self::stack(stack, &outer.material)? });
            }
            Shape::Sphere { .. } | Shape::Compact { .. } => return Ok(Self::rigid_outer(outer)),
        };
        let release = Release::new(bender)?;
        let torque = outer.speed / release.speed_per_moment;
        let scaled = |values: &[f64]| values.iter().map(|value| value * torque).collect::<Vec<f64>>();
        let velocity = scaled(&release.velocity);
        let kinetic_energy = 0.5 * velocity.iter().map(|v| v * v).sum::<f64>();
        let (length, stiffness) = (bender.length, bender.bending_stiffness);
        let strikes_at = torque * dot(&release.beam.tip, &release.displacement);
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
            clearance: if bender.strike_at == 0.0 { 0.0 } else { -strikes_at },
            stack: None,
            supply: None,
            tip_radius: bender.tip_radius,
            material: outer.material.clone(),
            friction: outer.turning.friction,
            speed: outer.speed,
        })
    }

    /// A stack with a tip of `material` that is switched on, in the state in which its tip touches; its coordinates are those about its
    /// rest.
    ///
    /// # Errors
    /// [`Error::Solver`] if it does not reach the plate, and as [`Circuit::new`].
    fn stack(stack: &Stack, material: &Material) -> Result<Self> {
        let supply = stack.resistive_drive().map(|supply| Circuit::new(stack, supply)).transpose()?;
        let rest = Self {
            oscillators: Vec::new(),
            tip: Vec::new(),
            displacement: Vec::new(),
            velocity: Vec::new(),
            tip_radius: stack.tip_radius,
            material: material.clone(),
            friction: 0.0,
            speed: stack.step_speed(),
            mass: stack.mass(),
            drive: None,
            clearance: 0.0,
            stack: Some(*stack),
            supply: None,
        };
        let mut body = match supply {
            Some(circuit) => {
                let each =
                    |value: fn(&circuit::CircuitMode) -> f64| circuit.modes.iter().map(value).collect();
                Self {
                    oscillators: circuit.modes.iter().map(|mode| mode.oscillator).collect(),
                    tip: each(|mode| -mode.tip),
                    displacement: each(|mode| mode.start[0]),
                    velocity: each(|mode| mode.start[1]),
                    clearance: stack.gap - circuit.final_extension(),
                    supply: Some((circuit.clone(), circuit.modes.iter().map(|mode| mode.feed).collect())),
                    ..rest
                }
            }
            None => {
                let modes = stack.modes(MODES);
                let still = |mode: &RodMode| -stack.blocked_force * mode.tip / mode.omega.powi(2);
                Self {
                    oscillators: modes.iter().map(|m| Oscillator { omega: m.omega, alpha: 0.0 }).collect(),
                    tip: modes.iter().map(|mode| -mode.tip).collect(),
                    displacement: modes.iter().map(still).collect(),
                    velocity: vec![0.0; modes.len()],
                    clearance: stack.gap - stack.stroke,
                    ..rest
                }
            }
        };
        if stack.gap > 0.0 {
            body.fly_to_contact(stack)?;
        }
        Ok(body)
    }

    /// Moves on, freely, until the tip touches the plate.
    fn fly_to_contact(&mut self, stack: &Stack) -> Result<()> {
        // |x''| of the tip is bounded by the modes' amplitudes
        let bound: f64 = (0..self.tip.len())
            .map(|k| {
                let Oscillator { omega, alpha } = self.oscillators[k];
                let amplitude = self.tip[k].abs() * self.displacement[k].hypot(self.velocity[k] / omega);
                amplitude * omega * (omega + 2.0 * alpha)
            })
            .sum();
        let slowest = self.oscillators.iter().map(|o| o.omega.min(o.omega.powi(2) / (2.0 * o.alpha)));
        let patience = PATIENCE / slowest.fold(f64::INFINITY, f64::min);
        let farthest = Cell::new(0.0_f64);
        let motion = |time: f64| {
            let (q, v) = self.after(time);
            let gap = self.clearance + dot(&self.tip, &q);
            farthest.set(farthest.get().max(stack.gap - gap));
            [gap, dot(&self.tip, &v)]
        };
        let time = first_fall(motion, [0.0, patience], bound, 1e-14 * stack.gap).ok_or_else(|| {
            Error::Solver(format!(
                "`outer.gap` is {} m, but the tip of the stack comes to {:.4e} m only: it never reaches the plate",
                stack.gap,
                farthest.get()
            ))
        })?;
        (self.displacement, self.velocity) = self.after(time);
        Ok(())
    }

    /// Coordinates and rates after `time` s without a force.
    fn after(&self, time: f64) -> (Vec<f64>, Vec<f64>) {
        let (mut q, mut v) = (self.displacement.clone(), self.velocity.clone());
        for ((oscillator, q), v) in self.oscillators.iter().zip(&mut q).zip(&mut v) {
            [*q, *v] = oscillator.after(time, [*q, *v]);
        }
        (q, v)
    }

    fn rigid_outer(outer: &Outer) -> Self {
        let stack = if let Shape::Stack(stack) = outer.shape { Some(stack) } else { None };
        let friction = outer.turning.friction;
        Self {
            stack,
            friction,
            ..Self::rigid(&outer.shape, &outer.material, [outer.speed, -outer.speed], 0.0)
        }
    }

    /// The inner body, which is rigid.
    pub fn inner(inner: &Inner) -> Self {
        let friction = inner.turning.friction;
        Self { friction, ..Self::rigid(&inner.shape, &inner.material, [inner.speed; 2], inner.gap) }
    }

    /// A rigid body that begins with the `velocity` in m/s towards the plate and along z, `clearance` m from it.
    fn rigid(shape: &Shape, material: &Material, velocity: [f64; 2], clearance: f64) -> Self {
        let mass = shape.mass(material);
        Self {
            oscillators: vec![Oscillator { omega: 0.0, alpha: 0.0 }],
            tip: vec![1.0 / mass.sqrt()],
            displacement: vec![0.0],
            velocity: vec![velocity[1] * mass.sqrt()],
            tip_radius: shape.tip_radius(),
            material: material.clone(),
            friction: 0.0,
            speed: velocity[0],
            mass,
            drive: None,
            clearance,
            stack: None,
            supply: None,
        }
    }
}
