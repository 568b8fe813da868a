//! Unilateral contact of rigid spheres with the candidate nodes of an elastic body, at one instant.
//!
//! The modes say where the candidates u lie without contact forces; forces lambda_i >= 0 along the true normals n_i
//! move them further by the residual flexibility, u_i += sum_j R_ij n_j lambda_j, until no gap
//! g_i = |x_i + u_i - c| - r is negative and only closed gaps carry force. The residual has no inertia: this is a static
//! problem, and its forces derive from an energy, so that an integrator that keeps energies keeps this one.
//!
//! With frozen normals it is a linear complementarity problem with the matrix G_ij = n_i^T R_ij n_j, which is
//! symmetric positive definite: its solution is unique. It is found by exchanging the wrong nodes of the last step's
//! contact set all at once, each time with a Newton step on the set; if that makes no progress only the last wrong one
//! is exchanged, which ends after a finite number of exchanges (Judice & Pires 1994, Computers Ops Res. 21, 587).
//!
//! From one instant to the next only candidates with a small gap are watched; [`ContactProblem::survey`] looks at all and tells
//! whether one has been missed.

use super::friction::Friction;
use super::nodes::{Ball, Nodes};
use super::surface_compliance::SurfaceCompliance;
use super::traces::{Push, Traces};
use super::watch::Watch;
use crate::error::{Error, Result};
use crate::numerics::cholesky::Cholesky;
use nalgebra::Vector3;

/// Largest gap in magnitude that a closed contact may have, over a typical indentation. It is also the largest turn of a normal
/// in rad since the last iteration: forces act along the normals of that, and a turn moves what they indent by its share.
const CLOSED: f64 = 5e-6;
/// Newton's method keeps its factor as long as a step shrinks the gaps to this share.
const CHORD: f64 = 0.05;
/// Exchanges of all wrong nodes at once without progress before they are exchanged singly.
const PATIENCE: u32 = 4;
/// Most iterations per instant.
const MOST: u32 = 400;

/// A solution, from which the next one starts.
#[derive(Debug, Clone, Default)]
pub struct Loads {
    /// Candidates in contact, ascending.
    pub(super) active: Vec<usize>,
    /// Force of each candidate in N. Shape (n).
    pub(super) force: Vec<f64>,
    /// Normals from the balls to the candidates. Shape (n).
    pub(super) normal: Vec<Vector3<f64>>,
    /// What a body that relaxes remembers of the forces before.
    pub(super) traces: Option<Traces>,
    /// Tangential forces, where the seat is rough.
    pub(super) friction: Option<Friction>,
}

/// The contact problem and its last solution.
#[derive(Debug, Clone)]
pub struct ContactProblem<'a> {
    pub(super) nodes: &'a Nodes,
    /// Largest gap in magnitude in m of a closed contact.
    pub(super) closed: f64,
    pub(super) loads: Loads,
    /// The candidates that are looked at; all in contact are among them.
    pub(super) watch: Watch,
    /// Number of the first slots in which the residual yields under the present forces; in the others under earlier ones.
    pub(super) deformed: usize,
    gap: Vec<f64>,
    /// Nodes on the wrong side: in contact with a tensile force, or out of contact and too deep. Shape (n).
    pub(super) wrong: Vec<bool>,
    /// Whether a node is in contact; for [`ContactProblem::mark_wrong`]. Shape (n).
    in_contact: Vec<bool>,
    /// Factor of G on the nodes `factored`, in this order.
    pub(super) factor: Cholesky,
    pub(super) factored: Vec<usize>,
    /// Normals that the factor's rows were made with. Shape (n).
    pub(super) factor_normal: Vec<Vector3<f64>>,
    pub(super) previous: Vec<usize>,
    /// The nodes in contact, as friction needs them.
    pub(super) surface: SurfaceCompliance,
    pub(super) step: Vec<f64>,
    /// Contact set with the forces on the body in N.
    pub(super) push: Vec<Push>,
    /// Gaps at the last survey, 0 in contact. Shape (n).
    pub(super) surveyed: Vec<f64>,
    /// Displacements of all candidates at a survey in m. Shape (3, n).
    pub(super) displaced: Vec<f64>,
    /// Largest displacement by the residual of any candidate at the last survey, m; of a body that relaxes.
    pub(super) lag: f64,
    /// Room for a choice of candidates.
    pub(super) chosen: Vec<usize>,
    /// What it has cost so far.
    pub work: Work,
}

