//! What a user has to know before relying on a reduced seal seat: what is taken as rigid, and what the mesh does not show.

use super::body::SeatMesh;
use super::integration::Integration;
use super::system::System;
use super::{SealSeat, SphereBody};

/// Share that a rigid sphere may lack of the contact's flexibility.
const RIGID: f64 = 0.05;
/// Distance of loaded nodes from the first touch, over the indentation, up to which these count as one line or point.
const ALONE: f64 = 1e-3;

/// Doubts about the model of `scene` on `mesh`, a sentence each.
pub(super) fn of_model(scene: &SealSeat, mesh: &SeatMesh) -> Vec<String> {
    let mut doubts = Vec::new();
    if scene.sphere.body == SphereBody::Elastic {
        doubts.push("the reduced model takes the sphere as rigid, the scene has an elastic one".to_owned());
    }
    let [seat, sphere] = [&scene.seat.material, &scene.sphere.material].map(|m| m.plane_strain_modulus());
    let share = seat / (seat + sphere);
    if share > RIGID {
        doubts.push(format!(
            "the sphere is taken as rigid, but its material would give {:.0} % of the contact's flexibility",
            100.0 * share
        ));
    }
    if mesh.geometry_hash().is_none() {
        doubts.push(format!(
            "mesh {} has no record of its geometry (`impactcheck mesh` writes one): only its edge, contact ring and tips were checked",
            mesh.path().display()
        ));
    }
    doubts
}

/// Doubts about the mesh where `run` has loaded it, a sentence each.
pub(super) fn of_contacts(system: &System, run: &Integration) -> Vec<String> {
    let loaded = run.tally.force_peak.iter().zip(run.tally.reach).zip([
        "the sphere is in contact with nodes of the contact ring only",
        "a tip of the actuator is in contact with one node only",
    ]);
    loaded
        .filter(|((force, reach), _)| **force > 0.0 && *reach <= ALONE * system.indentation)
        .map(|(_, what)| {
            format!("{what}: the mesh is too coarse for so light a contact, and what is indented depends on it; take a finer one")
        })
        .collect()
}
