//! Mesh of a solid body: straight-edged tetrahedra, linear or quadratic, read from a VTK file.

use super::curved;
use crate::error::{Error, Result};
use nalgebra::Vector3;
use std::collections::HashMap;
use std::path::Path;
use vtkio::model::{Attribute, CellType, DataSet, Piece, UnstructuredGridPiece, VertexNumbers, Vtk};

/// The edges of a tetrahedron between its corners, in VTK's order of the midside nodes 4 to 9.
pub(super) const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
/// Faces of a tetrahedron by its corners, pointing outwards, each with the midside nodes of its edges.
const FACES: [([usize; 3], [usize; 3]); 4] =
    [([0, 2, 1], [6, 5, 4]), ([0, 1, 3], [4, 8, 7]), ([1, 2, 3], [5, 9, 8]), ([2, 0, 3], [6, 7, 9])];
/// Largest distance of a midside node from the middle of its edge, over the edge's length: the elements are straight,
/// as those of the finite-element reference.
const STRAIGHT: f64 = 1e-6;

/// Tetrahedra with four nodes (linear) or ten (quadratic, straight edges).
#[derive(Debug, Clone, PartialEq)]
pub struct TetMesh {
    /// Places of the nodes in m. Shape (nodes).
    pub points: Vec<Vector3<f64>>,
    /// Nodes of the cells one after the other, corners first, midside nodes in VTK's order.
    /// Shape (cells * [`TetMesh::nodes_per_cell`]).
    pub cells: Vec<usize>,
    /// Polynomial order of the shape functions, 1 or 2.
    pub order: usize,
}

impl TetMesh {
    /// Checks and keeps a mesh.
    ///
    /// # Errors
    /// One sentence that says which cell or node is unusable: a node that does not exist or belongs to no cell, a
    /// cell that is flat or turned inside out, a curved edge.
    pub fn new(
        points: Vec<Vector3<f64>>,
        cells: Vec<usize>,
        order: usize,
    ) -> std::result::Result<Self, String> {
        let mesh = Self { points, cells, order };
        mesh.check()?;
        Ok(mesh)
    }

    /// As [`Self::new`] of quadratic cells whose edges may be curved.
    ///
    /// # Errors
    /// As [`Self::new`], for a cell that folds instead of a curved edge.
    pub fn curved(points: Vec<Vector3<f64>>, cells: Vec<usize>) -> std::result::Result<Self, String> {
        let mesh = Self { points, cells, order: 2 };
        mesh.check_cells(|number, cell| match curved::least_jacobian(&mesh.places(cell)) > 0.0 {
            true => Ok(()),
            false => Err(format!("cell {number} folds: one of its curved edges is turned inside out")),
        })?;
        Ok(mesh)
    }

    /// Reads an unstructured grid of tetrahedra (VTK cell type 10 or 24) from a `.vtu` file, in m. Of several bodies, which a
    /// cell array `body` tells apart, it is the first.
    ///
    /// # Errors
    /// [`Error::Solver`] if the file can't be read as VTK or its mesh is unusable.
    pub fn read(path: &Path) -> Result<Self> {
        Self::first_of(MeshFile::read(path)?, path)
    }