/// What the solutions have cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Instants solved.
    pub solutions: u64,
    /// Newton steps.
    pub iterations: u64,
    /// Factorisations.
    pub factorisations: u64,
    /// Nodes looked at, summed over the instants.
    pub watched: u64,
    /// Nodes in contact, summed over the Newton steps.
    pub loaded: u64,
    /// Passes over all nodes for their tangential forces.
    pub passes: u64,
}

impl<'a> ContactProblem<'a> {
    /// The problem of `nodes`, without forces, where contacts indent by about `indentation` in m: what is small goes by that. A body
    /// that relaxes remembers `traces`, a rough one has `friction`. Before the first solution there has to be a survey.
    pub(super) fn new(
        nodes: &'a Nodes,
        indentation: f64,
        traces: Option<Traces>,
        friction: Option<Friction>,
    ) -> Self {
        let n = nodes.len();
        Self {
            nodes,
            closed: CLOSED * indentation,
            loads: Loads {
                active: Vec::with_capacity(n),
                force: vec![0.0; n],
                normal: vec![Vector3::zeros(); n],
                traces,
                friction,
            },
            watch: Watch::none(n),
            deformed: 0,
            gap: vec![0.0; n],
            wrong: vec![false; n],
            in_contact: vec![false; n],
            factor: Cholesky::with_capacity(n),
            factored: Vec::with_capacity(n),
            factor_normal: vec![Vector3::zeros(); n],
            previous: Vec::with_capacity(n),
            surface: SurfaceCompliance::default(),
            step: Vec::with_capacity(n),
            push: Vec::with_capacity(n),
            surveyed: vec![0.0; n],
            displaced: vec![0.0; 3 * n],
            lag: 0.0,
            chosen: Vec::with_capacity(n),
            work: Work::default(),
        }
    }

    /// Candidates that carry force, ascending.
    pub fn active(&self) -> &[usize] {
        &self.loads.active
    }

    /// Force in N of a candidate, positive in compression.
    pub fn force(&self, candidate: usize) -> f64 {
        self.loads.force[candidate]
    }

    /// Force vector in N on the elastic body at a candidate.
    pub fn force_vector(&self, candidate: usize) -> Vector3<f64> {
        let normal = self.loads.force[candidate] * self.loads.normal[candidate];
        self.loads.friction.as_ref().map_or(normal, |friction| normal + friction.force[candidate])
    }

    /// Torque in N m about y on the ball that a candidate meets.
    pub fn torque(&self, candidate: usize) -> f64 {
        self.loads.friction.as_ref().map_or(0.0, |friction| {
            let (offset, on_ball) = (self.watch.off_centre(candidate).0, -friction.force[candidate]);
            offset.z * on_ball.x - offset.x * on_ball.z
        })
    }

    /// Elastic energy in J that the residual flexibility holds; of one that relaxes, with what it has lost.
    pub fn energy(&self) -> f64 {
        if let Some(traces) = &self.loads.traces {
            return traces.work;
        }
        let work = |&i: &usize| self.force_vector(i).dot(&self.watch.deformation(i));
        0.5 * self.loads.active.iter().map(work).sum::<f64>()
    }

    /// Energy in J that contact nodes that relax have taken; all of it is lost once they carry no force and have recovered.
    pub fn relaxed(&self) -> f64 {
        self.loads.traces.as_ref().map_or(0.0, |traces| traces.work)
    }

    /// Energy in J that friction has dissipated.
    pub fn rubbed(&self) -> f64 {
        self.loads.friction.as_ref().map_or(0.0, Friction::dissipated)
    }

