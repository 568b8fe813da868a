//! Parts of the models beside closed forms, for the bodies of a scene: what of it is compared with an exact solution.

use super::PlateImpact;
use crate::actuator::beam::{Beam, MODES};
use crate::actuator::cantilever;
use crate::analytical::circular_plate;
use crate::body::{ModalBody, kirchhoff};
use crate::dynamics::integration::Options;
use crate::dynamics::integrator::integrate;
use crate::dynamics::memory;
use crate::dynamics::wet::FluidForces;
use crate::error::Result;
use crate::fluid::film::CELLS;
use crate::fluid::{Film, FilmForces, Profile, Ring, Viscosity};
use crate::material::Relaxation;
use crate::scene::{Bender, Fluid, Model, Shape};
use std::f64::consts::{PI, TAU};

/// Modes whose frequencies are compared with closed forms.
const MOUNTED_MODES: usize = 8;
/// Duration of a contact over the time of its relaxation.
const SHORT: f64 = 0.01;
/// Models with the same beam, film and springs.
const ALL: &[Model] = &[Model::A, Model::B, Model::C];

/// What a closed form is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Frequencies of Kirchhoff's circular plate: Bessel functions (Leissa 1969).
    CircularPlate,
    /// Impact on a rigid half-space (Hertz 1882).
    Hertz,
    /// Impact of viscoelastic bodies that is short against their relaxation (Hunter 1960).
    Hunter,
    /// Frequencies of a cantilever with a mass at its tip (Blevins 1979).
    Cantilever,
    /// Film between a paraboloid and a plane (Taylor's force, the film ending at its rim).
    Film,
}

/// A part of some models beside a closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedForm {
    /// What it is of.
    pub form: Form,
    /// The models that have the part.
    pub models: &'static [Model],
    /// What was compared.
    pub quantity: &'static str,
    /// Largest difference, over the closed form.
    pub relative: f64,
}

/// The closed forms that there are for the bodies of `setup`.
///
/// # Errors
/// Those of the parts.
pub fn closed_forms(setup: &PlateImpact) -> Result<Vec<ClosedForm>> {
    let of = |form, models, quantity, relative| ClosedForm { form, models, quantity, relative };
    let mut found = vec![of(Form::CircularPlate, &[Model::A, Model::B], "frequencies", plate(setup)?)];
    match &setup.outer.shape {
        Shape::Bender(bender) => {
            found.push(of(Form::Cantilever, ALL, "bender_frequencies", beam(bender)?));
        }
        Shape::Stack(_) => {}
        _ => found.push(of(Form::Hertz, &[Model::A, Model::B], "outer_force_peak", contact(setup)?)),
    }
    if setup.relaxes() {
        found.push(of(Form::Hunter, ALL, "lost_speed", lost_speed(setup)?));
    }
    let newtonian = setup.fluid.as_ref().filter(|f| f.squeeze_film && f.shear_thinning.is_none());
    found.extend(newtonian.map(|fluid| of(Form::Film, ALL, "film_force", film(setup, fluid))));
    Ok(found)
}

/// Largest relative difference of `values` and the `exact` ones.
fn largest(values: impl Iterator<Item = f64>, exact: Vec<f64>) -> f64 {
    values.zip(exact).map(|(value, exact)| (value / exact - 1.0).abs()).fold(0.0, f64::max)
}

fn plate(setup: &PlateImpact) -> Result<f64> {
    let plate = &setup.plate;
    let material = &plate.material;
    let rigidity = circular_plate::rigidity(material.youngs_modulus, material.poisson_ratio, plate.thickness);
    let exact = circular_plate::frequencies(
        plate.edge,
        material.poisson_ratio,
        plate.radius,
        rigidity,
        material.density * plate.thickness,
        MOUNTED_MODES,
    );
    let modes = kirchhoff::modes(plate, MOUNTED_MODES)?;
    let elastic = modes.omega.into_iter().filter(|omega| *omega > 0.0);
    Ok(largest(elastic.map(|omega| omega / TAU), exact))
}

fn beam(bender: &Bender) -> Result<f64> {
    let Bender { length, bending_stiffness, line_mass, tip_mass, .. } = *bender;
    let exact = cantilever::frequencies(length, bending_stiffness, line_mass, tip_mass, MOUNTED_MODES);
    let omega = Beam::new(bender, MODES)?.omega;
    Ok(largest(omega.into_iter().map(|omega| omega / TAU), exact))
}

