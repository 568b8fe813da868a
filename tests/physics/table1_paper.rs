//! Table 1 of the paper: reduced models A and B of both scenes against independent prototypes of the same models
//! and against the efficiencies the paper reports from Abaqus (69 % and 39 %).

use approx::assert_abs_diff_eq;
use impactcheck::kinds::plate_impact::PlateQuantities;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::result::Summary;
use impactcheck::scene::{Model, Scene, resolve};

fn run(name: &str, model: Model, tolerance: f64) -> Summary {
    let scene = Scene::read(resolve(name).unwrap()).unwrap();
    Reduced::new(&scene, model, None).unwrap().run(tolerance).unwrap()
}

#[test]
fn efficiencies_of_models_a_and_b() {
    for (scene, a, b) in [("scaled-plate-r10", 0.561, 0.6960), ("scaled-plate-r6.35", 0.671, 0.3621)] {
        assert_abs_diff_eq!(run(scene, Model::A, 1e-7).value("efficiency").unwrap(), a, epsilon = 0.001);
        assert_abs_diff_eq!(run(scene, Model::B, 1e-7).value("efficiency").unwrap(), b, epsilon = 0.0005);
    }
}

#[test]
fn forces_and_contact_ends_of_model_b() {
    let cases = [
        ("scaled-plate-r10", [433.7, 317.2], [183.3e-6, 85.9e-6]),
        ("scaled-plate-r6.35", [140.0, 82.5], [61.5e-6, 53.9e-6]),
    ];
    for (scene, peaks, ends) in cases {
        let q = PlateQuantities::of_table(&run(scene, Model::B, 1e-7).quantities).unwrap();
        for (ours, theirs) in [q.outer_force_peak, q.inner_force_peak].into_iter().zip(peaks) {
            assert_abs_diff_eq!(ours, theirs, epsilon = 0.001 * theirs);
        }
        for (ours, theirs) in [q.outer_contact_end, q.inner_contact_end].into_iter().zip(ends) {
            assert_abs_diff_eq!(ours, theirs, epsilon = 0.1e-6);
        }
        assert!(q.outer_velocity_final > 0.0 && q.inner_velocity_final < 0.0, "rebound and launch along z");
    }
}

#[test]
fn halving_the_tolerance_changes_the_efficiency_by_less_than_1e_6() {
    for scene in ["scaled-plate-r10", "scaled-plate-r6.35"] {
        let [coarse, fine] = [1e-7, 5e-8].map(|t| run(scene, Model::B, t).value("efficiency").unwrap());
        assert_abs_diff_eq!(coarse, fine, epsilon = 1e-6);
    }
}

#[test]
fn contact_ends_of_model_c_are_where_its_forces_end() {
    // with a residual flexibility the modal approach of one contact depends on the force of the other
    for name in ["scaled-plate-r10", "scaled-plate-r6.35", "scenes/validation/titanium-sapphire.toml"] {
        let scene = Scene::read(resolve(name).unwrap()).unwrap();
        let outcome = Reduced::new(&scene, Model::C, None).unwrap().run_with_history(1e-7).unwrap();
        let (summary, history) = (&outcome.summary, &outcome.history);
        for (force, end) in [("outer_force", "outer_contact_end"), ("inner_force", "inner_contact_end")] {
            let end = summary.value(end).unwrap();
            let last = history[force].iter().rposition(|f| *f > 0.0).unwrap();
            assert!(history.time[last] <= end && end <= history.time[last + 1], "{name}: {end:e}");
        }
    }
}
