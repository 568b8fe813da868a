//! Impacts of a series whose bodies are scaled from those of their shape, against bodies meshed for every impact.

use impactcheck::body::cache::Cache;
use impactcheck::kinds::plate_impact::PlateQuantities;
use impactcheck::kinds::plate_impact::errors::largest_error;
use impactcheck::kinds::plate_impact::reduced::{Point, Reduced};
use impactcheck::kinds::plate_impact::shared::SharedBodies;
use impactcheck::scene::{Model, Scene, Setup, Shape, resolve};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::cell::RefCell;

/// Impacts of an impact program: all that leaves the plate's shape alone varies by an order of magnitude.
#[test]
fn impacts_between_scaled_bodies_are_those_between_meshed_ones() {
    let base = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let bodies = SharedBodies::for_varied(["outer.speed", "materials.steel.density"].into_iter());
    let worst = RefCell::new((0.0, ""));
    let config =
        Config { cases: 24, rng_seed: RngSeed::Fixed(3), failure_persistence: None, ..Config::default() };
    let scenes = (-1.0..0.5_f64, -0.4..0.2_f64, -0.4..0.2_f64, -0.5..0.2_f64, -0.5..0.2_f64, -0.7..0.7_f64);
    let impact = |(speed, outer, inner, modulus, density, size): (f64, f64, f64, f64, f64, f64)| {
        let ten = |exponent: f64| 10_f64.powf(exponent);
        let mut scene = base.clone();
        let Setup::PlateImpact(setup) = &mut scene.setup else { panic!("a plate") };
        setup.outer.speed *= ten(speed);
        for material in [&mut setup.plate.material, &mut setup.outer.material, &mut setup.inner.material] {
            material.youngs_modulus *= ten(modulus);
            material.density *= ten(density);
        }
        setup.plate.radius *= ten(size);
        setup.plate.thickness = 2.0 / 33.0 * setup.plate.radius;
        setup.outer.shape = Shape::Sphere { radius: 0.01 * ten(outer + size) };
        setup.inner.shape = Shape::Sphere { radius: 0.01 * ten(inner + size) };
        let point = |model: Reduced| -> Point { model.point(1e-6).unwrap() };
        let ours = point(Reduced::in_series(scene.clone(), Model::C, Some(16), &bodies).unwrap()).quantities;
        let meshed = point(Reduced::new_in(&scene, Model::C, Some(16), &Cache::off()).unwrap()).quantities;
        let speed = scene.plate_impact().unwrap().outer.speed;
        let (error, name): (f64, &str) = largest_error(&ours, &meshed, speed);
        let mut worst = worst.borrow_mut();
        if error > worst.0 {
            *worst = (error, name);
        }
        prop_assert!(error < 5e-4, "{name} is {error:e} off: {ours:?}, {meshed:?}");
        Ok(())
    };
    TestRunner::new(config).run(&scenes, impact).unwrap();
    assert!(worst.borrow().0 > 0.0, "the bodies were meshed: {:?}", worst.borrow());
}

/// A series in which a shape varies meshes every plate.
#[test]
fn plates_of_other_shapes_are_not_scaled() {
    let scene = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let point = |bodies: &SharedBodies| -> PlateQuantities {
        Reduced::in_series(scene.clone(), Model::C, Some(4), bodies).unwrap().point(1e-6).unwrap().quantities
    };
    let meshed = Reduced::new(&scene, Model::C, Some(4)).unwrap().point(1e-6).unwrap().quantities;
    for field in ["plate.thickness", "plate.radius", "materials.steel.poisson_ratio"] {
        assert_eq!(point(&SharedBodies::for_varied(["outer.speed", field].into_iter())), meshed);
    }
    assert_ne!(point(&SharedBodies::for_varied(["outer.speed"].into_iter())), meshed);
}
