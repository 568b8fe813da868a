//! How a contact of a tip and a face is pressed at an instant, whatever law it follows.

use std::f64::consts::PI;
use wide::f64x4;

/// State of a contact, as far as motion along the surfaces depends on it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Press {
    /// Force across the surfaces, N.
    pub force: f64,
    /// Radius of the contact, m.
    pub radius: f64,
    /// From Hertz's distribution of the pressure, 0, to an even one, 1.
    pub evenness: f64,
    /// Curvature that the surfaces have lost and spring back to without the force, 1/m.
    pub curvature: f64,
}

impl Press {
    /// Between this instant and the `next`: force and cube of the radius change evenly, as in Hertz's contact.
    pub fn between(&self, next: &Press, share: f64) -> Press {
        let mix = |from: f64, to: f64| from + share * (to - from);
        Press {
            force: mix(self.force, next.force),
            radius: mix(self.radius.powi(3), next.radius.powi(3)).cbrt(),
            evenness: mix(self.evenness, next.evenness),
            curvature: mix(self.curvature, next.curvature),
        }
    }

    /// Load per length in N/m at `place` m, inside the contact radius, of the row of springs that has this pressure (Popov and Hess,
    /// Method of Dimensionality Reduction in Contact Mechanics and Friction, Springer 2015, section 3.3).
    #[inline(always)]
    pub fn load(&self, place: f64x4) -> f64x4 {
        let inside = place * self.radius.recip();
        let left = f64x4::ONE - inside * inside;
        let hertz = left * 0.75;
        if self.evenness == 0.0 {
            return hertz * (self.force / self.radius);
        }
        let even = left.sqrt() * (2.0 / PI);
        (hertz + (even - hertz) * self.evenness) * (self.force / self.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Of both distributions the springs bear the whole force.
    #[test]
    fn the_springs_bear_the_force() {
        for evenness in [0.0, 0.4, 1.0] {
            let press = Press { force: 7.0, radius: 2e-4, evenness, curvature: 0.0 };
            let count = 100_000;
            let width = 2.0 * press.radius / f64::from(count);
            let place = |k: u32| (f64::from(k) + 0.5) * width - press.radius;
            let places = |k: u32| f64x4::from([0, 1, 2, 3].map(|lane| place(k + lane)));
            let load = |k: u32| width * press.load(places(k)).reduce_add();
            let sum: f64 = (0..count).step_by(4).map(load).sum();
            assert_relative_eq!(sum, press.force, max_relative = 1e-6);
        }
    }
}
