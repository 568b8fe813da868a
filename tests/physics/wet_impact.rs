//! Impacts in a fluid (section 3.5 of the paper): the implicit integrator against explicit Runge-Kutta, against the
//! dry integrator, conservation and closed forms.

use crate::common::scaled_plate;
use crate::runge_kutta::final_velocities;
use approx::assert_relative_eq;
use impactcheck::body::continuum::{self, MeshOptions};
use impactcheck::body::kirchhoff;
use impactcheck::dynamics::MovingBody;
use impactcheck::dynamics::integration::{Integration, Options};
use impactcheck::dynamics::integrator;
use impactcheck::dynamics::system::System;
use impactcheck::dynamics::wet;
use impactcheck::dynamics::wet::FluidForces;
use impactcheck::fluid::added_mass::immersed;
use impactcheck::kinds::plate_impact::PlateImpact;
use impactcheck::scene::{Bender, Edge, Fluid, Shape, ShearThinning};

fn water() -> Fluid {
    Fluid {
        viscosity: 1e-3,
        density: 1e3,
        minimum_gap: 0.25e-6,
        squeeze_film: true,
        added_mass_frequency_ratio: 1.0,
        plate_damping_ratio: 0.0,
        drag_coefficient: 0.0,
        shear_thinning: None,
    }
}

/// Titanium plate of section 4.2.2 between steel spheres of 1.5 mm.
fn valve(fluid: Fluid) -> PlateImpact {
    let mut setup = scaled_plate(1.5e-3, 0.5);
    let titanium = &mut setup.plate.material;
    (titanium.youngs_modulus, titanium.poisson_ratio, titanium.density) = (115e9, 0.37, 4430.0);
    (setup.plate.radius, setup.plate.thickness) = (5.5e-3, 0.3e-3);
    setup.fluid = Some(fluid);
    setup
}

struct Wet {
    system: System,
    fluid: FluidForces,
}

impl Wet {
    fn new(setup: &PlateImpact, modes: usize) -> Self {
        Self::with_cells(setup, modes, 64)
    }

    fn with_cells(setup: &PlateImpact, modes: usize, cells: usize) -> Self {
        let fluid = setup.fluid.as_ref().expect("fluid");
        assert_eq!(fluid.added_mass_frequency_ratio, 1.0, "the shapes below are those of the dry plate");
        let plate = immersed(kirchhoff::modes(&setup.plate, modes).unwrap(), fluid);
        let bodies = MovingBody::both(&setup.outer, &setup.inner).unwrap();
        let shapes = |radii: &[f64]| kirchhoff::UnitPlates::default().shapes(&setup.plate, modes, radii);
        let forces = FluidForces::with_cells(fluid, &setup.plate, &setup.inner, cells, shapes);
        Self {
            system: System::of(&bodies, &plate, &setup.plate.material, [0.0; 2]),
            fluid: forces.unwrap().expect("film or drag"),
        }
    }

    fn run(&self, tolerance: f64) -> Integration {
        self.run_to(tolerance, None)
    }

    fn run_to(&self, tolerance: f64, end_time: Option<f64>) -> Integration {
        let options = Options { tolerance, end_time, ..Options::default() };
        wet::integrate(&self.system, &self.fluid, &options).unwrap()
    }

    fn efficiency(&self, result: &Integration) -> f64 {
        let system = &self.system;
        system.masses[1] * result.velocity[1].powi(2) / (system.masses[0] * system.speed.powi(2))
    }

    /// Velocity of the inner body after `steps` explicit steps of `h` s.
    fn runge_kutta(&self, h: f64, steps: usize) -> f64 {
        final_velocities(&self.system, Some(&self.fluid), h, steps)[1]
    }
}

/// Impacts that differ in what they exercise.
fn cases() -> Vec<(&'static str, PlateImpact)> {
    let viscous = valve(Fluid { viscosity: 0.05, drag_coefficient: 0.4, ..water() });
    let mut gap = valve(Fluid { plate_damping_ratio: 0.03, ..water() });
    gap.inner.gap = 3e-6;
    let mut free = valve(water());
    free.plate.edge = Edge::Free;
    let thinning = ShearThinning { infinite_shear_viscosity: 1e-3, relaxation_time: 1e-3, power_index: 0.4 };
    let blood = valve(Fluid { viscosity: 0.05, shear_thinning: Some(thinning), ..water() });
    vec![
        ("water", valve(water())),
        ("50 mPa s and drag", viscous),
        ("gap, damped plate", gap),
        ("free plate", free),
        ("shear-thinning", blood),
    ]
}

