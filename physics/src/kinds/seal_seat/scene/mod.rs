//! The flexibly mounted seal seat (section 4.4 of the paper): a sphere in one of two conical seats on an island that
//! a membrane carries, struck from below by an actuator.
//!
//! Axes: z = 0 is the flat underside, z points up; both seats and all tips lie in the plane of symmetry y = 0, the
//! seats at x = -+ half their distance; the sphere rests in the one at x < 0. Each seat is a cone about an axis that
//! leans inwards by the tilt, widening upwards, and a bore below it. The cone touches the sphere along the ring.

mod chamber;
mod keys;
mod read;
mod soundness;

use super::NAME;
use crate::error::Result;
use crate::material::Material;
use crate::scene::grammar::Field;
use crate::scene::hash::{canonical, drop_inelastic, sha256_hex};
use crate::scene::parts::is_zero;
use crate::scene::values::Node;
use crate::scene::{Language, ReferenceSettings, Scene, Setup};
use serde::{Deserialize, Serialize};
use serde_json::json;

/// A slot across the whole island (along y) that makes a hinge between the two seats.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Notch {
    /// Width along x in m, half of it on either side of x = 0.
    pub width: f64,
    /// z of its floor in m.
    pub floor: f64,
}

/// Membrane and island with both seats, one piece; the membrane's rim is clamped.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Seat {
    /// Material of the whole piece.
    pub material: Material,
    /// Radius of the membrane in m.
    pub membrane_radius: f64,
    /// Thickness of the membrane in m; it lies at z = 0 to this.
    pub membrane_thickness: f64,
    /// Length of the island along x in m.
    pub island_length: f64,
    /// Width of the island along y in m.
    pub island_width: f64,
    /// z of the island's top in m.
    pub island_height: f64,
    /// Distance of the centres of spheres that rest in the two seats in m.
    pub seat_distance: f64,
    /// z of these centres in m.
    pub seated_height: f64,
    /// alpha, the inward tilt of the seats' axes against z in rad.
    pub tilt: f64,
    /// gamma, the full angle of the cones in rad.
    pub aperture_angle: f64,
    /// Radius of the bores in m.
    pub bore_radius: f64,
    /// Depth of the bores' floors below the seated centres, along the axes, in m.
    pub bore_depth: f64,
    /// The slot between the seats, if any.
    pub notch: Option<Notch>,
}

/// Whether the sphere deforms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SphereBody {
    /// It does not.
    Rigid,
    /// It does; the reference alone knows this.
    Elastic,
}

/// The sphere, at rest in the seat at x < 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SeatedSphere {
    /// Radius in m.
    pub radius: f64,
    /// Material.
    pub material: Material,
    /// Mass in kg; that of a full sphere of the material unless the scene gives another one.
    pub mass: f64,
    /// Whether it deforms.
    pub body: SphereBody,
}

/// The actuator: rigid, guided along z, with spherical tips that touch the underside at t = 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Actuator {
    /// Mass in kg.
    pub mass: f64,
    /// Speed towards the seat (along +z) in m/s.
    pub speed: f64,
    /// Radius of its tips in m.
    pub tip_radius: f64,
    /// x of each tip in m, at y = 0.
    pub tip_positions: Vec<f64>,
}

/// Sphere, seal seat, actuator.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SealSeat {
    /// The seat.
    pub seat: Seat,
    /// The sphere.
    pub sphere: SeatedSphere,
    /// The actuator.
    pub actuator: Actuator,
    /// Coulomb's coefficient of friction of the seat with sphere and tips.
    #[serde(skip_serializing_if = "is_zero")]
    pub friction: f64,
    /// Intended direction of the sphere's flight against z in rad, positive towards +x.
    pub intended_angle: f64,
}

/// The circle along which the cone touches the sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactRing {
    /// Centre (x, z) of the sphere at rest in m.
    pub sphere_centre: [f64; 2],
    /// Direction (x, z) of the seat's axis, out of the seat, of length 1.
    pub axis: [f64; 2],
    /// Radius in m: r cos(gamma/2).
    pub radius: f64,
    /// Place of the ring's plane along the axis, from the sphere's centre, in m: -r sin(gamma/2).
    pub offset: f64,
}

impl ContactRing {
    /// Centre (x, z) in m.
    pub fn centre(&self) -> [f64; 2] {
        [0, 1].map(|i| self.sphere_centre[i] + self.offset * self.axis[i])
    }

    /// The ring's point (x, y, z) at `angle` in rad: 0 is its innermost point (largest x), pi its outermost.
    pub fn point(&self, angle: f64) -> [f64; 3] {
        let [x, z] = self.centre();
        let [sin, cos] = self.axis;
        let across = self.radius * angle.cos();
        [x + across * cos, self.radius * angle.sin(), z - across * sin]
    }
}

impl SealSeat {
    /// The ring of the seat the sphere rests in, the one at x < 0.
    pub fn ring(&self) -> ContactRing {
        let (seat, r) = (&self.seat, self.sphere.radius);
        let (half, (sin, cos)) = (0.5 * seat.aperture_angle, seat.tilt.sin_cos());
        ContactRing {
            sphere_centre: [-0.5 * seat.seat_distance, seat.seated_height],
            axis: [sin, cos],
            radius: r * half.cos(),
            offset: -r * half.sin(),
        }
    }

    /// SHA-256 (hexadecimal) of all that a mesh of the seat depends on but its fineness: the seat's shape, the sphere's
    /// radius and the places of the tips. A mesh file records it.
    pub fn geometry_hash(&self) -> String {
        let mut geometry = json!({
            "seat": self.seat,
            "sphere_radius": self.sphere.radius,
            "tip_positions": self.actuator.tip_positions,
        });
        drop_inelastic(&mut geometry);
        if let Some(seat) = geometry["seat"].as_object_mut() {
            seat.remove("material");
        }
        sha256_hex(canonical(&geometry).as_bytes())
    }
}

impl From<SealSeat> for Setup {
    fn from(setup: SealSeat) -> Self {
        Self::new(setup)
    }
}

impl Scene {
    /// The seal seat, for what knows nothing else.
    ///
    /// # Errors
    /// [`crate::Error::Scene`] if the scene is of another kind.
    pub fn seal_seat(&self) -> Result<&SealSeat> {
        self.of_kind(NAME)
    }
}

impl Language for super::Kind {
    fn keys(&self) -> Vec<Field> {
        keys::keys()
    }

    fn read(&self, root: &Node, materials: &Node) -> Result<(Setup, ReferenceSettings)> {
        let reference = read::reference(&root.table_or_defaults("reference")?)?;
        Ok((read::seal_seat(root, materials)?.into(), reference))
    }
}
