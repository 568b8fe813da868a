//! What the contacts' local deformation adds to the motion of the plate's centre.
//!
//! The modes alone move the plate's mean plane. The centre that a finite-element program reports is the mean of the
//! points on the axis of both faces, and each of these sinks under its own contact. On the axis, a face moves by the
//! residual flexibility, weighted by a patch of no extent on its own side, and by the half-space: 0.75 (1 - nu^2)/(E a)
//! per unit force (Johnson, Contact Mechanics, 1985, section 3.4) with the patch radius a, a^2 = r p.

use super::system::System;
use crate::body::ModalBody;
use crate::contact::Hertz;

/// Displacement of the plate's centre by the contacts' local deformation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalCentre {
    /// Per contact, m/N: residual flexibility between its force and the centre, patches of no extent.
    flexibility: [f64; 2],
    /// Per contact, 1/N: its growth per m of p, see [`crate::contact::Residual`].
    growth: [f64; 2],
    /// Per contact: the half-space's share, m per N and per m^(-1/2) of the square root of p.
    half_space: [f64; 2],
}

impl LocalCentre {
    /// For `plate` with the contacts `laws`; `modulus` is the plate's E/(1 - nu^2) in Pa.
    pub fn new(plate: &ModalBody, laws: &[Hertz; 2], modulus: f64) -> Self {
        let (r, b) = (&plate.residual, &plate.patch_growth);
        let of = |value: &dyn Fn(usize) -> f64| [value(0), value(1)];
        Self {
            flexibility: of(&|j| 0.5 * (r[0][j] + r[1][j])),
            growth: of(&|j| 0.5 * (b[j][0] + b[j][1]) * laws[j].tip_radius),
            half_space: of(&|j| 0.5 * 0.75 / (modulus * laws[j].tip_radius.sqrt())),
        }
    }

    /// Displacement in m and velocity in m/s along z in addition to the modes', at the modal approach `y` in m, its
    /// rate in m/s and the forces `f` in N.
    pub fn motion(&self, system: &System, y: [f64; 2], rate: [f64; 2], f: [f64; 2]) -> [f64; 2] {
        let p = system.local_approach(y, f);
        let (p_rate, f_rate) = match &system.residual {
            Some(residual) => residual.rates(&system.laws, p, rate),
            None => (rate, [0, 1].map(|i| system.laws[i].tangent(p[i]) * rate[i])),
        };
        let mut motion = [0.0; 2];
        // the outer body presses the plate down, the inner one up
        for (j, sign) in [(0, -1.0), (1, 1.0)] {
            if f[j] > 0.0 {
                let per_force = self.flexibility[j] + self.growth[j] * p[j];
                // half-space: 0.75/(modulus a) per force with the patch of the force that acts
                let sunk = self.half_space[j] * f[j] / p[j].sqrt();
                let sunk_rate = sunk * (f_rate[j] / f[j] - 0.5 * p_rate[j] / p[j]);
                motion[0] += sign * (f[j] * per_force + sunk);
                motion[1] += sign * (f_rate[j] * per_force + f[j] * self.growth[j] * p_rate[j] + sunk_rate);
            }
        }
        motion
    }
}
