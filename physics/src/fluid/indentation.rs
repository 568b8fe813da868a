//! What the contact of the tip does to the gap of the film around it.
//!
//! Under Hertz's pressure the surfaces follow the tip: the gap begins with zero at the edge of the patch and opens with the power
//! 3/2 of the distance from it, and where it is narrow it hardly changes while the bodies approach (Johnson, Contact mechanics, eq.
//! 3.42a). By reciprocity the pressure of the film relieves the contact by the part of it that acts where the surfaces sink with the patch:
//! motion and force have the same factor (Betti's theorem), so that the film takes from the bodies exactly what it dissipates.

use super::film::Ring;
use std::f64::consts::PI;

/// Contact of the tip with the plate, as the film around it sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indentation {
    /// Squared radius of the patch over the tip radius, m; of an open contact the distance on the axis, negative.
    patch: f64,
    /// Change of `patch` per approach of the bodies: 1 but for what they yield beyond half-spaces.
    per_approach: f64,
    /// Radius of the tip, m.
    tip_radius: f64,
    /// Squared radius of the patch, m^2.
    square: f64,
}

impl Indentation {
    /// Of a tip with the radius `tip_radius` in m: the squared radius of the patch over it, `patch` in m, negative as the distance on the
    /// axis where the contact is open, changes by `per_approach` with the approach of the bodies.
    pub fn new(patch: f64, per_approach: f64, tip_radius: f64) -> Self {
        Self { patch, per_approach, tip_radius, square: tip_radius * patch.max(0.0) }
    }

    /// Squared radius of the patch, m^2; 0 of an open contact.
    pub fn square(&self) -> f64 {
        self.square
    }

    /// Gap in m at the radius `r` in m, at least that of the patch, between a flat plate and the tip, less r^2/(2 R).
    pub fn gap(&self, r: f64) -> f64 {
        if self.square <= 0.0 {
            return -self.patch;
        }
        let (a, beyond) = (self.square.sqrt(), (r * r - self.square).max(0.0).sqrt());
        let sunk = (2.0 * self.square - r * r) * (a / r).min(1.0).asin() + a * beyond;
        sunk / (PI * self.tip_radius) - self.patch
    }

    /// Mean closing speed of the gap in `ring` per closing speed of the bodies: at the radius r 2/pi acos(a/r), with the radius a of the
    /// patch.
    pub fn closing(&self, ring: Ring) -> f64 {
        if self.square <= 0.0 {
            return 1.0;
        }
        // r^2 acos(a/r) - a (r^2 - a^2)^(1/2) is the integral of 2 r acos(a/r)
        let squeezed = ring.squares.map(|square| {
            let beyond = (square - self.square).max(0.0);
            square * (self.square / square).min(1.0).sqrt().acos() - (self.square * beyond).sqrt()
        });
        self.per_approach * 2.0 * (squeezed[1] - squeezed[0]) / ring.area()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const RADIUS: f64 = 5e-3;

    fn pressed(patch: f64) -> Indentation {
        Indentation::new(patch, 1.0, RADIUS)
    }

    /// The gap outside Hertz's patch that opens with the power 3/2, and far away the undeformed one.
    #[test]
    fn the_gap_is_hertzs() {
        let indentation = pressed(2e-6);
        let a = indentation.square().sqrt();
        let gap = |r: f64| indentation.gap(r) + 0.5 * r * r / RADIUS;
        assert!(gap(a).abs() < 1e-18);
        let near: f64 = 1e-4;
        let opening = 8.0 * 2.0_f64.sqrt() / (3.0 * PI) * near.powf(1.5) * a * a / RADIUS;
        assert_relative_eq!(gap(a * (1.0 + near)), opening, max_relative = 1e-3);
        let far = 1e3 * a;
        let rigid = 0.5 * far * far / RADIUS - 2e-6;
        assert_relative_eq!(gap(far), rigid, max_relative = 1e-6);
    }

    /// The closing speed is the derivative of the gap; and both go on where the contact opens.
    #[test]
    fn the_gap_closes_as_it_says() {
        let step = 1e-12;
        for (patch, r) in [(2e-6, 1.01e-4), (2e-6, 2e-4), (2e-6, 3e-3), (-1e-6, 1e-3)] {
            let change = (pressed(patch + step).gap(r) - pressed(patch - step).gap(r)) / (2.0 * step);
            let ring = Ring { squares: [r * r * (1.0 - 1e-4), r * r * (1.0 + 1e-4)] };
            assert_relative_eq!(pressed(patch).closing(ring), -change, max_relative = 1e-4);
        }
        let (open, closed, ring) = (pressed(-1e-15), pressed(1e-15), Ring { squares: [1e-8, 2e-8] });
        assert!((open.gap(1e-4) - closed.gap(1e-4)).abs() < 1e-14);
        assert_relative_eq!(closed.closing(ring), open.closing(ring), epsilon = 1e-4);
    }
}
