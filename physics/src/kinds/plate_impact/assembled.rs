//! The models of a scene before they run: the plate reduced to modes, and the bodies joined by their contacts.

use super::PlateImpact;
use super::continua::Continua;
use super::predictor::Predictor;
use super::shared::SharedBodies;
use super::validity;
use crate::body::ModalBody;
use crate::body::continuum::{ContinuumPlate, MeshOptions, ModesAlong, cached};
use crate::body::kirchhoff::UnitPlates;
use crate::body::off_centre::{self, OffCentreModes};
use crate::dynamics::MovingBody;
use crate::dynamics::memory::{Bending, Memory};
use crate::dynamics::system::{PLATE, System};
use crate::dynamics::wet::FluidForces;
use crate::error::{Error, Result};
use crate::fluid::added_mass::{immersed, mass_factor};
use crate::kinds::general_impact::{OnOtherMesh, off_centre_plate};
use crate::kinds::rubbing::rubs_along;
use crate::scene::DEFAULT_MODES;
use crate::scene::{Edge, Material, Model, Shape};

/// Relative error of the forces at which model C stops adding modes by itself.
const TRUNCATION: f64 = 5e-4;
/// Most modes that model C chooses by itself.
const MAX_CHOSEN_MODES: usize = 64;
/// Contact radius over a sphere's radius from which on its residual flexibility is not known.
const WIDEST_PATCH: f64 = 0.5;

/// Displacement of the centre in a mode, over the largest in one, from which on the mode is one that moves the centre.
const MOVES: f64 = 0.5;

/// A model of a scene.
pub(super) struct Assembled {
    /// Oscillators and contacts.
    pub(super) system: System,
    /// Frequency in rad/s of the lowest mode left to the residual flexibility of model C.
    pub(super) omega_next: f64,
    /// Forces of the fluid.
    pub(super) fluid: Option<FluidForces>,
    /// What the user has to be warned of.
    pub(super) warnings: Vec<String>,
}

/// Which modes of the continuum plate are wanted.
pub(super) enum RequestedModes {
    /// So many.
    Modes(usize),
    /// As many as the error estimate asks for.
    Estimate,
}

/// `plate`, immersed if there is a fluid, between the bodies of the scene.
pub(super) fn join(setup: &PlateImpact, plate: ModalBody, tips: [f64; 2]) -> Result<System> {
    let plate = match &setup.fluid {
        Some(fluid) => immersed(plate, fluid),
        None => plate,
    };
    Ok(System::of(&MovingBody::both(&setup.outer, &setup.inner)?, &plate, &setup.plate.material, tips))
}

impl PlateImpact {
    /// Rigid outer and inner bodies joined by their contacts with the plate, reduced to `plate`; `tip_residual` as [`System::of`].
    pub fn rigid_system(&self, plate: &ModalBody, tip_residual: [f64; 2]) -> System {
        System::of(
            &MovingBody::both_rigid(&self.outer, &self.inner),
            plate,
            &self.plate.material,
            tip_residual,
        )
    }

    /// What its materials remember in a model that is `system`; `None` if all of them are elastic.
    ///
    /// # Errors
    /// As [`Memory::new`].
    pub fn memory(&self, system: &System) -> Result<Option<Memory>> {
        Memory::new(self.materials(), Some(Bending::new(&self.plate)), system)
    }
}

pub(super) fn kirchhoff_system(setup: &PlateImpact, modes: usize, plates: &UnitPlates) -> Result<System> {
    join(setup, plates.modes(&setup.plate, modes)?, [0.0; 2])
}

/// Models A and B with `modes` modes of a plate that is struck off its centre.
pub(super) fn off_centre_system(setup: &PlateImpact, modes: usize, plates: &UnitPlates) -> Result<System> {
    let OffCentreModes { body, along } = off_centre::modes(&setup.plate, setup.outer.offset, modes, plates)?;
    let centre: Vec<f64> = body.participation.iter().map(|phi| phi[1]).collect();
    let mut system = join(setup, body, [0.0; 2])?;
    system.along = along;
    // the plate is observed at its centre, not at the mean of both contacts
    system.centre[PLATE..].copy_from_slice(&centre);
    system.local_centre = system.local_centre.off_centre();
    Ok(system)
}

