//! The chamber in section: walls in the plane of symmetry, where a sphere off a cone's axis touches the cone.
//!
//! A closed polygon with the free space to the left of each wall. Its corners are sharp: around one that juts out the sphere's
//! centre moves on an arc of the sphere's radius.

use super::Vector;

/// Walls of a chamber for a sphere of one radius.
#[derive(Debug, Clone, PartialEq)]
pub struct Chamber {
    /// Corners in m, counterclockwise. Shape (n).
    corners: Vec<Vector>,
    radius: f64,
    /// Centres of a sphere that rests in the seat it starts from and in the other one.
    seats: [Vector; 2],
}

/// Why a chamber can't be, in a sentence without end.
#[derive(Debug, Clone, PartialEq)]
pub struct TooNarrow(pub String);

/// What of the chamber a sphere touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ChamberFeature {
    /// The wall of this number, from the corner of the same number on.
    Wall(usize),
    /// The corner of this number.
    Edge(usize),
}

/// Nearest point of a wall.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    pub(super) point: Vector,
    pub(super) feature: ChamberFeature,
}

impl Chamber {
    /// The floor from left to right (its ends are the side walls), and the ceiling at `height`.
    ///
    /// # Errors
    /// [`TooNarrow`] if a sphere can't rest in a seat or can't be between floor and ceiling.
    pub fn new(floor: &[Vector], height: f64, radius: f64, seats: [Vector; 2]) -> Result<Self, TooNarrow> {
        let [Some(first), Some(last)] = [floor.first(), floor.last()] else {
            return Err(TooNarrow("the chamber has no floor".into()));
        };
        let mut corners = floor.to_vec();
        corners.extend([Vector::new(last.x, height), Vector::new(first.x, height)]);
        let chamber = Chamber { corners, radius, seats };
        let mm = |length: f64| format!("{} mm", (length * 1e7).round() / 1e4);
        for (seat, name) in chamber.seats.iter().zip(["its seat", "the other seat"]) {
            let room =
                (0..chamber.walls()).map(|wall| chamber.gap(wall, *seat)).fold(f64::INFINITY, f64::min);
            if room < -1e-9 * radius.max(1e-3) {
                return Err(TooNarrow(format!(
                    "the chamber is too narrow: a sphere of radius {} in {name} (x = {}, z = {}) reaches {} into a wall",
                    mm(radius),
                    mm(seat.x),
                    mm(seat.y),
                    mm(-room)
                )));
            }
        }
        let [low, high] = chamber.columns();
        let highest = (0..=200).map(|k| chamber.floor(low + (high - low) * f64::from(k) / 200.0));
        let highest = highest.fold(f64::NEG_INFINITY, f64::max);
        if highest >= chamber.ceiling() {
            return Err(TooNarrow(format!(
                "a sphere of radius {} does not pass under the ceiling at z = {}: it needs a height of more than {}",
                mm(radius),
                mm(height),
                mm(highest + radius)
            )));
        }
        Ok(chamber)
    }

    /// The chamber over a rocker (Fig. 4): a flat floor at z = 0, and walls between which a sphere of `radius` m has a
    /// `travel` in m from one position to the other; the impact comes through the wall at x < 0.
    ///
    /// # Errors
    /// As [`Chamber::new`].
    pub fn over_rocker(travel: f64, height: f64, radius: f64) -> Result<Self, TooNarrow> {
        let (half, wall) = (0.5 * travel, 0.5 * travel + radius);
        let floor = [Vector::new(-wall, 0.0), Vector::new(wall, 0.0)];
        Chamber::new(&floor, height, radius, [Vector::new(-half, radius), Vector::new(half, radius)])
    }

    /// Centres in m of a sphere in the seat it starts from and in the other one.
    pub fn seats(&self) -> [Vector; 2] {
        self.seats
    }

    /// The corners in m, counterclockwise. Shape (n).
    pub fn corners(&self) -> &[Vector] {
        &self.corners
    }

