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
use crate::error::{Error, Result};

/// Largest gap in m, over the radius of the partner, that a closed contact may have.
const CLOSED: f64 = 1e-8;
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

/// Margin of the next survey over that which was needed before.
const RESERVE: f64 = 2.0;
/// Place of a candidate that is not watched.
const UNWATCHED: usize = usize::MAX;

/// A rigid sphere that candidates meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Centre in m.
    pub centre: [f64; 3],
    /// Radius in m.
    pub radius: f64,
}

/// The nodes that may be touched.
#[derive(Debug, Clone)]
pub struct Nodes {
    /// Places at rest in m. Shape (n).
    place: Vec<[f64; 3]>,
    /// Number of the ball each one meets. Shape (n).
    ball: Vec<usize>,
    /// Residual flexibility R_ij in m/N, 3 x 3 blocks row by row. Shape (n, n).
    residual: Vec<[f64; 9]>,
}

impl Nodes {
    /// Candidates at `place`, each against the ball of the number in `ball`, with the `residual` flexibility
    /// (x, y, z of each candidate; shape (3 n, 3 n), row by row) in m/N.
    pub fn new(place: Vec<[f64; 3]>, ball: Vec<usize>, residual: &[f64]) -> Self {
        let n = place.len();
        let entry = |i: usize, j: usize, k: usize| residual[(3 * i + k / 3) * 3 * n + 3 * j + k % 3];
        let residual = (0..n * n).map(|ij| std::array::from_fn(|k| entry(ij / n, ij % n, k))).collect();
        Self { place, ball, residual }
    }

    /// Number of candidates.
    pub fn len(&self) -> usize {
        self.place.len()
    }

    /// Whether there is no candidate.
    pub fn is_empty(&self) -> bool {
        self.place.is_empty()
    }

    /// Flexibility of candidate `i` under forces on all.
    fn row(&self, i: usize) -> &[[f64; 9]] {
        &self.residual[i * self.len()..(i + 1) * self.len()]
    }

    /// Displacement in m of candidate `i` under the forces `push` on candidates.
    fn displaced(&self, i: usize, push: &[(usize, [f64; 3])]) -> [f64; 3] {
        displaced(self.row(i), push)
    }

    /// Displacement in m of candidate `i` along its normal under a unit force on `j` along its own: n_i^T R_ij n_j.
    fn compliance(&self, i: usize, j: usize, normal: &[[f64; 3]]) -> f64 {
        let (r, p, q) = (&self.residual[i * self.len() + j], normal[i], normal[j]);
        p[0] * (r[0] * q[0] + r[1] * q[1] + r[2] * q[2])
            + p[1] * (r[3] * q[0] + r[4] * q[1] + r[5] * q[2])
            + p[2] * (r[6] * q[0] + r[7] * q[1] + r[8] * q[2])
    }
}

/// A solution, from which the next one starts.
#[derive(Debug, Clone, Default)]
pub struct Loads {
    /// Candidates in contact, ascending.
    active: Vec<usize>,
    /// Force of each candidate in N. Shape (n).
    force: Vec<f64>,
    /// Normals from the balls to the candidates. Shape (n).
    normal: Vec<[f64; 3]>,
    /// Candidates that are looked at, ascending.
    watched: Vec<usize>,
}

/// The contact problem and its last solution.
#[derive(Debug, Clone)]
pub struct Contact<'a> {
    nodes: &'a Nodes,
    loads: Loads,
    /// Displacements by the residual in m. Shape (n).
    yielding: Vec<[f64; 3]>,
    gap: Vec<f64>,
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
    push: Vec<(usize, [f64; 3])>,
    /// Gaps at the last survey, 0 in contact. Shape (n).
    surveyed: Vec<f64>,
    /// Place of each candidate among those watched, or [`UNWATCHED`]. Shape (n).
    slot: Vec<usize>,
    /// Flexibility between those watched, side by side in memory. Shape (watched, watched).
    compact: Vec<[f64; 9]>,
    /// What it has cost so far.
    pub work: Work,
}

/// What a look at all candidates has shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Survey {
    /// Whether one that was not watched has been passed through.
    pub missed: bool,
    /// Largest gap in m at the survey before of those that have touched since: what margin was needed.
    pub needed: f64,
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

    /// Looks at all candidates after [`Contact::solve`], and watches from now on those with gaps below `margin` in m, or
    /// below twice the margin that would have been needed since the last survey.
    pub fn survey(&mut self, modal: &[f64], balls: &[Ball], margin: f64) -> Survey {
        let mut survey = Survey { missed: false, needed: 0.0 };
        self.collect_push();
        let (mut active, mut watched) = (0, 0);
        for i in 0..self.nodes.len() {
            let was_watched = self.loads.watched.get(watched) == Some(&i);
            watched += usize::from(was_watched);
            let touches = self.loads.active.get(active) == Some(&i);
            if touches {
                active += 1;
                self.gap[i] = 0.0;
            } else {
                self.yielding[i] = self.nodes.displaced(i, &self.push);
                self.look(i, modal, balls);
            }
            let passed = !was_watched && self.gap[i] < -CLOSED * balls[self.nodes.ball[i]].radius;
            survey.missed |= passed;
            if touches || passed {
                survey.needed = survey.needed.max(self.surveyed[i]);
            }
        }
        self.surveyed.clone_from(&self.gap);
        self.watch(margin.max(RESERVE * survey.needed));
        survey
    }

    /// Watches the candidates whose gaps at the last survey were below `margin` in m.
    fn watch(&mut self, margin: f64) {
        self.loads.watched.clear();
        self.loads.watched.extend((0..self.nodes.len()).filter(|&i| self.surveyed[i] < margin));
        self.slot.fill(UNWATCHED);
        for (slot, &i) in self.loads.watched.iter().enumerate() {
            self.slot[i] = slot;
        }
        self.compact.clear();
        for &i in &self.loads.watched {
            let row = self.nodes.row(i);
            self.compact.extend(self.loads.watched.iter().map(|&j| row[j]));
        }
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
    fn look(&mut self, i: usize, modal: &[f64], balls: &[Ball]) {
        let ball = balls[self.nodes.ball[i]];
        let d: [f64; 3] = std::array::from_fn(|c| {
            self.nodes.place[i][c] + modal[3 * i + c] + self.yielding[i][c] - ball.centre[c]
        });
        let distance = dot(d, d).sqrt();
        self.gap[i] = distance - ball.radius;
        self.loads.normal[i] = d.map(|d| d / distance);
    }

    /// The forces on the body at the contact set.
    fn collect_push(&mut self) {
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

/// sum_j R_j f_j in m over the pairs (j, f_j) of `push`.
fn displaced(row: &[[f64; 9]], push: &[(usize, [f64; 3])]) -> [f64; 3] {
    let mut u = [0.0; 3];
    for (j, [x, y, z]) in push {
        let r = &row[*j];
        u[0] += r[0] * x + r[1] * y + r[2] * z;
        u[1] += r[3] * x + r[4] * y + r[5] * z;
        u[2] += r[6] * x + r[7] * y + r[8] * z;
    }
    u
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
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