    /// As [`Self::read`] of the `content` of a `.vtu` file, which messages call `path`.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(path: &Path, content: &[u8]) -> Result<Self> {
        Self::first_of(MeshFile::of(Vtk::parse_xml(content), path)?, path)
    }

    fn first_of(file: MeshFile, path: &Path) -> Result<Self> {
        let of_first = file.cell_array("body").map(|bodies| {
            let body = bodies.first().copied();
            bodies.iter().take_while(|other| Some(**other) == body).count()
        });
        let MeshFile { mut points, mut cells, order, .. } = file;
        if let Some(count) = of_first {
            cells.truncate(count * nodes_per_cell(order));
            points.truncate(cells.iter().max().map_or(0, |last| last + 1));
        }
        Self::new(points, cells, order).map_err(|what| unusable(path, &what))
    }

    /// Volume of each cell in m^3.
    pub fn volumes(&self) -> impl Iterator<Item = f64> {
        self.cells().map(|cell| {
            self.bent_places(cell)
                .map_or_else(|| volume(&self.corners(cell)), |places| curved::volume(&places))
        })
    }

    /// Number of nodes of a cell, 4 or 10.
    pub fn nodes_per_cell(&self) -> usize {
        nodes_per_cell(self.order)
    }

    /// The nodes of each cell.
    pub fn cells(&self) -> std::slice::ChunksExact<'_, usize> {
        self.cells.chunks_exact(self.nodes_per_cell())
    }

    /// Places of the nodes of a quadratic cell.
    pub(super) fn places(&self, cell: &[usize]) -> [Vector3<f64>; 10] {
        std::array::from_fn(|a| self.points[cell[a]])
    }

    /// Those of a cell with a curved edge.
    pub(super) fn bent_places(&self, cell: &[usize]) -> Option<[Vector3<f64>; 10]> {
        self.first_bent(cell).map(|_| self.places(cell))
    }

    /// The first midside node of `cell` that is not in the middle of its edge.
    fn first_bent(&self, cell: &[usize]) -> Option<usize> {
        let bent = |([a, b], midside): &([usize; 2], &usize)| {
            let (a, b) = (self.points[cell[*a]], self.points[cell[*b]]);
            (0.5 * (a + b)).metric_distance(&self.points[**midside]) > STRAIGHT * a.metric_distance(&b)
        };
        EDGES.into_iter().zip(&cell[4..]).find(bent).map(|(_, midside)| *midside)
    }

    /// Places of the corners of a cell.
    pub(super) fn corners(&self, cell: &[usize]) -> [Vector3<f64>; 4] {
        std::array::from_fn(|a| self.points[cell[a]])
    }

    /// The faces that belong to one cell only: their nodes, corners first. Shape (faces, 3 or 6).
    pub fn outer_faces(&self) -> Vec<Vec<usize>> {
        let mut outer: HashMap<[usize; 3], Option<Vec<usize>>> = HashMap::new();
        for cell in self.cells() {
            for (corners, midsides) in FACES {
                let mut key = corners.map(|c| cell[c]);
                let mut nodes = key.to_vec();
                if self.order == 2 {
                    nodes.extend(midsides.map(|m| cell[m]));
                }
                key.sort_unstable();
                outer.entry(key).and_modify(|face| *face = None).or_insert(Some(nodes));
            }
        }
        let mut faces: Vec<Vec<usize>> = outer.into_values().flatten().collect();
        faces.sort_unstable();
        faces
    }

    fn check(&self) -> std::result::Result<(), String> {
        self.check_cells(|_, cell| match self.first_bent(cell) {
            Some(node) => {
                Err(format!("node {node} is not in the middle of its edge: edges must be straight"))
            }
            None => Ok(()),
        })
    }

    /// Checks nodes and corners, and each cell by `more`.
    fn check_cells(
        &self,
        more: impl Fn(usize, &[usize]) -> std::result::Result<(), String>,
    ) -> std::result::Result<(), String> {
        let per_cell = self.nodes_per_cell();
        if self.cells.is_empty() || !self.cells.len().is_multiple_of(per_cell) {
            return Err(format!("{} node numbers are no tetrahedra of {per_cell} nodes", self.cells.len()));
        }
        if let Some(node) = self.points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
            return Err(format!("node {node} has a place that is not finite"));
        }
        let mut used = vec![false; self.points.len()];
        for (number, cell) in self.cells().enumerate() {
            for &node in cell {
                *used
                    .get_mut(node)
                    .ok_or_else(|| format!("cell {number} names node {node} of {}", self.points.len()))? =
                    true;
            }
            let corners = self.corners(cell);
            if volume(&corners) <= 0.0 {
                return Err(format!("cell {number} is flat or turned inside out"));
            }
            more(number, cell)?;
        }
        match used.iter().position(|used| !used) {
            Some(node) => Err(format!("node {node} belongs to no cell")),
            None => Ok(()),
        }
    }
}

/// What a `.vtu` file of tetrahedra holds, unchecked.
pub(super) struct MeshFile {
    pub(super) points: Vec<Vector3<f64>>,
    pub(super) cells: Vec<usize>,
    order: usize,
    /// Whole numbers of nodes and of cells, by their names.
    point_arrays: Vec<(String, Vec<i64>)>,
    cell_arrays: Vec<(String, Vec<i64>)>,
}

impl MeshFile {
    /// # Errors
    /// [`Error::Solver`] if the file can't be read as VTK or holds other cells.
    pub(super) fn read(path: &Path) -> Result<Self> {
        Self::of(Vtk::import(path), path)
    }

    fn of(vtk: std::result::Result<Vtk, vtkio::Error>, path: &Path) -> Result<Self> {
        let failed = |what: &str| unusable(path, what);
        let vtk = vtk.map_err(|e| failed(&format!("can't be read as VTK: {e}")))?;
        let piece = grid(vtk).map_err(|what| failed(&what))?;
        let points = piece.points.cast_into::<f64>().ok_or_else(|| failed("its points are no numbers"))?;
        let order = match piece.cells.types.first() {
            Some(CellType::Tetra) => 1,
            Some(CellType::QuadraticTetra) => 2,
            _ => return Err(failed("has no tetrahedra (VTK cell type 10 or 24)")),
        };
        if piece.cells.types.iter().any(|t| *t != piece.cells.types[0]) {
            return Err(failed("mixes cells of different types"));
        }
        let cells = connectivity(piece.cells.cell_verts, nodes_per_cell(order))
            .ok_or_else(|| failed("has cells with a wrong number of nodes"))?;
        Ok(Self {
            points: points.chunks_exact(3).map(Vector3::from_column_slice).collect(),
            cells,
            order,
            point_arrays: numbers(&piece.data.point),
            cell_arrays: numbers(&piece.data.cell),
        })
    }

