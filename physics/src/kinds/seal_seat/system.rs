//! The reduced seal seat: modes, contact nodes, rigid sphere and actuator, and their state.
//!
//! Half the bodies (y >= 0) with half the rigid masses; whoever reports doubles forces, impulses and energies.

use super::SealSeat;
use super::candidates::{Candidate, ContactBody, on_half_space};
use super::contact::ContactProblem;
use super::friction::Friction;
use super::nodes::{Ball, Nodes};
use super::survey::Survey;
use super::traces::Traces;
use crate::body::solid::InterfaceBody;
use crate::error::{Error, Result};
use crate::material::Relaxation;
use nalgebra::Vector3;

/// Oscillators and rigid bodies, joined by unilateral contact.
#[derive(Debug, Clone)]
pub struct System {
    /// Eigenfrequencies in rad/s, ascending. Shape (N).
    pub omega: Vec<f64>,
    /// Mass-normalised shapes at the candidates in kg^(-1/2), x, y, z of each. Shape (N, 3 n).
    pub participation: Vec<Vec<f64>>,
    /// How the seat relaxes; empty if it is elastic.
    pub relaxation: Vec<Relaxation>,
    /// Nodes that may be touched. Shape (n).
    pub candidates: Vec<Candidate>,
    /// Half the sphere's mass in kg.
    pub sphere_mass: f64,
    /// Half its moment of inertia in kg m^2.
    pub sphere_inertia: f64,
    /// Half the actuator's mass in kg.
    pub actuator_mass: f64,
    /// Speed of the actuator at the start in m/s.
    pub speed: f64,
    /// Indentation in m by a tip if the seat were a heavy half-space (Hertz): the scale of the contacts' displacements.
    pub indentation: f64,
    /// The sphere and the tips at the start.
    pub balls: Vec<Ball>,
    /// The candidates as the contact problem has them.
    pub nodes: Nodes,
    /// Coulomb's coefficient of friction of the seat with sphere and tips.
    pub friction: f64,
}

impl System {
    /// The scene's bodies with the `modes` lowest modes of the seat.
    ///
    /// # Errors
    /// [`Error::Usage`] if the seat was built with fewer modes.
    pub fn new(
        scene: &SealSeat,
        body: &InterfaceBody,
        candidates: &[Candidate],
        modes: usize,
    ) -> Result<Self> {
        if body.size() != 3 * candidates.len() {
            return Err(Error::Internal("the seat's interface is not its contact candidates".into()));
        }
        let residual = body.residual(modes)?;
        let [x, z] = scene.ring().sphere_centre;
        let mut balls =
            vec![Ball { centre: Vector3::new(x, 0.0, z), radius: scene.sphere.radius, turn: 0.0 }];
        let radius = scene.actuator.tip_radius;
        balls.extend(scene.actuator.tip_positions.iter().map(|&x| Ball {
            centre: Vector3::new(x, 0.0, -radius),
            radius,
            turn: 0.0,
        }));
        let ball = |candidate: &Candidate| match candidate.contact_body {
            ContactBody::Sphere => 0,
            ContactBody::Tip(tip) => 1 + tip,
        };
        let place = candidates.iter().map(|c| c.place).collect();
        Ok(Self {
            omega: body.omega[..modes].to_vec(),
            participation: body.participation[..modes].to_vec(),
            relaxation: scene.seat.material.relaxation.clone(),
            candidates: candidates.to_vec(),
            sphere_mass: 0.5 * scene.sphere.mass,
            sphere_inertia: 0.5 * 0.4 * scene.sphere.mass * scene.sphere.radius.powi(2),
            friction: scene.friction,
            actuator_mass: 0.5 * scene.actuator.mass,
            speed: scene.actuator.speed,
            indentation: on_half_space(scene).approach_peak(),
            nodes: Nodes::new(
                place,
                candidates.iter().map(ball).collect(),
                &body.participation[..modes],
                &residual,
            ),
            balls,
        })
    }

    /// What the elastic energy in J of mode `k` at `q` lacks for its internal variables `xi`.
    fn relaxed_energy(&self, k: usize, q: f64, xi: &[f64]) -> f64 {
        let terms = self.relaxation.iter().zip(xi);
        0.5 * self.omega[k].powi(2)
            * terms.map(|(term, xi)| term.ratio * ((q - xi).powi(2) - q * q)).sum::<f64>()
    }