    /// Largest displacement in m that forces have left to any candidate; 0 of an elastic body.
    pub fn lag(&self) -> f64 {
        self.lag
    }

    /// Begins a step: a body that relaxes remembers the present forces.
    pub fn pass(&mut self) {
        if self.loads.traces.is_some() {
            self.collect_push();
        }
        if let Some(traces) = &mut self.loads.traces {
            traces.pass(&self.push);
            self.watch.keep_deformation();
        }
    }

    /// Ends a step whose forces have been found: a body that relaxes books their work, a rough one that of friction.
    pub fn book(&mut self, balls: &[Ball]) {
        self.book_friction(balls);
        if self.loads.traces.is_some() {
            self.collect_push();
        }
        if let Some(traces) = &mut self.loads.traces {
            traces.book(&self.push, |i| self.watch.further_deformation(i));
        }
    }

    /// Copies the present solution.
    pub fn keep(&self, checkpoint: &mut Loads) {
        checkpoint.clone_from(&self.loads);
    }

    /// Goes back to a solution that was kept; a survey has to follow.
    pub fn go_back(&mut self, checkpoint: &Loads) {
        self.loads.clone_from(checkpoint);
    }

    /// Finds the forces at the modal coordinates `modal` in m kg^(1/2).
    ///
    /// # Errors
    /// [`Error::Solver`] if the residual is not positive definite or no solution is found.
    pub fn solve(&mut self, modal: &[f64], balls: &[Ball]) -> Result<()> {
        self.watch.place(modal, balls);
        if let Some(traces) = &self.loads.traces {
            self.watch.remember(self.nodes, traces.forces());
            self.watch.displace();
        }
        match self.loads.friction {
            Some(_) => self.solve_with_friction(balls),
            None => self.solve_normal(balls),
        }
    }

    /// Finds the normal forces, with the tangential ones as they are.
    pub(super) fn solve_normal(&mut self, balls: &[Ball]) -> Result<()> {
        self.work.solutions += 1;
        self.work.watched += self.watch.len() as u64;
        let (mut fewest, mut patience, mut last) = (usize::MAX, PATIENCE, f64::INFINITY);
        for iteration in 0..MOST {
            self.deform_up_to(self.watch.up_to(&self.loads.active));
            let worst = self.look_at_set(balls);
            let closed = self.loads.active.is_empty() || (worst <= 1.0 && iteration > 0);
            // A set that is sure to change is not solved to the end.
            let wrong = if closed {
                self.deform_up_to(self.watch.len());
                self.mark_wrong(balls)
            } else {
                self.fit(worst > CHORD * last)?;
                self.correct();
                (last, self.deformed) = (worst, 0);
                if patience > 0 { self.mark_tensile() } else { 0 }
            };
            if wrong == 0 && closed {
                return Ok(());
            }
            if wrong > 0 {
                if closed && wrong < fewest {
                    (fewest, patience) = (wrong, PATIENCE);
                } else if closed {
                    patience = patience.saturating_sub(1);
                }
                self.exchange(patience == 0);
                (last, self.deformed) = (f64::INFINITY, 0);
            }
        }
        Err(Error::Solver(format!(
            "the contact forces of the seal seat did not converge in {MOST} iterations with {} of {} candidates in contact",
            self.loads.active.len(),
            self.nodes.len()
        )))
    }

    /// Lets the residual yield under the present forces in the first `end` slots.
    pub(super) fn deform_up_to(&mut self, end: usize) {
        if self.deformed < end {
            self.collect_push();
            self.watch.deform_under(self.nodes, &self.push, self.deformed..end);
            self.deformed = end;
        }
    }

