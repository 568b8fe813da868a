//! One time step: the contact forces are polynomials through Gauss points, the oscillators answer exactly.
//!
//! Within a step of length h both forces are interpolated through their values at the STAGES Gauss-Legendre
//! points c_j h. The oscillators' answer to such a force is exact (see [`crate::numerics::duhamel`]), whatever omega h is:
//! high modes neither limit the step nor resonate with it. What is left is a system for the forces at the
//! Gauss points whose size does not depend on the number of modes. With smooth forces the velocities
//! after the step are of order 2 STAGES (Gauss quadrature), the forces inside of order STAGES.
//!
//! Forces that damp are another matter: to one that would stop a motion within a part of the step Gauss's points
//! answer with a motion that comes back undamped. Radau's points, of which the last is the end, stop it
//! (L-stability: Hairer and Wanner, Solving Ordinary Differential Equations II, IV.5), at order 2 STAGES - 1.

use crate::numerics::duhamel::{Feed, Oscillator};
use crate::numerics::quadrature::{gauss_legendre, gauss_radau};
use crate::numerics::stages::{STAGES, Stages};
use wide::f64x4;

/// Points of a step at which a contact is known: its start, the Gauss points, its end.
pub const POINTS: usize = STAGES + 2;

/// The same with Radau's points, of which the last is the end.
pub const RADAU_POINTS: usize = STAGES + 1;

/// Values at start, Gauss points and end of a step.
pub type Points = [f64; POINTS];

/// Gauss or Radau points on 0..1 and their interpolation polynomials; `P` points of a step are known, the ends included.
#[derive(Debug, Clone)]
pub struct Collocation<const P: usize = POINTS> {
    /// Gauss (Radau) points, ascending.
    pub nodes: Stages,
    /// Their weights on 0..1.
    pub weights: Stages,
    /// `lagrange[l][p]`: coefficient of u^p in the polynomial that is 1 at node l and 0 at the others.
    pub lagrange: [Stages; STAGES],
    /// Start, Gauss (Radau) points and end on 0..1.
    pub points: [f64; P],
    /// The same as `lagrange` for the polynomials through all `P` points.
    through_points: [[f64; P]; P],
    /// Weights of the values at the nodes in the polynomial's value at the start and at the end.
    pub ends: [Stages; 2],
    /// `slopes[j]`: weights in the polynomial's derivative at node j, per step.
    pub slopes: [Stages; STAGES],
}

impl Default for Collocation {
    /// Gauss's points.
    fn default() -> Self {
        Self::new(&gauss_legendre(STAGES))
    }
}

impl Collocation<RADAU_POINTS> {
    /// Radau's points, for forces that damp.
    pub fn radau() -> Self {
        Self::new(&gauss_radau(STAGES))
    }
}

/// Coefficients of Lagrange's polynomials: `[l][p]` that of u^p in the one that is 1 at `nodes[l]`, 0 at the others.
fn lagrange<const N: usize>(nodes: &[f64; N]) -> [[f64; N]; N] {
    std::array::from_fn(|l| {
        let mut polynomial = [0.0; N];
        polynomial[0] = 1.0;
        for (degree, j) in (0..N).filter(|j| *j != l).enumerate() {
            let scale = 1.0 / (nodes[l] - nodes[j]);
            for p in (0..=degree + 1).rev() {
                let below = if p > 0 { polynomial[p - 1] } else { 0.0 };
                let here = if p <= degree { polynomial[p] } else { 0.0 };
                polynomial[p] = scale * (below - nodes[j] * here);
            }
        }
        polynomial
    })
}

/// Value of the polynomial with `coefficients` at `u`.
#[inline(always)]
pub fn horner(coefficients: &[f64], u: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * u + c)
}

/// Coefficients of the derivative of the polynomial with `coefficients`.
pub fn derivative<const N: usize>(coefficients: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|p| coefficients.get(p + 1).map_or(0.0, |c| (p + 1) as f64 * c))
}

/// Newton's steps for a crossing at most.
const MAX_CROSSING_STEPS: usize = 50;
/// Change of a place in the step (0..1) at which a crossing is found: the next one is far below rounding errors.
const CROSSING: f64 = 1e-9;

/// Where between `ends` the polynomial with `coefficients` passes zero, by Newton's method kept between the places with
/// either sign; `values` are those at the ends, of which the second is positive or, if the first is, not.
#[inline]
pub fn crossing<const N: usize>(coefficients: &[f64; N], ends: [f64; 2], values: [f64; 2]) -> f64 {
    let ([mut low, mut high], rising) = (ends, values[1] > 0.0);
    let mut place = low + (high - low) * (values[0] / (values[0] - values[1])).clamp(0.0, 1.0);
    for _ in 0..MAX_CROSSING_STEPS {
        let (mut value, mut slope) = (0.0, 0.0);
        for c in coefficients.iter().rev() {
            slope = slope * place + value;
            value = value * place + c;
        }
        if (value > 0.0) == rising {
            high = place
        } else {
            low = place
        }
        let newton = place - value / slope;
        // false for NaN also
        let inside = newton >= low && newton <= high;
        let next = if inside { newton } else { 0.5 * (low + high) };
        if (next - place).abs() <= CROSSING {
            return next;
        }
        place = next;
    }
    place
}