    /// The state at t = 0: the actuator arrives, everything else rests.
    pub fn start(&self) -> State {
        let modes = self.omega.len();
        State {
            modal: vec![0.0; modes],
            modal_velocity: vec![0.0; modes],
            relaxed: vec![0.0; modes * self.relaxation.len()],
            sphere: [0.0; 2],
            sphere_velocity: [0.0; 2],
            turn: 0.0,
            spin: 0.0,
            actuator: 0.0,
            actuator_velocity: self.speed,
        }
    }
}

/// Positions since the start, and velocities.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Mass-normalised coordinates q in m kg^(1/2). Shape (N).
    pub modal: Vec<f64>,
    /// Their rates. Shape (N).
    pub modal_velocity: Vec<f64>,
    /// Internal variables of the material, as q. Shape (N, terms), empty of an elastic seat.
    pub relaxed: Vec<f64>,
    /// Displacement of the sphere along x and z in m.
    pub sphere: [f64; 2],
    /// Its velocity in m/s.
    pub sphere_velocity: [f64; 2],
    /// Its turn about y in rad, from z to x.
    pub turn: f64,
    /// Its spin in rad/s.
    pub spin: f64,
    /// Displacement of the actuator along z in m.
    pub actuator: f64,
    /// Its velocity in m/s.
    pub actuator_velocity: f64,
}

/// Forces of the contacts at one instant, of the half bodies; see [`Workspace::forces`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Forces {
    /// Generalised forces on the modes in N kg^(-1/2). Shape (N).
    pub modal: Vec<f64>,
    /// Force on the sphere along x and z in N.
    pub sphere: [f64; 2],
    /// Torque on it about y in N m.
    pub torque: f64,
    /// Force on the actuator along z in N: not positive.
    pub actuator: f64,
    /// Force on the seat along z in N.
    pub seat: f64,
    /// Sums of the normal forces on the flanks at the -x and the +x side of the seat's axis in N.
    pub flanks: [f64; 2],
    /// Largest distance in m of a loaded candidate from where its partner touches first, of sphere and tips.
    pub reach: [f64; 2],
}

impl Forces {
    fn clear(&mut self, modes: usize) {
        self.modal.clear();
        self.modal.resize(modes, 0.0);
        (self.sphere, self.torque, self.actuator, self.seat) = ([0.0; 2], 0.0, 0.0, 0.0);
        (self.flanks, self.reach) = ([0.0; 2], [0.0; 2]);
    }

    /// Adds the force `f` in N on the seat at candidate `i`, of which `normal` is along the normal.
    fn add(&mut self, system: &System, i: usize, f: Vector3<f64>, normal: f64) {
        let candidate = &system.candidates[i];
        for (sum, shape) in self.modal.iter_mut().zip(&system.participation) {
            *sum += shape[3 * i] * f[0] + shape[3 * i + 1] * f[1] + shape[3 * i + 2] * f[2];
        }
        self.seat += f[2];
        match candidate.contact_body {
            ContactBody::Sphere => {
                self.sphere[0] -= f[0];
                self.sphere[1] -= f[2];
                self.flanks[usize::from(candidate.right_flank)] += normal;
            }
            ContactBody::Tip(_) => self.actuator -= f[2],
        }
    }
}

/// Room for the evaluation of forces, and the contact problem's last solution.
#[derive(Debug, Clone)]
pub struct Workspace<'a> {
    /// Contact problem.
    pub contact: ContactProblem<'a>,
    /// Of the modes; as many as them.
    accelerations: Vec<f64>,
    balls: Vec<Ball>,
}

impl<'a> Workspace<'a> {
    /// Room for `system`, which yields within a step as `nodes` do, remembers `traces` if it relaxes, and has `friction` if it is rough.
    pub(super) fn new(
        system: &System,
        nodes: &'a Nodes,
        traces: Option<Traces>,
        friction: Option<Friction>,
    ) -> Self {
        Self {
            contact: ContactProblem::new(nodes, system.indentation, traces, friction),
            accelerations: Vec::new(),
            balls: system.balls.clone(),
        }
    }

