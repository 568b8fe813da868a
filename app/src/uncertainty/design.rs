//! Where the inputs are sampled: scrambled Sobol points, for moments and for Sobol indices at once.
//!
//! A row has a point A and a point B, independent of each other, and for every factor (an input, or inputs that are correlated) the
//! point A with that factor from B (Saltelli et al., Comput. Phys. Commun. 181, 2010, table 2). Rows come in [`REPLICATES`]
//! independently scrambled sequences (Owen's scrambling: Burley, J. Comput. Graph. Tech. 9, 2020), whose scatter among each other is
//! what the estimates are uncertain by: rows of one sequence avoid each other, and resampling them as if they were independent
//! would state intervals that are several times too wide.

use sobol_burley::{NUM_DIMENSIONS, sample};

/// Independent sequences.
pub const REPLICATES: usize = 16;
/// Most inputs: A and B take a dimension each.
pub const MOST_INPUTS: usize = NUM_DIMENSIONS as usize / 2;
/// Most rows: a sequence has 2^16 points.
pub const MOST_ROWS: usize = REPLICATES << 16;
/// Points are multiples of 2^-24, moved by half of that: none lies on a face of the cube.
const HALF_STEP: f64 = 1.0 / (1 << 25) as f64;

/// One of the points of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Point {
    /// The first sample.
    A,
    /// The second.
    B,
    /// The first with the factor of this number from the second.
    Mixed(usize),
}

/// Points of the unit cube.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// The inputs of each factor: groups that are independent of each other.
    pub factors: Vec<Vec<usize>>,
    /// Another one gives other points.
    pub seed: u32,
}

impl Design {
    /// Points of a row.
    pub fn points(&self) -> usize {
        2 + self.factors.len()
    }

    /// Point number `k` of a row.
    pub fn point(k: usize) -> Point {
        match k {
            0 => Point::A,
            1 => Point::B,
            k => Point::Mixed(k - 2),
        }
    }

    /// Where `point` of row number `row` lies, each coordinate within 0..1. Shape (inputs).
    pub fn at(&self, row: usize, point: Point) -> Vec<f64> {
        let inputs: usize = self.factors.iter().map(Vec::len).sum();
        let (sequence, index) = ((row % REPLICATES) as u32, (row / REPLICATES) as u32);
        let seed = self.seed.wrapping_mul(REPLICATES as u32).wrapping_add(sequence);
        let from_b = |input: &usize| match point {
            Point::A => false,
            Point::B => true,
            Point::Mixed(factor) => self.factors[factor].contains(input),
        };
        let coordinate = |input: usize| {
            let dimension = if from_b(&input) { inputs + input } else { input };
            f64::from(sample(index, dimension as u32, seed)) + HALF_STEP
        };
        (0..inputs).map(coordinate).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_is_exchanged_and_nothing_else() {
        let design = Design { factors: vec![vec![0, 2], vec![1]], seed: 3 };
        for row in [0, 7, 16, 99] {
            let [a, b, mixed] = [Point::A, Point::B, Point::Mixed(0)].map(|point| design.at(row, point));
            assert_eq!(mixed, [b[0], a[1], b[2]]);
            assert!(a.iter().chain(&b).all(|x| *x > 0.0 && *x < 1.0));
            assert!(a.iter().zip(&b).all(|(a, b)| a != b));
        }
        assert_ne!(design.at(0, Point::A), Design { seed: 4, ..design.clone() }.at(0, Point::A));
        assert_eq!(
            (0..4).map(Design::point).collect::<Vec<_>>(),
            [Point::A, Point::B, Point::Mixed(0), Point::Mixed(1)]
        );
    }

    /// In every sequence 64 points have one in each 64th of every coordinate, and one in each cell of 8 by 8 of the first two.
    #[test]
    fn sequences_are_sobol_s() {
        let design = Design { factors: vec![vec![0], vec![1], vec![2]], seed: 1 };
        for sequence in 0..REPLICATES {
            let points: Vec<Vec<f64>> =
                (0..64).map(|k| design.at(sequence + REPLICATES * k, Point::A)).collect();
            let cells = |of: &dyn Fn(&[f64]) -> usize| {
                let mut cells: Vec<usize> = points.iter().map(|p| of(p)).collect();
                cells.sort_unstable();
                cells
            };
            for axis in 0..3 {
                assert_eq!(cells(&|p| (64.0 * p[axis]) as usize), (0..64).collect::<Vec<_>>());
            }
            assert_eq!(
                cells(&|p| 8 * (8.0 * p[0]) as usize + (8.0 * p[1]) as usize),
                (0..64).collect::<Vec<_>>()
            );
        }
    }
}
