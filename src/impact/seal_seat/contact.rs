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
//! From one instant to the next only candidates with a small gap are watched; [`Contact::survey`] looks at all and tells
//! whether one has been missed.

use super::cholesky::Cholesky;
use super::nodes::{Ball, Nodes, displaced, dot};
use super::survey::UNWATCHED;
use crate::error::{Error, Result};

/// Largest gap in m, over the radius of the partner, that a closed contact may have.
pub(super) const CLOSED: f64 = 1e-8;
/// Change of a normal in rad that counts as much as a gap of its size times this, over the radius: forces act along the
/// normals of the last iteration.
const TURN: f64 = 1e-3;
/// Newton's method keeps its factor as long as a step shrinks the gaps to this share.
const CHORD: f64 = 0.05;
/// Rows that the factor takes up or loses, beyond a sixteenth of it, before it is rather made anew.
const UPDATES: usize = 4;
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
    force: Vec<f64>,
    /// Normals from the balls to the candidates. Shape (n).
    normal: Vec<[f64; 3]>,
    /// Candidates that are looked at, ascending.
    pub(super) watched: Vec<usize>,
}

/// The contact problem and its last solution.
#[derive(Debug, Clone)]
pub struct Contact<'a> {
    pub(super) nodes: &'a Nodes,
    pub(super) loads: Loads,
    /// Displacements by the residual in m. Shape (n).
    pub(super) yielding: Vec<[f64; 3]>,
    pub(super) gap: Vec<f64>,
    /// Nodes on the wrong side: in contact with a tensile force, or out of contact and too deep. Shape (n).
    wrong: Vec<bool>,
    /// Factor of G on the nodes `factored`, in this order.
    factor: Cholesky,
    factored: Vec<usize>,
    /// Normals that the factor's rows were made with. Shape (n).
    factor_normal: Vec<[f64; 3]>,
    previous: Vec<usize>,
    step: Vec<f64>,
    /// Contact set with the forces on the body in N.
    pub(super) push: Vec<(usize, [f64; 3])>,
    /// Gaps at the last survey, 0 in contact. Shape (n).
    pub(super) surveyed: Vec<f64>,
    /// Place of each candidate among those watched, or [`UNWATCHED`]. Shape (n).
    pub(super) slot: Vec<usize>,
    /// Flexibility between those watched, side by side in memory. Shape (watched, watched).
    pub(super) compact: Vec<[f64; 9]>,
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
}

