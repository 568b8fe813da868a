//! Places for labels inside a panel, away from the curves.

use super::polyline::Point;

/// Axis-parallel rectangle in px, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Rect {
    fn centred(at: Point, width: f64, height: f64) -> Self {
        Rect { x: at.0 - 0.5 * width, y: at.1 - 0.5 * height, width, height }
    }

    fn contains(&self, other: &Rect) -> bool {
        other.x >= self.x
            && other.y >= self.y
            && other.x + other.width <= self.x + self.width
            && other.y + other.height <= self.y + self.height
    }

    /// Distance of a point from the rectangle; 0 inside.
    fn distance(&self, p: Point) -> f64 {
        let dx = (self.x - p.0).max(p.0 - self.x - self.width).max(0.0);
        let dy = (self.y - p.1).max(p.1 - self.y - self.height).max(0.0);
        dx.hypot(dy)
    }

    /// Distance from another rectangle; 0 if they overlap.
    fn gap(&self, other: &Rect) -> f64 {
        let dx = (self.x - other.x - other.width).max(other.x - self.x - self.width).max(0.0);
        let dy = (self.y - other.y - other.height).max(other.y - self.y - self.height).max(0.0);
        dx.hypot(dy)
    }

    fn clearance<'a>(&self, points: impl IntoIterator<Item = &'a Point>) -> f64 {
        points.into_iter().map(|p| self.distance(*p)).fold(f64::INFINITY, f64::min)
    }
}

/// What is already in a panel.
pub(super) struct Panel {
    /// Room for labels.
    pub(super) area: Rect,
    /// Densely sampled curves.
    pub(super) curves: Vec<Vec<Point>>,
    /// Labels placed before.
    pub(super) taken: Vec<Rect>,
}

impl Panel {
    /// The place of most room for a box, of equal ones the one furthest right; it is then taken.
    pub(super) fn place_box(&mut self, width: f64, height: f64) -> Rect {
        let steps = 24;
        let mut best = (f64::NEG_INFINITY, Rect { x: self.area.x, y: self.area.y, width, height });
        for i in 0..=steps {
            for j in 0..=steps {
                let along = |k: i32, room: f64| room * f64::from(k) / f64::from(steps);
                let rect = Rect {
                    x: self.area.x + along(i, self.area.width - width),
                    y: self.area.y + along(j, self.area.height - height),
                    width,
                    height,
                };
                let score =
                    rect.clearance(self.curves.iter().flatten()).min(self.room_between(&rect)).min(14.0);
                if score >= best.0 {
                    best = (score, rect);
                }
            }
        }
        self.taken.push(best.1);
        best.1
    }

    /// The place for a label beside the curve `own`: close to it, far from all others. It is then taken.
    pub(super) fn place_label(
        &mut self,
        own: &[Point],
        others: &[Vec<Point>],
        width: f64,
        height: f64,
    ) -> Rect {
        let mut best = (f64::NEG_INFINITY, Rect { x: self.area.x, y: self.area.y, width, height });
        for k in (0..own.len()).step_by((own.len() / 120).max(1)) {
            for offset in [-1.0, 1.0] {
                for lift in [0.5 * height + 4.0, 0.5 * height + 9.0, 0.5 * height + 15.0] {
                    let at = (own[k].0, own[k].1 + offset * lift);
                    let rect = Rect::centred(at, width, height);
                    if !self.area.contains(&rect) {
                        continue;
                    }
                    let free = rect.clearance(self.curves.iter().flatten()).min(self.room_between(&rect));
                    let apart = rect.clearance(others.iter().flatten());
                    let score = free.min(6.0) + 0.08 * apart.min(60.0) - 0.02 * lift;
                    if score > best.0 {
                        best = (score, rect);
                    }
                }
            }
        }
        self.taken.push(best.1);
        best.1
    }

    /// Distance of `rect` from the nearest label placed before.
    fn room_between(&self, rect: &Rect) -> f64 {
        self.taken.iter().map(|t| rect.gap(t)).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::{Panel, Rect};

    fn line(y: f64) -> Vec<(f64, f64)> {
        (0..=300).map(|x| (f64::from(x), y)).collect()
    }

    #[test]
    fn labels_overlap_neither_curves_nor_each_other() {
        let curves = vec![line(50.0), line(100.0)];
        let area = Rect { x: 0.0, y: 0.0, width: 300.0, height: 200.0 };
        let mut panel = Panel { area, curves: curves.clone(), taken: Vec::new() };
        let boxed = panel.place_box(120.0, 40.0);
        let first = panel.place_label(&curves[0], &curves[1..], 40.0, 12.0);
        let second = panel.place_label(&curves[1], &curves[..1], 40.0, 12.0);
        for rect in [boxed, first, second] {
            assert!(area.contains(&rect));
            assert!(rect.clearance(curves.iter().flatten()) >= 3.0, "{rect:?}");
        }
        assert!(boxed.gap(&first) > 0.0 && boxed.gap(&second) > 0.0 && first.gap(&second) > 0.0);
        assert!(first.clearance(&curves[0]) < first.clearance(&curves[1]));
        assert!(second.clearance(&curves[1]) < second.clearance(&curves[0]));
    }
}
