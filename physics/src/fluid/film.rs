//! Squeeze film between the plate and the inner body: the modified Reynolds equation, eqs. (3) and (4) of the paper,
//!     d/dr (r h^3/mu dp/dr) = 12 r dh/dt,
//! by finite volumes in r.
//!
//! The pressure is that of the rim, 0, at the edge of the film, and nothing flows through the axis. Where the bodies
//! overlap there is no film: its domain begins at the edge of the overlap, through which nothing flows either. The
//! flow resistance is that of the gap h* = max(h, minimal gap): finite for every gap, with what is squeezed out
//! being the true dh/dt. So the film takes power p dh/dt from the bodies at exactly the rate at which it
//! dissipates it, h*^3/(12 mu) (dp/dr)^2, cell by cell: the film can't feed the motion, whatever the gap.
//!
//! In one dimension the flow through every cell face follows from the volume squeezed out inside of it, and the
//! pressure from the flow: no system of equations, and the viscosity of a generalised Newtonian fluid follows from
//! the flow without iteration. Cells are placed anew for every gap, their size is in relation to the width
//! sqrt(2 R h) of the pressure and grows outwards, and the force is a smooth function of the motion.

use super::viscosity::Viscosity;
use std::f64::consts::PI;

/// Gap of the film and its rate as functions of the radius r in m, without the curvature of the inner body.
pub trait Profile {
    /// Gap at r in m: negative where the bodies overlap.
    fn gap(&self, r: f64) -> f64;
    /// Rate of the gap at r in m/s.
    fn rate(&self, r: f64) -> f64;
}

/// Film between the plate and an inner body with a spherical tip.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    viscosity: Viscosity,
    minimum_gap: f64,
    tip_radius: f64,
    rim: f64,
    cells: usize,
}

/// Loads of the film at the centres of its cells.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FilmForces {
    /// Radius of the cell's centre in m. Shape (cells), or empty where there is no film.
    pub radius: Vec<f64>,
    /// Force of each cell that pushes the bodies apart, N. Shape (cells).
    pub load: Vec<f64>,
    /// The same per closing speed of 1 m/s that is equal everywhere, at the present viscosity, N s/m. Shape (cells).
    pub unit_load: Vec<f64>,
    /// Sum of `load`, N.
    pub force: f64,
    /// Sum of `unit_load`, N s/m.
    pub resistance: f64,
    /// Power dissipated in W.
    pub dissipation: f64,
    /// Where the bodies overlap most beside the contact on the axis. Up to the minimal gap that is no more than the film's
    /// equation leaves open.
    pub overlap: Option<Overlap>,
    /// Flow through the outer face of each cell. Shape (cells), or empty where there is no film.
    pub faces: Vec<Face>,
}

/// Overlap of plate and inner body beside the contact on the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Radius in m.
    pub radius: f64,
    /// Within the overlap around the axis how much deeper than there, else how deep, m.
    pub depth: f64,
}

/// Where the film narrows most towards its edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neck {
    /// Radius in m.
    pub radius: f64,
    /// Width of the film there in m.
    pub width: f64,
    /// Largest width farther in, m.
    pub width_inside: f64,
}

/// Flow through the outer face of a cell of the film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    /// Radius of the face in m.
    pub radius: f64,
    /// Area of the cell inside of it in m^2.
    pub area: f64,
    /// Width of the film there in m, the minimal gap at least.
    pub width: f64,
    /// Fall of the pressure to the next cell in Pa.
    pub fall: f64,
    /// Change of the fall per flow outwards, Pa s/m^3.
    pub per_flow: f64,
    /// Change of the fall per widening of the gap at the face, Pa/m.
    pub per_gap: f64,
    /// Fall against a uniform closing speed of 1 m/s at the present viscosity, Pa s/m.
    unit_fall: f64,
}

impl FilmForces {
    /// Where the film is narrowest in relation to its width farther in; `None` without a film.
    pub fn neck(&self) -> Option<Neck> {
        let mut width_inside: f64 = 0.0;
        let necks = self.faces.iter().map(|face| {
            width_inside = width_inside.max(face.width);
            Neck { radius: face.radius, width: face.width, width_inside }
        });
        necks.min_by(|a, b| (a.width / a.width_inside).total_cmp(&(b.width / b.width_inside)))
    }
}

