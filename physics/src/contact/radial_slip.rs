//! What friction does in a contact of unlike materials that is only pressed.
//!
//! Hertz's pressure moves the surfaces of unlike materials by different distances along the radius. Friction resists that: the contact
//! becomes stiffer (Spence, Proc. R. Soc. A 305 (1968) 55 and J. Elasticity 5 (1975) 297; Johnson, Contact Mechanics, 1985, section 5.4).
//!
//! As springs of the method of dimensionality reduction ([`super::TangentialContact`]): a radial displacement u(r) of surfaces is for
//! the spring at x the displacement (1/x) d/dx of the integral of r^2 u/sqrt(x^2 - r^2) from 0 to x. With it the circle in which nothing
//! slides has the radius a tanh(pi mu/(2 beta)), and without sliding the shear stress over the pressure grows as ln((a + r)/(a - r)).

use crate::material::Material;
use std::f64::consts::PI;

/// Points of the integral over the contact.
const POINTS: usize = 400;

/// Dundurs' second parameter beta of a tip and a face; 0 of like materials, positive of a tip that is compressible more easily.
pub fn dundurs_beta(tip: &Material, face: &Material) -> f64 {
    let of =
        |material: &Material, part: f64| (1.0 - part * material.poisson_ratio) / material.shear_modulus();
    0.5 * (of(tip, 2.0) - of(face, 2.0)) / (of(tip, 1.0) + of(face, 1.0))
}

/// Radial displacement of the tip over the face for the spring at `place` since the two met there, over 1/R, in m^2; both lengths in m.
/// Without friction, by Hertz's pressure over the contact `radius`.
pub fn parted(beta: f64, place: f64, radius: f64) -> f64 {
    // at the edge it vanishes, but not in rounding
    if place >= radius {
        return 0.0;
    }
    let ring = radius * radius - place * place;
    -2.0 * beta / PI * (ring * (place / radius).atanh() + place * (radius - place))
}

/// Force at an approach over that without friction, of a contact with Dundurs' `beta` and the coefficient of `friction`, while it grows.
///
/// Where nothing slides it is the same while the contact shrinks.
pub fn stiffening(beta: f64, friction: f64) -> f64 {
    let beta = beta.abs();
    if beta == 0.0 || friction == 0.0 {
        return 1.0;
    }
    let stick = (0.5 * PI * friction / beta).tanh();
    // deflections over a^2/R: what slides is held by the friction, what sticks moves on from where it stopped
    let held = |place: f64| {
        if place >= stick {
            return friction * (1.0 - place * place);
        }
        let stopped = place / stick;
        let moved = |radius: f64| -parted(beta, place, radius);
        friction * (stopped * stopped - place * place) + moved(1.0) - moved(stopped)
    };
    let work = |k: usize| {
        // closer points at the edge, where the displacement grows fastest
        let share = (k as f64 + 0.5) / POINTS as f64;
        let place = share * (2.0 - share);
        held(place) * place.atanh() * 2.0 * (1.0 - share)
    };
    1.0 + 3.0 * beta / PI * (0..POINTS).map(work).sum::<f64>() / POINTS as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rigid sphere on a face that it sticks to: Mossakovskii's and Spence's exact force over Hertz's, in the form of Borodich and Keer
    /// (Proc. R. Soc. A 460 (2004) 507): (1 - nu) ln(3 - 4 nu)/(1 - 2 nu) times the root of the integral of
    /// 2 t cos(ln(3 - 4 nu) ln((1 - t)/(1 + t))/(2 pi)).
    #[test]
    fn without_sliding_the_force_is_spence_s() {
        let rigid = Material::rigid();
        for nu in [0.0, 0.1, 0.2, 0.3, 0.4] {
            let face = Material::elastic("face", 1e9, nu, 1000.0);
            let beta = dundurs_beta(&rigid, &face);
            assert!((beta + 0.5 * (1.0 - 2.0 * nu) / (1.0 - nu)).abs() < 1e-9);
            let logarithm = (3.0 - 4.0 * nu).ln();
            let integrand = |t: f64| 2.0 * t * (logarithm / (2.0 * PI) * ((1.0 - t) / (1.0 + t)).ln()).cos();
            let count = 100_000;
            let integral =
                (0..count).map(|k| integrand((k as f64 + 0.5) / count as f64)).sum::<f64>() / count as f64;
            let exact = (1.0 - nu) * logarithm / (1.0 - 2.0 * nu) * integral.sqrt();
            let found = stiffening(beta, 1e6);
            // a tenth of what friction does: of the second order in beta
            assert!((found - exact).abs() < 0.1 * (exact - 1.0), "nu = {nu}: {found} {exact}");
        }
        // nothing parts under an incompressible face
        let face = Material::elastic("face", 1e9, 0.5, 1000.0);
        assert!((stiffening(dundurs_beta(&rigid, &face), 1.0) - 1.0).abs() < 1e-12);
    }

    /// It grows with the friction, from none to that of a contact that sticks.
    #[test]
    fn friction_stiffens() {
        let forces: Vec<f64> = [0.0, 0.03, 0.1, 0.3, 1.0, 1e6].map(|mu| stiffening(0.286, mu)).into();
        assert_eq!(forces[0], 1.0);
        assert!(forces.windows(2).all(|pair| pair[0] < pair[1] + 1e-12), "{forces:?}");
    }
}
