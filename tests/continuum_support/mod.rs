//! Materials, plates, and a plain Runge-Kutta integration of model C for the tests of the continuum bodies.
#![allow(dead_code)] // each test file uses its part

use impactcheck::body::ModalBody;
use impactcheck::scene::{Edge, Material, Plate};

pub fn material(youngs_modulus: f64, poisson_ratio: f64, density: f64) -> Material {
    Material { name: "material".into(), youngs_modulus, poisson_ratio, density }
}

pub fn steel() -> Material {
    material(210e9, 0.3, 7780.0)
}

pub fn titanium() -> Material {
    material(115e9, 0.37, 4430.0)
}

pub fn plate_of(radius: f64, thickness: f64, edge: Edge, material: Material) -> Plate {
    Plate { radius, thickness, edge, material, damping_ratio: 0.0 }
}

/// Two spheres on the axis of a plate, in contact with it at t = 0.
pub struct Impact {
    pub plate: ModalBody,
    /// Mass of each sphere, kg: outer, inner.
    pub mass: [f64; 2],
    /// Hertz stiffness k of F = k delta^1.5 at each contact, N/m^1.5.
    pub stiffness: [f64; 2],
    /// Residual flexibility of each sphere, m/N.
    pub sphere_residual: [f64; 2],
    /// Speed of the outer sphere, m/s.
    pub speed: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactResult {
    pub efficiency: f64,
    /// N: outer, inner.
    pub peak: [f64; 2],
    /// s: outer, inner.
    pub end: [f64; 2],
}

/// Positions and velocities: z of outer sphere, z of inner sphere, modal coordinates.
#[derive(Clone)]
struct State {
    position: Vec<f64>,
    velocity: Vec<f64>,
}

impl Impact {
    /// Classical Runge-Kutta with the constant step `step` up to `end`, both in s.
    pub fn run(&self, step: f64, end: f64) -> ImpactResult {
        let n = self.plate.omega.len() + 2;
        let mut state = State { position: vec![0.0; n], velocity: vec![0.0; n] };
        state.velocity[0] = -self.speed;
        let mut result = ImpactResult { efficiency: 0.0, peak: [0.0; 2], end: [0.0; 2] };
        let mut force = [0.0; 2];
        for i in 0..(end / step).round() as usize {
            let mut stages: Vec<(Vec<f64>, Vec<f64>)> = Vec::with_capacity(4);
            for fraction in [0.0, 0.5, 0.5, 1.0] {
                let mut at = state.clone();
                if let Some((velocity, acceleration)) = stages.last() {
                    for j in 0..n {
                        at.position[j] += fraction * step * velocity[j];
                        at.velocity[j] += fraction * step * acceleration[j];
                    }
                }
                force = self.forces(&at, force);
                stages.push((at.velocity.clone(), self.acceleration(&at, force)));
            }
            let weights = [1.0, 2.0, 2.0, 1.0].map(|w| w * step / 6.0);
            for ((velocity, acceleration), weight) in stages.iter().zip(weights) {
                for j in 0..n {
                    state.position[j] += weight * velocity[j];
                    state.velocity[j] += weight * acceleration[j];
                }
            }
            force = self.forces(&state, force);
            for (c, &force) in force.iter().enumerate() {
                result.peak[c] = result.peak[c].max(force);
                if force > 0.0 {
                    result.end[c] = (i + 1) as f64 * step;
                }
            }
        }
        let energy = |c: usize, v: f64| 0.5 * self.mass[c] * v * v;
        result.efficiency = energy(1, state.velocity[1]) / energy(0, self.speed);
        result
    }

    fn acceleration(&self, state: &State, force: [f64; 2]) -> Vec<f64> {
        let on_plate = [-force[0], force[1]];
        let mut a = vec![force[0] / self.mass[0], -force[1] / self.mass[1]];
        for (k, (&omega, phi)) in self.plate.omega.iter().zip(&self.plate.participation).enumerate() {
            a.push(-omega * omega * state.position[k + 2] + phi[0] * on_plate[0] + phi[1] * on_plate[1]);
        }
        a
    }

    /// Contact forces: Newton on F_i = k_i delta_i^1.5 with the approach delta_i reduced by the residuals.
    fn forces(&self, state: &State, guess: [f64; 2]) -> [f64; 2] {
        let modal = |i: usize| -> f64 {
            let q = &state.position[2..];
            self.plate.participation.iter().zip(q).map(|(phi, q)| phi[i] * q).sum()
        };
        let rigid = [modal(0) - state.position[0], state.position[1] - modal(1)];
        let r = self.plate.residual;
        // delta = rigid - a F; forces on the plate are (-F0, +F1).
        let a =
            [[r[0][0] + self.sphere_residual[0], -r[0][1]], [-r[1][0], r[1][1] + self.sphere_residual[1]]];
        let mut force = guess;
        for _ in 0..100 {
            let mut f = [0.0; 2];
            let mut jacobian = [[0.0; 2]; 2];
            for i in 0..2 {
                let delta = (rigid[i] - a[i][0] * force[0] - a[i][1] * force[1]).max(0.0);
                f[i] = force[i] - self.stiffness[i] * delta.powf(1.5);
                for j in 0..2 {
                    jacobian[i][j] =
                        f64::from(u8::from(i == j)) + 1.5 * self.stiffness[i] * delta.sqrt() * a[i][j];
                }
            }
            let [[j00, j01], [j10, j11]] = jacobian;
            let determinant = j00 * j11 - j01 * j10;
            let change = [(j11 * f[0] - j01 * f[1]) / determinant, (j00 * f[1] - j10 * f[0]) / determinant];
            force = [force[0] - change[0], force[1] - change[1]];
            if change[0].abs().max(change[1].abs()) < 1e-9 {
                return force.map(|f| f.max(0.0));
            }
        }
        panic!("contact forces did not converge: {rigid:?} {force:?}");
    }
}
