//! Drawn lines: as few points as the eye can't tell from all of them.

/// Point of the drawing in px.
pub(crate) type Point = (f64, f64);

/// Points of `line` that suffice for a distance of at most `tolerance` (Ramer, Douglas and Peucker).
fn simplified(line: &[Point], tolerance: f64) -> Vec<Point> {
    if line.len() < 3 {
        return line.to_vec();
    }
    let mut keep = vec![false; line.len()];
    keep[0] = true;
    keep[line.len() - 1] = true;
    let mut spans = vec![(0, line.len() - 1)];
    while let Some((a, b)) = spans.pop() {
        let far = (a + 1..b)
            .map(|k| (k, distance(line[k], line[a], line[b])))
            .fold((a, tolerance), |m, (k, d)| if d > m.1 { (k, d) } else { m });
        if far.0 > a {
            keep[far.0] = true;
            spans.extend([(a, far.0), (far.0, b)]);
        }
    }
    line.iter().zip(keep).filter_map(|(p, keep)| keep.then_some(*p)).collect()
}

/// Distance of `p` from the segment `a`-`b`.
fn distance(p: Point, a: Point, b: Point) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length2 = dx * dx + dy * dy;
    let s =
        if length2 > 0.0 { (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (p.0 - a.0 - s * dx).hypot(p.1 - a.1 - s * dy)
}

/// SVG path of the line; points that are not finite are omitted.
pub(crate) fn path(line: &[Point]) -> String {
    path_within(line, 0.08)
}

/// As [`path`], within `tolerance` px of the line.
pub(crate) fn path_within(line: &[Point], tolerance: f64) -> String {
    let finite: Vec<Point> = line.iter().copied().filter(|p| p.0.is_finite() && p.1.is_finite()).collect();
    let mut data = String::new();
    for (k, (x, y)) in simplified(&finite, tolerance).into_iter().enumerate() {
        data.push_str(&format!("{}{x:.2} {y:.2}", if k == 0 { 'M' } else { 'L' }));
    }
    data
}

/// Points of `line` at least `spacing` apart, enough to keep labels away from it.
pub(crate) fn thinned(line: &[Point], spacing: f64) -> Vec<Point> {
    let mut spaced: Vec<Point> = Vec::new();
    for p in line {
        if spaced.last().is_none_or(|k| (p.0 - k.0).hypot(p.1 - k.1) >= spacing) {
            spaced.push(*p);
        }
    }
    spaced
}

#[cfg(test)]
mod tests {
    use super::{path, simplified};

    #[test]
    fn corners_stay_and_straight_parts_go() {
        let line = [(0.0, 0.0), (1.0, 0.01), (2.0, 0.0), (2.0, 5.0), (2.0, 9.0)];
        assert_eq!(simplified(&line, 0.1), [(0.0, 0.0), (2.0, 0.0), (2.0, 9.0)]);
    }

    #[test]
    fn what_is_not_finite_is_not_drawn() {
        assert_eq!(path(&[(0.0, 1.0), (f64::NAN, 2.0), (4.0, 1.0)]), "M0.00 1.00L4.00 1.00");
        assert_eq!(path(&[]), "");
    }
}