/// Cells of the film unless asked for otherwise.
pub const CELLS: usize = 64;
/// Parts into which an overlap is divided to look for its deepest place, or for its end.
const OVERLAP_SAMPLES: u32 = 8;
/// First length of the graded cells over the width of the pressure, both in r^2.
const FINENESS: f64 = 1.0;

impl Film {
    /// Film of `viscosity` under a tip of radius `tip_radius` m that ends at the radius `rim` m (at most that of the
    /// tip), with the minimal gap of eq. (4) in m, on `cells` cells.
    pub fn new(viscosity: Viscosity, minimum_gap: f64, tip_radius: f64, rim: f64, cells: usize) -> Self {
        Self { viscosity, minimum_gap, tip_radius, rim: rim.min(tip_radius), cells }
    }

    /// Radius of the film's edge in m.
    pub fn rim(&self) -> f64 {
        self.rim
    }

    /// The minimal gap in m.
    pub fn minimum_gap(&self) -> f64 {
        self.minimum_gap
    }

    /// The deeper one of `before` and the overlap with `gap` m at `radius` m, if that is one: below `level` m.
    fn deeper(before: Option<Overlap>, level: f64, radius: f64, gap: f64) -> Option<Overlap> {
        let depth = level - gap;
        if depth > before.map_or(0.0, |o| o.depth) { Some(Overlap { radius, depth }) } else { before }
    }

    /// The deepest overlap inside r^2 = `start`.
    fn deepest_inside(gap: impl Fn(f64) -> f64, axis_gap: f64, start: f64) -> Option<Overlap> {
        (1..OVERLAP_SAMPLES)
            .map(|i| start * f64::from(i) / f64::from(OVERLAP_SAMPLES))
            .fold(None, |found, square| Self::deeper(found, axis_gap, square.sqrt(), gap(square)))
    }

    /// Solves for the pressure and writes its loads into `forces`.
    pub fn solve(&self, profile: &impl Profile, forces: &mut FilmForces) {
        forces.radius.clear();
        forces.load.clear();
        forces.unit_load.clear();
        forces.faces.clear();
        (forces.force, forces.resistance, forces.dissipation, forces.overlap) = (0.0, 0.0, 0.0, None);
        // the tip is a paraboloid, which is what lubrication theory resolves of a sphere: with the sphere's own
        // shape the force would be further from Stokes flow (Brenner 1961), 2.4 % too low at a gap of R/700
        let curvature = 0.5 / self.tip_radius;
        let gap = |square: f64| profile.gap(square.sqrt()) + curvature * square;
        let end = self.rim * self.rim;
        let axis_gap = gap(0.0);
        // where the overlap would end on a flat plate
        let flat = (-axis_gap).max(0.0) / curvature;
        let start = if flat > 0.0 { edge_of_overlap(gap, axis_gap, flat, end) } else { 0.0 };
        forces.overlap = (start > flat).then(|| Self::deepest_inside(gap, axis_gap, start)).flatten();
        // nothing is wet, or nothing that matters
        if start >= end * (1.0 - 1e-9) {
            // up to the rim the plate lies on the tip: how far it may is left to Hertz's contact, but where an open
            // film closes there the law jumps
            let depth = (-gap(end)).clamp(0.0, self.minimum_gap);
            forces.overlap = forces.overlap.or(Some(Overlap { radius: end.sqrt(), depth }));
            return;
        }
        // cell faces in r^2: start + first (growth^k - 1)
        let scale = 2.0 * FINENESS * self.tip_radius * axis_gap.max(0.0).hypot(self.minimum_gap);
        let growth = ((end - start) / scale).ln_1p() / self.cells as f64;
        let (ratio, mut power) = (growth.exp(), 1.0);
        let mut face = start;
        let (mut flow, mut unit_flow) = (0.0, 0.0);
        for cell in 0..self.cells {
            power *= ratio;
            let next = if cell + 1 == self.cells { end } else { start + scale * (power - 1.0) };
            let after = if cell + 1 == self.cells { end } else { start + scale * (power * ratio - 1.0) };
            let (centre, next_centre) = (0.5 * (face + next), 0.5 * (next + after));
            let area = PI * (next - face);
            let radius = centre.sqrt();
            // what is squeezed out inside of the outer face flows through it
            flow -= profile.rate(radius) * area;
            unit_flow += area;
            let (face_radius, face_gap) = (next.sqrt(), gap(next));
            if face_gap < 0.0 {
                forces.overlap = Self::deeper(forces.overlap, 0.0, face_radius, face_gap);
            }
            let width = face_gap.max(self.minimum_gap);
            let rate = 6.0 * flow.abs() / (2.0 * PI * face_radius * width * width);
            let (viscosity, slope) = self.viscosity.with_slope(rate);
            // with x = r^2: flow = -2 pi r h^3/(12 mu) dp/dr = -pi x h^3/(3 mu) dp/dx
            let resistance = 3.0 * viscosity * (next_centre - centre) / (PI * next * width.powi(3));
            let fall = flow * resistance;
            forces.dissipation += flow * fall;
            forces.faces.push(Face {
                radius: face_radius,
                area,
                width,
                fall,
                unit_fall: unit_flow * resistance,
                per_flow: (1.0 + slope) * resistance,
                per_gap: if face_gap > self.minimum_gap { -(3.0 + 2.0 * slope) * fall / width } else { 0.0 },
            });
            forces.radius.push(radius);
            face = next;
        }
        forces.load.resize(self.cells, 0.0);
        forces.unit_load.resize(self.cells, 0.0);
        let mut pressure = [0.0; 2];
        for (cell, face) in forces.faces.iter().enumerate().rev() {
            pressure = [pressure[0] + face.fall, pressure[1] + face.unit_fall];
            forces.load[cell] = pressure[0] * face.area;
            forces.unit_load[cell] = pressure[1] * face.area;
            forces.force += forces.load[cell];
            forces.resistance += forces.unit_load[cell];
        }
    }
}

