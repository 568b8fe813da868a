//! Flexibility at two contacts as a function of the radii of their patches.
//!
//! What a body yields beyond Hertz's half-spaces is smooth in the squares of the patch radii (Hertz's pressure has a
//! Hankel transform that is even in the radius), for a layer up to patches of about its thickness and, on the real
//! axis, far beyond. It is tabulated at some radii and interpolated by polynomials in the squares.

use serde::{Deserialize, Serialize};
use wide::f64x4;

/// Radii of the table.
pub const TABULATED: usize = 4;
/// Their values in patch radii: from the early contact to more than a first look at the impact expects.
pub const RADII: [f64; TABULATED] = [0.35, 1.0, 1.35, 1.6];
/// Index of the patch radius itself.
pub const WHOLE: usize = 1;

/// Values of one quantity at the tabulated radii.
pub type Tabulated = [f64; TABULATED];

/// Flexibility in m/N beyond the half-spaces, between patches of [`RADII`] times the patch radii of both contacts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct PatchTable {
    /// Of each contact by its own force. Shape (2, radii).
    pub own: [Tabulated; 2],
    /// Between contacts 0 and 1. Shape (radii of contact 0, radii of contact 1).
    pub mutual: [Tabulated; TABULATED],
}

impl PatchTable {
    /// Adds to all values what makes those at the patch radii `flexibility` (0,0), (0,1), (1,1) in m/N.
    pub fn shift_to(&mut self, [own0, mutual, own1]: [f64; 3]) {
        for (row, value) in self.own.iter_mut().zip([own0, own1]) {
            let shift = value - row[WHOLE];
            row.iter_mut().for_each(|value| *value += shift);
        }
        let shift = mutual - self.mutual[WHOLE][WHOLE];
        self.mutual.iter_mut().flatten().for_each(|value| *value += shift);
    }

    /// Adds the products of the displacements `at` of both contacts, times `own` for a contact with itself, times `mutual`
    /// between the two.
    pub fn add(&mut self, own: f64, mutual: f64, at: [Tabulated; 2]) {
        for m in 0..TABULATED {
            for i in 0..2 {
                self.own[i][m] += own * at[i][m] * at[i][m];
            }
            for n in 0..TABULATED {
                self.mutual[m][n] += mutual * at[0][m] * at[1][n];
            }
        }
    }
}

/// Flexibility in m/N as polynomials in x_i = (patch radius of contact i)^2 times `per_square[i]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PatchFlexibility {
    /// x_i over the square of the patch radius of contact i, 1/m^2.
    pub per_square: [f64; 2],
    /// Coefficients of x_i^m in the flexibility of contact i by its own force.
    pub own: [Tabulated; 2],
    /// `mutual[n][m]`: coefficient of x_0^m x_1^n in the flexibility between the contacts.
    pub mutual: [Tabulated; TABULATED],
}

impl PatchFlexibility {
    /// The same whatever the patches, m/N; symmetric.
    pub fn constant(flexibility: [[f64; 2]; 2]) -> Self {
        let [[own0, mutual], [_, own1]] = flexibility;
        let alone = |value| [value, 0.0, 0.0, 0.0];
        Self {
            per_square: [0.0; 2],
            own: [alone(own0), alone(own1)],
            mutual: [alone(mutual), [0.0; TABULATED], [0.0; TABULATED], [0.0; TABULATED]],
        }
    }

    /// Through the values of `table` for patches of the radii `patch` in m.
    pub fn through(table: &PatchTable, patch: [f64; 2]) -> Self {
        let polynomials = polynomials();
        let combine = |values: &Tabulated| -> Tabulated {
            std::array::from_fn(|m| (0..TABULATED).map(|j| values[j] * polynomials[j][m]).sum())
        };
        // by x_0 for each radius of contact 1, then by x_1
        let by_first: [Tabulated; TABULATED] =
            std::array::from_fn(|n| combine(&std::array::from_fn(|m| table.mutual[m][n])));
        let by_both: [Tabulated; TABULATED] =
            std::array::from_fn(|m| combine(&std::array::from_fn(|n| by_first[n][m])));
        Self {
            per_square: patch.map(|a| a.powi(-2)),
            own: table.own.map(|values| combine(&values)),
            mutual: std::array::from_fn(|n| std::array::from_fn(|m| by_both[m][n])),
        }
    }

    /// Flexibilities in m/N (0,0), (0,1) = (1,0), (1,1) for patches whose radii have the squares `square` in m^2.
    pub fn at(&self, square: [f64; 2]) -> [f64; 3] {
        let x = [0, 1].map(|i| square[i] * self.per_square[i]);
        let mutual = Bicubic::at(&self.mutual.map(f64x4::from), x);
        [Cubic::at(&self.own[0], x[0]).value, mutual.value, Cubic::at(&self.own[1], x[1]).value]
    }
}

