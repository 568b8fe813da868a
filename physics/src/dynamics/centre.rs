//! What the contacts' local deformation adds to the motion of the plate under them.
//!
//! The modes alone move the plate as a whole. What is observed, here and of the finite elements, is the mean of both faces, each
//! averaged with Hertz's weight sqrt(1 - (r/b)^2) over a circle of half the contact radius that the outer body would have on a
//! rigid plate: a point would follow every wave of a mesh. A face sinks under its own contact by the residual flexibility and by
//! that of a half-space, where pressures over concentric circles of the radii a <= b displace each other by
//! 0.75 (1 - nu^2)/(E b) (1 - a^2/(5 b^2)) per unit force (the mean of Hertz's displacement, Johnson, Contact Mechanics, 1985,
//! section 3.4, over the other pressure).

use crate::analytical::hertz::HertzImpact;
use crate::contact::{Hertz, PatchFlexibility, RADII, TABULATED};

/// Radius of the circle over the contact radius of the impact on a rigid plate.
const SHARE: f64 = 0.5;

/// Displacement of the plate's centre by the contacts' local deformation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalCentre {
    /// Residual flexibility of the plate.
    flexibility: PatchFlexibility,
    /// Tip radii in m.
    tip_radius: [f64; 2],
    /// E/(1 - nu^2) of the plate in Pa.
    modulus: f64,
    /// Square of the radius of the circle, m^2.
    circle: f64,
    /// Whether the outer body strikes off-centre, away from the circle.
    is_off_centre: bool,
}

impl LocalCentre {
    /// For a plate of the residual `flexibility` with the contacts `laws`; `modulus` is the plate's E/(1 - nu^2) in Pa, `hit` the
    /// outer body's impact on a rigid plate.
    pub fn new(flexibility: PatchFlexibility, laws: &[Hertz; 2], modulus: f64, hit: &HertzImpact) -> Self {
        let tip_radius = laws.map(|law| law.tip_radius);
        let circle = SHARE * SHARE * tip_radius[0] * hit.approach_peak();
        Self { flexibility, tip_radius, modulus, circle, is_off_centre: false }
    }

    /// The same of an off-centre impact: the face under the outer body sinks elsewhere.
    #[must_use]
    pub fn off_centre(self) -> Self {
        Self { is_off_centre: true, ..self }
    }

    /// Displacement of the centre per force of contact `j` with the patch `p` in m, in m/N: the mean of both faces.
    fn per_force(&self, j: usize, p: f64) -> f64 {
        let patch = self.tip_radius[j] * p;
        // the table goes no further; beyond it faces are averaged over a narrower circle
        let widest = self.flexibility.per_square.map(|per| RADII[TABULATED - 1].powi(2) / per);
        // on its own face the flexibility grows evenly with the squares of both circles
        let own = [0.5 * (self.circle.min(widest[j]) + patch); 2];
        let mut between = widest.map(|widest| self.circle.min(widest));
        between[j] = patch;
        let (small, large) = (patch.min(self.circle), patch.max(self.circle));
        let half_space = 0.75 / (self.modulus * large.sqrt()) * (1.0 - 0.2 * small / large);
        let (own, mutual) = (self.flexibility.at(own)[2 * j] + half_space, self.flexibility.at(between)[1]);
        match (self.is_off_centre, j) {
            (false, _) => 0.5 * (own + mutual),
            // both faces of the centre move as the inner contact does
            (true, 0) => mutual,
            (true, _) => 0.5 * own,
        }
    }

    /// Displacement in m along z in addition to the modes', with the patches `p` in m and the forces `f` in N.
    pub fn displacement(&self, p: [f64; 2], f: [f64; 2]) -> f64 {
        // the outer body presses the plate down, the inner one up
        [(0, -1.0), (1, 1.0)]
            .iter()
            .filter(|(j, _)| f[*j] > 0.0)
            .map(|&(j, sign)| sign * f[j] * self.per_force(j, p[j]))
            .sum()
    }

    /// Displacement in m and velocity in m/s along z in addition to the modes', with the patches `p` in m, the forces `f` in N and
    /// the rates of both.
    pub fn motion(&self, (p, p_rate): ([f64; 2], [f64; 2]), (f, f_rate): ([f64; 2], [f64; 2])) -> [f64; 2] {
        let mut motion = [0.0; 2];
        // the outer body presses the plate down, the inner one up
        for (j, sign) in [(0, -1.0), (1, 1.0)] {
            if f[j] > 0.0 {
                let per_force = self.per_force(j, p[j]);
                let step = 1e-4 * p[j];
                let growth = (self.per_force(j, p[j] + step) - self.per_force(j, p[j] - step)) / (2.0 * step);
                motion[0] += sign * f[j] * per_force;
                motion[1] += sign * (f_rate[j] * per_force + f[j] * growth * p_rate[j]);
            }
        }
        motion
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    /// Hertz's displacement per unit force at `r` outside and inside his circle of the radius `a`, over (1 - nu^2)/E (Johnson,
    /// eqs. 3.41a and 3.42a).
    fn displacement(a: f64, r: f64) -> f64 {
        let pressure = 1.5 / (PI * a * a);
        if r <= a {
            return PI * pressure / (4.0 * a) * (2.0 * a * a - r * r);
        }
        let ratio = a / r;
        pressure / (2.0 * a)
            * ((2.0 * a * a - r * r) * ratio.asin() + r * r * ratio * (1.0 - ratio * ratio).sqrt())
    }

    #[test]
    fn a_half_space_sinks_under_its_circle_by_the_mean_of_hertzs_displacement() {
        let laws = [Hertz { tip_radius: 0.01, stiffness: 1e10 }; 2];
        let hit = HertzImpact { mass: 0.03, speed: 0.5, stiffness: laws[0].stiffness };
        let centre = LocalCentre::new(PatchFlexibility::constant([[0.0; 2]; 2]), &laws, 2e11, &hit);
        let circle = centre.circle.sqrt();
        for ratio in [0.3, 0.9, 1.0, 1.2, 2.5] {
            let patch = ratio * circle;
            // r = b sqrt(1 - s^2) takes the end of the weight away
            let n = 4000;
            let mean = (0..n).map(|k| {
                let s = (f64::from(k) + 0.5) / f64::from(n);
                3.0 * s * s / f64::from(n) * displacement(patch, circle * (1.0 - s * s).sqrt())
            });
            let exact = 0.5 * mean.sum::<f64>() / 2e11;
            assert_relative_eq!(centre.per_force(0, patch * patch / 0.01), exact, max_relative = 1e-5);
        }
    }
}
