//! The inductance of a coil over the way of its plunger, which says all of a magnet: its force is i^2 L'(x)/2.

/// L(x) of a coil.
#[derive(Debug, Clone, PartialEq)]
pub enum Inductance {
    /// Cubics of -1/L in H^-1: the reluctance of an even air gap is in proportion to its length.
    Reluctance(Vec<Knot>),
    /// Cubics of L in H.
    Direct(Vec<Knot>),
}

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    way: f64,
    value: f64,
    slope: f64,
}

impl Inductance {
    /// With an even air gap: 1/L falls evenly over the `way` in m between the inductances `ends` in H, of which the second is larger.
    pub fn even_gap([start, end]: [f64; 2], way: f64) -> Self {
        Self::through(&[[0.0, start], [way, end]])
    }

    /// Through `points` of way in m and inductance in H, both rising. Slopes are those of the parabola through a point and its
    /// neighbours, but never so steep that the curve would fall between points (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980); at the
    /// ends those of a slope that goes on changing by the same factor, so that a coil pulls from its start.
    pub fn through(points: &[[f64; 2]]) -> Self {
        let value = |k: usize| -1.0 / points[k][1];
        let length = |k: usize| points[k + 1][0] - points[k][0];
        let secant = |k: usize| (value(k + 1) - value(k)) / length(k);
        let inside = |k: usize| {
            let [before, after] = [k - 1, k].map(|k| (secant(k), length(k)));
            let parabola = (before.0 * after.1 + after.0 * before.1) / (before.1 + after.1);
            parabola.min(3.0 * before.0.min(after.0))
        };
        let end = |secant: f64, next: f64| (secant * secant / next).min(3.0 * secant);
        let last = points.len() - 1;
        let slope = |k: usize| match k {
            _ if last == 1 => secant(0),
            0 => end(secant(0), inside(1)),
            _ if k == last => end(secant(last - 1), inside(last - 1)),
            _ => inside(k),
        };
        let knot = |k: usize| Knot { way: points[k][0], value: value(k), slope: slope(k) };
        Inductance::Reluctance((0..=last).map(knot).collect())
    }

    /// Of a magnet that pulls with `points` of way in m and force in N at a current of 1 A, straight lines between them, and has the
    /// inductance `first` in H at the first: L' = 2 F/i^2.
    pub fn of_forces(first: f64, points: &[[f64; 2]]) -> Self {
        let mut value = first;
        let knots = points.iter().enumerate().map(|(k, &[way, force])| {
            if let Some(&[before, pull]) = k.checked_sub(1).map(|k| &points[k]) {
                value += (force + pull) * (way - before);
            }
            Knot { way, value, slope: 2.0 * force }
        });
        Inductance::Direct(knots.collect())
    }

    /// Where between the start and `travel` m the curve bends.
    pub fn bends(&self, travel: f64) -> impl Iterator<Item = f64> {
        let (Inductance::Reluctance(knots) | Inductance::Direct(knots)) = self;
        knots.iter().map(|knot| knot.way).filter(move |way| 0.0 < *way && *way < travel)
    }

    /// Inductance in H and its slope in H/m, `way` m from the start.
    pub fn at(&self, way: f64) -> [f64; 2] {
        match self {
            Inductance::Direct(knots) => cubic(knots, way),
            Inductance::Reluctance(knots) => {
                let [value, slope] = cubic(knots, way);
                [-1.0 / value, slope / (value * value)]
            }
        }
    }
}

/// Value and slope of Hermite's cubics through `knots` at `way` m.
fn cubic(knots: &[Knot], way: f64) -> [f64; 2] {
    let after = knots.partition_point(|knot| knot.way <= way).clamp(1, knots.len() - 1);
    let [a, b] = [knots[after - 1], knots[after]];
    let h = b.way - a.way;
    let s = (way - a.way) / h;
    let (rise, bend) = (b.value - a.value, a.slope + b.slope);
    let square = 3.0 * rise - h * (a.slope + bend);
    let cube = h * bend - 2.0 * rise;
    let value = a.value + s * (h * a.slope + s * (square + s * cube));
    [value, a.slope + s * (2.0 * square + 3.0 * s * cube) / h]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Points of an even gap give its law, however few they are and whatever their distances.
    #[test]
    fn an_even_gap_stays_even() {
        let of = |x: f64| 1.0 / (50.0 - 16_667.0 * x);
        for ways in [&[0.0, 2e-3][..], &[0.0, 1e-3, 2e-3], &[0.0, 0.4e-3, 0.5e-3, 1.3e-3, 2e-3]] {
            let points: Vec<[f64; 2]> = ways.iter().map(|x| [*x, of(*x)]).collect();
            let curve = Inductance::through(&points);
            for x in [0.0, 0.1e-3, 0.45e-3, 0.9e-3, 2e-3] {
                let [inductance, slope] = curve.at(x);
                assert_relative_eq!(inductance, of(x), max_relative = 1e-12);
                assert_relative_eq!(slope, 16_667.0 * of(x) * of(x), max_relative = 1e-10);
            }
        }
    }

    /// Forces in a straight line make a parabola.
    #[test]
    fn forces_in_a_line_make_a_parabola() {
        let of = |x: f64| [0.02 + 3.0 * x + 500.0 * x * x, 3.0 + 1000.0 * x];
        let curve = Inductance::of_forces(0.02, &[[0.0, 1.5], [2e-3, 0.5 * of(2e-3)[1]]]);
        for x in [0.0, 0.45e-3, 2e-3] {
            assert_relative_eq!(curve.at(x)[0], of(x)[0], max_relative = 1e-12);
            assert_relative_eq!(curve.at(x)[1], of(x)[1], max_relative = 1e-12);
        }
    }

    /// Of a coil that also has an inductance beside the gap the slope is found to second order, at the ends too.
    #[test]
    fn the_slope_is_of_second_order() {
        let of = |x: f64| 5e-3 + 1.0 / (60.0 - 20_000.0 * x);
        let exact = |x: f64| 20_000.0 * (of(x) - 5e-3).powi(2);
        let off = |count: u32| {
            let way = |k: f64| 2e-3 * k / f64::from(count);
            let points: Vec<[f64; 2]> = (0..=count).map(f64::from).map(way).map(|x| [x, of(x)]).collect();
            let curve = Inductance::through(&points);
            let places = (0..=8 * count).map(|k| way(f64::from(k) / 8.0));
            places.map(|x| (curve.at(x)[1] / exact(x) - 1.0).abs()).fold(0.0, f64::max)
        };
        let [coarse, fine] = [16, 32].map(off);
        assert!((coarse / fine).log2() > 1.8 && fine < 2e-3, "{coarse:e} {fine:e}");
    }

    /// However the points rise, the curve rises everywhere, from its start on.
    #[test]
    fn a_curve_that_rises_pulls_everywhere() {
        for points in [
            &[[0.0, 1.0], [1.0, 1.01], [2.0, 3.0], [3.0, 3.01], [4.0, 3.02]][..],
            &[[0.0, 20e-3], [1.0, 21e-3], [4.0, 60e-3]],
            &[[0.0, 20e-3], [1.0, 40e-3], [4.0, 41e-3]],
        ] {
            let curve = Inductance::through(points);
            for k in 0..=400 {
                assert!(curve.at(0.01 * f64::from(k))[1] > 0.0, "{k} of {points:?}");
            }
        }
    }
}
