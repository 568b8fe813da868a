//! Stiffness and mass of a whole mesh, before any support or symmetry.

use super::basis::tabulate;
use super::element::ElementMatrices;
use super::mesh::Mesh;
use crate::error::{Error, Result};
use crate::scene::Material;
use faer::sparse::{SparseColMat, SymbolicSparseColMat};

/// Number of a displacement component that is held at zero.
pub(super) const FIXED: usize = usize::MAX;

/// Global stiffness and consistent mass by pairs of coupled nodes, in compressed rows.
#[derive(Debug, Clone)]
pub(super) struct Matrices {
    /// Range of each node's row in the other fields. Shape (nodes + 1).
    row_start: Vec<usize>,
    /// Coupled node, ascending in each row.
    column: Vec<usize>,
    /// Stiffness of (u_r, u_z) of the row's node against (u_r, u_z) of the column's: rr, rz, zr, zz.
    stiffness: Vec<[f64; 4]>,
    /// Mass, the same for both components, in kg.
    mass: Vec<f64>,
}

impl Matrices {
    /// Integrates all elements of `mesh`.
    ///
    /// # Errors
    /// [`Error::Solver`] if an element is degenerate or turned inside out.
    pub fn new(mesh: &Mesh, material: &Material) -> Result<Self> {
        let (row_start, column) = sparsity(mesh);
        let entries = column.len();
        let mut all =
            Self { row_start, column, stiffness: vec![[0.0; 4]; entries], mass: vec![0.0; entries] };
        let quadrature = tabulate(mesh.order);
        let per_element = (mesh.order + 1).pow(2);
        let mut element = ElementMatrices::new(per_element);
        let mut coordinates = vec![[0.0; 2]; per_element];
        for nodes in &mesh.elements {
            for (to, &node) in coordinates.iter_mut().zip(nodes) {
                *to = mesh.nodes[node];
            }
            element.compute(&coordinates, &quadrature, material)?;
            for (a, &row) in nodes.iter().enumerate() {
                let range = all.row_start[row]..all.row_start[row + 1];
                let columns = &all.column[range.clone()];
                for (b, node) in nodes.iter().enumerate() {
                    let entry = range.start + columns.partition_point(|c| c < node);
                    let (ab, ba) = (a * per_element + b, b * per_element + a);
                    let block = &mut all.stiffness[entry];
                    block[0] += element.k_rr[ab];
                    block[1] += element.k_rz[ab];
                    block[2] += element.k_rz[ba];
                    block[3] += element.k_zz[ab];
                    all.mass[entry] += element.mass[ab];
                }
            }
        }
        Ok(all)
    }

    /// Lower triangle of the stiffness over the free displacements.
    ///
    /// `dof` numbers (u_r, u_z) of each node, ascending with the nodes, or is [`FIXED`]; the row and column of
    /// a `pinned` number are decoupled from the rest (the diagonal stays, to keep the scale).
    pub fn free_stiffness(
        &self,
        dof: &[[usize; 2]],
        size: usize,
        pinned: Option<usize>,
    ) -> Result<SparseColMat<usize, f64>> {
        let (mut start, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for (node, components) in dof.iter().enumerate() {
            for (c, &column) in components.iter().enumerate().filter(|(_, d)| **d != FIXED) {
                for entry in self.row_start[node]..self.row_start[node + 1] {
                    for (d, &row) in dof[self.column[entry]].iter().enumerate() {
                        let decoupled = pinned.is_some_and(|p| p == row || p == column);
                        if row != FIXED && row >= column && (row == column || !decoupled) {
                            rows.push(row);
                            values.push(self.stiffness[entry][2 * c + d]);
                        }
                    }
                }
                start.push(rows.len());
            }
        }
        if start.len() != size + 1 {
            return Err(Error::Internal(format!(
                "continuum stiffness of {size} degrees of freedom has {} columns",
                start.len() - 1
            )));
        }
        Ok(SparseColMat::new(SymbolicSparseColMat::new_checked(size, size, start, None, rows), values))
    }

    /// Diagonal of the stiffness: of (u_r, u_z) of each node. Shape (nodes, 2).
    pub fn stiffness_diagonal(&self) -> Vec<[f64; 2]> {
        let own = |(node, range): (usize, &[usize])| {
            let entry = (range[0]..range[1]).find(|&e| self.column[e] == node);
            entry.map_or([0.0; 2], |e| [self.stiffness[e][0], self.stiffness[e][3]])
        };
        self.row_start.windows(2).enumerate().map(own).collect()
    }

    /// Mass matrix times the nodal displacements `x` (u_r, u_z). Shape (nodes, 2).
    pub fn mass_times(&self, x: &[[f64; 2]]) -> Vec<[f64; 2]> {
        self.row_start
            .windows(2)
            .map(|range| {
                let (mut r, mut z) = (0.0, 0.0);
                let row = range[0]..range[1];
                for (&node, &mass) in self.column[row.clone()].iter().zip(&self.mass[row]) {
                    r += mass * x[node][0];
                    z += mass * x[node][1];
                }
                [r, z]
            })
            .collect()
    }
}

/// Rows of coupled nodes: start of each row, and the ascending nodes of all rows.
fn sparsity(mesh: &Mesh) -> (Vec<usize>, Vec<usize>) {
    let mut elements_of = vec![Vec::new(); mesh.nodes.len()];
    for (element, nodes) in mesh.elements.iter().enumerate() {
        nodes.iter().for_each(|&node| elements_of[node].push(element));
    }
    let (mut start, mut column) = (vec![0], Vec::new());
    let mut row: Vec<usize> = Vec::new();
    for elements in &elements_of {
        row.clear();
        elements.iter().for_each(|&e| row.extend(&mesh.elements[e]));
        row.sort_unstable();
        row.dedup();
        column.extend(&row);
        start.push(column.len());
    }
    (start, column)
}