    /// x in m between which the sphere's centre can be.
    pub fn columns(&self) -> [f64; 2] {
        let x = self.corners.iter().map(|corner| corner.x);
        let (low, high) = x.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        [low + self.radius, high - self.radius]
    }

    /// Highest z in m of the sphere's centre.
    pub fn ceiling(&self) -> f64 {
        self.corners[self.corners.len() - 1].y - self.radius
    }

    /// Lowest z in m of the sphere's centre at `x`.
    pub fn floor(&self, x: f64) -> f64 {
        let mut highest = f64::NEG_INFINITY;
        for wall in 0..self.walls() - 3 {
            let (start, along, normal) = (self.corners[wall], self.along(wall), self.normal(wall));
            let across = x - start.x;
            if across.abs() <= self.radius {
                highest = highest.max(start.y + (self.radius.powi(2) - across.powi(2)).sqrt());
            }
            if along.x.abs() > 1e-12 {
                let s = (across - self.radius * normal.x) / along.x;
                if (0.0..=self.length(wall)).contains(&s) {
                    highest = highest.max(start.y + s * along.y + self.radius * normal.y);
                }
            }
        }
        highest
    }

    /// Whether a launch at `angle` rad against z from the seat goes straight into a wall that the sphere touches there.
    pub(super) fn is_next_to_wall(&self, angle: f64) -> bool {
        let along = Vector::new(angle.sin(), angle.cos());
        (0..self.walls()).filter(|wall| self.gap(*wall, self.seats[0]) < 1e-6 * self.radius).any(|wall| {
            let arm = self.seats[0] - self.nearest(wall, self.seats[0]).point;
            arm.dot(&along) < -1e-9 * arm.norm()
        })
    }

    pub(super) fn walls(&self) -> usize {
        self.corners.len()
    }

    pub(super) fn radius(&self) -> f64 {
        self.radius
    }

    pub(super) fn corner(&self, number: usize) -> Vector {
        self.corners[number % self.corners.len()]
    }

    pub(super) fn length(&self, wall: usize) -> f64 {
        (self.corner(wall + 1) - self.corner(wall)).norm()
    }

    /// Direction of a wall, of length 1.
    pub(super) fn along(&self, wall: usize) -> Vector {
        (self.corner(wall + 1) - self.corner(wall)).normalize()
    }

    /// Normal of a wall into the chamber, of length 1.
    pub(super) fn normal(&self, wall: usize) -> Vector {
        let along = self.along(wall);
        Vector::new(-along.y, along.x)
    }

    /// The wall that ends at a corner.
    pub(super) fn before(&self, corner: usize) -> usize {
        (corner + self.walls() - 1) % self.walls()
    }

    /// Angle in rad by which the walls turn away from each other at a corner; not positive where they face each other.
    pub(super) fn jut(&self, corner: usize) -> f64 {
        let (before, after) = (self.along(self.before(corner)), self.along(corner));
        -before.perp(&after).atan2(before.dot(&after))
    }

    /// The point of `wall` nearest to `place`.
    pub(super) fn nearest(&self, wall: usize, place: Vector) -> Nearest {
        let (start, along, length) = (self.corner(wall), self.along(wall), self.length(wall));
        let s = (place - start).dot(&along);
        if s <= 0.0 {
            Nearest { point: start, feature: ChamberFeature::Edge(wall) }
        } else if s >= length {
            let end = (wall + 1) % self.walls();
            Nearest { point: self.corner(end), feature: ChamberFeature::Edge(end) }
        } else {
            Nearest { point: start + s * along, feature: ChamberFeature::Wall(wall) }
        }
    }

    /// Distance in m of `wall` from a sphere at `place`.
    pub(super) fn gap(&self, wall: usize, place: Vector) -> f64 {
        (place - self.nearest(wall, place).point).norm() - self.radius
    }

    /// Whether `wall` has `feature`.
    pub(super) fn belongs(&self, wall: usize, feature: ChamberFeature) -> bool {
        match feature {
            ChamberFeature::Wall(own) => own == wall,
            ChamberFeature::Edge(corner) => wall == corner || wall == self.before(corner),
        }
    }
}
