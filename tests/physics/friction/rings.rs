//! Oblique impact of a ball on a half-space by Maw, Barber and Fawcett's rings, independent of the models' springs.

use super::RADIUS;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Velocity of the ball along the surface after an impact on a half-space of its own material, over that before, by the method of Maw,
/// Barber and Fawcett (Wear 38 (1976) 101): the contact is divided into rings, in which the surfaces stick, or slide under Coulomb's
/// stress. The stress is a sum of Mindlin's distributions sqrt(1 - r^2/c^2).
pub(super) struct Rings {
    /// Outer radii, m. Shape (rings).
    pub(super) radii: Vec<f64>,
    /// Displacement over stress at the rings' middles, averaged around the axis. Shape (rings, distributions), m/Pa.
    displacement: DMatrix<f64>,
    /// Rigid displacement less the elastic one in m, which stays where surfaces stick, and the number of rings that touched.
    stuck: Vec<f64>,
    touched: usize,
}

impl Rings {
    /// Both bodies have Poisson's ratio `nu` and the shear modulus `shear`.
    pub(super) fn new(count: usize, largest: f64, nu: f64, shear: f64) -> Self {
        let radii: Vec<f64> = (1..=count).map(|k| largest * k as f64 / count as f64).collect();
        let middle = |i: usize| radii[i] - 0.5 * largest / count as f64;
        let displacement = DMatrix::from_fn(count, count, |i, j| {
            let (r, c) = (middle(i), radii[j]);
            let shape = if r < c {
                0.5 * PI * (2.0 * c * c - r * r)
            } else {
                (2.0 * c * c - r * r) * (c / r).asin() + c * (r * r - c * c).sqrt()
            };
            // both bodies
            2.0 * (2.0 - nu) / (8.0 * shear * c) * shape
        });
        Self { radii, displacement, stuck: vec![0.0; count], touched: 0 }
    }

    fn middle(&self, ring: usize) -> f64 {
        self.radii[ring] - 0.5 * self.radii[0]
    }

    /// Stress of the distributions at the middle of ring `i`, of those up to `active`. Shape (active).
    fn stresses(&self, i: usize, active: usize) -> DVector<f64> {
        DVector::from_fn(active, |j, _| (1.0 - (self.middle(i) / self.radii[j]).powi(2)).max(0.0).sqrt())
    }

    /// Force along the surfaces in N when they have moved by `place` m, in a contact of this `radius` in m with a limit of the stress in Pa
    /// by the distance from the middle in m.
    pub(super) fn force(&mut self, place: f64, radius: f64, limit: impl Fn(f64) -> f64) -> f64 {
        let active = self.radii.iter().take_while(|c| **c <= radius).count();
        if active == 0 {
            self.touched = 0;
            self.stuck.fill(place);
            return 0.0;
        }
        let limits: Vec<f64> = (0..active).map(|i| limit(self.middle(i))).collect();
        // the direction in which a ring slides; 0 = it sticks
        let mut slides = vec![0.0_f64; active];
        let mut amplitudes = DVector::zeros(active);
        for _ in 0..60 {
            let mut matrix = DMatrix::zeros(active, active);
            let mut right = DVector::zeros(active);
            for i in 0..active {
                if slides[i] == 0.0 {
                    (0..active).for_each(|j| matrix[(i, j)] = self.displacement[(i, j)]);
                    right[i] = place - self.stuck[i];
                } else {
                    matrix.set_row(i, &self.stresses(i, active).transpose());
                    right[i] = slides[i] * limits[i];
                }
            }
            amplitudes = matrix.lu().solve(&right).expect("regular");
            let mut changed = false;
            for i in 0..active {
                let stress = self.stresses(i, active).dot(&amplitudes);
                let moved = place - self.elastic(i, &amplitudes) - self.stuck[i];
                let next = if slides[i] == 0.0 {
                    if stress.abs() > limits[i] { stress.signum() } else { 0.0 }
                } else if moved * slides[i] < 0.0 {
                    0.0
                } else {
                    slides[i]
                };
                changed |= next != slides[i];
                slides[i] = next;
            }
            if !changed {
                break;
            }
        }
        for i in 0..self.radii.len() {
            if i >= active || i >= self.touched || slides[i] != 0.0 {
                self.stuck[i] = place - self.elastic(i, &amplitudes);
            }
        }
        self.touched = active;
        (0..active).map(|j| amplitudes[j] * 2.0 / 3.0 * PI * self.radii[j].powi(2)).sum()
    }

    /// Elastic displacement of ring `i` in m under distributions of these `amplitudes` in Pa.
    fn elastic(&self, i: usize, amplitudes: &DVector<f64>) -> f64 {
        (0..amplitudes.len()).map(|j| self.displacement[(i, j)] * amplitudes[j]).sum()
    }

    pub(super) fn restitution(
        mut self,
        mass: f64,
        [normal, tangential]: [f64; 2],
        stiffness: f64,
        friction: f64,
    ) -> f64 {
        let largest_approach = (1.25 * mass * normal * normal / stiffness).powf(0.4);
        let steps = 1500;
        let h = 2.9433 * largest_approach / normal / steps as f64;
        let (mut approach, mut rate, mut place, mut slip_rate) = (0.0, normal, 0.0, tangential);
        let (mut force, mut along) = (0.0, 0.0);
        loop {
            rate -= 0.5 * h * force / mass;
            slip_rate -= 0.5 * h * 3.5 * along / mass;
            approach += h * rate;
            place += h * slip_rate;
            if approach <= 0.0 {
                break;
            }
            let radius = (RADIUS * approach).sqrt();
            force = stiffness * approach.powf(1.5);
            let pressure = 1.5 * force / (PI * radius * radius);
            along = self
                .force(place, radius, |r| friction * pressure * (1.0 - (r / radius).powi(2)).max(0.0).sqrt());
            rate -= 0.5 * h * force / mass;
            slip_rate -= 0.5 * h * 3.5 * along / mass;
        }
        1.0 - (tangential - slip_rate) / 3.5 / tangential
    }
}
