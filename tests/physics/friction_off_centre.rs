//! Friction and oblique impacts off the centre of a plate, where forces along the surface act on those across it and contacts move over it.

use super::friction::{run_model, sideways};
use approx::assert_relative_eq;
use impactcheck::dynamics::system::System;
use impactcheck::kinds;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::result::Summary;
use impactcheck::scene::{Model, Scene};

/// An oblique impact off the centre of a plate: results go over into those without friction, as the plate's normal turns in both. A body that
/// slides far away from where it struck is warned of.
#[test]
fn little_friction_is_nearly_none_off_centre() {
    let text = include_str!("../../scenes/validation/off-centre-oblique.toml");
    let run = |text: &str| run_model(Model::B, text);
    let with = |friction: f64| run(&text.replace("friction    = 0.3", &format!("friction = {friction:e}")));
    let (none, little) = (with(0.0), with(1e-7));
    let [smooth, rough] = [&none, &little].map(|summary| summary.sideways.expect("oblique"));
    // what so little friction does itself
    let near = 2.0 * 1e-7 * 0.55;
    assert!((smooth.outer_tangential_velocity_final - rough.outer_tangential_velocity_final).abs() < near);
    let [smooth, rough] =
        [smooth, rough].map(|of| of.inner_tangential_velocity_final.expect("an inner body"));
    assert!((smooth - rough).abs() < near && smooth != 0.0, "{smooth} {rough}");
    let slides = |summary: &Summary| summary.warnings.iter().any(|warning| warning.contains("slides"));
    assert!(!slides(&none));
    let glancing = text.replace("30 deg", "85 deg").replace("\"550 mm/s\"", "\"40 m/s\"");
    assert!(slides(&run(&glancing)));
}

/// Velocities in m/s of both bodies across the plate, and of the outer one along it, after an impact without friction in which the contacts of
/// `system` move over the plate: Lagrange's equations, integrated with steps of one length (Runge and Kutta's fourth order).
fn slid_over(system: &System, arm: f64, along: f64) -> [f64; 3] {
    const STEP: f64 = 5e-9;
    let n = system.size();
    let mut faces = vec![[0.0; 2]; n];
    system.elastic().zip(&system.along).for_each(|(k, along)| faces[k] = *along);
    // coordinates and places along x, then their rates
    let rates = |y: &[f64]| {
        let (q, v) = y.split_at(n + 2);
        let turned = [0, 1].map(|i| (0..n).map(|k| faces[k][i] * q[k]).sum::<f64>() / arm);
        let ways = [0, 1].map(|i| q[n + i] / arm - turned[i]);
        let seen = |i: usize, k: usize| system.approach[i][k] - ways[i] * faces[k][i];
        let forces = [0, 1].map(|i| {
            let approach = (0..n).map(|k| seen(i, k) * q[k]).sum::<f64>() - system.gap[i];
            system.laws[i].force(approach)
        });
        let mut rates = v.to_vec();
        rates.extend((0..n).map(|k| {
            let pressed: f64 = (0..2).map(|i| seen(i, k) * forces[i]).sum();
            -system.oscillators[k].omega.powi(2) * q[k] - pressed
        }));
        rates.extend([0, 1].map(|i| forces[i] * turned[i] / system.masses[i]));
        (rates, forces)
    };
    let (mut y, v) = system.initial_state();
    y.extend([0.0; 2]);
    y.extend(v);
    y.extend([along, 0.0]);
    let moved = |y: &[f64], rates: &[f64], h: f64| -> Vec<f64> {
        y.iter().zip(rates).map(|(y, rate)| y + h * rate).collect()
    };
    let mut open = 0;
    while open < 4000 {
        let (first, forces) = rates(&y);
        open = if forces == [0.0; 2] { open + 1 } else { 0 };
        let (second, _) = rates(&moved(&y, &first, 0.5 * STEP));
        let (third, _) = rates(&moved(&y, &second, 0.5 * STEP));
        let (fourth, _) = rates(&moved(&y, &third, STEP));
        for (k, y) in y.iter_mut().enumerate() {
            *y += STEP / 6.0 * (first[k] + 2.0 * (second[k] + third[k]) + fourth[k]);
        }
    }
    let v = &y[n + 2..];
    let [outer, inner] = system.of_bodies(&v[..n]);
    [outer, inner, v[n]]
}

