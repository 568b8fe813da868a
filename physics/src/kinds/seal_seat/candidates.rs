//! Contact candidates: the nodes of the seat's mesh that the sphere and the actuator's tips may touch.

use super::SealSeat;
use crate::analytical::hertz::HertzImpact;
use crate::body::solid::TetMesh;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// How far from a surface the corners of a face may lie that belongs to it, over the sphere's radius. A mesh has its
/// corners on the surfaces up to rounding, in files of a few digits too.
const ON_SURFACE: f64 = 1e-6;

/// Ratio of neighbouring zones of a series.
const SERIES: f64 = 1.5;

/// Share of a zone that contact may fill.
const ROOM: f64 = 0.85;

/// Which rigid body a candidate can meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ContactBody {
    /// The sphere.
    Sphere,
    /// The actuator's tip of this number.
    Tip(usize),
}

/// A node that may be touched.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Number of the node in the mesh.
    pub node: usize,
    /// Place in m on the exact surface: nodes of straight elements lie beside the cone by the edges' sagitta.
    pub place: Vector3<f64>,
    /// What it may meet.
    pub contact_body: ContactBody,
    /// Distance in m from where the other body touches first: from the ring along the cone, from the tip's axis.
    pub offset: f64,
    /// Whether it lies on the flank at the +x side of the seat's axis.
    pub right_flank: bool,
}

/// Half widths in m of the zones in which contact is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Zones {
    /// On the cone, to both sides of the ring.
    pub ring: f64,
    /// On the underside, around each tip's axis.
    pub tip: f64,
}

impl Zones {
    /// Widths for the forces that are to be expected, from above: the actuator's as if the seat were a heavy half-space
    /// (Hertz), the sphere's as it takes twice the actuator's speed in the same time.
    ///
    /// Tip: the radius of the Hertz contact (Johnson 1985, Contact Mechanics, eq. 4.22). Cone: five half widths of
    /// the line contact (eq. 4.43) with the force spread over the ring; the flanks share it unequally, and the sphere slides on
    /// them.
    pub fn expected(scene: &SealSeat) -> Self {
        let (actuator, ring, hit) = (&scene.actuator, scene.ring(), on_half_space(scene));
        let modulus = scene.seat.material.plane_strain_modulus();
        let patch = (actuator.tip_radius * hit.approach_peak()).sqrt();
        let force = 2.0 * hit.force_peak() * scene.sphere.mass / actuator.mass;
        let length = 2.0 * std::f64::consts::PI * ring.radius;
        let line_load = force / (length * (0.5 * scene.seat.aperture_angle).sin());
        let half_width = (4.0 * line_load * scene.sphere.radius / (std::f64::consts::PI * modulus)).sqrt();
        Self { ring: rounded(5.0 * half_width), tip: rounded(patch) }.at_most(scene)
    }

    /// The next of some few zones that are not smaller: so that launches of a series that differ a little share a body.
    pub fn of_series(self) -> Self {
        let next = |zone: f64| SERIES.powf((zone.ln() / SERIES.ln() - 1e-9).ceil());
        Self { ring: next(self.ring), tip: next(self.tip) }
    }

    /// These, but no wider than the radii of what touches there: farther out nothing can.
    pub fn at_most(self, scene: &SealSeat) -> Self {
        Self { ring: self.ring.min(scene.sphere.radius), tip: self.tip.min(scene.actuator.tip_radius) }
    }

    /// Zones that hold contact up to `reach` in m from where sphere and tips touch first, with room beyond it; `None`
    /// if these do.
    pub fn widened(&self, reach: [f64; 2]) -> Option<Self> {
        let wider = |zone: f64, reach: f64| if reach > ROOM * zone { rounded(1.5 * zone) } else { zone };
        let wide = Self { ring: wider(self.ring, reach[0]), tip: wider(self.tip, reach[1]) };
        (wide != *self).then_some(wide)
    }
}

/// The actuator's impact by one tip if the seat were a heavy half-space (Hertz).
pub(super) fn on_half_space(scene: &SealSeat) -> HertzImpact {
    let actuator = &scene.actuator;
    let stiffness = 4.0 / 3.0 * scene.seat.material.plane_strain_modulus() * actuator.tip_radius.sqrt();
    HertzImpact { mass: actuator.mass, speed: actuator.speed, stiffness }
}

