//! A reduced model of a scene: bodies reduced to modes and joined.

mod run;

use super::assembled::{Assembled, RequestedModes, continuum, kirchhoff, modes_along, off_centre_continuum};
use super::results::PlateQuantities;
use super::shared::SharedBodies;
use super::{MAX_MODES, PlateImpact};
use crate::body::cache::Cache;
use crate::body::continuum::ModesAlong;
use crate::dynamics::memory::Memory;
use crate::dynamics::sliding::Tilt;
use crate::dynamics::system::System;
use crate::dynamics::wet::FluidForces;
use crate::error::{Error, Result};
use crate::kinds::general_impact::OnOtherMesh;
use crate::kinds::rubbing::{Rubbing, StruckSurface, Touching, moves_along};
use crate::result::Choice;
use crate::scene::DEFAULT_MODES;
use crate::scene::{Edge, Model, Outer, Scene};

/// The same of an off-centre impact, where modes with nodal diameters are as many.
const OFF_CENTRE_MODES: usize = 64;

/// A reduced model, ready to run.
#[derive(Debug, Clone)]
pub struct Reduced {
    model: Model,
    system: System,
    /// Frequency in rad/s of the lowest mode left to the residual flexibility of model C.
    omega_next: f64,
    /// Forces of the fluid; a dry impact has none and takes the dry integrator.
    fluid: Option<FluidForces>,
    /// What its materials remember; elastic ones take the integrator that knows nothing of it.
    memory: Option<Memory>,
    /// The bodies, if they move along the plate.
    rubbing: Option<Rubbing>,
    warnings: Vec<String>,
    /// The same on another mesh, of a plate that is meshed.
    other: Option<OnOtherMesh<System>>,
    /// Why it is this model, if it was left to the program.
    choice: Option<Choice>,
    scene: Scene,
}

/// The bodies of `setup` that move along its plate in `system`, if they do; the plate also moves `along` itself.
fn rubbing(setup: &PlateImpact, system: &System, along: &ModesAlong) -> Option<Rubbing> {
    let PlateImpact { outer, inner, plate, .. } = setup;
    let masses = [outer.shape.mass(&outer.material), inner.shape.mass(&inner.material)];
    moves_along(outer, Some(inner)).then(|| Rubbing {
        // a free plate also moves along itself as a whole
        tilt: (plate.edge != Edge::Free).then_some(Tilt { arm: 0.5 * plate.thickness, masses }),
        outer: outer.clone(),
        inner: Some(inner.clone()),
        struck: StruckSurface::plate(plate, outer.offset, system, along),
        aside: Vec::new(),
        contacts: touching(setup, system),
    })
}

/// Both contacts of `setup` in `system`.
fn touching(setup: &PlateImpact, system: &System) -> [Touching; 2] {
    let PlateImpact { outer, inner, plate, .. } = setup;
    let bodies = [&outer.material, &inner.material];
    [0, 1].map(|i| (system.laws[i], [bodies[i].clone(), plate.material.clone()]))
}

/// What one impact of a series gives.
pub type Point = crate::result::Point<PlateQuantities>;

impl Reduced {
    /// Builds `model` of `scene`; `modes` overrides the scene's number of modes (model A always has one); if
    /// neither names one, model B takes [`DEFAULT_MODES`] and model C as many as its error estimate asks for.
    ///
    /// # Errors
    /// [`Error::Usage`] for a number of modes that makes no sense, [`Error::Solver`] for what no reduced model covers.
    pub fn new(scene: &Scene, model: Model, modes: Option<usize>) -> Result<Self> {
        Self::in_series(scene.clone(), model, modes, &SharedBodies::default())
    }

    /// As [`Reduced::new`], one of a series of impacts that share `bodies`.
    ///
    /// # Errors
    /// As [`Reduced::new`].
    pub fn in_series(
        scene: Scene,
        model: Model,
        modes: Option<usize>,
        bodies: &SharedBodies,
    ) -> Result<Self> {
        let setup = &*scene.plate_impact()?.along_normal();
        require_covered(setup, model)?;
        let modes = match (model, modes) {
            (Model::A, None | Some(1)) => Some(1),
            (Model::A, Some(n)) => {
                return Err(Error::Usage(format!("--modes {n}: model A has exactly one mode; use model B")));
            }
            (_, Some(0)) => return Err(Error::Usage("--modes 0: at least one mode is needed".into())),
            (_, Some(n)) if n > MAX_MODES => {
                return Err(Error::Usage(format!("--modes {n}: at most {MAX_MODES} modes are possible")));
            }
            (_, modes) => modes.or(scene.reduced.modes),
        };
        let built = match model {
            Model::A | Model::B => {
                let default = if setup.outer.offset > 0.0 { OFF_CENTRE_MODES } else { DEFAULT_MODES };
                kirchhoff(setup, modes.unwrap_or(default), &bodies.kirchhoff)?
            }
            Model::C if setup.outer.offset > 0.0 => {
                let (built, other) = off_centre_continuum(setup, modes)?;
                return Ok(Self { other, ..Self::of(built, model, scene, bodies)? });
            }
            Model::C => {
                let predictor = bodies.predictor(setup)?;
                let requested = modes.map_or(RequestedModes::Estimate, RequestedModes::Modes);
                continuum(setup, requested, &predictor, bodies.continua())?
            }
        };
        Self::of(built, model, scene, bodies)
    }