/// A plate that does not move.
fn rigid_plate() -> ModalBody {
    ModalBody { omega: vec![], damping_ratio: vec![], participation: vec![], residual: None }
}

/// The outer body on a plate that does not move.
fn contact(setup: &PlateImpact) -> Result<f64> {
    let system = setup.rigid_system(&rigid_plate(), [0.0; 2]);
    let hit = system.hertz_impact();
    let run = integrate(&system, &Options { end_time: Some(2.0 * hit.duration()), ..Options::default() })?;
    Ok((run.contacts[0].force_peak / hit.force_peak() - 1.0).abs())
}

/// Outer body and plate as Maxwell fluids that relax in a hundred contacts, the plate not moving: of the speed 4/9 T/tau is lost (Hunter,
/// The Hertz contact problem, J. Mech. Phys. Solids 8, 1960, 219), to first order in T/tau.
fn lost_speed(setup: &PlateImpact) -> Result<f64> {
    let mut maxwell = PlateImpact { fluid: None, ..setup.clone() };
    let elastic = maxwell.rigid_system(&rigid_plate(), [0.0; 2]);
    let duration = elastic.hertz_impact().duration();
    for material in [&mut maxwell.outer.material, &mut maxwell.plate.material] {
        material.relaxation = vec![Relaxation { ratio: 1.0, time: duration / SHORT }];
        material.hardening = None;
    }
    let system = maxwell.rigid_system(&rigid_plate(), [0.0; 2]);
    let options = Options { end_time: Some(2.0 * duration), ..Options::default() };
    let run = match maxwell.memory(&system)? {
        Some(memory) => memory::integrate(&system, &memory, &options)?.0,
        None => integrate(&system, &options)?,
    };
    let lost = 1.0 - run.velocity[0] / maxwell.outer.speed;
    Ok((lost / (4.0 / 9.0 * SHORT) - 1.0).abs())
}

/// A plane that the inner body nears.
struct Plane {
    gap: f64,
    speed: f64,
}

impl Profile for Plane {
    fn gap(&self, _: f64) -> f64 {
        self.gap
    }

    fn rate(&self, _: Ring, _: f64) -> f64 {
        -self.speed
    }
}

/// The film at four times its minimal gap, where that gap is not in force.
fn film(setup: &PlateImpact, fluid: &Fluid) -> f64 {
    let (tip, rim) = (setup.inner.shape.tip_radius(), FluidForces::rim(&setup.plate, &setup.inner));
    let plane = Plane { gap: 4.0 * fluid.minimum_gap, speed: setup.outer.speed };
    let mut forces = FilmForces::default();
    Film::new(Viscosity::new(fluid), fluid.minimum_gap, tip, rim, CELLS).solve(&plane, &mut forces);
    let edge = plane.gap + 0.5 * rim * rim / tip;
    let taylor = 6.0 * PI * fluid.viscosity * tip * tip * plane.speed / plane.gap;
    (forces.force / (taylor * (1.0 - plane.gap / edge).powi(2)) - 1.0).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn of(text: &str) -> Vec<ClosedForm> {
        let scene = Scene::parse("scene.toml", text).expect("shipped scene");
        closed_forms(scene.plate_impact().expect("a plate")).expect("closed forms")
    }

    /// Bounds are those of the parts' discretisations; none is exact by being the same formula.
    #[test]
    fn parts_of_the_models_are_as_close_as_they_are_fine() {
        let wet = of(include_str!("../../../../scenes/examples/wet-valve-plate.toml"));
        let bender = of(include_str!("../../../../scenes/examples/rocker-bender.toml"));
        let polymer = of(include_str!("../../../../scenes/validation/relaxing-plate.toml"));
        let bound = |form: Form| match form {
            Form::CircularPlate => 1e-8,
            Form::Hertz => 1e-6,
            Form::Cantilever | Form::Film => 2e-3,
            Form::Hunter => 5e-3,
        };
        for found in wet.iter().chain(&bender).chain(&polymer) {
            assert!(found.relative > 0.0 && found.relative < bound(found.form), "{found:?}");
        }
        let forms = |found: &[ClosedForm]| found.iter().map(|f| f.form).collect::<Vec<_>>();
        assert_eq!(forms(&wet), [Form::CircularPlate, Form::Hertz, Form::Film]);
        assert_eq!(forms(&bender), [Form::CircularPlate, Form::Cantilever]);
        assert_eq!(forms(&polymer), [Form::CircularPlate, Form::Hertz, Form::Hunter]);
    }
}
