//! From the circles that a mesh resolves to the contact patch itself, which is usually far smaller.
//!
//! What a body yields beyond a half-space is smooth in the square of the circle's radius b: what lies around is not seen by a small circle.
//! The mesh adds an error of its own, always too stiff, that falls as b^(-3.65) (measured on meshes of plates). A fit to three circles
//! separates the two.

use super::struck::{MIDDLE, StruckSolid};
use crate::body::ModalBody;
use crate::body::continuum::{half_space_flexibility, half_space_flexibility_along};
use crate::contact::PatchFlexibility;
use crate::numerics::vectors::{axpy, dot};
use crate::scene::Material;
use nalgebra::{Matrix3, Vector3};

/// Power of the circle's radius with which the mesh's error falls.
const MESH_POWER: f64 = -3.65;
/// Length of what is left of a vector, over its own, below which it depends on others.
const DEPENDENT: f64 = 1e-8;

/// A value at the circle of radius 0, and its slope by the square of the radius.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SquareLaw {
    value: f64,
    slope: f64,
}

/// The part of `vector` that is perpendicular to the `others` (Gram and Schmidt).
fn perpendicular(vector: &[f64], others: [&[f64]; 3]) -> Vec<f64> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let without = |vector: &[f64], basis: &[Vec<f64>]| {
        let mut rest = vector.to_vec();
        // twice is enough (Parlett, 6.9)
        for unit in basis.iter().chain(basis) {
            axpy(-dot(&rest, unit), unit, &mut rest);
        }
        rest
    };
    for other in others {
        let rest = without(other, &basis);
        let length = dot(&rest, &rest).sqrt();
        // one that depends on those before adds nothing
        if length > DEPENDENT * dot(other, other).sqrt() {
            basis.push(rest.iter().map(|value| value / length).collect());
        }
    }
    without(vector, &basis)
}

impl SquareLaw {
    /// Through `values` at the circles `radii`, without the error of the mesh.
    fn without_mesh(values: [f64; 3], radii: [f64; 3]) -> Self {
        // in units of the middle circle, so that the columns are of one size
        let x = radii.map(|radius| radius / radii[1]);
        let matrix = Matrix3::from_fn(|m, n| match n {
            0 => 1.0,
            1 => x[m] * x[m],
            _ => x[m].powf(MESH_POWER),
        });
        let found =
            matrix.lu().solve(&Vector3::from(values)).unwrap_or_else(|| Vector3::new(values[1], 0.0, 0.0));
        Self { value: found[0], slope: found[1] / (radii[1] * radii[1]) }
    }

    /// Nearest to `values` at the circles `radii`.
    fn near(values: [f64; 3], radii: [f64; 3]) -> Self {
        let x = radii.map(|radius| radius * radius);
        let mean = |values: [f64; 3]| values.iter().sum::<f64>() / 3.0;
        let (x0, y0) = (mean(x), mean(values));
        let [above, below] = [0, 1].map(|k| {
            (0..3).map(|m| (x[m] - x0) * if k == 0 { values[m] - y0 } else { x[m] - x0 }).sum::<f64>()
        });
        let slope = if below > 0.0 { above / below } else { 0.0 };
        Self { value: y0 - slope * x0, slope }
    }

    fn at(self, radius: f64) -> f64 {
        self.value + self.slope * radius * radius
    }
}

impl StruckSolid {
    /// [`Self::along`] of a body [`Self::of_material`] with these `faces` at the contacts, without what half-spaces give way near the contacts:
    /// that is part of the contacts' own stiffness. The highest modes have it; what forces elsewhere or across the surface do statically
    /// along it stays.
    pub fn along_beyond_half_spaces(&self, faces: [&Material; 2]) -> Vec<[f64; 2]> {
        let mut found = self.along.clone();
        let count = found.len();
        // static displacements: their products are flexibilities
        let of_modes = |value: &dyn Fn(usize) -> f64| (0..count).map(|k| value(k) / self.omega[k]).collect();
        let along: [Vec<f64>; 2] = [0, 1].map(|i| of_modes(&|k| self.along[k][i]));
        let normal: [Vec<f64>; 2] = [0, 1].map(|i| of_modes(&|k| self.participation[k][i][MIDDLE]));
        for i in (0..2).filter(|i| self.circles[*i][0] > 0.0) {
            let local = half_space_flexibility_along(faces[i], self.circles[i][MIDDLE]);
            let others = [&normal[0], &normal[1], &along[1 - i]];
            let own_part =
                |lowest: usize| perpendicular(&along[i][lowest..], others.map(|other| &other[lowest..]));
            let size = |part: &[f64]| dot(part, part);
            let lowest = (0..count).rev().find(|lowest| size(&own_part(*lowest)) >= local).unwrap_or(0);
            let part = own_part(lowest);
            let taken = 1.0 - (1.0 - local / size(&part)).max(0.0).sqrt();
            for (k, part) in (lowest..).zip(part) {
                found[k][i] -= self.omega[k] * taken * part;
            }
        }
        found
    }