    /// The array of the nodes called `name`.
    pub(super) fn point_array(&self, name: &str) -> Option<&[i64]> {
        self.point_arrays.iter().find(|(own, _)| own == name).map(|(_, values)| &values[..])
    }

    /// The array of the cells called `name`.
    pub(super) fn cell_array(&self, name: &str) -> Option<&[i64]> {
        self.cell_arrays.iter().find(|(own, _)| own == name).map(|(_, values)| &values[..])
    }
}

/// That the mesh file at `path` is of no use.
pub(super) fn unusable(path: &Path, what: &str) -> Error {
    Error::Solver(format!("mesh {}: {what}", path.display()))
}

/// The arrays of whole numbers among `arrays`.
fn numbers(arrays: &[Attribute]) -> Vec<(String, Vec<i64>)> {
    let of = |array: &Attribute| match array {
        Attribute::DataArray(array) => Some((array.name.clone(), array.data.cast_into::<i64>()?)),
        Attribute::Field { .. } => None,
    };
    arrays.iter().filter_map(of).collect()
}

fn nodes_per_cell(order: usize) -> usize {
    if order == 1 { 4 } else { 10 }
}

/// Volume of a tetrahedron in m^3, positive if its corners are in VTK's order.
pub(super) fn volume(corners: &[Vector3<f64>; 4]) -> f64 {
    let [a, b, c] = [1, 2, 3].map(|k| corners[k] - corners[0]);
    a.dot(&b.cross(&c)) / 6.0
}

/// The only piece of an unstructured grid.
fn grid(vtk: Vtk) -> std::result::Result<UnstructuredGridPiece, String> {
    let DataSet::UnstructuredGrid { pieces, .. } = vtk.data else {
        return Err("is no unstructured grid".into());
    };
    match <[Piece<UnstructuredGridPiece>; 1]>::try_from(pieces) {
        Ok([Piece::Inline(piece)]) => Ok(*piece),
        _ => Err("does not consist of one piece".into()),
    }
}

/// Node numbers of cells that have `per_cell` nodes each.
fn connectivity(numbers: VertexNumbers, per_cell: usize) -> Option<Vec<usize>> {
    match numbers {
        VertexNumbers::XML { connectivity, offsets } => {
            let offsets = offsets.strip_prefix(&[0]).unwrap_or(&offsets);
            let regular = offsets.iter().enumerate().all(|(k, end)| *end == ((k + 1) * per_cell) as u64);
            let whole = regular && connectivity.len() == offsets.len() * per_cell;
            whole.then(|| connectivity.into_iter().map(|n| n as usize).collect())
        }
        VertexNumbers::Legacy { vertices, .. } => {
            let cells = vertices.chunks_exact(per_cell + 1);
            let whole = cells.remainder().is_empty() && cells.clone().all(|c| c[0] as usize == per_cell);
            whole.then(|| cells.flat_map(|c| c[1..].iter().map(|n| *n as usize)).collect())
        }
    }
}

/// A box of the given lengths cut into six tetrahedra per brick, its corners moved by `place`.
#[cfg(test)]
pub(crate) fn boxes(
    lengths: [f64; 3],
    bricks: [usize; 3],
    order: usize,
    place: impl Fn([f64; 3]) -> [f64; 3],
) -> TetMesh {
    let [nx, ny, nz] = bricks;
    let number = |i: usize, j: usize, k: usize| (i * (ny + 1) + j) * (nz + 1) + k;
    let mut points = Vec::new();
    for (i, j, k) in grid_points([nx + 1, ny + 1, nz + 1]) {
        let at = [(i, nx, 0), (j, ny, 1), (k, nz, 2)];
        points.push(place(at.map(|(i, n, c)| lengths[c] * i as f64 / n as f64)).into());
    }
    let mut corners = Vec::new();
    for (i, j, k) in grid_points(bricks) {
        // Kuhn's division: a tetrahedron per order in which the axes are walked.
        for path in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let mut step = [i, j, k];
            let mut cell = vec![number(i, j, k)];
            for axis in path {
                step[axis] += 1;
                cell.push(number(step[0], step[1], step[2]));
            }
            let odd = matches!(path, [0, 2, 1] | [2, 1, 0] | [1, 0, 2]);
            if odd {
                cell.swap(2, 3);
            }
            corners.push(cell);
        }
    }
    let mut midsides: HashMap<[usize; 2], usize> = HashMap::new();
    let mut cells = Vec::new();
    for cell in corners {
        cells.extend(&cell);
        for [a, b] in EDGES.iter().filter(|_| order == 2) {
            let mut edge = [cell[*a], cell[*b]];
            edge.sort_unstable();
            let middle = *midsides.entry(edge).or_insert_with(|| {
                points.push(0.5 * (points[edge[0]] + points[edge[1]]));
                points.len() - 1
            });
            cells.push(middle);
        }
    }
    TetMesh::new(points, cells, order).expect("mesh")
}