    /// Evaluates the contact forces at `state`, corrected for kicks over steps of `step` in s: F - step^2/12 H M^-1 F with the
    /// masses M and the stiffness H of the contacts, the forces at the place that the accelerations would shift by step^2/12.
    /// Where a node touches or lets go H is that of the contact set.
    ///
    /// # Errors
    /// As [`ContactProblem::solve`].
    pub fn forces(&mut self, system: &System, state: &State, step: f64, forces: &mut Forces) -> Result<()> {
        self.place(system, state);
        self.contact.solve(&state.modal, &self.balls)?;
        self.contact.book(&self.balls);
        forces.clear(system.omega.len());
        for &i in self.contact.active() {
            let force = self.contact.force(i);
            forces.add(system, i, self.contact.force_vector(i), force);
            let on_sphere = system.candidates[i].contact_body == ContactBody::Sphere;
            if on_sphere {
                forces.torque += self.contact.torque(i);
            }
            let contact_body = usize::from(!on_sphere);
            if force > 0.0 {
                forces.reach[contact_body] = forces.reach[contact_body].max(system.candidates[i].offset);
            }
        }
        if !self.contact.active().is_empty() {
            self.correct(system, step * step / 12.0, forces);
        }
        Ok(())
    }

    /// Adds what the contacts answer when all accelerations under `forces` act for `shift` in s^2.
    fn correct(&mut self, system: &System, shift: f64, forces: &mut Forces) {
        let Self { contact, accelerations, .. } = self;
        accelerations.clone_from(&forces.modal);
        let [x, z] = forces.sphere.map(|f| f / system.sphere_mass);
        let actuator = forces.actuator / system.actuator_mass;
        let turn = forces.torque / system.sphere_inertia;
        let relative = |i: usize, from_centre: &Vector3<f64>| {
            let mut a = match system.candidates[i].contact_body {
                ContactBody::Sphere => {
                    Vector3::new(-x, 0.0, -z) - turn * Vector3::new(from_centre.z, 0.0, -from_centre.x)
                }
                ContactBody::Tip(_) => Vector3::new(0.0, 0.0, -actuator),
            };
            for (q, shape) in accelerations.iter().zip(&system.participation) {
                a.iter_mut().zip(&shape[3 * i..]).for_each(|(a, s)| *a += q * s);
            }
            a
        };
        contact.respond(shift, relative, |i, from_centre, normal, change| {
            forces.add(system, i, change, normal);
            if system.friction > 0.0 && system.candidates[i].contact_body == ContactBody::Sphere {
                forces.torque += from_centre.x * change.z - from_centre.z * change.x;
            }
        });
    }

    /// Looks at all candidates at `state`, whose forces have been evaluated: see [`ContactProblem::survey`].
    pub fn survey(&mut self, system: &System, state: &State, margin: f64) -> Survey {
        self.place(system, state);
        self.contact.survey(&state.modal, &self.balls, margin)
    }

    /// Puts the balls where `state` has them.
    fn place(&mut self, system: &System, state: &State) {
        for (number, (ball, start)) in self.balls.iter_mut().zip(&system.balls).enumerate() {
            if number == 0 {
                ball.centre[0] = start.centre[0] + state.sphere[0];
                ball.centre[2] = start.centre[2] + state.sphere[1];
                ball.turn = state.turn;
            } else {
                ball.centre[2] = start.centre[2] + state.actuator;
            }
        }
    }

    /// Energy in J of the half bodies, with what contact nodes that relax have lost.
    pub fn energy(&self, system: &System, state: &State) -> f64 {
        let modes = system.omega.iter().zip(&state.modal).zip(&state.modal_velocity);
        let modal: f64 = modes.map(|((omega, q), v)| 0.5 * (v * v + (omega * q).powi(2))).sum();
        let relaxed = state.relaxed.chunks(system.relaxation.len().max(1));
        let relaxing: f64 =
            relaxed.enumerate().map(|(k, xi)| system.relaxed_energy(k, state.modal[k], xi)).sum();
        let sphere = 0.5 * system.sphere_mass * state.sphere_velocity.iter().map(|v| v * v).sum::<f64>();
        let turning = 0.5 * system.sphere_inertia * state.spin.powi(2);
        let actuator = 0.5 * system.actuator_mass * state.actuator_velocity.powi(2);
        modal + relaxing + sphere + turning + actuator + self.contact.energy()
    }
}
