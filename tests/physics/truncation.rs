//! What a model says that it lacks modes for, against the same model with several times as many.

use approx::assert_relative_eq;
use impactcheck::kinds::plate_impact::PlateQuantities;
use impactcheck::kinds::plate_impact::errors::largest_error;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::scene::{Model, Scene, resolve};

/// Table 1's impact on a plate of `radius`.
fn scene(radius: &str) -> Scene {
    let text = std::fs::read_to_string(resolve("scaled-plate-r10").unwrap()).unwrap();
    let text = text.replace("\"33 mm\"", &format!("\"{radius}\""));
    Scene::parse("large.toml", &text).unwrap()
}

/// Estimated truncation error, and whether the user is warned of it, of `model` with `modes`; the error against `many` modes.
fn estimated_and_true(scene: &Scene, model: Model, modes: usize, many: (Model, usize)) -> (f64, bool, f64) {
    let run = |model, modes| Reduced::new(scene, model, Some(modes)).unwrap().run(1e-6).unwrap();
    let (ours, exact) = (run(model, modes), run(many.0, many.1));
    let speed = scene.plate_impact().unwrap().outer.speed;
    let warned = ours.warnings.iter().any(|warning| warning.contains("modal truncation error"));
    let [values, exact] = [&ours, &exact].map(|run| PlateQuantities::of_table(&run.quantities).unwrap());
    (ours.truncation_error.unwrap(), warned, largest_error(&values, &exact, speed).0)
}

/// From a plate whose modes are too few by far to one with enough of them.
#[test]
fn kirchhoff_models_report_their_distance_from_all_modes_of_their_plate() {
    for (radius, model, modes) in [
        ("33 mm", Model::A, 1),
        ("33 mm", Model::B, 3),
        ("33 mm", Model::B, 16),
        ("0.65 m", Model::B, 16),
        ("0.65 m", Model::B, 48),
        ("1 m", Model::B, 16),
        ("1 m", Model::B, 64),
    ] {
        let (estimated, warned, exact) = estimated_and_true(&scene(radius), model, modes, (Model::B, 240));
        assert_relative_eq!(estimated, exact, max_relative = 0.05, epsilon = 2e-3);
        assert_eq!(warned, estimated > 0.01, "{radius}, model {model} with {modes} modes");
    }
}

/// Model C stops to add modes at 64: on a wide plate it says that they are not enough.
#[test]
fn model_c_reports_its_truncation_error() {
    for (radius, modes) in [("33 mm", 2), ("33 mm", 4), ("33 mm", 16), ("0.65 m", 48), ("0.65 m", 64)] {
        let (estimated, warned, exact) =
            estimated_and_true(&scene(radius), Model::C, modes, (Model::C, 2 * modes + 8));
        assert!(
            exact <= estimated + 2e-4 && estimated <= 6.0 * exact + 1e-3,
            "{radius}, {modes}: {estimated} for {exact}"
        );
        assert_eq!(warned, estimated > 0.01);
    }
    let mut free = scene("0.65 m");
    free.reduced.modes = None;
    let default = Reduced::new(&free, Model::C, None).unwrap().run(1e-6).unwrap();
    assert_eq!((default.modes, default.warnings.len()), (Some(64), 1), "{:?}", default.warnings);
}

/// What the film does is left out of the estimate, and one there is.
#[test]
fn wet_impacts_and_benders_have_an_estimate() {
    for name in ["scenes/examples/wet-valve-plate.toml", "scenes/examples/rocker-bender.toml"] {
        let scene = Scene::read(resolve(name).unwrap()).unwrap();
        for (model, modes) in [(Model::B, Some(2)), (Model::C, None)] {
            let error =
                Reduced::new(&scene, model, modes).unwrap().run(1e-4).unwrap().truncation_error.unwrap();
            assert!(error.is_finite() && error > 0.0, "{name}: {error}");
        }
    }
}

/// What yields under the contacts of a soft plate is damped as its modes are; models with few of these leave that out.
#[test]
fn missing_damping_under_the_contacts_is_part_of_the_estimate() {
    let text = r#"name = "damped"
kind = "plate-impact"
materials.soft = { youngs_modulus = "38.3 MPa", poisson_ratio = -0.84, density = "4450 kg/m^3" }
materials.ball = { youngs_modulus = "31 MPa", poisson_ratio = -0.97, density = "734 kg/m^3" }
materials.stiff = { youngs_modulus = "575 MPa", poisson_ratio = -0.92, density = "17000 kg/m^3" }
plate = { radius = "20 mm", thickness = "2.845 mm", edge = "clamped", material = "soft", damping_ratio = 0.91 }
outer = { kind = "sphere", radius = "15.7 mm", material = "ball", speed = "58 mm/s" }
inner = { kind = "compact", mass = "7.77 g", tip_radius = "2.8 mm", material = "stiff" }
"#;
    let scene = Scene::parse("damped.toml", text).unwrap();
    let (estimated, _, exact) = estimated_and_true(&scene, Model::C, 10, (Model::C, 128));
    assert!(exact > 5e-3 && exact < estimated && estimated < 4.0 * exact, "{estimated} for {exact}");
}

/// Table 1's impact a little beside the centre: twice as many modes may all have nodal diameters through it.
#[test]
fn off_centre_modes_report_their_truncation_error() {
    let text = std::fs::read_to_string(resolve("scaled-plate-r10").unwrap()).unwrap();
    for (offset, model, modes) in [
        ("0.5 mm", Model::A, 1),
        ("0.5 mm", Model::B, 4),
        ("0.5 mm", Model::B, 8),
        ("8 mm", Model::A, 1),
        ("8 mm", Model::B, 16),
    ] {
        let text = text.replace("[outer]", &format!("[outer]\noffset = \"{offset}\""));
        let text = text.replace("\"axisymmetric\"", "\"solid\"");
        let scene = Scene::parse("beside.toml", &text).unwrap();
        let (estimated, warned, exact) = estimated_and_true(&scene, model, modes, (Model::B, 256));
        assert!(
            exact <= estimated && estimated <= 1.5 * exact + 1e-3,
            "{offset}, {modes}: {estimated} for {exact}"
        );
        assert_eq!(warned, estimated > 0.01);
    }
}