#[cfg(test)]
fn grid_points([nx, ny, nz]: [usize; 3]) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..nx).flat_map(move |i| (0..ny).flat_map(move |j| (0..nz).map(move |k| (i, j, k))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_the_outer_faces_of_its_surface() {
        for order in [1, 2] {
            let mesh = boxes([3.0, 2.0, 1.0], [3, 2, 1], order, |p| p);
            let faces = mesh.outer_faces();
            // two triangles per square of the surface
            assert_eq!(faces.len(), 2 * 2 * (3 * 2 + 2 + 3));
            let area: f64 = faces
                .iter()
                .map(|face| {
                    let [a, b, c] = [0, 1, 2].map(|k| mesh.points[face[k]]);
                    0.5 * (b - a).cross(&(c - a)).norm()
                })
                .sum();
            assert!((area - 22.0).abs() < 1e-12);
            let middle = |face: &[usize], a: usize, b: usize, m: usize| {
                let [a, b, m] = [a, b, m].map(|k| mesh.points[face[k]]);
                (0.5 * (a + b) - m).amax() < 1e-12
            };
            if order == 2 {
                let on_edges = |face: &Vec<usize>| {
                    [(0, 1), (1, 2), (2, 0)].iter().all(|&(a, b)| (3..6).any(|m| middle(face, a, b, m)))
                };
                assert!(faces.iter().all(on_edges));
            }
        }
    }

    /// A reference's mesh of a seat with an elastic sphere has both.
    #[test]
    fn of_several_bodies_the_first_is_read() {
        let array = |kind: &str, name: &str, numbers: &str| {
            let columns = if name == "Points" { " NumberOfComponents=\"3\"" } else { "" };
            format!(r#"<DataArray type="{kind}" Name="{name}"{columns} format="ascii">{numbers}</DataArray>"#)
        };
        let corner = "0 0 0 1 0 0 0 1 0 0 0 1";
        let text = format!(
            r#"<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="8" NumberOfCells="2"><Points>{}</Points><Cells>{}{}{}</Cells><CellData>{}</CellData>
</Piece></UnstructuredGrid></VTKFile>"#,
            array("Float64", "Points", &format!("{corner} {}", corner.replace('1', "3"))),
            array("Int64", "connectivity", "0 1 2 3 4 5 6 7"),
            array("Int64", "offsets", "4 8"),
            array("Int64", "types", "10 10"),
            array("Int32", "body", "0 1"),
        );
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("two.vtu");
        std::fs::write(&path, text).unwrap();
        let mesh = TetMesh::read(&path).unwrap();
        assert_eq!((mesh.points.len(), mesh.cells), (4, vec![0, 1, 2, 3]));
    }

    #[test]
    fn unusable_meshes_have_different_messages() {
        let good = boxes([1.0; 3], [1, 1, 1], 2, |p| p);
        let message = |points: Vec<Vector3<f64>>, cells: Vec<usize>, order| {
            TetMesh::new(points, cells, order).expect_err("unusable")
        };
        let mut inverted = good.cells.clone();
        inverted.swap(0, 1);
        assert!(message(good.points.clone(), inverted, 2).contains("turned inside out"));
        let mut curved = good.points.clone();
        curved[good.cells[4]][0] += 0.01;
        let said = message(curved, good.cells.clone(), 2);
        assert!(said.contains("straight") || said.contains("inside out"), "{said}");
        let mut missing = good.cells.clone();
        missing[0] = 99;
        assert!(message(good.points.clone(), missing, 2).contains("names node 99"));
        let mut more = good.points.clone();
        more.push(Vector3::zeros());
        assert!(message(more, good.cells.clone(), 2).contains("belongs to no cell"));
        assert!(message(good.points.clone(), good.cells[..9].to_vec(), 2).contains("no tetrahedra"));
        let mut lost = good.points.clone();
        lost[0][1] = f64::NAN;
        assert!(message(lost, good.cells.clone(), 2).contains("not finite"));
    }
}
