//! The mesh and the stress fields of a stored axisymmetric solution, read from its .vtu files.

use super::Stored;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use resvg::usvg::roxmltree::{Document, Node};
use std::fs;
use std::path::{Path, PathBuf};

/// Number of a quadrilateral among VTK's cell types.
const VTK_QUAD: f64 = 9.0;

/// Lists the fields of a solution and their instants.
const SERIES: &str = "stress.pvd";

/// Quadrilaterals in the half-plane (r, z), and what is known of each.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldMesh {
    /// Coordinates r and z of the nodes in m.
    pub points: Vec<[f64; 2]>,
    /// Nodes of each element, counted from 0.
    pub quads: Vec<[usize; 4]>,
    /// Body of each element: 0 outer, 1 plate, 2 inner. Shape (quads.len()).
    pub bodies: Vec<usize>,
    /// Von Mises stress at each element's midpoint in Pa, if the file has it. Shape (quads.len()).
    pub von_mises: Option<Vec<f64>>,
    /// Accumulated plastic strain of each element after the last impact, if the file has it. Shape (quads.len()).
    pub plastic_strain: Option<Vec<f64>>,
}

impl FieldMesh {
    /// Reads a .vtu file as `fem_reference` writes it: one piece of quadrilaterals, data in base64 or as text.
    ///
    /// # Errors
    /// One sentence that says what is wrong with the file.
    pub(crate) fn read(path: &Path) -> Result<Self, String> {
        read(path, parse)
    }
}

impl Stored {
    /// The mesh, if it consists of quadrilaterals.
    ///
    /// # Errors
    /// One sentence that says what is wrong with the file.
    pub fn mesh(&self) -> Result<FieldMesh, String> {
        FieldMesh::read(&self.folder.join("mesh.vtu"))
    }

    /// The stress field nearest to `time` (s) and its instant; `None` if the solution has none.
    ///
    /// # Errors
    /// One sentence that says what is wrong with a file.
    pub fn stress_near(&self, time: f64) -> Result<Option<(f64, FieldMesh)>, String> {
        nearest(&self.folder, time, parse)
    }

    /// The file that lists the fields that are stored, for ParaView; `None` where none of them is there.
    pub(crate) fn fields_over_time(&self) -> Option<PathBuf> {
        let is_there = series(&self.folder).is_ok_and(|fields| !fields.is_empty());
        is_there.then(|| self.folder.join(SERIES))
    }
}

/// What `parse` makes of the text of a file.
pub(super) fn read<T>(path: &Path, parse: fn(&str) -> Result<T, String>) -> Result<T, String> {
    let fail = |what: String| format!("{}: {what}", path.display());
    let text = fs::read_to_string(path).map_err(|e| fail(e.to_string()))?;
    parse(&text).map_err(fail)
}

/// Instant in s and contents of the field in the series of `folder` that is nearest to `time` (s); `None` if
/// none is there.
pub(super) fn nearest<T>(
    folder: &Path,
    time: f64,
    parse: fn(&str) -> Result<T, String>,
) -> Result<Option<(f64, T)>, String> {
    let series = series(folder)?.into_iter();
    let nearest = series.min_by(|a, b| (a.0 - time).abs().total_cmp(&(b.0 - time).abs()));
    nearest.map(|(instant, file)| Ok((instant, read(&file, parse)?))).transpose()
}

/// Instants in s and files of the fields in the series of `folder` that are there.
fn series(folder: &Path) -> Result<Vec<(f64, PathBuf)>, String> {
    let series = folder.join(SERIES);
    if !series.is_file() {
        return Ok(Vec::new());
    }
    let text = fs::read_to_string(&series).map_err(|e| format!("{}: {e}", series.display()))?;
    let document = Document::parse(&text).map_err(|e| format!("{}: {e}", series.display()))?;
    let entries = document.descendants().filter(|node| node.has_tag_name("DataSet")).filter_map(|node| {
        let instant: f64 = node.attribute("timestep")?.parse().ok()?;
        // a name that leads elsewhere would show another solution's field
        let name = node.attribute("file").filter(|name| !name.contains(['/', '\\']))?;
        Some((instant, folder.join(name))).filter(|(_, field)| field.is_file())
    });
    Ok(entries.collect())
}

/// The data arrays of a .vtu file of one piece.
pub(super) struct Arrays<'a> {
    document: Document<'a>,
    /// Whether lengths before binary data have eight bytes.
    wide: bool,
}

impl<'a> Arrays<'a> {
    /// Reads the structure of a file.
    pub(super) fn parse(text: &'a str) -> Result<Self, String> {
        let document = Document::parse(text).map_err(|e| e.to_string())?;
        let root = document.root_element();
        if root.attribute("compressor").is_some() || root.attribute("byte_order") == Some("BigEndian") {
            return Err("compressed and big-endian data are not read".into());
        }
        let wide = root.attribute("header_type") == Some("UInt64");
        Ok(Self { document, wide })
    }