/// Model C with `modes` modes, or all there are, of a plate that is struck off-centre: as a body from a mesh; and the same on another
/// mesh.
///
/// # Errors
/// As [`off_centre_plate`], [`Error::Usage`] for more modes than there are.
pub(super) fn off_centre_continuum(
    setup: &PlateImpact,
    modes: Option<usize>,
) -> Result<(Assembled, Option<OnOtherMesh<System>>)> {
    let (system, other, warnings) = off_centre_plate(&setup.plate, &setup.outer, &setup.inner)?;
    let modes = modes.unwrap_or(system.modes);
    if modes > system.modes {
        return Err(Error::Usage(format!(
            "--modes {modes}: model C of an off-centre impact has {} modes at most",
            system.modes
        )));
    }
    let system = system.lowest(modes);
    let other = other.map(|other| other.map(|system| system.lowest(modes)));
    Ok((Assembled { system, omega_next: f64::INFINITY, fluid: None, warnings }, other))
}

/// Models A and B with `modes` elastic modes.
pub(super) fn kirchhoff(setup: &PlateImpact, modes: usize, plates: &UnitPlates) -> Result<Assembled> {
    if setup.outer.offset > 0.0 {
        return Ok(Assembled {
            system: off_centre_system(setup, modes, plates)?,
            omega_next: f64::INFINITY,
            fluid: None,
            warnings: Vec::new(),
        });
    }
    let shapes = |radii: &[f64]| plates.shapes(&setup.plate, modes, radii);
    kirchhoff_plate(setup, plates.modes(&setup.plate, modes)?, shapes)
}

/// Modes of `model` by which the faces of the plate of `setup` move along themselves alone; none where nothing moves them so, and of a
/// free plate.
pub(super) fn modes_along(setup: &PlateImpact, model: Model, bodies: &SharedBodies) -> Result<ModesAlong> {
    let PlateImpact { outer, inner, plate, .. } = setup;
    if outer.offset != 0.0 || plate.edge == Edge::Free || !rubs_along(outer, Some(inner)) {
        return Ok(ModesAlong::default());
    }
    match model {
        Model::A | Model::B => off_centre::modes_along(plate, &bodies.kirchhoff),
        Model::C => bodies.modes_along(plate),
    }
}

/// Models A and B of a `plate` that is reduced to modes; `shapes` as [`FluidForces::new`] takes them.
pub(super) fn kirchhoff_plate(
    setup: &PlateImpact,
    plate: ModalBody,
    shapes: impl FnOnce(&[f64]) -> Result<Vec<Vec<f64>>>,
) -> Result<Assembled> {
    Ok(Assembled {
        system: join(setup, plate, [0.0; 2])?,
        omega_next: f64::INFINITY,
        fluid: fluid_forces(setup, shapes)?,
        warnings: Vec::new(),
    })
}

/// Model C.
pub(super) fn continuum(
    setup: &PlateImpact,
    requested: RequestedModes,
    predictor: &Predictor,
    bodies: Continua,
) -> Result<Assembled> {
    let rigid = usize::from(setup.plate.edge == Edge::Free);
    let (plate, omega_next) = continuum_plate(setup, requested, predictor, bodies)?;
    let elastic = plate.omega.len() - rigid;
    let inner: Vec<f64> = plate.participation.iter().map(|phi| phi[1]).collect();
    let fluid = fluid_forces(setup, |radii| continuum_shapes(setup, predictor, elastic, &inner, radii))?;
    let tips = tip_residuals(setup, predictor.patch_radius, |r, m, a| bodies.sphere_residual(r, m, a))?;
    let system = join(setup, plate, tips)?;
    let warnings = validity::warnings(setup.plate.thickness, predictor.patch_radius, &system);
    let slower = setup.fluid.as_ref().map_or(1.0, |fluid| mass_factor(fluid.added_mass_frequency_ratio));
    Ok(Assembled { system, omega_next: omega_next / slower.sqrt(), fluid, warnings })
}

/// Mass-normalised displacements of the inner face at `radii` in m (the first 0) in model C's modes, of which `elastic` are elastic,
/// with the signs of their participations at the `inner` contact. Shape (modes, radii).
pub(super) fn continuum_shapes(
    setup: &PlateImpact,
    predictor: &Predictor,
    elastic: usize,
    inner: &[f64],
    radii: &[f64],
) -> Result<Vec<Vec<f64>>> {
    let patches = predictor.meshed_patches(&setup.plate);
    let mut shapes = cached::face_shapes(&setup.plate, patches, elastic, &MeshOptions::default(), radii)?;
    for (shape, participation) in shapes.iter_mut().zip(inner) {
        let sign = (shape[0] * participation).signum();
        shape.iter_mut().for_each(|value| *value *= sign);
    }
    // the last mode stands for all from it on: with the shape of the last one that moves the centre
    let largest = shapes.iter().fold(0.0, |largest: f64, shape| largest.max(shape[0].abs()));
    let moves = shapes.iter().rfind(|shape| shape[0].abs() >= MOVES * largest).cloned();
    if let (Some(last), Some(moves), Some(participation)) = (shapes.last_mut(), moves, inner.last()) {
        *last = moves.iter().map(|value| participation / moves[0] * value).collect();
    }
    Ok(shapes)
}