    /// The body whose first material is `material`, and that of its `faces` at the contacts, as contacts of the radii `patch` in m see it; the
    /// second belongs to an inner body, along whose contact z points into the body. Each mode has this `damping_ratio`.
    ///
    /// Modes move the contacts as under these patches; the static flexibility follows the patch.
    pub fn modal_body(
        &self,
        material: &Material,
        faces: [&Material; 2],
        patch: [f64; 2],
        damping_ratio: f64,
    ) -> ModalBody {
        let body = self.of_material(material);
        let is_struck = self.circles.map(|circles| circles[0] > 0.0);
        let sides = [1.0, -1.0];
        let at_patch = |values: &[[f64; 3]; 2]| {
            [0, 1].map(|k| match is_struck[k] {
                true => sides[k] * SquareLaw::near(values[k], self.circles[k]).at(patch[k]),
                false => 0.0,
            })
        };
        let rigid = body.rigid.iter().map(|motion| [sides[0] * motion[0], sides[1] * motion[1]]);
        let participation: Vec<[f64; 2]> = rigid.chain(body.participation.iter().map(at_patch)).collect();
        let omega: Vec<f64> =
            std::iter::repeat_n(0.0, body.rigid.len()).chain(body.omega.iter().copied()).collect();
        let of_modes = |i: usize, j: usize| -> f64 {
            let elastic = omega.iter().zip(&participation).filter(|(omega, _)| **omega > 0.0);
            elastic.map(|(omega, phi)| phi[i] * phi[j] / (omega * omega)).sum()
        };
        let mut flexibility = PatchFlexibility::constant([[0.0; 2]; 2]);
        flexibility.per_square = patch.map(|radius| radius.powi(-2));
        for k in (0..2).filter(|k| is_struck[*k]) {
            let beyond = std::array::from_fn(|m| {
                body.own[k][m] - half_space_flexibility(faces[k], self.circles[k][m])
            });
            let line = SquareLaw::without_mesh(beyond, self.circles[k]);
            flexibility.own[k][0] = line.value - of_modes(k, k);
            flexibility.own[k][1] = line.slope * patch[k] * patch[k];
        }
        if is_struck == [true; 2] {
            // the same circle of the one against all of the other, and the other way round
            let first = SquareLaw::near(std::array::from_fn(|m| mean(body.mutual[m])), self.circles[0]);
            let second = SquareLaw::near(
                std::array::from_fn(|n| mean(body.mutual.map(|row| row[n]))),
                self.circles[1],
            );
            let middle = mean(body.mutual.map(mean));
            let value = first.value + second.value - middle;
            flexibility.mutual[0][0] = -value - of_modes(0, 1);
            flexibility.mutual[0][1] = -first.slope * patch[0] * patch[0];
            flexibility.mutual[1][0] = -second.slope * patch[1] * patch[1];
        }
        ModalBody {
            damping_ratio: omega.iter().map(|omega| if *omega > 0.0 { damping_ratio } else { 0.0 }).collect(),
            omega,
            participation,
            residual: Some(flexibility),
        }
    }
}

fn mean(values: [f64; 3]) -> f64 {
    values.iter().sum::<f64>() / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// The fit takes away an error of the mesh of any size, and a line comes back.
    #[test]
    fn the_mesh_s_own_error_is_taken_away() {
        let radii = [1.41e-4, 2e-4, 2.83e-4];
        let body = |b: f64| 3e-9 - 0.02 * b * b;
        let values = radii.map(|b| body(b) - 4e-11 * (b / 2e-4).powf(MESH_POWER));
        let line = SquareLaw::without_mesh(values, radii);
        assert_relative_eq!(line.at(5e-5), body(5e-5), max_relative = 1e-11);
        assert_relative_eq!(
            SquareLaw::near(radii.map(body), radii).at(5e-5),
            body(5e-5),
            max_relative = 1e-11
        );
    }
}
