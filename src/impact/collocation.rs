//! One time step: the contact forces are polynomials through Gauss points, the oscillators answer exactly.
//!
//! Within a step of length h both forces are interpolated through their values at the STAGES Gauss-Legendre
//! points c_j h. The oscillators' answer to such a force is exact (see [`super::duhamel`]), whatever omega h is:
//! high modes neither limit the step nor resonate with it. What is left is a system for the forces at the
//! Gauss points whose size does not depend on the number of modes. With smooth forces the velocities
//! after the step are of order 2 STAGES (Gauss quadrature), the forces inside of order STAGES.

use super::duhamel::{MOMENTS, Oscillator};
use super::system::System;
use crate::body::quadrature::gauss_legendre;

/// Gauss points of a step.
pub const STAGES: usize = 4;

/// Values at the Gauss points.
pub type Stages = [f64; STAGES];

/// Gauss points on 0..1 and their interpolation polynomials.
#[derive(Debug, Clone)]
pub struct Collocation {
    /// Gauss points, ascending.
    pub nodes: Stages,
    /// Gauss weights on 0..1.
    pub weights: Stages,
    /// `lagrange[l][p]`: coefficient of u^p in the polynomial that is 1 at node l and 0 at the others.
    pub lagrange: [Stages; STAGES],
}

impl Default for Collocation {
    fn default() -> Self {
        let (points, weights) = gauss_legendre(STAGES);
        let nodes: Stages = std::array::from_fn(|j| 0.5 * (1.0 + points[j]));
        let lagrange = std::array::from_fn(|l| {
            let mut polynomial = [0.0; STAGES];
            polynomial[0] = 1.0;
            for (degree, j) in (0..STAGES).filter(|j| *j != l).enumerate() {
                let scale = 1.0 / (nodes[l] - nodes[j]);
                for p in (0..=degree + 1).rev() {
                    let below = if p > 0 { polynomial[p - 1] } else { 0.0 };
                    let here = if p <= degree { polynomial[p] } else { 0.0 };
                    polynomial[p] = scale * (below - nodes[j] * here);
                }
            }
            polynomial
        });
        Self { nodes, weights: std::array::from_fn(|j| 0.5 * weights[j]), lagrange }
    }
}

impl Collocation {
    /// Weights of the values at the Gauss points in the polynomial's value at `u` (in units of the step).
    pub fn interpolation(&self, u: f64) -> Stages {
        std::array::from_fn(|l| self.lagrange[l].iter().rev().fold(0.0, |sum, c| sum * u + c))
    }

    /// Weights of the values at the Gauss points in the polynomial's derivative at `u`, per step.
    pub fn derivative(&self, u: f64) -> Stages {
        std::array::from_fn(|l| {
            (1..STAGES).rev().fold(0.0, |sum, p| sum * u + p as f64 * self.lagrange[l][p])
        })
    }

    /// An oscillator's answer at time `t` of a step of length `h`.
    pub fn response(&self, oscillator: &Oscillator, t: f64, h: f64) -> Response {
        let moments = oscillator.moments(t);
        let [slope, impulse, ..] = moments;
        Response {
            displacement_per_displacement: slope + 2.0 * oscillator.alpha * impulse,
            displacement_per_velocity: impulse,
            velocity_per_displacement: -oscillator.omega.powi(2) * impulse,
            velocity_per_velocity: slope,
            displacement_per_force: self.per_force(&moments[2..], h),
            velocity_per_force: self.per_force(&moments[1..], h),
        }
    }

    /// Answer per force at each Gauss point of a step of length `h`, from the answers to tau^p / p!.
    fn per_force(&self, moments: &[f64], h: f64) -> Stages {
        let mut answer = [0.0; STAGES];
        // the polynomials are in (tau/h)^p
        let mut scale = 1.0;
        for p in 0..STAGES {
            if p > 0 {
                scale *= p as f64 / h;
            }
            for l in 0..STAGES {
                answer[l] += self.lagrange[l][p] * scale * moments[p];
            }
        }
        answer
    }
}

/// Answer of an oscillator to its state at the start of the step and to the force at the Gauss points.
#[derive(Debug, Clone, Copy)]
pub struct Response {
    /// q(t) per q(0).
    pub displacement_per_displacement: f64,
    /// q(t) per q'(0), s.
    pub displacement_per_velocity: f64,
    /// q'(t) per q(0), 1/s.
    pub velocity_per_displacement: f64,
    /// q'(t) per q'(0).
    pub velocity_per_velocity: f64,
    /// q(t) per generalised force at each Gauss point, s^2.
    pub displacement_per_force: Stages,
    /// q'(t) per generalised force at each Gauss point, s.
    pub velocity_per_force: Stages,
}

/// Moments of one oscillator at the Gauss points and at the end of a step.
type PointMoments = [[f64; MOMENTS]; STAGES + 1];

/// Times of the Gauss points and of the end in a step of length `h`.
fn times(collocation: &Collocation, h: f64) -> [f64; STAGES + 1] {
    std::array::from_fn(|i| collocation.nodes.get(i).map_or(h, |node| node * h))
}

