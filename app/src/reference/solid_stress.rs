//! The stress in the struck body of a solid reference.

use super::Stored;
use super::fields::{Arrays, nearest};

/// Number of the struck body among the elastic ones.
const STRUCK: f64 = 0.0;

/// Von Mises stress of the elements of the struck body.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidStress {
    /// Midpoint of each element in m and stress there in Pa, by ascending x.
    elements: Vec<([f64; 3], f64)>,
}

impl SolidStress {
    /// Stress in Pa at each of `points` (m), that of the nearest element.
    pub fn at(&self, points: &[[f64; 3]]) -> Vec<f64> {
        points.iter().map(|point| self.nearest(point)).collect()
    }

    fn nearest(&self, point: &[f64; 3]) -> f64 {
        let middle = self.elements.partition_point(|(place, _)| place[0] < point[0]);
        let mut best = (f64::INFINITY, 0.0);
        // outwards to both sides until the distance along x alone is larger
        let mut visit = |(place, stress): &([f64; 3], f64)| {
            let square: f64 = place.iter().zip(point).map(|(a, b)| (a - b).powi(2)).sum();
            if square < best.0 {
                best = (square, *stress);
            }
            (place[0] - point[0]).powi(2) <= best.0
        };
        let (before, behind) = self.elements.split_at(middle);
        behind.iter().take_while(|element| visit(element)).for_each(drop);
        before.iter().rev().take_while(|element| visit(element)).for_each(drop);
        best.1
    }
}

impl Stored {
    /// The stress at the instant that is nearest to `time` (s), and that instant; `None` if none is stored.
    ///
    /// # Errors
    /// One sentence that says what is wrong with a file.
    pub fn solid_stress_near(&self, time: f64) -> Result<Option<(f64, SolidStress)>, String> {
        nearest(&self.folder, time, parse)
    }
}

fn parse(text: &str) -> Result<SolidStress, String> {
    let arrays = Arrays::parse(text)?;
    let points = arrays.needed("Points", "Points")?;
    let points = points.as_chunks::<3>().0;
    let [bodies, stress] = [arrays.needed("CellData", "body")?, arrays.needed("CellData", "von_mises")?];
    let cells = arrays.indices("connectivity", points.len())?;
    let per_cell = cells.len() / bodies.len().max(1);
    if per_cell < 4 || per_cell * bodies.len() != cells.len() || stress.len() != bodies.len() {
        return Err("the numbers of cells and of their data differ".into());
    }
    let middle = |cell: &[usize]| {
        std::array::from_fn(|c| cell[..4].iter().map(|node| points[*node][c]).sum::<f64>() / 4.0)
    };
    let all = cells.chunks_exact(per_cell).zip(&bodies).zip(stress);
    let mut elements: Vec<([f64; 3], f64)> = all
        .filter(|((_, body), _)| **body == STRUCK)
        .map(|((cell, _), stress)| (middle(cell), stress))
        .collect();
    if elements.is_empty() {
        return Err("no element belongs to the struck body".into());
    }
    elements.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    Ok(SolidStress { elements })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = r#"<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="6" NumberOfCells="3">
<Points><DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">0 0 0 4 0 0 0 0 4 0 4 0 4 4 4 8 8 8</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 3 2 1 4 3 2 1 4 3 5</DataArray></Cells>
<CellData><DataArray type="Float64" Name="von_mises" format="ascii">5 7 9</DataArray>
<DataArray type="Int32" Name="body" format="ascii">0 0 1</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>"#;

    #[test]
    fn each_point_has_the_stress_of_the_nearest_element_of_the_struck_body() {
        let stress = parse(TWO).expect("valid");
        assert_eq!(stress.at(&[[0.0; 3], [3.0, 3.0, 3.0], [9.0; 3], [1.4, 1.4, 1.4]]), [5.0, 7.0, 7.0, 5.0]);
    }

    #[test]
    fn what_has_no_stress_of_the_struck_body_is_an_error() {
        for (from, to, word) in [(">0 0 1<", ">1 1 1<", "no element"), (">5 7 9<", ">5<", "differ")] {
            let error = parse(&TWO.replace(from, to)).expect_err(word);
            assert!(error.contains(word), "{error}");
        }
    }
}
