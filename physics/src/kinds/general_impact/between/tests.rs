//! Elastic bodies under impact against closed forms.

use super::super::BodyMaterials;
use super::*;
use crate::analytical::hertz::HertzImpact;
use crate::body::solid::{CellMaterials, ContactInfo, StruckPoint, StruckSolid, SurfacePoint, boxes};
use crate::dynamics::integrate;
use crate::dynamics::integration::{Integration, Options};
use approx::assert_relative_eq;

const STEEL: [f64; 3] = [210e9, 0.3, 7780.0];

fn steel() -> Material {
    Material::elastic("steel", STEEL[0], STEEL[1], STEEL[2])
}

/// Whether a place is held, by its coordinates and the lengths of the block.
type Held = fn([f64; 3], [f64; 3]) -> bool;

/// A steel block of the lengths `size` m in `bricks`, graded towards the middle of its upper face, struck there at `at` (x, y; from the
/// middle) by a compact steel body with a tip of `radius` m, the mass of such a sphere and `speed` m/s; nodes for which `fixed` holds do not move.
fn struck(
    size: [f64; 3],
    bricks: [usize; 3],
    at: [f64; 2],
    [radius, speed]: [f64; 2],
    (graded, fixed): (bool, Held),
) -> (System, Between, Integration) {
    // finer towards the middle of the face: squares of the distance
    let grade = |x: f64, half: f64| {
        let share = x / half - 1.0;
        half * share * if graded { share.abs() } else { 1.0 }
    };
    let place = |[x, y, z]: [f64; 3]| {
        let below = size[2] - z;
        let z = if graded { -below * below / size[2] } else { -below };
        [grade(x, 0.5 * size[0]), grade(y, 0.5 * size[1]), z]
    };
    let mesh = boxes(size, bricks, 2, place);
    // midside nodes in the middle of the graded edges
    let fixed: Vec<bool> = mesh.points.iter().map(|p| fixed([p.x, p.y, p.z], size)).collect();
    let side = |n: usize| if graded { 2.0 / bricks[n] as f64 } else { 1.0 } * size[n] / bricks[n] as f64;
    let element_size = side(0).min(side(1));
    let edge = 0.5 * size[1] - at[1].abs();
    let contact = ContactInfo {
        point: [at[0], at[1], 0.0],
        distance: 0.0,
        normal: [0.0, 0.0, 1.0],
        curvatures: [0.0; 2],
        curvature_source: "cad".into(),
        element_size,
        wall: size[2],
        layers: bricks[2] as f64,
        edge_distance: edge.min(0.5 * size[0] - at[0].abs()),
        material: None,
        material_distance: f64::INFINITY,
    };
    let solid =
        StruckSolid::new(&mesh, &CellMaterials::one(steel()), &fixed, &[contact.struck()]).expect("solid");
    let elastic =
        ElasticBody { own: solid, other: None, contacts: vec![contact], warnings: Vec::new(), rubs: false };
    let body = Body {
        file: "block.msh".into(),
        content: String::new(),
        unit: None,
        materials: BodyMaterials::Material(steel()),
        fixed: Vec::new(),
        element_size: None,
        damping_ratio: 0.0,
        at: [None, None],
        disc: None,
    };
    let mass = Shape::Sphere { radius }.mass(&steel());
    let outer = Outer::centred(Shape::Compact { mass, tip_radius: radius }, steel(), speed);
    let moving = MovingBody::outer(&outer).expect("a body");
    let (system, between) = Between::joined(elastic, &body, moving, &outer, None).expect("joined");
    let end = 4.0 * system.hertz_impact().duration();
    let options = Options { tolerance: 1e-8, end_time: Some(end), ..Options::default() };
    let result = integrate(&system, None, &options).expect("a result");
    (system, between, result)
}

/// A body much larger than the contact is a half-space, but moves away: Hertz's impact with the reduced mass; a free one keeps the
/// momentum.
#[test]
fn a_free_block_is_a_half_space_that_moves() {
    let size = [20e-3, 20e-3, 20e-3];
    let (system, between, result) = struck(size, [8, 8, 6], [0.0; 2], [2e-3, 0.1], (true, |_, _| false));
    let mass = system.masses[0];
    let block = STEEL[2] * size.iter().product::<f64>();
    assert_relative_eq!(between.free_mass.expect("free"), block, max_relative = 1e-12);
    let hit =
        HertzImpact { mass: mass * block / (mass + block), speed: 0.1, stiffness: system.laws[0].stiffness };
    let contact = &result.contacts[0];
    assert_relative_eq!(contact.force_peak, hit.force_peak(), max_relative = 5e-3);
    assert!(result.momentum_residual < 1e-9, "{}", result.momentum_residual);
    let [moved, _] = between.velocities(contact.impulse, 0.0);
    assert_relative_eq!(mass * result.velocity[0] + block * moved, -mass * 0.1, max_relative = 1e-6);
}

