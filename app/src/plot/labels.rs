//! Places for labels inside a panel, away from the curves.

use crate::plot::polyline::Point;

/// Axis-parallel rectangle in px, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rect {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
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

    /// Squared distance of a point from the rectangle; 0 inside.
    fn distance_squared(&self, p: Point) -> f64 {
        let dx = (self.x - p.0).max(p.0 - self.x - self.width).max(0.0);
        let dy = (self.y - p.1).max(p.1 - self.y - self.height).max(0.0);
        dx * dx + dy * dy
    }

    /// Squared distance from another rectangle; 0 if they overlap.
    fn gap_squared(&self, other: &Rect) -> f64 {
        let dx = (self.x - other.x - other.width).max(other.x - self.x - self.width).max(0.0);
        let dy = (self.y - other.y - other.height).max(other.y - self.y - self.height).max(0.0);
        dx * dx + dy * dy
    }

    /// Distance of the nearest point.
    fn clearance<'a>(&self, points: impl IntoIterator<Item = &'a Point>) -> f64 {
        self.clearance_from(points, 0.0).unwrap_or(0.0)
    }

    /// Distance of the nearest point; `None` as soon as one is nearer than `least`.
    fn clearance_from<'a>(&self, points: impl IntoIterator<Item = &'a Point>, least: f64) -> Option<f64> {
        // equal distances pass, however the square is rounded
        let bound = least.max(0.0).powi(2) * (1.0 - 1e-12);
        let mut nearest = f64::INFINITY;
        for point in points {
            nearest = nearest.min(self.distance_squared(*point));
            if nearest < bound {
                return None;
            }
        }
        Some(nearest.sqrt())
    }
}

/// Distances of a label from its curve that are tried, px.
const DISTANCES: [f64; 7] = [4.0, 8.0, 13.0, 22.0, 34.0, 50.0, 70.0];
/// Distance from which on a line leads from the label to its curve, px.
const LEADER_FROM: f64 = 10.0;

/// Clearance of a box that is enough, px.
const ENOUGH_ROOM: f64 = 14.0;
/// By how much nearer to its own curve than to others a label counts at least and at most, px.
const APART: (f64, f64) = (-20.0, 30.0);

/// Score of a label for a px of clearance.
const CLEAR: f64 = 10.0;

/// Where a label stands.
pub(crate) struct Label {
    pub(crate) rect: Rect,
    /// From the label to its curve, if it stands too far away to be taken for its own.
    pub(crate) leader: Option<(Point, Point)>,
}

/// What is already in a panel.
pub(crate) struct LabelRoom {
    /// Room for labels.
    pub(crate) area: Rect,
    /// Densely sampled curves.
    pub(crate) curves: Vec<Vec<Point>>,
    /// Labels placed before.
    pub(crate) taken: Vec<Rect>,
}

impl LabelRoom {
    /// The place of most room for a box, of equal ones the one furthest right, with the room it has
    /// on all sides in px.
    pub(crate) fn find_box(&self, width: f64, height: f64) -> (f64, Rect) {
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
                let between = self.room_between(&rect).min(ENOUGH_ROOM);
                if between < best.0 {
                    continue;
                }
                let Some(free) = rect.clearance_from(self.curves.iter().flatten(), best.0) else {
                    continue;
                };
                if free.min(between) >= best.0 {
                    best = (free.min(between), rect);
                }
            }
        }
        best
    }

    /// The place for a label beside the curve `own`: close to it, clear of all curves, and nearer to it
    /// than to the curves in `others`. It is then taken.
    pub(crate) fn place_label(
        &mut self,
        own: &[Point],
        others: &[Vec<Point>],
        width: f64,
        height: f64,
    ) -> Label {
        let nowhere = Rect { x: self.area.x, y: self.area.y, width, height };
        let mut best = (f64::NEG_INFINITY, Label { rect: nowhere, leader: None });
        for &point in own.iter().step_by((own.len() / 100).max(1)) {
            for (side, distance) in [-1.0, 1.0].into_iter().flat_map(|s| DISTANCES.map(|d| (s, d))) {
                let at = (point.0, point.1 + side * (0.5 * height + distance));
                let rect = Rect::centred(at, width, height);
                if !self.area.contains(&rect) {
                    continue;
                }
                let score = |free: f64, apart: f64| CLEAR * free.min(2.5) + apart / 5.0 - 0.15 * distance;
                // most places can't be the best, whatever the curves
                let between = self.room_between(&rect);
                if score(between, APART.1) <= best.0 {
                    continue;
                }
                // the clearance that a better score needs
                let least = (best.0 - score(0.0, APART.1)) / CLEAR;
                let Some(free) = rect.clearance_from(self.curves.iter().flatten(), least) else {
                    continue;
                };
                let free = free.min(between);
                let near = rect.clearance(own);
                let apart = rect.clearance(others.iter().flatten()) - near;
                let score = score(free, apart.clamp(APART.0, APART.1));
                if score > best.0 {
                    let edge = (point.0, at.1 - side * 0.5 * height);
                    let leader = (near > LEADER_FROM).then_some((edge, point));
                    best = (score, Label { rect, leader });
                }
            }
        }
        self.taken.push(best.1.rect);
        best.1
    }

    /// Distance of `rect` from the nearest label placed before.
    fn room_between(&self, rect: &Rect) -> f64 {
        self.taken.iter().map(|t| rect.gap_squared(t)).fold(f64::INFINITY, f64::min).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::{LabelRoom, Rect};

    fn line(y: f64) -> Vec<(f64, f64)> {
        (0..=300).map(|x| (f64::from(x), y)).collect()
    }

    #[test]
    fn labels_overlap_neither_curves_nor_each_other() {
        let curves = vec![line(50.0), line(100.0)];
        let area = Rect { x: 0.0, y: 0.0, width: 300.0, height: 200.0 };
        let mut panel = LabelRoom { area, curves: curves.clone(), taken: Vec::new() };
        let (_, boxed) = panel.find_box(120.0, 40.0);
        panel.taken.push(boxed);
        let first = panel.place_label(&curves[0], &curves[1..], 40.0, 12.0).rect;
        let second = panel.place_label(&curves[1], &curves[..1], 40.0, 12.0).rect;
        for rect in [boxed, first, second] {
            assert!(area.contains(&rect));
            assert!(rect.clearance(curves.iter().flatten()) >= 3.0, "{rect:?}");
        }
        assert!(
            boxed.gap_squared(&first) > 0.0
                && boxed.gap_squared(&second) > 0.0
                && first.gap_squared(&second) > 0.0
        );
        assert!(first.clearance(&curves[0]) < first.clearance(&curves[1]));
        assert!(second.clearance(&curves[1]) < second.clearance(&curves[0]));
    }
}