#[test]
fn same_velocity_as_explicit_runge_kutta() {
    for (name, setup) in cases() {
        let wet = Wet::new(&setup, 4);
        let (h, steps) = (4e-9, 10_000);
        let ours = wet.run_to(1e-8, Some(h * steps as f64)).velocity[1];
        let theirs = wet.runge_kutta(h, steps);
        println!("{name}: {ours:.9} {theirs:.9}");
        assert_relative_eq!(ours, theirs, max_relative = 3e-6);
    }
}

#[test]
fn energy_and_momentum_are_accounted_for() {
    for (name, setup) in cases() {
        let wet = Wet::new(&setup, 16);
        let result = wet.run(1e-7);
        let losses = result.losses;
        println!(
            "{name}: energy {:.1e}, momentum {:.1e}, {} steps, {losses:?}",
            result.energy_residual, result.momentum_residual, result.steps
        );
        assert!(result.energy_residual < 2e-6, "{name}: {:e}", result.energy_residual);
        assert!(result.momentum_residual < 1e-8, "{name}: {:e}", result.momentum_residual);
        assert!(losses.squeeze_film > 1e-4 * wet.system.initial_energy(), "{name}");
        let fluid = setup.fluid.as_ref().expect("fluid");
        assert_eq!(losses.drag > 0.0, fluid.drag_coefficient > 0.0, "{name}");
        assert_eq!(losses.plate_damping > 0.0, fluid.plate_damping_ratio > 0.0, "{name}");
    }
}

#[test]
fn error_follows_the_tolerance_and_the_square_of_the_cells() {
    for (name, setup) in cases().into_iter().take(3) {
        let wet = Wet::new(&setup, 10);
        let exact = wet.efficiency(&wet.run(1e-9));
        for tolerance in [1e-4, 1e-6] {
            let error = (wet.efficiency(&wet.run(tolerance)) / exact - 1.0).abs();
            println!("{name}: tolerance {tolerance:.0e}, error {error:.1e}");
            assert!(error < 3.0 * tolerance, "{name}: {error:e} at {tolerance:e}");
        }
        let with_cells = |cells| {
            let wet = Wet::with_cells(&setup, 10, cells);
            wet.efficiency(&wet.run(1e-6))
        };
        let fine = with_cells(256);
        let errors = [32, 64].map(|cells| (with_cells(cells) - fine).abs());
        println!("{name}: error of the efficiency with 32 and 64 cells {errors:?}");
        assert!(errors[1] < 5e-4 && errors[1] < 0.4 * errors[0], "{name}: {errors:?}");
    }
}

/// A film that stops in picoseconds what it damps: Gauss's points, which leave that ringing, took 11 512 steps.
#[test]
fn a_film_much_stiffer_than_the_steps_does_not_shorten_them() {
    let wet = Wet::new(&valve(Fluid { viscosity: 500.0, ..water() }), 4);
    let result = wet.run(1e-6);
    println!("{} steps, momentum {:.1e}", result.steps, result.momentum_residual);
    assert!(result.steps < 4000, "{} steps", result.steps);
    assert!(result.momentum_residual < 1e-8 && result.energy_residual < 1e-5, "{result:?}");
}

#[test]
fn a_fluid_without_viscosity_changes_nothing() {
    let mut bender = valve(water());
    bender.outer.shape = Shape::Bender(Bender {
        length: 14e-3,
        bending_stiffness: 2.3e-3,
        line_mass: 0.04,
        tip_mass: 128e-6,
        tip_radius: 4e-3,
        discharge_time: 0.0,
        strike_at: 0.0,
    });
    for (name, mut setup) in [("sphere", valve(water())), ("bender", bender)] {
        setup.fluid.as_mut().expect("fluid").viscosity = 1e-15;
        let wet = Wet::new(&setup, 8);
        let (ours, dry) = (wet.run(1e-9), {
            let options = Options { tolerance: 1e-9, ..Options::default() };
            integrator::integrate(&wet.system, &options).unwrap()
        });
        assert_relative_eq!(ours.velocity[1], dry.velocity[1], max_relative = 1e-8);
        for i in 0..2 {
            assert_relative_eq!(ours.contacts[i].force_peak, dry.contacts[i].force_peak, max_relative = 1e-5);
        }
        assert_relative_eq!(ours.contacts[1].end, dry.contacts[1].end, max_relative = 1e-5);
        assert_eq!(ours.contacts[1].contacts, dry.contacts[1].contacts, "{name}");
    }
}

