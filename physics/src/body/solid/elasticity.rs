//! Linear elasticity of straight tetrahedra: stiffness and lumped mass of a body without supports.

use super::curved;
use super::materials::CellMaterials;
use super::mesh::{EDGES, TetMesh, volume};
use crate::scene::Material;
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

/// Number of a displacement component that is held at zero.
pub(super) const FIXED: usize = usize::MAX;

/// Elements integrated before they are added.
const AT_A_TIME: usize = 4096;

/// 3 x 3 block, row by row.
pub(super) type Block = [f64; 9];

/// Stiffness by pairs of coupled nodes, in compressed rows, and the nodes' masses.
#[derive(Debug, Clone)]
pub(super) struct SolidMatrices {
    /// Range of each node's row. Shape (nodes + 1).
    start: Vec<usize>,
    /// Coupled node, ascending in each row.
    column: Vec<usize>,
    /// Force on the row's node per displacement of the column's, N/m.
    stiffness: Vec<Block>,
    /// Mass of each node in kg. Shape (nodes).
    pub mass: Vec<f64>,
}

impl SolidMatrices {
    /// Integrates all elements of `mesh`.
    pub fn new(mesh: &TetMesh, materials: &CellMaterials) -> Self {
        let (start, column) = sparsity(mesh);
        let mut stiffness = vec![[0.0; 9]; column.len()];
        // a share of the elements at a time: those of a large mesh would take more memory than the matrix
        for (share, cells) in mesh.cells.chunks(AT_A_TIME * mesh.nodes_per_cell()).enumerate() {
            let cells = cells.par_chunks(mesh.nodes_per_cell()).enumerate();
            let lame = |k: usize| Lame::of(materials.of(share * AT_A_TIME + k));
            let elements: Vec<(&[usize], Vec<Block>)> =
                cells.map(|(k, cell)| (cell, element_stiffness(mesh, cell, lame(k)))).collect();
            for (cell, element) in elements {
                for (row, blocks) in cell.iter().zip(element.chunks_exact(cell.len())) {
                    let columns = &column[start[*row]..start[row + 1]];
                    for (node, block) in cell.iter().zip(blocks) {
                        let entry = start[*row] + columns.partition_point(|c| c < node);
                        stiffness[entry].iter_mut().zip(block).for_each(|(sum, part)| *sum += part);
                    }
                }
            }
        }
        Self { start, column, stiffness, mass: lumped_mass(mesh, materials) }
    }

    /// Consistent mass in kg of the quadratic elements of `mesh`, between the nodes that are coupled, in the order of the rows: the same for
    /// all three displacements.
    pub fn consistent_mass(&self, mesh: &TetMesh, materials: &CellMaterials) -> Vec<f64> {
        let mut mass = vec![0.0; self.column.len()];
        for (share, cells) in mesh.cells.chunks(AT_A_TIME * curved::NODES).enumerate() {
            let cells = cells.par_chunks(curved::NODES);
            let elements: Vec<_> = cells.map(|cell| (cell, curved::mass(&mesh.places(cell)))).collect();
            for (k, (cell, element)) in elements.into_iter().enumerate() {
                let density = materials.of(share * AT_A_TIME + k).density;
                for (row, values) in cell.iter().zip(element.chunks_exact(cell.len())) {
                    let columns = &self.column[self.start[*row]..self.start[row + 1]];
                    for (node, value) in cell.iter().zip(values) {
                        mass[self.start[*row] + columns.partition_point(|c| c < node)] += density * value;
                    }
                }
            }
        }
        mass
    }

    /// The matrix of such masses times the displacements `x`, whose free ones have the numbers `dof`.
    pub fn mass_times(&self, mass: &[f64], dof: &[[usize; 3]], x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; x.len()];
        for (node, own) in dof.iter().enumerate() {
            for entry in self.start[node]..self.start[node + 1] {
                for (row, column) in own.iter().zip(&dof[self.column[entry]]) {
                    if *row != FIXED && *column != FIXED {
                        product[*row] += mass[entry] * x[*column];
                    }
                }
            }
        }
        product
    }

    /// Largest diagonal element of the stiffness, N/m.
    pub fn stiffest(&self) -> f64 {
        self.stiffness.iter().flat_map(|block| [block[0], block[4], block[8]]).fold(0.0, f64::max)
    }

    /// Ties `node` to the ground by springs of the symmetric stiffness `spring`, N/m.
    pub fn stiffen(&mut self, node: usize, spring: Matrix3<f64>) {
        let own = self.start[node]..self.start[node + 1];
        let entry = own.start + self.column[own].partition_point(|column| *column < node);
        self.stiffness[entry].iter_mut().zip(spring.iter()).for_each(|(sum, part)| *sum += part);
    }

    /// Nodes coupled to `node`, ascending, with their blocks.
    fn row(&self, node: usize) -> impl Iterator<Item = (usize, &Block)> {
        let range = self.start[node]..self.start[node + 1];
        self.column[range.clone()].iter().copied().zip(&self.stiffness[range])
    }

    /// Lower triangle of the stiffness over the free displacements, whose numbers ascend with the nodes.
    pub fn free_stiffness(&self, dof: &[[usize; 3]], size: usize) -> SparseColMat<usize, f64> {
        let (mut start, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for (node, components) in dof.iter().enumerate() {
            for (c, &column) in components.iter().enumerate().filter(|(_, d)| **d != FIXED) {
                for (other, block) in self.row(node) {
                    for (d, &row) in dof[other].iter().enumerate() {
                        if row != FIXED && row >= column {
                            rows.push(row);
                            // the matrix is symmetric: row and column change places
                            values.push(block[3 * c + d]);
                        }
                    }
                }
                start.push(rows.len());
            }
        }
        SparseColMat::new(SymbolicSparseColMat::new_checked(size, size, start, None, rows), values)
    }
}