impl<'a> Contact<'a> {
    /// The problem of `nodes`, without forces; before the first solution there has to be a survey.
    pub fn new(nodes: &'a Nodes) -> Self {
        let n = nodes.len();
        Self {
            nodes,
            loads: Loads {
                active: Vec::with_capacity(n),
                force: vec![0.0; n],
                normal: vec![[0.0; 3]; n],
                watched: Vec::with_capacity(n),
            },
            yielding: vec![[0.0; 3]; n],
            gap: vec![0.0; n],
            wrong: vec![false; n],
            factor: Cholesky::with_capacity(n),
            factored: Vec::with_capacity(n),
            factor_normal: vec![[0.0; 3]; n],
            previous: Vec::with_capacity(n),
            step: Vec::with_capacity(n),
            push: Vec::with_capacity(n),
            surveyed: vec![0.0; n],
            slot: vec![UNWATCHED; n],
            compact: Vec::new(),
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
    pub fn force_vector(&self, candidate: usize) -> [f64; 3] {
        self.loads.normal[candidate].map(|n| n * self.loads.force[candidate])
    }

    /// Elastic energy in J that the residual flexibility holds.
    pub fn energy(&self) -> f64 {
        let work = |&i: &usize| dot(self.force_vector(i), self.yielding[i]);
        0.5 * self.loads.active.iter().map(work).sum::<f64>()
    }

    /// Copies the present solution.
    pub fn keep(&self, kept: &mut Loads) {
        kept.clone_from(&self.loads);
    }

    /// Goes back to a solution that was kept; a survey has to follow.
    pub fn go_back(&mut self, kept: &Loads) {
        self.loads.active.clone_from(&kept.active);
        self.loads.force.clone_from(&kept.force);
        self.loads.normal.clone_from(&kept.normal);
        self.collect_push();
        for a in 0..self.loads.active.len() {
            let i = self.loads.active[a];
            self.yielding[i] = self.nodes.displaced(i, &self.push);
        }
    }

    /// Finds the forces for candidates displaced by `modal` in m (shape (3 n)) without the residual's part.
    ///
    /// # Errors
    /// [`Error::Solver`] if the residual is not positive definite or no solution is found.
    pub fn solve(&mut self, modal: &[f64], balls: &[Ball]) -> Result<()> {
        self.work.solutions += 1;
        self.work.watched += self.loads.watched.len() as u64;
        let (mut fewest, mut patience, mut last) = (usize::MAX, PATIENCE, f64::INFINITY);
        for iteration in 0..MOST {
            // the last instant's forces still yield what they did
            let worst = self.evaluate_set(modal, balls, iteration > 0);
            let closed = self.loads.active.is_empty() || (worst <= CLOSED && iteration > 0);
            if !closed {
                self.fit(worst > CHORD * last)?;
                last = worst;
                self.correct();
            }
            // A set that is sure to change is not solved to the end.
            let wrong = match closed {
                true => self.mark_wrong(modal, balls),
                false if patience > 0 => self.mark_tensile(),
                false => 0,
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
                last = f64::INFINITY;
            }
        }
        Err(Error::Solver(format!(
            "the contact forces of the seal seat did not converge in {MOST} iterations with {} of {} candidates in contact",
            self.loads.active.len(),
            self.nodes.len()
        )))
    }

    /// Displacements, normals and gaps of the contact set; its largest gap in magnitude over the radius, or turn of a
    /// normal if that counts more. `yielding` = the forces have changed since.
    fn evaluate_set(&mut self, modal: &[f64], balls: &[Ball], yielding: bool) -> f64 {
        if yielding {
            self.collect_watched_push();
            for a in 0..self.loads.active.len() {
                let i = self.loads.active[a];
                self.yielding[i] = self.displaced(i);
            }
        }
        let mut worst = 0.0f64;
        for a in 0..self.loads.active.len() {
            let i = self.loads.active[a];
            let before = self.loads.normal[i];
            self.look(i, modal, balls);
            let turn = (0..3).map(|c| (self.loads.normal[i][c] - before[c]).abs()).fold(0.0, f64::max);
            worst = worst.max(self.gap[i].abs() / balls[self.nodes.ball[i]].radius).max(TURN * turn);
        }
        worst
    }

    /// Gap and normal of candidate `i` from its displacements.
    pub(super) fn look(&mut self, i: usize, modal: &[f64], balls: &[Ball]) {
        let ball = balls[self.nodes.ball[i]];
        let d: [f64; 3] = std::array::from_fn(|c| {
            self.nodes.place[i][c] + modal[3 * i + c] + self.yielding[i][c] - ball.centre[c]
        });
        let distance = dot(d, d).sqrt();
        self.gap[i] = distance - ball.radius;
        self.loads.normal[i] = d.map(|d| d / distance);
    }

    /// The forces on the body at the contact set.
    pub(super) fn collect_push(&mut self) {
        self.push.clear();
        let (normal, force) = (&self.loads.normal, &self.loads.force);
        self.push.extend(self.loads.active.iter().map(|&j| (j, normal[j].map(|n| n * force[j]))));
    }

    /// The same with the places of the nodes among those watched.
    fn collect_watched_push(&mut self) {
        self.collect_push();
        self.push.iter_mut().for_each(|(j, _)| *j = self.slot[*j]);
    }

    /// Displacement in m of a watched candidate by the residual, after [`Contact::collect_watched_push`].
    fn displaced(&self, i: usize) -> [f64; 3] {
        let width = self.loads.watched.len();
        displaced(&self.compact[self.slot[i] * width..][..width], &self.push)
    }

    /// Makes the factor that of the contact set: anew if `anew` or much has changed, else by adding and taking rows. Rows that
    /// stay keep the normals they were made with, which is what the method's chord is.
    fn fit(&mut self, anew: bool) -> Result<()> {
        self.wrong.fill(false);
        for &i in &self.loads.active {
            self.wrong[i] = true;
        }
        let gone = self.factored.iter().filter(|&&i| !self.wrong[i]).count();
        let new = self.loads.active.len() + gone - self.factored.len();
        if anew || gone + new > UPDATES + self.factored.len() / 16 {
            return self.factorise();
        }
        for k in (0..self.factored.len()).rev() {
            if !self.wrong[self.factored[k]] {
                self.factored.remove(k);
                if !self.factor.remove(k) {
                    return self.factorise();
                }
            }
        }
        self.factored.iter().for_each(|&i| self.wrong[i] = false);
        for a in 0..self.loads.active.len() {
            let i = self.loads.active[a];
            if self.wrong[i] {
                self.factored.push(i);
                self.factor_normal[i] = self.loads.normal[i];
                let (factored, normal, nodes) = (&self.factored, &self.factor_normal, self.nodes);
                if !self.factor.append(|b| nodes.compliance(i, factored[b], normal)) {
                    return self.factorise();
                }
            }
        }
        Ok(())
    }

    fn factorise(&mut self) -> Result<()> {
        self.factored.clone_from(&self.loads.active);
        self.work.factorisations += 1;
        for &i in &self.factored {
            self.factor_normal[i] = self.loads.normal[i];
        }
        let (active, normal, nodes) = (&self.factored, &self.factor_normal, self.nodes);
        if self.factor.factorise(active.len(), |a, b| nodes.compliance(active[a], active[b], normal)) {
            return Ok(());
        }
        self.factored.clear();
        Err(Error::Solver(
            "the residual flexibility of the seal seat's contact nodes is not positive definite: the mesh has too few nodes for this number of modes".into(),
        ))
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

    /// Marks the nodes that pull; their number.
    fn mark_tensile(&mut self) -> usize {
        self.wrong.fill(false);
        let mut count = 0;
        for &i in &self.loads.active {
            self.wrong[i] = self.loads.force[i] < 0.0;
            count += usize::from(self.wrong[i]);
        }
        count
    }

    /// Marks the nodes that pull and the open watched ones that are too deep; their number.
    fn mark_wrong(&mut self, modal: &[f64], balls: &[Ball]) -> usize {
        let mut count = self.mark_tensile();
        self.collect_watched_push();
        let mut active = 0;
        for w in 0..self.loads.watched.len() {
            let i = self.loads.watched[w];
            if self.loads.active.get(active) == Some(&i) {
                active += 1;
                continue;
            }
            self.yielding[i] = self.displaced(i);
            self.look(i, modal, balls);
            self.wrong[i] = self.gap[i] < -CLOSED * balls[self.nodes.ball[i]].radius;
            count += usize::from(self.wrong[i]);
        }
        count
    }

    /// Moves the marked nodes, or only the last one, into the contact set or out of it.
    fn exchange(&mut self, single: bool) {
        if single && let Some(last) = self.wrong.iter().rposition(|wrong| *wrong) {
            self.wrong[..last].fill(false);
        }
        for &i in self.loads.active.iter().filter(|&&i| self.wrong[i]) {
            self.loads.force[i] = 0.0;
        }
        self.previous.clone_from(&self.loads.active);
        self.loads.active.clear();
        let mut next = 0;
        for (i, &wrong) in self.wrong.iter().enumerate() {
            let was = self.previous.get(next) == Some(&i);
            next += usize::from(was);
            if was != wrong {
                self.loads.active.push(i);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes on a plane above a ball of radius 10 that rises through it, with a random flexibility.
    fn nodes(n: usize, random: &mut fastrand::Rng) -> (Nodes, Vec<f64>) {
        let place = (0..n).map(|_| [2.0 * random.f64() - 1.0, 2.0 * random.f64() - 1.0, 0.0]).collect();
        let m = 3 * n;
        let a: Vec<f64> = (0..m * m).map(|_| random.f64() - 0.5).collect();
        let product = |i: usize, j: usize| (0..m).map(|k| a[i * m + k] * a[j * m + k]).sum::<f64>();
        let residual: Vec<f64> =
            (0..m * m).map(|e| product(e / m, e % m) + if e / m == e % m { 0.1 } else { 0.0 }).collect();
        (Nodes::new(place, vec![0; n], &residual), residual)
    }

    #[test]
    fn gaps_are_not_negative_forces_do_not_pull_and_only_closed_gaps_carry_force() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut touching = 0;
        for n in [1, 2, 5, 12, 40] {
            let (nodes, residual) = nodes(n, &mut random);
            let mut contact = Contact::new(&nodes);
            let far = [Ball { centre: [0.0, 0.0, -20.0], radius: 10.0 }];
            contact.survey(&vec![0.0; 3 * n], &far, f64::INFINITY);
            // one sequence of instants: each starts from the last, deeper or shallower
            for height in [0.0, 0.01, 0.08, 0.06, 0.2, 0.02, -0.5, 0.05] {
                let modal: Vec<f64> = (0..3 * n).map(|_| 0.02 * (random.f64() - 0.5)).collect();
                let ball = Ball { centre: [0.0, 0.0, height - 10.0], radius: 10.0 };
                contact.solve(&modal, &[ball]).expect("solution");
                let force: Vec<f64> = (0..n).flat_map(|i| contact.force_vector(i)).collect();
                for i in 0..n {
                    let at: [f64; 3] = std::array::from_fn(|c| {
                        let row = 3 * i + c;
                        let yields: f64 = (0..3 * n).map(|k| residual[row * 3 * n + k] * force[k]).sum();
                        nodes.place[i][c] + modal[row] + yields - ball.centre[c]
                    });
                    let distance = dot(at, at).sqrt();
                    let (gap, load) = (distance - 10.0, contact.force(i));
                    assert!(load >= 0.0 && gap >= -1e-7, "{n} nodes: force {load}, gap {gap}");
                    assert!(load == 0.0 || gap < 1e-7, "{n} nodes: force {load} over a gap of {gap}");
                    let f: [f64; 3] = std::array::from_fn(|c| force[3 * i + c]);
                    assert!(dot(f, at) > (1.0 - 1e-6) * load * distance - 1e-12, "the force is not normal");
                    touching += usize::from(load > 0.0);
                }
            }
        }
        assert!(touching > 50, "{touching}");
    }

    #[test]
    fn a_survey_finds_what_was_not_watched() {
        let mut random = fastrand::Rng::with_seed(5);
        let (nodes, _) = nodes(20, &mut random);
        let mut contact = Contact::new(&nodes);
        let modal = vec![0.0; 60];
        let ball = |height: f64| [Ball { centre: [0.0, 0.0, height - 10.0], radius: 10.0 }];
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
