//! Newton's steps where one contact alone is pressed: those of [`super::State`], of which most is then zero.

use super::Residual;
use crate::contact::Hertz;
use crate::contact::patch_flexibility::{Cubic, Tabulated};

impl Residual {
    /// A Newton step for the patches from `p`, as [`super::State::newton_with_forces`].
    #[inline(always)]
    pub fn newton(
        &self,
        laws: &[Hertz; 2],
        further: [f64; 3],
        y: [f64; 2],
        p: [f64; 2],
    ) -> Option<([f64; 2], [f64; 2])> {
        match (p[0] > 0.0, p[1] > 0.0) {
            (true, false) => self.pressed_alone(0, &laws[0], further, y, p[0]),
            (false, true) => self.pressed_alone(1, &laws[1], further, y, p[1]),
            _ => self.state(laws, p).newton_with_forces(further, y, p),
        }
    }

    /// [`Self::newton`] where contact `i` alone is pressed, with the patch `coordinate` in m.
    #[inline(always)]
    fn pressed_alone(
        &self,
        i: usize,
        law: &Hertz,
        further: [f64; 3],
        y: [f64; 2],
        coordinate: f64,
    ) -> Option<([f64; 2], [f64; 2])> {
        let (largest, scale) = (self.largest[i], self.per_patch[i]);
        let (p, beyond) = (coordinate.min(largest), (coordinate - largest).max(0.0));
        let own = Cubic::at(&self.own[i], scale * p);
        let mutual = Cubic::at(&self.mutual_alone(i), scale * p);
        let root = law.stiffness * p.sqrt();
        // the forces, as the state of two contacts has them
        let (bending, g, g_rate) =
            (5.0 * root * p, 0.5 * scale * own.first, 0.5 * scale * scale * own.second);
        let inverse = 1.0 / (1.0 - bending * g);
        let force = inverse * (root * p + 1.5 * root * beyond);
        let curvature = 1.0 + 5.0 * g * force;
        let [flexibility, between] = [own.value + further[2 * i], mutual.value + further[1]];
        let error = 0.8 * (1.5 * beyond + curvature * p) + 0.2 * p + flexibility * force - y[i];
        // what they change by with the patch; a punch's patch stays as it is
        let (slope, approach, other) = if beyond > 0.0 {
            let slope = inverse * 1.5 * root;
            (slope, (flexibility + 0.8 / root) * slope, between * slope)
        } else {
            let slope = inverse * (bending * g_rate * force + 1.5 * root * curvature);
            let moved = 2.0 * g * force - 0.4 * curvature + 0.2;
            let along = scale * mutual.first * force;
            (slope, (flexibility + 0.8 / root) * slope + moved, between * slope + along)
        };
        if approach.is_nan() || approach <= 0.0 {
            return None;
        }
        let step = error / approach;
        let mut next = ([0.0; 2], [0.0; 2]);
        (next.0[i], next.1[i]) = (coordinate - step, force - slope * step);
        next.0[1 - i] = y[1 - i] - between * force + other * step;
        Some(next)
    }

    /// Coefficients in R_01 of x_i^m, the other contact open.
    #[inline(always)]
    fn mutual_alone(&self, i: usize) -> Tabulated {
        if i == 0 { self.mutual[0].to_array() } else { self.mutual.map(|row| row.as_array()[0]) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{LAWS, varying};
    use approx::assert_relative_eq;

    #[test]
    fn a_contact_pressed_alone_is_the_one_of_two_of_which_the_other_is_open() {
        for (depth, further) in [(4e-5, [0.0; 3]), (4e-5, [2e-9, -1e-9, 3e-9]), (1e-6, [2e-9, 0.0, 3e-9])] {
            let residual = varying(depth);
            for (y, p) in [([8e-6, -1e-6], [7e-6, -1.2e-6]), ([-2e-6, 3e-6], [-1.7e-6, 2e-6])] {
                let (patches, forces) = residual.newton(&LAWS, further, y, p).unwrap();
                let both = residual.state(&LAWS, p).newton_with_forces(further, y, p).unwrap();
                for i in 0..2 {
                    assert_relative_eq!(patches[i], both.0[i], max_relative = 1e-12);
                    assert_relative_eq!(forces[i], both.1[i], max_relative = 1e-12);
                }
            }
        }
    }
}