/// Lame's constants in Pa.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lame {
    lambda: f64,
    mu: f64,
}

impl Lame {
    fn of(material: &Material) -> Self {
        let (e, nu) = (material.youngs_modulus, material.poisson_ratio);
        Self { lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu: e / (2.0 * (1.0 + nu)) }
    }

    /// Adds to the `blocks` between nodes, row by row, what a point of quadrature gives that has the `weight` in m^3 and where the shape
    /// functions have the gradients `gradient` in 1/m.
    pub(super) fn add(self, blocks: &mut [Block], gradient: &[Vector3<f64>], weight: f64) {
        let n = gradient.len();
        for (a, ga) in gradient.iter().enumerate() {
            for (b, gb) in gradient.iter().enumerate() {
                let block = &mut blocks[a * n + b];
                let trace = weight * self.mu * ga.dot(gb);
                for c in 0..3 {
                    for d in 0..3 {
                        block[3 * c + d] += weight * (self.lambda * ga[c] * gb[d] + self.mu * ga[d] * gb[c]);
                    }
                    block[4 * c] += trace;
                }
            }
        }
    }
}

/// Nodal masses in kg, all positive; their sum is the mesh's mass.
///
/// In proportion to the diagonal of the consistent mass (Hinton, Rock & Zienkiewicz 1976, Earthquake Eng. Struct.
/// Dyn. 4, 245), for a straight quadratic tetrahedron 6 : 32, as the finite-element reference does it: on one mesh both are
/// the same discrete system. Row sums would make the corners' masses negative.
fn lumped_mass(mesh: &TetMesh, materials: &CellMaterials) -> Vec<f64> {
    let (corner, midside) = if mesh.order == 1 { (0.25, 0.0) } else { (1.0 / 36.0, 4.0 / 27.0) };
    let mut mass = vec![0.0; mesh.points.len()];
    for (number, cell) in mesh.cells().enumerate() {
        let whole = materials.of(number).density * volume(&mesh.corners(cell));
        cell[..4].iter().for_each(|&node| mass[node] += corner * whole);
        cell[4..].iter().for_each(|&node| mass[node] += midside * whole);
    }
    mass
}

/// Gradients in 1/m of the barycentric coordinates, and the volume in m^3.
fn barycentric_gradients(corners: &[Vector3<f64>; 4]) -> ([Vector3<f64>; 4], f64) {
    let [a, b, c] = [1, 2, 3].map(|k| corners[k] - corners[0]);
    let six_volumes = a.dot(&b.cross(&c));
    let [g1, g2, g3] = [b.cross(&c), c.cross(&a), a.cross(&b)].map(|g| g / six_volumes);
    ([-(g1 + g2 + g3), g1, g2, g3], six_volumes / 6.0)
}

/// Blocks of the stiffness between the element's nodes, row by row. Shape (n * n).
fn element_stiffness(mesh: &TetMesh, cell: &[usize], lame: Lame) -> Vec<Block> {
    if let Some(places) = mesh.bent_places(cell) {
        return curved::stiffness(&places, lame);
    }
    let (gradients, volume) = barycentric_gradients(&mesh.corners(cell));
    let n = cell.len();
    let mut blocks = vec![[0.0; 9]; n * n];
    if n == 4 {
        lame.add(&mut blocks, &gradients, volume);
        return blocks;
    }
    // Hammer, Marlowe & Stroud 1956: four points, exact for the products of linear gradients.
    let (near, far) = (0.585_410_196_624_968_5, 0.138_196_601_125_010_5);
    for point in 0..4 {
        let l: [f64; 4] = std::array::from_fn(|a| if a == point { near } else { far });
        let mut gradient = [Vector3::zeros(); 10];
        for a in 0..4 {
            gradient[a] = (4.0 * l[a] - 1.0) * gradients[a];
        }
        for (k, [a, b]) in EDGES.into_iter().enumerate() {
            gradient[4 + k] = 4.0 * (l[a] * gradients[b] + l[b] * gradients[a]);
        }
        lame.add(&mut blocks, &gradient, 0.25 * volume);
    }
    blocks
}

