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

/// Relative change of the tangential forces by a pass over all nodes at which they have settled, over the run's tolerance.
const SETTLED: f64 = 0.1;
/// Tangential forces that count as any, over the normal forces.
const LEAST: f64 = 1e-3;
/// Change of the tangential forces by another turn, over that by the turn before, through the normal forces: at most about so much.
const COUPLING: f64 = 0.1;
/// Most passes, and most turns of normal and tangential forces.
const MOST_PASSES: usize = 400;
const MOST_TURNS: usize = 100;

/// Tangential forces, and what they go by.
#[derive(Debug, Clone)]
pub(super) struct Friction {
    coefficient: f64,
    /// Relative, of the run.
    tolerance: f64,
    /// On the candidates in N. Shape (n).
    pub(super) force: Vec<Vector3<f64>>,
    /// At the instant before, and their change until then, N. Shape (n).
    force_before: Vec<Vector3<f64>>,
    trend: Vec<Vector3<f64>>,
    /// From the balls' centres to the candidates at the instant before in m, and the balls' turns in rad.
    offset: Vec<Vector3<f64>>,
    turn: Vec<f64>,
    /// Work of the friction on all bodies so far in J, not positive.
    work: f64,
}

impl Friction {
    /// Of `n` candidates against `balls`, without forces, in a run of this relative `tolerance`.
    pub(super) fn new(coefficient: f64, n: usize, balls: usize, tolerance: f64) -> Self {
        Self {
            coefficient,
            tolerance,
            force: vec![Vector3::zeros(); n],
            force_before: vec![Vector3::zeros(); n],
            trend: vec![Vector3::zeros(); n],
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

/// What a pass over the nodes has brought.
struct Pass {
    /// Change of the tangential forces, summed over the nodes, N.
    changed: f64,
    /// Their sum, N.
    held: f64,
}

/// A node in contact, while its tangential force is sought.
struct ContactNode {
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
    /// Finds normal and tangential forces in turn, until another turn would change these by no more than they may.
    pub(super) fn solve_with_friction(&mut self, modal: &[f64], balls: &[Ball]) -> Result<()> {
        self.extrapolate();
        for _ in 0..MOST_TURNS {
            self.solve_normal(modal, balls)?;
            if self.solve_tangential(balls)? {
                return Ok(());
            }
        }
        Err(self.not_settled(MOST_TURNS))
    }

    /// Starts from tangential forces extrapolated from the last step.
    fn extrapolate(&mut self) {
        let Some(friction) = &mut self.loads.friction else { return };
        for &i in &self.loads.active {
            friction.force[i] += friction.trend[i];
        }
        self.deform_from(0, self.watch.len());
    }

    fn not_settled(&self, rounds: usize) -> Error {
        Error::Solver(format!(
            "the friction forces of the seal seat did not converge in {rounds} iterations with {} nodes in contact",
            self.loads.active.len()
        ))
    }

    /// Finds the tangential forces under the present normal forces; whether these fit them.
    fn solve_tangential(&mut self, balls: &[Ball]) -> Result<bool> {
        let Some(mut friction) = self.loads.friction.take() else { return Ok(true) };
        let nodes = self.nodes_in_contact(&friction, balls);
        let before = friction.force.clone();
        let pressed: f64 = self.loads.active.iter().map(|&i| self.loads.force[i]).sum();
        let mut settles = |_: &usize| {
            let Pass { changed, held } = self.pass_over(&nodes, &mut friction);
            changed <= friction.tolerance * SETTLED * held.max(LEAST * pressed)
        };
        let passes = (1..=MOST_PASSES).find(&mut settles);
        let changes = friction.force.iter().zip(&before).map(|(now, before)| (now - before).norm());
        let change: f64 = changes.sum();
        let held: f64 = friction.force.iter().map(|force| force.norm()).sum();
        let fits = COUPLING * change <= friction.tolerance * held.max(LEAST * pressed);
        self.loads.friction = Some(friction);
        self.deform_from(0, self.watch.len());
        self.work.passes += passes.ok_or_else(|| self.not_settled(MOST_PASSES))? as u64;
        Ok(fits)
    }

    /// Lets each of `nodes` stick or slide, in turn.
    fn pass_over(&mut self, nodes: &[ContactNode], friction: &mut Friction) -> Pass {
        let part = 0..self.watch.up_to(&self.loads.active);
        let (mut changed, mut held) = (0.0, 0.0);
        for node in nodes {
            let (i, normal) = (node.candidate, node.normal);
            let slip = friction.slip(i, self.watch.off_centre(i).0, normal, node.turned);
            let old = friction.force[i];
            let wanted = old - normal.dot(&old) * normal - slip / node.compliance;
            let size = wanted.norm();
            let new = if size > node.most { wanted * (node.most / size) } else { wanted };
            friction.force[i] = new;
            changed += (new - old).norm();
            held += new.norm();
            self.watch.deform_further(self.nodes, (i, new - old), part.clone());
        }
        Pass { changed, held }
    }

    /// The nodes in contact; one that has just touched has slid since the instant before.
    fn nodes_in_contact(&mut self, friction: &Friction, balls: &[Ball]) -> Vec<ContactNode> {
        let mut nodes = Vec::with_capacity(self.loads.active.len());
        for &i in &self.loads.active {
            let normal = self.loads.normal[i];
            let compliance = self.watch.own_compliance(self.nodes, i);
            let across = Matrix3::identity() - normal * normal.transpose();
            let ball = self.nodes.ball[i];
            nodes.push(ContactNode {
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
        let both = friction.force.iter().zip(&friction.force_before);
        friction.trend.iter_mut().zip(both).for_each(|(trend, (now, before))| *trend = now - before);
        friction.force_before.clone_from(&friction.force);
        friction.turn.iter_mut().zip(balls).for_each(|(turn, ball)| *turn = ball.turn);
        self.loads.friction = Some(friction);
    }
}

#[cfg(test)]
mod tests {
    use super::super::contact::tests::nodes;
    use super::*;

    const FRICTION: f64 = 0.4;

    /// No force is beyond friction, what is below it has not moved along the ball, what moves is held back.
    #[test]
    fn nodes_stick_or_slide_against_their_force() {
        let mut random = fastrand::Rng::with_seed(3);
        let (mut stuck, mut slid) = (0, 0);
        for n in [1, 4, 20] {
            let (nodes, _) = nodes(n, &mut random);
            let friction = Friction::new(FRICTION, n, 1, 1e-7);
            let mut contact = ContactProblem::new(&nodes, 0.3, None, Some(friction));
            let ball = |x: f64, height: f64, turn: f64| {
                [Ball { centre: Vector3::new(x, 0.0, height - 10.0), radius: 10.0, turn }]
            };
            let modal = vec![0.0; 3 * n];
            contact.survey(&modal, &ball(0.0, -1.0, 0.0), f64::INFINITY);
            contact.solve(&modal, &ball(0.0, 0.1, 0.0)).expect("solution");
            contact.book(&ball(0.0, 0.1, 0.0));
            let mut before = ball(0.0, 0.1, 0.0);
            for [x, height, turn] in
                [[0.003, 0.1, 0.0], [0.02, 0.12, 0.001], [0.4, 0.11, 0.0], [0.3, 0.1, 0.03]]
            {
                let at: Vec<_> = (0..n).map(|i| contact.watch.off_centre(i).0).collect();
                let now = ball(x, height, turn);
                contact.solve(&modal, &now).expect("solution");
                for &i in contact.active() {
                    let (offset, normal) = (contact.watch.off_centre(i).0, contact.loads.normal[i]);
                    let turned = (turn - before[0].turn) * Vector3::new(offset.z, 0.0, -offset.x);
                    let moved = offset - at[i] - turned;
                    let slip = moved - normal.dot(&moved) * normal;
                    let force = contact.loads.friction.as_ref().expect("rough").force[i];
                    let most = FRICTION * contact.force(i);
                    assert!(force.norm() <= most * (1.0 + 1e-5) && force.dot(&normal).abs() < 1e-5 * most);
                    if force.norm() < 0.999 * most {
                        assert!(slip.norm() < 1e-5, "{n}: {slip}");
                        stuck += 1;
                    } else {
                        assert!(slip.dot(&force) <= 1e-6 * most, "{n}: {slip} {force}");
                        assert!((slip.normalize() + force.normalize()).norm() < 0.05 || slip.norm() < 1e-4);
                        slid += 1;
                    }
                }
                contact.book(&now);
                before = now;
            }
            assert!(contact.rubbed() >= 0.0);
        }
        assert!(stuck > 10 && slid > 10, "{stuck} {slid}");
    }
}
