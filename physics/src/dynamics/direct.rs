//! Impacts without a plate: a body strikes a wall, or another body.
//!
//! There is one contact, the first of a [`System`]; the second belongs to no coordinate and never closes. A wall does not move: in place of
//! the inner body stands a coordinate that nothing is coupled to.

use super::moving_body::MovingBody;
use super::system::{INNER, System};
use crate::body::ModalBody;
use crate::material::Material;
use crate::numerics::duhamel::Oscillator;

/// Distance in m at which the second contact stays for ever.
const OPEN: f64 = 1.0;

impl System {
    /// `outer` strikes a flat wall of `material`.
    pub fn on_wall(outer: MovingBody, material: &Material) -> Self {
        let still = MovingBody {
            oscillators: vec![Oscillator { omega: 0.0, alpha: 0.0 }],
            tip: vec![0.0],
            displacement: vec![0.0],
            velocity: vec![0.0],
            speed: 0.0,
            drive: None,
            stack: None,
            supply: None,
            ..outer.clone()
        };
        Self::direct([outer, still], material)
    }

    /// `outer` strikes `inner`; both tips are curved. Source: Johnson, Contact Mechanics, 1985, section 4.2: 1/R = 1/R1 + 1/R2.
    pub fn of_two_bodies(outer: MovingBody, inner: MovingBody) -> Self {
        let material = inner.material.clone();
        let [first, second] = [outer.tip_radius, inner.tip_radius];
        let tip_radius = first * second / (first + second);
        Self::direct([MovingBody { tip_radius, ..outer }, inner], &material)
    }

    /// The first contact joins both bodies; that of the outer body's tip with a face of `material`.
    fn direct(bodies: [MovingBody; 2], material: &Material) -> Self {
        let nothing = ModalBody {
            omega: Vec::new(),
            damping_ratio: Vec::new(),
            participation: Vec::new(),
            residual: None,
        };
        let mut system = Self::of(&bodies, &nothing, material, [0.0; 2]);
        system.approach[0][INNER] = system.approach[1][INNER];
        system.approach[1].fill(0.0);
        system.gap[1] = OPEN;
        system.laws[1] = system.laws[0];
        system
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analytical::hertz::HertzImpact;
    use crate::contact::Hertz;
    use crate::dynamics::integrate;
    use crate::dynamics::integration::Options;
    use crate::scene::{Inner, Outer, Shape};
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    fn material(modulus: f64, poisson_ratio: f64, density: f64) -> Material {
        Material::elastic("of a test", modulus, poisson_ratio, density)
    }

    fn outer(radius: f64, speed: f64) -> MovingBody {
        let shape = Shape::Sphere { radius };
        MovingBody::outer(&Outer::centred(shape, material(210e9, 0.3, 7780.0), speed)).unwrap()
    }

    /// Peak, end of contact and velocities of `system` against Hertz's closed form with `mass`, `speed` and `law`, that of the centre of
    /// mass being `drift`.
    fn is_hertz(system: &System, mass: f64, speed: f64, law: Hertz, velocities: [f64; 2]) {
        let exact = HertzImpact { mass, speed, stiffness: law.stiffness };
        let found = integrate(system, None, &Options { tolerance: 1e-9, ..Options::default() }).unwrap();
        let [contact, other] = &found.contacts;
        assert_relative_eq!(contact.force_peak, exact.force_peak(), max_relative = 1e-6);
        assert_relative_eq!(contact.end, exact.duration(), max_relative = 1e-6);
        assert_relative_eq!(contact.impulse, 2.0 * mass * speed, max_relative = 1e-6);
        assert_eq!((contact.contacts, other.contacts, other.force_peak), (1, 0, 0.0));
        for (found, exact) in found.velocity.iter().zip(velocities) {
            assert_relative_eq!(*found, exact, max_relative = 1e-6, epsilon = 1e-12);
        }
        assert!(found.energy_residual < 1e-9 && found.momentum_residual < 1e-9, "{found:?}");
    }

    #[test]
    fn a_sphere_on_a_half_space_or_a_rigid_wall_is_hertz_s_impact() {
        let mass = 4.0 / 3.0 * PI * 0.01_f64.powi(3) * 7780.0;
        for wall in [material(70e9, 0.33, 2700.0), material(f64::INFINITY, 0.0, 1.0)] {
            let compliance = (1.0 - 0.09) / 210e9 + (1.0 - wall.poisson_ratio.powi(2)) / wall.youngs_modulus;
            let law = Hertz { tip_radius: 0.01, stiffness: 4.0 / 3.0 * 0.1 / compliance };
            is_hertz(&System::on_wall(outer(0.01, 0.5), &wall), mass, 0.5, law, [0.5, 0.0]);
        }
    }

    #[test]
    fn two_unequal_spheres_exchange_momentum_by_hertz_s_impact() {
        for (radius, own) in [(0.02, 0.0), (0.003, 0.2), (0.01, -0.45)] {
            let glass = material(64e9, 0.2, 2500.0);
            let inner = Inner { shape: Shape::Sphere { radius }, material: glass, gap: 0.0, speed: own };
            let masses =
                [(0.01_f64, 7780.0), (radius, 2500.0)].map(|(r, rho)| 4.0 / 3.0 * PI * r.powi(3) * rho);
            let (mass, closing) = (masses[0] * masses[1] / (masses[0] + masses[1]), 0.5 + own);
            let radius = 0.01 * radius / (0.01 + radius);
            let compliance = (1.0 - 0.09) / 210e9 + (1.0 - 0.04) / 64e9;
            let law = Hertz { tip_radius: radius, stiffness: 4.0 / 3.0 * radius.sqrt() / compliance };
            let after = [-0.5 + 2.0 * mass * closing / masses[0], own - 2.0 * mass * closing / masses[1]];
            is_hertz(
                &System::of_two_bodies(outer(0.01, 0.5), MovingBody::inner(&inner)),
                mass,
                closing,
                law,
                after,
            );
        }
    }
}