/// The block is struck off its middle: it turns, and what it gets at the contact is that of the rigid body with its moments of
/// inertia, 1/M_eff = 1/M + d^2/J.
#[test]
fn a_free_block_struck_off_centre_turns() {
    let size = [20e-3, 20e-3, 20e-3];
    let (system, between, _) = struck(size, [10, 10, 4], [4e-3, 0.0], [2e-3, 0.1], (false, |_, _| false));
    let block = STEEL[2] * size.iter().product::<f64>();
    let inertia = block * (size[0] * size[0] + size[2] * size[2]) / 12.0;
    let mobility: f64 = system.rigid().map(|k| system.approach[0][k].powi(2)).sum();
    // the pressure's own width adds a little to the arm: d^2 over the circle, in the middle d^2 itself
    assert_relative_eq!(mobility, 1.0 / block + 4e-3f64.powi(2) / inertia, max_relative = 1e-3);
    // the same along x, on the arm of half the height; and what a force along x moves across the face
    let along: f64 = between.rigid.iter().map(|motion| motion.along[0].powi(2)).sum();
    assert_relative_eq!(along, 1.0 / block + 10e-3f64.powi(2) / inertia, max_relative = 1e-3);
    let across: f64 = between.rigid.iter().map(|motion| motion.along[0] * motion.approach[0]).sum();
    assert_relative_eq!(across, -4e-3 * 10e-3 / inertia, max_relative = 1e-3);
    // along y the same arm and another one about z, but the blow does not turn it that way
    let rigid = between.aside.iter().filter(|mode| mode.oscillator.omega == 0.0);
    let [aside, moved] = rigid.fold([0.0; 2], |[aside, moved], motion| {
        [aside + motion.along[0].powi(2), moved + motion.along[0] * motion.approach[0]]
    });
    assert_relative_eq!(aside, along + 4e-3f64.powi(2) / inertia, max_relative = 1e-3);
    assert!(moved.abs() < 1e-3 * across.abs(), "{moved}");
}

/// The end of a rod that is held at its other end gives way sideways as a cantilever does, L^3/(3 E I) and 6 L/(5 G A), if friction acts
/// there: forces along the rod alone do not bend it.
#[test]
fn a_rubbing_rod_bends_as_a_cantilever() {
    let (side, length) = (5e-3, 40e-3);
    let mesh = boxes([side, side, length], [4, 4, 24], 2, |p| p);
    let fixed: Vec<bool> = mesh.points.iter().map(|p| p.z == 0.0).collect();
    let at = SurfacePoint { point: Vector3::new(0.5 * side, 0.5 * side, length), normal: Vector3::z() };
    let [modulus, nu, _] = STEEL;
    let bending = length.powi(3) / (3.0 * modulus * side.powi(4) / 12.0);
    let shear = 1.2 * length / (0.5 * modulus / (1.0 + nu) * side * side);
    let flexibility = |rubs: bool| -> f64 {
        let point = StruckPoint { at, circles: [1e-3, 1.4e-3, 2e-3], rubs };
        let solid = StruckSolid::new(&mesh, &CellMaterials::one(steel()), &fixed, &[point]).expect("a rod");
        let solid = solid.of_material(&steel());
        solid.along.iter().zip(&solid.omega).map(|([along, _], omega)| (along / omega).powi(2)).sum()
    };
    let off = |rubs: bool| flexibility(rubs) / (bending + shear) - 1.0;
    assert!(off(true).abs() < 0.015, "{}", off(true));
    // an unsymmetrical mesh bends a little all the same
    assert!(off(false) < -0.02, "{}", off(false));
}

