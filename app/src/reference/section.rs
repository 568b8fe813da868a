//! The plane of symmetry of a stored seal seat: faces of its tetrahedra there, and their stress.

use super::Stored;
use super::fields::{Arrays, nearest, read};

/// Corners of the faces of a tetrahedron.
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// VTK's cell types of tetrahedra, and their numbers of nodes.
const TETRAHEDRA: [(f64, usize); 2] = [(10.0, 4), (24.0, 10)];
/// How far from the plane y = 0 its nodes may lie, over the size of the body.
const ON_PLANE: f64 = 1e-9;

/// Triangles in the plane y = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSection {
    /// Coordinates x and z of the corners of each triangle in m.
    pub triangles: Vec<[[f64; 2]; 3]>,
    /// Von Mises stress in Pa of the elements they belong to, if the file has it. Shape (triangles.len()).
    pub von_mises: Option<Vec<f64>>,
}

impl Stored {
    /// The mesh in the plane of symmetry.
    ///
    /// # Errors
    /// One sentence that says what is wrong with the file.
    pub fn section(&self) -> Result<MeshSection, String> {
        read(&self.folder.join("mesh.vtu"), parse)
    }

    /// The stress there at the instant kept that is nearest to `time` (s), and that instant; `None` if none is kept.
    ///
    /// # Errors
    /// One sentence that says what is wrong with a file.
    pub fn section_near(&self, time: f64) -> Result<Option<(f64, MeshSection)>, String> {
        nearest(&self.folder, time, parse)
    }
}

fn parse(text: &str) -> Result<MeshSection, String> {
    let arrays = Arrays::parse(text)?;
    let points = arrays.needed("Points", "Points")?;
    let points = points.as_chunks::<3>().0;
    let types = arrays.needed("Cells", "types")?;
    let kind = TETRAHEDRA.iter().find(|(kind, _)| types.iter().all(|t| t == kind));
    let (_, per_cell) = kind.ok_or("not all cells are tetrahedra of the same order")?;
    let cells = arrays.indices("connectivity", points.len())?;
    let stress = arrays.get("CellData", "von_mises")?;
    let counts = [Some(cells.len() / per_cell), stress.as_ref().map(Vec::len)];
    if types.is_empty() || counts.into_iter().flatten().any(|n| n != types.len()) {
        return Err("the numbers of cells and of their data differ".into());
    }
    let size = points.iter().flatten().fold(0.0_f64, |size, x| size.max(x.abs()));
    let mut triangles = Vec::new();
    let mut von_mises = stress.is_some().then(Vec::new);
    for (number, cell) in cells.chunks_exact(*per_cell).enumerate() {
        for face in FACES {
            let corners = face.map(|k| points[cell[k]]);
            if corners.iter().all(|p| p[1].abs() <= ON_PLANE * size) {
                triangles.push(corners.map(|p| [p[0], p[2]]));
                if let (Some(values), Some(all)) = (&mut von_mises, &stress) {
                    values.push(all[number]);
                }
            }
        }
    }
    if triangles.is_empty() {
        return Err("no face lies in the plane y = 0".into());
    }
    Ok(MeshSection { triangles, von_mises })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = r#"<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="5" NumberOfCells="2">
<Points><DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">0 0 0 2 0 0 0 0 1 0 1 0 2 1 1</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 3 2 1 4 3 2</DataArray>
<DataArray type="Int64" Name="types" format="ascii">10 10</DataArray></Cells>
<CellData><DataArray type="Float64" Name="von_mises" format="ascii">5 7</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>"#;

    #[test]
    fn only_faces_in_the_plane_are_taken_with_the_stress_of_their_element() {
        let section = parse(TWO).expect("valid");
        assert_eq!(section.triangles.len(), 1);
        let mut corners = section.triangles[0];
        corners.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        assert_eq!(corners, [[0.0, 0.0], [0.0, 1.0], [2.0, 0.0]]);
        assert_eq!(section.von_mises, Some(vec![5.0]));
    }

    #[test]
    fn what_is_no_section_is_an_error_that_says_so() {
        for (from, to, word) in [
            (">10 10<", ">10 24<", "tetrahedra"),
            (">5 7<", ">5<", "differ"),
            ("0 1 3 2 1", "0 1 3 9 1", "does not exist"),
            ("0 0 0 2 0 0 0 0 1", "0 1 0 2 1 0 0 1 1", "no face"),
        ] {
            let error = parse(&TWO.replace(from, to)).expect_err(word);
            assert!(error.contains(word), "{error}");
        }
    }
}
