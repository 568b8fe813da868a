//! Coulomb's friction at the contact nodes of the seat.
//!
//! A node in contact sticks, so that from one instant to the next it moves along with the ball's surface, or slides: then its
//! tangential force is friction times its normal force, against the sliding. With the displacements of nodes by tangential forces known,
//! this is a problem of forces within circles. It is solved node by node, again and again (Gauss-Seidel; Jourdan, Alart and Jean 1998,
//! Comput. Methods Appl. Mech. Eng. 155, 31), in turn with the normal forces (Panagiotopoulos 1975, Ing.-Arch. 44, 421).

use super::contact::ContactProblem;
use super::nodes::Ball;
use crate::error::{Error, Result};
use nalgebra::{Matrix3, Vector3};

/// Largest change of the tangential forces by a pass over all nodes, and by a further solution of the normal forces, over friction times the
/// normal forces.
const SETTLED: f64 = 1e-5;
/// Most passes, and most turns of normal and tangential forces.
const MOST_PASSES: usize = 400;
const MOST_TURNS: usize = 100;

/// Tangential forces, and what they go by.
#[derive(Debug, Clone)]
pub(super) struct Friction {
    coefficient: f64,
    /// On the candidates in N. Shape (n).
    pub(super) force: Vec<Vector3<f64>>,
    /// Forces on the candidates at the instant before in N, zero where there was no contact, and who was in contact. Shape (n).
    force_before: Vec<Vector3<f64>>,
    touched: Vec<bool>,
    /// From the balls' centres to the candidates at the instant before in m, and the balls' turns in rad.
    offset: Vec<Vector3<f64>>,
    turn: Vec<f64>,
    /// Work of the friction on all bodies so far in J, not positive.
    work: f64,
}

impl Friction {
    /// Of `n` candidates against `balls`, without forces.
    pub(super) fn new(coefficient: f64, n: usize, balls: usize) -> Self {
        Self {
            coefficient,
            force: vec![Vector3::zeros(); n],
            force_before: vec![Vector3::zeros(); n],
            touched: vec![false; n],
            offset: vec![Vector3::zeros(); n],
            turn: vec![0.0; balls],
            work: 0.0,
        }
    }

    /// Energy in J that sliding nodes have dissipated.
    pub(super) fn dissipated(&self) -> f64 {
        -self.work
    }

    /// Puts candidate `i` at `offset` m from the centre of its ball.
    pub(super) fn put(&mut self, i: usize, offset: Vector3<f64>) {
        self.offset[i] = offset;
    }

    /// Motion in m of candidate `i` over the surface of its ball since the instant before, in the plane across `normal`.
    fn slip(&self, i: usize, offset: Vector3<f64>, normal: Vector3<f64>, turned: f64) -> Vector3<f64> {
        let moved = offset - self.offset[i] - turned * Vector3::new(offset.z, 0.0, -offset.x);
        moved - normal.dot(&moved) * normal
    }
}

/// A node in contact during a pass.
struct Sticking {
    candidate: usize,
    normal: Vector3<f64>,
    /// Largest tangential force in N.
    most: f64,
    /// Turn of its ball since the instant before, rad.
    turned: f64,
    /// Largest displacement along the surface per force along it, m/N.
    compliance: f64,
}

impl ContactProblem<'_> {
    /// Finds normal and tangential forces in turn.
    pub(super) fn solve_with_friction(&mut self, modal: &[f64], balls: &[Ball]) -> Result<()> {
        for _ in 0..MOST_TURNS {
            self.solve_normal(modal, balls)?;
            if self.stick(balls)? <= SETTLED {
                return Ok(());
            }
        }
        Err(self.not_settled(MOST_TURNS))
    }

    fn not_settled(&self, rounds: usize) -> Error {
        Error::Solver(format!(
            "the friction forces of the seal seat did not converge in {rounds} iterations with {} nodes in contact",
            self.loads.active.len()
        ))
    }

    /// Finds the tangential forces under the present normal forces; how much they have changed, over friction times these.
    fn stick(&mut self, balls: &[Ball]) -> Result<f64> {
        let Some(mut friction) = self.loads.friction.take() else { return Ok(0.0) };
        let nodes = self.nodes_that_stick(&friction, balls);
        let all: f64 = nodes.iter().map(|node| node.most).sum();
        let before = friction.force.clone();
        let part = 0..self.watch.up_to(&self.loads.active);
        let mut passes = 0;
        let settled = loop {
            let mut changed = 0.0;
            for node in &nodes {
                let i = node.candidate;
                let (offset, _) = self.watch.off_centre(i);
                let slip = friction.slip(i, offset, node.normal, node.turned);
                let old = friction.force[i];
                let wanted = old - node.normal.dot(&old) * node.normal - slip / node.compliance;
                let size = wanted.norm();
                let new = if size > node.most { wanted * (node.most / size) } else { wanted };
                friction.force[i] = new;
                changed += (new - old).norm();
                self.watch.deform_further(self.nodes, (i, new - old), part.clone());
            }
            passes += 1;
            if changed <= SETTLED * all || passes == MOST_PASSES {
                break changed <= SETTLED * all;
            }
        };
        let change: f64 = before.iter().zip(&friction.force).map(|(a, b)| (a - b).norm()).sum();
        self.work.passes += passes as u64;
        self.loads.friction = Some(friction);
        self.deform_from(0, self.watch.len());
        if settled {
            Ok(if all > 0.0 { change / all } else { 0.0 })
        } else {
            Err(self.not_settled(MOST_PASSES))
        }
    }

    /// The nodes that have been in contact since the instant before; one that has just touched has not slid yet.
    fn nodes_that_stick(&mut self, friction: &Friction, balls: &[Ball]) -> Vec<Sticking> {
        let mut nodes = Vec::with_capacity(self.loads.active.len());
        for &i in self.loads.active.iter().filter(|&&i| friction.touched[i]) {
            let normal = self.loads.normal[i];
            let compliance = self.watch.own_compliance(self.nodes, i);
            let across = Matrix3::identity() - normal * normal.transpose();
            let ball = self.nodes.ball[i];
            nodes.push(Sticking {
                candidate: i,
                normal,
                most: friction.coefficient * self.loads.force[i].max(0.0),
                turned: balls[ball].turn - friction.turn[ball],
                compliance: (across * compliance * across).symmetric_eigenvalues().max(),
            });
        }
        nodes
    }

    /// Ends an instant whose forces have been found: books the work of friction since the one before.
    pub(super) fn book_friction(&mut self, balls: &[Ball]) {
        let Some(mut friction) = self.loads.friction.take() else { return };
        for slot in 0..self.watch.len() {
            let i = self.watch.node(slot);
            let (offset, ball) = self.watch.off_centre(i);
            let both = friction.force[i] + friction.force_before[i];
            if both != Vector3::zeros() {
                let turned = balls[ball].turn - friction.turn[ball];
                friction.work += 0.5 * both.dot(&friction.slip(i, offset, offset.normalize(), turned));
            }
            friction.put(i, offset);
        }
        friction.force_before.clone_from(&friction.force);
        friction.touched.fill(false);
        self.loads.active.iter().for_each(|&i| friction.touched[i] = true);
        friction.turn.iter_mut().zip(balls).for_each(|(turn, ball)| *turn = ball.turn);
        self.loads.friction = Some(friction);
    }
}