/// `value` with two significant digits, so that zones of scenes that are a little different find the same body.
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// All nodes of those outer faces on the cone and on the underside that reach into `zones`, ascending by node: so around all
/// nodes in a zone there are others, and contact at one that stands alone is known not to spread.
pub fn candidates(scene: &SealSeat, mesh: &TetMesh, zones: &Zones) -> Vec<Candidate> {
    let cone = Cone::of(scene);
    let close = ON_SURFACE * scene.sphere.radius;
    let mut found: Vec<Candidate> = Vec::new();
    for face in mesh.outer_faces() {
        let all = |on: &dyn Fn(Vector3<f64>) -> bool| face[..3].iter().all(|&node| on(mesh.points[node]));
        let on_cone = all(&|p| p[0] < 0.0 && cone.height(p).abs() < close);
        let below = all(&|p| p[2].abs() < close);
        let candidate = |&node: &usize| {
            let place = mesh.points[node];
            if on_cone { Some(cone.candidate(node, place)) } else { under_tip(scene, node, place) }
        };
        let nodes: Vec<_> = face.iter().filter(|_| on_cone || below).filter_map(candidate).collect();
        if nodes.iter().any(|c| c.offset <= if on_cone { zones.ring } else { zones.tip }) {
            found.extend(nodes);
        }
    }
    found.sort_unstable_by_key(|c| c.node);
    found.dedup_by_key(|c| c.node);
    found
}

/// A node of the underside; of several tips the nearest one meets it.
fn under_tip(scene: &SealSeat, node: usize, place: Vector3<f64>) -> Option<Candidate> {
    let distance = |x: &f64| (place[0] - x).hypot(place[1]);
    let tips = scene.actuator.tip_positions.iter().map(distance).enumerate();
    let (tip, offset) = tips.min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Candidate {
        node,
        place: Vector3::new(place.x, place.y, 0.0),
        contact_body: ContactBody::Tip(tip),
        offset,
        right_flank: false,
    })
}

/// The vector with the components x and z.
pub(super) fn in_plane([x, z]: [f64; 2]) -> Vector3<f64> {
    Vector3::new(x, 0.0, z)
}

/// The cone of the seat in which the sphere rests, seen from the sphere's centre.
struct Cone {
    centre: Vector3<f64>,
    /// Unit vector.
    axis: Vector3<f64>,
    radius: f64,
    /// Half the aperture angle.
    half_angle: f64,
}

impl Cone {
    fn of(scene: &SealSeat) -> Self {
        let ring = scene.ring();
        Self {
            centre: in_plane(ring.sphere_centre),
            axis: in_plane(ring.axis),
            radius: scene.sphere.radius,
            half_angle: 0.5 * scene.seat.aperture_angle,
        }
    }

    /// Distance in m of `p` from the sphere's centre across the axis and along it, and the unit vector across.
    fn meridian(&self, p: Vector3<f64>) -> (f64, f64, Vector3<f64>) {
        let d = p - self.centre;
        let along = d.dot(&self.axis);
        let across = d - along * self.axis;
        let radius = across.norm();
        (radius, along, across / radius)
    }

    /// Distance in m of `p` behind the cone, seen from the sphere.
    fn height(&self, p: Vector3<f64>) -> f64 {
        let (sin, cos) = self.half_angle.sin_cos();
        let (across, along, _) = self.meridian(p);
        across * cos - along * sin - self.radius
    }

    /// Distance in m of `p` from the ring, along the cone and up.
    fn along(&self, p: Vector3<f64>) -> f64 {
        let (sin, cos) = self.half_angle.sin_cos();
        let (across, along, _) = self.meridian(p);
        across * sin + along * cos
    }

    fn candidate(&self, node: usize, p: Vector3<f64>) -> Candidate {
        let (sin, cos) = self.half_angle.sin_cos();
        let (radius, along, across) = self.meridian(p);
        // Along the radius from the seat's axis onto the cone, as the reference moves it.
        let exact = (self.radius + along * sin) / cos;
        // The seat's +x flank is where the unit vector across has a positive component along (cos, 0, -sin).
        let side = across.x * self.axis.z - across.z * self.axis.x;
        let place = p + (exact - radius) * across;
        Candidate {
            node,
            place,
            contact_body: ContactBody::Sphere,
            offset: self.along(place).abs(),
            right_flank: side >= 0.0,
        }
    }
}
