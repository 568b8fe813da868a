//! How a contact of a tip and a face is pressed at an instant, whatever law it follows.

use std::f64::consts::PI;

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
    pub fn load(&self, place: f64) -> f64 {
        let left = 1.0 - (place / self.radius).powi(2);
        let [hertz, even] = [0.75 * left, 2.0 / PI * left.sqrt()];
        self.force / self.radius * (hertz + self.evenness * (even - hertz))
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
            let sum: f64 = (0..count).map(|k| width * press.load(place(k))).sum();
            assert_relative_eq!(sum, press.force, max_relative = 1e-6);
        }
    }
}