impl<const P: usize> Collocation<P> {
    /// From points in (-1, 1] and their weights.
    fn new((points, weights): &(Vec<f64>, Vec<f64>)) -> Self {
        let nodes: Stages = std::array::from_fn(|j| 0.5 * (1.0 + points[j]));
        let points: [f64; P] = std::array::from_fn(|i| match i {
            0 => 0.0,
            _ if i == P - 1 => 1.0,
            _ => nodes[i - 1],
        });
        let mut collocation = Self {
            nodes,
            weights: std::array::from_fn(|j| 0.5 * weights[j]),
            lagrange: lagrange(&nodes),
            points,
            through_points: self::lagrange(&points),
            ends: Default::default(),
            slopes: Default::default(),
        };
        collocation.ends = [0.0, 1.0].map(|u| collocation.interpolation(u));
        collocation.slopes = nodes.map(|u| collocation.derivative(u));
        collocation
    }

    /// Coefficients of the polynomial through `values` at all points.
    #[inline(always)]
    pub fn through(&self, values: &[f64; P]) -> [f64; P] {
        let mut coefficients = [0.0; P];
        for l in 0..P {
            for p in 0..P {
                coefficients[p] += self.through_points[l][p] * values[l];
            }
        }
        coefficients
    }

    /// Weights of the values at all points of a step in the polynomial's values at the Gauss points of the next step,
    /// which is `ratio` times as long. Shape (P, STAGES).
    pub fn extrapolation(&self, ratio: f64) -> [f64x4; P] {
        self.through_points
            .map(|polynomial| f64x4::from(self.nodes.map(|node| horner(&polynomial, 1.0 + node * ratio))))
    }

    /// Derivatives by time, at the start of a step of `h` s, of the polynomial through `values` at the nodes.
    pub fn derivatives(&self, values: &Stages, h: f64) -> Stages {
        let mut scale = 1.0;
        std::array::from_fn(|p| {
            if p > 0 {
                scale *= p as f64 / h;
            }
            scale
                * values
                    .iter()
                    .zip(&self.lagrange)
                    .map(|(value, polynomial)| value * polynomial[p])
                    .sum::<f64>()
        })
    }

    /// Weights of the values at the nodes in the polynomial's value at `u` (in units of the step).
    pub fn interpolation(&self, u: f64) -> Stages {
        self.lagrange.map(|polynomial| horner(&polynomial, u))
    }

    /// Weights of the values at the nodes in the polynomial's derivative at `u`, per step.
    fn derivative(&self, u: f64) -> Stages {
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

    /// Coordinate and rate of an oscillator through `feed` at time `t` of a step of length `h`, per force at the nodes.
    pub fn fed(&self, oscillator: &Oscillator, feed: &Feed, t: f64, h: f64) -> [Stages; 2] {
        oscillator.fed(feed, &oscillator.moments(t)).map(|answers| self.per_force(&answers, h))
    }

    /// Answer per force at each node of a step of length `h`, from the answers to tau^p / p!.
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

/// Answer of an oscillator to its state at the start of the step and to the force at the nodes.
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
    /// q(t) per generalised force at each node, s^2.
    pub displacement_per_force: Stages,
    /// q'(t) per generalised force at each node, s.
    pub velocity_per_force: Stages,
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use faer::Mat;
    use faer::linalg::solvers::Solve;

    /// v' = -lambda v over one step of length 1: a force that damps much faster than the step.
    fn left_of_a_damped_rate<const P: usize>(collocation: &Collocation<P>, lambda: f64) -> f64 {
        let free = Oscillator { omega: 0.0, alpha: 0.0 };
        let rows = collocation.nodes.map(|u| collocation.response(&free, u, 1.0).velocity_per_force);
        let matrix = Mat::from_fn(STAGES, STAGES, |j, l| f64::from(u8::from(j == l)) + lambda * rows[j][l]);
        let force = matrix.partial_piv_lu().solve(Mat::from_fn(STAGES, 1, |_, _| -lambda));
        1.0 + collocation.weights.iter().enumerate().map(|(j, w)| w * force[(j, 0)]).sum::<f64>()
    }

    #[test]
    fn crossings_are_found_wherever_they_are_and_however_flat() {
        for root in [1e-9_f64, 0.1, 0.37, 0.5, 0.999] {
            // (u - r)(u^2 + 1), (r - u)(u + 2)^2, (u - r)^3
            let polynomials = [
                [-root, 1.0, -root, 1.0],
                [4.0 * root, 4.0 * root - 4.0, root - 4.0, -1.0],
                [-root.powi(3), 3.0 * root * root, -3.0 * root, 1.0],
            ];
            for (polynomial, accuracy) in polynomials.into_iter().zip([1e-15, 1e-15, 1e-5]) {
                let values = [0.0, 1.0].map(|u| horner(&polynomial, u));
                let found = crossing(&polynomial, [0.0, 1.0], values);
                assert_relative_eq!(found, root, epsilon = accuracy);
            }
        }
        // no sign change: the end that is nearer to one
        assert!(crossing(&[1.0, 1.0], [0.0, 1.0], [-1e-20, 2.0]) < 1e-9);
    }

    #[test]
    fn radau_stops_what_is_damped_within_the_step_and_gauss_does_not() {
        for lambda in [1e4, 1e8] {
            assert!(left_of_a_damped_rate(&Collocation::radau(), lambda).abs() < 10.0 / lambda);
            assert!(left_of_a_damped_rate(&Collocation::default(), lambda).abs() > 0.9);
        }
        // its answer is Padé's (3, 4) approximation of the decay
        let above = 1.0 - 3.0 / 7.0 + 1.0 / 14.0 - 1.0 / 210.0;
        let below = 1.0 + 4.0 / 7.0 + 1.0 / 7.0 + 2.0 / 105.0 + 1.0 / 840.0;
        assert_relative_eq!(
            left_of_a_damped_rate(&Collocation::radau(), 1.0),
            above / below,
            epsilon = 1e-13
        );
    }
}