/// What half-spaces give way along the surface is taken out of the modes once, and nothing of what forces do elsewhere or across the surface.
#[test]
fn the_contacts_own_tangential_flexibility_counts_once() {
    let mesh = boxes([20e-3, 16e-3, 6e-3], [10, 8, 3], 2, |p| p);
    let fixed: Vec<bool> = mesh.points.iter().map(|p| p.x == 0.0).collect();
    let at = |z: f64| SurfacePoint {
        point: Vector3::new(12e-3, 8e-3, z),
        normal: Vector3::new(0.0, 0.0, if z > 0.0 { 1.0 } else { -1.0 }),
    };
    let points = [6e-3, 0.0].map(|z| StruckPoint { at: at(z), circles: [2e-3, 2.8e-3, 4e-3], rubs: true });
    let solid = StruckSolid::new(&mesh, &CellMaterials::one(steel()), &fixed, &points).expect("a block");
    let solid = solid.of_material(&steel());
    let beyond = solid.along_beyond_half_spaces([&steel(), &steel()]);
    let flexibility = |along: &[[f64; 2]], i: usize, other: &dyn Fn(usize) -> f64| -> f64 {
        (0..along.len()).map(|k| along[k][i] * other(k) / solid.omega[k].powi(2)).sum()
    };
    let [modulus, nu, _] = STEEL;
    let local = 0.15 * (2.0 - nu) / (0.5 * modulus / (1.0 + nu) * 2.8e-3);
    for i in 0..2 {
        let own = |along: &[[f64; 2]]| flexibility(along, i, &|k| along[k][i]);
        assert_relative_eq!(own(&solid.along) - own(&beyond), local, max_relative = 1e-6);
        assert!(own(&beyond) > 0.0);
        let others: [&dyn Fn(usize) -> f64; 3] =
            [&|k| solid.participation[k][0][1], &|k| solid.participation[k][1][1], &|k| {
                solid.along[k][1 - i]
            }];
        for other in others {
            let [before, after] = [&solid.along, &beyond].map(|along| flexibility(along, i, other));
            assert_relative_eq!(before, after, epsilon = 1e-6 * local);
        }
    }
}

/// A sphere against the end of a long rod, until the echo: m s'' = -F, d' = s' - F/(rho c A), F = k d^(3/2) with the bar's wave speed c.
#[test]
fn a_rod_takes_energy_away_as_a_wave() {
    let (side, length, speed) = (10e-3, 360e-3, 0.05);
    // the rod hangs down from its face; its end is small against the contact, so that the half-space is one
    let (system, _, result) =
        struck([side, side, length], [6, 6, 48], [0.0; 2], [10e-3, speed], (false, |_, _| false));
    let law = system.laws[0];
    let impedance = STEEL[2] * (STEEL[0] / STEEL[2]).sqrt() * side * side;
    let mass = system.masses[0];
    let (mut velocity, mut depth, mut peak, step) = (speed, 0.0_f64, 0.0_f64, 2e-9);
    let rate = |velocity: f64, depth: f64| {
        let force = law.force(depth);
        [-force / mass, velocity - force / impedance]
    };
    while velocity > 0.0 || depth > 0.0 {
        let [a, d] = rate(velocity, depth);
        let [a2, d2] = rate(velocity + 0.5 * step * a, depth + 0.5 * step * d);
        velocity += step * a2;
        depth += step * d2;
        peak = peak.max(law.force(depth));
    }
    let restitution = result.velocity[0] / speed;
    let expected = -velocity / speed;
    assert!(expected < 0.95, "the rod is heavy: {expected}");
    assert_relative_eq!(restitution, expected, max_relative = 0.01);
    assert_relative_eq!(result.contacts[0].force_peak, peak, max_relative = 0.01);
}

/// Cantilever: frequencies of Euler and Bernoulli with Timoshenko's correction for shear and rotation (first order, shear coefficient
/// 5/6), and the static deflection under the force.
#[test]
fn a_cantilever_bends_as_timoshenkos_beam() {
    let [length, width, height] = [80e-3, 6e-3, 4e-3];
    let x = 0.4 * length;
    let (system, ..) = struck(
        [length, width, height],
        [48, 4, 3],
        [x, 0.0],
        [3e-3, 0.1],
        (false, |[x, ..], [length, ..]| x < -0.5 * length + 1e-9),
    );
    let (e, density) = (STEEL[0], STEEL[2]);
    let area = width * height;
    let inertia = width * height.powi(3) / 12.0;
    let shear = 1.0 + 2.0 * (1.0 + STEEL[1]) * 6.0 / 5.0;
    // those in the plane of the force: others move with it for want of symmetry of the mesh alone
    let moved = |k: &usize| system.approach[0][*k].abs();
    let most = system.elastic().map(|k| moved(&k)).fold(0.0, f64::max);
    let modes: Vec<usize> = system.elastic().filter(|k| moved(k) > 0.05 * most).collect();
    for (k, root) in [1.875_104, 4.694_091].into_iter().enumerate() {
        let number: f64 = root / length;
        let slender = number * number * (e * inertia / (density * area)).sqrt();
        let correction = 0.5 * number * number * inertia / area * shear;
        let found = system.oscillators[modes[k]].omega;
        assert_relative_eq!(found, slender * (1.0 - correction), max_relative = 5e-3);
    }
    // all modes and the residual together, less the contact's own half-space: a force at x = 0.9 L
    let arm = 0.9 * length;
    let shear_modulus = e / (2.0 * (1.0 + STEEL[1]));
    let expected = arm.powi(3) / (3.0 * e * inertia) + 1.2 * arm / (shear_modulus * area);
    let modes: f64 =
        system.elastic().map(|k| (system.approach[0][k] / system.oscillators[k].omega).powi(2)).sum();
    let local = system.residual.expect("a residual").displacement(&system.laws, [1.0, 0.0], [1e-9, 0.0]).0[0];
    assert_relative_eq!(modes + local, expected, max_relative = 0.01);
    // the face turns with the beam's axis
    let each = system.elastic().zip(&system.along);
    let moved: f64 =
        each.map(|(k, along)| system.approach[0][k] * along[0] / system.oscillators[k].omega.powi(2)).sum();
    assert_relative_eq!(moved, -0.5 * height * arm.powi(2) / (2.0 * e * inertia), max_relative = 0.01);
}

