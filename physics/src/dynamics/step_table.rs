//! What the oscillators of a bank answer in a step of one length.

use super::batch::{Block, OscillatorBatch, pushed};
use super::collocation::Collocation;
use super::system::dot;
use super::tangential_load::LoadTable;
use crate::numerics::duhamel::MOMENTS;
use crate::numerics::stages::{STAGES, Stages, powers};
use wide::f64x4;

/// Everything about a step of one length that does not depend on the state.
#[derive(Debug, Clone)]
pub struct StepTable {
    /// Length of the step in s.
    pub h: f64,
    /// s' and s of every oscillator at Gauss point j, shape (STAGES, 2, blocks); then its moments at the end, shape
    /// (MOMENTS, blocks).
    oscillators: Vec<f64x4>,
    /// `coupling[c][l]`: approaches at all Gauss points lost per force at Gauss point l, in m/N; c is the pair of contacts
    /// (0,0), (0,1) = (1,0), (1,1).
    pub coupling: [[f64x4; STAGES]; 3],
    /// Of the bank's oscillators of a circuit coordinate and rate at the end under forces tau^p / p!.
    fed: Vec<[Stages; 2]>,
    /// Of forces along the surfaces, where they are known.
    pub load: Option<LoadTable>,
    /// `coefficients[p][l]`: coefficient of tau^p / p! in the polynomial of a force per value at Gauss point l.
    coefficients: [Stages; STAGES],
}

impl StepTable {
    /// Room for the tables of `blocks` blocks.
    pub fn empty(blocks: usize) -> Self {
        Self {
            h: 0.0,
            oscillators: bytemuck::zeroed_vec((STAGES * 2 + MOMENTS) * blocks),
            coupling: [[f64x4::ZERO; STAGES]; 3],
            fed: Vec::new(),
            load: None,
            coefficients: Default::default(),
        }
    }

    /// Makes these the tables of `batch` for steps of length `h` s.
    pub fn fill(&mut self, batch: &OscillatorBatch, collocation: &Collocation, h: f64) {
        let n = batch.blocks.len();
        self.h = h;
        let mut scale = 1.0;
        for p in 0..STAGES {
            if p > 0 {
                scale *= p as f64 / h;
            }
            self.coefficients[p] = std::array::from_fn(|l| scale * collocation.lagrange[l][p]);
        }
        let mut rows = [[[0.0; STAGES]; STAGES]; 3];
        for j in 0..STAGES {
            let t = collocation.nodes[j] * h;
            let powers = powers(t);
            let (slope, impulse) = self.oscillators[2 * j * n..][..2 * n].split_at_mut(n);
            // answers of the approaches to forces tau^p / p!
            let mut answers = [[f64x4::ZERO; STAGES]; 3];
            for (k, block) in batch.blocks.iter().enumerate() {
                let moments = block.moments(t, &powers);
                (slope[k], impulse[k]) = (moments[0], moments[1]);
                for p in 0..STAGES {
                    for pair in 0..3 {
                        answers[pair][p] += block.products[pair] * moments[p + 2];
                    }
                }
            }
            let mut answers = answers.map(|answers| answers.map(f64x4::reduce_add));
            for fed in &batch.fed {
                let [displacement, _] = fed.answers(t);
                for p in 0..STAGES {
                    answers[0][p] += fed.approach * displacement[p];
                }
            }
            for (rows, answers) in rows.iter_mut().zip(answers) {
                for p in 0..STAGES {
                    for l in 0..STAGES {
                        rows[l][j] += self.coefficients[p][l] * answers[p];
                    }
                }
            }
        }
        self.coupling = rows.map(|columns| columns.map(f64x4::from));
        let powers = powers(h);
        for (k, block) in batch.blocks.iter().enumerate() {
            for (p, moment) in block.moments(h, &powers).into_iter().enumerate() {
                self.oscillators[(2 * STAGES + p) * n + k] = moment;
            }
        }
        self.fed.clear();
        self.fed.extend(batch.fed.iter().map(|fed| fed.answers(h)));
        self.load = (!batch.along.is_empty()).then(|| LoadTable::new(self, batch, collocation));
    }

    /// As [`Self::coupling`], of pairs of ways to see the oscillators of which `products` gives the products in each block.
    pub fn couplings<const PAIRS: usize>(
        &self,
        batch: &OscillatorBatch,
        collocation: &Collocation,
        products: impl Fn(usize) -> [f64x4; PAIRS],
    ) -> [[f64x4; STAGES]; PAIRS] {
        let mut columns = [[[0.0; STAGES]; STAGES]; PAIRS];
        for j in 0..STAGES {
            let t = collocation.nodes[j] * self.h;
            let powers = powers(t);
            let mut answers = [[f64x4::ZERO; STAGES]; PAIRS];
            for (k, block) in batch.blocks.iter().enumerate() {
                let moments = block.moments(t, &powers);
                for (answers, product) in answers.iter_mut().zip(products(k)) {
                    (0..STAGES).for_each(|p| answers[p] += product * moments[p + 2]);
                }
            }
            for (columns, answers) in columns.iter_mut().zip(answers) {
                let answers = answers.map(f64x4::reduce_add);
                for l in 0..STAGES {
                    columns[l][j] = (0..STAGES).map(|p| self.coefficients[p][l] * answers[p]).sum();
                }
            }
        }
        columns.map(|columns| columns.map(f64x4::from))
    }