/// Where in r^2, between 0 and `end`, the overlap around the axis ends: the gap, `axis_gap` < 0 there, is zero for the first
/// time. `flat` is where it would end on a flat plate. `end` if there is an overlap up to the end.
///
/// The waves of the plate can bring it to the other body farther out again; that is no end of this overlap.
fn edge_of_overlap(gap: impl Fn(f64) -> f64, axis_gap: f64, flat: f64, end: f64) -> f64 {
    let mut low = (0.0, axis_gap);
    let mut high = (flat.min(end), gap(flat.min(end)));
    // a plate that bends around the body may leave it and come back
    let left = |low: f64, high: f64| {
        (1..OVERLAP_SAMPLES)
            .map(|i| low + (high - low) * f64::from(i) / f64::from(OVERLAP_SAMPLES))
            .map(|at| (at, gap(at)))
            .find(|(_, gap)| *gap > 0.0)
    };
    while high.1 <= 0.0 {
        if let Some(left) = left(low.0, high.0) {
            high = left;
        } else if high.0 >= end {
            return end;
        } else {
            let next = (2.0 * high.0).min(end);
            (low, high) = (high, (next, gap(next)));
        }
    }
    let root = |high| root_between(&gap, low, high, [1e-14 * -axis_gap, 1e-15 * end]);
    let found = root(high);
    left(low.0, found).map_or(found, root)
}

/// One of the roots of `gap` between a place with its negative value and one with its positive value, by regula falsi after
/// Illinois: the gap is nearly linear in r^2. `close` are the value and the width that end the search.
fn root_between(gap: impl Fn(f64) -> f64, mut low: (f64, f64), mut high: (f64, f64), close: [f64; 2]) -> f64 {
    let mut last = 0;
    for _ in 0..100 {
        let at = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let value = gap(at);
        if value.abs() <= close[0] || high.0 - low.0 <= close[1] {
            return at;
        }
        if value > 0.0 {
            high = (at, value);
            if last == 1 {
                low.1 *= 0.5;
            }
            last = 1;
        } else {
            low = (at, value);
            if last == -1 {
                high.1 *= 0.5;
            }
            last = -1;
        }
    }
    0.5 * (low.0 + high.0)
}