    /// Gaps and normals of the contact set; its largest gap in magnitude or turn of a normal, over what a closed contact may
    /// have.
    fn look_at_set(&mut self, balls: &[Ball]) -> f64 {
        let mut worst = 0.0f64;
        for a in 0..self.loads.active.len() {
            let i = self.loads.active[a];
            let before = self.loads.normal[i];
            self.look(i, balls);
            let turn = (self.loads.normal[i] - before).amax();
            worst = worst.max(self.gap[i].abs() / self.closed).max(turn / CLOSED);
        }
        worst
    }

    /// Gap and normal of the watched candidate `i`.
    fn look(&mut self, i: usize, balls: &[Ball]) {
        let (d, ball) = self.watch.off_centre(i);
        let distance = d.norm();
        self.gap[i] = distance - balls[ball].radius;
        self.loads.normal[i] = d / distance;
    }

    /// The forces on the body at the contact set.
    pub(super) fn collect_push(&mut self) {
        self.push.clear();
        for &j in &self.loads.active {
            self.push.push((j, self.force_vector(j)));
        }
    }

    /// Newton step on the contact set.
    fn correct(&mut self) {
        self.work.iterations += 1;
        self.work.loaded += self.factored.len() as u64;
        self.step.clear();
        self.step.extend(self.factored.iter().map(|&i| -self.gap[i]));
        self.factor.solve(&mut self.step);
        for (&i, step) in self.factored.iter().zip(&self.step) {
            self.loads.force[i] += step;
        }
    }

    /// Changes of the forces at the contact set when its nodes move in relation to the balls by `shift` in s^2 times the `acceleration` of a
    /// candidate with this place from the centre of its ball, with the set and the last factor as they are; `each` gets candidate, place in m,
    /// change of the normal force and of the whole force on the body in N.
    pub fn respond(
        &mut self,
        shift: f64,
        acceleration: impl Fn(usize, &Vector3<f64>) -> Vector3<f64>,
        mut each: impl FnMut(usize, &Vector3<f64>, f64, Vector3<f64>),
    ) {
        let relative = |i: usize| acceleration(i, &self.watch.off_centre(i).0);
        let normal = &self.loads.normal;
        self.step.clear();
        self.step.extend(self.factored.iter().map(|&i| -(shift * normal[i].dot(&relative(i)))));
        self.factor.solve(&mut self.step);
        for (&i, &change) in self.factored.iter().zip(&self.step) {
            each(i, &self.watch.off_centre(i).0, change, change * normal[i]);
        }
        let pressed = |i: usize| self.factored.iter().position(|&j| i == j).map_or(0.0, |k| self.step[k]);
        let along = |i: usize, change| each(i, &self.watch.off_centre(i).0, 0.0, change);
        self.respond_along(|i| shift * relative(i), pressed, along);
    }

