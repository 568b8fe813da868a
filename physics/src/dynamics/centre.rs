//! What the contacts' local deformation adds to the motion of the plate's centre.
//!
//! The modes alone move the plate's mean plane. The centre that a finite-element program reports is the mean of the
//! points on the axis of both faces, and each of these sinks under its own contact. On the axis, a face moves by the
//! residual flexibility, weighted by a patch of no extent on its own side, and by the half-space: 0.75 (1 - nu^2)/(E a)
//! per unit force (Johnson, Contact Mechanics, 1985, section 3.4) with the patch radius a, a^2 = r p.

use super::system::System;
use crate::contact::{Hertz, PatchFlexibility};

/// Displacement of the plate's centre by the contacts' local deformation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalCentre {
    /// Residual flexibility of the plate.
    flexibility: PatchFlexibility,
    /// Tip radii in m.
    tip_radius: [f64; 2],
    /// Per contact: the half-space's share, m per N and per m^(-1/2) of the square root of p.
    half_space: [f64; 2],
}

impl LocalCentre {
    /// For a plate of the residual `flexibility` with the contacts `laws`; `modulus` is the plate's E/(1 - nu^2) in Pa.
    pub fn new(flexibility: PatchFlexibility, laws: &[Hertz; 2], modulus: f64) -> Self {
        let tip_radius = laws.map(|law| law.tip_radius);
        Self { flexibility, tip_radius, half_space: tip_radius.map(|r| 0.5 * 0.75 / (modulus * r.sqrt())) }
    }

    /// Displacement of the centre per force of contact `j` with the patch `p` in m, in m/N: the mean of both faces. On the
    /// contact's own face the patch counts once, as that of the force, and not as that of a displacement.
    fn per_force(&self, j: usize, p: f64) -> f64 {
        let mut square = [0.0; 2];
        let none = self.flexibility.at(square);
        square[j] = self.tip_radius[j] * p;
        let under = self.flexibility.at(square);
        0.5 * (0.5 * (none[2 * j] + under[2 * j]) + under[1])
    }

    /// Displacement in m and velocity in m/s along z in addition to the modes', with the patches `p` in m, the rates of the modal
    /// approaches in m/s and the forces `f` in N.
    pub fn motion(&self, system: &System, p: [f64; 2], rate: [f64; 2], f: [f64; 2]) -> [f64; 2] {
        let (p_rate, f_rate) = match &system.residual {
            Some(residual) => residual.rates(&system.laws, p, rate),
            None => (rate, [0, 1].map(|i| system.laws[i].tangent(p[i]) * rate[i])),
        };
        let mut motion = [0.0; 2];
        // the outer body presses the plate down, the inner one up
        for (j, sign) in [(0, -1.0), (1, 1.0)] {
            if f[j] > 0.0 {
                let per_force = self.per_force(j, p[j]);
                let step = 1e-4 * p[j];
                let growth = (self.per_force(j, p[j] + step) - self.per_force(j, p[j] - step)) / (2.0 * step);
                // half-space: 0.75/(modulus a) per force with the patch of the force that acts
                let sunk = self.half_space[j] * f[j] / p[j].sqrt();
                let sunk_rate = sunk * (f_rate[j] / f[j] - 0.5 * p_rate[j] / p[j]);
                motion[0] += sign * (f[j] * per_force + sunk);
                motion[1] += sign * (f_rate[j] * per_force + f[j] * growth * p_rate[j] + sunk_rate);
            }
        }
        motion
    }
}