/// A body whose supports leave a motion is refused.
#[test]
fn a_body_that_can_still_turn_is_refused() {
    let mesh = boxes([1.0, 1.0, 1.0], [2, 2, 2], 2, |p| p);
    for held in [
        |p: &Vector3<f64>| p.norm() == 0.0,
        // an edge, about which it turns, straight or along a diagonal
        |p: &Vector3<f64>| p.x == 0.0 && p.z == 0.0,
        |p: &Vector3<f64>| p.z == 0.0 && p.x == p.y,
    ] {
        let fixed: Vec<bool> = mesh.points.iter().map(held).collect();
        let refused = StruckSolid::new(&mesh, &CellMaterials::one(steel()), &fixed, &[])
            .expect_err("it can turn")
            .to_string();
        assert!(refused.contains("it can turn"), "{refused}");
    }
    let fixed: Vec<bool> = mesh.points.iter().map(|p| p.z == 0.0).collect();
    assert!(StruckSolid::new(&mesh, &CellMaterials::one(steel()), &fixed, &[]).is_ok());
}

/// A contact on what is held, and one whose circle leaves the face.
#[test]
fn a_contact_that_the_body_can_not_feel_is_refused() {
    let mesh = boxes([1.0, 1.0, 0.5], [4, 4, 2], 2, |p| p);
    let refused = |at: [f64; 2], fixed: fn(f64) -> bool| {
        let fixed: Vec<bool> = mesh.points.iter().map(|p| fixed(p.z)).collect();
        let at = SurfacePoint { point: Vector3::new(at[0], at[1], 0.5), normal: Vector3::z() };
        StruckSolid::new(
            &mesh,
            &CellMaterials::one(steel()),
            &fixed,
            &[StruckPoint { at, circles: [0.15, 0.2, 0.3], rubs: false }],
        )
    };
    let held = refused([0.5; 2], |z| z > 0.49).expect_err("held").to_string();
    assert!(held.contains("held"), "{held}");
    let edge = refused([0.1, 0.5], |z| z < 0.01).expect_err("at the edge").to_string();
    assert!(edge.contains("leaves the face"), "{edge}");
    assert!(refused([0.5; 2], |z| z < 0.01).is_ok());
}

/// A plate without an inner body is struck as one behind which a body lies that is too far away to be reached.
#[test]
fn a_plate_alone_is_one_with_an_inner_body_out_of_reach() {
    use crate::scene::{Model, Scene};
    let text = |kind: &str, inner: &str| {
        format!(
            "name = \"p\"\nkind = \"{kind}\"\n[materials.steel]\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\n\
             density = 7780\n[plate]\nradius = 0.033\nthickness = 0.002\nedge = \"clamped\"\nmaterial = \"steel\"\n\
             [outer]\nkind = \"sphere\"\nradius = 0.01\nmaterial = \"steel\"\nspeed = 0.55\n{inner}"
        )
    };
    let far = "[inner]\nkind = \"sphere\"\nradius = 0.01\nmaterial = \"steel\"\ngap = 0.1\n[run]\nend_time = 1e-3\n";
    let result = |kind: &str, inner: &str| {
        let scene = Scene::parse("p.toml", &text(kind, inner)).expect("valid");
        let model = crate::kinds::of(&scene).model(&scene, Model::C, None).expect("a model");
        model.run(1e-8).expect("a result")
    };
    let (alone, far) = (result("impact", ""), result("plate-impact", far));
    for name in ["outer_velocity_final", "outer_force_peak", "outer_contact_end", "first_frequency"] {
        let [ours, theirs] = [&alone, &far].map(|summary| summary.value(name).expect("a value"));
        assert_relative_eq!(ours, theirs, max_relative = 2e-3);
    }
    assert_eq!(alone.value("inner_velocity_final"), None);
}
