//! Sums of columns times numbers, vectorised for the processor that runs them.

use nalgebra::Vector3;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// Displacements under unit forces along x, y and z at some node: shape (3 of the force, 3 of the displacement, width).
/// In single precision: rounding them moves a contact by far less than its gap may be.
type Column<'a> = &'a [f32];

/// u = sum_j R_j f_j on a part of the nodes.
struct Deform<'a, C> {
    /// Shape (3, width).
    u: &'a mut [f64],
    part: Range<usize>,
    column: C,
    push: &'a [(usize, Vector3<f64>)],
}

/// Displacements `u` (shape (3, width)) of the nodes in `part` under the forces `push` on nodes whose columns `column` gives.
pub(super) fn deform_under<'c>(
    u: &mut [f64],
    part: Range<usize>,
    column: impl Fn(usize) -> Column<'c>,
    push: &[(usize, Vector3<f64>)],
) {
    Arch::new().dispatch(Deform { u, part, column, push });
}

impl<'c, C: Fn(usize) -> Column<'c>> WithSimd for Deform<'_, C> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { u, part, column, push } = self;
        let width = u.len() / 3;
        let parts = |column: Column<'c>, c: usize| -> [Column<'c>; 3] {
            std::array::from_fn(|d| &column[(3 * d + c) * width..][part.clone()])
        };
        for c in 0..3 {
            u[c * width..][part.clone()].fill(0.0);
        }
        // two at a time: half as many reads and writes of u
        let pairs = push.chunks_exact(2);
        for (j, force) in pairs.remainder() {
            let column = column(*j);
            for c in 0..3 {
                add(&mut u[c * width..][part.clone()], parts(column, c), force);
            }
        }
        for pair in pairs {
            let columns = [column(pair[0].0), column(pair[1].0)];
            for c in 0..3 {
                let (x, y) = (parts(columns[0], c), parts(columns[1], c));
                add_two(&mut u[c * width..][part.clone()], x, &pair[0].1, y, &pair[1].1);
            }
        }
    }
}

#[inline(always)]
fn add(u: &mut [f64], [x, y, z]: [&[f32]; 3], f: &Vector3<f64>) {
    let n = u.len();
    let (x, y, z) = (&x[..n], &y[..n], &z[..n]);
    for k in 0..n {
        u[k] += f[0] * f64::from(x[k]) + f[1] * f64::from(y[k]) + f[2] * f64::from(z[k]);
    }
}

#[inline(always)]
fn add_two(
    u: &mut [f64],
    [p, q, r]: [&[f32]; 3],
    f: &Vector3<f64>,
    [x, y, z]: [&[f32]; 3],
    g: &Vector3<f64>,
) {
    let n = u.len();
    let (p, q, r, x, y, z) = (&p[..n], &q[..n], &r[..n], &x[..n], &y[..n], &z[..n]);
    for k in 0..n {
        u[k] += (f[0] * f64::from(p[k]) + f[1] * f64::from(q[k]) + f[2] * f64::from(r[k]))
            + (g[0] * f64::from(x[k]) + g[1] * f64::from(y[k]) + g[2] * f64::from(z[k]));
    }
}

/// u += sum_k q_k phi_k
struct AddedModes<'a> {
    u: &'a mut [f64],
    shapes: &'a [f64],
    q: &'a [f64],
}

/// Adds to `u` the `shapes` (shape (N, length of u)) times the coordinates `q`.
pub(super) fn add_modes(u: &mut [f64], shapes: &[f64], q: &[f64]) {
    Arch::new().dispatch(AddedModes { u, shapes, q });
}

impl WithSimd for AddedModes<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let n = self.u.len();
        for (k, q) in self.q.iter().enumerate() {
            let shape = &self.shapes[k * n..][..n];
            for i in 0..n {
                self.u[i] += q * shape[i];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_the_definition_on_the_part_and_leave_the_rest() {
        let mut random = fastrand::Rng::with_seed(2);
        for (width, count) in [(1, 1), (7, 2), (33, 5)] {
            let columns: Vec<f32> = (0..count * 9 * width).map(|_| random.f32() - 0.5).collect();
            let column = |j: usize| &columns[j * 9 * width..][..9 * width];
            let push: Vec<_> = (0..count).map(|j| (j, Vector3::from_fn(|_, _| random.f64() - 0.5))).collect();
            let part = width / 3..width;
            let mut u = vec![7.0; 3 * width];
            deform_under(&mut u, part.clone(), column, &push);
            for (c, k) in (0..3).flat_map(|c| (0..width).map(move |k| (c, k))) {
                let entry = |j: usize, d: usize| f64::from(column(j)[(3 * d + c) * width + k]);
                let sum: f64 =
                    push.iter().map(|(j, f)| (0..3).map(|d| entry(*j, d) * f[d]).sum::<f64>()).sum();
                let expected = if part.contains(&k) { sum } else { 7.0 };
                assert!((u[c * width + k] - expected).abs() < 1e-14, "{width} {count} {c} {k}");
            }
            let (shapes, q) = ([u.clone(), u.clone()].concat(), [0.5, -2.0]);
            let before = u.clone();
            add_modes(&mut u, &shapes, &q);
            assert!(u.iter().zip(&before).all(|(u, b)| (u + 0.5 * b).abs() < 1e-13));
        }
    }
}
