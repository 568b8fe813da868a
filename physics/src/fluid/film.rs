//! Squeeze film between the plate and the inner body: the modified Reynolds equation, eqs. (3) and (4) of the paper,
//!     d/dr (r h^3/mu dp/dr) = 12 r dh/dt,
//! by finite volumes in r.
//!
//! The pressure is that of the rim, 0, at the edge of the film, and nothing flows through the axis. Where the bodies
//! touch there is no film: its domain begins at the edge of the contact patch, through which nothing flows either. The
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

/// Gap of the film and its rate, without the curvature of the inner body.
pub trait Profile {
    /// Gap at the radius r in m: negative where the bodies overlap.
    fn gap(&self, r: f64) -> f64;
    /// Mean rate of the gap in `ring`, m/s, of which `closing` is what [`Self::closing`] gives.
    fn rate(&self, ring: Ring, closing: f64) -> f64;
    /// Squared radius of the contact patch in m^2, 0 if the bodies do not touch on the axis.
    fn patch(&self) -> f64 {
        0.0
    }
    /// Mean closing speed of the gap in `ring` per closing speed of the bodies.
    fn closing(&self, _: Ring) -> f64 {
        1.0
    }
}

/// A cell of the film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Squares of the inner and the outer radius, m^2.
    pub squares: [f64; 2],
}

impl Ring {
    /// Square of the radius that halves its area, m^2.
    fn middle(&self) -> f64 {
        0.5 * (self.squares[0] + self.squares[1])
    }

    /// Radius that halves its area, m.
    pub fn radius(&self) -> f64 {
        self.middle().sqrt()
    }

    /// Area in m^2.
    pub fn area(&self) -> f64 {
        PI * (self.squares[1] - self.squares[0])
    }
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
    /// Force of each cell that pushes the bodies apart, N. Shape (cells).
    pub load: Vec<f64>,
    /// The same per closing speed of the bodies of 1 m/s, at the present viscosity, N s/m. Shape (cells).
    pub unit_load: Vec<f64>,
    /// Force on each body, N: `load`, less what relieves the contact.
    pub force: f64,
    /// The same of `unit_load`, N s/m.
    pub resistance: f64,
    /// What relieves the contact, of `load` in N and of `unit_load` in N s/m.
    pub relief: [f64; 2],
    /// Power dissipated in W.
    pub dissipation: f64,
    /// Where the bodies overlap most outside the contact on the axis. Up to the minimal gap that is no more than the film's
    /// equation leaves open.
    pub overlap: Option<Overlap>,
    /// The cells and the flow through the outer face of each. Shape (cells), or empty where there is no film.
    pub faces: Vec<Face>,
}

/// Overlap of plate and inner body outside the contact on the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Radius in m.
    pub radius: f64,
    /// Depth in m.
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
    /// The cell.
    pub ring: Ring,
    /// What [`Profile::closing`] gives of it.
    pub closing: f64,
    /// Radius of the face in m.
    pub radius: f64,
    /// Width of the film there in m, the minimal gap at least.
    pub width: f64,
    /// Fall of the pressure to the next cell in Pa.
    pub fall: f64,
    /// Change of the fall per flow outwards, Pa s/m^3.
    pub per_flow: f64,
    /// Change of the fall per widening of the gap at the face, Pa/m.
    pub per_gap: f64,
    /// Fall per closing speed of the bodies of 1 m/s at the present viscosity, Pa s/m.
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

    /// Solves for the pressure and writes its loads into `forces`.
    pub fn solve(&self, profile: &impl Profile, forces: &mut FilmForces) {
        forces.load.clear();
        forces.unit_load.clear();
        forces.faces.clear();
        (forces.force, forces.resistance, forces.relief) = (0.0, 0.0, [0.0; 2]);
        (forces.dissipation, forces.overlap) = (0.0, None);
        // the tip is a paraboloid, which is what lubrication theory resolves of a sphere: with the sphere's own
        // shape the force would be further from Stokes flow (Brenner 1961), 2.4 % too low at a gap of R/700
        let curvature = 0.5 / self.tip_radius;
        let gap = |square: f64| profile.gap(square.sqrt()) + curvature * square;
        let (start, end) = (profile.patch(), self.rim * self.rim);
        // nothing is wet, or nothing that matters
        if start >= end * (1.0 - 1e-9) {
            return;
        }
        // cell faces in r^2: start + first (growth^k - 1). The first length is that in which the gap opens by the minimal
        // gap: in proportion to r^2, around a patch with the power 2/3 of it
        let narrow = if start > 0.0 { 0.0 } else { gap(0.0).max(0.0) };
        let opening = self.tip_radius * narrow.hypot(self.minimum_gap);
        let scale = 2.0 * FINENESS * (opening * opening * (start + opening)).cbrt();
        let growth = ((end - start) / scale).ln_1p() / self.cells as f64;
        let (ratio, mut power) = (growth.exp(), 1.0);
        let mut face = start;
        let (mut flow, mut unit_flow) = (0.0, 0.0);
        for cell in 0..self.cells {
            power *= ratio;
            let next = if cell + 1 == self.cells { end } else { start + scale * (power - 1.0) };
            let after = if cell + 1 == self.cells { end } else { start + scale * (power * ratio - 1.0) };
            let ring = Ring { squares: [face, next] };
            // what is squeezed out inside of the outer face flows through it
            let closing = profile.closing(ring);
            flow -= profile.rate(ring, closing) * ring.area();
            unit_flow += closing * ring.area();
            let (face_radius, face_gap) = (next.sqrt(), gap(next));
            if face_gap < 0.0 {
                let deepest = forces.overlap.map_or(0.0, |overlap| overlap.depth);
                if -face_gap > deepest {
                    forces.overlap = Some(Overlap { radius: face_radius, depth: -face_gap });
                }
            }
            let width = face_gap.max(self.minimum_gap);
            let rate = 6.0 * flow.abs() / (2.0 * PI * face_radius * width * width);
            let (viscosity, slope) = self.viscosity.with_slope(rate);
            // with x = r^2: flow = -2 pi r h^3/(12 mu) dp/dr = -pi x h^3/(3 mu) dp/dx
            let length = 0.5 * (next + after) - ring.middle();
            let resistance = 3.0 * viscosity * length / (PI * next * width.powi(3));
            let fall = flow * resistance;
            forces.dissipation += flow * fall;
            forces.faces.push(Face {
                ring,
                closing,
                radius: face_radius,
                width,
                fall,
                unit_fall: unit_flow * resistance,
                per_flow: (1.0 + slope) * resistance,
                per_gap: if face_gap > self.minimum_gap { -(3.0 + 2.0 * slope) * fall / width } else { 0.0 },
            });
            face = next;
        }
        forces.load.resize(self.cells, 0.0);
        forces.unit_load.resize(self.cells, 0.0);
        let mut pressure = [0.0; 2];
        for (cell, face) in forces.faces.iter().enumerate().rev() {
            pressure = [pressure[0] + face.fall, pressure[1] + face.unit_fall];
            let loads = pressure.map(|pressure| pressure * face.ring.area());
            (forces.load[cell], forces.unit_load[cell]) = (loads[0], loads[1]);
            forces.force += face.closing * loads[0];
            forces.resistance += face.closing * loads[1];
            forces.relief = [0, 1].map(|i| forces.relief[i] + (1.0 - face.closing) * loads[i]);
        }
    }
}
