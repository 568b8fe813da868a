//! Model C on both scenes of Table 1 of the paper.
//!
//! Goal: the continuum plate with residual flexibility, and the spheres' residual, give the impact of an
//! independent finite-element program (converged prototype: (a) efficiency 0.6946 +- 0.0002, peaks 443.1 / 352.1 N
//! +- 0.7, ends 180.5 / 84.5 us; (b) 0.3868 +- 0.0003, 142.9 / 85.35 +- 0.15, 62.4 / 52.2), whatever the
//! patch radius, the number of modes and the mesh.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use impactcheck::kinds::plate_impact::PlateQuantities;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::scene::{Model, Scene, resolve};
use impactcheck::study::{Verdict, insensitivity};

#[test]
fn both_scenes_of_table_1_agree_with_converged_finite_elements() {
    for (name, efficiency, peaks, ends) in [
        ("scaled-plate-r10", 0.6946, [443.1, 352.1], [180.5e-6, 84.5e-6]),
        ("scaled-plate-r6.35", 0.3868, [142.9, 85.35], [62.4e-6, 52.2e-6]),
    ] {
        let scene = Scene::read(resolve(name).unwrap()).unwrap();
        for modes in [6, 16] {
            let run = Reduced::new(&scene, Model::C, Some(modes)).unwrap().run(1e-7).unwrap();
            assert!(run.warnings.is_empty(), "{:?}", run.warnings);
            let ours = PlateQuantities::of_table(&run.quantities).unwrap();
            assert_abs_diff_eq!(ours.efficiency, efficiency, epsilon = 0.0008);
            for (ours, peak) in [ours.outer_force_peak, ours.inner_force_peak].into_iter().zip(peaks) {
                assert_relative_eq!(ours, peak, max_relative = 2.5e-3);
            }
            for (ours, end) in [ours.outer_contact_end, ours.inner_contact_end].into_iter().zip(ends) {
                assert_relative_eq!(ours, end, max_relative = 2.5e-3);
            }
        }
    }
}

#[test]
fn number_of_modes_patch_radius_and_mesh_hardly_matter() {
    let study = insensitivity::run(&mut |_| ()).unwrap();
    let missed: Vec<_> = study.claims.iter().filter(|claim| claim.verdict != Verdict::Pass).collect();
    assert!(missed.is_empty(), "{missed:#?}");
    assert_eq!(study.rows.len(), 2 * 10);
}

/// A patch wider than the membrane is thick is beyond the model: it still gives an answer, and says so.
#[test]
fn a_contact_wider_than_the_plate_is_thick_is_warned_of() {
    let text = std::fs::read_to_string(resolve("scenes/validation/titanium-membrane.toml").unwrap()).unwrap();
    let run = |thickness: &str| {
        let scene = Scene::parse("scene.toml", &text.replace("\"0.1 mm\"", thickness)).unwrap();
        Reduced::new(&scene, Model::C, None).unwrap().run(1e-8).unwrap()
    };
    assert!(run("\"0.1 mm\"").warnings.is_empty());
    let thin = run("\"0.05 mm\"");
    assert_eq!(thin.warnings.len(), 1);
    let near = |ratio: &&str| thin.warnings[0].contains(&format!("{ratio} times as wide"));
    assert!(["1.04", "1.05"].iter().any(near), "{}", thin.warnings[0]);
    assert!(thin.value("efficiency").unwrap() > 0.9 && thin.energy_residual < 1e-5);
}
