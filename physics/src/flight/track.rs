//! The line or arc on which the centre of a sphere moves that stays on a wall or an edge.

use super::Vector;
use super::chamber::{Chamber, ChamberFeature};

/// Path of the centre along a wall (straight) or around an edge (an arc of the sphere's radius).
#[derive(Debug, Clone, Copy)]
pub(super) struct Track {
    pub(super) feature: ChamberFeature,
    /// The wall's start, or the edge.
    origin: Vector,
    /// Normal where the path begins.
    normal: Vector,
    radius: f64,
    /// Its length in m.
    pub(super) length: f64,
}

impl Track {
    pub(super) fn of(chamber: &Chamber, feature: ChamberFeature) -> Self {
        let radius = chamber.radius();
        match feature {
            ChamberFeature::Wall(wall) => Track {
                feature,
                origin: chamber.corner(wall),
                normal: chamber.normal(wall),
                radius,
                length: chamber.length(wall),
            },
            ChamberFeature::Edge(corner) => Track {
                feature,
                origin: chamber.corner(corner),
                normal: chamber.normal(chamber.before(corner)),
                radius,
                length: radius * chamber.jut(corner).max(0.0),
            },
        }
    }

    /// Curvature in 1/m: how much the path bends away from the free space.
    pub(super) fn curvature(&self) -> f64 {
        if matches!(self.feature, ChamberFeature::Edge(_)) { 1.0 / self.radius } else { 0.0 }
    }

    /// Normal into the chamber at `q` m from the path's begin.
    pub(super) fn normal(&self, q: f64) -> Vector {
        let (sin, cos) = (q * self.curvature()).sin_cos();
        Vector::new(cos * self.normal.x + sin * self.normal.y, cos * self.normal.y - sin * self.normal.x)
    }

    /// Direction of the path at `q`.
    pub(super) fn tangent(&self, q: f64) -> Vector {
        tangent(self.normal(q))
    }

    /// The centre at `q`.
    pub(super) fn place(&self, q: f64) -> Vector {
        let along = if self.curvature() == 0.0 { q * tangent(self.normal) } else { Vector::zeros() };
        self.origin + along + self.radius * self.normal(q)
    }

    /// Where on the path a sphere at `place` is.
    pub(super) fn along(&self, place: Vector) -> f64 {
        let arm = place - self.origin;
        if self.curvature() == 0.0 {
            arm.dot(&tangent(self.normal))
        } else {
            self.radius * arm.dot(&tangent(self.normal)).atan2(arm.dot(&self.normal))
        }
    }

    /// What the path goes on with beyond its end (or, `backwards`, before its begin).
    pub(super) fn next(&self, chamber: &Chamber, backwards: bool) -> ChamberFeature {
        match (self.feature, backwards) {
            (ChamberFeature::Wall(wall), true) => ChamberFeature::Edge(wall),
            (ChamberFeature::Wall(wall), false) => ChamberFeature::Edge((wall + 1) % chamber.walls()),
            (ChamberFeature::Edge(corner), true) => ChamberFeature::Wall(chamber.before(corner)),
            (ChamberFeature::Edge(corner), false) => ChamberFeature::Wall(corner),
        }
    }
}

/// Direction along a surface with this `normal`: to the right on a floor.
pub(super) fn tangent(normal: Vector) -> Vector {
    Vector::new(normal.y, -normal.x)
}
