//! The bodies of a plate impact as one set of oscillators coupled by two contacts.
//!
//! Every body is a set of mass-normalised coordinates q_k: the rigid spheres (omega = 0), the modes
//! of the plate. The approach of contact i is delta_i = sum_k b_ik q_k - gap_i, less what the residual flexibility yields, and
//! its force acts back as q_k'' + 2 alpha_k q_k' + omega_k^2 q_k = -sum_i b_ik F_i.
//! Contact 0 joins outer body and plate, contact 1 plate and inner body.

use super::duhamel::Oscillator;
use crate::body::ModalBody;
use crate::contact::{Hertz, Residual};
use crate::scene::PlateImpact;

/// Index of the outer body's rigid motion among the oscillators.
pub const OUTER: usize = 0;
/// Index of the inner body's rigid motion.
pub const INNER: usize = 1;
/// Index of the first coordinate of the plate.
pub const PLATE: usize = 2;

/// Oscillators and contacts of a plate impact.
#[derive(Debug, Clone)]
pub struct System {
    /// The oscillators: outer body, inner body, plate. Shape (n).
    pub oscillators: Vec<Oscillator>,
    /// Approach of each contact per unit of each coordinate, kg^(-1/2). Shape (2, n).
    pub approach: [Vec<f64>; 2],
    /// Displacement along z of the plate's centre (mean of both faces) per unit of each coordinate. Shape (n).
    pub centre: Vec<f64>,
    /// Initial gap of each contact in m.
    pub gap: [f64; 2],
    /// Contact laws.
    pub laws: [Hertz; 2],
    /// Residual flexibility in terms of the approaches; `None` if it is zero.
    pub residual: Option<Residual>,
    /// Masses of outer and inner body in kg.
    pub masses: [f64; 2],
    /// Speed of the outer body towards the plate in m/s.
    pub speed: f64,
    /// First eigenfrequency of the plate that is not a rigid motion, Hz.
    pub first_frequency: f64,
    /// Number of elastic modes of the plate.
    pub modes: usize,
}

impl System {
    /// Joins the plate, reduced to `plate`, with rigid outer and inner bodies; `tip_residual` is the residual
    /// flexibility in m/N of the outer and the inner body at their contact points (zero for models A and B).
    pub fn new(setup: &PlateImpact, plate: &ModalBody, tip_residual: [f64; 2]) -> Self {
        let (outer, inner) = (&setup.outer, &setup.inner);
        let masses = [outer.shape.mass(&outer.material), inner.shape.mass(&inner.material)];
        let rigid = Oscillator { omega: 0.0, alpha: 0.0 };
        let mut oscillators = vec![rigid, rigid];
        let mut approach = [vec![-1.0 / masses[0].sqrt(), 0.0], vec![0.0, 1.0 / masses[1].sqrt()]];
        let mut centre = vec![0.0, 0.0];
        for ((&omega, &damping), &[top, bottom]) in
            plate.omega.iter().zip(&plate.damping_ratio).zip(&plate.participation)
        {
            oscillators.push(Oscillator { omega, alpha: damping * omega });
            approach[0].push(top);
            approach[1].push(-bottom);
            centre.push(0.5 * (top + bottom));
        }
        // the inner contact closes when the plate moves down
        let sign = |i: usize, j: usize| if i == j { 1.0 } else { -1.0 };
        let tip_radius = [outer.shape.tip_radius(), inner.shape.tip_radius()];
        let mut residual = Residual { flexibility: [[0.0; 2]; 2], growth: [[0.0; 2]; 2] };
        for i in 0..2 {
            for j in 0..2 {
                residual.flexibility[i][j] = sign(i, j) * plate.residual[i][j];
                residual.growth[i][j] = sign(i, j) * plate.patch_growth[i][j] * tip_radius[i];
            }
            residual.flexibility[i][i] += tip_residual[i];
        }
        let law = |shape: &crate::scene::Shape, material| {
            Hertz::new(shape.tip_radius(), material, &setup.plate.material)
        };
        let elastic = plate.omega.iter().copied().filter(|w| *w > 0.0);
        Self {
            approach,
            centre,
            gap: [0.0, inner.gap],
            laws: [law(&outer.shape, &outer.material), law(&inner.shape, &inner.material)],
            residual: (!residual.is_zero()).then_some(residual),
            masses,
            speed: outer.speed,
            first_frequency: elastic.clone().fold(f64::INFINITY, f64::min) / (2.0 * std::f64::consts::PI),
            modes: elastic.count(),
            oscillators,
        }
    }

    /// Number of oscillators.
    pub fn size(&self) -> usize {
        self.oscillators.len()
    }

    /// Coordinates and their rates at t = 0, when the outer body touches. Shapes (n).
    pub fn initial_state(&self) -> (Vec<f64>, Vec<f64>) {
        let mut rates = vec![0.0; self.size()];
        rates[OUTER] = -self.speed * self.masses[0].sqrt();
        (vec![0.0; self.size()], rates)
    }

    /// Kinetic energy of the outer body before the impact in J.
    pub fn initial_energy(&self) -> f64 {
        0.5 * self.masses[0] * self.speed.powi(2)
    }

    /// Kinetic and strain energy of all bodies in J, without that of the contacts.
    pub fn energy(&self, q: &[f64], v: &[f64]) -> f64 {
        self.oscillators.iter().zip(q).zip(v).map(|((o, q), v)| 0.5 * (v * v + (o.omega * q).powi(2))).sum()
    }

    /// Strain energy of contacts and residual flexibility in J under the forces `f` in N at the Hertz approaches `d` in m
    /// that go with them, negative where a contact is open.
    #[inline(always)]
    pub fn stored_energy(&self, f: [f64; 2], d: [f64; 2]) -> f64 {
        let d = d.map(|d| d.max(0.0));
        0.4 * (f[0] * d[0] + f[1] * d[1]) + self.residual.map_or(0.0, |r| r.strain_energy(f, d))
    }

    /// Approach of both contacts in m, without the part of the residual flexibility.
    pub fn modal_approach(&self, q: &[f64]) -> [f64; 2] {
        [0, 1].map(|i| dot(&self.approach[i], q) - self.gap[i])
    }

    /// Forces of both contacts in N at the modal approach `y` in m; `None` if there is no equilibrium.
    #[inline]
    pub fn forces(&self, y: [f64; 2]) -> Option<[f64; 2]> {
        match &self.residual {
            None => Some([self.laws[0].force(y[0]), self.laws[1].force(y[1])]),
            Some(residual) => residual.forces(&self.laws, y),
        }
    }
}

/// Scalar product.
#[inline(always)]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