/// Film and drag of the scene, if there are any. `shapes` gives the mass-normalised shapes of the dry plate's inner
/// face at radii in m.
pub(super) fn fluid_forces(
    setup: &PlateImpact,
    shapes: impl FnOnce(&[f64]) -> Result<Vec<Vec<f64>>>,
) -> Result<Option<FluidForces>> {
    let Some(fluid) = &setup.fluid else { return Ok(None) };
    let per_mass = mass_factor(fluid.added_mass_frequency_ratio).sqrt().recip();
    FluidForces::new(fluid, &setup.plate, &setup.inner, |radii| {
        let scaled = |shape: &Vec<f64>| shape.iter().map(|value| value * per_mass).collect();
        Ok(shapes(radii)?.iter().map(scaled).collect())
    })
}

/// Plate of model C: continuum with residual flexibility; and the frequency in rad/s of the lowest mode that is left to it.
fn continuum_plate(
    setup: &PlateImpact,
    requested: RequestedModes,
    predictor: &Predictor,
    bodies: Continua,
) -> Result<(ModalBody, f64)> {
    let patches = predictor.meshed_patches(&setup.plate);
    let build = |modes| bodies.plate(&setup.plate, patches, modes);
    let in_film = setup.fluid.as_ref().is_some_and(|fluid| fluid.squeeze_film);
    let lowest = |plate: &ContinuumPlate, modes| {
        let slow = predictor.slow();
        let body =
            if in_film { plate.modal_body_in_film(modes, slow) } else { plate.modal_body(modes, slow) };
        Ok((body, plate.omega_next(modes)))
    };
    match requested {
        RequestedModes::Modes(modes) => lowest(&build(modes)?, modes),
        RequestedModes::Estimate => {
            let mut most = DEFAULT_MODES;
            loop {
                let plate = build(most)?;
                let enough =
                    (1..=most).find(|n| predictor.truncation_error(plate.omega_next(*n)) <= TRUNCATION);
                if let Some(modes) = enough.or((most >= MAX_CHOSEN_MODES).then_some(most)) {
                    return lowest(&plate, (modes + usize::from(in_film)).min(most));
                }
                // with twice as many modes the highest frequency is four times as high at most
                let far = predictor.truncation_error(plate.omega_next(most)) > 16.0 * TRUNCATION;
                most = if far { MAX_CHOSEN_MODES } else { 2 * most };
            }
        }
    }
}

/// Residual flexibility in m/N of the outer and the inner body at their contact points, for contact patches of the
/// radii `patch` in m; `sphere` gives that of a sphere by radius, material and patch.
///
/// # Errors
/// [`Error::Solver`] for a contact half as wide as its sphere, and those of `sphere`.
pub(super) fn tip_residuals(
    setup: &PlateImpact,
    patch: [f64; 2],
    sphere: impl Fn(f64, &Material, f64) -> Result<f64>,
) -> Result<[f64; 2]> {
    let tip = |body: &str, shape: &Shape, material: &Material, patch| match *shape {
        Shape::Sphere { radius } if patch >= WIDEST_PATCH * radius => Err(Error::Solver(format!(
            "model {}: the {body} contact's radius, {:.3} mm by the first look, is not below half of `{body}.radius`, {:.3} mm: \
             its sphere model is limited to smaller contacts; take model B, a lower speed or a stiffer material",
            Model::C,
            1e3 * patch,
            1e3 * WIDEST_PATCH * radius
        ))),
        Shape::Sphere { radius } => sphere(radius, material, patch),
        // a compact body and the tips of benders and stacks are rigid but for their Hertz contact
        Shape::Compact { .. } | Shape::Bender(_) | Shape::Stack(_) => Ok(0.0),
    };
    Ok([
        tip("outer", &setup.outer.shape, &setup.outer.material, patch[0])?,
        tip("inner", &setup.inner.shape, &setup.inner.material, patch[1])?,
    ])
}
