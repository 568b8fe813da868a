//! A rough seal seat: model C against finite elements on one mesh, its limits, and what friction costs.

use super::reduced::{fixture, mesh, sixteen};
use impactcheck::body::cache::Cache;
use impactcheck::kinds::seal_seat::SeatModel;
use impactcheck::result::Summary;
use impactcheck::scene::{Model, Scene};

/// The improved design with this coefficient of `friction`.
fn rough(friction: f64) -> impactcheck::Result<SeatModel> {
    let text = std::fs::read_to_string(fixture("seal-seat.toml")).expect("scene");
    let scene = Scene::parse("seat.toml", &format!("friction = {friction:e}\n{text}")).expect("scene");
    SeatModel::new(&scene, Model::C, Some(16), &mesh(), &Cache::off())
}

fn value(summary: &Summary, name: &str) -> f64 {
    summary.value(name).expect("determined")
}

/// Friction; then of the explicit finite elements of `fem_reference` on the fixture's mesh: velocity of the sphere along x and z in m/s, its
/// spin in rad/s, force peaks of sphere and actuator in N, energy dissipated by friction in J.
const FINITE_ELEMENTS: [(f64, [f64; 6]); 2] = [
    (0.1, [0.304733, 1.580283, 211.81, 4.7416, 22.5864, 1.7113e-5]),
    (0.3, [0.194902, 1.560463, 439.01, 4.7317, 22.2923, 1.0271e-5]),
];

#[test]
fn a_rough_seat_is_that_of_finite_elements_on_the_same_mesh() {
    for (friction, [x, z, spin, sphere, actuator, work]) in FINITE_ELEMENTS {
        let found = rough(friction).expect("model").run(1e-4).expect("run");
        let angle = (value(&found, "sphere_angle") - x.atan2(z)).to_degrees();
        assert!(angle.abs() < 0.02, "{friction}: {angle} degrees");
        for (name, ours, exact, bound) in [
            ("speed", value(&found, "sphere_speed"), x.hypot(z), 0.002),
            ("spin", found.sphere_spin.expect("spin"), spin, 0.002),
            ("sphere's force", value(&found, "sphere_force_peak"), sphere, 0.012),
            ("actuator's force", value(&found, "actuator_force_peak"), actuator, 0.005),
            ("friction's work", found.friction_work.expect("work"), work, 0.02),
        ] {
            assert!((ours / exact - 1.0).abs() < bound, "{friction}: {name} {ours}, {exact}");
        }
        assert!(found.energy_residual.expect("ledger") < 1e-5);
    }
}

#[test]
fn next_to_no_friction_is_a_smooth_seat() {
    let of = |model: &SeatModel| model.integrate(0.5e-6, 1e-6, false).expect("run");
    let (smooth, hardly) = (of(sixteen()).state, of(&rough(1e-9).expect("model")));
    let [x, z] = hardly.state.sphere_velocity;
    assert!((x - smooth.sphere_velocity[0]).hypot(z - smooth.sphere_velocity[1]) < 1e-7, "{x} {z}");
    assert!(hardly.state.spin.abs() < 1e-4 && (0.0..1e-12).contains(&hardly.rubbed), "{hardly:?}");
}

#[test]
fn more_friction_than_solids_have_is_refused() {
    let error = rough(4.0).expect_err("refused").to_string();
    assert!(error.contains("friction is 4") && error.contains("at most 3"), "{error}");
    assert!(rough(3.0).expect("model").run(1e-3).is_ok());
}

#[test]
fn friction_converges_in_time_and_keeps_the_tolerance() {
    let mut orders = Vec::new();
    for friction in [0.1, 0.2, 0.3] {
        let model = rough(friction).expect("model");
        let velocity = |step: f64| model.integrate(step, 1e-6, false).expect("run").state.sphere_velocity;
        let exact = velocity(1e-6 / 64.0);
        let error = |[x, z]: [f64; 2]| (x - exact[0]).hypot(z - exact[1]) / exact[0].hypot(exact[1]);
        let errors = [2e-6, 0.25e-6].map(|step| error(velocity(step)));
        assert!(errors[1] < 5e-5, "{friction}: {errors:?}");
        orders.push((errors[0] / errors[1]).log(8.0));
        for tolerance in [3e-3, 1e-3, 3e-4] {
            let found = model.run(tolerance).expect("run");
            let miss = error(["sphere_velocity_x", "sphere_velocity_z"].map(|name| value(&found, name)));
            assert!(miss < tolerance, "{friction}, {tolerance}: {miss}");
        }
    }
    // of second order but for the kinks where nodes begin to stick
    assert!(orders.iter().sum::<f64>() > 1.5 * 3.0, "{orders:?}");
}
