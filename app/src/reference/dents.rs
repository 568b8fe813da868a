//! The surfaces that impacts have left behind: `dents.csv` of a stored solution whose materials yield.

use super::Stored;
use serde::Deserialize;

/// The surfaces at rest after an impact, over the virgin ones and out of their bodies.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Dents {
    /// Number of the impact, from 1 on.
    pub impact: u64,
    /// Distances from the axis in m. Shape (n).
    pub radius: Vec<f64>,
    /// Heights in m of outer body, the plate's outer and inner face, inner body. Shapes (n).
    pub heights: [Vec<f64>; 4],
}

#[derive(Deserialize)]
struct DentRow {
    impact: u64,
    radius: f64,
    outer_body: f64,
    plate_outer_face: f64,
    plate_inner_face: f64,
    inner_body: f64,
}

impl Stored {
    /// The surfaces after every impact, the first one first; none of a solution that has none.
    ///
    /// # Errors
    /// One sentence that says what is wrong with the file.
    pub fn dents(&self) -> Result<Vec<Dents>, String> {
        let path = self.folder.join("dents.csv");
        if !path.is_file() {
            return Ok(Vec::new());
        }
        let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        read(&text).map_err(|e| format!("{}: {e}", path.display()))
    }
}

fn read(text: &str) -> Result<Vec<Dents>, csv::Error> {
    let mut all: Vec<Dents> = Vec::new();
    for row in csv::Reader::from_reader(text.as_bytes()).deserialize() {
        let DentRow { impact, radius, outer_body, plate_outer_face, plate_inner_face, inner_body } = row?;
        if all.last().is_none_or(|dents| dents.impact != impact) {
            all.push(Dents { impact, ..Dents::default() });
        }
        let dents = all.last_mut().expect("one at least");
        dents.radius.push(radius);
        let heights = [outer_body, plate_outer_face, plate_inner_face, inner_body];
        dents.heights.iter_mut().zip(heights).for_each(|(surface, height)| surface.push(height));
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::read;

    const HEADER: &str = "impact,radius,outer_body,plate_outer_face,plate_inner_face,inner_body\n";

    #[test]
    fn rows_of_one_impact_are_its_surfaces() {
        let text = format!("{HEADER}1,0,-1e-6,-2e-6,-3e-6,-4e-6\n1,1e-4,1,2,3,4\n2,0,5,6,7,8\n");
        let found = read(&text).expect("valid");
        assert_eq!(found.iter().map(|dents| dents.impact).collect::<Vec<_>>(), [1, 2]);
        assert_eq!(found[0].radius, [0.0, 1e-4]);
        assert_eq!(found[0].heights, [[-1e-6, 1.0], [-2e-6, 2.0], [-3e-6, 3.0], [-4e-6, 4.0]]);
        assert_eq!(found[1].heights[3], [8.0]);
        let error = read(&format!("{HEADER}1,0,-1e-6,x,0,0\n")).expect_err("no number");
        assert!(error.to_string().contains("line: 2"), "{error}");
    }
}