#[test]
fn no_film_makes_the_integration_fail() {
    // from no contact at all to a film that glues the bodies together
    for gap in [0.0, 1e-9, 1e-6, 20e-6, 10e-3] {
        for viscosity in [1e-6, 1e-3, 1.0, 1e2] {
            for minimum_gap in [5e-9, 0.25e-6] {
                let mut setup = valve(Fluid { viscosity, minimum_gap, ..water() });
                setup.inner.gap = gap;
                let wet = Wet::with_cells(&setup, 6, 32);
                let result = wet.run_to(1e-4, Some(40e-6));
                let case = format!("gap {gap:e}, viscosity {viscosity:e}, minimal gap {minimum_gap:e}");
                println!("{case}: {} steps, energy {:.1e}", result.steps, result.energy_residual);
                assert!(result.velocity.iter().all(|v| v.is_finite()), "{case}");
                assert!(result.energy_residual < 1e-3, "{case}: {:e}", result.energy_residual);
                assert!(wet.efficiency(&result) < 1.0, "{case}");
            }
        }
    }
}

#[test]
fn drag_slows_the_inner_body_by_its_square_law() {
    let setup = valve(Fluid { squeeze_film: false, drag_coefficient: 0.4, ..water() });
    let wet = Wet::new(&setup, 8);
    let (early, late) = (100e-6, 10e-3);
    let [early_v, late_v] = [early, late].map(|end| wet.run_to(1e-9, Some(end)).velocity[1]);
    // m v' = -c_W rho/2 pi R^2 v |v|: 1/v grows linearly
    let rate = 0.4 * 500.0 * std::f64::consts::PI * 1.5e-3_f64.powi(2) / wet.system.masses[1];
    assert_relative_eq!(1.0 / late_v.abs() - 1.0 / early_v.abs(), rate * (late - early), max_relative = 1e-6);
}

#[test]
fn shapes_of_both_plates_under_the_film_agree() {
    // on the patch the continuum plate's shapes are its participations, and a thin one moves as Kirchhoff's: shear and
    // rotary inertia take 3 % off the centre of the third mode
    let plate = valve(water()).plate;
    let (patch, modes, mesh) = ([40e-6; 2], 3, MeshOptions::default());
    let radii = [0.0, 0.5e-3, 1e-3, 1.5e-3];
    let continuum = continuum::face_shapes(&plate, patch, modes, &mesh, &radii).unwrap();
    let body = continuum::plate(&plate, patch, modes, &mesh).unwrap();
    let kirchhoff = kirchhoff::UnitPlates::default().shapes(&plate, modes, &radii).unwrap();
    let participation = kirchhoff::modes(&plate, modes).unwrap().participation;
    for mode in 0..modes {
        assert_relative_eq!(kirchhoff[mode][0], participation[mode][1], max_relative = 1e-12);
        // participations of quick modes are weighted over a patch twice as wide
        assert_relative_eq!(continuum[mode][0], body.participation[mode][1], max_relative = 3e-3);
        let sign = continuum[mode][0].signum();
        for (ours, theirs) in continuum[mode].iter().zip(&kirchhoff[mode]) {
            assert_relative_eq!(sign * ours, *theirs, epsilon = 0.04 * kirchhoff[mode][0]);
        }
    }
}

#[test]
fn added_mass_is_a_heavier_plate() {
    // the mass matrix times nine is a density times nine
    let ratio = 1.0 / 3.0;
    let setup = valve(Fluid { squeeze_film: false, added_mass_frequency_ratio: ratio, ..water() });
    let fluid = setup.fluid.as_ref().expect("fluid");
    let dry = kirchhoff::modes(&setup.plate, 16).unwrap();
    let wet = immersed(dry.clone(), fluid);
    assert_relative_eq!(wet.omega[0], ratio * dry.omega[0], max_relative = 1e-14);
    let mut heavy = setup.clone();
    heavy.plate.material.density *= 9.0;
    heavy.fluid = None;
    let run = |setup: &PlateImpact, plate| {
        integrator::integrate(&setup.rigid_system(&plate, [0.0; 2]), &Options::default()).unwrap().velocity
    };
    let expected = run(&heavy, kirchhoff::modes(&heavy.plate, 16).unwrap());
    let found = run(&setup, wet);
    assert_relative_eq!(found[1], expected[1], max_relative = 1e-9);
    assert_relative_eq!(found[0], expected[0], max_relative = 1e-9);
}