    /// Marks the nodes that pull and the open watched ones that are too deep; their number.
    fn mark_wrong(&mut self, balls: &[Ball]) -> usize {
        let mut count = self.mark_tensile();
        self.in_contact.fill(false);
        self.loads.active.iter().for_each(|&i| self.in_contact[i] = true);
        for slot in 0..self.watch.len() {
            let i = self.watch.node(slot);
            if !self.in_contact[i] {
                self.look(i, balls);
                self.wrong[i] = self.gap[i] < -self.closed;
                count += usize::from(self.wrong[i]);
            }
        }
        count
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    const INDENTATION: f64 = 0.3;

    /// Nodes on a plane above a ball of radius 10 that rises through it, with a random flexibility.
    pub fn nodes(n: usize, random: &mut fastrand::Rng) -> (Nodes, Vec<f64>) {
        let place =
            (0..n).map(|_| Vector3::new(2.0 * random.f64() - 1.0, 2.0 * random.f64() - 1.0, 0.0)).collect();
        let m = 3 * n;
        let a: Vec<f64> = (0..m * m).map(|_| random.f64() - 0.5).collect();
        let product = |i: usize, j: usize| (0..m).map(|k| a[i * m + k] * a[j * m + k]).sum::<f64>();
        let entry = |e: usize| product(e / m, e % m) + if e / m == e % m { 0.1 } else { 0.0 };
        // as precise as the solver keeps it
        let residual: Vec<f64> = (0..m * m).map(|e| f64::from(entry(e) as f32)).collect();
        // one mode per displacement: its coordinates are the displacements
        let shapes: Vec<Vec<f64>> =
            (0..m).map(|k| (0..m).map(|e| f64::from(u8::from(e == k))).collect()).collect();
        (Nodes::new(place, vec![0; n], &shapes, &residual), residual)
    }

    #[test]
    fn gaps_are_not_negative_forces_do_not_pull_and_only_closed_gaps_carry_force() {
        let mut random = fastrand::Rng::with_seed(3);
        // the gap of a closed contact, and what the last turn of the normals changes of the indentation
        let bound = 2.0 * CLOSED * INDENTATION;
        let mut in_contact = 0;
        for n in [1, 2, 5, 12, 40] {
            let (nodes, residual) = nodes(n, &mut random);
            let mut contact = ContactProblem::new(&nodes, INDENTATION, None, None);
            let far = [Ball { centre: Vector3::new(0.0, 0.0, -20.0), radius: 10.0, turn: 0.0 }];
            contact.survey(&vec![0.0; 3 * n], &far, f64::INFINITY);
            // one sequence of instants: each starts from the last, deeper or shallower
            for height in [0.0, 0.01, 0.08, 0.06, 0.2, 0.02, -0.5, 0.05] {
                let modal: Vec<f64> = (0..3 * n).map(|_| 0.02 * (random.f64() - 0.5)).collect();
                let ball = Ball { centre: Vector3::new(0.0, 0.0, height - 10.0), radius: 10.0, turn: 0.0 };
                contact.solve(&modal, &[ball]).expect("solution");
                let force: Vec<f64> =
                    (0..n).flat_map(|i| <[f64; 3]>::from(contact.force_vector(i))).collect();
                for i in 0..n {
                    let at = Vector3::from_fn(|c, _| {
                        let row = 3 * i + c;
                        let deformation: f64 = (0..3 * n).map(|k| residual[row * 3 * n + k] * force[k]).sum();
                        nodes.place[i][c] + modal[row] + deformation - ball.centre[c]
                    });
                    let distance = at.norm();
                    let (gap, load) = (distance - 10.0, contact.force(i));
                    assert!(load >= 0.0 && gap >= -bound, "{n} nodes: force {load}, gap {gap}");
                    assert!(load == 0.0 || gap < bound, "{n} nodes: force {load} over a gap of {gap}");
                    let f = contact.force_vector(i);
                    assert!(f.dot(&at) > (1.0 - 1e-6) * load * distance - 1e-12, "the force is not normal");
                    in_contact += usize::from(load > 0.0);
                }
            }
        }
        assert!(in_contact > 50, "{in_contact}");
    }

    #[test]
    fn a_survey_finds_what_was_not_watched() {
        let mut random = fastrand::Rng::with_seed(5);
        let (nodes, _) = nodes(20, &mut random);
        let mut contact = ContactProblem::new(&nodes, INDENTATION, None, None);
        let modal = vec![0.0; 60];
        let ball =
            |height: f64| [Ball { centre: Vector3::new(0.0, 0.0, height - 10.0), radius: 10.0, turn: 0.0 }];
        contact.survey(&modal, &ball(-0.1), f64::INFINITY);
        contact.solve(&modal, &ball(-0.1)).expect("apart");
        // none is near: none is watched
        assert!(!contact.survey(&modal, &ball(-0.1), 1e-3).missed);
        contact.solve(&modal, &ball(0.1)).expect("solution");
        assert!(contact.active().is_empty());
        let survey = contact.survey(&modal, &ball(0.1), 1e-3);
        assert!(survey.missed && survey.needed > 0.09, "all nodes have been passed through unseen");
        contact.solve(&modal, &ball(0.1)).expect("solution");
        assert!(!contact.active().is_empty());
        assert!(!contact.survey(&modal, &ball(0.1), 1e-3).missed);
    }
}