/// Rows of coupled nodes: start of each row, and the ascending nodes of all rows.
fn sparsity(mesh: &TetMesh) -> (Vec<usize>, Vec<usize>) {
    let mut cells_of = vec![Vec::new(); mesh.points.len()];
    for (number, cell) in mesh.cells().enumerate() {
        cell.iter().for_each(|&node| cells_of[node].push(number));
    }
    let per_cell = mesh.nodes_per_cell();
    let rows: Vec<Vec<usize>> = cells_of
        .par_iter()
        .map(|cells| {
            let mut row: Vec<usize> =
                cells.iter().flat_map(|c| &mesh.cells[c * per_cell..(c + 1) * per_cell]).copied().collect();
            row.sort_unstable();
            row.dedup();
            row
        })
        .collect();
    let mut start = vec![0];
    start.extend(rows.iter().scan(0, |end, row| {
        *end += row.len();
        Some(*end)
    }));
    (start, rows.concat())
}

#[cfg(test)]
mod tests {
    use super::super::mesh::boxes;
    use super::*;
    use approx::assert_relative_eq;

    fn material() -> Material {
        Material::elastic("m", 2.6e9, 0.38, 1320.0)
    }

    /// Force on the nodes under the displacements `u`. Shape (nodes, 3).
    fn forces(matrices: &SolidMatrices, u: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        (0..matrices.mass.len())
            .map(|node| {
                let force = |(other, block): (usize, &Block)| Matrix3::from_row_slice(block) * u[other];
                matrices.row(node).map(force).sum()
            })
            .collect()
    }

    /// A box 3 x 2 x 1 with a node inside, sheared so that no edge is parallel to an axis.
    fn sheared(order: usize) -> TetMesh {
        boxes([3.0, 2.0, 1.0], [3, 2, 2], order, |[x, y, z]| [x + 0.2 * y * z, y + 0.1 * x, z + 0.3 * x * x])
    }

    #[test]
    fn rigid_motions_need_no_force() {
        for order in [1, 2] {
            let mesh = sheared(order);
            let matrices = SolidMatrices::new(&mesh, &CellMaterials::one(material()));
            let scale = 2.6e9 * 3.0;
            for axis in 0..3 {
                let mut omega = Vector3::zeros();
                omega[axis] = 1.0;
                let shift = vec![omega; mesh.points.len()];
                let turn = mesh.points.iter().map(|p| omega.cross(p)).collect();
                for u in [shift, turn] {
                    let worst = forces(&matrices, &u).iter().map(Vector3::amax).fold(0.0, f64::max);
                    assert!(worst < 1e-13 * scale, "order {order}: {worst}");
                }
            }
        }
    }

    #[test]
    fn patch_test_uniform_strain_gives_the_exact_energy_and_no_force_inside() {
        let gradient: Matrix3<f64> = Matrix3::new(1e-3, 4e-4, -2e-4, -3e-4, 2e-3, 5e-4, 6e-4, -1e-4, -1.5e-3);
        let (e, nu) = (2.6e9, 0.38);
        let (lambda, mu) = (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu)));
        let strain = gradient.symmetric_part();
        let density = 0.5 * lambda * strain.trace().powi(2) + mu * strain.norm_squared();
        for order in [1, 2] {
            let mesh = sheared(order);
            let matrices = SolidMatrices::new(&mesh, &CellMaterials::one(material()));
            let u: Vec<_> = mesh.points.iter().map(|p| gradient * p).collect();
            let force = forces(&matrices, &u);
            let whole: f64 = mesh.cells().map(|cell| volume(&mesh.corners(cell))).sum();
            let energy: f64 = 0.5 * u.iter().zip(&force).map(|(u, f)| u.dot(f)).sum::<f64>();
            assert_relative_eq!(energy, density * whole, max_relative = 1e-12);
            let mut inside = vec![true; mesh.points.len()];
            mesh.outer_faces().iter().flatten().for_each(|&n| inside[n] = false);
            assert!(inside.contains(&true));
            let largest = force.iter().map(Vector3::amax).fold(0.0, f64::max);
            for (force, _) in force.iter().zip(&inside).filter(|(_, inside)| **inside) {
                assert!(force.amax() < 1e-12 * largest, "order {order}: {force:?}");
            }
        }
    }

    #[test]
    fn masses_are_positive_and_add_up() {
        for order in [1, 2] {
            let mesh = sheared(order);
            let matrices = SolidMatrices::new(&mesh, &CellMaterials::one(material()));
            let whole: f64 = mesh.cells().map(|cell| volume(&mesh.corners(cell))).sum();
            assert_relative_eq!(matrices.mass.iter().sum::<f64>(), 1320.0 * whole, max_relative = 1e-13);
            assert!(matrices.mass.iter().all(|m| *m > 0.0));
        }
    }
}