    /// Approaches at the Gauss points, in m, if no force acted during the step; `gap` in m.
    #[inline]
    pub fn free_approach(
        &self,
        batch: &OscillatorBatch,
        gap: [f64; 2],
        q: &[f64x4],
        v: &[f64x4],
    ) -> [f64x4; 2] {
        let free = self.free_motion(batch, |k| batch.blocks[k].approach, q, v);
        std::array::from_fn(|i| free[i] - f64x4::splat(gap[i]))
    }

    /// What is `seen` of the oscillators at the nodes in two ways, m, if no force acted during the step.
    #[inline(always)]
    pub fn free_motion(
        &self,
        batch: &OscillatorBatch,
        seen: impl Fn(usize) -> [f64x4; 2],
        q: &[f64x4],
        v: &[f64x4],
    ) -> [f64x4; 2] {
        let n = q.len();
        let (blocks, v) = (&batch.blocks[..n], &v[..n]);
        let rows: [&[f64x4]; 2 * STAGES] = std::array::from_fn(|row| &self.oscillators[row * n..][..n]);
        let mut sums = [[f64x4::ZERO; STAGES]; 2];
        for k in 0..n {
            let rate = v[k] + blocks[k].damping * q[k];
            let seen = seen(k);
            for j in 0..STAGES {
                let value = rows[2 * j][k] * q[k] + rows[2 * j + 1][k] * rate;
                sums[0][j] += seen[0] * value;
                sums[1][j] += seen[1] * value;
            }
        }
        sums.map(|sums| f64x4::from(sums.map(f64x4::reduce_add)))
    }

    /// Writes the state at the end of the step under the forces at the Gauss points and gives the approaches there,
    /// without the gaps, and the energy of the oscillators there in J.
    #[inline]
    pub fn advance(
        &self,
        batch: &OscillatorBatch,
        forces: &[Stages; 2],
        (q, v): (&[f64x4], &[f64x4]),
        (q_end, v_end): (&mut [f64x4], &mut [f64x4]),
    ) -> ([f64; 2], f64) {
        let n = q.len();
        let (v, q_end, v_end) = (&v[..n], &mut q_end[..n], &mut v_end[..n]);
        let blocks = &batch.blocks[..n];
        let rows: [&[f64x4]; MOMENTS] =
            std::array::from_fn(|p| &self.oscillators[(2 * STAGES + p) * n..][..n]);
        let mut polynomial = [[0.0; STAGES]; 2];
        for p in 0..STAGES {
            for l in 0..STAGES {
                polynomial[0][p] += self.coefficients[p][l] * forces[0][l];
                polynomial[1][p] += self.coefficients[p][l] * forces[1][l];
            }
        }
        let (mut sums, mut energy) = ([f64x4::ZERO; 2], f64x4::ZERO);
        for k in 0..n {
            let Block { stiffness, damping, approach: [b0, b1], .. } = blocks[k];
            let (slope, impulse) = (rows[0][k], rows[1][k]);
            let mut displacement = slope * q[k] + impulse * (v[k] + damping * q[k]);
            let mut rate = slope * v[k] - stiffness * impulse * q[k];
            for p in 0..STAGES {
                let force = b0 * polynomial[0][p] + b1 * polynomial[1][p];
                displacement -= rows[p + 2][k] * force;
                rate -= rows[p + 1][k] * force;
            }
            (q_end[k], v_end[k]) = (displacement, rate);
            sums[0] += b0 * displacement;
            sums[1] += b1 * displacement;
            energy += rate * rate + stiffness * (displacement * displacement);
        }
        let mut sums = sums.map(f64x4::reduce_add);
        for (fed, answers) in batch.fed.iter().zip(&self.fed) {
            let [displacement, rate] = answers.map(|answers| dot(&answers, &polynomial[0]));
            bytemuck::cast_slice_mut::<_, f64>(q_end)[fed.place] -= displacement;
            bytemuck::cast_slice_mut::<_, f64>(v_end)[fed.place] -= rate;
            sums[0] -= fed.approach * displacement;
        }
        (sums, 0.5 * energy.reduce_add())
    }

    /// Adds what `forces` along the surfaces do to the state at the end of the step; gives what they add to the approaches, and the energy of
    /// all then in J.
    pub fn advance_along(
        &self,
        batch: &OscillatorBatch,
        forces: &[Stages; 2],
        (q_end, v_end): (&mut [f64x4], &mut [f64x4]),
    ) -> ([f64; 2], f64) {
        let n = q_end.len();
        let polynomial = forces.each_ref().map(|forces| self.coefficients.map(|row| dot(&row, forces)));
        let (mut sums, mut energy) = ([f64x4::ZERO; 2], f64x4::ZERO);
        for (k, (block, along)) in batch.blocks.iter().zip(&batch.along).enumerate() {
            let moments = std::array::from_fn(|p| self.oscillators[(2 * STAGES + p) * n + k]);
            let [displacement, rate] = pushed(&moments, along, &polynomial);
            q_end[k] += displacement;
            v_end[k] += rate;
            (0..2).for_each(|i| sums[i] += block.approach[i] * displacement);
            energy += v_end[k] * v_end[k] + block.stiffness * (q_end[k] * q_end[k]);
        }
        (sums.map(f64x4::reduce_add), 0.5 * energy.reduce_add())
    }
}
