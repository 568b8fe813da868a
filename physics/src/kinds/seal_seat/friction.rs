//! Coulomb's friction at the contact nodes of the seat.
//!
//! A node in contact sticks, so that from one instant to the next it moves along with the ball's surface, or slides: then its
//! tangential force is friction times its normal force, against the sliding. With the displacements of nodes by tangential forces known,
//! this is a problem of forces within circles. It is solved node by node, again and again (Gauss-Seidel; Jourdan, Alart and Jean 1998,
//! Comput. Methods Appl. Mech. Eng. 155, 31), in turn with the normal forces (Panagiotopoulos 1975, Ing.-Arch. 44, 421).

use super::contact::ContactProblem;
use super::nodes::Ball;
use super::surface_compliance::{Pass, SLIDING};
use crate::error::{Error, Result};
use nalgebra::Vector3;

/// Relative change of the tangential forces by a pass over all nodes at which they have settled, over the run's tolerance.
const SETTLED: f64 = 0.1;
/// Tangential forces that count as any, over the normal forces.
const LEAST: f64 = 1e-3;
/// Change of the tangential forces by another turn, over that by the turn before, through the normal forces: at most about so much.
const COUPLING: f64 = 0.1;
/// Turn of the direction of sliding from step to step in rad up to which it goes on; beyond, it is a new direction.
const MOST_TURN: f64 = 0.5;
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
    /// Motion in m over the ball's surface of the candidates that slid in the last step, else zero, and how far its direction turned about the
    /// normal from the step before, rad. Shape (n).
    slid: Vec<Vector3<f64>>,
    turning: Vec<f64>,
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
            slid: vec![Vector3::zeros(); n],
            turning: vec![0.0; n],
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

    /// Books the motion `slid` in m of candidate `i` in the last step over the surface of its ball, zero if it stuck.
    fn book_sliding(&mut self, i: usize, slid: Vector3<f64>, normal: Vector3<f64>) {
        let before = std::mem::replace(&mut self.slid[i], slid);
        let turn = normal.dot(&before.cross(&slid)).atan2(before.dot(&slid));
        self.turning[i] = if turn.abs() < MOST_TURN { turn } else { 0.0 };
    }

    /// Motion in m of candidate `i` over the surface of its ball since the instant before, in the plane across `normal`.
    fn slip(&self, i: usize, offset: Vector3<f64>, normal: Vector3<f64>, turned: f64) -> Vector3<f64> {
        let moved = offset - self.offset[i] - turned * Vector3::new(offset.z, 0.0, -offset.x);
        moved - normal.dot(&moved) * normal
    }
}

