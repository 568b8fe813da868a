//! The cache of model C's bodies from the outside: a run with a cold, a warm, a damaged and no cache gives the same
//! summary, and rounding the contact patches to three digits changes nothing that matters.

use assert_cmd::Command;
use impactcheck::body::continuum::{ContinuumPlate, MeshOptions, sphere_residual};
use impactcheck::dynamics::integration::Options;
use impactcheck::dynamics::integrator::integrate;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::scene::{Model, Scene, Shape, resolve};
use std::path::Path;

/// Summary of model C without the seconds it took.
fn summary(scene: &str, cache: &str) -> serde_json::Value {
    let output = Command::cargo_bin("impactcheck")
        .unwrap()
        .args(["reduced", scene, "--model", "C", "--json"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("IMPACTCHECK_CACHE", cache)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let mut document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    document.as_object_mut().unwrap().remove("solve_seconds");
    document
}

fn entries(folder: &Path) -> Vec<std::path::PathBuf> {
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    paths.sort();
    paths
}

#[test]
fn cold_warm_damaged_and_no_cache_give_the_same_summary() {
    let folder = tempfile::tempdir().unwrap();
    let cache = folder.path().to_str().unwrap();
    let scene = "scaled-plate-r10";
    let without = summary(scene, "");
    assert_eq!(entries(folder.path()).len(), 0);
    assert_eq!(summary(scene, cache), without, "cold");
    // the plate and, with patches of their own, both spheres
    assert_eq!(entries(folder.path()).len(), 3);
    assert_eq!(summary(scene, cache), without, "warm");
    let good =
        entries(folder.path()).into_iter().map(|p| (std::fs::read(&p).unwrap(), p)).collect::<Vec<_>>();
    for (bytes, path) in &good {
        std::fs::write(path, &bytes[..bytes.len() / 2]).unwrap();
    }
    assert_eq!(summary(scene, cache), without, "damaged");
    for (bytes, path) in &good {
        assert_eq!(&std::fs::read(path).unwrap(), bytes, "mended");
    }
    assert_eq!(entries(folder.path()).len(), 3, "nothing is left over");
}

#[test]
fn a_warm_cache_is_really_read() {
    let folder = tempfile::tempdir().unwrap();
    let cache = folder.path().to_str().unwrap();
    let scene = "scaled-plate-r6.35";
    summary(scene, cache);
    let before: Vec<_> =
        entries(folder.path()).iter().map(|p| p.metadata().unwrap().modified().unwrap()).collect();
    summary(scene, cache);
    let after: Vec<_> =
        entries(folder.path()).iter().map(|p| p.metadata().unwrap().modified().unwrap()).collect();
    assert_eq!(before, after, "no entry is written again");
}

#[test]
fn rounding_the_patch_radii_to_three_digits_changes_the_impact_by_less_than_1e_4() {
    for name in ["scaled-plate-r10", "scaled-plate-r6.35"] {
        let scene = Scene::read(resolve(name).unwrap()).unwrap();
        let setup = scene.plate_impact().unwrap();
        let reduced = Reduced::new(&scene, Model::B, None).unwrap();
        let system = reduced.system();
        let predictor = integrate(system, &Options { tolerance: 1e-3, ..Options::default() }).unwrap();
        let patch = [0, 1].map(|i| system.laws[i].contact_radius(predictor.contacts[i].force_peak));
        let run = |factor: f64| {
            let patch = patch.map(|a| a * factor);
            let mesh = MeshOptions::default();
            let plate = ContinuumPlate::new(&setup.plate, patch, 16, &mesh).unwrap().modal_body(16, 0.0);
            let tip = |shape: &Shape, material, patch| {
                sphere_residual(shape.tip_radius(), material, patch, &mesh).unwrap()
            };
            let tips = [
                tip(&setup.outer.shape, &setup.outer.material, patch[0]),
                tip(&setup.inner.shape, &setup.inner.material, patch[1]),
            ];
            let system = setup.rigid_system(&plate, tips);
            let result = integrate(&system, &Options { tolerance: 1e-7, ..Options::default() }).unwrap();
            let speed = result.velocity[1].abs();
            [speed * speed, result.contacts[0].force_peak, result.contacts[1].force_peak]
        };
        let exact = run(1.0);
        // the largest error of three digits
        for factor in [0.995, 1.005] {
            for (name, (rounded, exact)) in
                ["efficiency", "outer peak", "inner peak"].iter().zip(run(factor).into_iter().zip(exact))
            {
                let change = rounded / exact - 1.0;
                println!("{factor} {name}: {change:e}");
                assert!(change.abs() < 1e-4, "{name}: {change:e}");
            }
        }
    }
}