    /// As [`Reduced::new`] with the bodies of model C from `cache`.
    ///
    /// # Errors
    /// As [`Reduced::new`].
    pub fn new_in(scene: &Scene, model: Model, modes: Option<usize>, cache: &Cache) -> Result<Self> {
        Self::in_series(scene.clone(), model, modes, &SharedBodies::meshed(cache.clone()))
    }

    fn of(built: Assembled, model: Model, scene: Scene, bodies: &SharedBodies) -> Result<Self> {
        let Assembled { mut system, omega_next, fluid, warnings } = built;
        let memory = scene.plate_impact()?.memory(&system)?;
        if let Some(memory) = &memory {
            system.first_frequency = memory.frequency(system.first_frequency);
        }
        let along = modes_along(scene.plate_impact()?, model, bodies)?;
        let rubbing = rubbing(scene.plate_impact()?, &system, &along);
        Ok(Self {
            model,
            system,
            omega_next,
            fluid,
            memory,
            rubbing,
            warnings,
            other: None,
            choice: None,
            scene,
        })
    }

    /// With the reason why it was chosen, and a warning where it does not meet the tolerance.
    #[must_use]
    pub fn chosen(mut self, choice: Choice) -> Self {
        self.warnings.extend((!choice.met).then(|| choice.reason.clone()));
        self.choice = Some(choice);
        self
    }

    /// Refuses a `model` that has no form for impacts like that of `scene`, or one that has to be requested alone because it makes a mesh,
    /// before anything is built.
    ///
    /// # Errors
    /// [`Error::Solver`] with the reason, [`Error::Scene`] if the scene is no plate impact.
    pub fn require(scene: &Scene, model: Model) -> Result<()> {
        let setup = scene.plate_impact()?;
        require_covered(setup, model)?;
        match model == Model::C && setup.outer.offset > 0.0 {
            true => Err(Error::Solver(format!(
                "`outer.offset` is {} m: model C makes a mesh of the plate, which needs gmsh; request it alone",
                setup.outer.offset
            ))),
            false => Ok(()),
        }
    }

    /// The model.
    pub fn model(&self) -> Model {
        self.model
    }

    /// The oscillators and contacts the model consists of.
    pub fn system(&self) -> &System {
        &self.system
    }
}

/// Refuses what `model` does not have.
fn require_covered(setup: &PlateImpact, model: Model) -> Result<()> {
    let (Outer { offset, .. }, edge) = (&setup.outer, setup.plate.edge);
    let covers = match model {
        // supports that leave motions in the plane are not those of a body from a mesh
        Model::C => edge != Edge::SimplySupported,
        Model::A | Model::B => edge != Edge::Free,
    };
    if *offset == 0.0 || covers {
        return Ok(());
    }
    Err(Error::Solver(format!(
        "`outer.offset` is {offset} m: off-centre impacts need model A or B with a clamped or simply supported plate, or model C with a clamped or free one; the reference takes all"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the references found it: 6 % too low with 10 mPa s, half a percent in water.
    #[test]
    fn a_film_too_strong_for_rigid_surfaces_has_a_warning() {
        let viscous = include_str!("../../../../scenes/validation/viscous-film.toml");
        let water = include_str!("../../../../scenes/validation/squeeze-film.toml");
        for (text, is_warned) in [(viscous, true), (water, false)] {
            let scene = Scene::parse("film.toml", text).unwrap();
            let summary = Reduced::new(&scene, Model::B, None).unwrap().run(1e-4).unwrap();
            assert_eq!(
                summary.warnings.iter().any(|w| w.contains("squeeze film dissipates")),
                is_warned,
                "{summary:?}"
            );
        }
    }

    #[test]
    fn a_contact_half_as_wide_as_its_sphere_is_refused_by_the_sphere_s_name() {
        let text = include_str!("../../../../tests/fixtures/plate-impact.toml");
        let [start, end] = ["[outer]", "[inner]"].map(|table| text.find(table).expect("a table"));
        let soft = text.replace(
            &text[start..end],
            "[outer]\nkind = \"sphere\"\nradius = \"5 mm\"\nmaterial = \"soft\"\nspeed = \"20 m/s\"\n\n",
        ) + "\n[materials.soft]\nyoungs_modulus = \"1.8 MPa\"\npoisson_ratio = 0.4\ndensity = \"1100 kg/m^3\"\n";
        let scene = Scene::parse("soft.toml", &soft).unwrap();
        let refused = Reduced::new(&scene, Model::C, None).expect_err("too wide").to_string();
        assert!(refused.contains("`outer.radius`, 2.500 mm"), "{refused}");
        assert!(Reduced::new(&scene, Model::B, None).is_ok());
    }
}
