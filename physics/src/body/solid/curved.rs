//! Quadratic tetrahedra whose edges may be curved: their geometry, stiffness and consistent mass by quadrature.

use super::elasticity::{Block, Lame};
use super::mesh::EDGES;
use nalgebra::{Matrix3, Vector3};

/// Nodes of an element.
pub(super) const NODES: usize = 10;

/// Places of an element's nodes in m, VTK's order.
pub(super) type Places = [Vector3<f64>; NODES];

/// A point of quadrature: barycentric coordinates, and the weight in an element of volume 1.
type Point = ([f64; 4], f64);

/// Fourteen points, exact to the fifth degree, all weights positive (Walkington, Quadrature on simplices of arbitrary dimension, 2000).
fn rule() -> [Point; 14] {
    let corner = [
        (0.310_885_919_263_300_6, 0.112_687_925_718_015_85),
        (0.092_735_250_310_891_23, 0.073_493_043_116_361_95),
    ];
    let (edge, edge_weight) = (0.045_503_704_125_649_65, 0.042_546_020_777_081_47);
    let mut points = [([0.0; 4], 0.0); 14];
    for (k, (own, weight)) in corner.into_iter().enumerate() {
        for a in 0..4 {
            let mut place = [own; 4];
            place[a] = 1.0 - 3.0 * own;
            points[4 * k + a] = (place, weight);
        }
    }
    for (k, [a, b]) in EDGES.into_iter().enumerate() {
        let mut place = [edge; 4];
        place[a] = 0.5 - edge;
        place[b] = 0.5 - edge;
        points[8 + k] = (place, edge_weight);
    }
    points
}

/// Values of the shape functions at barycentric coordinates.
fn shapes(l: [f64; 4]) -> [f64; NODES] {
    let mut values = [0.0; NODES];
    for a in 0..4 {
        values[a] = l[a] * (2.0 * l[a] - 1.0);
    }
    for (k, [a, b]) in EDGES.into_iter().enumerate() {
        values[4 + k] = 4.0 * l[a] * l[b];
    }
    values
}

/// Their derivatives by the second to fourth barycentric coordinate, the first making up for them.
fn derivatives(l: [f64; 4]) -> [Vector3<f64>; NODES] {
    let unit = |a: usize| match a {
        0 => Vector3::repeat(-1.0),
        a => Vector3::ith(a - 1, 1.0),
    };
    let mut values = [Vector3::zeros(); NODES];
    for a in 0..4 {
        values[a] = (4.0 * l[a] - 1.0) * unit(a);
    }
    for (k, [a, b]) in EDGES.into_iter().enumerate() {
        values[4 + k] = 4.0 * (l[a] * unit(b) + l[b] * unit(a));
    }
    values
}

/// Derivatives of the place by those coordinates, in m.
fn jacobian(places: &Places, derivatives: &[Vector3<f64>; NODES]) -> Matrix3<f64> {
    places.iter().zip(derivatives).map(|(place, derivative)| place * derivative.transpose()).sum()
}

/// Least Jacobian determinant at nodes and points of quadrature over that of the straight element, at most 1; not positive where the
/// element folds.
pub(super) fn least_jacobian(places: &Places) -> f64 {
    let all = at_nodes().into_iter().chain(rule().map(|(place, _)| place));
    let [a, b, c] = [1, 2, 3].map(|k| places[k] - places[0]);
    let straight = a.dot(&b.cross(&c));
    all.map(|l| jacobian(places, &derivatives(l)).determinant() / straight).fold(1.0, f64::min)
}

/// Volume in m^3.
pub(super) fn volume(places: &Places) -> f64 {
    points(places).map(|(_, _, weight)| weight).sum()
}

/// Values and gradients (1/m) of the shape functions, and the weight in m^3, at each point of quadrature.
fn points(places: &Places) -> impl Iterator<Item = ([f64; NODES], [Vector3<f64>; NODES], f64)> {
    rule().into_iter().map(|(l, weight)| {
        let derivatives = derivatives(l);
        let jacobian = jacobian(places, &derivatives);
        let inverse = jacobian.try_inverse().unwrap_or_else(Matrix3::zeros).transpose();
        (shapes(l), derivatives.map(|d| inverse * d), weight * jacobian.determinant() / 6.0)
    })
}