/// A polynomial's value and derivatives.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cubic {
    pub value: f64,
    pub first: f64,
    pub second: f64,
}

impl Cubic {
    #[inline(always)]
    pub fn at([c0, c1, c2, c3]: &Tabulated, x: f64) -> Self {
        Self {
            value: c0 + x * (c1 + x * (c2 + x * c3)),
            first: c1 + x * (2.0 * c2 + x * (3.0 * c3)),
            second: 2.0 * c2 + x * (6.0 * c3),
        }
    }
}

/// The value and the derivatives of a polynomial of two variables.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bicubic {
    pub value: f64,
    /// By each variable.
    pub first: [f64; 2],
    /// By the first twice, by both, by the second twice.
    pub second: [f64; 3],
}

impl Bicubic {
    /// `coefficients[n]`: those of x_0^m x_1^n for all m.
    #[inline(always)]
    pub fn at([c0, c1, c2, c3]: &[f64x4; TABULATED], [x, y]: [f64; 2]) -> Self {
        let value = *c0 + (*c1 + (*c2 + *c3 * y) * y) * y;
        let first = *c1 + (*c2 * 2.0 + *c3 * (3.0 * y)) * y;
        let second = *c2 * 2.0 + *c3 * (6.0 * y);
        let powers = f64x4::from([1.0, x, x * x, x * x * x]);
        let slopes = f64x4::from([0.0, 1.0, 2.0 * x, 3.0 * x * x]);
        let curvatures = f64x4::from([0.0, 0.0, 2.0, 6.0 * x]);
        let dot = |a: f64x4, b: f64x4| (a * b).reduce_add();
        Self {
            value: dot(powers, value),
            first: [dot(slopes, value), dot(powers, first)],
            second: [dot(curvatures, value), dot(slopes, first), dot(powers, second)],
        }
    }
}

/// `[j][m]`: coefficient of x^m in the polynomial that is 1 at the square of radius j and 0 at those of the others.
fn polynomials() -> [Tabulated; TABULATED] {
    let nodes = RADII.map(|r| r * r);
    std::array::from_fn(|j| {
        let mut polynomial = [1.0, 0.0, 0.0, 0.0];
        for (degree, other) in nodes.iter().enumerate().filter(|(k, _)| *k != j).map(|(_, n)| n).enumerate() {
            let scale = 1.0 / (nodes[j] - other);
            for m in (0..=degree + 1).rev() {
                let below = if m > 0 { polynomial[m - 1] } else { 0.0 };
                let here = if m <= degree { polynomial[m] } else { 0.0 };
                polynomial[m] = scale * (below - other * here);
            }
        }
        polynomial
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Polynomials of the degree of the table come back, with their derivatives.
    #[test]
    fn a_cubic_in_the_squares_is_met_everywhere() {
        let patch = [2e-3, 0.5e-3];
        let own = |i: usize, x: f64| 1.0 + (2.0 + i as f64) * x - 0.3 * x * x + 0.05 * x * x * x;
        let mutual = |x: f64, y: f64| 0.5 - 0.2 * x + 0.1 * y + 0.07 * x * y * y - 0.01 * x.powi(3) * y;
        let square = |m: usize| RADII[m] * RADII[m];
        let table = PatchTable {
            own: [0, 1].map(|i| std::array::from_fn(|m| own(i, square(m)))),
            mutual: std::array::from_fn(|m| std::array::from_fn(|n| mutual(square(m), square(n)))),
        };
        let flexibility = PatchFlexibility::through(&table, patch);
        for [x, y] in [[0.0, 0.0], [0.3, 2.0], [1.0, 1.0], [2.2, 0.1]] {
            let found = flexibility.at([x * patch[0] * patch[0], y * patch[1] * patch[1]]);
            for (found, expected) in found.into_iter().zip([own(0, x), mutual(x, y), own(1, y)]) {
                assert_relative_eq!(found, expected, max_relative = 1e-12);
            }
            let surface = |x: f64, y: f64| Bicubic::at(&flexibility.mutual.map(f64x4::from), [x, y]);
            let (s, h) = (surface(x, y), 1e-5);
            let (east, north) = (surface(x + h, y), surface(x, y + h));
            let (west, south) = (surface(x - h, y), surface(x, y - h));
            assert_relative_eq!((east.value - west.value) / (2.0 * h), s.first[0], epsilon = 1e-8);
            assert_relative_eq!((north.value - south.value) / (2.0 * h), s.first[1], epsilon = 1e-8);
            assert_relative_eq!((east.first[0] - west.first[0]) / (2.0 * h), s.second[0], epsilon = 1e-8);
            assert_relative_eq!((north.first[0] - south.first[0]) / (2.0 * h), s.second[1], epsilon = 1e-8);
            assert_relative_eq!((north.first[1] - south.first[1]) / (2.0 * h), s.second[2], epsilon = 1e-8);
        }
    }
}
