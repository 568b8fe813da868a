//! The 95 % bands of a reference's curves, as its store has them beside the history.

use crate::curves::CommonAxis;

/// Half widths of the 95 % bands of the curves of a history, at its instants.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveBands {
    time: Vec<f64>,
    widths: Vec<(&'static str, Vec<f64>)>,
}

impl CurveBands {
    /// `widths` by the name of the curve of `history.csv`, in its unit, each of shape (time.len());
    /// `time` in s, strictly increasing.
    pub fn new(time: Vec<f64>, widths: Vec<(&'static str, Vec<f64>)>) -> Self {
        CurveBands { time, widths }
    }

    /// The curves and the largest half width of their bands, in their units.
    pub(super) fn widest(&self) -> impl Iterator<Item = (&'static str, f64)> {
        self.widths.iter().map(|(curve, widths)| (*curve, widths.iter().copied().fold(0.0, f64::max)))
    }

    /// Half width of the band of `curve` at the instants of `axis`, linear between the samples and constant beyond them.
    /// `None` if it has none. Shape (axis.samples).
    pub fn sampled(&self, curve: &str, axis: &CommonAxis) -> Option<Vec<f64>> {
        let (_, widths) = self.widths.iter().find(|(name, _)| *name == curve)?;
        let at = |t: f64| {
            let next = self.time.partition_point(|&s| s < t);
            match next {
                0 => widths[0],
                k if k == self.time.len() => widths[k - 1],
                k => {
                    let share = (t - self.time[k - 1]) / (self.time[k] - self.time[k - 1]);
                    widths[k - 1] + share * (widths[k] - widths[k - 1])
                }
            }
        };
        let same_length = !widths.is_empty() && widths.len() == self.time.len();
        same_length.then(|| (0..axis.samples).map(|k| at(axis.time(k))).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::CurveBands;
    use crate::curves::CommonAxis;

    #[test]
    fn widths_are_linear_between_samples_and_constant_beyond() {
        let bands = CurveBands::new(vec![0.0, 1.0, 3.0], vec![("outer_force", vec![1.0, 3.0, 7.0])]);
        let axis = CommonAxis { start: 0.0, end: 4.0, samples: 9 };
        let widths = bands.sampled("outer_force", &axis).expect("it has this band");
        assert_eq!(widths, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 7.0, 7.0]);
        assert_eq!(bands.sampled("inner_force", &axis), None);
    }
}