impl ContactProblem<'_> {
    /// Finds normal and tangential forces in turn, until another turn would change these by no more than they may.
    pub(super) fn solve_with_friction(&mut self, balls: &[Ball]) -> Result<()> {
        self.extrapolate();
        for _ in 0..MOST_TURNS {
            self.solve_normal(balls)?;
            if self.solve_tangential(balls)? {
                self.deform_up_to(self.watch.len());
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
        self.deformed = 0;
    }

    fn not_settled(&self, rounds: usize) -> Error {
        let friction = self.loads.friction.as_ref().map_or(0.0, |friction| friction.coefficient);
        Error::Solver(format!(
            "the friction forces of the seal seat did not converge in {rounds} iterations with {} nodes in contact: a friction of {friction} is too large for model C on this mesh; reduce it, or use the reference alone",
            self.loads.active.len()
        ))
    }

    /// Finds the tangential forces under the present normal forces; whether these fit them.
    fn solve_tangential(&mut self, balls: &[Ball]) -> Result<bool> {
        if self.loads.active.is_empty() {
            return Ok(true);
        }
        let Some(mut friction) = self.loads.friction.take() else { return Ok(true) };
        let before = friction.force.clone();
        self.surface.follow(&self.loads.active, &self.loads.normal, &mut self.watch, self.nodes);
        let mut nodes = self.surface.sliding(|i| {
            let (offset, ball) = self.watch.off_centre(i);
            let turned = balls[ball].turn - friction.turn[ball];
            let normal = self.loads.normal[i];
            let slip = friction.slip(i, offset, normal, turned);
            // the slip of a step has the direction of its middle; the force opposes that of its end
            let (sin, cos) = (0.5 * friction.turning[i]).sin_cos();
            let slip = cos * slip + sin * normal.cross(&slip);
            (friction.force[i], slip, friction.coefficient * self.loads.force[i].max(0.0))
        });
        let pressed: f64 = self.loads.active.iter().map(|&i| self.loads.force[i]).sum();
        let settled =
            |pass: Pass| pass.changed <= friction.tolerance * SETTLED * pass.held.max(LEAST * pressed);
        let passes = (1..=MOST_PASSES).find(|_| settled(self.surface.pass(&mut nodes)));
        for (i, force) in self.surface.forces(&nodes) {
            friction.force[i] = force;
        }
        let changes = friction.force.iter().zip(&before).map(|(now, before)| (now - before).norm());
        let change: f64 = changes.sum();
        let held: f64 = friction.force.iter().map(|force| force.norm()).sum();
        let fits = COUPLING * change <= friction.tolerance * held.max(LEAST * pressed);
        self.loads.friction = Some(friction);
        self.deformed = 0;
        self.work.passes += passes.ok_or_else(|| self.not_settled(MOST_PASSES))? as u64;
        Ok(fits)
    }

    /// Changes in N of the tangential forces, where there are any, when the nodes in contact move by `moved` (of a candidate) in m in relation
    /// to the balls and the normal forces change by `pressed` in N.
    pub(super) fn respond_along(
        &self,
        moved: impl Fn(usize) -> Vector3<f64>,
        pressed: impl Fn(usize) -> f64,
        mut each: impl FnMut(usize, Vector3<f64>),
    ) {
        let Some(friction) = self.loads.friction.as_ref().filter(|_| !self.loads.active.is_empty()) else {
            return;
        };
        let normal = &self.loads.force;
        let mut nodes =
            self.surface.sliding(|i| (friction.force[i], moved(i), friction.coefficient * normal[i]));
        self.surface.respond(&mut nodes, |i| {
            if normal[i] > 0.0 { (1.0 + pressed(i) / normal[i]).max(0.0) } else { 1.0 }
        });
        self.surface.forces(&nodes).for_each(|(i, force)| each(i, force - friction.force[i]));
    }

    /// Ends an instant whose forces have been found: books the work of friction since the one before.
    pub(super) fn book_friction(&mut self, balls: &[Ball]) {
        let Some(mut friction) = self.loads.friction.take() else { return };
        for slot in 0..self.watch.len() {
            let i = self.watch.node(slot);
            let (offset, ball) = self.watch.off_centre(i);
            let both = friction.force[i] + friction.force_before[i];
            let (mut slid, normal) = (Vector3::zeros(), offset.normalize());
            if both != Vector3::zeros() {
                let turned = balls[ball].turn - friction.turn[ball];
                let slip = friction.slip(i, offset, normal, turned);
                friction.work += 0.5 * both.dot(&slip);
                if friction.force[i].norm() >= SLIDING * friction.coefficient * self.loads.force[i] {
                    slid = slip;
                }
            }
            friction.book_sliding(i, slid, normal);
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
                    let friction = contact.loads.friction.as_ref().expect("rough");
                    let (force, ahead) = (friction.force[i], 0.5 * friction.turning[i].abs());
                    let most = FRICTION * contact.force(i);
                    assert!(force.norm() <= most * (1.0 + 1e-5) && force.dot(&normal).abs() < 1e-5 * most);
                    if force.norm() < 0.999 * most {
                        assert!(slip.norm() < 1e-5, "{n}: {slip}");
                        stuck += 1;
                    } else {
                        assert!(slip.dot(&force) <= 1e-6 * most, "{n}: {slip} {force}");
                        let off = (slip.normalize() + force.normalize()).norm();
                        assert!(off < 0.05 + ahead || slip.norm() < 1e-4, "{n}: {off}");
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
