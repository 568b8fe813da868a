//! Impacts of a series whose bodies are scaled from those of their shape, against bodies meshed for every impact.

use impactcheck::body::cache::Cache;
use impactcheck::kinds::plate_impact::PlateQuantities;
use impactcheck::kinds::plate_impact::errors::largest_error;
use impactcheck::kinds::plate_impact::reduced::{Point, Reduced};
use impactcheck::kinds::plate_impact::shared::SharedBodies;
use impactcheck::scene::{Model, Scene, Shape, resolve};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::cell::RefCell;

/// Impacts of an impact program: all that leaves the plate's shape alone varies by an order of magnitude.
#[test]
fn impacts_between_scaled_bodies_are_those_between_meshed_ones() {
    let base = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let setup = base.plate_impact().unwrap();
    let bodies = SharedBodies::for_varied([("outer.speed", [0.05, 2.0])], setup, 24);
    let worst = RefCell::new((0.0, ""));
    let config =
        Config { cases: 24, rng_seed: RngSeed::Fixed(3), failure_persistence: None, ..Config::default() };
    let scenes = (-1.0..0.5_f64, -0.4..0.2_f64, -0.4..0.2_f64, -0.5..0.2_f64, -0.5..0.2_f64, -0.7..0.7_f64);
    let impact = |(speed, outer, inner, modulus, density, size): (f64, f64, f64, f64, f64, f64)| {
        let ten = |exponent: f64| 10_f64.powf(exponent);
        let mut scene = base.clone();
        let mut setup = scene.plate_impact().unwrap().clone();
        setup.outer.speed *= ten(speed);
        for material in [&mut setup.plate.material, &mut setup.outer.material, &mut setup.inner.material] {
            material.youngs_modulus *= ten(modulus);
            material.density *= ten(density);
        }
        setup.plate.radius *= ten(size);
        setup.plate.thickness = 2.0 / 33.0 * setup.plate.radius;
        setup.outer.shape = Shape::Sphere { radius: 0.01 * ten(outer + size) };
        setup.inner.shape = Shape::Sphere { radius: 0.01 * ten(inner + size) };
        scene.setup = setup.into();
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

/// A short series in which a shape varies meshes every plate.
#[test]
fn plates_of_other_shapes_are_not_scaled() {
    let scene = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let point = |bodies: &SharedBodies| -> PlateQuantities {
        Reduced::in_series(scene.clone(), Model::C, Some(4), bodies).unwrap().point(1e-6).unwrap().quantities
    };
    let meshed = Reduced::new(&scene, Model::C, Some(4)).unwrap().point(1e-6).unwrap().quantities;
    let setup = scene.plate_impact().unwrap();
    let of = |field: &'static str, impacts: usize| {
        let varied = [("outer.speed", [0.05, 2.0]), (field, [0.25, 0.35])];
        SharedBodies::for_varied(varied, setup, impacts)
    };
    for field in ["plate.thickness", "plate.radius", "materials.steel.poisson_ratio"] {
        assert_eq!(point(&of(field, 3)), meshed);
    }
    assert_ne!(point(&of("inner.gap", 300)), meshed);
}

/// Impacts of a series in which the plate's shape varies too: its bodies lie between those of a few shapes.
#[test]
fn impacts_between_bodies_between_shapes_are_those_between_meshed_ones() {
    let base = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let varied = [("plate.thickness", [1.8e-3, 2.4e-3]), ("materials.steel.poisson_ratio", [0.27, 0.33])];
    let bodies = SharedBodies::for_varied(varied, base.plate_impact().unwrap(), 1000);
    for (thickness, ratio, speed) in [(1.85e-3, 0.28, 0.3), (2.1e-3, 0.3, 0.6), (2.37e-3, 0.325, 1.0)] {
        let mut scene = base.clone();
        let mut setup = scene.plate_impact().unwrap().clone();
        setup.plate.thickness = thickness;
        setup.outer.speed = speed;
        for material in [&mut setup.plate.material, &mut setup.outer.material, &mut setup.inner.material] {
            material.poisson_ratio = ratio;
        }
        scene.setup = setup.into();
        let point = |model: Reduced| -> Point { model.point(1e-6).unwrap() };
        let ours = point(Reduced::in_series(scene.clone(), Model::C, Some(16), &bodies).unwrap()).quantities;
        let meshed = point(Reduced::new_in(&scene, Model::C, Some(16), &Cache::off()).unwrap()).quantities;
        let (error, name): (f64, &str) = largest_error(&ours, &meshed, speed);
        assert!(error > 0.0 && error < 5e-4, "{name} is {error:e} off: {ours:?}, {meshed:?}");
    }
}