/// Everything about a step of one length that does not depend on the state.
#[derive(Debug, Clone)]
pub struct StepTable {
    /// Length of the step in s.
    pub h: f64,
    /// Moments of every oscillator at the Gauss points and at the end. Shape (n).
    moments: Vec<PointMoments>,
    /// q at Gauss point j per q(0) and q'(0). Each of shape (STAGES, n), row by row.
    node: [Vec<f64>; 2],
    /// [q per q(0), q per q'(0), q' per q(0), q' per q'(0)] at the end. Each of shape (n).
    end: [Vec<f64>; 4],
    /// q and q' at the end per generalised force at Gauss point l. Each of shape (STAGES, n).
    force: [Vec<f64>; 2],
    /// Approach at Gauss point j lost per force at Gauss point l: contacts (0,0), (0,1) = (1,0), (1,1).
    pub coupling: [[Stages; STAGES]; 3],
}

impl StepTable {
    /// Tables of `system` for steps of length `h` s.
    pub fn new(system: &System, collocation: &Collocation, h: f64) -> Self {
        let times = times(collocation, h);
        let moments = system.oscillators.iter().map(|o| times.map(|t| o.moments(t))).collect();
        Self::from_moments(system, collocation, h, moments)
    }

    /// Tables for steps of twice the length of these.
    pub fn doubled(&self, system: &System, collocation: &Collocation) -> Self {
        let times = times(collocation, self.h);
        let double = |(o, moments): (&Oscillator, &PointMoments)| {
            std::array::from_fn(|i| o.doubled(&moments[i], times[i]))
        };
        let moments = system.oscillators.iter().zip(&self.moments).map(double).collect();
        Self::from_moments(system, collocation, 2.0 * self.h, moments)
    }

    fn from_moments(system: &System, collocation: &Collocation, h: f64, moments: Vec<PointMoments>) -> Self {
        let n = system.size();
        let zeros = |rows: usize| vec![0.0; rows * n];
        let mut node = [zeros(STAGES), zeros(STAGES)];
        let mut end = [zeros(1), zeros(1), zeros(1), zeros(1)];
        let mut force = [zeros(STAGES), zeros(STAGES)];
        let mut coupling = [[[0.0; STAGES]; STAGES]; 3];
        for (k, (oscillator, moments)) in system.oscillators.iter().zip(&moments).enumerate() {
            let (b0, b1) = (system.approach[0][k], system.approach[1][k]);
            for j in 0..STAGES {
                let [slope, impulse, ..] = moments[j];
                node[0][j * n + k] = slope + 2.0 * oscillator.alpha * impulse;
                node[1][j * n + k] = impulse;
                let per_force = collocation.per_force(&moments[j][2..], h);
                for (coupling, product) in coupling.iter_mut().zip([b0 * b0, b0 * b1, b1 * b1]) {
                    for l in 0..STAGES {
                        coupling[j][l] += product * per_force[l];
                    }
                }
            }
            let last = &moments[STAGES];
            let [slope, impulse, ..] = *last;
            end[0][k] = slope + 2.0 * oscillator.alpha * impulse;
            end[1][k] = impulse;
            end[2][k] = -oscillator.omega.powi(2) * impulse;
            end[3][k] = slope;
            for (part, force) in force.iter_mut().enumerate() {
                let per_force = collocation.per_force(&last[2 - part..], h);
                for l in 0..STAGES {
                    force[l * n + k] = per_force[l];
                }
            }
        }
        Self { h, moments, node, end, force, coupling }
    }

    /// Approaches at the Gauss points, in m, if no force acted during the step.
    pub fn free_approach(&self, system: &System, q: &[f64], v: &[f64]) -> [Stages; 2] {
        let n = q.len();
        let mut approach = [[0.0; STAGES]; 2];
        let (b0, b1) = (&system.approach[0][..n], &system.approach[1][..n]);
        for j in 0..STAGES {
            let (per_q, per_v) = (&self.node[0][j * n..][..n], &self.node[1][j * n..][..n]);
            let (mut sum0, mut sum1) = ([0.0; LANES], [0.0; LANES]);
            for k in 0..n {
                let value = per_q[k] * q[k] + per_v[k] * v[k];
                sum0[k % LANES] += b0[k] * value;
                sum1[k % LANES] += b1[k] * value;
            }
            approach[0][j] = sum0.iter().sum::<f64>() - system.gap[0];
            approach[1][j] = sum1.iter().sum::<f64>() - system.gap[1];
        }
        approach
    }

    /// Writes the state at the end of the step under the forces at the Gauss points.
    pub fn advance(
        &self,
        system: &System,
        forces: &[Stages; 2],
        q: &[f64],
        v: &[f64],
        q_end: &mut [f64],
        v_end: &mut [f64],
    ) {
        let n = q.len();
        let (q_end, v_end) = (&mut q_end[..n], &mut v_end[..n]);
        let [qq, qv, vq, vv] = [&self.end[0][..n], &self.end[1][..n], &self.end[2][..n], &self.end[3][..n]];
        for k in 0..n {
            q_end[k] = qq[k] * q[k] + qv[k] * v[k];
            v_end[k] = vq[k] * q[k] + vv[k] * v[k];
        }
        let (b0, b1) = (&system.approach[0][..n], &system.approach[1][..n]);
        for l in 0..STAGES {
            let (f0, f1) = (forces[0][l], forces[1][l]);
            let (per_q, per_v) = (&self.force[0][l * n..][..n], &self.force[1][l * n..][..n]);
            for k in 0..n {
                let force = -(b0[k] * f0 + b1[k] * f1);
                q_end[k] += per_q[k] * force;
                v_end[k] += per_v[k] * force;
            }
        }
    }
}

/// Partial sums that the compiler can keep in vector registers.
const LANES: usize = 8;
