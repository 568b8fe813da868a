//! The inductance of a coil over the way of its plunger, which says all of a magnet: its force is i^2 L'(x)/2.

/// L(x) of a coil.
#[derive(Debug, Clone, PartialEq)]
pub enum Inductance {
    /// 1/L falls evenly: the reluctance of an even air gap is in proportion to its length.
    EvenGap {
        /// With the plunger at the start and at the end, where it is larger, H.
        ends: [f64; 2],
        /// Way from the start to the end in m.
        way: f64,
    },
    /// Points, cubics between them.
    Curve(Vec<Knot>),
}

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    way: f64,
    inductance: f64,
    slope: f64,
}

impl Inductance {
    /// Through `points` of way in m and inductance in H, both rising. Slopes are those of the parabola through a point and its
    /// neighbours, but never so steep that the curve would fall between points (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980).
    pub fn through(points: &[[f64; 2]]) -> Self {
        let secants: Vec<f64> =
            points.windows(2).map(|p| (p[1][1] - p[0][1]) / (p[1][0] - p[0][0])).collect();
        let last = secants.len() - 1;
        let knot = |k: usize| {
            // at the ends the parabola of the next point
            let middle = k.clamp(1, last.max(1)).min(last);
            let [before, after] = [secants[middle.saturating_sub(1)], secants[middle]];
            let [low, here, high] = [middle.saturating_sub(1), middle, middle + 1].map(|k| points[k][0]);
            let bend = if middle == 0 { 0.0 } else { (after - before) / (high - low) };
            let slope = after + bend * (2.0 * points[k][0] - here - high);
            let around = [secants[k.saturating_sub(1).min(last)], secants[k.min(last)]];
            let steepest = 3.0 * around[0].min(around[1]);
            Knot { way: points[k][0], inductance: points[k][1], slope: slope.clamp(0.0, steepest) }
        };
        Inductance::Curve((0..points.len()).map(knot).collect())
    }

    /// Of a magnet that pulls with `points` of way in m and force in N at a current of 1 A, straight lines between them, and has the
    /// inductance `first` in H at the first: L' = 2 F/i^2.
    pub fn of_forces(first: f64, points: &[[f64; 2]]) -> Self {
        let mut inductance = first;
        let knots = points.iter().enumerate().map(|(k, &[way, force])| {
            if let Some(&[before, pull]) = k.checked_sub(1).map(|k| &points[k]) {
                inductance += (force + pull) * (way - before);
            }
            Knot { way, inductance, slope: 2.0 * force }
        });
        Inductance::Curve(knots.collect())
    }

    /// Where between the start and `travel` m the curve bends.
    pub fn bends(&self, travel: f64) -> impl Iterator<Item = f64> {
        let knots = if let Inductance::Curve(knots) = self { &knots[..] } else { &[] };
        knots.iter().map(|knot| knot.way).filter(move |way| 0.0 < *way && *way < travel)
    }

    /// Inductance in H and its slope in H/m, `way` m from the start.
    pub fn at(&self, way: f64) -> [f64; 2] {
        match self {
            Inductance::EvenGap { ends: [start, end], way: length } => {
                let slope = (1.0 / start - 1.0 / end) / length;
                let inductance = 1.0 / (1.0 / start - slope * way);
                [inductance, slope * inductance * inductance]
            }
            Inductance::Curve(knots) => {
                let after = knots.partition_point(|knot| knot.way <= way).clamp(1, knots.len() - 1);
                let [a, b] = [knots[after - 1], knots[after]];
                let h = b.way - a.way;
                let s = (way - a.way) / h;
                let (rise, bend) = (b.inductance - a.inductance, a.slope + b.slope);
                // Hermite's cubic in powers of s
                let square = 3.0 * rise - h * (a.slope + bend);
                let cube = h * bend - 2.0 * rise;
                let inductance = a.inductance + s * (h * a.slope + s * (square + s * cube));
                [inductance, a.slope + s * (2.0 * square + 3.0 * s * cube) / h]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A parabola's points give the parabola, whatever their distances; forces in a straight line give it too.
    #[test]
    fn a_parabola_is_kept() {
        let of = |x: f64| [0.02 + 3.0 * x + 500.0 * x * x, 3.0 + 1000.0 * x];
        let ways = [0.0, 0.4e-3, 0.5e-3, 1.3e-3, 2e-3];
        let through = Inductance::through(&ways.map(|x| [x, of(x)[0]]));
        let of_forces = Inductance::of_forces(0.02, &[[0.0, 1.5], [2e-3, 0.5 * of(2e-3)[1]]]);
        for x in [0.0, 0.1e-3, 0.45e-3, 0.9e-3, 2e-3] {
            for curve in [&through, &of_forces] {
                let [inductance, slope] = curve.at(x);
                assert_relative_eq!(inductance, of(x)[0], max_relative = 1e-12);
                assert_relative_eq!(slope, of(x)[1], max_relative = 1e-12);
            }
        }
        let line = Inductance::through(&[[0.0, 1.0], [2.0, 5.0]]);
        assert_eq!(line.at(0.5), [2.0, 2.0]);
    }

    /// Where the points rise steeply and then hardly, the curve still rises.
    #[test]
    fn a_curve_that_rises_never_falls() {
        let curve = Inductance::through(&[[0.0, 1.0], [1.0, 1.01], [2.0, 3.0], [3.0, 3.01], [4.0, 3.02]]);
        for k in 0..=400 {
            assert!(curve.at(0.01 * f64::from(k))[1] >= -1e-12, "{k}");
        }
    }
}