    /// The array `name` of a section (Points, Cells, CellData), if there is one.
    pub(super) fn get(&self, section: &str, name: &str) -> Result<Option<Vec<f64>>, String> {
        let section = self.document.root_element().descendants().find(|node| node.has_tag_name(section));
        let found = section.and_then(|node| {
            node.children().find(|n| n.has_tag_name("DataArray") && n.attribute("Name") == Some(name))
        });
        found.map(|node| numbers(node, self.wide).map_err(|what| format!("{name}: {what}"))).transpose()
    }

    /// As [`Arrays::get`], of an array that has to be there.
    pub(super) fn needed(&self, section: &str, name: &str) -> Result<Vec<f64>, String> {
        self.get(section, name)?.ok_or_else(|| format!("no {name}"))
    }

    /// The array `name` of the cells as numbers of nodes, of which there are `nodes`.
    pub(super) fn indices(&self, name: &str, nodes: usize) -> Result<Vec<usize>, String> {
        let index = |number: &f64| Some(*number as usize).filter(|n| *number >= 0.0 && *n < nodes);
        let found: Option<Vec<usize>> = self.needed("Cells", name)?.iter().map(index).collect();
        found.ok_or_else(|| "a cell has a node that does not exist".into())
    }
}

fn parse(text: &str) -> Result<FieldMesh, String> {
    let arrays = Arrays::parse(text)?;
    let points = arrays.needed("Points", "Points")?;
    let points: Vec<[f64; 2]> = points.chunks_exact(3).map(|p| [p[0], p[1]]).collect();
    if arrays.needed("Cells", "types")?.iter().any(|kind| *kind != VTK_QUAD) {
        return Err("not all cells are quadrilaterals".into());
    }
    let nodes = arrays.indices("connectivity", points.len())?;
    let quads: Vec<[usize; 4]> = nodes.chunks_exact(4).map(|q| [q[0], q[1], q[2], q[3]]).collect();
    let bodies: Vec<usize> = arrays.needed("CellData", "body")?.iter().map(|b| *b as usize).collect();
    let von_mises = arrays.get("CellData", "von_mises")?;
    let plastic_strain = arrays.get("CellData", "plastic_strain")?;
    let [stresses, strains] = [&von_mises, &plastic_strain].map(|values| values.as_ref().map(Vec::len));
    let lengths = [Some(bodies.len()), stresses, strains];
    if quads.is_empty() || lengths.into_iter().flatten().any(|n| n != quads.len()) {
        return Err("the numbers of cells and of their data differ".into());
    }
    Ok(FieldMesh { points, quads, bodies, von_mises, plastic_strain })
}

/// Values of a `DataArray`.
fn numbers(node: Node, wide: bool) -> Result<Vec<f64>, String> {
    let text: String = node.text().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ");
    match node.attribute("format") {
        Some("ascii") => text
            .split(' ')
            .filter(|t| !t.is_empty())
            .map(|t| t.parse().map_err(|_| format!("`{t}`")))
            .collect(),
        Some("binary") => {
            let bytes = BASE64_STANDARD.decode(text.replace(' ', "")).map_err(|e| e.to_string())?;
            // the length of the data stands before them
            let data = bytes.get(if wide { 8 } else { 4 }..).ok_or("no data")?;
            match node.attribute("type") {
                Some("Float64") => Ok(read_as(data, f64::from_le_bytes)),
                Some("Float32") => Ok(read_as(data, |b| f64::from(f32::from_le_bytes(b)))),
                Some("Int64") => Ok(read_as(data, |b| i64::from_le_bytes(b) as f64)),
                Some("Int32") => Ok(read_as(data, |b| f64::from(i32::from_le_bytes(b)))),
                other => Err(format!("type {other:?} is not read")),
            }
        }
        other => Err(format!("format {other:?} is not read")),
    }
}

fn read_as<const N: usize>(data: &[u8], number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
    data.as_chunks::<N>().0.iter().map(|bytes| number(*bytes)).collect()
}

#[cfg(test)]
mod tests {
    use super::parse;

    const ONE_ELEMENT: &str = r#"<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="1">
<Points><DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 1 2 0 0 2 0</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="binary">EAAAAAAAAAABAAAAAgAAAAMAAAA=</DataArray>
<DataArray type="Int64" Name="types" format="ascii">9</DataArray></Cells>
<CellData><DataArray type="Int32" Name="body" format="ascii">1</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>"#;

    #[test]
    fn text_and_base64_are_read() {
        let mesh = parse(ONE_ELEMENT).expect("valid");
        assert_eq!(mesh.points, [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]]);
        assert_eq!((mesh.quads, mesh.bodies, mesh.von_mises), (vec![[0, 1, 2, 3]], vec![1], None));
    }

    #[test]
    fn what_is_no_mesh_of_quadrilaterals_is_an_error_that_says_so() {
        for (from, to, word) in [
            (">9<", ">10<", "quadrilaterals"),
            ("AgAAAAMAAAA=", "AgAAAAkAAAA=", "does not exist"),
            (">1</DataArray></CellData>", ">1 1</DataArray></CellData>", "differ"),
            ("Name=\"body\"", "Name=\"none\"", "no body"),
            ("EAAAAAAA", "?", "connectivity"),
        ] {
            let error = parse(&ONE_ELEMENT.replace(from, to)).expect_err(word);
            assert!(error.contains(word), "{error}");
        }
    }
}
