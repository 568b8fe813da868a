//! A seat that relaxes: model C against finite elements on one mesh, and what it may not be.

use super::reduced::{fixture, mesh};
use impactcheck::body::cache::Cache;
use impactcheck::kinds::seal_seat::SeatModel;
use impactcheck::result::Summary;
use impactcheck::scene::{Model, Scene};

/// The improved design with `keys` added to its polymer.
fn scene(keys: &str) -> impactcheck::Result<Scene> {
    let text = std::fs::read_to_string(fixture("seal-seat.toml")).expect("scene");
    let density = "density        = \"1320 kg/m^3\"";
    assert!(text.contains(density));
    Scene::parse("seat.toml", &text.replacen(density, &format!("{density}\n{keys}"), 1))
}

fn run(keys: &str) -> Summary {
    let model = SeatModel::new(&scene(keys).expect("scene"), Model::C, Some(16), &mesh(), &Cache::off());
    model.expect("model").run(1e-4).expect("run")
}

/// Loss factor; then of the explicit finite elements of `fem_reference` on the fixture's mesh with the same nine terms:
/// velocity of the sphere along x and z in m/s, force peaks of sphere and actuator in N, energy lost in the seat in J.
const FINITE_ELEMENTS: [(f64, [f64; 5]); 2] = [
    (0.05, [0.3934379, 1.5683764, 4.632405, 21.597453, 1.254517e-4]),
    (0.2, [0.3609361, 1.4348632, 4.328253, 18.442779, 3.929357e-4]),
];

#[test]
fn a_seat_that_relaxes_is_that_of_finite_elements_on_the_same_mesh() {
    for (loss_factor, [x, z, sphere, actuator, lost]) in FINITE_ELEMENTS {
        let found = run(&format!("loss_factor = {loss_factor}\nmodulus_frequency = \"10 kHz\""));
        let value = |name: &str| found.value(name).expect("determined");
        let angle = (value("sphere_angle") - x.atan2(z)).to_degrees();
        assert!(angle.abs() < 0.05, "{loss_factor}: {angle} degrees");
        let losses = found.losses.expect("losses").bodies.expect("of bodies");
        for (name, ours, exact) in [
            ("speed", value("sphere_speed"), x.hypot(z)),
            ("sphere's force", value("sphere_force_peak"), sphere),
            ("actuator's force", value("actuator_force_peak"), actuator),
            ("loss", losses[1], lost),
        ] {
            assert!((ours / exact - 1.0).abs() < 0.012, "{loss_factor}: {name} {ours}, {exact}");
        }
        assert!(found.energy_residual.expect("ledger") < 1e-5 && losses[0] + losses[2] == 0.0);
    }
}

#[test]
fn only_the_seat_relaxes_and_nothing_yields() {
    let relaxation = "relaxation = [{ ratio = 0.1, time = \"10 us\" }]";
    scene(relaxation).expect("a polymer seat");
    let text = std::fs::read_to_string(fixture("seal-seat.toml")).expect("scene");
    for (from, to, words) in [
        ("[materials.steel]", format!("[materials.steel]\n{relaxation}"), "`sphere.material`"),
        (
            "[materials.polymer]",
            "[materials.polymer]\nyield_strength = \"60 MPa\"\nhardening = 0".to_owned(),
            "`seat.material`",
        ),
    ] {
        let error = Scene::parse("seat.toml", &text.replacen(from, &to, 1)).expect_err("refused");
        assert!(error.to_string().contains(words), "{error}");
    }
}