/// A body that slides over the plate, away from its centre, is where the plate moves less.
#[test]
fn a_contact_that_slides_meets_the_plate_where_it_is() {
    let text =
        include_str!("../../scenes/validation/off-centre-oblique.toml").replace("friction    = 0.3", "");
    let (along, across) = (3.0, 0.5);
    let text = text
        .replace("\"550 mm/s\"", &format!("{:e}", f64::hypot(along, across)))
        .replace("\"30 deg\"", &format!("{:e}", f64::atan2(along, across)));
    let scene = Scene::parse("test.toml", &text).expect("valid");
    let model = Reduced::new(&scene, Model::B, Some(6)).expect("model");
    let summary = model.run(1e-8).expect("run");
    let expected = slid_over(model.system(), 1e-3, along);
    let found = [
        summary.value("outer_velocity_final").expect("a velocity"),
        summary.value("inner_velocity_final").expect("a velocity"),
        sideways(&summary)[0],
    ];
    // what the way changes is a hundred times as much
    let still = slid_over(model.system(), 1e-3, 0.0);
    for i in 0..2 {
        assert!((still[i] - expected[i]).abs() > 1e-3, "{still:?} {expected:?}");
    }
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-5, "{found} {expected}");
    }
    assert!(summary.energy_residual.is_some_and(|residual| residual < 1e-7), "{summary:?}");
}

/// Where friction changes a force to more than its double, in a thick plate with a small body behind, there is a result.
#[test]
fn strong_friction_off_centre_has_a_result() {
    let summary = run_model(
        Model::B,
        r#"
name = "test"
kind = "plate-impact"
friction = 1.5
materials.steel = { youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7780 }
plate = { radius = "6 mm", thickness = "4 mm", edge = "clamped", material = "steel" }
outer = { kind = "sphere", radius = "6 mm", material = "steel", speed = "100 mm/s", offset = "0.6 mm", angle = "85 deg" }
inner = { kind = "sphere", radius = "2 mm", material = "steel" }
"#,
    );
    assert!(summary.value("outer_force_peak").is_some_and(|peak| peak > 0.0));
    assert!(summary.energy_residual.is_some_and(|residual| residual < 1e-6));
}

/// Off-centre friction acts back on the contact forces: exactly in every step, so that a coarse tolerance moves neither velocities nor force
/// peaks.
#[test]
fn friction_off_centre_keeps_the_tolerance_of_time() {
    let text = include_str!("../../scenes/validation/off-centre-oblique.toml");
    let scene = Scene::parse("scene.toml", text).expect("valid");
    let model = kinds::of(&scene).model(&scene, Model::B, None).expect("model");
    let [coarse, fine] = [1e-4, 1e-9].map(|tolerance| model.run(tolerance).expect("run"));
    for name in ["outer_force_peak", "inner_force_peak", "outer_velocity_final", "inner_velocity_final"] {
        let [coarse, fine] = [&coarse, &fine].map(|summary| summary.value(name).expect("a value"));
        assert_relative_eq!(coarse, fine, max_relative = 1e-5);
    }
    for (summary, bound) in [(coarse, 1e-6), (fine, 1e-10)] {
        assert!(summary.energy_residual.is_some_and(|residual| residual < bound), "{summary:?}");
    }
}

/// Friction that excites the plate's vibrations ever more: the rounds of normal and tangential motion come near before they diverge. The
/// result is the nearest, with a warning that has its error, and other tolerances find the same within it.
#[test]
fn friction_that_excites_vibrations_states_its_error() {
    let scene = Scene::parse(
        "test.toml",
        r#"
name = "test"
kind = "plate-impact"
friction = 0.121441
materials.plate = { youngs_modulus = 4.1412e9, poisson_ratio = 0.321607, density = 3050.16 }
materials.bodies = { youngs_modulus = 20.3638e9, poisson_ratio = 0.181258, density = 1510.5 }
plate = { radius = "8 mm", thickness = "1 mm", edge = "clamped", material = "plate" }
outer = { kind = "sphere", radius = 29.3133e-3, material = "bodies", speed = 54.4162e-3, angle = 0.836842, offset = 2.35322e-3 }
inner = { kind = "sphere", radius = 31.7775e-3, material = "bodies" }
"#,
    );
    let scene = scene.expect("valid");
    let model = kinds::of(&scene).model(&scene, Model::B, None).expect("model");
    let found = [1e-3, 1e-5, 1e-7].map(|tolerance| model.run(tolerance).expect("run"));
    let warned = |summary: &&Summary| summary.warnings.iter().any(|text| text.contains("have not converged"));
    assert!(found.iter().filter(warned).count() > 0);
    for name in ["outer_force_peak", "inner_force_peak", "outer_velocity_final", "inner_velocity_final"] {
        let values = found.each_ref().map(|summary| summary.value(name).expect("a value"));
        assert_relative_eq!(values[0], values[1], max_relative = 1.5e-2);
        assert_relative_eq!(values[2], values[1], max_relative = 1.5e-2);
    }
}