/// Gradients of the displacement at the nodes, of an element whose nodes are displaced by `moved` m. Shape (10).
pub(super) fn gradients_at_nodes(places: &Places, moved: &Places) -> [Matrix3<f64>; NODES] {
    at_nodes().map(|l| {
        let derivatives = derivatives(l);
        let inverse = jacobian(places, &derivatives).try_inverse().unwrap_or_else(Matrix3::zeros);
        jacobian(moved, &derivatives) * inverse
    })
}

/// Barycentric coordinates of the nodes.
fn at_nodes() -> [[f64; 4]; NODES] {
    std::array::from_fn(|k| match k {
        0..4 => std::array::from_fn(|b| f64::from(u8::from(k == b))),
        _ => std::array::from_fn(|c| if EDGES[k - 4].contains(&c) { 0.5 } else { 0.0 }),
    })
}

/// Blocks of the stiffness between the nodes in N/m, row by row. Shape (10 * 10).
pub(super) fn stiffness(places: &Places, lame: Lame) -> Vec<Block> {
    let mut blocks = vec![[0.0; 9]; NODES * NODES];
    for (_, gradients, weight) in points(places) {
        lame.add(&mut blocks, &gradients, weight);
    }
    blocks
}

/// Consistent mass between the nodes for a density of 1 kg/m^3, row by row. Shape (10 * 10).
pub(super) fn mass(places: &Places) -> [f64; NODES * NODES] {
    let mut mass = [0.0; NODES * NODES];
    for (shapes, _, weight) in points(places) {
        for (a, own) in shapes.iter().enumerate() {
            for (b, other) in shapes.iter().enumerate() {
                mass[NODES * a + b] += weight * own * other;
            }
        }
    }
    mass
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn straight(corners: [Vector3<f64>; 4]) -> Places {
        std::array::from_fn(|k| match k {
            0..4 => corners[k],
            _ => {
                let [a, b] = EDGES[k - 4];
                0.5 * (corners[a] + corners[b])
            }
        })
    }

    /// Integrals of products of barycentric coordinates are factorials: 3! 2!^2/(4 + 3)! of the volume for l_0^2 l_1^2.
    #[test]
    fn the_rule_is_exact_to_the_fifth_degree() {
        let integral = |powers: [i32; 4]| -> f64 {
            rule().iter().map(|(l, w)| w * (0..4).map(|a| l[a].powi(powers[a])).product::<f64>()).sum()
        };
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for powers in [[0, 0, 0, 0], [1, 0, 0, 0], [2, 2, 0, 0], [1, 1, 1, 1], [5, 0, 0, 0], [3, 1, 0, 1]] {
            let all: i32 = powers.iter().sum();
            let expected = 6.0 * powers.map(factorial).iter().product::<f64>() / factorial(all + 3);
            assert_relative_eq!(integral(powers), expected, max_relative = 1e-13);
        }
    }

    /// An element that is bent by a quadratic map has the volume that the map gives it, and folds where the map does.
    #[test]
    fn a_bent_element_has_the_volume_of_its_map() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector3::from);
        let bent = |c: f64| straight(corners).map(|p| Vector3::new(p.x + c * p.x * p.x, p.y, p.z));
        // det = 1 + 2 c x, whose mean over the element is 1 + c/2
        assert_relative_eq!(volume(&bent(0.4)), (1.0 + 0.2) / 6.0, max_relative = 1e-13);
        assert_relative_eq!(mass(&bent(0.4)).iter().sum::<f64>(), 1.2 / 6.0, max_relative = 1e-13);
        // of the straight element between the bent one's corners the determinant is 1 + c
        assert_relative_eq!(least_jacobian(&bent(-0.4)), 0.2 / 0.6, max_relative = 1e-12);
        assert!(least_jacobian(&bent(-0.6)) < 0.0);
        assert_relative_eq!(least_jacobian(&straight(corners)), 1.0, max_relative = 1e-12);
    }
}
