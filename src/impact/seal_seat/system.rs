//! The reduced seal seat: modes, contact nodes, rigid sphere and actuator, and their state.
//!
//! Half the bodies (y >= 0) with half the rigid masses; whoever reports doubles forces, impulses and energies.

use super::candidates::{Candidate, Partner};
use super::contact::Contact;
use super::nodes::{Ball, Nodes};
use super::survey::Survey;
use crate::body::solid::InterfaceBody;
use crate::error::{Error, Result};
use crate::scene::SealSeat;

/// Oscillators and rigid bodies, joined by unilateral contact.
#[derive(Debug, Clone)]
pub struct System {
    /// Eigenfrequencies in rad/s, ascending. Shape (N).
    pub omega: Vec<f64>,
    /// Mass-normalised shapes at the candidates in kg^(-1/2), x, y, z of each. Shape (N, 3 n).
    pub participation: Vec<Vec<f64>>,
    /// Nodes that may be touched. Shape (n).
    pub candidates: Vec<Candidate>,
    /// Half the sphere's mass in kg.
    pub sphere_mass: f64,
    /// Half the actuator's mass in kg.
    pub actuator_mass: f64,
    /// Speed of the actuator at the start in m/s.
    pub speed: f64,
    /// The sphere and the tips at the start.
    pub balls: Vec<Ball>,
    /// The candidates as the contact problem has them.
    pub nodes: Nodes,
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
        let mut balls = vec![Ball { centre: [x, 0.0, z], radius: scene.sphere.radius }];
        let radius = scene.actuator.tip_radius;
        balls
            .extend(scene.actuator.tip_positions.iter().map(|&x| Ball { centre: [x, 0.0, -radius], radius }));
        let ball = |candidate: &Candidate| match candidate.partner {
            Partner::Sphere => 0,
            Partner::Tip(tip) => 1 + tip,
        };
        let place = candidates.iter().map(|c| c.place).collect();
        Ok(Self {
            omega: body.omega[..modes].to_vec(),
            participation: body.participation[..modes].to_vec(),
            candidates: candidates.to_vec(),
            sphere_mass: 0.5 * scene.sphere.mass,
            actuator_mass: 0.5 * scene.actuator.mass,
            speed: scene.actuator.speed,
            nodes: Nodes::new(place, candidates.iter().map(ball).collect(), &residual),
            balls,
        })
    }

    /// The state at t = 0: the actuator arrives, everything else rests.
    pub fn start(&self) -> State {
        let modes = self.omega.len();
        State {
            modal: vec![0.0; modes],
            modal_velocity: vec![0.0; modes],
            sphere: [0.0; 2],
            sphere_velocity: [0.0; 2],
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
    /// Displacement of the sphere along x and z in m.
    pub sphere: [f64; 2],
    /// Its velocity in m/s.
    pub sphere_velocity: [f64; 2],
    /// Displacement of the actuator along z in m.
    pub actuator: f64,
    /// Its velocity in m/s.
    pub actuator_velocity: f64,
}

/// Forces of the contacts at one instant, of the half bodies.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Forces {
    /// Generalised forces on the modes in N kg^(-1/2). Shape (N).
    pub modal: Vec<f64>,
    /// Force on the sphere along x and z in N.
    pub sphere: [f64; 2],
    /// Force on the actuator along z in N: not positive.
    pub actuator: f64,
    /// Sums of the normal forces on the flanks at the -x and the +x side of the seat's axis in N.
    pub flanks: [f64; 2],
    /// Largest distance in m of a loaded candidate from where its partner touches first, of sphere and tips.
    pub reach: [f64; 2],
}

/// Room for the evaluation of forces, and the contact problem's last solution.
#[derive(Debug, Clone)]
pub struct Workspace<'a> {
    /// Contact problem.
    pub contact: Contact<'a>,
    displaced: Vec<f64>,
    balls: Vec<Ball>,
}

impl<'a> Workspace<'a> {
    /// Room for `system`.
    pub fn new(system: &'a System) -> Self {
        Self {
            contact: Contact::new(&system.nodes),
            displaced: vec![0.0; 3 * system.candidates.len()],
            balls: system.balls.clone(),
        }
    }

    /// Evaluates the contact forces at `state`.
    ///
    /// # Errors
    /// As [`Contact::solve`].
    pub fn forces(&mut self, system: &System, state: &State, forces: &mut Forces) -> Result<()> {
        self.place(system, state);
        self.contact.solve(&self.displaced, &self.balls)?;
        forces.modal.clear();
        forces.modal.resize(system.omega.len(), 0.0);
        (forces.sphere, forces.actuator, forces.flanks, forces.reach) = ([0.0; 2], 0.0, [0.0; 2], [0.0; 2]);
        for &i in self.contact.active() {
            let f = self.contact.force_vector(i);
            let candidate = &system.candidates[i];
            for (sum, shape) in forces.modal.iter_mut().zip(&system.participation) {
                *sum += shape[3 * i] * f[0] + shape[3 * i + 1] * f[1] + shape[3 * i + 2] * f[2];
            }
            let partner = match candidate.partner {
                Partner::Sphere => {
                    forces.sphere[0] -= f[0];
                    forces.sphere[1] -= f[2];
                    forces.flanks[usize::from(candidate.right_flank)] += self.contact.force(i);
                    0
                }
                Partner::Tip(_) => {
                    forces.actuator -= f[2];
                    1
                }
            };
            if self.contact.force(i) > 0.0 {
                forces.reach[partner] = forces.reach[partner].max(candidate.offset);
            }
        }
        Ok(())
    }

    /// Looks at all candidates at `state`, whose forces have been evaluated: see [`Contact::survey`].
    pub fn survey(&mut self, system: &System, state: &State, margin: f64) -> Survey {
        self.place(system, state);
        self.contact.survey(&self.displaced, &self.balls, margin)
    }

    /// Puts the candidates without contact, and the balls, where `state` has them.
    fn place(&mut self, system: &System, state: &State) {
        self.displaced.fill(0.0);
        for (shape, &q) in system.participation.iter().zip(&state.modal) {
            self.displaced.iter_mut().zip(shape).for_each(|(u, phi)| *u += q * phi);
        }
        for (number, (ball, start)) in self.balls.iter_mut().zip(&system.balls).enumerate() {
            if number == 0 {
                ball.centre[0] = start.centre[0] + state.sphere[0];
                ball.centre[2] = start.centre[2] + state.sphere[1];
            } else {
                ball.centre[2] = start.centre[2] + state.actuator;
            }
        }
    }

    /// Energy in J of the half bodies.
    pub fn energy(&self, system: &System, state: &State) -> f64 {
        let modes = system.omega.iter().zip(&state.modal).zip(&state.modal_velocity);
        let modal: f64 = modes.map(|((omega, q), v)| 0.5 * (v * v + (omega * q).powi(2))).sum();
        let sphere = 0.5 * system.sphere_mass * state.sphere_velocity.iter().map(|v| v * v).sum::<f64>();
        let actuator = 0.5 * system.actuator_mass * state.actuator_velocity.powi(2);
        modal + sphere + actuator + self.contact.energy()
    }
}
